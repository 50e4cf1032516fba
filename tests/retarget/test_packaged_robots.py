"""The robots that ship: their descriptions against the makers' figures, their limits, poses and gestures.

Descriptions are written here, in axes of our own. Where the checkout has `../shared/robots`, each is compared with the
maker's file by MuJoCo's kinematics, which shares nothing with ours but the names of the joints.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from mmm_core.generate.engine import Engine
from mmm_core.motion.motion import Motion
from retarget.pipeline import Retargeter
from retarget.robot.loading import list_robots, load_robot
from retarget.robot.robot import RobotModel
from tests.retarget.random_motions import random_motion
from tests.retarget.test_pipeline import RATES_HZ, at_rest, check_bounds
from tests.support.sizes import few_and_long

SHARED = Path(__file__).parents[3] / "shared" / "robots"


@dataclass(frozen=True)
class Maker:
    """How a maker's file differs from ours: joint = sign * theirs + offset; turn is ours from their axes."""

    folder: str
    file: str
    turn_deg: float = 0.0
    sign: dict[str, float] = field(default_factory=dict[str, float])
    offset_deg: dict[str, float] = field(default_factory=dict[str, float])
    base: str = ""
    """Their body that is our chest, where it is not the root."""


MAKERS = {
    "op3": Maker("robotis_op3", "robot.xml"),
    "op2": Maker("robotis_op2", "robot.urdf", offset_deg={"head_tilt": -33.0}),
    "reachy_2021": Maker("reachy_2021", "robot.urdf"),
    "ffw_bg2": Maker("robotis_ffw_bg2", "robot.xml"),
    # x left and y back there, and a twist of 1.05 degrees; the right shoulder's figure turns against its own range
    "poppy_torso": Maker(
        "poppy_torso", "robot.xml", 90 - 1.053, {"r_shoulder_x": -1.0}, {"head_y": 20.0}
    ),
    "toddlerbot": Maker("toddlerbot", "robot.xml"),
}  # fmt: skip
WRISTS = ("left_wrist", "right_wrist")


def facts(name: str) -> tuple[Any, dict[str, Any]]:
    maker = MAKERS[name]
    folder = SHARED / maker.folder
    if not folder.is_dir():
        pytest.skip("no ../shared/robots beside this checkout")
    table = tomllib.loads((folder / "joints.toml").read_text())
    return mujoco.MjModel.from_xml_path(str(folder / maker.file)), {j["name"]: j for j in table["joint"]}


def theirs(name: str, joint: str, model: Any) -> str:
    """The maker's name of our joint: of a geared pair the driven one."""
    driven = f"{joint}_driven"
    return driven if mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, driven) >= 0 else joint


def pose(model: Any, angles: dict[str, float]) -> Any:
    data = mujoco.MjData(model)
    for joint, q in angles.items():
        data.qpos[model.joint(joint).qposadr[0]] = q
    mujoco.mj_kinematics(model, data)
    return data


@pytest.mark.parametrize("name", MAKERS)
@pytest.mark.parametrize("seed", range(4))
def test_wrists_and_head_move_as_in_the_makers_file(name: str, seed: int) -> None:
    maker, robot = MAKERS[name], load_robot(name)
    model, _ = facts(name)
    ours = mujoco.MjModel.from_xml_path(str(robot.description_path))
    share = np.random.default_rng(seed).uniform(size=robot.n_joints)
    q = robot.position_min_rad + share * (robot.position_max_rad - robot.position_min_rad)
    angles = dict(zip(robot.joint_names, q.tolist(), strict=True))
    if name == "toddlerbot":  # the maker's root is the torso, ours the hips: the waist is compared by itself
        angles |= {"waist_roll": 0.0, "waist_yaw": 0.0}
    to_theirs = {
        theirs(name, j, model): maker.sign.get(j, 1.0) * (a - np.deg2rad(maker.offset_deg.get(j, 0.0)))
        for j, a in angles.items()
    }
    zero_theirs = {
        theirs(name, j, model): -maker.sign.get(j, 1.0) * np.deg2rad(maker.offset_deg.get(j, 0.0)) for j in angles
    }
    turn = np.deg2rad(maker.turn_deg)
    R = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    zero_o, now_o = pose(ours, {}), pose(ours, angles)
    zero_t, now_t = pose(model, zero_theirs), pose(model, to_theirs)
    names = {j.role: j.name for j in robot.joints}
    for point, role in (("left_wrist", "left_"), ("right_wrist", "right_"), ("head", "head_")):
        site = ours.site(point).id
        chain = [n for r, n in names.items() if r.startswith(role) and _carries(ours, n, int(ours.site_bodyid[site]))]
        if not chain:
            continue  # Reachy's neck is no servo of ours
        last = max(chain, key=lambda n: _depth(ours, int(ours.jnt_bodyid[ours.joint(n).id])))
        body = int(model.jnt_bodyid[model.joint(theirs(name, last, model)).id])
        at = R.T @ zero_o.site_xpos[site]  # the point, carried along by their last body
        local = zero_t.xmat[body].reshape(3, 3).T @ (at - zero_t.xpos[body])
        moved = R @ (now_t.xpos[body] + now_t.xmat[body].reshape(3, 3) @ local)
        assert moved == pytest.approx(now_o.site_xpos[site], abs=1.5e-3), point


