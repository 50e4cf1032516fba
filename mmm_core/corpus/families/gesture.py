"""What a gesture, a family of gestures and its words are."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from mmm_core.corpus.score import Score

LEFT_RIGHT = ("left", "right")
ONE = ("left", "right")
BOTH = ("both",)
ANY = ("left", "right", "both")
ALL = ("left", "right", "both", "alternating")


@dataclass(frozen=True)
class Gesture:
    """One gesture of a clip.

    Attributes:
        family: a key of `FAMILIES`.
        side: left, right, both, alternating, or "" where the family has none.
        count: repetitions; 1 where the family does not repeat.
        direction: left, right, up, down, forward, ...; "" where the family has none.
        tempo: 1 is usual, above it faster.
        size: 1 is usual, above it larger.
        height: low or high, "" where nothing is said.
        hold_s: how long a pose is kept; 0 where nothing is said.
        style: a key of `mmm_core.corpus.styles.STYLES`, "" for none.
    """

    family: str
    side: str = ""
    count: int = 1
    direction: str = ""
    tempo: float = 1.0
    size: float = 1.0
    height: str = ""
    hold_s: float = 0.0
    style: str = ""

    @property
    def arms(self) -> tuple[str, ...]:
        """Channels of the arms that act."""
        return {"left": ("left",), "right": ("right",)}.get(self.side, ("left", "right"))

    @property
    def lead(self) -> str:
        """The arm that leads: the acting one, or the right."""
        return "left" if self.side == "left" else "right"


@dataclass(frozen=True)
class Words:
    """What people say for a family: patterns of imperatives, each beginning with its verb, and of phrases without one.

    `(a|b|)` stands for each of its alternatives. Slots: {S} the side, {D} the direction, {n} a count ("twice", "3 times",
    or nothing), {N} a number before a plural. `^` marks a further verb: "raise your {S} hand and ^wave". `~` begins a phrase that is
    not an imperative: a noun ("~a bow", "~{N} bows"), a sentence about a part of the body ("~your {S} arm goes up"), or a few
    words ("~{S} arm up").

    Attributes:
        bare: no side named; "with your {S} hand" or "with both hands" is added where the family has sides.
        one: with a side.
        any: no side named, nothing to be added.
        both: for both arms.
        alternating: for one arm after the other.
    """

    bare: tuple[str, ...] = ()
    one: tuple[str, ...] = ()
    any: tuple[str, ...] = ()
    both: tuple[str, ...] = ()
    alternating: tuple[str, ...] = ()


Perform = Callable[[Score, Gesture], None]


@dataclass(frozen=True)
class Family:
    """What a family of gestures is made of.

    Attributes:
        perform: writes the gesture into a score.
        words: what is said for it.
        limb: what is seen to move: arm, head, trunk, or "" for nothing.
        sides: sides it can have; empty when it has none.
        counts: repetitions that need not be said; empty when it is not repeated.
        directions: directions it can have.
        directed: words for single directions.
        holds: whether it ends in a pose that may be kept.
        heights: whether it can be done low or high.
        starts_away: whether it starts somewhere else than at rest.
    """

    perform: Perform
    words: Words = field(default_factory=Words)
    limb: str = "arm"
    sides: tuple[str, ...] = ANY
    counts: tuple[int, ...] = ()
    directions: tuple[str, ...] = ()
    directed: dict[str, Words] = field(default_factory=dict)
    holds: bool = False
    heights: bool = False
    starts_away: bool = False
