"""Converts answers of the sentence parser into readings, and readings into gestures, whose probability the parser computes.

What other readings of the sentence deny is kept: an answer that might do it is no reading.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace

from mmm_core.language.commands import MOST_AT_ONCE, MOST_STEPS, PlainCommand, Reading
from mmm_core.language.count_words import count_asked, with_times
from mmm_core.language.gesture_steps import LEFT, RIGHT, ArmGesture, GestureSteps, arm_of, plainly, with_own_arm
from mmm_core.language.limbs import limbs_of
from mmm_core.language.manner import manner_of
from mmm_core.language.plain_gestures import OUTSIDE, SEVERAL, Meant, family_of, is_gesture, is_sure_of

_LOG_SURE = math.log(0.75)
"""Log-probability from which on the parser is believed beside a denial whose act is not known.

Of 1,505 sentences that three writers wrote, most of which deny something, 15 are read rightly thereby and none wrongly.
"""


def steps_asked(reading: Reading, meant: Mapping[str, Meant]) -> GestureSteps:
    """The gestures of the commands of a reading, with the arms that their words name.

    Args:
        reading: the reading.
        meant: what each of its commands means by itself.
    """
    return tuple(tuple(_asked(command, meant[command.text]) for command in step) for step in reading.steps)


def reading_in(steps: GestureSteps, text: str, others: Sequence[Reading], meant: Mapping[str, Meant]) -> Reading | None:
    """A reading with given gestures; None where a gesture has no such arm, or for more steps or commands than a text may have.

    A command takes its words, number and manner from the first reading that has the gesture with its arm, else the number and the
    manner from the first that has the gesture. What other readings deny is denied.

    Args:
        steps: the gestures.
        text: the sentence.
        others: its other readings.
        meant: what each of their commands means by itself.
    """
    if len(steps) > MOST_STEPS or any(len(step) > MOST_AT_ONCE for step in steps):
        return None
    flat = [one for step in steps for one in step]
    if any(one != with_own_arm(one) or not plainly(one) for one in flat):
        return None
    said = [[(c, _asked(c, meant[c.text])) for step in other.steps for c in step] for other in others]
    commands = iter([_command(one, flat[:i].count(one), said) for i, one in enumerate(flat)])
    denied = next((other.denied for other in others if other.denied), ())
    if not steps and not denied:
        denied = tuple(command.text for step in others[0].steps for command in step) if others else ()
    return Reading(text, tuple(tuple(next(commands) for _ in step) for step in steps), denied)


def keeps_denials(
    steps: GestureSteps,
    others: Sequence[Reading],
    meant: Mapping[str, Meant],
    acts: Mapping[str, Meant],
    log_parsed: float = -math.inf,
) -> bool:
    """Whether steps in all likelihood have nothing that another reading of the sentence denies.

    Beside a denial whose act is not known ("don't swat it"), only gestures of readings with that denial are likely, unless the
    parser, which knows of denials as well, is sure of the steps. Steps that may have a denied act are refused however sure it is,
    and so are those beside a denial of several acts ("don't wave or clap").

    Args:
        steps: the gestures.
        others: the other readings.
        meant: what each of their commands means by itself.
        acts: what each of the acts that they deny means by itself.
        log_parsed: logarithm of the parser's probability of the steps.
    """
    flat = [one for step in steps for one in step]
    for other in others:
        unknown = [acts[words].name for words in other.denied if not is_sure_of(acts[words])]
        if unknown and (log_parsed < _LOG_SURE or SEVERAL in unknown):
            asked = {one.gesture for step in steps_asked(other, meant) for one in step}
            if any(one.gesture not in asked for one in flat):
                return False
        denied = [
            ArmGesture(arm_of(words, acts[words].name), acts[words].name)
            for words in other.denied
            if is_gesture(acts[words].name)
        ]
        if any(_may_be(one, act) for one in flat for act in denied):
            return False
    return True


def denies_itself(reading: Reading, meant: Mapping[str, Meant], acts: Mapping[str, Meant]) -> bool:
    """Whether a reading surely denies one of its several gestures: it asks to nod and yawn, and denies "yawning".

    What is the only gesture may be denied in words alone: "why aren't you celebrating? Celebrate!". An act that is denied with a
    number or a manner may be asked for with another: "don't clap twice, clap once".
    """
    denied = [
        ArmGesture(arm_of(words, acts[words].name), acts[words].name)
        for words in reading.denied
        if is_sure_of(acts[words]) and count_asked(words) is None and manner_of(words)[1].plain
    ]
    flat = [one for step in steps_asked(reading, meant) for one in step]
    contrary = [one for one in flat if any(_may_be(one, act) for act in denied)]
    return 0 < len(contrary) < len(flat)


def _may_be(one: ArmGesture, denied: ArmGesture) -> bool:
    """Whether a gesture may be the denied one: of the same family, with no other direction and not with the other arm."""
    arms = {arm_of(plainly(one), one.gesture), denied.arm}
    ways, denied_ways = ({*gesture.partition("/")[2].split()} for gesture in (one.gesture, denied.gesture))
    is_same_way = ways <= denied_ways or denied_ways <= ways
    return family_of(one.gesture) == family_of(denied.gesture) and is_same_way and arms != {LEFT, RIGHT}


def _asked(command: PlainCommand, meant: Meant) -> ArmGesture:
    gesture = meant.name if is_gesture(meant.name) else OUTSIDE
    return ArmGesture(arm_of(command.text, gesture), gesture)


def _command(one: ArmGesture, n_before: int, said: Sequence[Sequence[tuple[PlainCommand, ArmGesture]]]) -> PlainCommand:
    """The command of a gesture that `n_before` commands before it ask for as well, in the words of a reading that has it."""
    if (same := next(_others(said, n_before, lambda asked: asked == one), None)) is not None:
        return same
    words = plainly(one)
    alike = next(_others(said, n_before, lambda asked: asked.gesture == one.gesture), None)
    if alike is None:
        return PlainCommand(words, limbs=limbs_of(words))
    count = count_asked(alike.text)
    words = with_times(words, count) if count else words
    return replace(alike, text=words, limbs=limbs_of(words))


def _others(
    said: Sequence[Sequence[tuple[PlainCommand, ArmGesture]]], n_before: int, fits: Callable[[ArmGesture], bool]
) -> Iterator[PlainCommand]:
    """The fitting commands of readings: first those after `n_before` fitting ones of their reading, then the last of each."""
    fitting = [[command for command, asked in reading if fits(asked)] for reading in said]
    yield from (commands[n_before] for commands in fitting if len(commands) > n_before)
    yield from (commands[-1] for commands in fitting if commands)
