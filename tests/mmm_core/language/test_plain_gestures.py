"""Plain commands for gestures, and readings in which they take the place of other words."""

from __future__ import annotations

import pytest

from mmm_core.corpus.families import FAMILIES
from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.limbs import limbs_of
from mmm_core.language.plain_gestures import (
    OUTSIDE,
    SEVERAL,
    SURE,
    SURE_OF_ALL,
    SURELY_DENIED,
    Meant,
    gesture_of,
    gestures,
    in_plain_words,
    plain_command,
    plainly_said,
    without_denied_acts,
    without_unasked,
)
from mmm_core.language.reading import read


def test_each_gesture_of_the_corpus_has_a_plain_command() -> None:
    assert list(gestures()) == [f"{n}/{d}" if d else n for n, f in FAMILIES.items() for d in f.directions or ("",)]


def test_a_plain_command_is_read_as_itself() -> None:
    said = ("x", "with your left hand", "with your right arm", "with both hands", "x three times")
    for command in filter(None, (plain_command(gesture, words) for gesture in gestures() for words in said)):
        ((one,),) = read(command).steps
        assert one.manner.plain
        assert one.text == command


@pytest.mark.parametrize(
    ("gesture", "said", "command"),
    [
        ("knock", "rap on the hatch", "knock on the door"),
        ("knock", "rap on the hatch twice with your left hand", "knock on the door with your left hand 2 times"),
        ("knock", "three bangs on the hatch", "knock on the door 3 times"),
        ("march_arms", "go for a march with your arms just once", "march with your arms once"),
        ("push", "shove it off with both hands", "push forward with both hands"),
        ("look/left", "what is over there on your left", "look to the left"),
        ("point/left", "show us the exit on the left with your right hand", "point to the left with your right hand"),
        ("hook", "a left hook at him", "throw a left hook"),
        ("wave", "say hello right away", "wave your hand"),
        ("raise", "left paw up to shoulder height", ""),
        ("raise", "left paw right overhead", ""),
        ("lift", "that crate goes above your head", ""),
        (
            "big_wave",
            "swing your whole left arm overhead",
            "swing your straight left arm above your head from side to side",
        ),
        ("heart_over_head", "a big love heart above your hair", "make a heart above your head"),
        ("hands_up", "hands up high in the air", "raise both hands up"),
        ("clap/up", "four claps up high, halfway to the ceiling", ""),
        ("punch", "have a go at the bag with each fist", ""),
        ("roll_arms", "forearms round each other five times", "roll your forearms around each other 5 times"),
        ("roll_head", "let your head go all the way round", "roll your head"),
        ("lean/forward", "over you go, all the way", ""),
        ("dab", "do that dab thing with your left arm", ""),
    ],
)
def test_arm_and_number_are_kept_or_nothing_is_said(gesture: str, said: str, command: str) -> None:
    assert plain_command(gesture, said) == command


def test_both_arms_of_words_that_name_none_are_kept() -> None:
    assert plain_command("catch", "catch the ball and bring it to your chest") == "catch a ball"
    assert (
        plain_command("catch", "catch the ball and bring it to your chest", both_arms=True)
        == "catch a ball with both hands"
    )


@pytest.mark.parametrize("said", ["throw hooks from both sides 6 times", "box like a champion", "flex your muscles"])
def test_a_plain_command_stays(said: str) -> None:
    """They name no arms that `plain_command` would find."""
    assert plainly_said(PlainCommand(said), Meant(gesture_of(said), 1.0)).text == said


def _words(reading: Reading) -> list[list[str]]:
    return [[command.text for command in step] for step in reading.steps]


def test_a_command_is_said_in_plain_words_where_its_gesture_is_likely() -> None:
    found = read("very slowly rap at the hatch, then bow")
    said = found.steps[0][0].text
    plain = in_plain_words(found, Meant(SEVERAL, 0.99), {said: Meant("knock", SURE)})
    assert _words(plain) == [["knock on the door"], [found.steps[1][0].text]]
    assert plain.steps[0][0].manner == found.steps[0][0].manner
    assert plain.steps[0][0].limbs == limbs_of("knock on the door")
    assert plain.text == found.text


@pytest.mark.parametrize("meant", [Meant("knock", SURE - 0.01), Meant(OUTSIDE, 0.99), Meant(SEVERAL, 0.99)])
def test_what_is_unlikely_or_no_gesture_stays(meant: Meant) -> None:
    found = read("rap at the hatch, then bow")
    assert in_plain_words(found, Meant(SEVERAL, 0.99), {"rap at the hatch": meant}) == found


def test_a_sentence_that_is_surely_one_gesture_is_one_command() -> None:
    several = read("nod, then bow")
    doubtful = {"nod": Meant(OUTSIDE, 0.9)}
    assert _words(in_plain_words(several, Meant("bow", SURE_OF_ALL), doubtful)) == [["bow politely"]]
    assert in_plain_words(several, Meant("bow", SURE_OF_ALL - 0.01), doubtful) == several
    assert in_plain_words(several, Meant("bow", SURE_OF_ALL), {}) == several
    denied = read("do not nod, bow")
    assert in_plain_words(denied, Meant("nod", 0.99), {}) == denied


def test_a_sentence_that_asks_for_nothing_has_no_commands() -> None:
    found = read("everyone but you is to clap, then bow")
    assert without_denied_acts(found, Meant(SEVERAL, 0.9, denied=SURELY_DENIED - 0.01)) == found
    nothing = without_denied_acts(found, Meant(SEVERAL, 0.9, denied=SURELY_DENIED))
    assert not nothing.steps
    told = read("clap, then bow")
    assert without_denied_acts(told, Meant(SEVERAL, 0.9, denied=1.0)) == told, "no word of it denies"
    assert nothing.denied == tuple(command.text for step in found.steps for command in step)


@pytest.mark.parametrize(
    ("said", "probability", "steps", "denied"),
    [
        ("no clap now, bow", 0.95, ["bow"], ("clap",)),
        ("no clap now, bow", 0.85, ["clap", "bow"], ()),
        ("now clap, bow", 0.95, ["clap", "bow"], ()),
    ],
)
def test_what_a_denying_sentence_does_not_ask_for_is_denied(
    said: str, probability: float, steps: list[str], denied: tuple[str, ...]
) -> None:
    given = Reading(said, ((PlainCommand("clap"),), (PlainCommand("bow"),)))
    found = without_unasked(given, [Meant(OUTSIDE, probability), Meant("bow", 0.99)])
    assert ([step[0].text for step in found.steps], found.denied) == (steps, denied)
    assert without_unasked(given, ()) == given
