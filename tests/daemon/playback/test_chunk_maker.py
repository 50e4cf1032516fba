"""Chunks of a motion at any rate of the bus."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from daemon.playback.chunk_maker import FADE_FRAMES, ChunkMaker, blended_from, block_frames
from daemon.poses.layers import Layers
from daemon.poses.pose_sequence import PoseSequence, distance_deg, posture_of
from retarget.path.limits import JointLimits
from retarget.path.paths import JointState
from retarget.pipeline import BLOCK_FRAMES
from tests.support.kinematic import raised_arm
from tests.support.robots import packaged

REFERENCE = packaged("reference")


@pytest.mark.parametrize(
    ("rate_hz", "frames"), [(100, BLOCK_FRAMES), (60, BLOCK_FRAMES), (33, 20), (48, 25), (77.7, None)]
)
def test_a_block_ends_with_a_frame_of_the_bus(rate_hz: float, frames: int | None) -> None:
    assert block_frames(20, rate_hz) == frames


def test_a_bus_of_an_odd_rate_gets_its_first_chunk_as_soon() -> None:
    """33 cycles a second and blocks of 1.2 s: such a robot waited until the whole motion was retargeted.

    Blocks of a second fit. One chunk goes on from the other within the limits, as the bus sends them.
    """
    robot = replace(REFERENCE, bus=replace(REFERENCE.bus, rate_hz=33))
    posture = posture_of(raised_arm("right", 4.0, 1.0, "right"))
    start = JointState(robot.rest_rad, np.zeros(robot.n_joints))
    chunks = list(ChunkMaker(robot, Layers("off")).chunks(posture, start, None, complete=True, first_at_once=True))
    assert len(chunks) >= 3
    lengths = [chunk.path.duration_s * 33 for chunk in chunks[:-1]]
    np.testing.assert_allclose(lengths, np.round(lengths), atol=1e-6)
    assert [chunk.is_last for chunk in chunks] == [False] * (len(chunks) - 1) + [True]
    goals = np.concatenate([robot.rest_rad[None], *(chunk.path.at_rate(33) for chunk in chunks)])
    limits = JointLimits.of(robot)
    assert (np.abs(np.diff(goals, axis=0)) <= limits.velocity_rad_s / 33 * (1 + 1e-6)).all()
    assert (np.abs(np.diff(goals, 2, axis=0)) <= limits.acceleration_rad_s2 / 33**2 * (1 + 1e-6) + 1e-9).all()


def blended_frames(before: PoseSequence, after: PoseSequence, *, easy: bool = False) -> int:
    """Number of frames that a blend changes."""
    changed = distance_deg(blended_from(before, after, easy=easy), after) > 1e-3
    return int(np.flatnonzero(changed)[-1]) + 2  # the last frame of a blend has the full weight of `after`


def test_the_farther_the_poses_the_longer_the_blend():
    """After idle movements, a few degrees from a motion's first pose, a long blend would hide the motion's beginning."""
    moving = posture_of(raised_arm("right", 4.0, 2.0, "right"))
    apart_deg = distance_deg(moving, moving.at(np.zeros(len(moving), np.intp)))
    near, far, farther = (int(np.argmax(apart_deg > deg)) for deg in (5.0, 30.0, 90.0))
    frames = [blended_frames(moving.at(np.full(FADE_FRAMES, at)), moving[:20]) for at in (near, far, farther)]
    assert 3 <= frames[0] < FADE_FRAMES == frames[1] < frames[2] <= FADE_FRAMES + 4
    assert blended_frames(moving.at(np.full(FADE_FRAMES, far)), moving[:20], easy=True) > FADE_FRAMES
