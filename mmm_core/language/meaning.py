"""Finds the known command that a text means: the nearest sentence vector with the same side, direction and number.

The vector hardly distinguishes left from right, up from down or two from three, so these are read from the words.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

import torch
from torch import Tensor

from mmm_core.language.count_words import ADVERBS, NUMBERS

_SIDES = re.compile(r"\b(left|right|both)\b")
_VALUES = NUMBERS | ADVERBS
_COUNTS = re.compile(rf"\b({'|'.join(_VALUES)})\b")
_TIMES = re.compile(rf"\s*\b(?:(?:{'|'.join(NUMBERS)}) times|{'|'.join(ADVERBS)})\b")
_WAYS = {
    "up": re.compile(r"\b(?:rais|lift|hoist|up\b|upwards?\b|rise)"),
    "down": re.compile(r"\b(?:lower(?:s|ed|ing)?\b|drop|down\b|downwards?\b|sink|fall|hang)"),
}
_NEAR_ENOUGH = 0.95
"""Least share of the nearest command's cosine for a command of the same number; below it the nearest one is kept,
without its number."""


class Meanings:
    """Known commands with the side, direction and number that each names.

    Args:
        commands: N known commands.
    """

    def __init__(self, commands: Sequence[str]) -> None:
        self._commands = list(commands)
        self._sides = _Said(map(_sides, commands))
        self._ways = _Said(map(_ways, commands))
        self._counts = _Said(map(_counts, commands))
        self._plain = torch.tensor([not _counts(_TIMES.sub("", c)) for c in commands])

    def nearest(self, text: str, cosine: Tensor) -> str:
        """The command that a text means, given the cosines (N,) between the text and the known commands.

        Without a command of the same sides and directions it is the nearest of all. A number that the text does not name is
        left out.
        """
        ways, counts = _ways(text), _counts(text)
        agreeing = self._sides.are(_sides(text))
        if ways:
            agreeing &= self._ways.are(ways) | self._ways.are(frozenset())
        if not agreeing.any():
            agreeing = torch.ones_like(agreeing)
        same = agreeing & self._counts.are(counts)
        plain = agreeing & self._plain
        pool = same | plain if (same | plain).any() else agreeing
        best = int(cosine.masked_fill(~pool, -1.0).argmax())
        if same.any():
            exact = int(cosine.masked_fill(~same, -1.0).argmax())
            if cosine[exact] >= _NEAR_ENOUGH * cosine[best]:
                return self._commands[exact]
        return self._commands[best] if same[best] else _TIMES.sub("", self._commands[best])


class _Said:
    """One property that each of N commands names or leaves open."""

    def __init__(self, said: Iterable[frozenset[str | int]]) -> None:
        self._numbers: dict[frozenset[str | int], int] = {}
        self._of = torch.tensor([self._numbers.setdefault(s, len(self._numbers)) for s in said])

    def are(self, what: frozenset[str | int]) -> Tensor:
        """(N,) mask of the commands that name exactly `what`."""
        return self._of == self._numbers.get(what, -1)


def _sides(text: str) -> frozenset[str]:
    return frozenset(_SIDES.findall(text.lower()))


def _ways(text: str) -> frozenset[str]:
    return frozenset(way for way, words in _WAYS.items() if words.search(text.lower()))


def _counts(text: str) -> frozenset[int]:
    return frozenset(_VALUES[str(word)] for word in _COUNTS.findall(text.lower()))
