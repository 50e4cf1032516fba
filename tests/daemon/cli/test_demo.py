"""What the demo says of each text: the audit of its part of the log."""

from __future__ import annotations

import numpy as np

from daemon.demo.main_job import audited_plans
from daemon.recording.mcap_reading import Log, LoggedCycle
from retarget.robot.ticks import JointServoMap
from tests.support.rig import swing
from tests.support.robots import packaged

ROBOT = packaged("reference")


def log_of(q_rad: np.ndarray, period_s: float) -> Log:
    """Two plans, one after the other, played from the moment torque is on."""
    ticks = np.rint(JointServoMap(ROBOT).to_ticks(q_rad)).astype(int)
    rows = [tuple(int(t) for t in row) for row in ticks]
    half = len(rows) // 2
    return Log(cycles=[
        LoggedCycle(i, round(1e9 * i * period_s), "playing", 1 + (i >= half), True, q_rad[i], row, rows[0])
        for i, row in enumerate(rows)
    ])  # fmt: skip


def test_a_plan_within_the_limits_has_no_violations_and_its_own_goals() -> None:
    q = swing(ROBOT, 2.0)
    counts = audited_plans(log_of(q, ROBOT.bus.period_s), ROBOT)
    assert counts == {1: (len(q) // 2 * ROBOT.n_servos, 0), 2: (len(q) // 2 * ROBOT.n_servos, 0)}


def test_a_jump_or_goals_in_a_hurry_are_counted_for_their_plan() -> None:
    q = swing(ROBOT, 2.0)
    jumped = q.copy()
    jumped[150:] = ROBOT.rest_rad
    counts = audited_plans(log_of(jumped, ROBOT.bus.period_s), ROBOT)
    assert counts[1][1] == 0
    assert counts[2][1] > 0
    hurried = audited_plans(log_of(q, ROBOT.bus.period_s / 20), ROBOT)
    assert hurried[1][1] > 0
