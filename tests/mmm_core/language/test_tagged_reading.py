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
from mmm_core.language.tagged_reading import Meanings, read_with_tags
from mmm_core.language.tagged_words import TAGS, words_of

SENTENCES = (
    "clap, but do not bow",
    "wave with anything but your left hand",
    "don't nod at me, young man",
    "nod and then wave twice",
)


def _read(marked: str) -> tuple[list[list[str]], tuple[str, ...]]:
    sentence, tags = read_marked(marked)
    reading = read_with_tags(read(sentence), tags)
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
        ("[2 Blow a kiss], but [1 put your hand on your heart] beforehand, and end on [3 a little bow]",
         [["put your hand on your heart"], ["blow a kiss"], ["a bow (0.6 times as large)"]]),
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


def test_a_denial_of_the_rules_is_kept_where_the_tags_have_none() -> None:
    sentence, tags = read_marked("Don't you go [1 nodding at me], young man.")
    assert read_with_tags(read(sentence), tags).denied


@pytest.mark.parametrize(
    ("marked", "likely", "steps"),
    [
        ("[1a Punching left], [1b a heart above you], lads", ("punch left", "a heart above you"),
         [["punch left", "a heart above you"]]),
        ("[1 A shrug], I would say", ("a shrug",), [["a shrug"]]),
        ("[1 A shrug], I would say", (), [["a shrug, I would say"]]),
    ],
)  # fmt: skip
def test_words_that_name_no_act_are_commands_where_they_are_likely(
    marked: str, likely: tuple[str, ...], steps: list[list[str]]
) -> None:
    sentence, tags = read_marked(marked)
    said = [command.text for step in read(sentence).steps for command in step]

    def how_likely(reading: Reading) -> float:
        return min(float(command.text in likely) for step in reading.steps for command in step)

    assert said != [text for step in steps for text in step] or not likely
    found = read_with_tags(read(sentence), tags, Meanings(how_likely))
    assert [[command.text.lower() for command in step] for step in found.steps] == [
        [text.lower() for text in step] for step in steps
    ]


def test_what_a_likely_reading_does_not_deny_is_not_done() -> None:
    sentence, tags = read_marked("There is no need for [1 that thing with the fists]")
    rules = read(sentence)
    assert read_with_tags(rules, tags, Meanings(lambda reading: float(reading != rules))) == rules


def test_tags_without_a_command_leave_the_reading_of_the_rules() -> None:
    sentence = "wave and so on, if you like"
    by_rules = read(sentence)
    assert read_with_tags(by_rules, read_marked(sentence)[1]) is by_rules


@pytest.mark.parametrize(
    ("marked", "meant", "steps", "denied"),
    [
        # words that the rules cannot complete mean a gesture in their sentence
        ("[1 Twist to the left]; [2 likewise clockwise]", ("twist/left", "twist/right"),
         [["twist to the left"], ["turn your upper body to the right"]], ()),
        # both divide alike: the rules' words stay where they are a phrase of the corpus
        ("[1 clap your hands], then [2 it's a wee tune on the tin whistle]", ("clap", "flute"),
         [["clap your hands"], ["play the flute"]], ()),
        # what a sentence that may deny does not ask for is denied
        ("[1 clapping] is for the others and not for you, who [2 bow]", (OUTSIDE, "bow"), [["bow politely"]], ("clap",)),
    ],
)  # fmt: skip
def test_what_a_command_means_in_its_sentence(
    marked: str, meant: tuple[str, ...], steps: list[list[str]], denied: tuple[str, ...]
) -> None:
    sentence, tags = read_marked(marked)
    meanings = Meanings(lambda _: 1.0, lambda _: [Meant(name, 0.95) for name in meant])
    found = read_with_tags(read(sentence), tags, meanings)
    assert [[command.text.lower() for command in step] for step in found.steps] == steps
    assert found.denied == denied


def test_tags_alone_do_not_divide_what_surely_is_one_gesture() -> None:
    sentence, tags = read_marked("[1 Hammer the nail in], [2 pull that face] when you do")
    by_rules = Reading(sentence, ((PlainCommand("hammer the nail in"),),))
    assert len(read_with_tags(by_rules, tags).steps) == 2
    assert read_with_tags(by_rules, tags, Meanings(whole=Meant("hammer", 0.9))) == by_rules


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
    tags = data.draw(st.lists(st.sampled_from(TAGS), min_size=n_words, max_size=n_words))
    reading = read_with_tags(read(sentence), tags)
    assert reading.text == sentence
    assert reading.steps or reading.denied


@given(st.sampled_from(SENTENCES), st.data())
def test_whatever_the_tags_what_the_rules_deny_stays_denied(sentence: str, data: st.DataObject) -> None:
    n_words = len(words_of(sentence))
    by_rules = read(sentence)
    reading = read_with_tags(by_rules, data.draw(st.lists(st.sampled_from(TAGS), min_size=n_words, max_size=n_words)))
    assert bool(reading.denied) or not by_rules.denied


def _reading(steps: list[list[str]], denied: tuple[str, ...] = ()) -> Reading:
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
    given = _reading(steps, denied)
    found = without_asides(given, {command.text: Meant("clap", 0.2) for step in given.steps for command in step})
    assert [[command.text for command in step] for step in found.steps] == kept
    assert len(found.notes) == sum(map(len, steps)) - sum(map(len, kept))


def test_what_probably_means_a_gesture_is_no_aside() -> None:
    given = _reading([["the robot dance"], ["clap your hands"]])
    assert without_asides(given, {"the robot dance": Meant("robot", 0.95)}) == given
    given = _reading([["your left side should sway"], ["clap your hands"]])
    assert without_asides(given, {"your left side should sway": Meant("sway", 0.6)}) == given


def test_what_is_no_gesture_beside_a_denial_is_no_command() -> None:
    thanks = {"thanks very much": Meant(OUTSIDE, 0.95)}
    assert without_asides(_reading([["thanks very much"]], ("salute",)), thanks).steps == ()
    assert len(without_asides(_reading([["thanks very much"], ["clap"]]), thanks).steps) == 2, "the scope says so"
    assert without_asides(_reading([["thanks very much"]]), thanks).steps
    assert without_asides(
        _reading([["thanks very much"]], ("salute",)), {"thanks very much": Meant(OUTSIDE, 0.8)}
    ).steps
