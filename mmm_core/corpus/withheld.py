"""Phrases that no caption may contain, because held-out texts must be new to the model.

New phrases are written without sight of the held-out texts; a phrase that happens to equal one is left out here.
"""

from __future__ import annotations

import re

from mmm_core.corpus.heldout import PROBE_SETS
from mmm_core.corpus.scope_prompts import SCOPE_DEVELOPMENT, SCOPE_TEST
from mmm_core.language.inflection import NUMBERS

_EMPTY_WORDS = frozenset((
    "a", "an", "the", "your", "you", "me", "i", "for", "with", "using", "please", "now", "just", "and", "next", "ok", "hey", "um",
    "thanks", "robot", "do", "give", "show", "make", "perform", "want",
))  # fmt: skip
"""Words that can be added to a command or left out of it without a change of meaning."""


_DIGITS = dict(zip("12345678", NUMBERS[1:], strict=True))


def _key(text: str) -> str:
    text = "".join(_DIGITS.get(c, c) for c in text)
    return " ".join(w for w in re.sub(r"[^a-z0-9]", " ", text.lower()).split() if w not in _EMPTY_WORDS)


_PROMPTS = (*SCOPE_TEST.all_texts(), *SCOPE_DEVELOPMENT.all_texts())
_WITHHELD = frozenset(
    _key(text) for text in (*(p.text for probes in PROBE_SETS.values() for p in probes), *_PROMPTS)
) - {""}


def is_withheld(phrase: str) -> bool:
    """Whether a phrase equals a probe or a scope prompt up to articles, politeness and the like."""
    return _key(phrase) in _WITHHELD
