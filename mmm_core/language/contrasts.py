"""Sentences that set one act against another, put in the words in which a denial is commonly said."""

from __future__ import annotations

from mmm_core.language.word_tables import replaced, substitutions


def contrasted(said: str) -> str:
    """A sentence with its contrasts in common words; the sentence itself where it has none.

    >>> contrasted("give the dabbing a rest and nod"), contrasted("not so much a wave as a salute")
    ('skip the dabbing, nod', 'not a wave, but a salute')
    >>> contrasted("give your arms a rest"), contrasted("give me a rest")
    ('lower your arms', 'give me a rest')
    """
    return replaced(said, substitutions("contrasts"))
