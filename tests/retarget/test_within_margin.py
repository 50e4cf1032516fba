"""A robot that stands nearer to itself than paths keep (a stop, a hand led it there) is led away, and never deeper."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from daemon.control.safety_limiter import GATE_SHARE, SafetyLimiter
from retarget.path.collision import KEPT, SelfContact
from retarget.path.limits import JointLimits
from retarget.path.paths import JointState
from retarget.pipeline import Retargeter
from retarget.robot.loading import load_robot
from retarget.robot.robot import RobotModel
from tests.retarget.gestures import gesture
from tests.support.sizes import few_and_long

ROBOTS = ("reference", "op3", "toddlerbot")


def poses_within(robot: RobotModel, contact: SelfContact, n_poses: int) -> NDArray[np.float64]:
    """The first `n_poses` drawn poses that no path comes to, but that the gate lets be."""
    rng, limits = np.random.default_rng(3), JointLimits.of(robot)
    anywhere = rng.uniform(limits.position_min_rad, limits.position_max_rad, (4000, robot.n_joints))
    q_rad = robot.rest_rad + rng.random((4000, 1)) * (anywhere - robot.rest_rad)
    room, gate_room = contact.slacks_m(q_rad, 1.0).min(1), contact.slacks_m(q_rad, 1.05 * GATE_SHARE).min(1)
    return q_rad[(room < 0) & (gate_room > 0)][:n_poses]


@pytest.mark.parametrize("name", few_and_long(["reference"], ROBOTS))
@pytest.mark.parametrize(("n_poses", "most_stay"), [(3, 0), pytest.param(8, 1, marks=pytest.mark.soak)])
def test_a_motion_leaves_a_pose_within_the_margin(name: str, n_poses: int, most_stay: int) -> None:
    robot = load_robot(name)
    contact = SelfContact(robot)
    retargeter, motion = Retargeter(robot, contact=contact), gesture("wave")
    poses = poses_within(robot, contact, n_poses)
    assert len(poses) == n_poses
    stayed = 0
    for pose in poses:
        path = retargeter.retarget(motion, JointState(pose, np.zeros(robot.n_joints)))
        q_rad = path.at_rate(4 * robot.bus.rate_hz)
        start_m = contact.slack_m(pose, 0.0)
        margin_m = start_m - contact.slack_m(pose, 1.0)
        least_m = np.minimum(KEPT * margin_m, start_m - 0.1 * margin_m)
        assert (contact.distances_m(q_rad) >= least_m - 1e-5).all()
        gate, goals = SafetyLimiter(robot, contact=contact), []
        gate.reset(pose)
        for target in path.at_rate(robot.bus.rate_hz):
            goals.append(gate.step(target))
        stayed += bool(np.abs(np.array(goals) - pose).max() < 0.05)
    assert stayed <= most_stay, f"{stayed} of {n_poses} motions did not leave"


def test_a_pose_that_keeps_the_margins_is_given_nothing() -> None:
    robot = load_robot("reference")
    contact = SelfContact(robot)
    assert contact.allowed_from(contact.least(robot.rest_rad[None]).least_m[0]) is None
