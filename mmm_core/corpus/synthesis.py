"""Draws a clip at random: which gestures, how, in what order, with what words; and performs it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mmm_core.corpus.families import FAMILIES, Gesture
from mmm_core.corpus.grammar import caption, usual_counts
from mmm_core.corpus.score import REST_ARM, ArmPose, Body, Score, perform
from mmm_core.motion import FPS
from mmm_core.skeleton import Array
from mmm_core.tokens import FRAMES_PER_TOKEN, MAX_TOKENS

N_CAPTIONS = 6
LONGEST_S = MAX_TOKENS * FRAMES_PER_TOKEN / FPS
_COUNT_WEIGHTS = np.array([0.19, 0.25, 0.25, 0.15, 0.10, 0.06])
"""Probability of one to six repetitions."""
_WEIGHTS = {"wave": 3.0, "point": 3.0, "look": 2.5, "raise": 2.0, "clap": 1.8, "nod": 1.8, "shake_head": 1.5, "bow": 1.5, "punch": 1.5, "stand": 0.8, "lean": 1.5, "twist": 1.3, "beckon": 1.3, "arms_down": 1.2, "hands_up": 1.3, "stop": 1.3}  # fmt: skip
_NAMES = list(FAMILIES)
_P = np.array([_WEIGHTS.get(name, 1.0) for name in _NAMES])
_P /= _P.sum()
_SIZED = ("wave", "punch", "clap", "bow", "nod", "shake_head", "tilt_head", "lean", "twist", "shrug", "arm_circle", "flap")  # fmt: skip
_HEAD_ONLY = ("nod", "shake_head", "look", "tilt_head")
_ARM_ONLY = ("wave", "raise", "arm_forward", "arm_side", "t_pose", "hands_up", "cross_arms", "hands_on_hips", "stop", "heart", "clap", "beckon", "salute", "phone", "push")  # fmt: skip


@dataclass(frozen=True)
class ClipSpec:
    """What a clip shows: gestures in order, or two at once."""

    gestures: tuple[Gesture, ...]
    parallel: bool = False


@dataclass(frozen=True)
class SynthClip:
    """A made clip.

    Attributes:
        features: (T, 263) float32, T a multiple of four.
        captions: sentences for it.
        spec: what it shows.
        body: joints, head and forearms before they became features.
    """

    features: NDArray[np.float32]
    captions: list[str]
    spec: ClipSpec
    body: Body


def draw_gesture(rng: np.random.Generator, names: tuple[str, ...] | None = None) -> Gesture:
    """One gesture, of the families in `names` where given."""
    name = str(rng.choice(names)) if names else _NAMES[int(rng.choice(len(_NAMES), p=_P))]
    family = FAMILIES[name]
    side = ""
    if family.sides:
        one_sided = family.sides != ("both",)
        weights = np.array([0.25 if s == "both" and one_sided else 1.0 for s in family.sides])
        side = str(rng.choice(family.sides, p=weights / weights.sum()))
    direction = str(rng.choice(family.directions)) if family.directions else ""
    if name in ("clap", "hug") and rng.random() < 0.4:
        direction = ""
    count = 1
    if family.counts:
        said = rng.random() < 0.7
        count = 1 + int(rng.choice(6, p=_COUNT_WEIGHTS)) if said else int(rng.choice(usual_counts(name)))
    tempo, size = 1.0, 1.0
    if rng.random() < 0.22:
        tempo = float(rng.choice([0.65, 1.4]))
    elif name in _SIZED and rng.random() < 0.2:
        size = float(rng.choice([0.65, 1.25]))
    return Gesture(name, side, count, direction, tempo, size)


def draw_spec(rng: np.random.Generator) -> ClipSpec:
    """One gesture, two in a row, or a head gesture during an arm gesture."""
    kind = rng.random()
    if kind < 0.66:
        return ClipSpec((draw_gesture(rng),))
    if kind < 0.74:
        return ClipSpec((draw_gesture(rng, _ARM_ONLY), draw_gesture(rng, _HEAD_ONLY)), parallel=True)
    first, second = draw_gesture(rng), draw_gesture(rng)
    while "stand" in (first.family, second.family) or second.family in (first.family, "arms_down"):
        first, second = draw_gesture(rng), draw_gesture(rng)
    return ClipSpec((first, second))


def synthesise(rng: np.random.Generator) -> SynthClip:
    """A clip drawn at random, at most 9.8 s long."""
    while True:
        clip = synthesise_spec(draw_spec(rng), rng)
        if clip is not None:
            return clip


def synthesise_spec(spec: ClipSpec, rng: np.random.Generator) -> SynthClip | None:
    """A clip that shows `spec`; None when it would be longer than 9.8 s."""
    score = Score(rng, _rest(rng))
    if rng.random() < 0.35:
        score.hold(rng.uniform(0.05, 0.35))
    _write(score, spec)
    last = FAMILIES[spec.gestures[-1].family]
    if rng.random() < (0.55 if last.holds else 0.93):
        score.relax(rng.uniform(0.5, 0.85))
    score.hold(rng.choice([0.1, rng.uniform(0.1, 0.6), rng.uniform(0.3, 2.0)]))
    n_tokens = int(np.ceil(score.time_s * FPS / FRAMES_PER_TOKEN))
    if n_tokens > MAX_TOKENS:
        return None
    body = perform(score, n_tokens * FRAMES_PER_TOKEN)
    captions = [caption(list(spec.gestures), spec.parallel, rng) for _ in range(N_CAPTIONS)]
    return SynthClip(body.features(), captions, spec, body)


def _write(score: Score, spec: ClipSpec) -> None:
    start_s, ends = score.time_s, [score.time_s]
    for i, gesture in enumerate(spec.gestures):
        if i and spec.parallel:
            score.time_s = start_s + score.rng.uniform(0.0, 0.3)
        elif i and not (score.rng.random() < 0.3 and gesture.side and gesture.side == spec.gestures[i - 1].side):
            score.relax(score.rng.uniform(0.4, 0.65))
        FAMILIES[gesture.family].perform(score, gesture)
        ends.append(score.time_s)
    score.time_s = max(ends)


def _rest(rng: np.random.Generator) -> dict[str, Array]:
    """A relaxed stance: arms hang, a little different for everybody."""

    def arm() -> Array:
        upper, fore = np.array(REST_ARM.upper), np.array(REST_ARM.fore)
        jitter = rng.normal(0, 0.04, (2, 3))
        u, f = upper + jitter[0], fore + jitter[1]
        return ArmPose((abs(float(u[0])), float(u[1]), float(u[2])), (float(f[0]), float(f[1]), float(f[2]))).vector()

    lean = rng.normal(0, np.deg2rad(1.5))
    return {
        "left": arm(),
        "right": arm(),
        "head": np.zeros(3),
        "trunk": np.array([0.0, lean, 0.0]),
        "shrug": np.zeros(1),
    }
