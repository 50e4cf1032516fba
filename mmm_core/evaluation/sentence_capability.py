"""Finds the expectations of sentences that a body can meet: that of a robot, or a person's as far as the checks see them.

Each command of a sentence is performed by the corpus alone (`robot_capability`). What is expected of a whole sentence (order,
at once, denial) can be met if each of its commands can be seen, if no command shows the sign of what is denied (someone who
beckons also waves away, as far as the signs go), and if two commands are in order when the corpus performs one after the other:
someone who touches the forehead and then salutes also salutes first, as far as the signs go.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from mmm_core.corpus.heldout import Command, Probe, Sentence
from mmm_core.evaluation.reconstruction import TooLongError
from mmm_core.evaluation.robot_capability import OnRobot, is_most, performances, showable
from mmm_core.evaluation.sentences import as_probe, is_in_turn, shows_as_usual

_LONGEST_HOLD_S = 5.0
"""A clip of the corpus has no room for a longer hold; who can hold a pose for five seconds can hold it for longer."""
_MOST_STROKES = 5
"""Likewise, a clip has no room for ten slow strokes; who can do five can do more."""
_OF_WHOLE = frozenset({"order", "at_once", "denial"})


def showable_expectations(
    sentences: Sequence[Sentence], on_robot: OnRobot = lambda motion: motion
) -> dict[str, frozenset[str]]:
    """The expectations of each sentence that can be met, by its text.

    Args:
        sentences: the sentences.
        on_robot: maps a motion to a person in a robot's poses; a person's own motion when not given.
    """
    commands = list(dict.fromkeys(c for s in sentences for step in s.commands for c in step))
    names = {c: str(i) for i, c in enumerate(commands)}
    met = showable(
        on_robot,
        probes=[_named(c, names[c]) for c in commands],
    )
    found: dict[str, frozenset[str]] = {}
    for s in sentences:
        asked = [c for step in s.commands for c in step]
        whole = _OF_WHOLE if all(_expected(c) <= met[names[c]] for c in asked) else frozenset()
        if any(_shows_too(c, family, on_robot) for c in asked for family in s.denied):
            whole -= {"denial"}
        if len(asked) == len(s.commands) == 2 and whole and not _in_order(s, on_robot):
            whole -= {"order"}
        single = met[names[asked[0]]] | {"tempo", "size"} if len(asked) == 1 else frozenset()
        found[s.text] = whole | single
    return found


def _in_order(sentence: Sentence, on_robot: OnRobot) -> bool:
    """Whether the corpus's own performances of two commands, one after the other, are in order, if both fit into a clip."""
    first, second = (_named(command) for (command,) in sentence.commands)
    try:
        both = list(performances(replace(first, then=second), on_robot))
    except TooLongError:
        return True
    return is_most(sum(is_in_turn(sentence.commands, shown) for shown in both))


def _shows_too(command: Command, family: str, on_robot: OnRobot) -> bool:
    """Whether a command's own performances show the sign of another family, too."""
    return is_most(sum(shows_as_usual(shown, family) for shown in performances(_named(command), on_robot)))


def _named(command: Command, text: str = "") -> Probe:
    """A command as a probe whose hold and strokes fit into a clip of the corpus."""
    probe = as_probe(command)
    count = None if probe.count is None else min(probe.count, _MOST_STROKES)
    return replace(probe, text=text, count=count, hold_s=min(command.hold_s, _LONGEST_HOLD_S))


def _expected(command: Command) -> frozenset[str]:
    """The expectations of a command that a body must meet to show a whole sentence with it."""
    given = {"side": command.side, "direction": command.direction}
    return frozenset({"limb", "pose", *(key for key, value in given.items() if value)})
