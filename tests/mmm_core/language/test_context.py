"""What a text means after another command, rule by rule, and the texts that stand by themselves whatever came before."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.language.command_changes import NothingToReferToError
from mmm_core.language.commands import MOST_STEPS, PlainCommand, exactly, read_exactly
from mmm_core.language.context import InContext, conversation, in_context
from mmm_core.language.manner import Manner
from mmm_core.language.reading import read
from mmm_core.language.stop_words import means_stop

WAVE, LOOK, CLAP, LEAN = "wave with your right hand", "look left", "clap three times", "lean forward"


def after(before: str, text: str) -> str:
    """What a text means after another one, steps joined by "; "."""
    meant = in_context(text, read(before))
    assert meant is not None, text
    return "; ".join(meant.reading.sentences)


@pytest.mark.parametrize(
    ("before", "text", "meant"),
    [
        (WAVE, "again", WAVE), (WAVE, "once more, please", WAVE), (WAVE, "agian", WAVE), (WAVE, "ok now do that again", WAVE),
        (WAVE, "encore!", WAVE), (WAVE, "repeat that", WAVE), ("nod, then bow", "the same again", "nod; bow"),
        (WAVE, "slower", f"{WAVE} (0.65 times as fast)"), (WAVE, "not so fast", f"{WAVE} (0.65 times as fast)"),
        (WAVE, "do it again but a lot faster", f"{WAVE} (2 times as fast)"), (WAVE, "a bit faster", f"{WAVE} (1.2 times as fast)"),
        ("nod slowly", "slower", "nod (0.5 times as fast)"), ("nod slowly", "at normal speed", "nod"),
        (LEAN, "bigger", f"{LEAN} (1.4 times as large)"), (LEAN, "not so far", f"{LEAN} (0.65 times as large)"),
        (WAVE, "with the other hand", "wave with your left hand"), (WAVE, "no, the other hand", "wave with your left hand"),
        ("salute", "the other one", "salute with your left hand"), ("raise your left arm", "switch sides", "raise your right arm"),
        (WAVE, "and now the left", "wave with your left hand"), (LOOK, "to the right", "look to the right"),
        ("left hand on your heart and salute with the right", "with the other hand",
         "put your right hand on your heart + salute with your left hand"),
        (LOOK, "the other way", "look to the right"), (LEAN, "and in the other direction", "lean back"),
        (LOOK, "and up", "look up"),
        (WAVE, "with both hands", "wave with both hands"), ("raise your left arm", "both", "raise both arms"),
        (CLAP, "two more", "clap twice"), (CLAP, "one more clap", "clap once"), ("nod", "four more times please", "nod four times"),
        ("give me two nods", "three more", "give me three nods"), ("nod", "a few more", "nod three times"),
        ("raise your right arm", "lower it slowly", "lower your right arm (0.62 times as fast)"),
        (WAVE, "salute with the other hand", "salute with your left hand"),
        (WAVE, "once more, slower and with the other hand", "wave with your left hand (0.65 times as fast)"),
    ],
)  # fmt: skip
def test_a_text_that_refers_to_the_last_command(before: str, text: str, meant: str) -> None:
    assert after(before, text) == meant


@pytest.mark.parametrize("text", ["keep going", "don't stop", "keep it up", "go on", "carry on", "over and over again"])
def test_what_keeps_going_goes_round_and_a_pose_is_held(text: str) -> None:
    waving, raising = in_context(text, read(WAVE)), in_context(text, read("raise both arms"))
    assert waving is not None and waving.keeps_going and not waving.is_pose
    assert raising is not None and raising.keeps_going and raising.is_pose


def test_times_of_several_commands_or_of_a_pose_are_those_of_the_whole() -> None:
    several, pose = in_context("three more", read("nod, then bow")), in_context("twice more", read(LOOK))
    assert several is not None and several.times == 3 and len(several.reading.steps) == 2
    assert pose is not None and pose.times == 2


@pytest.mark.parametrize(
    "text",
    [
        "now clap", "clap again and again with joy", "both arms up", "raise your left arm", "say hello", "wave to them",
        "make it so", "two more claps", "left hand up", "play the same song on the guitar", "look at the other people",
        "stop waving and clap", "bow once more to the king", "turn left", "hold a bigger box", "a slow dance",
        "thanks", "yes", "right",
    ],
)  # fmt: skip
def test_a_text_that_stands_by_itself(text: str) -> None:
    assert in_context(text, read("nod")) is None


@pytest.mark.parametrize(
    "text", ["again", "slower", "with the other hand", "the other way", "both", "three more", "keep going"]
)
def test_without_a_command_before_there_is_nothing_to_refer_to(text: str) -> None:
    for before in (None, read("do not bow")):
        with pytest.raises(NothingToReferToError, match="refers to a command before it"):
            in_context(text, before)


@pytest.mark.parametrize(
    ("before", "text"),
    [("nod", "with the other hand"), ("clap", "the other way"), (LOOK, "both"), ("clap", "with the other hand"),
     ("left hand on your heart and salute with the right", "both")],
)  # fmt: skip
def test_what_the_last_command_has_not_cannot_be_changed(before: str, text: str) -> None:
    with pytest.raises(NothingToReferToError, match="the last command was"):
        in_context(text, read(before))


@pytest.mark.parametrize("text", ["left", "up", "with your left hand", "say hello", "not so fast"])
def test_words_that_mean_something_alone_do_without_a_command(text: str) -> None:
    assert in_context(text, None) is None


@pytest.mark.parametrize("text", ["stop that", "no, stop that", "stop doing that", "don't do that"])
def test_to_stop_that_is_a_stop_like_any_other(text: str) -> None:
    assert means_stop(text)


def test_a_conversation_continues_from_the_meaning_and_not_from_a_denial() -> None:
    meant = conversation(["wave", "slower", "with the other hand", "do not bow", "twice more"])
    last = meant[-1]
    assert last.reading.sentences == ("wave with your left hand twice (0.65 times as fast)",)  # type: ignore[union-attr]


PHRASES = ["again", "slower", "bigger", "with the other hand", "the other way", "both", "three more", "keep going", "left", "up",
           "and", "wave with your left hand", "nod", "look up", "raise your arm, then bow",
           "it", "twice", "no", "faster", "do not clap"]  # fmt: skip


@given(st.lists(st.sampled_from(PHRASES), min_size=1, max_size=4).map(" ".join), st.sampled_from(PHRASES))
def test_whatever_is_meant_can_be_written_and_read_exactly(text: str, before: str) -> None:
    try:
        meant = in_context(text, read(before))
    except NothingToReferToError:
        return
    if meant is not None:
        steps = meant.reading.steps
        again = read(exactly(steps)).steps
        assert [[c.text for c in s] for s in again] == [[c.text for c in s] for s in steps]
        for ours, theirs in zip((c for s in steps for c in s), (c for s in again for c in s), strict=True):
            assert theirs.manner.tempo == pytest.approx(ours.manner.tempo, rel=0.05)
            assert theirs.manner.size == pytest.approx(ours.manner.size, rel=0.05)


@pytest.mark.parametrize(
    "text",
    ["wave (0.5 times as fast)", "exactly:", "exactly: wave + ", "exactly: wave (blue)", "exactly: (2)",
     "exactly: " + "nod; " * MOST_STEPS + "nod",
     "exactly: a + b + c + d"],
)  # fmt: skip
def test_a_text_that_is_not_written_exactly(text: str) -> None:
    assert read_exactly(text) is None


def test_what_is_written_exactly_stays_within_its_bounds() -> None:
    (step,) = read("exactly: wave (9 times as fast, 0.1 times as large, for 99 s)").steps
    assert step[0] == PlainCommand("wave", Manner(2.0, 1 / 1.8, 30.0), frozenset({"some_arm"}))


@pytest.mark.parametrize(
    ("texts", "sentence"),
    [
        (("nod", "a hundred times"), "nod thirty times"), (("nod", "200 times"), "nod thirty times"),
        (("clap slowly", "normal"), "clap"), (("raise your left arm", "lower"), "lower your left arm"),
    ],
)  # fmt: skip
def test_follow_ups_that_became_other_motions(texts: tuple[str, ...], sentence: str) -> None:
    """The words "a hundred times" alone raised one hand and waved the other."""
    found = conversation(texts)[-1]
    assert isinstance(found, InContext) and found.reading.sentences == (sentence,)


def test_a_number_alone_has_nothing_to_refer_to() -> None:
    with pytest.raises(NothingToReferToError):
        conversation(["a hundred times"])
