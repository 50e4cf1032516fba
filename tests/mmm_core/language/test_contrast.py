"""Contrast, words before a command, sides put right, orders told backwards and manner, each with what looks like it and is none."""

from __future__ import annotations

import pytest

from mmm_core.language.context import InContext, conversation
from mmm_core.language.denial import without_denial
from mmm_core.language.spelling import mended
from tests.support.readings import said


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        ("wave instead of bowing", "wave | not: bowing"),
        ("wave instead of just standing there", "wave | not: just standing there"),
        ("instead of standing around, wave", "wave | not: standing around"),
        ("nod rather than saying yes", "nod | not: saying yes"),
        ("wave rather than whatever you were doing", "wave | not: whatever you were doing"),
        ("bow in place of the wave", "bow | not: the wave"), ("wave with your left hand instead", "wave with your left hand"),
        ("instead of the left hand use the right hand and wave", "wave with your right hand | not: the left hand"),
        ("bow, no wait, wave instead", "wave"), ("stop clapping, start waving", "wave | not: clapping"),
        ("wave with anything but your right hand", "wave with your left hand | not: your right hand"),
        ("don't wave with both hands, one is enough", "wave with one hand"), ("no pressure, wave", "wave"),
        ("nod without moving your shoulders", "nod | not: your shoulders"),
        ("don't raise both arms, only the right", "raise your right arm"), ("forget what I said, just wave", "wave"),
        ("lift only your left arm", "lift your left arm"), ("nothing but a nod", "a nod"),
        ("don't bow yet, first wave", "wave | not: bow yet"),
        ("can't you wave", "wave"), ("isn't it time to bow", "bow"), ("wave, though not too fast", "wave (0.75 times as fast)"),
        ("do not panic, wave", "wave"), ("I know you want to clap, but please don't", " | not: that"),
        ("it's rude to point, so don't", " | not: point"), ("who told you to wave? don't", " | not: that"),
        ("point up w/o using the left", "point up with your right hand | not: the left"),
        ("keep your left hand out of it and nod", "nod | not: the left arm"),
        ("beckon with the right hand; meanwhile keep your left arm out to the side",
         "beckon with the right hand + raise your left arm to the side"),
        ("enough of the waving, nod", "nod | not: waving"),
        ("quit it with the air guitar already", " | not: air guitar already"), ("don't touch anything", " | not: touch anything"),
        ("you must not type anything now", " | not: type anything"), ("do anything but nod", "wave your right hand | not: nod"),
        ("dinnae point at folk", " | not: point at folk"), ("ditch the bow and clap your hands", "clap your hands | not: the bow"),
        ("no, don't clap yet, Mrs Baird's still talking", " | not: clap yet"),
        ("no need of shaking hands, nod", "nod | not: shaking hands"),
        ("fist bump me but lay off the left hand", "fist bump me with your right hand | not: the left hand"),
        ("lord no, don't you go beating your chest in my kitchen", " | not: beating your chest in my kitchen"),
        ("leave off with the clapping", " | not: the clapping"),
        ("You must never wave at my bus again, the driver stops every time", " | not: wave at my bus again"),
        ("For heaven's sake, nobody here wants a bow off thee", " | not: a bow off thee"),
        ("Don't salute with the left, that is disrespect, do it with the other hand", "salute with your right hand"),
        ("I'd thank you to refrain from flexing", " | not: flexing"),
        ("be informed that you must on no account yawn", " | not: yawn"),
        ("bruh if you dab one more time im leaving", " | not: dab one more time"),
        # and what looks like it
        ("be advised, wave", "be advised, wave"),
        ("no rush, wave", "wave (0.62 times as fast)"), ("don't rush, wave", "wave (0.62 times as fast)"),
        ("lose the hat and wave", "lose the hat, wave"), ("keep off the grass", "keep off the grass"),
        ("keep on waving", "keep on waving"), ("leave off waving", " | not: waving"),
        ("a nod will do, thank you", "a nod"), ("my hands are full, please wave", "wave"),
        ("do not shoot", "do not shoot"), ("tell me not to worry", "tell me not to worry"),
        ("never say never", "never say never"),
    ],
)  # fmt: skip
def test_contrast(text: str, read_as: str) -> None:
    assert said(text) == read_as


@pytest.mark.parametrize("text", ["no rush", "never say never", "do not shoot", "no worries", "do not panic"])
def test_nothing_is_denied(text: str) -> None:
    assert not without_denial(text).denied


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        ("your task: wave", "wave"), ("Your mission: salute", "salute"), ("all I ask is: bow", "bow"),
        ("all I ask is a bow", "a bow"),
        ("all I want is for you to bow", "bow"), ("my only wish: clap", "clap"),
        ("one request: raise your left hand", "raise your left hand"),
        ("make believe you are rowing a boat", "row a boat"), ("let's pretend you are driving a car", "drive a car"),
        ("mime how you open a door", "open a door"), ("today's exercise: twist to the left", "twist to the left"),
        ("the next move is a bow", "a bow"), ("your turn to wave", "wave"),
        # and what looks like it
        ("mime opening a door", "mime opening a door"), ("play the piano", "play the piano"),
        ("imitate a bird", "imitate a bird"),
        ("hush: cautioning me not to wake the baby", "hush: cautioning me not to wake the baby"),
    ],
)  # fmt: skip
def test_words_before_a_command(text: str, read_as: str) -> None:
    assert said(text) == read_as


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        ("raise your right arm. I said left, not right", "raise your left arm"),
        ("wave with your right hand. no, left, not right!", "wave with your left hand"),
        ("raise your hand. The left one, not the right", "raise your left hand"),
        ("ok so lift your left no wait your right arm lift your right arm", "lift your right arm"),
        # and what looks like it
        ("look left, not right", "look to the left | not: right"),
        ("point to the left, not the right", "point to the left | not: the right"),
        ("clap your hands and wave your hands", "clap your hands; wave your hands"),
    ],
)  # fmt: skip
def test_a_side_is_put_right(text: str, read_as: str) -> None:
    assert said(text) == read_as


