"""A command's last word with which it is no phrase of the corpus, and a word alike with which it is: "cover your mouse".

The word is spelt right, so that only the phrase tells that another was meant. Common words of commands and parts of the body stay.
"""

from __future__ import annotations

import re
from functools import lru_cache

from rapidfuzz import process
from rapidfuzz.distance import OSA

from mmm_core.language.known_phrases import SAYS_NOTHING, is_known_phrase
from mmm_core.language.slips_in_context import KEY_WORDS
from mmm_core.language.word_tables import REMEMBERED, lines

_OBJECT = re.compile(
    r"\b(?:your|the|my|our|an?|own) (?P<object>[a-z]{4,})(?= with (?:your|the) (?:left|right) (?:hand|arm)$|$)"
)
_STAYS = frozenset("wrist wrists cheek cheeks forehead waist temple temples thigh thighs brow knee knees".split())
_LONG = 5
"""Letters of a word that may differ in two from the word that was meant, if both begin alike; shorter ones in one."""


@lru_cache(REMEMBERED)
def with_meant_object(command: str) -> str:
    """A command in lower case, with the word in the place of its last one that makes it a phrase of the corpus, if one is alike.

    >>> with_meant_object("cover your mouse with your left hand"), with_meant_object("cover your nose")
    ('cover your mouth with your left hand', 'cover your nose')
    """
    found = _OBJECT.search(command)
    if found is None:
        return command
    word, before = found["object"], command[: found.start("object")]
    common = lines("corpus_words")[:KEY_WORDS]
    if word in common or word in _STAYS or is_known_phrase(before + word):
        return command
    most = 2 if len(word) >= _LONG else 1
    for meant, n_slips, _ in process.extract(word, common, scorer=OSA.distance, score_cutoff=most, limit=None):
        begins_alike = meant[0] == word[0]
        if meant not in SAYS_NOTHING and (n_slips == 1 or begins_alike) and is_known_phrase(before + meant):
            return before + meant + command[found.end() :]
    return command
