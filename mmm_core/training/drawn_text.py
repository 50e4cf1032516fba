"""A text that the gesture classifier learns from, how often each kind of text is drawn, and batches of drawn texts."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from typing import NamedTuple, Protocol, TypeVar

TOGETHER = 8
"""Batches that are drawn together, so that each holds texts of similar length."""


class Drawn(NamedTuple):
    """A text with what it asks for; None where that is not known.

    Attributes:
        text: the text.
        name: the gesture of `part`, or the class of the whole text.
        manners: tempos and sizes that the text names.
        is_denied: whether it asks for no motion.
        part: first character and end of the command that `name` is about; None for the whole text.
    """

    text: str
    name: str | None
    manners: frozenset[str] | None = None
    is_denied: bool | None = None
    part: tuple[int, int] | None = None


class Shares(NamedTuple):
    """Shares of the kinds of texts that are drawn; all others are single gestures.

    Attributes:
        outside: texts that are no gesture.
        marked: marked sentences of several commands.
        manner: sentences with marked manner.
        denial: sentences with a negative word.
        parts: commands of marked sentences.
        joined: two gestures joined to one text.
        joined_parts: share of the joined texts that ask for one of both gestures instead of "several".
    """

    outside: float
    marked: float
    manner: float
    denial: float
    parts: float
    joined: float
    joined_parts: float


SHARES = Shares(outside=0.1, marked=0.09, manner=0.1, denial=0.08, parts=0.1, joined=0.06, joined_parts=0.4)
SETTLING_SHARES = Shares(outside=0.09, marked=0.12, manner=0.08, denial=0.07, parts=0.07, joined=0.05, joined_parts=0.3)
"""Shares of the end of a training: more single gestures and more sentences of several commands."""


class _HasText(Protocol):
    @property
    def text(self) -> str: ...


_T = TypeVar("_T", bound=_HasText)


def batches_of(draw: Callable[[], _T], size: int, seed: int) -> Iterator[list[_T]]:
    """Batches of `size` drawn texts without end, each of texts of similar length; `seed` gives their order."""
    rng = random.Random(seed)
    while True:
        drawn = sorted((draw() for _ in range(TOGETHER * size)), key=lambda one: len(one.text))
        batches = [drawn[at : at + size] for at in range(0, len(drawn), size)]
        rng.shuffle(batches)
        yield from batches
