"""Laws of retargeting, for any motion: bounds at every rate, no self-contact, mirrors, joins, the same bits."""

from __future__ import annotations

import json
import re
from pathlib import Path

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_motions import mirrored, random_motion, real_motions

from mmm_core.motion.motion import Motion
from retarget.errors import MotionError
from retarget.path.limits import limit_step
from retarget.path.paths import JointPath, JointState
from retarget.pipeline import BLOCK_FRAMES, Retargeter
from retarget.robot.kinematics import Kinematics
from retarget.robot.loading import load_robot
from tests.support.robots import ByName, packaged
from tests.support.sizes import examples, few_and_long

RETARGETERS = ByName(("reference", "op3"), lambda name: Retargeter(packaged(name)))
kinds = st.sampled_from(["noise", "teleport", "smooth"])
robots = st.sampled_from(sorted(RETARGETERS))
RATES_HZ = (20.0, 100.0, 125.0, 200.0)


def check_bounds(path: JointPath, start: JointState, r: Retargeter, rate_hz: float) -> None:
    period, limits = 1 / rate_hz, r.limits
    q = np.concatenate(
        [(start.position_rad - start.velocity_rad_s * period)[None], start.position_rad[None], path.at_rate(rate_hz)]
    )
    assert (q[2:] >= limits.position_min_rad - 1e-12).all()
    assert (q[2:] <= limits.position_max_rad + 1e-12).all()
    assert (np.abs(np.diff(q, axis=0)) <= limits.velocity_rad_s * period * (1 + 1e-7)).all()
    bend = np.abs(np.diff(q, n=2, axis=0))
    assert (bend <= limits.acceleration_rad_s2 * period**2 * (1 + 1e-6) + 1e-12).all()


def at_rest(r: Retargeter) -> JointState:
    return JointState(r.robot.rest_rad, np.zeros(r.robot.n_joints))


@settings(max_examples=examples(12))
@given(robots, st.integers(0, 10_000), kinds, st.integers(1, 60))
def test_no_bound_is_passed_at_any_rate_and_the_path_ends_at_rest(name: str, seed: int, kind: str, T: int) -> None:
    r = RETARGETERS[name]
    path = r.retarget(random_motion(seed, T, kind), at_rest(r))
    for rate_hz in RATES_HZ:
        check_bounds(path, at_rest(r), r, rate_hz)
    assert not path.velocity_at(np.array([path.duration_s])).any()


@settings(max_examples=examples(8))
@given(robots, st.integers(0, 10_000), kinds)
def test_the_daemons_gate_passes_the_path_bit_for_bit(name: str, seed: int, kind: str) -> None:
    r = RETARGETERS[name]
    path = r.retarget(random_motion(seed, 30, kind), at_rest(r)).at_rate(r.robot.bus.rate_hz)
    position, velocity = r.robot.rest_rad, np.zeros(r.robot.n_joints)
    for q in path:
        goal = limit_step(q, position, velocity, r.limits, r.robot.bus.period_s)
        assert np.array_equal(goal, q)
        position, velocity = goal, (goal - position) / r.robot.bus.period_s


@settings(max_examples=examples(8))
@given(robots, st.integers(0, 10_000), st.integers(1, 50))
def test_a_take_over_joins_in_position_and_velocity(name: str, seed: int, at: int) -> None:
    r = RETARGETERS[name]
    first = r.retarget(random_motion(seed, 40, "smooth"), at_rest(r))
    t_s = np.array([min(at / 100, first.duration_s)])
    state = JointState(first.at(t_s)[0], first.velocity_at(t_s)[0])
    second = r.retarget(random_motion(seed + 1, 30, "noise"), state)
    assert np.allclose(second.at(np.array([0.0]))[0], state.position_rad)
    assert np.allclose(second.velocity_at(np.array([0.0]))[0], state.velocity_rad_s)
    for rate_hz in RATES_HZ:
        check_bounds(second, state, r, rate_hz)


@settings(max_examples=examples(6))
@given(robots, st.integers(0, 10_000), kinds)
def test_no_emitted_frame_touches_itself_by_mujocos_own_check(name: str, seed: int, kind: str) -> None:
    """MuJoCo's contacts on a model of its own; pairs two joints apart overlap by design and are left out."""
    r = RETARGETERS[name]
    model = mujoco.MjModel.from_xml_path(str(r.robot.description_path))
    data = mujoco.MjData(model)
    address = [model.joint(n).qposadr[0] for n in r.robot.joint_names]
    parent = model.body_parentid

    def near(a: int, b: int) -> bool:
        above = {a: {parent[a], parent[parent[a]]}, b: {parent[b], parent[parent[b]]}}
        return a in above[b] or b in above[a] or parent[a] == parent[b]

    def touching(q: np.ndarray) -> set[tuple[int, int]]:
        data.qpos[address] = q
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)
        bodies = [tuple(sorted(model.geom_bodyid[list(c.geom)])) for c in data.contact if c.dist < 0]
        return {pair for pair in bodies if not near(*pair)}

    resting = touching(r.robot.rest_rad)
    for q in r.retarget(random_motion(seed, 25, kind), at_rest(r)).at_rate(100.0)[::2]:
        assert touching(q) <= resting


