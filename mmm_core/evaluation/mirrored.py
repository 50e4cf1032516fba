"""Measures whether a mirrored prompt gives the mirrored motion: angles between limbs of one and of the other's mirror image."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from mmm_core.language.mirroring import mirror_words
from mmm_core.motion.motion import Motion
from mmm_core.motion.skeleton import MIRROR, PARENTS, Array, matrix_from_quat

UPPER = (3, 6, 9, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21)
"""Joints at the ends of the bones of trunk, neck and arms (HumanML3D's order)."""
_FLIP_X = np.array([-1.0, 1.0, 1.0])


def limb_angles_deg(a: Motion, b: Motion) -> Array:
    """(T, bones + 1) degrees between the upper body's bones, and the head, of `a` mirrored and of `b`.

    Raises:
        ValueError: the motions have no frames, or different numbers of frames.
    """
    if not len(a.joints_m) or len(a.joints_m) != len(b.joints_m):
        raise ValueError(
            f"motions of {len(a.joints_m)} and {len(b.joints_m)} frames; expected as many, and at least one"
        )
    mirrored = a.joints_m[:, list(MIRROR)].astype(np.float64) * _FLIP_X
    ones, others = (_bones(joints) for joints in (mirrored, b.joints_m.astype(np.float64)))
    sine = np.linalg.norm(np.cross(ones, others), axis=-1)
    angles = np.rad2deg(np.arctan2(sine, (ones * others).sum(-1)))
    turned = matrix_from_quat(a.head_quat_wxyz.astype(np.float64)) * np.outer(_FLIP_X, _FLIP_X)
    between = np.swapaxes(turned, -1, -2) @ matrix_from_quat(b.head_quat_wxyz.astype(np.float64))
    head = np.rad2deg(2 * np.arcsin(np.clip(np.linalg.norm(between - np.eye(3), axis=(1, 2)) / np.sqrt(8), 0, 1)))
    return np.concatenate([angles, head[:, None]], 1)


def _bones(joints: Array) -> Array:
    bones = np.stack([joints[:, j] - joints[:, PARENTS[j]] for j in UPPER], 1)
    return bones / np.linalg.norm(bones, axis=-1, keepdims=True)


def mirrored_figures(
    generate: Callable[[str, int], Motion], texts: Sequence[str], seeds: Sequence[int]
) -> dict[str, Any]:
    """RMS angle in degrees over texts that name a side; 180 for a pair of different lengths, or with one text refused."""
    rms: list[float] = []
    for text in texts:
        other = mirror_words(text)
        if other == text:
            continue
        for seed in seeds:
            a, b = generate(text, seed), generate(other, seed)
            if len(a.joints_m) != len(b.joints_m):
                rms.append(180.0)
            elif len(a.joints_m):
                rms.append(float(np.sqrt(np.square(limb_angles_deg(a, b)).mean())))
    if not rms:
        return {"n": 0}
    worst, mean = max(rms), float(np.sqrt(np.square(rms).mean()))
    return {"n": len(rms), "rms_deg": round(mean, 3), "worst_rms_deg": round(worst, 3)}
