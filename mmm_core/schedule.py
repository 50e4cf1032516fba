"""How many tokens stay masked at each step of parallel decoding. Pure functions."""

from __future__ import annotations

import math
from typing import Literal

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
