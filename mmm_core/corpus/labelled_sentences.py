"""Sentences with the gestures that they ask for: what the sentence parser learns from, beside marked sentences and phrases.

A line has a sentence, " => " and its steps: `;` between commands one after another, `+` between those done at the same time, in the order in
which they are done. A command is an arm where one is named (left, right, both, turns), a gesture of `plain_gestures.txt` or "outside",
and where they are said a number of strokes (x3), seconds (5s), a tempo and a size. What is denied follows ` | not `. `=> | not wave` asks
for nothing.
"""

from __future__ import annotations

import re
from itertools import chain
from pathlib import Path
from typing import NamedTuple

from mmm_core.corpus.marked_sentences import lines_of
from mmm_core.corpus.withheld import is_withheld
from mmm_core.errors import TrainingDataError
from mmm_core.language.gesture_steps import ANY_ARM, IN_TURN, ArmGesture, GestureSteps, with_own_arm
from mmm_core.language.plain_gestures import OUTSIDE, gestures
from mmm_core.language.tagged_words import MANNERS, NO_MANNER

LABELLED_SENTENCES = Path(__file__).parent / "prompts" / "labelled_sentences"
_DENIED = re.compile(r" *\| *not ")
_COMMAND = re.compile(
    r"(?:(?P<arm>left|right|both|turns) )?(?P<gesture>.+?)(?P<manner>(?: (?:x\d+|\d+(?:\.\d+)?s|slow|fast|small|large))*)"
)
_ARMS = {"": ANY_ARM, "turns": IN_TURN}
_MANNERS = frozenset(MANNERS) - {NO_MANNER}


class LabelledSentence(NamedTuple):
    """A sentence and what it asks for.

    Attributes:
        text: the sentence.
        steps: gestures, step by step; none where it asks for nothing.
        manners: tempos and sizes that a writer's label has for any of them; none of a sentence that was put together.
        counts: how often each gesture is to be done, None where that is not said, in the order of the steps; None where it is not known.
    """

    text: str
    steps: GestureSteps
    manners: frozenset[str] = frozenset()
    counts: tuple[int | None, ...] | None = None


def load_labelled_sentences(folder: Path = LABELLED_SENTENCES, files: str = "*.txt") -> list[LabelledSentence]:
    """The sentences of the files of a folder, in the order of the files' names, without those that are withheld from training.

    Args:
        folder: where the files are.
        files: pattern of their names.

    Raises:
        TrainingDataError: a line has no " =>", no sentence, or names a gesture that there is not.
    """
    read = [read_labelled(line, path) for path in sorted(folder.glob(files)) for line in lines_of(path)]
    return [one for one in read if not is_withheld(one.text)]


def read_labelled(line: str, path: Path = LABELLED_SENTENCES) -> LabelledSentence:
    """A line as a sentence with what it asks for; what is denied is skipped.

    >>> read_labelled("before you clap, left hand up => left raise; clap x2").steps
    ((ArmGesture(arm='left', gesture='raise'),), (ArmGesture(arm='any', gesture='clap'),))
    """
    text, arrow, label = line.rpartition(" =>")
    if not arrow or not text.strip():
        raise TrainingDataError(path, "", repr(line), "a sentence, => and its steps")
    asked, *_denied = _DENIED.split(f" {label.strip()}")
    of_steps = asked.split(";") if asked.strip() else []
    found = [[_command(said, line, path) for said in step.split("+")] for step in of_steps]
    steps = tuple(tuple(gesture for gesture, _ in step) for step in found)
    said = [manner.split() for step in found for _, manner in step]
    manners = frozenset(chain.from_iterable(said)) & _MANNERS
    counts = tuple(next((int(word[1:]) for word in words if word[0] == "x"), None) for words in said)
    return LabelledSentence(text.strip(), steps, manners, counts)


def _command(said: str, line: str, path: Path) -> tuple[ArmGesture, str]:
    """A gesture with its arm, and the words of its number, time and manner."""
    found = _COMMAND.fullmatch(said.strip())
    if found is None or (found["gesture"] not in gestures() and found["gesture"] != OUTSIDE):
        raise TrainingDataError(
            path, repr(line), repr(said.strip()), "an arm, a gesture of plain_gestures.txt, its manner"
        )
    arm = found["arm"] or ""
    return with_own_arm(ArmGesture(_ARMS.get(arm, arm), found["gesture"])), found["manner"]
