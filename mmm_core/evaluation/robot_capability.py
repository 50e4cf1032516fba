"""Finds the expectations of probes that a robot can meet: a robot without a waist cannot bow, whatever the model generates.

The corpus itself performs each probe and the robot follows. An expectation that is not met then is beyond the robot, or
beyond the retargeting. The remaining expectations measure the model and not the body.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from mmm_core.corpus.families import FAMILIES
from mmm_core.corpus.heldout import PROBES, Probe
from mmm_core.evaluation.probes import judge
from mmm_core.evaluation.reconstruction import Features, performed
from mmm_core.motion.features import recover
from mmm_core.motion.motion import FPS, Motion
from mmm_core.motion.posture_features import PostureFeatures, posture_features

PERFORMANCES = 3
"""Performances of each probe; the robot can show an expectation when most of them meet it."""
OnRobot = Callable[[Motion], Motion]


def showable(
    on_robot: OnRobot, progress: Callable[[int], None] = lambda _n: None, probes: Sequence[Probe] = PROBES
) -> dict[str, frozenset[str]]:
    """The expectations that a robot can show, by the text of each probe.

    Args:
        on_robot: maps a motion to a person in the robot's poses (`retarget.robot_to_human.shown_on_a_person`).
        progress: called with the number of probes done.
        probes: the probes to perform.
    """
    found: dict[str, frozenset[str]] = {}
    for probe in probes:
        seen: Counter[str] = Counter()
        for shown in performances(probe, on_robot):
            seen.update(key for key, ok in judge(probe, shown, with_pose=True).items() if ok)
        found[probe.text] = frozenset(key for key, n in seen.items() if is_most(n))
        progress(len(found))
    return found


def performances(probe: Probe, on_robot: OnRobot) -> Iterator[PostureFeatures]:
    """The corpus's own performances of a probe, as a robot shows them; a gesture without strokes as often as it is to be done."""
    is_whole = not FAMILIES[probe.family].counts and probe.then is None
    times = (probe.count or 1) if is_whole else 1
    for seed in range(PERFORMANCES):
        motion = on_robot(as_motion(np.tile(performed(probe, seed), (times, 1)), probe.text))
        yield posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad)


def is_most(n_performances: int) -> bool:
    """Whether a number of performances is the greater part of all."""
    return 2 * n_performances > PERFORMANCES


def as_motion(features: Features, text: str = "") -> Motion:
    """The motion of features (T, 263)."""
    seen = recover(features)
    return Motion(
        seen.joints_m.astype(np.float32), FPS, seen.head_quat_wxyz.astype(np.float32), seen.forearm_twist_rad.astype(np.float32),
        features, np.zeros(0, np.int64), text, 0, "accepted", 1.0,
    )  # fmt: skip
