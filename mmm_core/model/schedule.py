"""The number of masked tokens before each step of parallel decoding. Pure functions."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

Schedule = Literal["cosine", "linear"]


def masked_share(progress: float, schedule: Schedule = "cosine") -> float:
    """Share of positions still masked when `progress` in [0, 1] of the steps is done.

    MaskGIT (arXiv 2202.04200) sec. 3.2 and MMM (arXiv 2312.03596) sec. 3.3: cos(pi/2 * progress); linear: 1 - progress.
    """
    return math.cos(math.pi / 2 * progress) if schedule == "cosine" else 1.0 - progress


def masked_counts(n_positions: int, n_steps: int, schedule: Schedule = "cosine") -> list[int]:
    """Number of masked positions before each step; starts with all, strictly falls, ends before 0.

    The list may be shorter than `n_steps` when there are fewer positions than steps: a step that would
    predict nothing new is left out.
    """
    counts: list[int] = []
    for step in range(n_steps):
        count = max(1, math.floor(masked_share(step / n_steps, schedule) * n_positions + 1e-9))
        count = n_positions if step == 0 else count
        if counts and count >= counts[-1]:
            count = counts[-1] - 1
        if count < 1:
            break
        counts.append(count)
    return counts


def official_counts(
    n_open: int, n_tokens: int, *, max_steps: int = 10, longest: int = 49, early_exit: bool = False
) -> list[int]:
    """Masked positions before each forward pass of the released sampler.

    Differs from `masked_counts`: the number of steps S shrinks with the motion's length, yet `max_steps` passes are
    made, and each surplus pass samples one position again. With `early_exit`, which the released code applies to a batch
    of one only, sampling ends after S passes; because of a misplaced parenthesis there, it ends after a single pass for 8
    to 12 tokens. The released code computes the counts in single precision, and so does this function: in double precision
    201 of the 1,225 pairs of `n_open` and `n_tokens` would differ by one position in a step.

    Args:
        n_open: positions to fill; fewer than `n_tokens` in an edit.
        n_tokens: length of the motion.
        max_steps: passes for the longest motion.
        longest: tokens of the longest motion.
        early_exit: whether to end early, as the released code does for a batch of one.
    """
    steps = np.float32(round(max_steps * n_tokens / longest) + 1e-8)
    counts: list[int] = []
    for k in range(max_steps):
        progress = min(np.float32(k) / steps, np.float32(1))
        if early_exit and abs(min(k - 1 / float(steps), 1.0) - float(progress)) < 1e-6:
            break
        counts.append(max(1, math.floor(_single_precision_cosine(progress) * np.float32(n_open))))
    return counts


def _single_precision_cosine(progress: np.float32) -> np.float32:
    """cos(pi/2 * progress), each operation rounded to 24 bits as a float32 tensor rounds it.

    At progress 2/3 the result is 0.49999997, not 0.5, so that of L positions L/2 - 1 stay masked instead of L/2.
    """
    angle = progress * np.float32(math.pi / 2)
    return np.float32(math.cos(float(angle)))
