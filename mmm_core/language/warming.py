"""Loads every table of words, so that no sentence pays for it."""

from __future__ import annotations

from mmm_core.language.nearest_words import loaded
from mmm_core.language.reading import read

_LONGEST = 12
"""Letters of a longest word whose slips are looked up without loading anything."""
_SENTENCES = (
    "could you please wvae yuor hnad slowly for two seconds while nodding, then look to the left",
    "lean eft, don't bow, but raise your left arm and lower it again",
    "bean your hart",
    "nod fat",
    "put yourright hand on your haert and salute with the other one",
)
"""Sentences that every step reads something in."""


def warmed() -> None:
    """Loads the tables: about 0.3 s of the processor at the first call, hardly anything after it."""
    loaded(_LONGEST)
    for text in _SENTENCES:
        read(text)
