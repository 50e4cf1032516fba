"""Poses of a generated motion, with or without the small movements of `mmm_core.motion.life`."""

from __future__ import annotations

from dataclasses import replace

from daemon.poses.pose_sequence import PoseSequence, posture_of
from mmm_core.language.mirroring import canonical
from mmm_core.motion.life import alive
from mmm_core.motion.motion import Motion

SEED_STRIDE = 15_485_863
"""Distance between the seeds of a story's scenes."""


class Aliveness:
    """Makes poses of motions.

    Args:
        on: whether trunk and head move along with the arms.
    """

    def __init__(self, on: bool) -> None:
        self._on = on

    def posture_of(self, motion: Motion, piece: int = 0) -> PoseSequence:
        """The poses of a generated motion; `piece` is the index of the scene in a story.

        A preview and its motion begin alike, and a text's mirror image gives the mirrored poses.
        """
        if not self._on:
            return posture_of(motion)
        seeded = replace(motion, seed=(motion.seed + piece * SEED_STRIDE) % 2**31) if piece else motion
        return posture_of(alive(seeded, is_mirrored=canonical(motion.text)[1]))
