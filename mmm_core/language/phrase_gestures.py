"""The gesture of a phrase of the corpus: without it another class is named for one in eleven captions, with it for one in 33.

`words/phrase_gestures.bin` has a hash of each phrase of a single gesture, that gesture's number in `gestures`, and whether the
phrase means both arms though it may name none. A phrase that goes to the left stands for its mirror image as well.
"""

from __future__ import annotations

import re
import zlib
from array import array
from collections.abc import Mapping
from functools import cache
from typing import NamedTuple

from mmm_core.language.hard_phrases import to_said_side
from mmm_core.language.known_phrases import BESIDE, place_among, significant_words
from mmm_core.language.plain_gestures import IN_TURN, gestures
from mmm_core.language.word_tables import PHRASE_GESTURES_FILE

_FEWEST_LETTERS = 3
"""Number of letters of the words of a phrase: shorter ones ("go") stand in many sentences."""
_SHOWS = re.compile(r"\b(?:perform|mak|giv|show)(?:s|es|ing)\b")
"""Forms of verbs that say no gesture, as captions have them: "making a bow"."""
_KEY_BYTES = 4


class PhraseMeaning(NamedTuple):
    """The meaning of a phrase of the corpus.

    Attributes:
        gesture: its gesture; of a gesture that goes to a side, the one to the left.
        both_arms: whether it means both arms.
    """

    gesture: str
    both_arms: bool


def phrase_key(text: str) -> int | None:
    """The hash of the words of a phrase that say its gesture; None where they are too short.

    >>> phrase_key("jive exactly 3 times") == phrase_key("jive in turn"), phrase_key("go")
    (True, None)
    """
    words = BESIDE.sub(" ", _SHOWS.sub(" ", IN_TURN.sub(" ", text.lower())))
    said = " ".join(significant_words(words, with_arms=True))
    return zlib.crc32(said.encode()) if len(said) >= _FEWEST_LETTERS else None


def gesture_of_phrase(text: str) -> str:
    """The gesture of a phrase of the corpus; empty for other texts, and where several gestures share the phrase.

    >>> gesture_of_phrase("be jack on the beanstalk"), gesture_of_phrase("twist to the right"), gesture_of_phrase("be happy")
    ('climb', 'twist/right', '')
    """
    meaning = _meaning_of(text)
    return to_said_side(meaning.gesture, text) if meaning else ""


def is_for_both_arms(text: str) -> bool:
    """Whether a phrase of one gesture means both arms: "stand at parade rest".

    >>> is_for_both_arms("stand at parade rest"), is_for_both_arms("hide a hand behind your back")
    (True, False)
    """
    meaning = _meaning_of(text)
    return meaning is not None and meaning.both_arms


def packed(meanings: Mapping[int, PhraseMeaning]) -> bytes:
    """The content of the file: ascending hashes of phrases, a byte for each gesture, and a byte for each "both arms"."""
    numbers = {name: number for number, name in enumerate(gestures())}
    keys = sorted(meanings)
    found = [meanings[key] for key in keys]
    return b"".join(
        (
            array("I", keys).tobytes(),
            bytes(numbers[one.gesture] for one in found),
            bytes(one.both_arms for one in found),
        )
    )


def _meaning_of(text: str) -> PhraseMeaning | None:
    keys, numbers, both = _known()
    at = place_among(keys, phrase_key(text))
    return None if at is None else PhraseMeaning(gestures()[numbers[at]], bool(both[at]))


@cache
def _known() -> tuple[array[int], bytes, bytes]:
    """The hashes, ascending, and for each the number of its gesture and whether it means both arms."""
    content = PHRASE_GESTURES_FILE.read_bytes()
    n = len(content) // (_KEY_BYTES + 2)
    keys = array("I", content[: n * _KEY_BYTES])
    assert keys.itemsize == _KEY_BYTES
    return keys, content[n * _KEY_BYTES : -n], content[-n:]
