"""How far a text lies from what the model can do.

The untouched sentence vector is compared with those of the commands the model was trained on: the best cosine is the
score, the command it belongs to is how the text was understood. Thresholds and how they were set: docs/model.md.
"""

from __future__ import annotations

from dataclasses import dataclass

from torch import Tensor

from mmm_core.motion import Status

REJECT_BELOW = 0.45
DEGRADE_BELOW = 0.58


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
    """Known commands and their unit sentence vectors (N, D)."""

    commands: list[str]
    vectors: Tensor

    def judge(self, sentence: Tensor) -> ScopeVerdict:
        """Verdict for one unit sentence vector (D,)."""
        cosine = self.vectors @ sentence
        best = int(cosine.argmax())
        score, nearest = float(cosine[best]), self.commands[best]
        if score < REJECT_BELOW:
            reason = f"nothing like it was learnt (nearest: '{nearest}', {score:.2f}, needed {REJECT_BELOW})"
            return ScopeVerdict("rejected", score, nearest, reason)
        if score < DEGRADE_BELOW:
            reason = f"taken as '{nearest}' ({score:.2f}); sure from {DEGRADE_BELOW}"
            return ScopeVerdict("degraded", score, nearest, reason)
        return ScopeVerdict("accepted", score, nearest, "")
