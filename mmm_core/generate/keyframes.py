"""Generates a motion through given poses at given times; the model makes the frames between them.

This is the in-betweening of MMM (arXiv 2312.03596, sec. 3.3) with poses instead of motions: at its time each pose becomes the
id of a person who stands still in the pose, and all other ids are [MASK]. Ids are coarse, so the motion passes a pose within
a few degrees; a caller that needs the exact pose bends the motion towards it afterwards (`daemon.poses.key_poses`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import torch
from torch import Tensor

from mmm_core.errors import GenerationError, TextRefusedError
from mmm_core.generate.editing import TOKEN_S
from mmm_core.generate.engine import Engine
from mmm_core.generate.motion_model import check_seed
from mmm_core.language.scope import ScopeVerdict
from mmm_core.model.sampling import empty_row, fill
from mmm_core.model.tokens import MAX_TOKENS, frames_for_seconds, tokens_for_frames
from mmm_core.motion.features import RestPose, features_from_joints
from mmm_core.motion.humanml3d_features import humanml3d_features_from_joints
from mmm_core.motion.motion import FPS, Motion
from mmm_core.motion.skeleton import matrix_from_quat

STILL_FRAMES = 24
"""Frames (1.2 s) for which a pose is held when the tokenizer encodes it; the middle token becomes the pose's id."""


@dataclass(frozen=True)
class Keyframe:
    """A pose and its time.

    Attributes:
        at_s: seconds from the motion's start.
        pose: a motion whose first frame is the pose.
    """

    at_s: float
    pose: Motion


def between(engine: Engine, keyframes: Sequence[Keyframe], text: str = "", *, seed: int = 0) -> Motion:
    """A motion that ends with the last keyframe and shows each pose at its time.

    Args:
        engine: the model.
        keyframes: poses in order of time, each in a token (0.2 s) of its own.
        text: a command for the frames between the poses; empty leaves them to the model.
        seed: any integer from 0 to 2^31 - 1.

    Raises:
        GenerationError: there is no keyframe, two lie in one token, a time is out of range, the text is rejected, or it is
            empty and the model was not trained without texts.
    """
    check_seed(seed)
    if not keyframes:
        raise GenerationError("a motion through no pose was asked for", "at least one keyframe")
    n_frames = frames_for_seconds(max(TOKEN_S, *(k.at_s for k in keyframes)), FPS)
    row = empty_row(engine.model.transformer, min(MAX_TOKENS, tokens_for_frames(n_frames)))
    taken: dict[int, float] = {}
    for key in keyframes:
        place = min(len(row) - 1, int(key.at_s / TOKEN_S + 1e-6))
        if key.at_s < 0 or place in taken:
            other = f" and another at {taken[place]:g} s" if place in taken else ""
            raise GenerationError(f"a pose at {key.at_s:g} s{other}", f"times from 0, at least {TOKEN_S} s apart")
        taken[place] = key.at_s
        row[place] = still_ids(engine, key.pose)
    for place in taken:  # a pose that is held for two tokens is met more surely (measured: 6 instead of 13 degrees)
        if place and place - 1 not in taken:
            row[place - 1] = row[place]
    states, verdict = engine.understand(text)
    if not text.strip():
        transformer = engine.model.transformer
        if not bool(transformer.no_words.any()):
            raise GenerationError("no text was given", "a text: this model knows no motion without one")
        states, verdict = transformer.no_text(1), ScopeVerdict("accepted", 1.0, "", "")
    elif verdict.status == "rejected":
        raise TextRefusedError(text, verdict.reason)
    if any((row == engine.model.transformer.ids.mask).flatten().tolist()):
        row = fill(engine.model.transformer, states, [row], [seed], engine.settings)[0]
    return engine.motion(row, text, seed, verdict, n_frames)


def still_ids(engine: Engine, pose: Motion) -> Tensor:
    """(C,) ids of a person who holds a pose."""
    features = features_of(pose, engine.model.rest_pose)[:1].repeat(STILL_FRAMES, 1)
    features[:, :3] = 0.0  # the root stays
    features[:, 193:259] = 0.0
    features[:, 259:263] = 1.0
    with torch.inference_mode():
        ids = engine.model.tokenizer.encode(features[None])[0]
    return ids[len(ids) // 2]


def features_of(motion: Motion, rest_pose: RestPose = "mmmd") -> Tensor:
    """(T, 263) features of a motion: its own, or else features computed from its joints, with the lowest joint on the floor.

    Computed features follow the definition of `rest_pose`: ours, or HumanML3D's.
    """
    if motion.features.any():
        return torch.from_numpy(motion.features.copy())
    joints = motion.joints_m.astype("float64")
    if rest_pose == "humanml3d":
        return torch.from_numpy(humanml3d_features_from_joints(joints))
    joints[..., 1] -= joints[..., 1].min()
    head = matrix_from_quat(motion.head_quat_wxyz.astype("float64"))
    return torch.from_numpy(features_from_joints(joints, head, motion.forearm_twist_rad.astype("float64")))
