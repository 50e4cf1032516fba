"""Probes: commands in words the grammar never says, with what they should show. Never trained on (a test sees to it)."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.resources import files

import msgspec

HELD_OUT_VERBS = (
    "elevate", "hoist", "thrust", "peek", "peer", "stare", "smack", "wag", "swat", "incline", "hail", "pantomime", "emulate",
    "propel", "caress", "oscillate", "genuflect", "clench", "brandish", "gyrate", "crane", "fend",
)  # fmt: skip
"""Words that no caption has: what a model does with them, it took from the text encoder."""


@dataclass(frozen=True)
class Probe:
    """A command and what its motion must show; empty and None where the text leaves it open.

    Attributes:
        text: the command.
        family, limb, side, count, direction: as of a gesture.
        hold_s: seconds that the pose is to be kept; 0 where it is not said.
        tempo: slow or fast.
        then: what follows; only order, limbs, sides and directions of both are judged.
    """

    text: str
    family: str
    limb: str
    side: str = ""
    count: int | None = None
    direction: str = ""
    hold_s: float = 0.0
    tempo: str = ""
    then: Probe | None = None


def read_probes(name: str) -> tuple[Probe, ...]:
    """The probes of `mmm_core/corpus/prompts/<name>.jsonl`, one JSON object a line with the fields of `Probe`.

    Raises:
        msgspec.ValidationError: a field of the wrong type, or one that is missing.
    """
    lines = files("mmm_core.corpus").joinpath("prompts", f"{name}.jsonl").read_bytes()
    return tuple(msgspec.json.decode(line, type=Probe) for line in lines.splitlines())


PROBES = read_probes("probes_development")
"""The development set: models, decoding steps and temperatures have been chosen by it."""
TEST_PROBES = read_probes("probes_test")
"""The test set, by two writers who saw neither the development set nor any phrase of the corpus: figures are reported on it, nothing is chosen by it."""
PROBE_SETS = {"development": PROBES, "test": TEST_PROBES}


@dataclass(frozen=True)
class Command:
    """One gesture that a sentence asks for; empty, None and 0 where the sentence leaves a field open.

    Attributes:
        family, limb, side, count, direction, hold_s, tempo: as of a probe.
        size: small or large.
    """

    family: str
    limb: str
    side: str = ""
    count: int | None = None
    direction: str = ""
    hold_s: float = 0.0
    tempo: str = ""
    size: str = ""


@dataclass(frozen=True)
class Sentence:
    """A sentence as people say or type it, and the motion that it asks for.

    Attributes:
        text: the sentence.
        kind: ellipsis, at_once, slips, denial, manner, in_turn, everyday or long.
        commands: gestures in turn, each with those done at once.
        clean: the sentence of kind slips as it would be written without them.
        denied: families that must not be seen.
        nothing: whether nothing at all may move.
    """

    text: str
    kind: str
    commands: tuple[tuple[Command, ...], ...]
    clean: str = ""
    denied: tuple[str, ...] = ()
    nothing: bool = False


def read_sentences(name: str) -> tuple[Sentence, ...]:
    """The sentences of `mmm_core/corpus/prompts/<name>.jsonl`, one JSON object a line with the fields of `Sentence`.

    Raises:
        msgspec.ValidationError: a field of the wrong type, or one that is missing.
    """
    lines = files("mmm_core.corpus").joinpath("prompts", f"{name}.jsonl").read_bytes()
    return tuple(msgspec.json.decode(line, type=Sentence) for line in lines.splitlines())
