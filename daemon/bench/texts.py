"""Texts for benchmarks: plain commands of every family, and texts beyond the model's scope, drawn with a seed."""

from __future__ import annotations

import numpy as np


def draw_texts(n: int, seed: int, *, outside_share: float = 0.0) -> list[str]:
    """`n` shuffled sentences of the corpus grammar's plainest form, with a share `outside_share` of texts that the model cannot do.

    The sentences differ from each other as long as there are enough.
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
