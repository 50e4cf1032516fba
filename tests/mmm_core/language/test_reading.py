"""What is read in a sentence, kind by kind, and the sentences that each rule must leave alone."""

from __future__ import annotations

import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.corpus.family_words import corpus_words
from mmm_core.language.at_once import divided
from mmm_core.language.denial import without_denial
from mmm_core.language.ellipsis import completed
from mmm_core.language.limbs import limbs_of
from mmm_core.language.manner import Manner, manner_of
from mmm_core.language.reading import read
from mmm_core.language.slips import mended_word
from mmm_core.language.spelling import mended
from mmm_core.language.word_tables import CORPUS_WORDS_FILE


def said(text: str) -> list[list[str]]:
    """Texts of the commands that are read, in turn and at once."""
    return [[c.text for c in step] for step in read(text).steps]


@pytest.mark.parametrize(
    "text",
    [
        "turn your head right and back", "lean back", "do not move until I tell you", "a left wave", "lopen dansen", "mira arriba",
        "nod to the second person on your left", "shake up and down", "raise your left hand and wave", "draw a circle in the air",
    ],
)  # fmt: skip
def test_what_the_tables_of_orders_and_corrections_leave_alone(text: str) -> None:
    assert len(read(text).steps) <= 1
    assert all(len(step) == 1 for step in read(text).steps)
    assert all(c.text.split()[-1] == text.rsplit(maxsplit=1)[-1] for step in read(text).steps for c in step)


@pytest.mark.parametrize(
    "text",
    ["wave with your right hand", "Clap your hands twice!", "play the guitar", "act like a zombie", "look around", "stir the soup",
     "point to the left", "wave like there is no tomorrow", "nod your head up and down", "make a stop sign", "dance the macarena"],
)  # fmt: skip
def test_a_plain_sentence_is_passed_on_as_it_is(text: str) -> None:
    reading = read(text)
    assert reading.plain and said(text) == [[text]]


class TestSlips:
    @pytest.mark.parametrize(
        ("text", "plain"),
        [
            ("wave um wave your left hand", "wave your left hand"), ("rays your right arm", "raise your right arm"),
            ("salute with your write hand", "salute with your right hand"), ("take a bough", "take a bow"),
            ("cover your mouse", "cover your mouth"), ("play the violet", "play the violin"),
            ("lock up the shop", "lock up the shop"), ("wave to the mouse", "wave to the mouse"),
            ("wave wiht yuor right hadn", "wave with your right hand"), ("clap 3 tmes", "clap 3 times"),
            ("WAVE  PLZ", "wave please"), ("nod — sloooowly", "nod , slowly"),
            ("turn you head to the right", "turn your head to the right"),
        ],
    )  # fmt: skip
    def test_mended(self, text: str, plain: str) -> None:
        assert mended(text) == plain

    @pytest.mark.parametrize(
        "text",
        ["write a letter in the air", "the bough of a tree", "wave to beyonce", "do the macarena", "kneel", "twerk",
         "a selfie pose",          "pet the cat", "solve it", "lien holder", "dabbing",
         "salute captain picard", "left rather than right", "verbeuge dich"],
    )  # fmt: skip
    def test_what_is_right_or_foreign_stays(self, text: str) -> None:
        assert mended(text) == text

    @pytest.mark.parametrize("word", ["Grandma", "tango", "karaoke", "robbie", "biceps", "waving", "nods"])
    def test_words_that_stay(self, word: str) -> None:
        assert mended_word(word) == word


class TestDenial:
    @pytest.mark.parametrize(
        ("text", "rest", "denied"),
        [
            ("do not wave, nod", "nod", ("wave",)),
            ("instead of waving, salute", "salute", ("waving",)),
            ("not a bow but a nod", "a nod", ("a bow",)),
            ("look left, not right", "look left", ("right",)),
            ("wave but leave your right arm alone", "wave with your left hand", ("the right arm",)),
        ],
    )
    def test_kept_apart(self, text: str, rest: str, denied: tuple[str, ...]) -> None:
        found = without_denial(text)
        assert (found.rest, found.denied) == (rest, denied)

    @pytest.mark.parametrize(
        "text", ["no idea", "i do not know", "stop the traffic", "say no", "shake your head no", "never give up", "do not shoot",
                 "wave like there is no tomorrow", "not only nod but also clap"],
    )  # fmt: skip
    def test_no_denial(self, text: str) -> None:
        assert not without_denial(text).denied

    def test_not_stopping_is_doing(self) -> None:
        assert without_denial("do not stop waving").rest == "waving"

    def test_anything_else_may_be_done(self) -> None:
        reading = read("do anything but nod")
        assert reading.denied == ("nod",) and "nod" not in reading.words and reading.steps


