"""Probes: commands in words that the grammar never uses, with the expected motion. A test makes sure that none is trained on."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.resources import files

import msgspec

HELD_OUT_VERBS = (
    "elevate", "hoist", "thrust", "peek", "peer", "stare", "smack", "wag", "swat", "incline", "hail", "pantomime", "emulate",
    "propel", "caress", "oscillate", "genuflect", "clench", "brandish", "gyrate", "crane", "fend",
)  # fmt: skip
"""Words that no caption contains, so that a model knows them only through the text encoder."""


@dataclass(frozen=True)
class Probe:
    """A command and the expectations that its motion must meet; a field is empty or None if the text leaves it open.

    Attributes:
        text: the command.
        family, limb, side, count, direction: the expected gesture, as in `families.gesture`.
        hold_s: seconds that the pose must be kept; 0 if the text names no time.
        tempo: slow or fast.
        then: the gesture that follows; then only order, limbs, sides and directions of both are judged.
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
        msgspec.ValidationError: a field is missing or has the wrong type.
    """
    lines = files("mmm_core.corpus").joinpath("prompts", f"{name}.jsonl").read_bytes()
    return tuple(msgspec.json.decode(line, type=Probe) for line in lines.splitlines())


PROBES = read_probes("probes_development")
"""The development set: models, decoding steps and temperatures have been chosen by it."""
TEST_PROBES = read_probes("probes_test")
"""The test set, by two writers who saw neither the development set nor any phrase of the corpus; no choice depends on it."""
PROBE_SETS = {"development": PROBES, "test": TEST_PROBES}


@dataclass(frozen=True)
class Command:
    """One gesture that a sentence asks for; a field is empty, None or 0 if the sentence leaves it open.

    Attributes:
        family, limb, side, count, direction, hold_s, tempo: as in a probe.
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
        commands: groups of gestures done at the same time, in the order of the sentence.
        clean: a sentence of kind "slips" without its slips.
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
        msgspec.ValidationError: a field is missing or has the wrong type.
    """
    lines = files("mmm_core.corpus").joinpath("prompts", f"{name}.jsonl").read_bytes()
    return tuple(msgspec.json.decode(line, type=Sentence) for line in lines.splitlines())
