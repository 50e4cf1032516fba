"""Arms of every family: exact where they can be, the least error where they cannot, for any zero pose, axes and frames."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_robots import FAMILIES, made_robot
from random_motions import random_motion

from retarget.errors import RobotFileError
from retarget.human.arm_chain import read_arm
from retarget.human.arms import Arms
from retarget.human.branches import choose, fill_unseen
from retarget.human.human import read_human
from retarget.human.poser import Poser
from retarget.path.limits import JointLimits
from retarget.pipeline import Retargeter
from retarget.robot.kinematics import Kinematics
from tests.support.sizes import examples, few_and_long

REACHES_ALL = [name for name in FAMILIES if int(name[0]) >= 4]
LEAST_ERROR = [name for name in FAMILIES if int(name[0]) < 4]


def both_arms(robot) -> Arms:
    kinematics = Kinematics(robot)
    return Arms([read_arm(kinematics, side) for side in ("left", "right")])


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def mujocos_directions(robot, q):
    """(2, M, 3) directions of upper arms and forearms by MuJoCo's own kinematics: the independent oracle."""
    model = mujoco.MjModel.from_xml_path(str(robot.description_path))
    data = mujoco.MjData(model)
    upper, fore = np.empty((2, 2, len(q), 3))
    for m in range(len(q)):
        data.qpos[[model.joint(n).qposadr[0] for n in robot.joint_names]] = q[m]
        mujoco.mj_kinematics(model, data)
        for g, side in enumerate(("left", "right")):
            roles = [r for r in ("roll", "pitch") if f"{side}_shoulder_{r}" in robot.joint_names]
            shoulder = data.joint(f"{side}_shoulder_{roles[0]}").xanchor
            wrist = data.site(f"{side}_wrist").xpos
            has_elbow = f"{side}_elbow" in robot.joint_names
            elbow = data.joint(f"{side}_elbow").xanchor if has_elbow else wrist
            upper[g, m] = unit(elbow - shoulder)
            fore[g, m] = unit(wrist - elbow) if has_elbow else upper[g, m]
    return upper, fore


@pytest.mark.parametrize("beside_m", [0.0, 0.01])
@pytest.mark.parametrize("family", list(FAMILIES))
def test_directions_are_mujocos_and_slopes_their_derivatives(family, beside_m, tmp_path):
    robot = made_robot(tmp_path, family, beside_m=beside_m)
    arms, rng = both_arms(robot), np.random.default_rng(1)
    q = rng.uniform(robot.position_min_rad, robot.position_max_rad, (12, robot.n_joints))
    columns = np.array([c.joints for c in arms.chains])
    angles = q[:, columns].transpose(1, 0, 2)
    upper, fore = mujocos_directions(robot, q)
    for found in (arms.directions(angles), (arms.bones(angles).upper, arms.bones(angles).fore)):
        np.testing.assert_allclose(found[0], upper, atol=1e-9)
        np.testing.assert_allclose(found[1], fore, atol=1e-9)
    slope = arms.bones(angles).slope
    for j in range(arms.n_joints):
        ahead = angles.copy()
        ahead[..., j] += 1e-6
        by_difference = (np.concatenate(arms.directions(ahead), -1) - np.concatenate([upper, fore], -1)) / 1e-6
        np.testing.assert_allclose(slope[:, :, j], by_difference, atol=1e-4)


@pytest.mark.parametrize("family", REACHES_ALL)
def test_a_shoulder_of_three_axes_reaches_every_pair_in_all_its_ways(family, tmp_path):
    arms, rng = both_arms(made_robot(tmp_path, family)), np.random.default_rng(2)
    pose = rng.uniform(-2.9, 2.9, (2, 300, 4))
    upper, fore = arms.directions(pose)
    solutions, _ = arms.ik_solutions(upper, fore)
    found_upper, found_fore = (d.reshape(2, 300, 4, 3) for d in arms.directions(solutions.reshape(2, -1, 4)))
    missed = np.abs(found_upper - upper[:, :, None]).max(-1) + np.abs(found_fore - fore[:, :, None]).max(-1)
    assert missed.min(-1).max() < 1e-4, "at least one way reaches"
    if "slanted" not in family:
        assert np.percentile(missed, 99) < 1e-4, "with axes at right angles, all four do"
    turned = np.abs((solutions - pose[:, :, None] + np.pi) % (2 * np.pi) - np.pi).max(-1).min(-1)
    assert np.percentile(turned, 98) < 1e-5, "the pose they came from is among the ways"