class TestManner:
    @pytest.mark.parametrize(
        ("clause", "rest", "tempo", "size"),
        [
            ("nod slowly", "nod", -1, 0), ("clap as fast as you can", "clap", 1, 0), ("give a tiny bow", "give a bow", 0, -1),
            ("lean a little to the left", "lean to the left", 0, -1), ("bow as deep as you can", "bow", 0, 1),
            ("shrug your shoulders in an exaggerated way", "shrug your shoulders", 0, 1),
        ],
    )  # fmt: skip
    def test_taken_out(self, clause: str, rest: str, tempo: int, size: int) -> None:
        words, manner = manner_of(clause)
        assert words == rest
        assert ((manner.tempo > 1) - (manner.tempo < 1), (manner.size > 1) - (manner.size < 1)) == (tempo, size)

    @pytest.mark.parametrize(
        "clause", ["point at the little bird", "fast food", "a big heart over your head", "eat a tiny cake", "slow"]
    )
    def test_words_of_things_are_no_manner(self, clause: str) -> None:
        assert manner_of(clause) == (clause, Manner())

    def test_very_is_stronger(self) -> None:
        assert manner_of("nod very slowly")[1].tempo < manner_of("nod slowly")[1].tempo

    @pytest.mark.parametrize(
        ("clause", "seconds"), [("salute and hold it for four seconds", 4), ("look up for 2 seconds", 2), ("nod", 0)]
    )
    def test_holds(self, clause: str, seconds: float) -> None:
        assert manner_of(clause)[1].hold_s == seconds


class TestAtOnce:
    @pytest.mark.parametrize(
        ("clause", "limbs"),
        [
            ("wave with your left hand", {"left_arm"}), ("shake your head", {"head"}), ("scratch your head", {"some_arm"}),
            ("bow", {"trunk"}), ("clap", {"left_arm", "right_arm"}), ("point to the left", {"some_arm"}),
            ("think hard", {"some_arm"}), ("stay", set()), ("bow your head", {"head"}),
        ],
    )  # fmt: skip
    def test_limbs(self, clause: str, limbs: set[str]) -> None:
        assert limbs_of(clause) == limbs

    @pytest.mark.parametrize(
        "clause", ["raise your hand and wave", "wave to the kids and the parents", "clap and bow", "look left and right",
                   "pat the dog on its head", "wave with your right hand"],
    )  # fmt: skip
    def test_one_or_in_turn(self, clause: str) -> None:
        assert divided(clause) == [clause]

    @pytest.mark.parametrize(
        ("text", "n_commands"),
        [
            ("a soldier's greeting, right hand to the eyebrow", 1),
            ("salute, left hand to your brow", 1),
            ("a nod, right hand to your heart", 2),
            ("a wave, left hand on your hip", 2),
        ],
    )
    def test_a_hands_way_says_how_where_no_other_limb_is_meant(self, text: str, n_commands: int) -> None:
        assert [len(step) for step in read(text).steps] == [n_commands]

    def test_the_same_limb_follows_and_it_is_said(self) -> None:
        reading = read("clap while you wave with your left hand")
        assert [len(step) for step in reading.steps] == [1, 1] and reading.notes


class TestEllipsis:
    @pytest.mark.parametrize(
        "clause", ["nod", "clap your hands", "point to the door", "lean back", "salute with your left hand"]
    )
    def test_whole_clauses_take_nothing(self, clause: str) -> None:
        assert completed(clause, "wave with your right hand") is None


@given(st.text(max_size=80))
def test_any_text_is_read(text: str) -> None:
    reading = read(text)
    assert all(c.text for step in reading.steps for c in step) or not text.strip()


def test_reading_takes_less_than_two_milliseconds() -> None:
    texts = [
        "turn your head left, then right",
        "left hand on your heart and salute with the right",
        "bwo deeply and shurg",
    ] * 20
    read(texts[0])
    worked = time.process_time()
    for i, text in enumerate(texts):
        read(f"{text} {i} times")
    assert (time.process_time() - worked) / len(
        texts
    ) < 0.02  # a bound against blow-ups; docs/language.md has the figure


def test_the_words_of_the_corpus_are_those_of_its_phrases() -> None:
    """When this fails after phrases or everyday words were changed: `python -m mmm_core.corpus.family_words`."""
    assert CORPUS_WORDS_FILE.read_text(encoding="utf-8") == corpus_words()


@pytest.mark.parametrize(
    "text",
    [
        "point your left hand at the door", "rotate your left arm", "peer to the right of the box", "tilt your head to the left",
        "rock the baby", "swing your right arm forward", "stare at the left door", "lean on your right hand",
    ],
)  # fmt: skip
def test_likely_words_of_other_gestures_stay(text: str) -> None:
    assert said(text) == [[text]]


@pytest.mark.parametrize(
    ("text", "commands"),
    [
        ("clap then bow then clap then bow then clap then bow", ["clap", "bow"] * 3),
        ("nod then wave then nod then wave then nod then wave then nod then wave", ["nod", "wave"] * 4),
        ("bow before you clap, but after nodding", ["nod", "bow", "clap"]),
        ("wave after you nod but before you bow", ["nod", "wave", "bow"]),
        ("lift your right arm lift your right arm", ["lift your right arm"]),
        ("raise your left arm, then lower", ["raise your left arm", "lower your left arm"]),
    ],
)  # fmt: skip
def test_commands_in_turn_are_all_there(text: str, commands: list[str]) -> None:
    """Repeated pairs were taken for a slip of the tongue, and an act between two others came last."""
    assert [command.text for step in read(text).steps for command in step] == commands


@pytest.mark.parametrize(
    ("text", "sizes"), [("bow deeply, then slightly", (1.4, 0.6)), ("wave widely, then a little", (1.4, 0.6))]
)
def test_each_command_has_its_own_size(text: str, sizes: tuple[float, float]) -> None:
    found = [command.manner.size for step in read(text).steps for command in step]
    assert found[1] == sizes[1] and found[0] in (1.0, sizes[0])  # "bow deeply" is a phrase of its own
