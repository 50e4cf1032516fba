"""Texts for figures: plain commands of every family, and things beyond the model, drawn with a seed."""

from __future__ import annotations

import numpy as np


def draw_texts(n: int, seed: int, *, outside_share: float = 0.0) -> list[str]:
    """`n` sentences of the corpus grammar's plainest form, shuffled; a share of them of what the model cannot do.

    They are different as long as there are enough.
    """
    from mmm_core.corpus.outside import OUTSIDE
    from mmm_core.corpus.plain_commands import known_commands

    rng = np.random.default_rng(seed)
    known = sorted(known_commands())
    order = rng.permutation(len(known))
    texts = [known[int(order[i % len(known)])] for i in range(n)]
    for i in np.flatnonzero(rng.random(n) < outside_share):
        texts[i] = OUTSIDE[int(rng.integers(len(OUTSIDE)))]
    return texts
