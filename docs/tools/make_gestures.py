"""Makes the gestures that ship: `python -m docs.tools.make_gestures`. Once for each model; the result is in version control.

Each gesture is a text of the table below, generated with seed after seed until one passes the kinematic checks of the
evaluation (limb, side, count, direction), and begins and ends near standing. The best of the
first few that pass is kept: nearest to standing at its ends, and fitting the reference robot with the least change. Where
one side fails, it is the other side's mirror image, which must pass the same checks.
"""

from __future__ import annotations

import logging
import sys
from dataclasses import dataclass, replace

import numpy as np

from daemon.gestures.clips import Clip, save_clips
from daemon.gestures.library import SHIPPED
from daemon.poses.cycles import marks_of
from daemon.poses.pose_sequence import PoseSequence, distance_deg, mirrored, posture_of, standing
from mmm_core.corpus.heldout import Probe
from mmm_core.motion.motion import Motion
from retarget.pipeline import Retargeter
from retarget.robot.loading import load_robot

log = logging.getLogger(__name__)

SEEDS = range(40)
GOOD_ENOUGH = 4
"""Candidates that pass, of which the best is kept."""
_OUT_AND_BACK_DEG = 30.0
_INTERVENTION_COST = 10.0


@dataclass(frozen=True)
class Wanted:
    """A gesture to make: its name and what its motion must show."""

    name: str
    probe: Probe
    seconds: float | None = None


def _arm(name: str, family: str, text: str, direction: str = "", count: int | None = None) -> list[Wanted]:
    """The same with either arm; `{}` in text and direction is the side."""
    return [
        Wanted(
            f"{name}_{side}", Probe(text.format(side), family, "arm", side, count, direction.format(side))
        ) for side in ("left", "right")
    ]  # fmt: skip


def _both(name: str, family: str, text: str, count: int | None = None) -> list[Wanted]:
    return [Wanted(name, Probe(text, family, "arm", "both", count))]


def _head(name: str, family: str, text: str, direction: str = "", count: int | None = None) -> list[Wanted]:
    return [Wanted(name, Probe(text, family, "head", "", count, direction))]


def _trunk(name: str, family: str, text: str, direction: str = "", count: int | None = None) -> list[Wanted]:
    return [Wanted(name, Probe(text, family, "trunk", "", count, direction))]


WANTED: tuple[Wanted, ...] = (
    *_arm("wave", "wave", "wave with your {} hand"),
    *_arm("wave_twice", "wave", "wave twice with your {} hand", count=2),
    *_arm("raise", "raise", "raise your {} hand"),
    *_arm("raise_side", "raise_side", "lift your {} arm to the side"),
    *_arm("raise_front", "raise_front", "lift your {} arm to the front"),
    *_arm("point_aside", "point", "point {0} with your {0} hand", "{}"),
    *_arm("point_up", "point", "point up with your {} hand", "up"),
    *_arm("point_down", "point", "point down with your {} hand", "down"),
    *_arm("point_forward", "point", "point forward with your {} hand", "forward"),
    *_arm("beckon", "beckon", "beckon with your {} hand"),
    *_arm("stop", "stop", "signal stop with your {} hand"),
    *_arm("salute", "salute", "salute with your {} hand"),
    *_arm("punch", "punch", "punch with your {} fist"),
    *_arm("offer", "offer", "offer your {} hand"),
    *_arm("hand_on_heart", "heart", "put your {} hand on your heart"),
    *_arm("hand_to_chin", "chin", "touch your chin with your {} hand"),
    *_arm("hand_to_ear", "ear", "put your {} hand to your ear"),
    *_arm("hand_on_hip", "hip", "put your {} hand on your hip"),
    *_arm("behind_head", "behind_head", "bring your {} hand behind your head"),
    *_arm("drink", "drink", "lift a cup to your lips with the {} hand"),
    *_arm("push", "push", "push something away with your {} hand"),
    *_arm("pull", "pull", "pull something towards you with your {} hand"),
    *_arm("conduct", "conduct", "conduct an orchestra with your {} hand"),
    *_arm("circle", "circle", "draw a circle with your {} arm"),
    *_arm("dismiss", "dismiss", "dismiss me with your {} hand"),
    *_both("wave_both", "wave", "wave with both hands"),
    *_both("hands_up", "hands_up", "raise both arms"),
    *_both("t_pose", "t_pose", "raise both arms to shoulder height"),
    *_both("arms_forward", "arms_forward", "stretch both arms forward"),
    *_both("open_arms", "open", "open your arms wide"),
    *_both("cross_arms", "cross", "cross your arms"),
    *_both("hands_on_hips", "hips", "put your hands on your waist"),
    *_both("clap", "clap", "clap your hands"),
    *_both("clap_three_times", "clap", "clap three times", 3),
    *_both("shrug", "shrug", "shrug your shoulders"),
    *_both("cheer", "cheer", "give 3 cheers"),
    *_both("drum", "drum", "drum with both hands"),
    *_both("flap", "flap", "flap both arms"),
    *_both("show_palms", "palms", "show both your palms"),
    *_head("nod", "nod", "nod your head up and down"),
    *_head("nod_twice", "nod", "nod twice", count=2),
    *_head("shake_head", "shake_head", "shake your head"),
    *_head("look_left", "look", "look to the left", "left"),
    *_head("look_right", "look", "look to the right", "right"),
    *_head("look_up", "look", "look up at the sky", "up"),
    *_head("look_down", "look", "look down", "down"),
    *_head("tilt_head_left", "tilt_head", "tilt your head to the left", "left"),
    *_head("tilt_head_right", "tilt_head", "tilt your head to the right", "right"),
    *_head("scan", "scan", "scan the room"),
    *_trunk("bow", "bow", "bow"),
    *_trunk("bow_twice", "bow", "bow twice", count=2),
    *_trunk("lean_left", "lean", "tilt your upper body left", "left"),
    *_trunk("lean_right", "lean", "tilt your upper body right", "right"),
    *_trunk("lean_back", "lean", "bend backwards", "back"),
    *_trunk("twist_left", "twist", "twist your upper body to the left", "left"),
    *_trunk("twist_right", "twist", "twist your upper body to the right", "right"),
)


