"""Loads every table of words, so that no sentence pays for it."""

from __future__ import annotations

from mmm_core.language import slips
from mmm_core.language.reading import read

_LONGEST = 12
"""Letters of a longest word whose slips are looked up without loading anything."""
_SENTENCES = (
    "could you please wvae yuor hnad slowly for two seconds while nodding, then look to the left",
    "don't bow, but raise your left arm and lower it again",
    "put yourright hand on your haert and salute with the other one",
)
"""Sentences that every step reads something in."""


def warmed() -> None:
    """Loads the tables: about 0.3 s of the processor at the first call, hardly anything after it."""
    slips.loaded(_LONGEST)
    for text in _SENTENCES:
        read(text)
