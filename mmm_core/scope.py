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
    _sides: list[frozenset[str]] = field(init=False)

    def __post_init__(self) -> None:
        """Note which sides each known command names."""
        object.__setattr__(self, "_sides", [_named_sides(c) for c in self.commands[: self.n_known]])

    def judge(self, text: str, sentence: Tensor) -> ScopeVerdict:
        """Verdict for a text and its unit sentence vector (D,).

        The vector hardly tells left from right, so among the known commands only those that name the same sides are
        taken as the meaning, where there are any.
        """
        cosine = self.vectors @ sentence
        known, outside = cosine[: self.n_known], cosine[self.n_known :]
        score = float(known.max())
        same_sides = torch.tensor([sides == _named_sides(text) for sides in self._sides])
        candidates = known.masked_fill(~same_sides, -1.0) if same_sides.any() else known
        nearest = self.commands[int(candidates.argmax())]
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


def _named_sides(text: str) -> frozenset[str]:
    return frozenset(_SIDES.findall(text.lower()))
