"""The rig of `mmmd bench audit`: plays, is disturbed, is repaired, reports what its audit saw."""

from __future__ import annotations

import json
import shutil

import numpy as np
import pytest

from daemon.bench.audit_rig import AuditRig
from daemon.cli import main
from daemon.shared_memory.bus_link import BusRequest, BusState
from sim.faults import Fault
from tests.support.rig import swing
from tests.support.robots import packaged
from tests.support.sizes import few_and_long

ROBOT = packaged("op3")


class Drawn:
    """Draws what a test wants: the same case each time, noise from a seed."""

    def __init__(self, case: int) -> None:
        self._case, self._random = case, np.random.default_rng(3)

    def integers(self, n: int) -> int:
        return self._case if n == 40 else int(self._random.integers(n))

    def normal(self, *args) -> np.ndarray:
        return self._random.normal(*args)

    def choice(self, values: list[float]) -> float:
        return float(self._random.choice(values))


@pytest.mark.long
def test_a_calm_run_reports_goals_and_nothing_else():
    rig = AuditRig(ROBOT)
    rig.make_ready()
    path = swing(ROBOT, 2.0)
    rig.play(path)
    assert rig.state().position_rad == pytest.approx(path[-1])
    rig.play(path, 0.5, stop=True)
    assert not rig.state().velocity_rad_s.any(), "it was stopped half way"
    report = rig.finish()
    assert report["goals"] > 1.5 * len(path) * ROBOT.n_servos
    assert report["poses_checked"] > 0.15 * 1.5 * len(path)
    assert {
        report[k] for k in ("violations", "self_contacts", "inherited_contacts", "measured_contacts", "repairs")
    } == {0}


@pytest.mark.parametrize("case", few_and_long([2], [0, 1, 3, 9]))
def test_what_makes_no_sense_breaks_nothing(case):
    """Requests at random, noise, frames that are not finite, frames in reverse, and none of these."""
    rig = AuditRig(ROBOT)
    rig.make_ready()
    rig.play_disturbed(swing(ROBOT, 1.0), Drawn(case))  # type: ignore[arg-type]
    report = rig.finish()
    assert report["violations"] == report["self_contacts"] == 0, report["details"] + report["contact_details"]


def test_what_breaks_is_repaired_and_counted():
    rig = AuditRig(ROBOT, (Fault("trip", start_s=4.0, servo_id=ROBOT.servo_ids[0]),))
    rig.make_ready()
    assert rig.repairs == 0
    for _ in range(4):
        rig.play_disturbed(swing(ROBOT, 1.0), Drawn(9))  # type: ignore[arg-type]
    assert rig.finish()["repairs"] == 1


@pytest.mark.long
def test_what_cannot_be_repaired_is_said():
    rig = AuditRig(ROBOT, (Fault("silent", servo_id=ROBOT.servo_ids[0]),))
    with pytest.raises(RuntimeError, match="after ten repairs"):
        rig.make_ready()


def test_contacts_that_are_commanded_are_reported(monkeypatch):
    """With the gate's knowledge of the body taken away a plan into the body shows in the report."""
    from daemon.control.safety_limiter import SafetyLimiter
    from retarget.path.collision import SelfContact
    from retarget.path.limits import JointLimits

    limits, body = JointLimits.of(ROBOT), SelfContact(ROBOT, margin_m=0.0)
    draw = np.random.default_rng(0)
    poses = draw.uniform(limits.position_min_rad, limits.position_max_rad, (2000, ROBOT.n_joints))
    inside = np.repeat(poses[body.clearance_m(poses).argmin()][None], 300, 0)
    monkeypatch.setattr("daemon.control.control_loop.SafetyLimiter", lambda robot, contact: SafetyLimiter(robot))
    rig = AuditRig(ROBOT)
    rig.make_ready()
    rig.play(inside)
    rig._request(BusRequest.STOP)
    rig._until(BusState.HOLDING)
    report = rig._bus.audit.report()
    assert report["self_contacts"] > 10 and "deep" in report["contact_details"][0]
    assert report["measured_contacts"] > 10


@pytest.mark.long
def test_a_robot_of_ones_own_can_be_audited(tmp_path, capsys):
    """`--robot` was unknown: the one thing a builder wants after `robot new` could not be had of the own robot file."""
    mine = tmp_path / "mine"
    shutil.copytree(ROBOT.path.parent, mine)
    text = (mine / "robot.toml").read_text()
    (mine / "robot.toml").write_text(
        text.replace('name = "op3"', 'name = "mine"').replace("rate_hz = 125", "rate_hz = 40")
    )
    assert main(["bench", "audit", "--robot", str(mine), "--n", "1", "--json"]) == 0
    out, err = capsys.readouterr()
    assert "0 outside a limit, 0 poses in self-contact" in err
    assert "poses_checked" not in err, "all figures of every robot stood on stderr, and once more in the result"
    figures = json.loads(out)
    assert figures["robots"] == ["mine"] and figures["goals"] > 0 and figures["violations"] == 0


def test_an_audit_of_what_cannot_be_simulated_is_refused(tmp_path, capsys):
    assert main(["bench", "audit", "--robot", str(tmp_path / "none")]) == 2
    assert main(["bench", "story", "--robot", "op3"]) == 2
    assert "--robot is for audit" in capsys.readouterr().err
