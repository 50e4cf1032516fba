"""Finds the expectations of sentences that a body can meet: that of a robot, or a person's as far as the checks see them.

Each command of a sentence is performed by the corpus alone (`robot_capability`). What is expected of a whole sentence (order,
at once, denial) can be met if each of its commands can be seen.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from mmm_core.corpus.heldout import Command, Sentence
from mmm_core.evaluation.robot_capability import showable
from mmm_core.evaluation.sentences import as_probe
from mmm_core.motion.motion import Motion

_LONGEST_HOLD_S = 5.0
"""A clip of the corpus has no room for a longer hold; who can hold a pose for five seconds can hold it for longer."""
_OF_WHOLE = frozenset({"order", "at_once", "denial"})


def showable_expectations(
    sentences: Sequence[Sentence], on_robot: Callable[[Motion], Motion] = lambda motion: motion
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
        probes=[replace(as_probe(c), text=names[c], hold_s=min(c.hold_s, _LONGEST_HOLD_S)) for c in commands],
    )
    found: dict[str, frozenset[str]] = {}
    for s in sentences:
        asked = [c for step in s.commands for c in step]
        whole = _OF_WHOLE if all(_expected(c) <= met[names[c]] for c in asked) else frozenset()
        single = met[names[asked[0]]] | {"tempo", "size"} if len(asked) == 1 else frozenset()
        found[s.text] = whole | single
    return found


def _expected(command: Command) -> frozenset[str]:
    """The expectations of a command that a body must meet to show a whole sentence with it."""
    given = {"side": command.side, "direction": command.direction}
    return frozenset({"limb", "pose", *(key for key, value in given.items() if value)})
