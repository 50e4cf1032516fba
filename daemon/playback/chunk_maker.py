"""Turns poses of a person into joint paths of the robot, chunk by chunk: layers, fade from the poses before, retargeting."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from daemon.playback.trajectory import Chunk
from daemon.poses.layers import Layers
from daemon.poses.pose_sequence import PoseSequence, distance_deg, faded_in, poses_of_joints, standing
from mmm_core.motion.motion import FPS
from retarget.human.human import read_human
from retarget.path.paths import JointState
from retarget.pipeline import BLOCK_FRAMES, Retargeter
from retarget.robot.robot import RobotModel
from retarget.robot_to_human import joints_of_path

FADE_FRAMES = 8
"""Number of pose frames (0.4 s) over which a motion is blended out of the poses before it, unless these are near or far."""
_LEAST_FADE_FRAMES, _FADE_DEG_PER_FRAME = 3, 4.0
"""Frames of the shortest blend, and degrees between the poses for each further frame: where the two are near, as after idle
movements, a long blend would only delay the motion's visible beginning."""
_FAR_DEG, _FAR_DEG_PER_FRAME = 60.0, 15.0
"""Degrees between the poses from which on `FADE_FRAMES` are too few, and degrees for each further frame: a longer way in the same
time would be more jerky than a person's movement (`mmmd bench seams`)."""
_LEAST_BLOCK, _MOST_BLOCK = 12, 36
"""Frames of a block: with fewer, limits would be kept with less of the motion in view, with more the first takes longer."""
_WHOLE = 1e-9
_EASY_DEG_S = 60.0
"""Degrees a second at most with which idle movements lead back to standing."""


def block_frames(fps: float, rate_hz: float) -> int | None:
    """Frames of a block that ends with a frame of the bus, the number nearest to the retargeter's own; None where there is none."""
    for n in sorted(range(_LEAST_BLOCK, _MOST_BLOCK + 1), key=lambda n: abs(n - BLOCK_FRAMES)):
        frames = n / fps * rate_hz
        if abs(frames - round(frames)) < _WHOLE:
            return n
    return None


def blended_from(before: PoseSequence, posture: PoseSequence, *, easy: bool = False) -> PoseSequence:
    """`posture` with its first frames blended from the poses that would have followed, `before`; more slowly when `easy`."""
    far_deg = float(distance_deg(before, posture.at(np.zeros(len(before), np.intp))).max())
    if easy:
        n = max(FADE_FRAMES, math.ceil(far_deg / _EASY_DEG_S * posture.fps))
    else:
        n = min(FADE_FRAMES, _LEAST_FADE_FRAMES + math.ceil(far_deg / _FADE_DEG_PER_FRAME))
        n += max(0, math.ceil((far_deg - _FAR_DEG) / _FAR_DEG_PER_FRAME))
    return faded_in(posture, before, n)


class ChunkMaker:
    """Makes the chunks of one robot, one at a time; `next` on them runs in a worker thread.

    Args:
        robot: the robot.
        layers: gaze to apply.
    """

    def __init__(self, robot: RobotModel, layers: Layers) -> None:
        self._layers, self._retargeter, self._rate_hz = layers, Retargeter(robot), robot.bus.rate_hz

    def chunks(
        self,
        raw: PoseSequence,
        start: JointState,
        before: PoseSequence | None,
        *,
        complete: bool,
        easy: bool = False,
        first_at_once: bool = False,
    ) -> Iterator[Chunk]:
        """Yield the joint path of poses, chunk by chunk.

        Args:
            raw: poses without layers.
            start: position and velocity of the joints at the beginning.
            before: poses from which the first ones are blended in; None where `raw` continues the path by itself.
            complete: whether the trajectory ends, at rest, with these poses.
            easy: whether to blend out of `before` slowly.
            first_at_once: whether the first chunk is needed at once; see `Retargeter.pieces`.

        Raises:
            MotionError: the motion cannot be retargeted.
        """
        posture = self._layers.over(raw)
        if before is not None and len(posture):
            posture = blended_from(before, posture, easy=easy)
        first, n = 0, block_frames(posture.fps, self._rate_hz)
        if n is None:
            paths = iter([(self._retargeter.retarget(posture, start, settle=complete), len(posture))])
        else:
            paths = self._retargeter.pieces(
                posture, start, settle=complete, first_at_once=first_at_once, block_frames=n
            )
        for path, n in paths:
            is_last = first + n >= len(posture)
            yield Chunk(path, posture[first:], raw[first:], is_last, is_last and complete)
            first += n

    def gaze_rad(self) -> dict[int, float]:
        """Angles of the head's joints, radians by index, that show the gaze that is set; empty without one."""
        if self._layers.gaze_deg is None:
            return {}
        q_rad = self._retargeter.solve(read_human(self._layers.over(standing())))[0]
        joints = enumerate(self._retargeter.robot.joints)
        return {j: float(q_rad[j]) for j, joint in joints if joint.role.startswith("head")}

    def person(self, q_rad: NDArray[np.float64]) -> PoseSequence:
        """One frame of a person in the pose (J,) of the robot."""
        joints, head = joints_of_path(self._retargeter.kinematics, q_rad[None])
        return poses_of_joints(joints, head, np.zeros((1, 2)), FPS)
