"""Words that look like something the reader knows and mean something else stay as they are."""

import pytest

from mmm_core.language.reading import read


def words(sentence: str) -> list[str]:
    return [command.text for step in read(sentence).steps for command in step]


@pytest.mark.parametrize(
    ("sentence", "commands"),
    [
        ("heed the faint sound", ["heed the faint sound"]),
        ("someone inches his way up a rope", ["someone inches his way up a rope"]),
        ("the person lets his shoulders drop", ["the person lets his shoulders drop"]),
        ("your left hand swings up from below and lets go", ["your left hand swings up from below and lets go"]),
        ("lets wave", ["wave"]),
        ("ok lets clap", ["clap"]),
        ("a hand up in the air", ["a hand up in the air"]),
        ("there is a balloon up in the air", ["look up"]),
        ("act as if you hand out cards", ["act as if you hand out cards"]),
        ("raise you left hand", ["raise your left hand"]),
        ("hammer your chest with one fist after the other", ["hammer your chest with one fist after the other"]),
        ("use the right for waving; the left does nothing", ["wave with your right hand"]),
        ("use the right hand", ["use the right hand"]),
        ("one arm up, then the other", ["raise your right hand", "raise your left hand"]),
    ],
)
def test_a_word_is_taken_for_another_only_where_it_stands_for_it(sentence: str, commands: list[str]) -> None:
    assert words(sentence) == commands


@pytest.mark.parametrize(
    ("sentence", "n"),
    [
        ("tell the robot to take the ladle in its left hand and stir twice", 1),
        ("act as if you reach up for the top shelf and take something down with the left arm", 1),
        ("a person miming how they reach up for the shelf and take something down using the right arm", 1),
        ("put your weight and shoulders over your right leg", 1),
        ("a plus sign made by your body and arms for 4 seconds", 1),
        ("raise your left hand and nod your head", 2),
        ("nod your head and arms wide", 2),
        ("left hand on your heart and salute with the right", 2),
    ],
)
def test_what_one_gesture_lists_is_not_parted(sentence: str, n: int) -> None:
    assert len(words(sentence)) == n


def test_a_hold_begins_with_a_word_and_not_within_one() -> None:
    """The pattern of "and holding it for" began within "hand holding it for", so that a hand became an "h"."""
    (step,) = read("a glug of wine with your left hand holding it for three seconds").steps
    assert step[0].text == "a glug of wine with your left hand" and step[0].manner.hold_s == 3.0


def test_way_is_a_size_only_where_it_is_an_adverb() -> None:
    assert read("lean way back").steps[0][0].manner.size > 1.2
    assert read("a human gives way to me with a sweep of their left hand").steps[0][0].manner.plain
