"""Judges tempo and size of a motion for a sentence that names them, against the motion of the plain sentence."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from mmm_core.corpus.families import FAMILIES
from mmm_core.corpus.heldout import Command
from mmm_core.corpus.plain_commands import plain_phrases
from mmm_core.language.inflection import times
from mmm_core.motion.drawn_circles import drawn_circle, farther_hand, loop_width_m, width_m
from mmm_core.motion.motion import Motion
from mmm_core.motion.posture_features import posture_features
from mmm_core.motion.repetitions import Strokes, about_mean, body_path, strokes_of
from mmm_core.motion.sizing import is_cyclic
from mmm_core.recognition import checks

LEAST_CHANGE = 1.15
"""Factor by which tempo or size must differ, in the right sense, from those of the plain sentence's motion."""
_CIRCLES = frozenset({"arm_circle", "draw_circle"})
"""Families whose size is that of the circle and not how far the hand goes from its first pose."""
_MOVING = 0.2
"""Share of the greatest speed above which a frame counts as moving."""


def judge_manner(command: Command, motion: Motion, plain: Motion) -> dict[str, bool]:
    """Whether tempo and size of a motion differ from those of the plain motion by at least `LEAST_CHANGE`, in the right sense."""
    verdict: dict[str, bool] = {}
    if command.tempo:
        faster = _pace(motion, command) / max(_pace(plain, command), 1e-6)
        verdict["tempo"] = faster >= LEAST_CHANGE if command.tempo == "fast" else faster <= 1 / LEAST_CHANGE
    if command.size:
        larger = _size_ratio(motion, plain, command)
        verdict["size"] = larger >= LEAST_CHANGE if command.size == "large" else larger <= 1 / LEAST_CHANGE
    return verdict


def plain_sentence(command: Command) -> str:
    """The corpus's first sentence for a command without its manner."""
    row = {"": ("any", "none", "both"), "both": ("both",), "alternating": ("alternating",)}.get(command.side, ("one",))
    ways = (command.direction, *FAMILIES[command.family].directions)  # a command may leave open where to
    said = next(phrases for way in ways if (phrases := plain_phrases(command.family, way)))
    fitting = [p for r, p in said if r in row and "{N}" not in p and (command.count is None or "{n}" in p)]
    phrase = (fitting or [p for _, p in said if "{N}" not in p])[0]
    often = "" if command.count is None else times(command.count, np.random.default_rng(3))
    filled = phrase.replace("{S}", command.side).replace("{D}", command.direction).replace("{n}", often)
    return " ".join(filled.split())


def _pace(motion: Motion, command: Command) -> float:
    """Speed of a motion: strokes a second or, without strokes, mean speed while moving divided by the motion's reach."""
    s = posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad)
    cycle = checks.cycle_s(s, command.family)
    if cycle:
        return 1 / cycle
    path = _limb_path(motion, command)
    speed = np.linalg.norm(np.diff(path, axis=0), axis=-1)
    moving = speed[speed > _MOVING * speed.max()] if len(speed) and speed.max() > 0 else np.zeros(1)
    return float(moving.mean()) * motion.fps / max(float(np.linalg.norm(path - path[0], axis=-1).max()), 1e-6)


def _size_ratio(motion: Motion, plain: Motion, command: Command) -> float:
    """How many times larger a motion is than the plain one, by the first measure that both have."""
    measures = (_stroke_range, _cycle_range_m, _circle_width_m)
    sizes = [(measure(motion, command), measure(plain, command)) for measure in measures]
    sizes += [_cycle_ranges_m(motion, plain), _circle_widths_m(motion, plain)]
    sizes += [(measure(motion, command), measure(plain, command)) for measure in (_loop_width_m, _signal_range, _reach)]
    return next((a / b for a, b in sizes if a > 0 and b > 0), 1.0)


def _cycle_ranges_m(motion: Motion, plain: Motion) -> tuple[float, float]:
    """Ranges of a repeated stroke of both motions, where the plain one alone repeats it clearly; else 0."""
    found = strokes_of(plain)
    if found is None or not is_cyclic(found):
        return 0.0, 0.0
    swings = [_swing_m(shown, plain, found) for shown in (motion, plain)]
    return swings[0], swings[1]


def _swing_m(motion: Motion, plain: Motion, strokes: Strokes) -> float:
    """Range of the farther-swinging hand about its mean over a period, while the plain motion makes its strokes."""
    away = about_mean(motion.joints_m[:, 20:] - motion.joints_m[:, [9]], strokes.period_frames)
    per_frame = len(motion.joints_m) / len(plain.joints_m)
    first, last = (round(strokes.frames[i] * per_frame) for i in (0, -1))
    return float(np.ptp(away[first : last + 1], axis=0).max())


def _circle_widths_m(motion: Motion, plain: Motion) -> tuple[float, float]:
    """Widths of a circle that only the plain motion draws round: of the same hand in the same share of the time."""
    found = drawn_circle(farther_hand(plain.joints_m))
    if found is None:
        return 0.0, 0.0
    widths: list[float] = []
    for shown in (motion, plain):
        per_frame = len(shown.joints_m) / len(plain.joints_m)
        first, last = (round(frame * per_frame) for frame in found)
        widths.append(width_m(farther_hand(shown.joints_m)[first : last + 1]))
    return widths[0], widths[1]


def _stroke_range(motion: Motion, command: Command) -> float:
    """Range of the family's own signal from peak to valley between its strokes; 0 with fewer than two strokes."""
    falls = [
        float(signal[[a, b]].mean() - signal[a : b + 1].min())
        for signal, least in _signals(motion, command)
        for a, b in pairwise(checks.peaks(signal, least))
    ]
    return float(np.median(falls)) if falls else 0.0


def _cycle_range_m(motion: Motion, _command: Command) -> float:
    """Range of one cycle of a motion that repeats, without what leads to it, such as raising the arms; else 0."""
    found = strokes_of(motion)
    return found.range_m if found is not None and is_cyclic(found) else 0.0


def _circle_width_m(motion: Motion, _command: Command) -> float:
    """Width of a circle that a hand draws once; else 0."""
    hand = farther_hand(motion.joints_m)
    found = drawn_circle(hand)
    return 0.0 if found is None else width_m(hand[found[0] : found[1] + 1])


def _loop_width_m(motion: Motion, command: Command) -> float:
    """Width of the path that a hand draws in a gesture of circles, however round a robot's limits leave it; else 0."""
    return loop_width_m(farther_hand(motion.joints_m)) if command.family in _CIRCLES else 0.0


def _signal_range(motion: Motion, command: Command) -> float:
    """Range of the family's own signal; 0 where it has none."""
    return max((float(np.ptp(signal)) for signal, _ in _signals(motion, command) if len(signal)), default=0.0)


def _signals(motion: Motion, command: Command) -> list[tuple[np.ndarray, float]]:
    s = posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad)
    return checks._stroke_signals(s, command.family)  # noqa: SLF001


def _reach(motion: Motion, command: Command) -> float:
    """Greatest distance of the limb from its first pose."""
    path = _limb_path(motion, command)
    return float(np.linalg.norm(path - path[0], axis=-1).max())


def _limb_path(motion: Motion, command: Command) -> np.ndarray:
    """(T, D) path of the limb that a command moves."""
    path = body_path(motion)
    columns = {"head": [6, 7, 8], "trunk": [9, 10, 11]}.get(command.limb)
    if columns is None:
        sides = {"left": [0, 1, 2], "right": [3, 4, 5]}
        columns = sides.get(command.side, [0, 1, 2, 3, 4, 5])
    return path[:, columns]