def _carries(model: Any, joint: str, body: int) -> bool:
    above = set()
    while body:
        above.add(body)
        body = int(model.body_parentid[body])
    return int(model.jnt_bodyid[model.joint(joint).id]) in above


def _depth(model: Any, body: int) -> int:
    depth = 0
    while body:
        depth, body = depth + 1, int(model.body_parentid[body])
    return depth


def test_toddlerbots_waist_turns_the_chest_as_the_maker_turns_the_hips() -> None:
    model, _ = facts("toddlerbot")
    ours = mujoco.MjModel.from_xml_path(str(load_robot("toddlerbot").description_path))
    for angles in ({"waist_roll": 0.3}, {"waist_yaw": 0.8}, {"waist_roll": -0.2, "waist_yaw": -1.0}):
        zero, hips = pose(model, {}), pose(model, angles)
        body = model.body("waist_link").id
        turned = hips.xmat[body].reshape(3, 3) @ zero.xmat[body].reshape(3, 3).T  # hips seen from the chest
        chest = pose(ours, angles).xmat[ours.body("torso").id].reshape(3, 3)
        assert chest == pytest.approx(turned.T, abs=1e-9)


def test_toddlerbots_linkage_keeps_the_length_of_its_rods() -> None:
    model, _ = facts("toddlerbot")
    servo = next(s for s in load_robot("toddlerbot").servos if s.joint_name == "neck_pitch")
    assert servo.linkage is not None
    for end in ("front", "back"):
        lengths = []
        for q in np.deg2rad(np.linspace(-79, 34, 24)):
            at = pose(model, {"neck_pitch": q, "neck_pitch_act": float(servo.linkage.to_servo(np.array(q)))})
            one, two = (at.xanchor[model.joint(f"neck_pitch_{end}_rev_{i}").id] for i in (1, 2))
            lengths.append(np.linalg.norm(one - two))
        assert np.ptp(lengths) < 2e-6, "metres: a servo tick is 12 micrometres at the crank"


@pytest.mark.parametrize("name", MAKERS)
def test_ids_models_and_limits_are_the_makers_or_tighter(name: str) -> None:
    robot, maker = load_robot(name), MAKERS[name]
    _, table = facts(name)
    by_id = {j["id"]: j for j in table.values() if "id" in j}
    for servo in robot.servos:
        fact = by_id[servo.servo_id]
        assert servo.model.name[:5] in fact["servo"].replace("DYNAMIXEL-Y ", "").replace("DYNAMIXEL-P 42", "PH42-"), (
            fact
        )
        if servo.linkage is not None or len(servo.couplings) > 1:
            continue
        joint = robot.joints[servo.couplings[0][0]]
        sign = servo.direction if "drives" in fact else 1.0  # a figure of a joint's turn is not one of its range
        offset = maker.offset_deg.get(joint.name, 0.0)
        ends = np.rad2deg([joint.position_min_rad, joint.position_max_rad])
        low, high = sorted(sign * servo.gear_ratio * (ends - offset))
        assert low >= np.rad2deg(fact["lower"]) - 0.5, joint.name
        assert high <= np.rad2deg(fact["upper"]) + 0.5, joint.name


