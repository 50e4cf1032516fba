"""Records of a gesture, of a family of gestures, and of the family's phrases."""

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
        side: left, right, both, alternating, or "" for a family without sides.
        count: number of strokes; 1 for a family without strokes.
        direction: left, right, up, down, forward, ...; "" for a family without directions.
        tempo: factor of speed, 1 as usual.
        size: factor of size, 1 as usual.
        height: low or high; "" for the usual height.
        hold_s: seconds that a pose is kept; 0 for the usual time.
        style: a key of `mmm_core.language.moods.MOODS`, "" for none.
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
        """The leading arm: the acting one, or the right of two."""
        return "left" if self.side == "left" else "right"


@dataclass(frozen=True)
class Words:
    """Phrases of a family: patterns of imperatives, each beginning with its verb, and of phrases that are not imperatives.

    `(a|b|)` stands for each of its alternatives. Slots: {S} the side, {D} the direction, {n} a count ("twice", "3 times",
    or nothing), {N} a number before a plural. `^` marks a further verb: "raise your {S} hand and ^wave". `~` begins a phrase that is
    not an imperative: a noun ("~a bow", "~{N} bows"), a sentence about a part of the body ("~your {S} arm goes up"), or a few
    words ("~{S} arm up").

    Attributes:
        bare: phrases without a side; "with your {S} hand" or "with both hands" is added if the family has sides.
        one: phrases with a side.
        any: phrases without a side, to which nothing is added.
        both: phrases for both arms.
        alternating: phrases for one arm after the other.
    """

    bare: tuple[str, ...] = ()
    one: tuple[str, ...] = ()
    any: tuple[str, ...] = ()
    both: tuple[str, ...] = ()
    alternating: tuple[str, ...] = ()


Perform = Callable[[Score, Gesture], None]


@dataclass(frozen=True)
class Family:
    """A family of gestures: its performance, its phrases and its variants.

    Attributes:
        perform: writes a gesture of the family into a score.
        words: phrases of the family.
        limb: the limb that visibly moves: arm, head, trunk, or "" for none.
        sides: sides that a gesture can have; empty for a family without sides.
        counts: usual numbers of strokes, which a sentence need not name; empty for a family without strokes.
        directions: directions that a gesture can have.
        directed: phrases for single directions.
        holds: whether the gesture ends in a pose that may be kept.
        heights: whether the gesture can be low or high.
        starts_away: whether the gesture does not begin at rest.
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
