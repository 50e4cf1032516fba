"""Numbers, sides and once more: what is said of several strokes or turns in one breath, and what looks like it and is none."""

from __future__ import annotations

import pytest

from mmm_core.language.context import conversation
from mmm_core.language.reading import Reading, read


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        # a number before its gesture, or one for each way
        ("2x nod, 3x clap", "nod 2 times; clap 3 times"),
        ("three times nod, then clap", "nod three times; clap"),
        ("circle your left arm forwards three times and backwards twice",
         "circle your left arm forwards three times; circle your left arm backwards twice"),
        ("look twice left and three times right", "look left twice; look right three times"),
        ("salute for three rounds", "salute three times"),
        ("do a clap, just one", "do a clap once"),
        ("bow, only two", "bow two times"),
        # a stop at the end is the end of the gesture, not a stop sign
        ("wave three times, then stop", "wave three times"),
        ("wave twice and stop there", "wave twice"),
        # sides in a row, without a mark between them
        ("punch left left right right left", "punch left twice; punch right twice; punch left once"),
        ("head left right left", "look to the left; look to the right; look to the left"),
        ("slow jabs left right left",
         "jab left (0.62 times as fast); jab right (0.62 times as fast); jab left (0.62 times as fast)"),
        ("look left once, right twice, left once", "look left once; look right twice; look left once"),
        # first and second, one after the other, one and the other
        ("wave first with the right and second with the left", "wave with your right hand; wave with your left hand"),
        ("wave with each hand, one after the other", "wave with your right hand; wave with your left hand"),
        ("knock with each hand, one after the other, twice", "knock with alternating hands twice"),
        ("rub one ear, then the other", "rub your right ear; rub your left ear"),
        ("wave at the door, then the window", "wave; wave"),
        ("swing the left arm, the right arm, then both", "swing the left arm; swing the right arm; swing both arms"),
        ("rotate your wrists inwards, then outwards", "rotate your wrists inwards; rotate your wrists outwards"),
        ("salute with the right hand and, while holding it, look left", "salute with the right hand + look to the left"),
        # once more, a stop between, a hold
        ("nod and once more", "nod; nod"), ("nod three times, wait, and once more", "nod three times; nod once"),
        ("rub your belly, stop, rub it again", "rub your belly; rub your belly"),
        ("salute until I count to five", "salute (for 5 s)"),
        ("bow for a good two seconds before you straighten up", "bow (for 2 s)"),
        ("nod three times and clap once", "nod three times; clap once"), ("nod nod nod", "nod three times"),
        ("two claps, a short pause, one clap", "two claps; one clap"), ("clap your hands, but only twice", "clap your hands twice"),
        ("pat your head twice and your belly three times", "pat your head twice; pat your belly three times"),
        ("twice wave with the left and once with the right", "wave twice with your left hand; wave once with your right hand"),
        ("alternate between nodding and shaking your head", "nod; shake your head"),
        ("bow, wait two seconds, come back up", "bow (for 2 s)"),
        ("repeat this twice: raise and lower your arms", "raise and lower your arms twice"),
        # and what looks like these
        ("nod twice and clap three times at the same time", "nod twice + clap three times"), ("clap clap", "clap"),
        ("bow and come up", "bow and come up"), ("take a break", "take a break"), ("nod and clap", "nod + clap"),
        ("wave with both hands one after the other", "wave with both hands one after the other"),
        ("raise your left left hand", "raise your left hand"), ("punch twice", "punch twice"),
        ("turn left right hand up", "turn left right hand up"), ("nod again and again", "nod again and again"),
        ("two rounds of applause", "two rounds of applause"),
        ("wave and once again raise your arm", "wave and once again raise your arm"),
        ("point at the man, the tall one", "point at the man, the tall one"),
        ("once you have bowed, clap", "bow; clap"),
        ("a person leans forward, then back", "a person leans forward; a person leans back"),
    ],
)  # fmt: skip
def test_what_is_read(text: str, read_as: str) -> None:
    assert "; ".join(read(text).sentences) == read_as


@pytest.mark.parametrize("again", ["once more", "wait, once more", "hang on, and again"])
def test_once_more_is_the_whole_command(again: str) -> None:
    meant = conversation(["nod three times", again])[-1]
    assert not isinstance(meant, Reading) and meant.reading.sentences == ("nod three times",)


def test_wait_alone_refers_to_nothing() -> None:
    assert isinstance(conversation(["nod three times", "wait"])[-1], Reading)
