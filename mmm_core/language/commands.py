"""Plain commands, the reading of a sentence, and a notation for commands that is read verbatim.

`exactly: wave your right hand (0.62 times as fast) + nod; bow (for 2 s)` has two steps, the first of two commands at once.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

from mmm_core.language.limbs import limbs_of
from mmm_core.language.manner import FASTEST, LARGEST, LONGEST_HOLD_S, Manner
from mmm_core.language.moods import MOODS

EXACTLY = "exactly:"
"""Prefix of a text that is read verbatim."""
MOST_STEPS, MOST_AT_ONCE = 16, 3
"""Largest number of steps in a text, and of commands in a step: the model has three body parts."""
_MARKS = re.compile(r"[();+]")
_COMMAND = re.compile(r"(?P<text>[^()]*?[a-z][^()]*?)\s*(?:\((?P<manner>[^()]*)\))?", re.IGNORECASE)
_SAID = re.compile(
    r"(?:(?P<tempo>N) times as fast|(?P<size>N) times as large|for (?P<hold>N) s|"
    rf"in a (?P<mood>{'|'.join(MOODS)}) mood)".replace("N", r"\d{1,3}(?:\.\d{1,3})?"))  # fmt: skip


@dataclass(frozen=True)
class PlainCommand:
    """One command that the model is given.

    Attributes:
        text: words of the command.
        manner: tempo, size, hold and mood.
        limbs: limbs that the words name: left_arm, right_arm, some_arm, head, trunk.
    """

    text: str
    manner: Manner = Manner()  # noqa: RUF009
    limbs: frozenset[str] = frozenset()

    @property
    def sentence(self) -> str:
        """Words and manner of the command: "bow (0.55 times as fast, for 2 s)"."""
        manner = self.manner
        said = [f"{manner.tempo:.2g} times as fast"] if manner.tempo != 1.0 else []
        said += [f"{manner.size:.2g} times as large"] if manner.size != 1.0 else []
        said += [f"for {manner.hold_s:g} s"] if manner.hold_s else []
        said += [f"in a {manner.mood} mood"] if manner.mood else []
        return f"{self.text} ({', '.join(said)})" if said else self.text


Steps = tuple[tuple[PlainCommand, ...], ...]
"""Steps in order; each is a tuple of commands that are done at once."""


@dataclass(frozen=True)
class Reading:
    """The commands read in a sentence.

    Attributes:
        text: the sentence.
        steps: steps in order, each with the commands done at once; empty where the sentence requests nothing.
        denied: denied commands.
        notes: changes that the speaker may not expect.
        plain: whether the sentence is passed on unchanged.
        outside: the probability that the sentence asks for no gesture of the corpus; 0 where nobody was asked.
        too_many: number of commands in turn of a sentence that has more than `MOST_STEPS` and of which nothing is done; else 0.
    """

    text: str
    steps: Steps
    denied: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    plain: bool = False
    outside: float = 0.0
    too_many: int = 0

    @property
    def sentences(self) -> tuple[str, ...]:
        """The steps in order, commands at once joined by " + "."""
        return tuple(" + ".join(c.sentence for c in step) for step in self.steps)

    @property
    def words(self) -> str:
        """The commands as one sentence: "raise your left hand and nod, then bow"."""
        return ", then ".join(" and ".join(c.text for c in step) for step in self.steps)


def exactly(steps: Sequence[Sequence[PlainCommand]]) -> str:
    """Steps as a text that `read_exactly` reads; factors have two digits.

    >>> exactly([[PlainCommand("nod", Manner(tempo=0.62)), PlainCommand("clap")], [PlainCommand("bow")]])
    'exactly: nod (0.62 times as fast) + clap; bow'
    """
    bare = [[PlainCommand(" ".join(_MARKS.sub(" ", c.text).split()), c.manner).sentence for c in s] for s in steps]
    return f"{EXACTLY} " + "; ".join(" + ".join(step) for step in bare)


def read_exactly(text: str) -> Reading | None:
    """The commands of a text in the form of `exactly`, within the bounds of tempo, size and hold; None for any other text."""
    if not text.startswith(EXACTLY):
        return None
    steps: list[tuple[PlainCommand, ...]] = []
    said = [step.split("+") for step in text.removeprefix(EXACTLY).split(";")]
    if len(said) > MOST_STEPS or any(len(step) > MOST_AT_ONCE for step in said):
        return None
    for step in said:
        found = [_COMMAND.fullmatch(part.strip()) for part in step]
        manners = [_manner(m["manner"]) if m is not None else None for m in found]
        commands = [
            PlainCommand(m["text"], manner, limbs_of(m["text"]))
            for m, manner in zip(found, manners, strict=True)
            if m is not None and manner is not None
        ]
        if len(commands) < len(found):
            return None
        steps.append(tuple(commands))
    reading = Reading(text, tuple(steps))
    return Reading(reading.words, reading.steps)


def _manner(said: str | None) -> Manner | None:
    """The manner in brackets; None where it is none."""
    manner = Manner()
    for part in said.split(",") if said else ():
        found = _SAID.fullmatch(part.strip())
        if found is None:
            return None
        if found["tempo"]:
            manner = replace(manner, tempo=_within(float(found["tempo"]), FASTEST))
        elif found["size"]:
            manner = replace(manner, size=_within(float(found["size"]), LARGEST))
        elif found["mood"]:
            manner = replace(manner, mood=found["mood"])
        else:
            manner = replace(manner, hold_s=min(float(found["hold"]), LONGEST_HOLD_S))
    return manner


def _within(factor: float, most: float) -> float:
    return min(most, max(1 / most, factor))
