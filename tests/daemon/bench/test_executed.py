"""What simulated robots do of a motion: judged on measured positions, with tracking error and lag."""

import numpy as np
import pytest

from daemon.bench.executed import Executed, tracking
from mmm_core.corpus.heldout import PROBES
from mmm_core.evaluation.reconstruction import performed
from mmm_core.evaluation.robot_capability import as_motion
from retarget.pipeline import Retargeter
from retarget.robot.loading import load_robot
from sim.faults import Fault

PROBE = next(p for p in PROBES if p.family == "wave" and p.side == "right" and p.count is None and p.then is None)


@pytest.fixture(scope="module")
def motion():
    return as_motion(performed(PROBE, 0), PROBE.text)


def _cycles(goal_rad):
    cycles = np.zeros(len(goal_rad), np.dtype([("plan_id", "u8"), ("goal_rad", "f8", 2), ("setpoint_rad", "f8", 2)]))
    cycles["goal_rad"] = cycles["setpoint_rad"] = goal_rad
    return cycles


def test_lag_and_way_of_a_servo_that_is_late_and_weak():
    t = np.arange(0, 4, 0.01)
    goal = np.stack([np.sin(3 * t), np.zeros(len(t))], 1)
    late = np.stack([0.9 * np.sin(3 * (t - 0.06)), np.zeros(len(t))], 1)
    found = tracking(_cycles(goal), late, 0.01)
    assert found.lag_s[0] == pytest.approx(0.06, abs=0.011)
    assert found.way[0] == pytest.approx(0.9, abs=0.01)
    assert np.isnan(found.lag_s[1]) and np.isnan(found.way[1])
    assert np.abs(found.error_rad[:, 0]).max() > 0.1


@pytest.mark.long
def test_a_wave_is_seen_in_what_the_servos_measured(motion):
    """Until now figures ended at the path: whether servos under load follow it was taken for granted."""
    robot = Executed(Retargeter(load_robot("op3")))
    measured = robot.shown(motion)
    figures = robot.figures()
    assert figures["kept"] == 1.0
    assert 0 < figures["tracking_rms_deg"] < 8 and 0 < figures["lag_ms"] < 150
    assert figures["violations"] == figures["self_contacts"] == 0
    assert len(measured.joints_m) >= len(motion.joints_m)


@pytest.mark.long
def test_servos_that_do_not_turn_show_in_the_verdict(motion):
    """The verdict is about measured positions: with the right arm stuck the path waves and the robot does not."""
    op3 = load_robot("op3")
    stuck = [
        Fault("stuck", start_s=0.0, end_s=9.0, servo_id=s.servo_id) for s in op3.servos if s.joint_name[:2] == "r_"
    ]
    robot = Executed(Retargeter(op3), faults=tuple(stuck))
    robot.shown(motion)
    figures = robot.figures()
    assert figures["kept_by_expectation"]["pose"] == 0.0
    assert figures["joints_that_fall_short"]["r_el"] < 0.6