@settings(max_examples=examples(6))
@given(st.integers(0, 10_000))
def test_the_mirrored_motion_gives_the_mirrored_path(seed: int) -> None:
    r = RETARGETERS["reference"]
    m = random_motion(seed, 25, "smooth")
    plain, other = r.retarget(m).q_rad, r.retarget(mirrored(m)).q_rad
    names = list(r.robot.joint_names)
    for j, name in enumerate(names):
        side, _, part = name.partition("_")
        swap = {"left": "right", "right": "left"}.get(side)
        k = names.index(f"{swap}_{part}") if swap else j
        sign = -1.0 if name in ("head_yaw", "waist_yaw") else 1.0
        assert np.abs(plain[:, j] - sign * other[:, k]).max() < 0.02, name


def test_the_same_motion_gives_the_same_bits() -> None:
    m = random_motion(5, 30, "noise")
    for name in RETARGETERS:
        a, b = (Retargeter(load_robot(name)).retarget(m).control_rad for _ in range(2))
        assert np.array_equal(a, b)


@pytest.mark.parametrize("name", sorted(RETARGETERS))
def test_forward_kinematics_is_mujocos(name: str) -> None:
    robot = load_robot(name)
    kinematics = Kinematics(robot)
    model = mujoco.MjModel.from_xml_path(str(robot.description_path))
    data = mujoco.MjData(model)
    rng = np.random.default_rng(0)
    q = rng.uniform(robot.position_min_rad, robot.position_max_rad, (20, robot.n_joints))
    places = kinematics.places(q)
    for t in range(len(q)):
        data.qpos[[model.joint(n).qposadr[0] for n in robot.joint_names]] = q[t]
        mujoco.mj_kinematics(model, data)
        for k, point in enumerate(kinematics.key_points):
            if point.name in ("left_wrist", "right_wrist", "head", "chest"):
                assert np.allclose(places[t, k], data.site(point.name).xpos, atol=1e-9), point.name


def test_recorded_motion_keeps_its_directions_on_a_robot_that_can() -> None:
    motions = real_motions()
    errors = [RETARGETERS["reference"].retarget(m).report.direction_mean_deg for m in motions.values()]
    assert np.median(errors) < 8.0, errors


def test_motions_that_cannot_be_retargeted_are_named() -> None:
    r, good = RETARGETERS["reference"], random_motion(0, 3, "smooth")
    fields = {f: getattr(good, f) for f in good.__dataclass_fields__}
    collapsed = np.array(good.joints_m)
    collapsed[:, 18] = collapsed[:, 16]
    with pytest.raises(MotionError, match=r"left upper arm.*bone of 0\.0000 m in frame 0"):
        r.retarget(Motion(**(fields | {"joints_m": collapsed})))
    empty = {k: fields[k][:0] for k in ("joints_m", "head_quat_wxyz", "forearm_twist_rad", "features")}
    with pytest.raises(MotionError, match="no frames"):
        r.retarget(Motion(**(fields | empty)))


def test_the_command_writes_every_field(tmp_path: Path) -> None:
    from daemon.cli import main

    m = random_motion(3, 30, "smooth")
    m.save_npz(tmp_path / "in.npz")
    assert (
        main(["retarget", str(tmp_path / "in.npz"), "--robot", "op3", "--out", str(tmp_path / "out.npz"), "--json"])
        == 0
    )
    with np.load(tmp_path / "out.npz") as out:
        T, robot = len(out["q_rad"]), load_robot("op3")
        assert out["q_rad"].shape == (T, 8)
        assert tuple(out["joint_names"]) == robot.joint_names
        assert out["ticks"].shape == (T, 8)
        assert out["servo_ids"].tolist() == list(robot.servo_ids)
        assert out["keypoints"].shape == (T, 8, 3)
        wanted = {f"{s}_{p}" for s in ("left", "right") for p in ("shoulder", "elbow", "wrist")} | {"head", "chest"}
        assert set(out["keypoint_names"]) == wanted
        assert out["head_quat_wxyz"].shape == (T, 4)
        assert (float(out["rate_hz"]), str(out["up_axis"])) == (20.0, "z")
        assert "direction_mean_deg" in json.loads(str(out["report"]))


