"""Finds the joints that a robot lacks to show a motion, before it moves: a waist, a neck that tilts, arms of four joints."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from mmm_core.motion.motion import Motion
from mmm_core.motion.posture_features import posture_features
from mmm_core.recognition.checks import HEAD_MOVED_DEG, reach_deg
from mmm_core.recognition.seen import Act
from retarget.human.human import read_human
from retarget.pipeline import Retargeter

_AXES = {
    "nod": "pitch", "shake_head": "yaw", "look_around": "yaw", "look_back": "yaw", "tilt_head": "roll", "wobble_head": "roll",
    "roll_head": "pitch roll", "look": "yaw pitch", "look left": "yaw", "look right": "yaw", "look up": "pitch",
    "look down": "pitch",
    "bow": "pitch", "slump": "pitch", "breathe": "pitch", "twist": "yaw", "twist_repeat": "yaw", "sway": "roll", "shift": "roll",
    "trunk_circle": "pitch roll", "lean": "pitch roll", "lean left": "roll", "lean right": "roll", "lean forward": "pitch",
    "lean back": "pitch",
}  # fmt: skip
"""Axes about which head or trunk must turn to show a family, or a family in a direction."""
_SAID = {"pitch": "bends forward", "yaw": "turns", "roll": "tilts sideways"}
_WHOLE_ARM = ("shoulder_pitch", "shoulder_roll", "shoulder_yaw", "elbow")
"""An arm that has these joints points both its bones anywhere, as far as its limits go."""
_OFF_DEG = 25.0
"""Degrees by which the bones of an arm may miss their direction before this is reported."""
_KEY_FRAMES = 5


def lacking(retargeter: Retargeter, motion: Motion, acts: Iterable[Sequence[Act]]) -> str:
    """Text of what the robot lacks to show a motion; empty for nothing.

    Args:
        retargeter: retargeter of the robot.
        motion: motion as a person performs it.
        acts: acts that the motion shows, scene by scene.
    """
    roles = {joint.role for joint in retargeter.robot.joints}
    found: dict[str, None] = {}
    for act in (act for scene in acts for act in scene):
        if act.limb == "arm":
            for side in ("left", "right") if act.side == "both" else (act.side,):
                found |= dict.fromkeys(_of_arm(retargeter, motion, side, roles))
        elif act.limb:
            found |= dict.fromkeys(_of_body(act, roles))
    return "; ".join(found)


def _of_body(act: Act, roles: set[str]) -> list[str]:
    joint = "head" if act.limb == "head" else "waist"
    axes = (_AXES.get(f"{act.family} {act.direction}") or _AXES.get(act.family, "")).split()
    missing = [axis for axis in axes if f"{joint}_{axis}" not in roles]
    if not missing and axes:
        return []
    if joint == "waist" and _bends(act) and "head_pitch" in roles:
        return ["it has no waist that bends forward: its head does instead"]
    if not any(role.startswith(joint) for role in roles):
        return [f"it has no {'neck' if joint == 'head' else 'waist'}"]
    return [f"it has no {joint} joint that {_SAID[axis]}" for axis in missing]


def instead(act: Act, robots: Motion) -> str:
    """Text of the replacement for an act that a robot without a waist cannot show, if the robot has made it; else empty."""
    if not _bends(act):
        return ""
    shown = posture_features(robots.joints_m, robots.head_quat_wxyz)
    return ", the head bent instead" if reach_deg(shown, "head") > HEAD_MOVED_DEG else ""


def _bends(act: Act) -> bool:
    """Whether the act bends the upper body forward, which bending the head can replace."""
    return act.family in ("bow", "slump") or (act.family, act.direction) == ("lean", "forward")


def _of_arm(retargeter: Retargeter, motion: Motion, side: str, roles: set[str]) -> list[str]:
    if not any(role.startswith(f"{side}_shoulder") for role in roles):
        return [f"it has no {side} arm"]
    if all(f"{side}_{joint}" in roles for joint in _WHOLE_ARM):
        return []
    at = (np.linspace(0.25, 0.75, _KEY_FRAMES) * (len(motion.joints_m) - 1)).astype(np.intp)
    key = replace(
        motion, joints_m=motion.joints_m[at], head_quat_wxyz=motion.head_quat_wxyz[at], features=motion.features[at],
        forearm_twist_rad=motion.forearm_twist_rad[at], tokens=motion.tokens[:0],
    )  # fmt: skip
    poses = retargeter.poses(read_human(key))
    off = np.median(retargeter.direction_errors_deg(poses, poses.q_rad), axis=1)[0 if side == "left" else 1 :: 2]
    worst = float(off.max())
    n_joints = sum(role.startswith((f"{side}_shoulder", f"{side}_elbow", f"{side}_forearm")) for role in roles)
    return [f"its {side} arm of {n_joints} joints is about {worst:.0f} degrees off"] if worst > _OFF_DEG else []
