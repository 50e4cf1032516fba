"""A phrase of the corpus means the gesture that it was written for, whatever the classifier says."""

from __future__ import annotations

import re

import pytest

from mmm_core.corpus.family_words import phrase_gestures
from mmm_core.corpus.outside import OUTSIDE
from mmm_core.corpus.plain_commands import plain_phrases
from mmm_core.corpus.withheld import is_withheld
from mmm_core.language.phrase_gestures import gesture_of_phrase, phrase_key
from mmm_core.language.plain_gestures import gestures
from mmm_core.language.word_tables import PHRASE_GESTURES_FILE


@pytest.mark.parametrize(
    ("text", "gesture"),
    [
        ("be Jack on the beanstalk", "climb"),
        ("a quizzical air with the left arm", "think"),
        ("jive exactly 3 times", "dance_pump"),
        ("this person sulks", "slump"),
        ("twist to the left", "twist/left"),
        ("twist to the right", "twist/right"),  # its mirror image is in the file
        ("twist to the left and to the right", ""),
        ("spread your arms", ""),  # to the sides, or for a hug
        ("turn", ""),  # "turn your hand" is one
        ("run away", ""),
    ],
)
def test_a_phrase_of_one_gesture_has_it(text: str, gesture: str) -> None:
    assert gesture_of_phrase(text) == gesture


def test_hands_and_arms_tell_phrases_apart() -> None:
    """Single words of phrases stand in any sentence."""
    assert phrase_key("turn your hand") != phrase_key("turn") == phrase_key("turn in turn with both hands")


def test_nothing_outside_is_a_phrase() -> None:
    assert not [text for text in OUTSIDE if gesture_of_phrase(text)]


@pytest.mark.long
def test_the_file_is_that_of_the_corpus() -> None:
    """When this fails after phrases were changed: `python -m mmm_core.corpus.family_words`."""
    assert PHRASE_GESTURES_FILE.read_bytes() == phrase_gestures()


def test_nearly_every_phrase_has_its_gesture_and_none_another() -> None:
    """The test takes every 50th phrase. A phrase without a gesture is one that several gestures share."""
    found: list[tuple[str, str]] = []
    for gesture in gestures():
        family, _, direction = gesture.partition("/")
        said = [p.replace("{D}", direction).replace("{S}", "left") for _, p in plain_phrases(family, direction)[::50]]
        found += [(gesture, gesture_of_phrase(re.sub(r"{.}", "", p))) for p in said if not is_withheld(p)]
    assert not [one for one in found if one[1] and one[0] != one[1]]
    assert sum(one[1] != "" for one in found) > 0.75 * len(found) > 500