def test_the_command_names_a_file_it_cannot_use(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from daemon.cli import main

    assert main(["retarget", str(tmp_path / "none.npz"), "--out", str(tmp_path / "out.npz")]) == 2
    assert "no such file" in capsys.readouterr().err
    np.savez(tmp_path / "bad.npz", joints=np.zeros((4, 21, 3)), fps=20.0)
    assert main(["retarget", str(tmp_path / "bad.npz"), "--out", str(tmp_path / "out.npz")]) == 2
    assert "(T, 22, 3)" in capsys.readouterr().err
    (tmp_path / "text.npz").write_text("a note")
    assert main(["retarget", str(tmp_path / "text.npz"), "--out", str(tmp_path / "out.npz")]) == 2
    assert "not even a zip archive" in capsys.readouterr().err
    assert not (tmp_path / "out.npz").exists()


BAD_MOTIONS = [
    ("fps", {"fps": 0.5}, "1 to 1000"),
    ("fps", {"fps": float("inf")}, "1 to 1000"),
    ("centimetres", {"joints_m": lambda j: j * 100}, "bones of 0.02 to 0.6 m"),
    ("another order", {"joints_m": lambda j: np.roll(j, 4, axis=1)}, "HumanML3D's order"),
    ("joints shuffled", {"joints_m": lambda j: j[:, ::-1]}, "HumanML3D's order"),
    (
        "an arm of another size",
        {"joints_m": lambda j: _with(j, 18, j[:, 16] + 2.2 * (j[:, 18] - j[:, 16]))},
        "one person",
    ),
    ("a point", {"joints_m": lambda j: j * 0}, "0.0000 m"),
    ("hips in one place", {"joints_m": lambda j: _with(j, 1, j[:, 2])}, "hips"),
]


def _with(joints: np.ndarray, j: int, value: np.ndarray) -> np.ndarray:
    changed = joints.copy()
    changed[:, j] = value
    return changed


@pytest.mark.parametrize(("change", "said"), [pytest.param(c, s, id=n) for n, c, s in BAD_MOTIONS])
def test_what_is_no_human_is_named(change: dict[str, object], said: str) -> None:
    good = random_motion(0, 30, "smooth")
    fields = {f: getattr(good, f) for f in good.__dataclass_fields__}
    fields |= {k: v(fields[k]) if callable(v) else v for k, v in change.items()}
    with pytest.raises(MotionError) as caught:
        RETARGETERS["reference"].retarget(Motion(**fields))
    assert said in str(caught.value), str(caught.value)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_motion_with_a_value_that_is_none_is_never_made(bad: float) -> None:
    good = random_motion(0, 30, "smooth")
    joints = good.joints_m.copy()
    joints[3, 20, 1] = bad
    with pytest.raises(ValueError, match="finite"):
        Motion(**({f: getattr(good, f) for f in good.__dataclass_fields__} | {"joints_m": joints}))


def test_one_frame_is_a_path() -> None:
    for r in RETARGETERS.values():
        path = r.retarget(random_motion(4, 1, "noise"), at_rest(r))
        check_bounds(path, at_rest(r), r, 200.0)


BAD_FILES = [
    ("no fps", {"fps": None}, "fps"),
    ("fps of nothing", {"fps": 0.0}, "fps"),
    ("not a number", {"joints": lambda j: _with(j, 20, np.full_like(j[:, 20], np.nan))}, "'joints'.*NaN.*frame 0, 30"),
    (
        "infinite",
        {"joints": lambda j: np.where(np.arange(30)[:, None, None] == 7, np.inf, j)},
        "'joints'.*frame 7, 1 such",
    ),
    ("words", {"joints": lambda j: np.full(j.shape, "left")}, "'joints'.*numbers"),
    ("a joint short", {"joints": lambda j: j[:, :21]}, r"22, 3"),
    ("empty", {"joints": lambda j: j[:0]}, "T >= 1"),
    ("no length", {"joints": lambda j: _with(j, 20, j[:, 18])}, "left forearm"),
    ("arms of a giant", {"joints": lambda j: 4 * j}, "0.6 m"),
]


@pytest.mark.parametrize(("change", "said"), [pytest.param(c, s, id=n) for n, c, s in BAD_FILES])
def test_a_bad_file_is_named_with_its_key(
    change: dict[str, object], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from daemon.cli import main

    fields: dict[str, object] = {"joints": random_motion(0, 30, "smooth").joints_m, "fps": 20.0}
    fields |= {k: v(fields[k]) if callable(v) else v for k, v in change.items()}
    np.savez(tmp_path / "bad.npz", **{k: np.asarray(v) for k, v in fields.items() if v is not None})
    assert main(["retarget", str(tmp_path / "bad.npz"), "--out", str(tmp_path / "out.npz")]) == 2
    error = capsys.readouterr().err
    assert re.search(said, error) and str(tmp_path / "bad.npz") in error and "Traceback" not in error, error
    assert not (tmp_path / "out.npz").exists()


@pytest.mark.parametrize("settle", [True, False])
@pytest.mark.parametrize("frames", few_and_long([1, 20], [33, 75, 160]))
def test_the_pieces_of_a_path_are_the_path(frames, settle):
    retargeter, whole = Retargeter(load_robot("reference")), random_motion(4, frames, "smooth")
    start = JointState(retargeter.robot.rest_rad, np.zeros(retargeter.robot.n_joints))
    path = retargeter.retarget(whole, start, settle=settle)
    pieces = list(retargeter.pieces(whole, start, settle=settle))
    assert sum(n for _, n in pieces) == frames
    assert all(n == BLOCK_FRAMES for _, n in pieces[:-1])
    np.testing.assert_allclose(
        np.concatenate([p.at_rate(100) for p, _ in pieces]), path.at_rate(100), rtol=0, atol=1e-9
    )
