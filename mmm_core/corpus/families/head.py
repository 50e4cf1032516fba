"""Head: nodding, shaking, tilting, looking, rolling."""

from __future__ import annotations

import numpy as np

from mmm_core.corpus.families.gesture import LEFT_RIGHT, Family, Gesture, Words
from mmm_core.corpus.families.strokes import SIGN, keep, turn_s
from mmm_core.corpus.score import Score

_HEAD_STROKE_S = 0.32
_AIM_DEG = {"left": (1, 0), "right": (-1, 0), "up": (0, -1), "down": (0, 1), "up left": (1, -1), "up right": (-1, -1), "down left": (1, 1), "down right": (-1, 1)}  # fmt: skip


def _nod(score: Score, g: Gesture) -> None:
    for _ in range(g.count):
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
    duration = g.count * max(0.9, 1.5 / g.tempo)
    score.trace(
        duration,
        head=lambda u: np.array([
            0.0, wide * np.cos(2 * np.pi * g.count * u), turn * wide * np.sin(2 * np.pi * g.count * u)
        ]),
    )  # fmt: skip


def _looks(where: str, place: str) -> Words:
    return Words((
        f"look (to the |to your |){where}", f"(turn|move) (your|the) head (to the |to your |){where}", f"glance (to the |){where}",
        f"face {where} with your head", f"gaze (to the |to your |){where}", f"look over to (the|your) {where}( side|)",
        f"look at (what is on|the wall on) (the|your) {where}", f"(check|watch) {place}",
    ))  # fmt: skip


def _diagonal(height: str, side: str) -> Words:
    return Words((
        f"look {height} (to the|and to the|to your) {side}", f"(glance|gaze) {height} to the {side}",
        f"turn your head {height} and to the {side}", f"look (at|to|towards) the {'upper' if height == 'up' else 'lower'} {side}( corner|)",
        f"move your head {height} to the {side}", f"look diagonally {height} (to the |){side}",
        f"face {height} and (to the |){side} with your head", f"look {side} and {height}",
    ))  # fmt: skip


HEAD: dict[str, Family] = {
    "nod": Family(_nod, Words((
        "nod (your head|yes|in agreement|approvingly|politely|) {n}", "say yes with your head", "give (a nod|me a nod|a short nod)", "give (me |){N} nods",
        "agree by nodding {n}", "move your head up and down {n}", "show that you agree with a nod", "nod your head up and down {n}",
        "make {N} nods", "answer yes with (a nod|your head)", "bob your head {n}",
    )), "head", (), (2,)),
    "shake_head": Family(_shake, Words((
        "shake (your|the) head (no|in disagreement|) {n}", "say no (by shaking|with) your head", "turn your head from side to side {n}",
        "disagree by shaking your head {n}", "(reject|decline) it by shaking your head {n}", "move your head left and right {n}", "show disagreement with your head", "give {N} head shakes",
        "refuse by shaking your head {n}", "answer no with your head", "deny it with a shake of (your|the) head", "swing your head from side to side {n}",
    )), "head", (), (1, 2)),
    "tilt_head": Family(_tilt, Words((
        "(tilt|tip|lean|bend|cock) your head (to the |to your |){D}", "drop your head towards your {D} shoulder",
        "put your {D} ear to your {D} shoulder", "lay your head on your {D} shoulder", "bring your head down to the {D} shoulder",
        "let your head fall to the {D}", "tilt the head over to the {D}( side|)",
    )), "head", (), (), LEFT_RIGHT, holds=True),
    "wobble_head": Family(_wobble, Words((
        "(wobble|rock|waggle) your head {n}", "(wobble|rock|tilt) your head from side to side {n}", "tilt your head left and right {n}",
        "bob your head from shoulder to shoulder {n}", "do an Indian head (wobble|bobble) {n}", "show that you are unsure with your head",
        "swing your ears towards your shoulders {n}", "make {N} head wobbles", "tip your head to one side and then the other {n}",
        "say (maybe|perhaps) with your head", "show that you are (undecided|in two minds) with your head", "weigh it up with your head {n}", "tip your head from side to side {n}", "swing your head like a pendulum {n}",
    )), "head", (), (2,)),
    "look": Family(_look, Words(), "head", (), (), tuple(_AIM_DEG), {
        "left": _looks("left", "the left side"), "right": _looks("right", "the right side"),
        "up": Words((
            "look (up|upwards|up high|up to heaven)", "look (up |)at (the ceiling|the sky|the stars|a bird in the sky)", "(raise|lift) (your|the) head",
            "turn your eyes up", "gaze (upwards|up|at the sky)", "lift your head and ^look up", "tilt your head back", "glance (up|upwards)", "watch the clouds",
        )),
        "down": Words((
            "look (down|downwards|to the ground)", "look (down |)at (the floor|your feet|the ground)", "(lower|drop|hang|bow) (your|the) head",
            "gaze (down|at the ground|at the floor)", "bend your head down", "glance (down|downwards)", "watch your feet", "tilt your head down",
        )),
        "up left": _diagonal("up", "left"), "up right": _diagonal("up", "right"),
        "down left": _diagonal("down", "left"), "down right": _diagonal("down", "right"),
    }, holds=True),
    "look_back": Family(_look_back, Words((
        "look (back |)over your {D} shoulder", "glance (back |)over (your|the) {D} shoulder", "look behind you (to|on|over) the {D}( side|)",
        "turn (around |)and ^look behind you on the {D}", "check (what is |)behind you over your {D} shoulder", "turn your head back over the {D} shoulder",
        "look backwards (to|on) (the|your) {D}", "see who is behind your {D} shoulder",
    )), "head", (), (), LEFT_RIGHT, holds=True),
    "look_around": Family(_look_around, Words((
        "look around", "look (left and right|right and left)", "look around (the room|you|carefully|in all directions)", "look to both sides", "scan (the room|the area)",
        "look from side to side", "search the room with your eyes", "glance (around|about)", "have a look (around|round)", "check both sides", "watch the whole room",
        "look for somebody", "see what is around you", "look (everywhere|about)",
    )), "head", ()),
    "roll_head": Family(_roll, Words((
        "roll your (head|neck) {n}", "(circle|rotate) your (head|neck) {n}", "make (a circle|circles) with your head {n}", "move your head in (a circle|circles) {n}",
        "do {N} (neck|head) rolls", "loosen your neck by rolling your head {n}", "turn your head in circles {n}", "stretch your neck in circles {n}",
        "draw {N} circles with your head", "roll your head (around|all the way round) {n}", "let your head circle on your neck {n}", "loosen up your neck {n}",
    )), "head", (), (1, 2)),
}  # fmt: skip
