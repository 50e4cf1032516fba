"""How far a text lies from what the model can do.

The untouched sentence vector is compared with those of known commands and of things the model cannot do
(`mmm_core.corpus.outside`). The best cosine among the known is the score, the command it belongs to is how the text was
understood; when something that cannot be done lies nearer, the text is refused. Thresholds: docs/model.md.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

import torch
from torch import Tensor

from mmm_core.motion import Status

REJECT_BELOW = 0.45
DEGRADE_BELOW = 0.58
OUTSIDE_MARGIN = 0.03
"""A text is refused when something outside lies nearer by this much, and reported as degraded from a tie on."""
_SIDES = re.compile(r"\b(left|right|both)\b")
_NUMBERS = {"once": "1", "one": "1", "twice": "2", "two": "2", "three": "3", "four": "4", "five": "5", "six": "6"}
_COUNTS = re.compile(r"\b(once|twice|one|two|three|four|five|six|[1-9])\b")


@dataclass(frozen=True)
class ScopeVerdict:
    """How a text was taken.

    Attributes:
        status: accepted, degraded (done, but far from anything learnt) or rejected.
        score: best cosine, -1 to 1.
        nearest: the known command with that cosine.
        reason: why it is not accepted; empty when it is.
    """

    status: Status
    score: float
    nearest: str
    reason: str


@dataclass(frozen=True)
class ScopeIndex:
    """Known commands and outside ones with their unit sentence vectors (N, D).

    Attributes:
        commands: the known commands first, then what cannot be done.
        vectors: (N, D), in the same order.
        n_known: how many of them are known commands.
    """

    commands: list[str]
    vectors: Tensor
    n_known: int
    _named: list[tuple[frozenset[str], frozenset[str]]] = field(init=False)

    def __post_init__(self) -> None:
        """Note which sides and counts each known command names."""
        object.__setattr__(self, "_named", [(_sides(c), _counts(c)) for c in self.commands[: self.n_known]])

    def judge(self, text: str, sentence: Tensor) -> ScopeVerdict:
        """Verdict for a text and its unit sentence vector (D,).

        The vector hardly tells left from right or two from three, so the meaning is taken from the known commands that
        name the same sides and counts, else the same sides and no count, else from all.
        """
        cosine = self.vectors @ sentence
        known, outside = cosine[: self.n_known], cosine[self.n_known :]
        score = float(known.max())
        nearest = self.commands[self._meaning(text, known)]
        if score < REJECT_BELOW:
            reason = f"nothing like it was learnt (nearest: '{nearest}', {score:.2f}; needed {REJECT_BELOW})"
            return ScopeVerdict("rejected", score, nearest, reason)
        other = float(outside.max()) if len(outside) else -1.0
        impossible = self.commands[self.n_known + int(outside.argmax())] if len(outside) else ""
        if other > score + OUTSIDE_MARGIN:
            reason = f"it is like '{impossible}' ({other:.2f}), which this upper-body model cannot do"
            return ScopeVerdict("rejected", score, nearest, reason)
        if score < DEGRADE_BELOW or other > score:
            reason = f"taken as '{nearest}' ({score:.2f}); sure from {DEGRADE_BELOW}"
            return ScopeVerdict("degraded", score, nearest, reason)
        return ScopeVerdict("accepted", score, nearest, "")

    def _meaning(self, text: str, known: Tensor) -> int:
        """Index of the nearest known command that says nothing else than the text about sides and counts."""
        sides, counts = _sides(text), _counts(text)
        for wanted in ((sides, counts), (sides, frozenset[str]())):
            fitting = torch.tensor([named == wanted for named in self._named])
            if fitting.any():
                nearest = int(known.masked_fill(~fitting, -1.0).argmax())
                if wanted[1] == frozenset() or float(known[nearest]) > 0.95 * float(known.max()):
                    return nearest
        return int(known.argmax())


def _sides(text: str) -> frozenset[str]:
    return frozenset(_SIDES.findall(text.lower()))


def _counts(text: str) -> frozenset[str]:
    return frozenset(_NUMBERS.get(str(word), str(word)) for word in _COUNTS.findall(text.lower()))