@pytest.mark.parametrize("family", REACHES_ALL[:3])
def test_the_straight_and_the_raised_arm_are_reached_too(family, tmp_path):
    arms = both_arms(made_robot(tmp_path, family))
    around = unit(np.random.default_rng(3).normal(size=(2, 50, 3)))
    for direction in (
        around,
        np.broadcast_to(arms.axes[:, :1], (2, 50, 3)),
        np.broadcast_to(-arms.axes[:, :1], (2, 50, 3)),
    ):
        for other in (direction, around):
            solutions, observability = arms.ik_solutions(direction, other)
            assert np.isfinite(solutions).all() and (observability >= 0).all() and (observability <= 1).all()
            found = arms.directions(solutions.reshape(2, -1, 4))
            missed = [
                np.abs(f.reshape(2, 50, 4, 3) - d[:, :, None]).max(-1)
                for f, d in zip(found, (direction, other), strict=True)
            ]
            assert np.maximum(*missed).min(-1).max() < 1e-3


@pytest.mark.parametrize("family", LEAST_ERROR)
def test_an_arm_that_cannot_reach_comes_as_near_as_any_pose_of_a_grid(family, tmp_path):
    low, high = -110, 95
    arms = both_arms(made_robot(tmp_path, family, range_deg=(low, high)))
    rng, n = np.random.default_rng(4), arms.n_joints
    upper, fore = unit(rng.normal(size=(2, 2, 120, 3)))
    solutions, _ = arms.ik_solutions(upper, fore)
    found_upper, found_fore = (d.reshape(2, 120, -1, 3) for d in arms.directions(solutions.reshape(2, -1, n)))
    cost = ((found_upper - upper[:, :, None]) ** 2).sum(-1) + ((found_fore - fore[:, :, None]) ** 2).sum(-1)
    steps = np.deg2rad(np.linspace(low, high, 42))
    grid = np.broadcast_to(np.stack(np.meshgrid(*[steps] * n), -1).reshape(-1, n), (2, len(steps) ** n, n))
    grid_upper, grid_fore = arms.directions(grid)
    aim, poses = np.concatenate([upper, fore], -1), np.concatenate([grid_upper, grid_fore], -1)
    best = 4 - 2 * (aim @ poses.swapaxes(-1, -2)).max(-1)
    worse = cost.min(-1) - best
    assert np.percentile(worse, 97) < 0.01
    assert (solutions >= np.deg2rad(low) - 1e-12).all() and (solutions <= np.deg2rad(high) + 1e-12).all()


@pytest.mark.parametrize("family", few_and_long(list(FAMILIES)[::4], list(FAMILIES)))
def test_a_motion_is_retargeted_on_every_family(family, tmp_path):
    r = Retargeter(made_robot(tmp_path, family))
    path = r.retarget(random_motion(3, 60, "smooth"))
    limits = r.limits
    assert (path.control_rad >= limits.position_min_rad - 1e-12).all()
    assert (path.control_rad <= limits.position_max_rad + 1e-12).all()
    assert np.isfinite(path.q_rad).all()
    poses = r.poses(read_human(random_motion(3, 60, "smooth")))
    reach = r.direction_errors_deg(poses, poses.q_rad)
    assert (np.percentile(reach, 90) < 1.0) == (family in REACHES_ALL)


def test_a_joint_cut_off_by_its_limit_is_made_up_for_by_the_others(tmp_path):
    arms = both_arms(made_robot(tmp_path, "4 hanging", range_deg=(-60, 60)))
    upper, fore = unit(np.random.default_rng(5).normal(size=(2, 2, 200, 3)))
    way = arms.ik_solutions(upper, fore)[0][:, :, 0]
    clipped = np.clip(way, arms.low, arms.high)
    better = arms.within_limits(way, upper, fore)
    assert (better >= arms.low).all() and (better <= arms.high).all()

    def missed(q):
        found = arms.directions(q)
        return ((found[0] - upper) ** 2).sum(-1) + ((found[1] - fore) ** 2).sum(-1)

    assert missed(better).mean() < 0.75 * missed(clipped).mean()


