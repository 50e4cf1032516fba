"""Draws a clip at random (gestures, their manner, order and words) and performs it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mmm_core.corpus.beat import Calm
from mmm_core.corpus.body import Body, perform
from mmm_core.corpus.families import FAMILIES, Family, Gesture
from mmm_core.corpus.grammar import caption, usual_counts
from mmm_core.corpus.score import REST_ARM, ArmPose, Score
from mmm_core.language.moods import MOODS
from mmm_core.model.tokens import FRAMES_PER_TOKEN, MAX_TOKENS
from mmm_core.motion.motion import FPS
from mmm_core.motion.skeleton import Array

N_CAPTIONS = 6
SINGLE_SHARE = 0.62
"""Share of clips that show one gesture, by default."""
LONGEST_S = MAX_TOKENS * FRAMES_PER_TOKEN / FPS
_COUNT_WEIGHTS = np.array([0.16, 0.21, 0.21, 0.16, 0.12, 0.07, 0.04, 0.03])
"""Probability of one to eight repetitions."""
_WEIGHTS = {
    "wave": 7.0, "point": 6.0, "look": 6.0, "raise": 3.5, "clap": 4.5, "nod": 4.5, "shake_head": 3.5, "bow": 3.5, "punch": 3.0, "lean": 3.0,
    "twist": 2.2, "tilt_head": 2.2, "beckon": 1.5, "arms_down": 1.5, "hands_up": 1.6, "stop": 1.6, "arm_forward": 1.6, "arm_side": 1.6,
    "t_pose": 1.3, "cross_arms": 1.3, "hands_on_hips": 1.3, "salute": 1.3, "shrug": 1.2, "arm_circle": 1.6, "stand": 1.2, "think": 1.2, "heart": 1.2,
}  # fmt: skip
"""How often a family is drawn, the others 0.8: what people ask for most, and what can be counted, more often."""


def usual_weight(family: str) -> float:
    """How often a family is drawn unless told otherwise, beside the others."""
    return _WEIGHTS.get(family, 0.8)


_NAMES = list(FAMILIES)
_P = np.array([usual_weight(name) for name in _NAMES])
_P /= _P.sum()
_UNSIZED = ("tilt_head", "look", "look_back", "look_around", "high_five", "handshake", "fist_pump", "cheer", "catch", "throw", "throw_low", "tennis", "golf", "basketball", "archery", "kiss", "type", "drum", "piano", "pick", "climb", "turn_key", "flip_palm", "robot", "arm_wave", "yawn", "hook", "uppercut", "punch", "stand", "shift")  # fmt: skip
"""Families whose way of performing knows no size."""
_HEAD_ONLY = ("nod", "shake_head", "look", "tilt_head")
_USES_HEAD = ("zombie", "stretch", "think", "shade_eyes", "facepalm", "listen", "yawn", "drink", "watch_time", "lift", "robot", "dab", "violin", "archery", "celebrate", "shrug", "present", "point")  # fmt: skip
_ONE_ARMED = tuple(n for n, f in FAMILIES.items() if f.limb == "arm" and "right" in f.sides and not f.starts_away)
_ARM_ONLY = tuple(n for n, f in FAMILIES.items() if f.limb == "arm" and not f.starts_away and n not in _USES_HEAD)
_USES_BOTH_ARMS = ("superhero", "archery", "disco", "dab", "saw", "guitar", "violin", "flute", "traffic", "throw", "throw_low", "tennis")  # fmt: skip
_FREE_HAND = tuple(n for n in _ONE_ARMED if n not in _USES_BOTH_ARMS and n not in ("punch", "hook", "uppercut"))
_TRUNK_ONLY = ("lean", "twist")


@dataclass(frozen=True)
class ClipSpec:
    """The gestures of a clip: one or several in order, or two at once if `parallel`."""

    gestures: tuple[Gesture, ...]
    parallel: bool = False


@dataclass(frozen=True)
class SynthClip:
    """A synthesised clip.

    Attributes:
        features: (T, 263) float32, T a multiple of four.
        captions: sentences for the clip.
        spec: the gestures of the clip.
        body: joints, head and forearms from which the features were computed.
    """

    features: NDArray[np.float32]
    captions: list[str]
    spec: ClipSpec
    body: Body


def draw_gesture(
    rng: np.random.Generator, names: tuple[str, ...] = (), side: str = "", weights: Mapping[str, float] | None = None
) -> Gesture:
    """One gesture drawn at random.

    Args:
        rng: source of randomness.
        names: families to choose from; all when empty.
        side: side of the gesture; drawn when empty.
        weights: weights by which families are drawn if `names` is empty; None takes the usual ones.
    """
    if names:
        name = names[int(rng.integers(len(names)))]
    else:
        p = _P if weights is None else np.array([weights.get(n, 0.0) for n in _NAMES])
        name = _NAMES[int(rng.choice(len(_NAMES), p=p / p.sum()))]
    family = FAMILIES[name]
    if family.sides and not side:
        often = np.array([{"both": 0.4, "alternating": 0.3}.get(s, 1.0) for s in family.sides])
        side = str(rng.choice(family.sides, p=often / often.sum()))
    direction = str(rng.choice(family.directions)) if family.directions else ""
    if name in ("clap", "hug") and rng.random() < 0.4:
        direction = ""
    count = 1
    if family.counts:
        said = rng.random() < 0.7
        count = 1 + int(rng.choice(8, p=_COUNT_WEIGHTS)) if said else int(rng.choice(usual_counts(name)))
    if side == "alternating":
        count = max(2, count)
    g = Gesture(name, side if family.sides else "", count, direction)
    height = str(rng.choice(["low", "high"])) if family.heights and rng.random() < 0.3 else ""
    return replace(_in_a_manner(g, rng), height=height)


def _in_a_manner(g: Gesture, rng: np.random.Generator) -> Gesture:
    """The gesture, sometimes with another tempo, size, hold or style."""
    family, kind = FAMILIES[g.family], rng.random()
    if kind < (0.3 if family.counts else 0.15):
        return replace(g, tempo=float(rng.choice([0.65, 1.4])))
    if kind < 0.38 and g.family not in _UNSIZED and (family.counts or family.limb in ("head", "trunk")):
        return replace(g, size=float(rng.choice([0.65, 1.25])))
    if kind < 0.48 and family.holds:
        return replace(g, hold_s=float(rng.choice([1, 2, 3, 4, 5], p=[0.1, 0.3, 0.3, 0.2, 0.1])))
    if kind < 0.55 and has_styles(family):
        return in_a_style(g, rng)
    return g


def has_styles(family: Family) -> bool:
    """Whether gestures of a family can have a style: they are gestures of the arms and begin at rest."""
    return family.limb == "arm" and not family.starts_away


def in_a_style(g: Gesture, rng: np.random.Generator) -> Gesture:
    """The gesture in a style drawn at random, with the style's tempo and size."""
    name = str(rng.choice(list(MOODS)))
    size = MOODS[name].size if FAMILIES[g.family].counts else 1.0
    return replace(g, style=name, tempo=MOODS[name].tempo, size=size)


