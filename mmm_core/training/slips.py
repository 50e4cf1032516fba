"""Slips of the finger in training texts."""

from __future__ import annotations

import random

_LETTERS = "qwertyuiopasdfghjklzxcvbnm"


def slip(word: str, rng: random.Random) -> str:
    """A word with two letters swapped, one lost or one replaced; a short word stays."""
    if len(word) < 4:
        return word
    i = rng.randrange(1, len(word) - 1)
    before, after = word[:i], word[i + 1 :]
    return rng.choice((before + after[0] + word[i] + after[1:], before + after, before + rng.choice(_LETTERS) + after))
