"""Texts for figures: plain commands of every family, drawn with a seed."""

from __future__ import annotations

import numpy as np


def draw_texts(n: int, seed: int) -> list[str]:
    """`n` different sentences of the corpus grammar's plainest form, shuffled."""
    from mmm_core.corpus.grammar import known_commands

    known = sorted(known_commands())
    order = np.random.default_rng(seed).permutation(len(known))
    return [known[order[i % len(known)]] for i in range(n)]
