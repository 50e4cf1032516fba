"""Trunk and whole stance: bowing, leaning, twisting, swaying, breathing, standing."""

from __future__ import annotations

import numpy as np

from mmm_core.corpus.families.gesture import LEFT_RIGHT, Family, Gesture, Perform
from mmm_core.corpus.families.strokes import SIGN, cycle_s, keep, turn_s
from mmm_core.corpus.score import Score


def _bow(score: Score, g: Gesture) -> None:
    for _ in range(g.count):
        score.to_beat()
        depth = np.deg2rad(38) * g.size * score.rng.uniform(0.85, 1.15)
        score.move(turn_s(score, g, 0.85), trunk=(0.0, depth, 0.0), head=(0.0, 0.3 * depth, 0.0))
        score.hold(g.hold_s or score.rng.uniform(0.15, 0.7))
        score.move(turn_s(score, g, 0.85), trunk=(0.0, 0.0, 0.0), head=(0.0, 0.0, 0.0))


def _lean(score: Score, g: Gesture) -> None:
    angle = np.deg2rad(score.rng.uniform(16, 24)) * g.size
    target = {
        "left": (0.0, 0.0, angle),
        "right": (0.0, 0.0, -angle),
        "forward": (0.0, angle, 0.0),
        "back": (0.0, -0.6 * angle, 0.0),
    }
    score.move(turn_s(score, g, 0.75), trunk=target[g.direction])
    keep(score, g, (0.5, 1.5))


def _twist(score: Score, g: Gesture) -> None:
    angle = np.deg2rad(score.rng.uniform(26, 40)) * SIGN[g.direction] * g.size
    score.move(turn_s(score, g, 0.7), trunk=(angle, 0.0, 0.0))
    keep(score, g, (0.5, 1.6))


def _side_to_side(axis: int, angle_deg: float, half_s: float) -> Perform:
    def perform(score: Score, g: Gesture) -> None:
        first = 1 if score.rng.random() < 0.5 else -1
        half = max(0.35, half_s / g.tempo)
        for i in range(2 * g.count):
            if i % 2:
                score.to_beat()
            angles = [0.0, 0.0, 0.0]
            angles[axis] = first * (1 - 2 * (i % 2)) * np.deg2rad(angle_deg) * g.size * score.rng.uniform(0.92, 1.08)
            score.move(half * (0.75 if i == 0 else 1.0), trunk=angles, head=[-0.5 * a for a in angles])
        score.move(half * 0.75, trunk=(0.0, 0.0, 0.0), head=(0.0, 0.0, 0.0))

    return perform


def _circle(score: Score, g: Gesture) -> None:
    turn = -1 if score.rng.random() < 0.5 else 1
    wide = np.deg2rad(15) * g.size
    score.move(turn_s(score, g, 0.5), trunk=(0.0, wide, 0.0))
    score.trace(
        g.count * (cycle_s(score, g, 1.7, 1.0) if score.beat_s else max(1.0, 1.7 / g.tempo)),
        trunk=lambda u: np.array([
            0.0, wide * np.cos(2 * np.pi * g.count * u), turn * wide * np.sin(2 * np.pi * g.count * u)
        ]),
    )  # fmt: skip
    score.move(turn_s(score, g, 0.5), trunk=(0.0, 0.0, 0.0))


def _breathe(score: Score, g: Gesture) -> None:
    for _ in range(g.count):
        score.to_beat()
        depth = g.size * score.rng.uniform(0.9, 1.1)
        half = max(0.7, 1.0 / g.tempo * score.rng.uniform(0.9, 1.1))
        score.move(half, trunk=(0.0, -0.12 * depth, 0.0), shrug=0.75 * depth, head=(0.0, -0.08 * depth, 0.0))
        score.move(1.15 * half, trunk=(0.0, 0.05, 0.0), shrug=-0.05, head=(0.0, 0.03, 0.0))


def _slump(score: Score, g: Gesture) -> None:
    depth = np.deg2rad(score.rng.uniform(15, 21)) * g.size
    score.move(turn_s(score, g, 1.1), trunk=(0.0, depth, 0.0), head=(0.0, 1.1 * depth, 0.0), shrug=-0.4)
    keep(score, g, (0.7, 1.8))


def _stand(score: Score, g: Gesture) -> None:
    score.hold(g.hold_s or score.pause_s(1.2, 3.0))


def _shift(score: Score, g: Gesture) -> None:
    """Small idle movements: weight from one foot to the other, a short glance."""
    side = 1 if score.rng.random() < 0.5 else -1
    for _ in range(int(score.rng.integers(2, 4))):
        roll = side * np.deg2rad(score.rng.uniform(1.5, 3.0))
        score.move(score.rng.uniform(0.7, 1.1), trunk=(0.5 * roll, 0.01, roll), head=(0.8 * roll, 0.02, -0.8 * roll))
        score.hold(score.rng.uniform(0.3, 0.8))
        side = -side


TRUNK: dict[str, Family] = {
    "bow": Family(_bow, limb="trunk", sides=(), counts=(1,)),
    "lean": Family(
        _lean, limb="trunk", sides=(), counts=(), directions=("left", "right", "forward", "back"), holds=True
    ),
    "twist": Family(_twist, limb="trunk", sides=(), counts=(), directions=LEFT_RIGHT, holds=True),
    "sway": Family(_side_to_side(2, 11, 0.62), limb="trunk", sides=(), counts=(2, 3)),
    "twist_repeat": Family(_side_to_side(0, 30, 0.6), limb="trunk", sides=(), counts=(2,)),
    "trunk_circle": Family(_circle, limb="trunk", sides=(), counts=(1, 2)),
    "breathe": Family(_breathe, limb="", sides=(), counts=(1, 2)),
    "slump": Family(_slump, limb="trunk", sides=(), holds=True),
    "stand": Family(_stand, limb="", sides=()),
    "shift": Family(_shift, limb="", sides=()),
}