def draw_spec(
    rng: np.random.Generator, weights: Mapping[str, float] | None = None, single_share: float = SINGLE_SHARE
) -> ClipSpec:
    """One gesture, two or three in a row, or two at once on different limbs; `weights` as in `draw_gesture`."""
    kind = float(np.interp(rng.random(), (0.0, single_share, 1.0), (0.0, SINGLE_SHARE, 1.0)))
    if kind < SINGLE_SHARE:
        return ClipSpec((draw_gesture(rng, weights=weights),))
    if kind < 0.74:
        return ClipSpec(_pair_at_once(rng), parallel=True)
    gestures = [draw_gesture(rng, weights=weights)]
    while len(gestures) < (2 if kind < 0.95 else 3):
        following = draw_gesture(rng)
        family = FAMILIES[following.family]
        if following.family != gestures[-1].family and family.limb and not family.starts_away:
            gestures.append(replace(following, style=""))
    return ClipSpec((replace(gestures[0], style=""), *gestures[1:]))


def _pair_at_once(rng: np.random.Generator) -> tuple[Gesture, Gesture]:
    kind = rng.random()
    if kind < 0.5:
        pair = draw_gesture(rng, _ARM_ONLY), draw_gesture(rng, _HEAD_ONLY)
    elif kind < 0.65:
        pair = draw_gesture(rng, _ARM_ONLY), draw_gesture(rng, _TRUNK_ONLY)
    else:
        side = str(rng.choice(["left", "right"]))
        first = draw_gesture(rng, _FREE_HAND, side)
        second = draw_gesture(rng, _FREE_HAND, "right" if side == "left" else "left")
        while second.family == first.family:
            second = draw_gesture(rng, _FREE_HAND, second.side)
        pair = first, second
    return replace(pair[0], style=""), replace(pair[1], style="")


