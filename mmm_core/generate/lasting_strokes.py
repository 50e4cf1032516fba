"""Makes strokes for as long as a text asks: "wave for ten seconds" becomes as many waves as take ten seconds.

A pose is held as long as it is said; a gesture that repeats a stroke goes on with it instead. How long a stroke takes is told by
the lengths predicted for two and for six of them.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from mmm_core.generate.interpretation import ReadCommand
from mmm_core.generate.motion_model import MotionModel
from mmm_core.language.count_words import MOST, count_asked, with_times
from mmm_core.language.mirroring import mirror_words
from mmm_core.language.whole_gestures import has_strokes
from mmm_core.motion.motion import FPS

_FEW, _MANY = 2, 6
"""Numbers of strokes whose predicted lengths are compared."""
_HELD = re.compile(r"\b(?:bow|shrug)")
"""Words of gestures that have a pose besides strokes: "bow for five seconds" is one bow."""


def with_lasting_strokes(
    engine: MotionModel, steps: Sequence[tuple[ReadCommand, ...]]
) -> list[tuple[ReadCommand, ...]]:
    """The steps of a text, with a number of strokes in place of a hold in each step of one command that repeats a stroke."""
    return [(_lasting(engine, step[0]),) if len(step) == 1 and _goes_on(step[0]) else step for step in steps]


def _goes_on(command: ReadCommand) -> bool:
    """Whether a command names seconds but no number, and its gesture repeats a stroke."""
    if not command.manner.hold_s or count_asked(command.text) is not None:
        return False
    return has_strokes(command.text) and _HELD.search(command.text.lower()) is None


def _lasting(engine: MotionModel, command: ReadCommand) -> ReadCommand:
    states = engine.read([_as_read(command, n) for n in (_FEW, _MANY)])
    few, many = (engine.predicted_frames(states.row(i)) for i in range(2))
    stroke = max((many - few) / (_MANY - _FEW), 1.0)
    wanted = command.manner.hold_s * FPS * command.manner.tempo
    count = min(MOST, max(_FEW, _FEW + round((wanted - few) / stroke)))
    text, manner = with_times(command.text, count), replace(command.manner, hold_s=0.0)
    return replace(command, text=text, states=engine.read([_as_read(command, count)]), manner=manner)


def _as_read(command: ReadCommand, count: int) -> str:
    """The words that the model reads for a command with so many strokes."""
    words = with_times(command.text, count)
    return mirror_words(words) if command.is_mirrored else words
