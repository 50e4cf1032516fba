"""Reading of sentences whose words are tagged: the tags are written as marks (`mmm_core.corpus.marked_sentences`)."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.corpus.marked_sentences import read_marked
from mmm_core.language.asides import without_asides
from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.plain_gestures import OUTSIDE, Meant
from mmm_core.language.reading import read
from mmm_core.language.sure_reading import is_sure
from mmm_core.language.tagged_reading import can_be_read, reading_of, without_splits
from mmm_core.language.tagged_words import TAGS, marked_commands, words_of


def _reading(marked: str, *meant: str) -> Reading:
    sentence, tags = read_marked(marked)
    return reading_of(sentence, marked_commands(sentence, tags), [Meant(name, 0.95) for name in meant])


def _read(marked: str, *meant: str) -> tuple[list[list[str]], tuple[str, ...]]:
    reading = _reading(marked, *meant)
    return [[command.sentence for command in step] for step in reading.steps], reading.denied


@pytest.mark.parametrize(
    ("marked", "steps"),
    [
        ("[1a Swing your right arm forwards] and [1b the left backwards].",
         [["swing your right arm forwards", "swing your left arm backwards"]]),
        ("[1a hold your left palm up] and [1b the right one down]",
         [["hold your left palm up", "hold your right palm down"]]),
        ("[1 lean to the right a little] and [2 to the left a lot]",
         [["lean to the right (0.6 times as large)"], ["lean to the left (1.4 times as large)"]]),
        ("Start by [1 saluting], follow with [2 a quick nod], and finish with [3 your hands behind your back].",
         [["salute"], ["a nod (1.6 times as fast)"], ["put your hands behind your back"]]),
        ("[* all slowly and with your left hand]: [1 wave], [2 salute]",
         [["wave with your left hand (0.62 times as fast)"], ["salute with your left hand (0.62 times as fast)"]]),
        ("[1 look up], then [2 down], then [3 at me] and [4 wave]",
         [["look up"], ["look down"], ["look straight ahead"], ["wave"]]),
    ],
)  # fmt: skip
def test_each_marked_command_is_completed_and_read_by_the_rules(marked: str, steps: list[list[str]]) -> None:
    assert _read(marked)[0] == steps


def test_what_is_denied_is_kept_apart() -> None:
    assert _read("I said not to [- clap] so [1 shrug] for them") == ([["shrug"]], ("clap",))


@pytest.mark.parametrize(
    ("marked", "meant", "steps", "denied"),
    [
        # words that the rules cannot complete mean a gesture in their sentence
        ("[1 Twist to the left]; [2 likewise clockwise]", ("twist/left", "twist/right"),
         [["twist to the left"], ["turn your upper body to the right"]], ()),
        # what is a phrase of the corpus stays as it is
        ("[1 knock on the door], then [2 it's a wee tune on the tin whistle]", ("knock", "flute"),
         [["knock on the door"], ["play the flute"]], ()),
        # what a sentence that may deny does not ask for is denied
        ("[1 clapping] is for the others and not for you, who [2 bow]", (OUTSIDE, "bow"), [["bow politely"]], ("clap",)),
    ],
)  # fmt: skip
def test_what_a_command_means_in_its_sentence(
    marked: str, meant: tuple[str, ...], steps: list[list[str]], denied: tuple[str, ...]
) -> None:
    found = _reading(marked, *meant)
    assert [[command.text.lower() for command in step] for step in found.steps] == steps
    assert found.denied == denied


@pytest.mark.parametrize(
    ("sentence", "tags", "without"),
    [
        ("shrug your shoulders", "then then inside", "then inside inside"),
        ("nod shrug", "then then", "then then"),
        (
            "with the left hold a cup",
            "then inside inside with inside inside",
            "then inside inside inside inside inside",
        ),
    ],
)
def test_a_command_begins_with_a_verb_or_after_a_word_between(sentence: str, tags: str, without: str) -> None:
    assert without_splits(sentence, tags.split()) == without.split()


@pytest.mark.parametrize(
    "sentence", ["wave", "Nod your head.", "turn your head left, then right", "arms wide and nod", "a big bow"]
)
def test_rules_are_sure_of_short_commands(sentence: str) -> None:
    assert is_sure(read(sentence))


@pytest.mark.parametrize(
    "sentence",
    [
        "Stretch upward and when you're done let everything hang loose",
        "put your hand on your heart, which I would like to see once you have blown a kiss",
    ],
)
def test_rules_are_not_sure_where_words_that_join_are_left(sentence: str) -> None:
    assert not is_sure(read(sentence))


@given(st.text(st.characters(codec="utf-8"), max_size=60), st.data())
def test_any_text_with_any_tags_is_read(sentence: str, data: st.DataObject) -> None:
    n_words = len(words_of(sentence))
    marked = marked_commands(sentence, data.draw(st.lists(st.sampled_from(TAGS), min_size=n_words, max_size=n_words)))
    if can_be_read(marked):
        reading = reading_of(sentence, marked)
        assert reading.text == sentence
        assert [len(step) for step in reading.steps] == [len(step) for step in marked.steps]
        assert reading.denied == marked.denied


def _given(steps: list[list[str]], denied: tuple[str, ...] = ()) -> Reading:
    return Reading("said", tuple(tuple(PlainCommand(text) for text in step) for step in steps), denied)


@pytest.mark.parametrize(
    ("steps", "denied", "kept"),
    [
        ([["we will"], ["clap your hands"]], (), [["clap your hands"]]),
        ([["you are grand"]], ("rubbing your hands",), []),
        ([["hook"], ["a left"]], (), [["hook"], ["a left"]]),
        ([["clap twice"], ["another three times"]], (), [["clap twice"], ["another three times"]]),
        ([["cover your mouth"], ["fixing your hat"]], (), [["cover your mouth"], ["fixing your hat"]]),
        ([["pitch it overhand"]], ("the underhand nonsense",), [["pitch it overhand"]]),
        ([["missus"]], (), [["missus"]]),
        ([["run away"], ["clap"]], (), [["run away"], ["clap"]]),
        ([["twirl"], ["clap"]], ("bow",), [["twirl"], ["clap"]]),
        ([["your hands should clap"]], ("bow",), [["your hands should clap"]]),
    ],
)
def test_what_is_no_command_is_left_out_beside_one_or_a_denial(
    steps: list[list[str]], denied: tuple[str, ...], kept: list[list[str]]
) -> None:
    given = _given(steps, denied)
    found = without_asides(given, {command.text: Meant("clap", 0.2) for step in given.steps for command in step})
    assert [[command.text for command in step] for step in found.steps] == kept
    assert len(found.notes) == sum(map(len, steps)) - sum(map(len, kept))


def test_what_probably_means_a_gesture_is_no_aside() -> None:
    given = _given([["the robot dance"], ["clap your hands"]])
    assert without_asides(given, {"the robot dance": Meant("robot", 0.95)}) == given
    given = _given([["your left side should sway"], ["clap your hands"]])
    assert without_asides(given, {"your left side should sway": Meant("sway", 0.6)}) == given


def test_what_is_no_gesture_beside_a_denial_is_no_command() -> None:
    thanks = {"thanks very much": Meant(OUTSIDE, 0.95)}
    assert without_asides(_given([["thanks very much"]], ("salute",)), thanks).steps == ()
    assert len(without_asides(_given([["thanks very much"], ["clap"]]), thanks).steps) == 2, "the scope says so"
    assert without_asides(_given([["thanks very much"]]), thanks).steps
    assert without_asides(_given([["thanks very much"]], ("salute",)), {"thanks very much": Meant(OUTSIDE, 0.8)}).steps
