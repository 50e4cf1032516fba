"""Trunk and whole stance: bowing, leaning, twisting, swaying, breathing, standing."""

from __future__ import annotations

import numpy as np

from mmm_core.corpus.families.gesture import LEFT_RIGHT, Family, Gesture, Perform, Words
from mmm_core.corpus.families.strokes import SIGN, keep, turn_s
from mmm_core.corpus.score import Score


def _bow(score: Score, g: Gesture) -> None:
    for _ in range(g.count):
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
        g.count * max(1.0, 1.7 / g.tempo),
        trunk=lambda u: np.array([
            0.0, wide * np.cos(2 * np.pi * g.count * u), turn * wide * np.sin(2 * np.pi * g.count * u)
        ]),
    )  # fmt: skip
    score.move(turn_s(score, g, 0.5), trunk=(0.0, 0.0, 0.0))


def _breathe(score: Score, g: Gesture) -> None:
    for _ in range(g.count):
        depth = g.size * score.rng.uniform(0.9, 1.1)
        half = max(0.7, 1.0 / g.tempo * score.rng.uniform(0.9, 1.1))
        score.move(half, trunk=(0.0, -0.12 * depth, 0.0), shrug=0.75 * depth, head=(0.0, -0.08 * depth, 0.0))
        score.move(1.15 * half, trunk=(0.0, 0.05, 0.0), shrug=-0.05, head=(0.0, 0.03, 0.0))


def _slump(score: Score, g: Gesture) -> None:
    depth = np.deg2rad(score.rng.uniform(15, 21)) * g.size
    score.move(turn_s(score, g, 1.1), trunk=(0.0, depth, 0.0), head=(0.0, 1.1 * depth, 0.0), shrug=-0.4)
    keep(score, g, (0.7, 1.8))


def _stand(score: Score, g: Gesture) -> None:
    score.hold(g.hold_s or score.rng.uniform(1.2, 3.0))


def _shift(score: Score, g: Gesture) -> None:
    """Small idle movements: weight from one foot to the other, a short glance."""
    side = 1 if score.rng.random() < 0.5 else -1
    for _ in range(int(score.rng.integers(2, 4))):
        roll = side * np.deg2rad(score.rng.uniform(1.5, 3.0))
        score.move(score.rng.uniform(0.7, 1.1), trunk=(0.5 * roll, 0.01, roll), head=(0.8 * roll, 0.02, -0.8 * roll))
        score.hold(score.rng.uniform(0.3, 0.8))
        side = -side


def _lean_words(where: str) -> Words:
    return Words((
        f"lean (to the |to your |over to the |){where}", f"bend (your body |your upper body |sideways |)to the {where}", f"(tilt|tip) your (upper body|torso) (to the |){where}",
        f"lean over to your {where} side", f"lean your (body|torso) (to the |){where}", f"bend over to the {where} side",
    ))  # fmt: skip