def mirror_name(name: str, names: set[str]) -> str:
    """The clip of the other side; empty for one that has no side."""
    for a, b in (("_left", "_right"), ("_right", "_left")):
        if name.endswith(a) and name.removesuffix(a) + b in names:
            return name.removesuffix(a) + b
    return ""


def main() -> int:
    """Make all that can be made; the others are named."""
    from mmm_core.generate.engine import Engine

    logging.basicConfig(level=logging.INFO, format="%(message)s")
    engine = Engine.load(threads=1)
    retargeter = Retargeter(load_robot("reference"))
    names = {w.name for w in WANTED}
    clips: dict[str, Clip] = {}
    missing: list[Wanted] = []
    for wanted in WANTED:
        passed: list[tuple[float, int, PoseSequence]] = []
        for seed in SEEDS:
            motion = engine.generate(wanted.probe.text, seed=seed, seconds=wanted.seconds).motion
            if (cost := _cost(motion, wanted, retargeter)) is not None:
                passed.append((cost, seed, posture_of(motion)))
            if len(passed) >= GOOD_ENOUGH:
                break
        if not passed:
            missing.append(wanted)
            log.info("%-20s none of %d seeds passes: %s", wanted.name, len(SEEDS), wanted.probe.text)
            continue
        cost, seed, posture = min(passed, key=lambda row: row[0])
        source = f"checkpoint {engine.checkpoint_hash[:12]}, seed {seed}"
        marks = marks_of(posture)
        clips[wanted.name] = Clip(
            wanted.name, wanted.probe.text, posture, marks, mirror_name(wanted.name, names), source
        )
        log.info(
            "%-20s seed %d, %.1f s, loop %s, hold %d", wanted.name, seed, len(posture) / 20, marks.loop, marks.hold
        )
    for wanted in list(missing):
        other = clips.get(mirror_name(wanted.name, names))
        if other is None:
            continue
        posture = mirrored(other.posture)
        if _cost(posture.motion(), wanted, retargeter) is not None:
            source = f"mirror image of {other.name}: {other.source}"
            clips[wanted.name] = Clip(wanted.name, wanted.probe.text, posture, other.marks, other.name, source)
            missing.remove(wanted)
    clips = dict(sorted(clips.items()))
    for name, clip in clips.items():
        clips[name] = replace(clip, mirror=mirror_name(name, set(clips)))
    save_clips(SHIPPED, clips)
    log.info("%d gestures; not made: %s", len(clips), ", ".join(w.name for w in missing) or "none")
    return 0


def _cost(motion: Motion, wanted: Wanted, retargeter: Retargeter) -> float | None:
    """How far a motion is from the best; None when it fails a check."""
    from mmm_core.evaluation.probes import judge
    from mmm_core.motion.posture_features import posture_features

    if motion.status != "accepted" or len(motion.joints_m) < 16:
        return None
    verdict = judge(wanted.probe, posture_features(motion.joints_m, motion.head_quat_wxyz))
    if not all(verdict.values()):
        return None
    posture = posture_of(motion)
    ends = distance_deg(standing().at(np.zeros(2, np.intp)), posture.at(np.array([0, len(posture) - 1])))
    report = retargeter.retarget(motion).report
    if ends.max() > _OUT_AND_BACK_DEG:
        return None
    return float(ends.max()) + report.direction_mean_deg + _INTERVENTION_COST * report.interventions


if __name__ == "__main__":
    sys.exit(main())
