"""Several cuts of a recording: other beginnings and ends, a little faster or slower, so that its ids are not learnt by heart.

A token covers four frames, so that a recording that begins a frame later has other ids. People's recordings are few, and a
transformer that sees each of them as one row of ids soon knows the rows.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mmm_core.model.tokens import FRAMES_PER_TOKEN
from mmm_core.motion.features import joints_of
from mmm_core.training.batches import Clip, cut_to_tokens

LATEST_FRAME = 7
"""Last frame that a cut may begin with."""
LEFT_OUT = 0.2
"""Largest share of a recording that a cut leaves out at its end."""
FASTEST = 1.15
"""Largest factor on a recording's speed; its inverse is the smallest one."""


def cuts_of(clip: Clip, n: int, generator: np.random.Generator) -> list[Clip]:
    """`n` cuts of a clip: first the clip itself, then varied ones of at least two tokens, all cut to whole tokens."""
    varied = [replace(clip, features=_varied(clip.features, generator)) for _ in range(n - 1)]
    whole = [one for one in varied if len(one.features) >= 2 * FRAMES_PER_TOKEN]
    return [cut_to_tokens(one, generator) for one in (clip, *whole)]


def at_speed(features: NDArray[np.float32], speed: float) -> NDArray[np.float32]:
    """Features (T, F) of the motion at `speed` times its speed: (about T / speed, F).

    Poses are interpolated linearly; velocities, which are per frame, grow by the factor. `motion.performing` changes a tempo by
    rotations, which needs features of our definition; recordings may have those of HumanML3D or KIT-ML.
    """
    T, F = features.shape
    at = np.arange(0.0, T - 1 + 1e-9, speed)
    before = np.minimum(at.astype(np.int64), T - 2)
    share = (at - before)[:, None]
    out = features[before] * (1 - share) + features[before + 1] * share
    out[:, :3] *= speed  # of the root
    out[:, -4 - 3 * joints_of(F) : -4] *= speed  # of the joints; the last four are foot contacts
    return out.astype(np.float32)


def _varied(features: NDArray[np.float32], generator: np.random.Generator) -> NDArray[np.float32]:
    start = int(generator.integers(0, LATEST_FRAME + 1))
    end = len(features) - int(generator.uniform(0.0, LEFT_OUT) * len(features))
    speed = float(np.exp(generator.uniform(-1, 1) * np.log(FASTEST)))
    part = features[start:end]
    return at_speed(part, speed) if len(part) > 1 else part