@pytest.mark.parametrize("name", list_robots())
def test_the_description_is_no_wider_than_the_file_and_poses_lie_inside(name: str) -> None:
    robot = load_robot(name)
    model = mujoco.MjModel.from_xml_path(str(robot.description_path))
    for joint in robot.joints:
        for q in (joint.rest_rad, joint.park_rad):
            assert joint.position_min_rad <= q <= joint.position_max_rad
        found = model.joint(joint.name)
        if model.jnt_limited[found.id]:
            assert joint.position_min_rad >= found.range[0] - 1e-6, joint.name
            assert joint.position_max_rad <= found.range[1] + 1e-6, joint.name


@pytest.mark.parametrize("name", list_robots())
def test_rest_and_park_hang_on_both_sides_alike_and_touch_nothing(name: str) -> None:
    retargeter = Retargeter(load_robot(name))
    robot = retargeter.robot
    for q in (robot.rest_rad, robot.park_rad):
        places = dict(
            zip(
                (p.name for p in retargeter.kinematics.key_points),
                retargeter.kinematics.places(q[None])[0],
                strict=True,
            )
        )
        for part in ("shoulder", "elbow", "wrist"):
            left, right = places[f"left_{part}"], places[f"right_{part}"]
            assert left == pytest.approx(right * [1, -1, 1], abs=2e-3), part
        if name != "op3":  # its arms of three joints hang a little wider
            assert places["left_wrist"][2] < places["left_elbow"][2] < places["left_shoulder"][2]
        assert retargeter.contact.pairs(q) == []


TEXTS = ("wave with your right hand", "clap your hands three times", "bow", "raise your left arm", "nod twice")


@pytest.fixture(scope="module")
def gestures(engine: Engine) -> dict[str, Motion]:
    return {text: engine.generate(text, seed=1).motion for text in TEXTS}


@pytest.mark.parametrize("name", few_and_long(["reference", "poppy_torso"], list_robots()))
def test_the_shipped_models_gestures_keep_every_limit_and_touch_nothing(name: str, gestures: dict[str, Motion]) -> None:
    r = Retargeter(load_robot(name))
    for text, motion in gestures.items():
        path = r.retarget(motion, at_rest(r))
        for rate_hz in RATES_HZ:
            check_bounds(path, at_rest(r), r, rate_hz)
        assert not r.contact.frames(path.at_rate(100.0)).any(), text


@pytest.mark.parametrize("kind", few_and_long(["teleport"], ["noise", "teleport"]))
@pytest.mark.parametrize("name", few_and_long(["reference", "op3"], list_robots()))
def test_arms_that_do_anything_at_all_keep_every_limit_and_touch_nothing(name: str, kind: str) -> None:
    r = Retargeter(load_robot(name))
    path = r.retarget(random_motion(3, 40, kind), at_rest(r))
    for rate_hz in RATES_HZ:
        check_bounds(path, at_rest(r), r, rate_hz)
    assert not r.contact.frames(path.at_rate(100.0)).any()


@pytest.mark.parametrize("name", [n for n in list_robots() if n not in ("op2", "op3")])
def test_a_raised_arm_is_raised_where_the_arm_has_the_joints_for_it(name: str, gestures: dict[str, Motion]) -> None:
    """Against the human's own wrist, by our kinematics: the highest the left hand gets is well above its shoulder."""
    r = Retargeter(load_robot(name))
    path = r.retarget(gestures["raise your left arm"], at_rest(r))
    places = r.kinematics.places(path.q_rad)
    names = [p.name for p in r.kinematics.key_points]
    left, right = (
        places[:, names.index(f"{s}_wrist"), 2] - places[:, names.index(f"{s}_shoulder"), 2] for s in ("left", "right")
    )
    reach = np.linalg.norm(places[0, names.index("left_wrist")] - places[0, names.index("left_elbow")])
    assert left.max() > reach
    assert right.max() < 0


def robots_with(model: str) -> list[RobotModel]:
    return [r for r in map(load_robot, list_robots()) if any(s.model.name == model for s in r.servos)]


def test_what_ships_covers_every_kind_of_drive() -> None:
    servos = [s for name in list_robots() for s in load_robot(name).servos]
    assert any(s.linkage is not None for s in servos)
    assert any(len(s.couplings) == 2 for s in servos)
    assert any(s.gear_ratio != 1 for s in servos)
    assert {s.model.protocol for s in servos} == {1.0, 2.0}
    assert {s.model.ticks_per_turn for s in servos} >= {4096, 1227.6, 524288}
    assert len({s.model.ticks_per_turn for s in robots_with("AX-12A")[0].servos}) == 2, "two resolutions on one bus"
