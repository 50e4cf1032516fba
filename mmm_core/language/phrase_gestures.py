"""The gesture of a phrase of the corpus: the classifier, which generalises, mistakes one in twelve of them for another gesture.

`words/phrase_gestures.bin` has a hash of each phrase of a single gesture, and the gesture's number in `gestures`. A phrase that
goes to the left stands for its mirror image as well.
"""

from __future__ import annotations

import zlib
from array import array
from bisect import bisect_left
from functools import cache

from mmm_core.language.hard_phrases import to_said_side
from mmm_core.language.known_phrases import BESIDE, significant_words
from mmm_core.language.plain_gestures import IN_TURN, gestures
from mmm_core.language.word_tables import PHRASE_GESTURES_FILE

_FEWEST_LETTERS = 3
"""Number of letters of the words of a phrase: shorter ones ("go") stand in many sentences."""
_KEY_BYTES = 4


def phrase_key(text: str) -> int | None:
    """The hash of the words of a phrase that say its gesture; None where they are too short.

    >>> phrase_key("jive exactly 3 times") == phrase_key("jive in turn"), phrase_key("go")
    (True, None)
    """
    said = " ".join(significant_words(BESIDE.sub(" ", IN_TURN.sub(" ", text.lower())), with_arms=True))
    return zlib.crc32(said.encode()) if len(said) >= _FEWEST_LETTERS else None


def gesture_of_phrase(text: str) -> str:
    """The gesture of a phrase of the corpus; empty for other texts, and where several gestures share the phrase.

    >>> gesture_of_phrase("be jack on the beanstalk"), gesture_of_phrase("twist to the right"), gesture_of_phrase("be happy")
    ('climb', 'twist/right', '')
    """
    key, (keys, numbers) = phrase_key(text), _known()
    at = bisect_left(keys, key) if key is not None else len(keys)
    return to_said_side(gestures()[numbers[at]], text) if at < len(keys) and keys[at] == key else ""


def packed(found: dict[int, str]) -> bytes:
    """The content of the file for gestures by the hash of their phrase: ascending hashes, then a byte for each gesture."""
    numbers = {name: number for number, name in enumerate(gestures())}
    keys = sorted(found)
    return array("I", keys).tobytes() + bytes(numbers[found[key]] for key in keys)


@cache
def _known() -> tuple[array[int], bytes]:
    """The hashes, ascending, and the number of the gesture of each."""
    content = PHRASE_GESTURES_FILE.read_bytes()
    end = len(content) // (_KEY_BYTES + 1) * _KEY_BYTES
    keys = array("I", content[:end])
    assert keys.itemsize == _KEY_BYTES
    return keys, content[end:]