def test_an_arm_led_past_its_first_axis_comes_out_on_the_near_side(tmp_path):
    """Raised sideways through the pitch axis: the pitch must not turn half round and back within a frame."""
    robot = made_robot(tmp_path, "4 hanging")
    poser = Poser(Kinematics(robot), JointLimits.of(robot))
    angle = np.linspace(-0.5, 0.5, 41)
    upper = unit(np.stack([np.sin(angle) * 0.4, np.cos(angle), 0.02 + 0 * angle], -1))
    fore = unit(upper + np.array([0.0, 0, 0.9]))
    human = type("Human", (), {})()
    human.upper, human.fore = np.stack([upper, upper * [1, -1, 1]]), np.stack([fore, fore * [1, -1, 1]])
    human.forearm_twist_rad, human.fps = np.zeros((2, 41)), 20.0
    human.chest_rotation = human.head_rotation = np.tile(np.eye(3), (41, 1, 1))
    before = np.zeros(robot.n_joints)
    before[[robot.joint_names.index(f"{s}_shoulder_{p}") for p in ("pitch", "roll") for s in ("left", "right")]] = (
        1.6,
        1.6,
        1.4,
        1.4,
    )
    poses = poser.solve(human, before)
    assert np.abs(np.diff(poses.q_rad, axis=0)).max() < 0.35
    found = poser.directions(poses.q_rad)
    assert max(np.abs(found[0] - poses.upper).max(), np.abs(found[1] - poses.fore).max()) < 0.1


@given(st.integers(0, 10_000))
@settings(max_examples=examples(20))
def test_the_row_of_ways_is_the_cheapest_of_all_rows(seed):
    rng = np.random.default_rng(seed)
    G, T, C, n = 1, 4, 3, 2
    solutions, own = rng.normal(size=(G, T, C, n)), rng.uniform(0, 1, (G, T, C))
    before = rng.normal(size=(G, n))
    q, _ = choose(solutions, own, np.ones(solutions.shape), before)

    def cost(row):
        picked = np.concatenate([before, solutions[0, np.arange(T), row]])
        return np.abs(np.diff(picked, axis=0)).sum() + own[0, np.arange(T), row].sum()

    best = min((np.array(r) for r in np.ndindex(*[C] * T)), key=cost)
    np.testing.assert_allclose(q[0], solutions[0, np.arange(T), best])


def test_of_two_ways_that_cost_nothing_the_near_one_is_taken():
    """Both ways of an arm with wide limits lie within them: it once swung half round to reach the first."""
    solutions = np.broadcast_to(np.array([[3.0, 3.0], [0.1, 0.1]]), (1, 5, 2, 2))
    q, _ = choose(solutions, np.zeros((1, 5, 2)), np.ones(solutions.shape), np.zeros((1, 2)))
    np.testing.assert_allclose(q, 0.1)


def test_an_unseen_joint_is_filled_in_from_the_frames_around():
    q, observability = np.array([0.0, 9.0, 9.0, 3.0, -7.0]), np.array([1.0, 0.1, 0.1, 1.0, 0.0])
    fill_unseen(q, observability, 5.0)
    np.testing.assert_allclose(q, [0, 1, 2, 3, 3])


def test_arms_that_cannot_be_used_are_named(tmp_path):
    made_robot(tmp_path, "4 hanging")
    toml = tmp_path / "robot.toml"
    good = toml.read_text()
    text = good
    for old, new in (
        ("left_shoulder_yaw", "left_wrist"),
        ("left_elbow", "head_yaw"),
        ("left_shoulder_roll", "head_pitch"),
    ):
        text = text.replace(f'role = "{old}"', f'role = "{new}"')
    toml.write_text(text)
    from retarget.robot.loading import load_robot

    arms = Arms([read_arm(Kinematics(load_robot(str(tmp_path))), "right")])
    assert arms.reaches_all
    with pytest.raises(RobotFileError, match="left arm"):
        read_arm(Kinematics(load_robot(str(tmp_path))), "left")
    xml = tmp_path / "robot.xml"
    xml.write_text(xml.read_text().replace('site name="left_wrist"', 'site name="left_hand"'))
    toml.write_text(good)
    with pytest.raises(RobotFileError, match="site 'left_wrist'"):
        read_arm(Kinematics(load_robot(str(tmp_path))), "left")
