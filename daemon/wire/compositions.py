"""Requests for composed motion: a story, a sequence of poses, an edit of another motion. No I/O."""

from __future__ import annotations

from typing import Annotated

import msgspec
from msgspec import Meta

from daemon.wire.request_base import LONGEST_S, MAX_ID_CHARS, MAX_SEED, MAX_TEXT_CHARS, SHORTEST_S, Name, Play, Text

MOST_SCENES = 1000
"""Number of scenes in a story, at most; a looping story has no end."""
MOST_POSES = 20
SHORTEST_GAP_S = 0.2
"""Seconds between two poses, at least: one token."""


class SceneOf(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """A scene of a story.

    Attributes:
        text: what to do, in English.
        seconds: length of the scene; None lets the model choose.
    """

    text: Text
    seconds: Annotated[float, Meta(ge=SHORTEST_S, le=LONGEST_S)] | None = None


class Story(Play, tag="story", kw_only=True):
    """Play several texts one after another in one motion, with generated transitions.

    It moves with the first part while later ones are made, in constant memory, so a story has any length; with `loop` it
    has no end. A part that the model cannot do is left out, which a `progress` event tells.

    Attributes:
        scenes: the parts, in order.
        seed: the same scenes and seed give the same motion.
    """

    scenes: Annotated[list[SceneOf], Meta(min_length=1, max_length=MOST_SCENES)]
    seed: Annotated[int, Meta(ge=0, le=MAX_SEED)] = 0

    def __post_init__(self) -> None:
        """Refuse options that a story does not have.

        Raises:
            ValueError: which becomes one `error` event.
        """
        super().__post_init__()
        if self.hold:
            raise ValueError("a story has no `hold`: leave it out")
        for number, scene in enumerate(self.scenes, 1):
            if not scene.text.strip():
                raise ValueError(f"scene {number} has an empty text: say what to do, in words")

    @property
    def words(self) -> str:
        """All texts in one."""
        return "; ".join(self.texts)[:MAX_TEXT_CHARS]

    @property
    def texts(self) -> tuple[str, ...]:
        """The text of each scene."""
        return tuple(scene.text for scene in self.scenes)


class KeyPoseOf(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """A pose that is due at a time: that of `gesture`, of `command`, or `standing`; exactly one of these is given.

    Attributes:
        at_s: seconds from the beginning of the motion.
        gesture: the pose of a named clip.
        command: id of a played command with this pose.
        standing: whether the pose is standing with hanging arms, looking ahead.
        time_s: seconds from the start of the clip or motion; None takes its hold pose.
    """

    at_s: Annotated[float, Meta(ge=0, le=LONGEST_S)]
    gesture: Name | None = None
    command: Annotated[str, Meta(min_length=1, max_length=MAX_ID_CHARS)] | None = None
    standing: bool = False
    time_s: Annotated[float, Meta(ge=0, le=LONGEST_S)] | None = None


class Inbetween(Play, tag="inbetween", kw_only=True):
    """Pass through poses at given times: the motion between them is generated.

    The motion begins with the robot's present pose unless a pose is due at 0 s, and ends with the last pose.

    Attributes:
        poses: in order of time, at least 0.2 s apart.
        text: what happens between them; empty leaves it to the model.
        seed: the same poses, text and seed give the same motion.
    """

    poses: Annotated[list[KeyPoseOf], Meta(min_length=1, max_length=MOST_POSES)]
    text: Annotated[str, Meta(max_length=MAX_TEXT_CHARS)] = ""
    seed: Annotated[int, Meta(ge=0, le=MAX_SEED)] = 0

    def __post_init__(self) -> None:
        """Refuse poses and times that contradict each other.

        Raises:
            ValueError: which becomes one `error` event.
        """
        super().__post_init__()
        before_s = -1.0
        for number, pose in enumerate(self.poses, 1):
            if (pose.gesture is not None) + (pose.command is not None) + pose.standing != 1:
                raise ValueError(f"pose {number}: give one of `gesture`, `command` and `standing`")
            if pose.standing and pose.time_s is not None:
                raise ValueError(f"pose {number}: `time_s` belongs to a `gesture` or `command`")
            if pose.at_s < 0:
                raise ValueError(f"pose {number}: at {pose.at_s:g} s: give a time from 0 on")
            if pose.at_s < before_s + SHORTEST_GAP_S - 1e-9:
                raise ValueError(
                    f"pose {number}: at {pose.at_s:g} s, after one at {before_s:g} s: leave 0.2 s between them"
                )
            before_s = pose.at_s
        if not self.poses:
            raise ValueError("no pose: give at least one, with its time")
        if before_s < SHORTEST_GAP_S:
            raise ValueError(f"the last pose is at {before_s:g} s: give one at 0.2 s or later")

    @property
    def words(self) -> str:
        """The text, or the number of poses."""
        return self.text or f"{len(self.poses)} poses"

    @property
    def texts(self) -> tuple[str, ...]:
        """The text."""
        return (self.text,)


class Edit(Play, tag="edit", kw_only=True):
    """Play a motion with a part generated anew. Exactly one of `gesture`, `command`, `plan` and `file` names the motion.

    Attributes:
        text: what the new part is to be.
        gesture: a named clip.
        command: id of a command that was played.
        plan: number of its plan, as in its events.
        file: an .npz of `mmmd generate`, within the daemon's folder of motions (`--motions`).
        parts: of the body that are made again: upper, lower, or a part of the model (left_arm, right_arm, rest); empty for
            all of it.
        start_s: from here on, in the motion's own time.
        end_s: up to here; None is its end.
        seed: the same motion, edit and seed give the same result.
    """

    text: Text
    gesture: Name | None = None
    command: Annotated[str, Meta(min_length=1, max_length=MAX_ID_CHARS)] | None = None
    plan: Annotated[int, Meta(ge=1)] | None = None
    file: Annotated[str, Meta(min_length=1, max_length=1024)] | None = None
    parts: Annotated[list[Annotated[str, Meta(min_length=1, max_length=64)]], Meta(max_length=16)] = msgspec.field(
        default_factory=list[str]
    )
    start_s: Annotated[float, Meta(ge=0, le=LONGEST_S)] = 0.0
    end_s: Annotated[float, Meta(gt=0, le=LONGEST_S)] | None = None
    seed: Annotated[int, Meta(ge=0, le=MAX_SEED)] = 0

    def __post_init__(self) -> None:
        """Refuse fields that contradict each other.

        Raises:
            ValueError: which becomes one `error` event.
        """
        super().__post_init__()
        if sum(source is not None for source in (self.gesture, self.command, self.plan, self.file)) != 1:
            raise ValueError("say what is edited: give one of `gesture`, `command`, `plan` and `file`")
        if self.end_s is not None and self.end_s <= self.start_s:
            raise ValueError(f"`end_s` {self.end_s:g} is not after `start_s` {self.start_s:g}: exchange them")
        if not self.text.strip():
            raise ValueError("`text` is empty: say what the new part is to be, in words")

    @property
    def words(self) -> str:
        """The text."""
        return self.text

    @property
    def texts(self) -> tuple[str, ...]:
        """The text."""
        return (self.text,)


class Replay(Play, tag="replay", kw_only=True):
    """Play a motion once more, unchanged, without a generator. Exactly one of `command`, `plan` and `file` names the motion.

    Attributes:
        command: id of a command that was played.
        plan: number of its plan, as in its events.
        file: an .npz of `mmmd generate`, within the daemon's folder of motions (`--motions`).
    """

    command: Annotated[str, Meta(min_length=1, max_length=MAX_ID_CHARS)] | None = None
    plan: Annotated[int, Meta(ge=1)] | None = None
    file: Annotated[str, Meta(min_length=1, max_length=1024)] | None = None

    def __post_init__(self) -> None:
        """Refuse fields that contradict each other.

        Raises:
            ValueError: which becomes one `error` event.
        """
        super().__post_init__()
        if sum(source is not None for source in (self.command, self.plan, self.file)) != 1:
            raise ValueError("say what is played: give one of `command`, `plan` and `file`")

    @property
    def words(self) -> str:
        """The name of the motion, in words."""
        return self.file or self.command or f"plan {self.plan}"
