"""Laws for every packaged robot: chunks that join, stops, long motions in blocks, time shifts; checked by MuJoCo alone."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_motions import random_motion
from test_pipeline import at_rest, check_bounds

from daemon.bench.contacts import ContactCheck
from daemon.bench.motions import cut
from retarget.paths import JointState
from retarget.pipeline import Retargeter
from retarget.robot import list_robots, load_robot

RETARGETERS = {name: Retargeter(load_robot(name)) for name in list_robots()}
CHECKS = {name: ContactCheck(r.robot) for name, r in RETARGETERS.items()}
names = st.sampled_from(list(RETARGETERS))
kinds = st.sampled_from(["noise", "teleport", "smooth"])


def end_of(path) -> JointState:
    at = np.array([path.duration_s])
    return JointState(path.at(at)[0], path.velocity_at(at)[0])


@settings(max_examples=14)
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


@settings(max_examples=7)
@given(names, st.integers(0, 10_000), kinds)
def test_a_long_motion_keeps_every_bound_across_its_blocks(name: str, seed: int, kind: str) -> None:
    r = RETARGETERS[name]
    path = r.retarget(random_motion(seed, 90, kind), at_rest(r))
    assert len(path.control_rad) >= 92
    for rate_hz in (20.0, 200.0):
        check_bounds(path, at_rest(r), r, rate_hz)
    assert CHECKS[name].frames(path.at_rate(100.0)[::4]) == 0


@settings(max_examples=6)
@given(st.integers(0, 10_000), st.integers(1, 30))
def test_shifting_time_shifts_the_path(seed: int, shift: int) -> None:
    """A gentle motion held for a while before it begins gives the same path, so much later."""
    r = RETARGETERS["reference"]
    keys = random_motion(seed, 6, "smooth")
    slow = np.interp(np.arange(60) / 30, np.arange(6), np.arange(6.0))
    low = slow.astype(int)
    share = (slow - low)[:, None, None].astype(np.float32)
    joints = keys.joints_m[low] * (1 - share) + keys.joints_m[low + 1] * share
    motion = cut(random_motion(seed, 60, "smooth"), 0, 60)
    fields = {f: getattr(motion, f) for f in motion.__dataclass_fields__} | {
        "joints_m": joints, "head_quat_wxyz": np.repeat(keys.head_quat_wxyz[:1], 60, 0),
        "forearm_twist_rad": np.zeros((60, 2), np.float32),
    }  # fmt: skip
    motion = type(motion)(**fields)
    held = type(motion)(**(fields | {
        k: np.concatenate([np.repeat(fields[k][:1], shift, 0), fields[k]])
        for k in ("joints_m", "head_quat_wxyz", "forearm_twist_rad", "features")
    }))  # fmt: skip
    first, later = r.retarget(motion), r.retarget(held)
    if first.report.interventions or max(first.report.peak_speed_share, first.report.peak_acceleration_share) > 0.9:
        return  # a bound was in play: which frames were in view then depends on where the blocks begin
    np.testing.assert_allclose(later.q_rad[shift : shift + 60], first.q_rad[:60], atol=0.01)


@pytest.mark.parametrize("name", list(RETARGETERS))
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
