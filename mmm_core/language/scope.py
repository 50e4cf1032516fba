"""The scope of the model: how far a text lies from the motions that it can generate.

A small classifier reads the untouched sentence vector: trained on the corpus's own sentences against texts of things that
cannot be done (`mmm_core.corpus.outside`, `mmm_core.training.scope_training`). The margin by which
the text lies nearer to a known command than to any text outside is added to its log-odds. The score is that sum as a
probability; a phrase of the corpus itself is sure (`mmm_core.language.known_phrases`). The nearest known command says how the
text was understood (`mmm_core.language.meaning`). A text of several
clauses, some of them out of scope, is degraded to the others.
Method, thresholds and figures: docs/scope.md.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace

import torch
import torch.nn.functional as F
from torch import Tensor, nn

from mmm_core.language.known_phrases import is_known_phrase
from mmm_core.language.meaning import Meanings
from mmm_core.motion.motion import Status

REJECT_BELOW = 0.5
DEGRADE_BELOW = 0.97
CLAUSE_BELOW = 0.06
"""Score below which one clause among others is left out: low, since clauses are short and judged less surely."""
CLAUSE_KEPT_FROM = 0.995
"""Score from which a clause is kept although the whole text is rejected."""
MARGIN_WEIGHT = 10.0
LOGIT_AT_HALF = -2.5
"""Log-odds with margin that mean a score of one half. This and the thresholds: docs/scope.md."""
OUTSIDE_WEIGHT = 6.0
"""Log-odds that a text loses which the gesture classifier surely takes for no gesture."""
FEATURE_SCALE = 20.0
"""Components of a unit vector of width 384 are about 1/20."""

# Checkpoints without a classifier: cosines alone.
COSINE_REJECT_BELOW = 0.45
COSINE_DEGRADE_BELOW = 0.58
OUTSIDE_MARGIN = 0.03
"""Cosine by which a text outside must be nearer for a refusal, in checkpoints without a classifier; from a tie on the
text is degraded."""

_BETWEEN_CLAUSES = re.compile(
    r"""\s*[,;.]?\s*(?<!\bup\s)(?<!\bback\s)(?<!\bleft\s)(?<!\bright\s)
    \b(?:and\ then|and\ afterwards|after\ that|then|and|while\ you|while|before\ you)\b\s*
    |\s*[;,.]\s+""",
    re.IGNORECASE | re.VERBOSE,
)
_LATIN_WORD = re.compile(r"[A-Za-z]{2,}")
_CODE = re.compile(r"[{}<\\$|=]|(?<!-)>|://|\w\((?!s\))|\.\./|--\w")
"""Characters of programs, addresses and paths that do not occur in sentences."""
MOST_CLAUSES, MOST_WORDS = 4, 30
"""Largest number of clauses and of words in a text judged clause by clause, so that a decision takes less than 30 ms."""


@dataclass(frozen=True)
class ScopeVerdict:
    """The verdict on a text.

    Attributes:
        status: accepted, degraded (done in part, or far from the training texts) or rejected.
        score: estimated probability, 0 to 1, that the model can carry out the text.
        nearest: the nearest known command.
        reason: why the text is not accepted; empty when it is.
        kept: the clauses that are carried out; empty where the text is carried out as it stands.
    """

    status: Status
    score: float
    nearest: str
    reason: str
    kept: str = ""


class ScopeClassifier(nn.Module):
    """Log-odds that a sentence vector (B, D) belongs to a text that can be done."""

    def __init__(self, width: int, hidden: int) -> None:
        super().__init__()
        self.hidden = nn.Linear(width, hidden)
        self.out = nn.Linear(hidden, 1)

    def forward(self, sentence: Tensor) -> Tensor:
        return self.out(F.gelu(self.hidden(FEATURE_SCALE * sentence)))[:, 0]


@dataclass(frozen=True)
class ScopeIndex:
    """Texts inside and outside the scope with their unit sentence vectors (N, D), and the classifier between them.

    Attributes:
        commands: the known commands first, then texts out of scope.
        vectors: (N, D), in the same order.
        n_known: number of known commands.
        classifier: classifier of the scope; None in older checkpoints, in which cosines decide.
    """

    commands: list[str]
    vectors: Tensor
    n_known: int
    classifier: ScopeClassifier | None = None
    _meanings: Meanings = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_meanings", Meanings(self.commands[: self.n_known]))

    def judge(self, text: str, sentence: Tensor, outside: float = 0.0) -> ScopeVerdict:
        """Verdict for a text as a whole.

        Args:
            text: the text, in plain words.
            sentence: its unit sentence vector (D,).
            outside: probability that it asks for no gesture (`Reading.outside`).
        """
        if why := unreadable(text):
            return ScopeVerdict("rejected", 0.0, "", why)
        cosine = self.vectors @ sentence
        known, others = cosine[: self.n_known], cosine[self.n_known :]
        nearest = self._meanings.nearest(text, known)
        other = float(others.max()) if len(others) else -1.0
        impossible = self.commands[self.n_known + int(others.argmax())] if len(others) else ""
        if self.classifier is None:
            return _by_cosine(nearest, float(known.max()), impossible, other)
        score = self._score(sentence, float(known.max()) - other, outside)
        if score < DEGRADE_BELOW and is_known_phrase(text):
            score = DEGRADE_BELOW
        if score < REJECT_BELOW:
            like = f"it is like '{impossible}', " if other > float(known.max()) - 0.1 else ""
            reason = (
                f"{like}nothing this upper-body model can do (score {score:.2f}; needed {REJECT_BELOW}); "
                f"the nearest it can do: '{nearest}'"
            )
            return ScopeVerdict("rejected", score, nearest, reason)
        if score < DEGRADE_BELOW:
            return ScopeVerdict(
                "degraded",
                score,
                nearest,
                f"not sure of it: score {_below(score, DEGRADE_BELOW)}; sure from {DEGRADE_BELOW}",
            )
        return ScopeVerdict("accepted", score, nearest, "")

    @torch.inference_mode()
    def _score(self, sentence: Tensor, margin: float, outside: float) -> float:
        assert self.classifier is not None
        logit = float(self.classifier(sentence[None])) + MARGIN_WEIGHT * margin - OUTSIDE_WEIGHT * outside
        return float(torch.sigmoid(torch.tensor(logit - LOGIT_AT_HALF)))


def clauses_of(text: str) -> list[str]:
    """The clauses of a text, in order; empty for a single clause, or above `MOST_CLAUSES` or `MOST_WORDS`."""
    if len(text.split(None, MOST_WORDS)) > MOST_WORDS:
        return []
    parts = [part for part in _BETWEEN_CLAUSES.split(text.strip()) if _LATIN_WORD.search(part)]
    return parts if 1 < len(parts) <= MOST_CLAUSES else []


def with_clauses(whole: ScopeVerdict, clauses: list[str], verdicts: list[ScopeVerdict]) -> ScopeVerdict:
    """The verdict on a text, given the verdicts on its clauses: degraded to the clauses in scope where some are not.

    Clauses lean on each other ("hold it there"), so a clause is left out only if it lies far outside; and a text that is
    rejected as a whole is saved only by clauses well inside.
    """
    taken = taken_clauses(whole, verdicts)
    if not taken or len(taken) == len(clauses):
        return whole
    kept = ", then ".join(clauses[i] for i in taken)
    left_out = "', '".join(clauses[i] for i in range(len(clauses)) if i not in taken)
    reason = f"kept '{kept}'; left out '{left_out}', which this upper-body model cannot do"
    best = max((verdicts[i] for i in taken), key=lambda v: v.score)
    return replace(whole, status="degraded", nearest=best.nearest, reason=reason, kept=kept)


def taken_clauses(whole: ScopeVerdict, verdicts: list[ScopeVerdict]) -> list[int]:
    """Indices of the clauses that are carried out, given the verdicts on the text and on its clauses."""
    least = CLAUSE_KEPT_FROM if whole.status == "rejected" else CLAUSE_BELOW
    return [i for i, verdict in enumerate(verdicts) if verdict.score >= least]


def _below(score: float, mark: float) -> str:
    """A score below a mark in as many digits as tell it from the mark: 0.97 is not below 0.97."""
    return next(said for digits in range(2, 18) if float(said := f"{score:.{digits}f}") < mark)


def _by_cosine(nearest: str, score: float, impossible: str, other: float) -> ScopeVerdict:
    if score < COSINE_REJECT_BELOW:
        reason = f"nothing like it was learnt (nearest: '{nearest}', {score:.2f}; needed {COSINE_REJECT_BELOW})"
        return ScopeVerdict("rejected", score, nearest, reason)
    if other > score + OUTSIDE_MARGIN:
        reason = f"it is like '{impossible}' ({other:.2f}), which this upper-body model cannot do"
        return ScopeVerdict("rejected", score, nearest, reason)
    if score < COSINE_DEGRADE_BELOW or other > score:
        reason = f"not sure of it: score {_below(score, COSINE_DEGRADE_BELOW)}; sure from {COSINE_DEGRADE_BELOW}"
        return ScopeVerdict("degraded", score, nearest, reason)
    return ScopeVerdict("accepted", score, nearest, "")


def unreadable(text: str) -> str:
    """The reason why a text holds no readable sentence; empty where it holds one."""
    if not any(c.isprintable() and not c.isspace() for c in text):
        return "the text is empty"
    latin, letters = sum(c.isascii() and c.isalpha() for c in text), sum(c.isalpha() for c in text)
    if letters > 2 * latin:
        return "it is written in another script; commands are in English"
    if not _LATIN_WORD.search(text):
        return "there is no word in it; commands are English sentences"
    if found := _CODE.search(text):
        return f"'{found[0]}' belongs to programs, not to commands in English"
    return ""
