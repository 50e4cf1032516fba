"""Loads every table of words in advance, so that the first sentence is read as fast as later ones."""

from __future__ import annotations

from mmm_core.language.nearest_words import loaded
from mmm_core.language.reading import read

_LONGEST = 12
"""Letters of the longest word whose misspellings are looked up without loading a table."""
_SENTENCES = (
    "could you please wvae yuor hnad slowly for two seconds while nodding, then look to the left",
    "lean eft, don't bow, but raise your left arm and lower it again",
    "bean your hart",
    "nod fat",
    "put yourright hand on your haert and salute with the other one",
)
"""Sentences that exercise every step of reading."""


def warmed() -> None:
    """Load the tables: about 0.3 s of processor time at the first call, almost none afterwards."""
    loaded(_LONGEST)
    for text in _SENTENCES:
        read(text)
