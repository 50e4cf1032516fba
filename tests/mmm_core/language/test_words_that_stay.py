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
        ("your shoulders turn to the right", ["your shoulders turn to the right"]),
        ("your shoulders dip left", ["your shoulders dip left"]),
        ("your turn to bow", ["bow"]),
        ("listen in at the door", ["listen in at the door"]),
        ("listen, wave", ["wave"]),
        ("get a coat down from a high hook", ["get a coat down from a high hook"]),
        ("I want to see a big wave", ["a big wave"]),
        ("queue for the toilet", ["queue for the toilet"]),
        ("wait for the bus", ["wait for the bus"]),
        ("wait for me", ["make a stop sign with your right hand"]),
        ("wave for the children", ["wave"]),
        ("hold your arms as if you carry a tray", ["hold your arms as if you carry a tray"]),
        ("bow as if you mean it", ["bow"]),
        ("next, take your right arm back and throw", ["take your right arm back and throw"]),
        ("an incredulous shake of the head", ["an incredulous shake of the head"]),
        ("a slow shake of the head", ["shake your head"]),
        ("arms in an X", ["arms in an X"]),
        ("show an X slowly", ["show an x"]),
        ("each hand under the opposite arm", ["both hands under the opposite arm"]),
        ("show having their arms crossed", ["show having their arms crossed"]),
        ("show leaning left and right", ["show leaning left and right"]),
        ("a human looses an arrow", ["a human looses an arrow"]),
        ("the character sings the anthem", ["the character sings the anthem"]),
        ("clap there times", ["clap three times"]),
        ("look there", ["look there"]),
        (
            "wave with the left and the right hand in turn exactly 3 times",
            ["wave with alternating hands exactly 3 times"],
        ),
        ("wave with the left and the right hand in turn", ["wave with your left hand", "wave with your right hand"]),
        ("left uppercut, right uppercut three times", ["uppercut with alternating hands three times"]),
        ("left uppercut, right uppercut", ["left uppercut", "right uppercut"]),
        ("nod three times, then once more", ["nod three times", "nod once"]),
        ("nod, then once more", ["nod", "nod"]),
        ("clap twice, then with your left hand wave", ["clap twice", "wave with your left hand"]),
        ("wave, then with the other hand", ["wave", "wave with your left hand"]),
        ("the crowd can't see you so raise both arms", ["raise both arms"]),
        ("do not lean so far", []),
        ("give him a little wave", ["wave your right hand"]),
        ("lean a little to the left", ["lean to the left"]),
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
        ("right fist with a toothbrush, back and forth at the lips", 1),
        ("left arm, right arm, dancing three times", 1),
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


@pytest.mark.parametrize(
    ("sentence", "size", "tempo"),
    [
        ("a touch of the opposite shoulder with the right hand", 1.0, 1.0),
        ("nod a touch", 0.6, 1.0),
        ("a sweeping punch", 1.0, 1.0),
        ("a person telling me to hurry up by rolling his hands", 1.0, 1.0),
        ("hurry up and bow", 1.0, 1.6),
        ("show me the way slowly", 1.0, 0.62),
        ("a hasty glance at the left wrist", 1.0, 1.6),
    ],
)
def test_manner_is_read_where_it_is_meant(sentence: str, size: float, tempo: float) -> None:
    manner = read(sentence).steps[0][0].manner
    assert (manner.size, manner.tempo) == pytest.approx((size, tempo), abs=0.01)


@pytest.mark.parametrize(
    ("sentence", "command", "denied"),
    [
        ("do not loosen up, pump your elbows", "pump your elbows", "loosen up"),
        ("no driving away a fly, raise your arm", "raise your right hand", "driving away a fly"),
        ("stop moping and reach forward", "reach forward", "moping"),
        ("stop moving your head left and right and clap your hands", "clap your hands", "moving your head left and right"),
        ("I said left, not right: wave", "wave with your left hand", "the right"),
        ("I said left, not right: wave your left hand", "wave your left hand", None),
        ("with your left hand, show me the way, not with the right hand",
         "show me the way with your left hand", "with the right hand"),
        ("do not worry, wave", "wave", None),
        ("do not rush, wave", "wave", None),
        ("no idea", "shrug your shoulders", None),
    ],
)  # fmt: skip
def test_what_is_not_to_be_done_is_left_out(sentence: str, command: str, denied: str | None) -> None:
    reading = read(sentence)
    assert words(sentence) == [command]
    assert reading.denied == ((denied,) if denied else ())