TRUNK: dict[str, Family] = {
    "bow": Family(_bow, Words((
        "bow (politely|down|respectfully|to the audience|to me|in front of the king|) {n}", "(take|make|give) a (deep |polite |)bow", "make {N} bows",
        "bend forward in a bow {n}", "give {N} bows", "bow your upper body {n}", "greet (me |)with a bow", "thank the audience with a bow",
        "bend at the waist {n}", "greet (me |)like a Japanese host",
    )), "trunk", (), (1,)),
    "lean": Family(_lean, Words(), "trunk", (), (), ("left", "right", "forward", "back"), {
        "left": _lean_words("left"), "right": _lean_words("right"),
        "forward": Words(("lean (forward|towards me|to the front)", "bend forward a little", "lean your (body|torso|upper body) forward", "tilt your (upper body|torso) forward",
                          "bend your (back|body) forward", "come closer with your upper body", "lean in( to listen|)", "bring your chest forward")),
        "back": Words(("lean (back|backward|away from me)", "bend (backward|back)", "lean your (body|torso|upper body) (back|backward)", "tilt your upper body (back|backward)",
                       "bend your (back|body) backward", "draw your upper body back", "move your chest back", "lean away")),
    }, holds=True),
    "twist": Family(_twist, Words((
        "(turn|rotate|twist) your (upper body|torso|waist|body|shoulders) (to the |to your |){D}", "(twist|swivel) (to the |){D}",
        "turn at the waist to the {D}", "rotate your chest to the {D}",
    )), "trunk", (), (), LEFT_RIGHT, holds=True),
    "sway": Family(_side_to_side(2, 11, 0.62), Words((
        "sway (from side to side|left and right|to the music|) {n}", "(sway|rock) your (body|upper body) (from side to side|left and right) {n}", "lean left and right {n}",
        "rock (from side to side|gently) {n}", "swing your upper body from side to side {n}", "sway like a tree in the wind {n}", "move your body to the rhythm {n}",
        "lean from one side to the other {n}", "do {N} side bends",
    )), "trunk", (), (2, 3)),
    "twist_repeat": Family(_side_to_side(0, 30, 0.6), Words((
        "(twist|turn|rotate) your (upper body|torso|waist|shoulders) (from side to side|left and right) {n}", "twist (from side to side|left and right) {n}",
        "do {N} (torso|waist) twists", "swivel left and right {n}", "warm up your waist by turning left and right {n}", "swing your shoulders from side to side {n}",
    )), "trunk", (), (2,)),
    "trunk_circle": Family(_circle, Words((
        "circle your (upper body|torso|waist|trunk) {n}", "(rotate|roll) your (upper body|torso|trunk) in (a circle|circles) {n}", "make circles with your (upper body|torso|waist) {n}",
        "move your (upper body|torso) in (a circle|circles) {n}", "draw {N} circles with your (upper body|torso)", "do {N} torso circles", "swing your upper body round in a circle {n}",
        "roll your waist (around|) {n}",
    )), "trunk", (), (1, 2)),
    "breathe": Family(_breathe, Words((
        "breathe (deeply|in and out|in deeply and ^breathe out|) {n}", "take (a deep breath|deep breaths) {n}", "take {N} (deep |)breaths", "inhale and ^exhale {n}",
        "fill your lungs {n}", "breathe in and out (slowly|deeply) {n}", "do {N} breathing exercises", "sigh (deeply|) {n}", "let your chest rise and fall {n}", "draw {N} deep breaths",
        "calm down with deep breaths", "take (a long breath|some air)", "catch your breath",
    )), "", (), (1, 2)),
    "slump": Family(_slump, Words((
        "slump (down|forward|sadly|)", "slouch", "let your (head and shoulders|shoulders|head and upper body) (hang|drop|sink)", "look (sad|tired|exhausted|disappointed|defeated)",
        "act (sad|tired|exhausted|disappointed|defeated)", "sink into yourself", "be (sad|tired|exhausted)", "show that you are (sad|tired|disappointed)", "collapse forward a little", "droop",
    )), "trunk", (), holds=True),
    "stand": Family(_stand, Words((
        "stand (still|there|quietly|at ease|motionless|)", "do nothing", "stay (still|where you are|put|calm)", "wait (quietly|for me|)", "rest", "hold still", "do not move", "be idle",
        "keep (still|quiet|your arms down)", "relax and ^stand", "remain still", "freeze", "stand with your arms hanging",
    )), "", ()),
    "shift": Family(_shift, Words((
        "shift your weight( from foot to foot| from side to side|)", "(stand|wait) (impatiently|casually|restlessly|around)", "shift from one foot to the other", "fidget( a little|)",
        "move a little while standing", "act bored", "be restless", "stand around", "idle( around|)", "wait for the bus", "look bored", "loiter",
        "change your standing leg", "hang around", "kill time",
    )), "", ()),
}  # fmt: skip