def synthesise(
    rng: np.random.Generator,
    beat_s: float = 0.0,
    weights: Mapping[str, float] | None = None,
    single_share: float = SINGLE_SHARE,
) -> SynthClip:
    """A clip drawn at random, at most 9.8 s long.

    Args:
        rng: source of all randomness.
        beat_s: seconds of a beat, as in `synthesise_spec`.
        weights: weights of the families, as in `draw_gesture`.
        single_share: share of clips that show one gesture.
    """
    while True:
        clip = synthesise_spec(draw_spec(rng, weights, single_share), rng, beat_s)
        if clip is not None:
            return clip


def synthesise_spec(
    spec: ClipSpec, rng: np.random.Generator, beat_s: float = 0.0, *, deterministic: bool = False
) -> SynthClip | None:
    """A clip that shows `spec`, or None if it would be longer than 9.8 s. With a beat its strokes are clean (`beat.py`).

    A `deterministic` clip has no randomness in its pauses either, so that a gesture always has the same motion.
    """
    score = score_of(spec, rng, beat_s, deterministic=deterministic)
    n_tokens = int(np.ceil(score.time_s * FPS / FRAMES_PER_TOKEN - 1e-6))
    if n_tokens > MAX_TOKENS:
        return None
    style = MOODS.get(spec.gestures[0].style)
    posture = (style.trunk_pitch_rad, style.head_pitch_rad) if style else (0.0, 0.0)
    body = perform(score, n_tokens * FRAMES_PER_TOKEN, style.stiffness if style else 0.0, posture)
    return SynthClip(body.features(), words_for(spec, rng), spec, body)


def score_of(spec: ClipSpec, rng: np.random.Generator, beat_s: float = 0.0, *, deterministic: bool = False) -> Score:
    """The score of `spec`: performed freely, as by a person, or with a beat."""
    return _on_beat(spec, rng, beat_s, deterministic) if beat_s else _freely(spec, rng)


def words_for(spec: ClipSpec, rng: np.random.Generator) -> list[str]:
    """Sentences that ask for `spec`."""
    return [caption(list(spec.gestures), spec.parallel, rng) for _ in range(N_CAPTIONS)]


def _freely(spec: ClipSpec, rng: np.random.Generator) -> Score:
    score = Score(rng, rest_pose(rng), follow_through=float(rng.uniform(0.0, 0.05)))
    if rng.random() < 0.45:
        score.hold(rng.choice([rng.uniform(0.05, 0.35), rng.uniform(0.3, 1.5)]))
    _write(score, spec)
    last = FAMILIES[spec.gestures[-1].family]
    says_how_long = spec.gestures[-1].hold_s > 0  # a pose with a named duration always ends
    if says_how_long or rng.random() < (0.55 if last.holds else 0.93):
        score.relax(rng.uniform(0.65, 0.95))
    score.hold(rng.choice([0.1, rng.uniform(0.1, 0.6), rng.uniform(0.3, 2.0)]))
    return score


def _on_beat(spec: ClipSpec, rng: np.random.Generator, beat_s: float, deterministic: bool) -> Score:
    """A score with a beat that begins at once and has randomness in its pauses alone, or none if `deterministic`."""
    score = Score(rng, rest_pose(Calm(rng)), follow_through=0.02, beat_s=beat_s)
    if deterministic:
        score.chance = score.rng
    _write(score, spec)
    last = FAMILIES[spec.gestures[-1].family]
    if deterministic or spec.gestures[-1].hold_s > 0 or not last.holds or rng.random() < 0.75:
        score.to_beat()
        score.relax(0.8)
    score.hold(beat_s if deterministic or rng.random() < 0.5 else beat_s * rng.integers(2, 11))
    return score


def _write(score: Score, spec: ClipSpec) -> None:
    start_s, ends = score.time_s, [score.time_s]
    for i, gesture in enumerate(spec.gestures):
        if i and spec.parallel:
            score.time_s = start_s + (0.0 if score.beat_s else score.rng.uniform(0.0, 0.3))
        elif i and not (score.rng.random() < 0.3 and gesture.side and gesture.side == spec.gestures[i - 1].side):
            score.to_beat()
            score.relax(score.rng.uniform(0.5, 0.75))
        FAMILIES[gesture.family].perform(score, gesture)
        ends.append(score.time_s)
    score.time_s = max(ends)


def rest_pose(rng: np.random.Generator) -> dict[str, Array]:
    """Channel values of a relaxed stance with hanging arms, varied a little at random."""

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
