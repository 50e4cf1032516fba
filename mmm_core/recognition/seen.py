"""Describes the gestures that a motion shows, and lists those that another body's motion of them does not show.

A text only suggests the gestures to search for: a gesture is named only where its sign is found in the motion (`signs`). Where
no sign is found, the sentence says which limb goes where.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from mmm_core.motion.motion import Motion
from mmm_core.motion.posture_features import PostureFeatures, part, posture_features
from mmm_core.recognition import checks
from mmm_core.recognition.named import families_named, sentences
from mmm_core.recognition.sign_tables import DIRECTED, HEAD_TRUNK, SIGNS
from mmm_core.recognition.signs import arm_of, shows

HEAD_FAMILIES = ("shake_head", "nod", "look_around", "look_back", "tilt_head", "roll_head", "wobble_head", "look")
TRUNK_FAMILIES = ("bow", "twist_repeat", "trunk_circle", "twist", "sway", "slump", "lean")
ARM_FAMILIES = ("raise", "clap", "arm_side", "wave")
"""Families of the arms that are searched for though no word names them."""
PLAINER = "wave"
"""Family that is searched for first among the named ones, because gestures of other families show its sign too."""
STILL_FAMILIES = ("breathe", "shift", "stand")
"""Families in whose performance hardly anything moves."""
_HAVE_DIRECTION = ("look", "tilt_head", "lean", "twist", "point")
HARDLY = "hardly moved"
"""End of the description of a missing act whose limb stood still."""
_MOVED_DEG = {"head": checks.HEAD_MOVED_DEG, "trunk": checks.TRUNK_MOVED_DEG}
_EXACT_UP_TO = 2
"""Strokes that must all be found; of a larger number, one may be missed."""
NOTHING_MOVES = "stands still: nothing moves that one would notice"
_WORDS = {1: "once", 2: "twice"}
_TWO = {"hand": "both hands", "arm": "both arms"}
_TOWARDS = {"forward": "forward", "back": "backward", "up": "up", "down": "down", "self": "to the chest"}
LEAST_FRAMES = 4
"""Frames of the shortest part of a motion in which gestures are searched for."""


@dataclass(frozen=True)
class Act:
    """One gesture that a motion shows, or the movement of a limb.

    Attributes:
        limb: arm, head, trunk; "" where hardly anything moves.
        side: left, right or both; "" where no arm acts.
        family: the gesture family whose sign was found; "" where none was found.
        direction: direction of the gesture; "" for none.
        count: number of strokes; None where the family's strokes are not counted.
        place: place that the hand goes to, where no sign was found.
    """

    limb: str
    side: str = ""
    family: str = ""
    direction: str = ""
    count: int | None = None
    place: str = ""

    @property
    def sentence(self) -> str:
        """A description of the act, as the rest of a sentence that begins with "it"."""
        if not self.limb and self.family in ("", "stand"):
            return NOTHING_MOVES
        if not self.family:
            return f"moves {self._of('hand')} {self.place}" if self.limb == "arm" else f"moves the {self._body}"
        known = sentences()
        said = known.get(f"{self.family} {self.direction}") or known[self.family]
        said = said.replace("{hand}", self._of("hand")).replace("{arm}", self._of("arm"))
        said = " ".join(said.replace("{direction}", _towards(self.direction)).split())
        return said if self.count is None else f"{said} {_WORDS.get(self.count, f'{self.count} times')}"

    @property
    def _body(self) -> str:
        return "upper body" if self.limb == "trunk" else self.limb

    def _of(self, what: str) -> str:
        return _TWO[what] if self.side == "both" else f"the {self.side} {what}"


@dataclass(frozen=True)
class Scene:
    """A part of a motion and the words that it was generated for.

    Attributes:
        end_s: end in seconds from the motion's beginning; a scene begins at the end of the one before.
        words: text that may name the gestures of the scene.
    """

    end_s: float
    words: str


def seen(shown: PostureFeatures, words: str = "") -> tuple[Act, ...]:
    """The acts that a motion shows: at least one, the arms' first.

    Args:
        shown: posture features of the motion.
        words: a text that suggests the gestures to search for.
    """
    named = families_named(words)
    acts = [*_acts_of_arms(shown, named)] if shown.arms else []
    body = replace(shown, arms="")
    limb = checks.limb(body)
    usual = (() if acts else TRUNK_FAMILIES) if limb == "trunk" else (() if acts else HEAD_FAMILIES) if limb else ()
    wanted = [f for f in named if f in HEAD_TRUNK and (f not in STILL_FAMILIES or not (limb or acts))]
    for family in (*wanted, *usual):
        if (found := _act_of_body(body, family)) is not None:
            return (*acts, found)
    return tuple(acts) or (Act(limb),)


def scenes_seen(motion: Motion, scenes: Sequence[Scene]) -> tuple[tuple[Act, ...], ...]:
    """The acts that a motion shows in each scene."""
    shown = posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad)
    parts = _parts(len(motion.joints_m), motion.fps, scenes)
    return tuple(seen(part(shown, *ends), scene.words) for scene, ends in zip(scenes, parts, strict=True))


def sentence(scenes: Sequence[Sequence[Act]], *, counted: bool = True) -> str:
    """One sentence for the acts of scenes, without its subject: "claps 3 times, then bows"; without numbers unless `counted`."""
    return ", then ".join(
        " and ".join((act if counted else replace(act, count=None)).sentence for act in acts) for acts in scenes
    )


def lost(motion: Motion, scenes: Sequence[Scene], wanted: Sequence[Sequence[Act]]) -> list[tuple[Act, str]]:
    """The wanted acts that a motion does not show, each with a description of the missing part.

    Args:
        motion: a motion that copies another one, such as that of a robot's body.
        scenes: parts of that motion; the last one goes on to its end.
        wanted: for each scene the acts that the motion must show.
    """
    shown = posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad)
    parts = _parts(len(motion.joints_m), motion.fps, scenes)
    found: list[tuple[Act, str]] = []
    for acts, ends in zip(wanted, parts, strict=True):
        there = part(shown, *ends)
        found += [(act, missing) for act in acts if (missing := _missing(act, there))]
    return found


def _parts(n_frames: int, fps: float, scenes: Sequence[Scene]) -> list[tuple[int, int]]:
    """First frame and end of each scene, at least `LEAST_FRAMES` apart; the last scene ends with the motion."""
    ends = [min(n_frames, round(scene.end_s * fps)) for scene in scenes[:-1]] + [n_frames]
    starts = [0, *ends[:-1]]
    return [
        (max(0, min(a, n_frames - LEAST_FRAMES)), max(b, a + LEAST_FRAMES)) for a, b in zip(starts, ends, strict=True)
    ]


def _missing(act: Act, s: PostureFeatures) -> str:
    """A description of the part of an act that a motion does not show; "" where it shows the whole act."""
    if not act.limb:
        return ""
    if act.limb == "arm":
        still = [side for side in _sides(act.side) if s.arms not in (side, "both")]
        if still:
            return f"{' and '.join(f'the {side} arm' for side in still)} {HARDLY}"
        if act.family and not any(shows(s, act.family, side, act.direction) for side in (act.side, "")):
            return f"not seen: {act.sentence}"
    else:
        if checks.reach_deg(s, act.limb) < _MOVED_DEG[act.limb]:
            return f"the {'upper body' if act.limb == 'trunk' else 'head'} {HARDLY}"
        if act.family and _act_of_body(replace(s, arms=""), act.family, act.direction) is None:
            return f"not seen: {act.sentence}"
    found = checks.count(s, act.family, act.side) if act.count is not None else None
    if act.count is not None and found is not None and found < act.count - (act.count > _EXACT_UP_TO):
        return f"{found} of {act.count} strokes"
    return ""


def _acts_of_arms(s: PostureFeatures, named: Sequence[str]) -> Iterator[Act]:
    """Yields acts of the arms that moved, together or each by itself."""
    left = set(_sides(s.arms))
    first = (PLAINER,) if PLAINER in named else ()
    arms = [f for f in (*first, *named, *ARM_FAMILIES) if f in SIGNS or f == "arms_down"]
    for family in dict.fromkeys(arms):
        for side in _acting(s.arms, family):
            if set(_sides(side)) <= left and (direction := _direction_of_arm(s, family, side)) is not None:
                yield Act("arm", side, family, direction, checks.count(s, family, side) or None)
                left -= set(_sides(side))
        if not left:
            return
    if len(left) == len(_sides(s.arms)):
        yield Act("arm", s.arms, place=_place(s, "right" if s.arms == "both" else s.arms))


def _acting(arms: str, family: str) -> tuple[str, ...]:
    """Sides on which the arms that moved may show a family; a family whose sentence names no hand needs both arms."""
    if "{" in sentences()[family]:
        return ("both", "left", "right") if arms == "both" else (arms,)
    return ("both",) if arms == "both" else ()


def _direction_of_arm(s: PostureFeatures, family: str, side: str) -> str | None:
    """The direction in which arms show a family, "" for none in particular; None where they do not show it."""
    for directed, direction in DIRECTED:
        if directed == family and shows(s, family, side, direction):
            return direction
    if not shows(s, family, side):
        return None
    return checks.direction(replace(s, arms=side), family) if family == "point" else ""


def _act_of_body(s: PostureFeatures, family: str, wanted: str = "") -> Act | None:
    """The act of head or trunk by which a motion shows a family, in the wanted direction if there is one."""
    limb = "head" if family in HEAD_FAMILIES else "" if family in STILL_FAMILIES else "trunk"
    direction = checks.direction(s, family) if family in _HAVE_DIRECTION else ""
    if (wanted and direction != wanted) or (family in _HAVE_DIRECTION and not direction):
        return None
    if not HEAD_TRUNK[family](s, direction):
        return None
    return Act(limb, "", family, direction, checks.count(s, family) or None)


def _place(s: PostureFeatures, side: str) -> str:
    """Place of a palm in words when it is farthest from its first position."""
    palm = arm_of(s, side).palm
    outward, up, forward = palm[int(np.linalg.norm(palm - palm[0], axis=-1).argmax())]
    if up > 0.35:
        return "above the head"
    if up > 0.05 and outward < 0.3 and forward < 0.35:
        return "to the head"
    if outward > 0.55:
        return "to the side"
    if forward < -0.08:
        return "behind the back"
    if forward > 0.42:
        return "forward"
    return "in front of the chest" if up > -0.3 else "in front of the belly"


def _sides(side: str) -> tuple[str, ...]:
    return ("left", "right") if side == "both" else (side,)


def _towards(direction: str) -> str:
    """A direction in words: "to the left", "up and to the left"."""
    height, _, side = direction.rpartition(" ")
    if side in ("left", "right"):
        return f"{height} and to the {side}" if height else f"to the {side}"
    return _TOWARDS.get(direction, "")
