"""Sentences with the gestures that they ask for: what the sentence parser learns from, beside marked sentences and phrases.

A line has a sentence, " => " and its steps: `;` between commands one after another, `+` between those done at the same time, in the order in
which they are done. A command is an arm where one is named (left, right, both, turns), a gesture of `plain_gestures.txt` or "outside",
and where they are said a number of strokes (x3), seconds (5s), a tempo and a size. What is denied follows ` | not `. `=> | not wave` asks
for nothing.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

from mmm_core.corpus.marked_sentences import lines_of
from mmm_core.corpus.withheld import is_withheld
from mmm_core.errors import TrainingDataError
from mmm_core.language.gesture_steps import ANY_ARM, IN_TURN, ArmGesture, GestureSteps, with_own_arm
from mmm_core.language.plain_gestures import OUTSIDE, gestures

LABELLED_SENTENCES = Path(__file__).parent / "prompts" / "labelled_sentences"
_DENIED = re.compile(r" *\| *not ")
_COMMAND = re.compile(
    r"(?:(?P<arm>left|right|both|turns) )?(?P<gesture>.+?)(?P<manner>(?: (?:x\d+|\d+(?:\.\d+)?s|slow|fast|small|large))*)"
)
_ARMS = {"": ANY_ARM, "turns": IN_TURN}


class LabelledSentence(NamedTuple):
    """A sentence and what it asks for; no steps where it asks for nothing."""

    text: str
    steps: GestureSteps


def load_labelled_sentences(folder: Path = LABELLED_SENTENCES) -> list[LabelledSentence]:
    """The sentences of the `.txt` files of a folder, in the order of the files' names, without those that are withheld from training.

    Raises:
        TrainingDataError: a line has no " =>", no sentence, or names a gesture that there is not.
    """
    read = [read_labelled(line, path) for path in sorted(folder.glob("*.txt")) for line in lines_of(path)]
    return [one for one in read if not is_withheld(one.text)]


def read_labelled(line: str, path: Path = LABELLED_SENTENCES) -> LabelledSentence:
    """A line as a sentence with what it asks for; numbers, manner and what is denied are read over.

    >>> read_labelled("before you clap, left hand up => left raise; clap x2").steps
    ((ArmGesture(arm='left', gesture='raise'),), (ArmGesture(arm='any', gesture='clap'),))
    """
    text, arrow, label = line.rpartition(" =>")
    if not arrow or not text.strip():
        raise TrainingDataError(path, "", repr(line), "a sentence, => and its steps")
    asked, *_denied = _DENIED.split(f" {label.strip()}")
    of_steps = asked.split(";") if asked.strip() else []
    steps = [[_command(said, line, path) for said in step.split("+")] for step in of_steps]
    return LabelledSentence(text.strip(), tuple(map(tuple, steps)))


def _command(said: str, line: str, path: Path) -> ArmGesture:
    found = _COMMAND.fullmatch(said.strip())
    if found is None or (found["gesture"] not in gestures() and found["gesture"] != OUTSIDE):
        raise TrainingDataError(
            path, repr(line), repr(said.strip()), "an arm, a gesture of plain_gestures.txt, its manner"
        )
    arm = found["arm"] or ""
    return with_own_arm(ArmGesture(_ARMS.get(arm, arm), found["gesture"]))
