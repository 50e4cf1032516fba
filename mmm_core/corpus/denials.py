"""Sentences with a negative word around a gesture: those that deny all, those that ask for another gesture, those that deny nothing.

`prompts/denial_sentences.txt` has a pattern on each line, with slots for gestures; the gesture classifier learns from it whether a
sentence asks for any motion at all.
"""

from __future__ import annotations

import random
import re
from collections.abc import Sequence
from importlib.resources import files
from typing import NamedTuple

from mmm_core.corpus.withheld import is_withheld
from mmm_core.language.inflection import gerund

NOTHING, OTHER, MEANT = KINDS = ("nothing", "other", "meant")
"""Kinds of patterns: nothing may move; another gesture is to be done; the gesture is to be done nevertheless."""


_SLOT = re.compile(r"\{([vgwh])\}")


class Slot(NamedTuple):
    """A gesture in a sentence: its first character, its end, and whether it is the other gesture."""

    start: int
    end: int
    is_other: bool


class Pattern(NamedTuple):
    """A sentence with slots: {v} and {g} for a gesture as an imperative and as a gerund, {w} and {h} for another one."""

    kind: str
    words: str

    def filled(self, gesture: str, other: str) -> tuple[str, list[Slot]]:
        """The sentence with two gestures, each an imperative such as "wave your hand", and where these stand in it."""
        words = {"v": gesture, "g": gerund(gesture, None), "w": other, "h": gerund(other, None)}
        said, slots = "", []
        for i, piece in enumerate(_SLOT.split(self.words)):
            if i % 2:
                slots.append(Slot(len(said), len(said) + len(words[piece]), piece in "wh"))
            said += words[piece] if i % 2 else piece
        return said, slots


def denial_patterns() -> tuple[Pattern, ...]:
    """All patterns, in the order of their file."""
    text = files("mmm_core.corpus").joinpath("prompts", "denial_sentences.txt").read_text(encoding="utf-8")
    rows = (line.partition(" => ") for line in text.splitlines() if line and not line.startswith("#"))
    return tuple(Pattern(kind, words) for kind, _, words in rows)


def draw_denial(
    rng: random.Random, patterns: Sequence[Pattern], gesture: str, other: str
) -> tuple[str, str, list[Slot]]:
    """A sentence with two gestures that is withheld from no training, its kind, and where the gestures stand."""
    while True:
        pattern = rng.choice(patterns)
        said, slots = pattern.filled(gesture, other)
        if not is_withheld(said):
            return said, pattern.kind, slots
