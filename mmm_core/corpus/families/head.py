"""Head: nodding, shaking, tilting, looking, rolling."""

from __future__ import annotations

import numpy as np

from mmm_core.corpus.families.gesture import LEFT_RIGHT, Family, Gesture
from mmm_core.corpus.families.strokes import SIGN, cycle_s, keep, turn_s
from mmm_core.corpus.score import Score

_HEAD_STROKE_S = 0.32
_AIM_DEG = {"left": (1, 0), "right": (-1, 0), "up": (0, -1), "down": (0, 1), "up left": (1, -1), "up right": (-1, -1), "down left": (1, 1), "down right": (-1, 1)}  # fmt: skip


def _nod(score: Score, g: Gesture) -> None:
    for _ in range(g.count):
        score.to_beat()
        depth = np.deg2rad(23) * g.size * score.rng.uniform(0.9, 1.15)
        half = max(0.25, _HEAD_STROKE_S / g.tempo)
        score.move(half, head=(0.0, depth, 0.0))
        score.move(half * score.rng.uniform(1.0, 1.15), head=(0.0, score.rng.uniform(-0.06, 0.02), 0.0))


def _shake(score: Score, g: Gesture) -> None:
    first = 1 if score.rng.random() < 0.5 else -1
    angle = np.deg2rad(30) * g.size
    half = max(0.26, _HEAD_STROKE_S / g.tempo)
    score.move(half * 0.7, head=(first * angle * score.rng.uniform(0.9, 1.1), 0.0, 0.0))
    for _ in range(g.count):
        score.to_beat()
        score.move(half, head=(-first * angle * score.rng.uniform(0.9, 1.1), 0.0, 0.0))
        score.move(half, head=(first * angle * score.rng.uniform(0.9, 1.1), 0.0, 0.0))
    score.move(half * 0.7, head=(0.0, 0.0, 0.0))


def _tilt(score: Score, g: Gesture) -> None:
    roll = np.deg2rad(score.rng.uniform(20, 30)) * SIGN[g.direction] * g.size
    score.move(turn_s(score, g), head=(score.rng.uniform(-0.04, 0.04), score.rng.uniform(-0.04, 0.06), roll))
    keep(score, g, (0.5, 1.6))


def _wobble(score: Score, g: Gesture) -> None:
    first = 1 if score.rng.random() < 0.5 else -1
    half = max(0.28, 0.36 / g.tempo)
    for i in range(2 * g.count):
        if i % 2:
            score.to_beat()
        roll = first * (1 - 2 * (i % 2)) * np.deg2rad(20) * g.size * score.rng.uniform(0.9, 1.1)
        score.move(half, head=(0.0, 0.0, roll))
    score.move(half * 0.7, head=(0.0, 0.0, 0.0))


def _look(score: Score, g: Gesture) -> None:
    side, height = _AIM_DEG[g.direction]
    yaw = side * np.deg2rad(score.rng.uniform(42, 62) if not height else score.rng.uniform(34, 46))
    pitch = height * np.deg2rad(score.rng.uniform(28, 40) if not side else score.rng.uniform(22, 30))
    pitch += 0.0 if height else score.rng.uniform(-0.08, 0.08)
    trunk = (0.15 * yaw, 0.08 * pitch, 0.0)
    score.move(turn_s(score, g, 0.55), head=(yaw, pitch, 0.0), trunk=trunk)
    keep(score, g, (0.5, 1.6))


def _look_back(score: Score, g: Gesture) -> None:
    yaw = SIGN[g.direction] * np.deg2rad(score.rng.uniform(62, 74))
    score.move(turn_s(score, g, 0.75), head=(yaw, 0.05, 0.0), trunk=(0.45 * yaw, 0.0, 0.0))
    keep(score, g, (0.5, 1.4))


def _look_around(score: Score, g: Gesture) -> None:
    first = 1 if score.rng.random() < 0.5 else -1
    for side in (first, -first):
        yaw = side * np.deg2rad(score.rng.uniform(40, 58))
        score.move(turn_s(score, g, 0.8), head=(yaw, 0.0, 0.0), trunk=(0.15 * yaw, 0.0, 0.0))
        score.hold(score.rng.uniform(0.2, 0.6))


def _roll(score: Score, g: Gesture) -> None:
    turn = -1 if score.rng.random() < 0.5 else 1
    wide = np.deg2rad(20) * g.size
    score.move(turn_s(score, g, 0.45), head=(0.0, wide, 0.0))
    duration = g.count * (cycle_s(score, g, 1.5, 0.9) if score.beat_s else max(0.9, 1.5 / g.tempo))
    score.trace(
        duration,
        head=lambda u: np.array([
            0.0, wide * np.cos(2 * np.pi * g.count * u), turn * wide * np.sin(2 * np.pi * g.count * u)
        ]),
    )  # fmt: skip


HEAD: dict[str, Family] = {
    "nod": Family(_nod, limb="head", sides=(), counts=(2,)),
    "shake_head": Family(_shake, limb="head", sides=(), counts=(1, 2)),
    "tilt_head": Family(_tilt, limb="head", sides=(), counts=(), directions=LEFT_RIGHT, holds=True),
    "wobble_head": Family(_wobble, limb="head", sides=(), counts=(2,)),
    "look": Family(_look, limb="head", sides=(), counts=(), directions=tuple(_AIM_DEG), holds=True),
    "look_back": Family(_look_back, limb="head", sides=(), counts=(), directions=LEFT_RIGHT, holds=True),
    "look_around": Family(_look_around, limb="head", sides=()),
    "roll_head": Family(_roll, limb="head", sides=(), counts=(1, 2)),
}
