"""Laws for every packaged robot: chunks that join, stops, long motions in blocks, time shifts; checked by MuJoCo alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from random_motions import random_motion

from daemon.bench.contacts import ContactCheck
from daemon.bench.motions import cut
from mmm_core.motion.motion import Motion
from retarget.human.human import read_human
from retarget.path.paths import JointState
from retarget.pipeline import BLOCK_FRAMES, Retargeter
from retarget.robot.loading import list_robots
from retarget.robot_to_human import joints_of_path
from tests.retarget.test_pipeline import at_rest, check_bounds
from tests.support.robots import ByName, packaged
from tests.support.sizes import examples, few_and_long

RETARGETERS = ByName(list_robots(), lambda name: Retargeter(packaged(name)))
CHECKS = ByName(list_robots(), lambda name: ContactCheck(packaged(name)))
names = st.sampled_from(list(RETARGETERS))
kinds = st.sampled_from(["noise", "teleport", "smooth"])


def end_of(path) -> JointState:
    at = np.array([path.duration_s])
    return JointState(path.at(at)[0], path.velocity_at(at)[0])


@settings(max_examples=examples(14))
@given(names, st.integers(0, 10_000), kinds)
def test_chunks_join_keep_every_bound_and_touch_nothing(name: str, seed: int, kind: str) -> None:
    """As a stream comes: each chunk knows only itself, and may be the last; then the robot brakes."""
    r, check = RETARGETERS[name], CHECKS[name]
    motion, state = random_motion(seed, 45, kind), at_rest(r)
    for start, end in ((0, 20), (20, 21), (21, 41), (41, 45)):
        path = r.retarget(cut(motion, start, end), state, settle=False)
        for rate_hz in (20.0, 200.0):
            check_bounds(path, state, r, rate_hz)
        assert check.frames(path.at_rate(100.0)[::3]) == 0
        state = end_of(path)
    stopped = r.retarget(cut(motion, 44, 45), state)
    check_bounds(stopped, state, r, 200.0)
    assert check.frames(stopped.at_rate(100.0)[::3]) == 0
    assert not end_of(stopped).velocity_rad_s.any()


@pytest.mark.long
@settings(max_examples=examples(7))
@given(names, st.integers(0, 10_000), kinds)
def test_a_long_motion_keeps_every_bound_across_its_blocks(name: str, seed: int, kind: str) -> None:
    r = RETARGETERS[name]
    path = r.retarget(random_motion(seed, 90, kind), at_rest(r))
    assert len(path.control_rad) >= 92
    for rate_hz in (20.0, 200.0):
        check_bounds(path, at_rest(r), r, rate_hz)
    assert CHECKS[name].frames(path.at_rate(100.0)[::4]) == 0


@pytest.mark.long
@settings(max_examples=examples(7))
@given(names, st.integers(0, 10_000), kinds)
def test_a_first_piece_at_once_keeps_every_bound_and_touches_nothing(name: str, seed: int, kind: str) -> None:
    """It is not made better where contacts are near; the pieces after it go on from it."""
    r, motion = RETARGETERS[name], random_motion(seed, 60, kind)
    state = at_rest(r)
    for path, _ in r.pieces(motion, state, first_at_once=True):
        for rate_hz in (20.0, 200.0):
            check_bounds(path, state, r, rate_hz)
        assert CHECKS[name].frames(path.at_rate(100.0)[::3]) == 0
        state = end_of(path)
    assert not state.velocity_rad_s.any()


HOLD_BLOCKS = 4
"""Blocks for which the first frame is held: what comes from the rest pose, and slow robots, have arrived in most motions then."""
NEARLY_RAD, SAME_RAD = 1e-7, 2e-5
"""How near to one place a hold brings a robot, and how near its paths then stay, a seventieth of a tick: near contacts the first
grows by up to a hundred times."""


def held_before(motion: Motion, n: int) -> Motion:
    """The motion after `n` frames in which its first frame is held."""
    fields = {f: getattr(motion, f) for f in motion.__dataclass_fields__}
    for key in ("joints_m", "head_quat_wxyz", "forearm_twist_rad", "features"):
        fields[key] = np.concatenate([np.repeat(fields[key][:1], n, 0), fields[key]])
    return Motion(**fields)


@pytest.mark.parametrize(
    ("name", "at_least"),
    [
        *(pytest.param(name, 3, marks=pytest.mark.long) for name in ("reference", "op3")),
        *(pytest.param(name, 12, marks=pytest.mark.soak) for name in RETARGETERS),
    ],
)
def test_shifting_time_shifts_the_path_whatever_the_motion(name: str, at_least: int) -> None:
    """Limits, contacts and interventions included: held for a block more, the same path comes that much later.

    Left out are motions whose hold does not bring the robot to one place: joints that hardly show still come from the
    rest pose, or the robot is too slow to have arrived. It ends when `at_least` were compared.
    """
    r, compared = RETARGETERS[name], 0
    for seed in range(6):
        for kind in ("smooth", "teleport") if compared < at_least else ():
            motion = random_motion(seed, 50, kind)
            held = HOLD_BLOCKS * BLOCK_FRAMES
            before, after = held_before(motion, held), held_before(motion, held + BLOCK_FRAMES)
            wanted, wanted_late = (r.poses(read_human(m)).q_rad[held:] for m in (before, after))
            early, late = r.retarget(before).q_rad, r.retarget(after).q_rad[BLOCK_FRAMES:]
            arrived = slice(held - 2, held)
            start_off_rad = np.abs(late[arrived] - early[arrived]).max()
            if start_off_rad < NEARLY_RAD and np.abs(wanted_late[BLOCK_FRAMES:] - wanted).max() < 1e-7:
                path = slice(held, held + 50)
                np.testing.assert_allclose(late[path], early[path], rtol=0, atol=SAME_RAD)
                compared += 1
    assert compared >= 3


@settings(max_examples=examples(6))
@given(st.integers(0, 10_000), st.integers(1, 30))
def test_a_gentle_motion_may_be_shifted_by_any_time(seed: int, shift: int) -> None:
    """Within the limits it does not matter where blocks begin: elbows, wrists and head are where they were, to half a mm."""
    r = RETARGETERS["reference"]
    rng = np.random.default_rng(seed)
    keys = np.cumsum(rng.uniform(-0.12, 0.12, (12, r.robot.n_joints)), 0)
    at = np.arange(60)[:, None] / 6
    k = np.minimum(at.astype(int)[:, 0], 9)
    a, b, c, u = keys[k], keys[k + 1], keys[k + 2], at - k[:, None]
    q = r.robot.rest_rad + (a + b) / 2 + (b - a) * u + (c - 2 * b + a) * u * u / 2
    joints, head = joints_of_path(r.kinematics, np.clip(q, r.limits.position_min_rad, r.limits.position_max_rad))
    still = random_motion(0, 60, "smooth")
    motion = replace(
        still, joints_m=joints.astype(np.float32), head_quat_wxyz=head.astype(np.float32),
        forearm_twist_rad=np.zeros((60, 2), np.float32),
    )  # fmt: skip
    motion = held_before(motion, 24)  # before that, joints that hardly show come from the rest pose
    early, late = r.retarget(motion), r.retarget(held_before(motion, shift))
    assume(max(early.report.peak_speed_share, early.report.peak_acceleration_share) < 0.95)
    assume(not early.report.interventions)
    n = len(motion.joints_m)
    end = n - 3  # in the last ones it comes to rest, in front of a joint's end wherever the block leaves room for it
    seen, seen_late = (
        r.kinematics.places(early.q_rad[24:end]),
        r.kinematics.places(late.q_rad[shift + 24 : shift + end]),
    )
    np.testing.assert_allclose(seen_late, seen, atol=5e-4)
    assert np.abs(np.diff(seen, axis=0)).max() > 5e-3  # one frame more or less would be seen


@pytest.mark.parametrize("name", few_and_long(["op3", "ffw_bg2"], list(RETARGETERS)))
def test_a_start_too_fast_or_outside_comes_back_inside(name: str) -> None:
    """Speed towards a position limit that no braking can hold: it is passed by as little as braking allows, and left."""
    r = RETARGETERS[name]
    position = r.limits.position_max_rad - 1e-3
    start = JointState(position, 0.5 * r.limits.velocity_rad_s)
    path = r.retarget(random_motion(1, 40, "smooth"), start)
    q = path.at_rate(100.0)
    assert (q[-1] <= r.limits.position_max_rad + 1e-9).all() and (q[-1] >= r.limits.position_min_rad - 1e-9).all()
    bend = np.abs(np.diff(q, n=2, axis=0))
    assert (bend <= r.limits.acceleration_rad_s2 * 1e-4 * (1 + 1e-6) + 1e-12).all()
