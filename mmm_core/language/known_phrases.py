"""Whether a text equals a phrase of the corpus, apart from articles, sides, numbers, endings of words and courtesy.

The scope classifier generalises, and so it refuses 0.6 % of the phrases that the model was trained with ("do a star jump") and
doubts 2.3 %. A phrase of the corpus is in scope whatever the classifier says. Of each phrase the file holds a 32-bit hash, which a
text of other words has with a chance of one in 116,000.
"""

from __future__ import annotations

import re
import zlib
from array import array
from bisect import bisect_left
from functools import cache

from mmm_core.language.count_words import ADVERBS, NUMBERS
from mmm_core.language.one_gesture import stem
from mmm_core.language.word_tables import KNOWN_PHRASES_FILE

FEWEST_LETTERS = 8
"""Least number of letters in a phrase: the classifier judges single short words."""
_WORD = re.compile(r"[a-z']+|\d+")
CAPTION_SUBJECT = (
    r"(?:(?:the|an?|this|some) (?:\w+ )?(?:person|man|woman|human|humanoid|robot|character|figure)|someone|somebody)\b"
)
"""Pattern of the subject of a caption of one motion, such as the corpus has: "a man is shooting out their right hand"."""
SUBJECT_BEFORE_VERB = re.compile(rf"^\s*{CAPTION_SUBJECT} (?=(?:is )?\w+(?:s|ing)\b)")
"""Pattern of that subject before its verb, without the verb: "this person shifts from foot to foot"."""
BESIDE = re.compile(
    r"(?:,? (?:exactly|just|only))* (?:(?:\w+ times?|a single time)(?: in a row)?|once|twice)\b|"
    r"(?: with| using) (?:the|your|their|his|her|its|both) (?:left |right )?(?:arm|hand)s?\b"
)
"""Number of strokes and hand of a command."""
_ARMS = frozenset("hand hands arm arms".split())
_SAYS_NOTHING = frozenset(
    (
        "a an the your my his her its their both one of left right please robot now do does doing perform make give me us show "
        "some with using time times"
    ).split()
) | {*NUMBERS, *ADVERBS}
"""Words that, like those for arms, a command may gain or lose without a change of its gesture."""


def key_of(text: str) -> int | None:
    """The hash of a text's significant words; None where they are too short.

    >>> key_of("Do five star jumps!") == key_of("a star jump"), key_of("nod")
    (True, None)
    """
    said = " ".join(significant_words(text))
    return zlib.crc32(said.encode()) if len(said) >= FEWEST_LETTERS else None


def significant_words(text: str, *, with_arms: bool = False) -> list[str]:
    """The stems of the words of a text that say which gesture is meant, `with_arms` also those for arms and hands."""
    words = [word for word in _WORD.findall(SUBJECT_BEFORE_VERB.sub("", text.lower())) if word not in _SAYS_NOTHING]
    return [stem(word) for word in words if not word.isdigit() and (with_arms or word not in _ARMS)]


def is_known_phrase(text: str) -> bool:
    """Whether the significant words of a text are those of a phrase of the corpus."""
    return place_among(_known(), key_of(text)) is not None


def place_among(hashes: array[int], key: int | None) -> int | None:
    """The index of `key` among ascending hashes; None where it is not one of them."""
    at = bisect_left(hashes, key) if key is not None else len(hashes)
    return at if at < len(hashes) and hashes[at] == key else None


@cache
def _known() -> array[int]:
    """The hashes, ascending."""
    known = array("I", KNOWN_PHRASES_FILE.read_bytes())
    assert known.itemsize == 4
    return known
