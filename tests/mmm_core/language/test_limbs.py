"""Limbs of commands: the table's words, the corpus's own phrases, and gestures that are not taken for two at once."""

from __future__ import annotations

import numpy as np
import pytest

from mmm_core.corpus.families import FAMILIES
from mmm_core.corpus.family_words import family_phrases, limb_words
from mmm_core.language.limbs import limbs_of
from mmm_core.language.reading import read
from mmm_core.language.word_tables import LIMB_WORDS_FILE
from tests.support.sizes import few_and_long

PHRASES_EACH = 8


def phrases() -> list[tuple[str, str]]:
    """Some phrases of the corpus for each family, slots left out, with the family's limb."""
    rng = np.random.default_rng(7)
    drawn = [
        (" ".join(said[i].replace("^", "").split()).lower(), FAMILIES[family].limb)
        for family, said in family_phrases().items()
        for i in rng.choice(len(said), min(PHRASES_EACH, len(said)), replace=False)
    ]
    return [(text, limb) for text, limb in drawn if limb]


def test_the_table_of_limbs_is_made_of_the_phrases() -> None:
    """When this fails after phrases were changed: `python -m mmm_core.corpus.family_words`."""
    assert LIMB_WORDS_FILE.read_text(encoding="utf-8") == limb_words()


def test_the_limb_of_most_phrases_is_known_and_of_few_another() -> None:
    told = [(bool(found), limb in {"arm" if "arm" in name else name for name in found}) for text, limb in phrases()
            for found in [limbs_of(text)]]  # fmt: skip
    assert np.mean([known for known, _ in told]) > 0.88
    assert np.mean([known and not right for known, right in told]) < 0.03


@pytest.mark.parametrize("every", few_and_long([6], [1]))
def test_one_gesture_is_hardly_ever_taken_for_two(every: int) -> None:
    some = phrases()[::every]
    parted = [text for text, _ in some if sum(len(step) for step in read(text).steps) != 1]
    assert len(parted) < 0.03 * len(some)


@pytest.mark.parametrize(
    ("clause", "limbs"),
    [
        ("cup your ear", {"some_arm"}),
        ("pour some tea", {"some_arm"}),
        ("type a letter", {"some_arm"}),
        ("look at your watch", {"some_arm"}),
        ("look through your binoculars", {"left_arm", "right_arm"}),
        ("draw your bow", {"some_arm"}),
        ("let your head hang", {"head"}),
        ("admire the ceiling", {"head"}),
        ("totter to the side", {"trunk"}),
        ("shift your weight", {"trunk"}),
        ("look at the cup", {"head"}),
        ("smile", set()),
        ("count to three", set()),
        ("over your head", set()),
        ("go to the kitchen", set()),
        ("tell me a story", set()),
    ],
)
def test_limbs_of_words_that_name_none(clause: str, limbs: set[str]) -> None:
    assert limbs_of(clause) == limbs


@pytest.mark.parametrize(
    ("text", "together"),
    [
        ("lean forward and cup your right ear", ["lean forward", "cup your right ear"]),
        ("type something while nodding", ["type something", "nod"]),
        ("pour the tea as you look up", ["pour the tea", "look up"]),
    ],
)
def test_words_of_the_table_are_done_at_once(text: str, together: list[str]) -> None:
    assert [[c.text for c in step] for step in read(text).steps] == [together]


@pytest.mark.parametrize(
    "text",
    [
        "swear with your hand on your heart",
        "make a circle with your arms over your head",
        "lift your right hand and swear an oath",
        "hold your hands together over your head",
        "with your head, draw a circle",
        "nod and smile",
    ],
)
def test_what_is_one_gesture_stays_one(text: str) -> None:
    assert len(read(text).steps) == 1 and len(read(text).steps[0]) == 1


@pytest.mark.parametrize(
    ("text", "commands"),
    [
        ("drum with both hands, head nodding along", "drum with both hands + nod along"),
        ("your left hand waves, your right hand salutes", "wave with your left hand + salute with your right hand"),
        ("looking to the left, wave with your right hand", "wave with your right hand + look to the left"),
        ("with a nod, wave your left hand", "wave your left hand + nod"),
        ("in one go: look left, raise your right arm", "look to the left + raise your right arm"),
        ("wave, your other hand on your heart", "wave with your right hand + put your left hand on your heart"),
        ("raise ur left hand n look right", "raise your left hand + look to the right"),
        (
            "your left hand should cover your mouth while your head looks down",
            "cover your mouth with your left hand + look down",
        ),
        ("keep your head down while you raise both arms", "look down + raise both arms"),
        ("clap, then your head shakes", "clap; your head shakes"),
        ("keep your arms down and nod", "nod"),
        ("wave with the other hand", "wave with the other hand"),
        ("looking good, robot", "looking good"),
        ("in one corner: a lamp", "in one corner: a lamp"),
    ],
)
def test_forms_of_at_once(text: str, commands: str) -> None:
    assert "; ".join(read(text).sentences) == commands
