"""Describes what a command's motion shows and what the robot lacks for it, and judges whether the robot has shown it."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from daemon.playback.sources.lacking import instead, lacking
from daemon.poses.pose_sequence import PoseSequence, distance_deg, posture_of
from daemon.state.ledger import Entry
from mmm_core.motion.motion import Motion
from mmm_core.motion.posture_features import posture_features
from mmm_core.recognition.checks import PALM_M
from mmm_core.recognition.named import families_named
from mmm_core.recognition.seen import HARDLY, NOTHING_MOVES, Scene, lost, scenes_seen, sentence
from mmm_core.recognition.signs import TOUCHING_M, palms_meet
from retarget.human.hand_contacts import Hands
from retarget.pipeline import Retargeter
from retarget.robot.robot import RobotModel
from retarget.robot_to_human import as_motion

Array = NDArray[np.float64]
SHOWN, IN_PART, NOT_SHOWN = "shown", "in part", "not shown"
_TOUCHING_M, _LOOKED_AT = 0.03, 200
"""Metres between a robot's hands up to which they touch, and number of poses examined."""
_OTHER_POSE_DEG = 20.0
"""Degrees by which the first pose of a robot differs from that of a motion where it began in another one."""
_HELD_S = 1.0
"""Seconds of a held pose that are judged beside the way to it."""
LONGEST_S = 15.0
"""Seconds of a motion that are judged; a longer motion is not judged."""


ShownCheck = Callable[[Entry, Array, float], "Verdict"]
"""Judges whether goals (T, J), at a rate in hertz, have shown the motion of a command."""


@dataclass(frozen=True)
class Shows:
    """Description of a motion before it is played.

    Attributes:
        sentence: text of what the motion shows.
        lacks: text of what the robot lacks to show it; empty for nothing.
    """

    sentence: str
    lacks: str


@dataclass(frozen=True)
class Verdict:
    """Judgement whether a robot has shown a motion.

    Attributes:
        shown: "shown", "in part" or "not shown"; empty when it is not judged.
        seen: text of what the motion shows.
        missing: text of what was not seen on the robot; empty for nothing.
    """

    shown: str = ""
    seen: str = ""
    missing: str = ""


class Showing:
    """Describes and judges motions for one robot. Its methods may run in any thread."""

    def __init__(self, robot: RobotModel) -> None:
        self._retargeter, self._lock = Retargeter(robot), threading.Lock()
        self._hands = Hands(self._retargeter.kinematics, self._retargeter.contact, self._retargeter.limits)
        families_named("wave")  # reads the tables now, not with the first text

    def of(self, posture: PoseSequence, scenes: Sequence[Scene], *, draft: bool = False) -> Shows:
        """The description of a motion, and of what the robot lacks for it.

        Args:
            posture: the motion, or its first part.
            scenes: its scenes; scenes that begin after the end of `posture` are described by their words.
            draft: whether it is a draft, whose strokes are not counted, because the motion may have another number of them.
        """
        motion, length_s = posture.motion(), len(posture) / posture.fps
        n_here = 1 + sum(scene.end_s < length_s for scene in scenes[:-1])
        acts = scenes_seen(motion, scenes[:n_here])
        to_come = [f"what '{scene.words.partition(chr(10))[0]}' asks" for scene in scenes[n_here:]]
        with self._lock:
            lacks = lacking(self._retargeter, motion, acts)
        return Shows(", then ".join([sentence(acts, counted=not draft), *to_come]), lacks)

    def verdict(
        self, posture: PoseSequence, scenes: Sequence[Scene], q_rad: Array, fps: float, *, held: bool = False
    ) -> Verdict:
        """Judge whether the robot has shown a motion.

        Args:
            posture: the motion, as it was to be played.
            scenes: its scenes.
            q_rad: (T, J) goals that the robot was given for it, radians.
            fps: number of goals a second.
            held: whether the robot stays in the last goal.
        """
        if held and len(q_rad):
            q_rad = np.concatenate([q_rad, np.repeat(q_rad[-1:], round(_HELD_S * fps), 0)])
        if len(q_rad) < 2 or len(posture) > LONGEST_S * posture.fps:
            return Verdict()
        motion = posture.motion()
        acts = scenes_seen(motion, scenes)
        every, said = [act for scene in acts for act in scene], sentence(acts)
        if all(act.sentence == NOTHING_MOVES for act in every):
            meant = all("stand" in families_named(scene.words) for scene in scenes)
            return Verdict(SHOWN, said) if meant else Verdict(NOT_SHOWN, said, "nothing moves")
        robots = as_motion(self._retargeter.kinematics, q_rad[: round(motion.duration_s * fps) + 1], fps, motion)
        robots = _from_its_first_pose(robots, motion)
        missing = [(act, what, instead(act, robots)) for act, what in lost(robots, scenes, acts)]
        missing += [(act, self._apart(q_rad, robots), "") for act in every if palms_meet(act.family)]
        missing = [row for row in missing if row[1]]
        if not missing:
            return Verdict(SHOWN, said)
        seen_at_all = any(other or not what.endswith(HARDLY) for _, what, other in missing) or len(missing) < len(every)
        words = "; ".join(dict.fromkeys(what + other for _, what, other in missing))
        return Verdict(IN_PART if seen_at_all else NOT_SHOWN, said, words)

    def _apart(self, q_rad: Array, robots: Motion) -> str:
        """Text of how far apart the hands stay in poses (T, J); empty when they meet, by the robot's shapes or its forearms.

        `robots` holds these poses on a person: a robot whose hands have no shapes is judged by where its forearms lead.
        """
        with self._lock:
            apart_m = self._hands.apart_m(q_rad[:: max(1, len(q_rad) // _LOOKED_AT)])
        seen = posture_features(robots.joints_m, robots.head_quat_wxyz)
        palms = [seen.wrists_m[side] + PALM_M * seen.fore[side] for side in ("left", "right")]
        on_a_person_m = float(np.linalg.norm(palms[0] - palms[1], axis=-1).min())
        together = apart_m < _TOUCHING_M or (np.isinf(apart_m) and on_a_person_m < _TOUCHING_M + TOUCHING_M)
        return "" if together else f"the hands stay {100 * min(apart_m, on_a_person_m):.0f} cm apart"


def _from_its_first_pose(robots: Motion, motion: Motion) -> Motion:
    """A robot's motion with the first pose of the motion that it follows, where the robot began in another one.

    Signs are measured from the first pose: a robot that bows while it is bent does not bend from there.
    """
    if distance_deg(posture_of(robots)[:1], posture_of(motion)[:1])[0] < _OTHER_POSE_DEG:
        return robots
    joints_m, head_quat_wxyz = robots.joints_m.copy(), robots.head_quat_wxyz.copy()
    joints_m[0], head_quat_wxyz[0] = motion.joints_m[0], motion.head_quat_wxyz[0]
    return replace(robots, joints_m=joints_m, head_quat_wxyz=head_quat_wxyz)


def at_tempo(scenes: Sequence[Scene], tempo: float) -> list[Scene]:
    """The scenes of a motion played `tempo` times as fast."""
    return [replace(scene, end_s=scene.end_s / tempo) for scene in scenes]