def test_a_side_is_put_right_in_the_next_text() -> None:
    """'I said left, not right' was read as a command of its own, "left"."""
    *_, last = conversation(["raise your right arm", "I said left, not right"])
    assert isinstance(last, InContext) and last.reading.sentences == ("raise your left arm",)


@pytest.mark.parametrize(
    ("text", "plain"),
    [
        ("brb", "brb"),
        ("wave pls :)", "wave please"),
        ("idk", "i do not know"),
        ("gr8 job", "great job"),
        ("hii", "hi"),
        ("at 4:30", "at 4:30"),
    ],
)
def test_chat(text: str, plain: str) -> None:
    """'brb' became "bob", and "hii" "hip"."""
    assert mended(text) == plain


@pytest.mark.parametrize("word", ["buries", "hurries", "tidied", "prettier"])
def test_words_in_y_may_be_inflected(word: str) -> None:
    """'buries' became "carries" or "buried": another gesture."""
    assert mended(f"she {word} it") == f"she {word} it"


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        ("nod and after the nod wave", "nod; wave"), ("clap, then after a short break bow", "clap; bow"),
        ("salute before anything else, then clap", "salute; clap"), ("first of all wave, and to finish off, bow", "wave; bow"),
        ("nod prior to bowing", "nod; bow"), ("your last move should be a bow, start by waving", "wave; a bow"),
        ("shrug. That done, salute.", "shrug; salute"), ("finish by clapping but begin by nodding", "nod; clap"),
        ("when you're through with waving, clap", "wave; clap"),
        ("after nodding and before clapping, salute", "nod; clap; salute"),
        ("bow, then again but deeper", "bow; bow (1.3 times as large)"),
        ("clap three times, nod the same number", "clap three times; nod three times"),
        ("wave slowly, then quickly", "wave (0.62 times as fast); wave (1.6 times as fast)"),
        ("point left with one hand and right with the other", "point left with your left hand + point right with your right hand"),
        ("look both ways before you cross", "look to the left; look to the right"),
        ("Over there, look, on your left!", "look to the left"),
        ("look up, then left, then down", "look up; look to the left; look down"),
        ("hold your left arm out and wave with the other", "hold your left arm out + wave with your right hand"),
        ("raise your right arm, lower it, then do the same with the left",
         "raise your right arm; lower your right arm; raise your left arm; lower your left arm"),
        ("point up, then at yourself", "point up; point at yourself"),
        ("touch your head, shoulders and hips", "touch your head; touch your shoulders; touch your hips"),
        ("wave your left hand, then stop and wave the right", "wave your left hand; wave your right hand"),
        ("with one arm raised, look to the left", "raise your right arm + look to the left"),
        ("point at yourself with your left and at me with your right",
         "point at yourself with your left hand + point at me with your right hand"),
        ("clap, and when you have clapped, bow", "clap; bow"), ("wave first; the bow comes after", "wave; the bow"),
        ("I want to see a bow, but a wave before it", "a wave; a bow"),
        ("nod three times and clap once after that", "nod three times; clap once"),
        ("wave and bow, but the bow first", "bow; wave"),
        # and what looks like it
        ("finish the drink", "finish the drink"), ("look up at me", "look up at me"),
        ("touch your nose and your chin", "touch your nose and your chin"),
    ],
)  # fmt: skip
def test_order(text: str, read_as: str) -> None:
    assert said(text) == read_as


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        ("do it gently: wave", "wave (0.62 times as fast)"), ("an exaggerated bow", "a bow (1.4 times as large)"),
        ("hold your hand up for 5s", "raise your hand up (for 5 s)"), ("bow a little deeper", "bow (1.2 times as large)"),
        ("clap three times slowly and twice fast", "clap three times (0.62 times as fast); clap twice (1.6 times as fast)"),
        ("punch 3 times with each hand", "punch 3 times with your right hand; punch 3 times with your left hand"),
        ("clap a dozen times", "clap twelve times"), ("clap once or twice", "clap twice"), ("nod thrice", "nod three times"),
        ("nod twenty five times", "nod 25 times"), ("bow, not once but twice", "bow twice"),
        ("not just one but two bows", "not just one but two bows"),
        ("wave four or five times", "wave four times"), ("give me ten claps", "give me ten claps"),
        ("bow one time", "bow once"),
        ("I want to hear five claps", "five claps"), ("super fast clapping please", "clap (1.8 times as fast)"),
        ("wave like mad", "wave (1.7 times as fast)"),
        ("take ages to raise your left arm", "raise your left arm (0.55 times as fast)"),
        ("wave small", "wave (0.6 times as large)"),
        ("a slow, deep bow", "a bow (0.62 times as fast, 1.4 times as large)"),
        # and what looks like it
        ("point at the small dog", "point forward"), ("take a long time out", "take a long time out"),
    ],
)  # fmt: skip
def test_manner(text: str, read_as: str) -> None:
    assert said(text) == read_as
