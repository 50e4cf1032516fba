"""Readings in the gestures that the sentence parser proposes, and the gestures of readings, whose probability it tells."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.count_words import count_asked
from mmm_core.language.gesture_steps import ArmGesture, GestureSteps, arm_of, plainly
from mmm_core.language.limbs import limbs_of
from mmm_core.language.plain_gestures import OUTSIDE, Meant, is_gesture


def steps_asked(reading: Reading, meant: Mapping[str, Meant]) -> GestureSteps:
    """The gestures of the commands of a reading, with the arms that their words name.

    Args:
        reading: the reading.
        meant: what each of its commands means by itself.
    """
    return tuple(tuple(_asked(command, meant[command.text]) for command in step) for step in reading.steps)


def reading_in(steps: GestureSteps, text: str, others: Sequence[Reading], meant: Mapping[str, Meant]) -> Reading | None:
    """A reading with given gestures; None where one of these has no plain command.

    A command takes its words, number and manner from another reading that has the gesture: from the first of these with the same
    arm, else from the first.

    Args:
        steps: the gestures.
        text: the sentence.
        others: its other readings.
        meant: what each of their commands means by itself.
    """
    if any(not plainly(one) for step in steps for one in step):
        return None
    said = [(command, _asked(command, meant[command.text])) for other in others for s in other.steps for command in s]
    found = tuple(tuple(_command(one, said) for one in step) for step in steps)
    denied = next((other.denied for other in others if other.denied), ())
    if not steps and not denied:
        denied = tuple(command.text for step in others[0].steps for command in step) if others else ()
    return Reading(text, found, denied)


def _asked(command: PlainCommand, meant: Meant) -> ArmGesture:
    gesture = meant.name if is_gesture(meant.name) else OUTSIDE
    return ArmGesture(arm_of(command.text, gesture), gesture)


def _command(one: ArmGesture, said: Sequence[tuple[PlainCommand, ArmGesture]]) -> PlainCommand:
    """The command of a gesture, in the words of another reading where one has it."""
    same = [command for command, asked in said if asked == one]
    if same:
        return same[0]
    words = plainly(one)
    alike = next((command for command, asked in said if asked.gesture == one.gesture), None)
    if alike is None:
        return PlainCommand(words, limbs=limbs_of(words))
    count = count_asked(alike.text)
    words += f" {count} times" if count and count > 1 else " once" if count else ""
    return replace(alike, text=words, limbs=limbs_of(words))
