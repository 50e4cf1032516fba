"""Sport and fighting: punches, throwing, catching, swimming, running arms."""

from __future__ import annotations

import numpy as np

from mmm_core.corpus.families.gesture import ALL, ANY, BOTH, ONE, Family, Gesture, Perform, Words
from mmm_core.corpus.families.strokes import (
    arms_to,
    cycle_s,
    keep,
    loops,
    pair_to,
    reach_s,
    strokes,
    vary,
)
from mmm_core.corpus.reach import ELBOW_OUT, reach
from mmm_core.corpus.score import SIDE, ArmPose, Score, Vector

_GUARD = ArmPose((0.25, -0.75, 0.3), (-0.15, 0.75, 0.65), 0.3)
_STRIKES = {
    "punch": ArmPose((0.1, -0.05, 1.0), (-0.08, 0.05, 1.0), -0.8),
    "hook": ArmPose((0.75, 0.0, 0.7), (-0.8, 0.06, 0.6), -0.8),
    "uppercut": ArmPose((0.05, -0.3, 0.95), (-0.12, 0.97, 0.35), 1.0),
}
_WIND_UP = {
    "punch": _GUARD,
    "hook": ArmPose((0.9, -0.4, 0.0), (0.25, 0.3, 0.9), -0.3),
    "uppercut": ArmPose((0.3, -0.9, -0.2), (0.0, -0.1, 1.0), 0.6),
}


def _strike(kind: str) -> Perform:
    def perform(score: Score, g: Gesture) -> None:
        """From the guard: wind up, strike, and back; two arms take turns."""
        ready, strike = _WIND_UP[kind], _STRIKES[kind]
        both = g.side in ("both", "alternating")
        arms_to(score, g, _GUARD if both else ready, amount=0.03)
        first = int(score.rng.integers(2))
        for i in range(g.count):
            arms = (("left", "right")[(first + i) % 2],) if both else g.arms
            if both and kind != "punch":
                score.move(0.24 / g.tempo**0.5, **dict.fromkeys(arms, vary(score, ready, 0.02)))
            turn = (1 if arms[0] == "right" else -1) * 0.13 * g.size
            posed = vary(score, strike, 0.03)
            score.move(0.27 / g.tempo**0.5, **dict.fromkeys(arms, posed), trunk=(turn, 0.03, 0.0))
            back = vary(score, _GUARD if both else ready, 0.03)
            score.move(0.34 / g.tempo**0.5, **dict.fromkeys(arms, back), trunk=(0.0, 0.0, 0.0))

    return perform


def _throw(wind_up: ArmPose, release: ArmPose, after: ArmPose) -> Perform:
    def perform(score: Score, g: Gesture) -> None:
        """Wind up with the shoulder back, release, follow through."""
        side = 0.0 if g.side == "both" else 1.0 if g.lead == "right" else -1.0
        for _ in range(g.count):
            posed = vary(score, wind_up, 0.03)
            score.move(
                1.05 * reach_s(score, g, posed), SIDE, **dict.fromkeys(g.arms, posed), trunk=(-0.22 * side, -0.05, 0.0)
            )
            fast = 0.24 / g.tempo**0.5
            score.move(fast, **dict.fromkeys(g.arms, release), trunk=(0.1 * side, 0.06, 0.0))
            score.move(1.2 * fast, **dict.fromkeys(g.arms, vary(score, after, 0.03)), trunk=(0.22 * side, 0.12, 0.0))
            score.hold(score.rng.uniform(0.1, 0.4))

    return perform


def _catch(score: Score, g: Gesture) -> None:
    for _ in range(g.count):
        arms_to(score, g, ArmPose((0.15, -0.25, 0.95), (-0.1, 0.12, 1.0), 0.6), 0.36 / g.tempo**0.5, 0.03)
        arms_to(score, g, reach((0.02, -0.24, 0.24), (0.7, -0.7, 0.0), 0.6), 0.4 / g.tempo**0.5, 0.03)
        score.hold(score.rng.uniform(0.25, 0.7))


def _archery(score: Score, g: Gesture) -> None:
    """The other arm holds the bow out, the leading one draws to the cheek and lets go."""
    bow = ArmPose((0.85, 0.05, 0.5), (0.85, 0.05, 0.5), -0.6)
    yaw = -0.35 if g.lead == "right" else 0.35
    for _ in range(g.count):
        pair_to(score, g, reach((-0.3, 0.02, 0.42), ELBOW_OUT), bow)
        draw = vary(score, ArmPose((0.95, 0.1, -0.05), (-0.85, 0.15, 0.5)), 0.02)
        score.move(0.75 / g.tempo, **{g.lead: draw}, head=(-yaw, 0.0, 0.0))
        keep(score, g, (0.3, 0.9))
        loose = vary(score, ArmPose((1.0, 0.12, -0.15), (0.2, 0.75, 0.3)), 0.03)
        score.move(0.25, **{g.lead: loose})


def _golf(score: Score, g: Gesture) -> None:
    """Both hands on one club: up beside the right shoulder, down through the middle, up on the left."""

    def grip(left: float, up: float, forward: float) -> dict[str, ArmPose]:
        return {"left": reach((left, up, forward)), "right": reach((-left + 0.04, up - 0.04, forward))}

    for _ in range(g.count):
        score.move(0.85 / g.tempo, **grip(0.0, -0.45, 0.32), trunk=(0.0, 0.15, 0.0))
        score.move(0.8 / g.tempo, **grip(-0.27, 0.1, 0.25), trunk=(-0.4, 0.1, 0.0), head=(0.35, 0.15, 0.0))
        score.hold(score.rng.uniform(0.05, 0.25))
        score.move(0.28, **grip(0.0, -0.45, 0.33), trunk=(0.05, 0.15, 0.0))
        score.move(0.34, **grip(0.3, 0.15, 0.25), trunk=(0.45, 0.02, 0.0), head=(0.1, 0.0, 0.0))
        score.hold(score.rng.uniform(0.2, 0.6))


def _swing_arms(high: ArmPose, low: ArmPose, usual_s: float) -> Perform:
    def perform(score: Score, g: Gesture) -> None:
        """Arms swing against each other, as in walking and running."""
        half = cycle_s(score, g, usual_s) / 2
        first = int(score.rng.integers(2))
        for i in range(2 * g.count):
            share = g.size * score.rng.uniform(0.93, 1.07)
            pose = {
                ("left", "right")[(first + i) % 2]: vary(score, high, 0.02 * share),
                ("left", "right")[(first + i + 1) % 2]: vary(score, low, 0.02 * share),
            }
            score.move(half * (1.2 if i == 0 else 1.0), **pose)

    return perform


def _crawl(phase: float) -> Vector:
    """Over the head forward, down in front, back along the hip."""
    a = 2 * np.pi * phase
    return (0.24, 0.06 + 0.42 * float(np.cos(a)), 0.12 + 0.38 * float(np.sin(a)))


def _breast(phase: float) -> Vector:
    """Forward together, outward in an arc, back to the chest."""
    a = 2 * np.pi * phase
    out = 0.22 + 0.2 * float(np.sin(a)) if np.sin(a) > 0 else 0.22 + 0.17 * float(np.sin(a))
    return (out, -0.14, 0.3 + 0.2 * float(np.cos(a)))


SPORT: dict[str, Family] = {
    "punch": Family(_strike("punch"), Words(
        ("punch( forward| straight ahead| the air|) {n}", "jab {n}", "hit forward {n}", "throw (a punch|a jab)", "box {n}"),
        one=("punch with your {S} fist {n}", "throw a {S} punch {n}", "throw {N} punches with your {S} arm", "hit forward with your {S} fist {n}", "give {N} {S} punches", "throw {N} {S} jabs"),
        both=("punch with alternating fists {n}", "throw {N} punches with both hands", "do some boxing", "box with both fists {n}", "punch left and right {n}", "shadow box"),
        alternating=("punch with alternating fists {n}", "box left and right {n}", "throw {N} alternating punches")), sides=ALL, counts=(1, 2)),
    "hook": Family(_strike("hook"), Words(
        ("throw a hook", "throw {N} hooks", "punch from the side {n}", "swing a hook {n}", "box with a hook {n}", "hook {n}"),
        one=("throw a {S} hook {n}", "throw {N} {S} hooks", "punch in a curve with your {S} fist {n}", "land a {S} hook {n}", "hit from the side with your {S} fist {n}"),
        alternating=("throw left and right hooks {n}",)), sides=(*ONE, "alternating"), counts=(1, 2)),
    "uppercut": Family(_strike("uppercut"), Words(
        ("throw an (uppercut|upper cut)", "punch upwards {n}", "throw {N} (uppercuts|upper cuts)", "hit upwards {n}", "box upwards {n}"),
        one=("throw a {S} (uppercut|upper cut) {n}", "throw {N} {S} uppercuts", "punch upwards with your {S} fist {n}", "hit from below with your {S} fist {n}", "land a {S} uppercut {n}"),
        alternating=("throw left and right uppercuts {n}",)), sides=(*ONE, "alternating"), counts=(1, 2)),
    "throw": Family(_throw(ArmPose((0.75, 0.2, -0.35), (0.1, 0.9, -0.4)), ArmPose((0.35, 0.3, 0.85), (0.05, 0.55, 0.85)), ArmPose((0.0, -0.6, 0.8), (-0.35, -0.75, 0.6))), Words(
        ("throw (a ball|a ball overarm|something|a stone|a baseball|it away|a snowball) {n}", "pitch (a ball|a baseball) {n}", "toss (a ball|something) (away |forward |){n}", "hurl (a stone|a spear) {n}", "fling something (away|forward) {n}", "make {N} throws", "bowl a cricket ball {n}")), sides=ONE, counts=(1,)),
    "throw_low": Family(_throw(ArmPose((0.3, -0.75, -0.6), (0.15, -0.8, -0.55)), ArmPose((0.12, -0.75, 0.65), (0.05, -0.5, 0.85), 1.0), ArmPose((0.12, -0.1, 1.0), (0.05, 0.45, 0.9), 1.0)), Words(
        ("throw (a ball |something |)underarm {n}", "roll a (ball|bowling ball) {n}", "go bowling", "bowl (a strike|) {n}", "toss (a ball|it) (up from below|underhand) {n}", "pitch (underhand|underarm) {n}", "swing your arm from below to throw {n}", "play skittles", "throw a frisbee from below {n}", "play boules")), sides=ONE, counts=(1,)),
    "catch": Family(_catch, Words(
        ("catch (a ball|the ball|something|it|a beach ball) {n}", "reach out and ^catch (a ball|the ball) {n}", "play catch {n}", "receive a (pass|ball) {n}", "grab (a ball out of the air|something from the air) {n}", "make {N} catches", "save the ball like a goalkeeper", "catch what I throw {n}")), sides=ANY, counts=(1,)),
    "archery": Family(_archery, Words(
        ("shoot (an arrow|a bow|with a bow and arrow) {n}", "draw (a bow|the bow) {n}", "pull a bow string {n}", "act like (an archer|Robin Hood)", "practise archery {n}", "fire an arrow {n}", "aim (a|with a) bow {n}", "do archery", "be an archer", "shoot {N} arrows")), sides=BOTH, counts=(1,), holds=True),
    "sword": Family(strokes(ArmPose((0.5, 0.6, 0.5), (0.1, 0.85, -0.35)), ArmPose((0.05, -0.3, 0.95), (-0.25, -0.4, 0.9)), 0.8, 0.45), Words(
        ("swing (a sword|your sword) {n}", "cut with a sword {n}", "fight with a (sword|lightsaber|light sabre) {n}", "slash (down |)with a (sword|blade) {n}", "chop (wood|down|with an axe) {n}", "act like a (knight|samurai|swordsman) {n}", "swing an axe {n}", "make {N} (chops|slashes)")), sides=ANY, counts=(1, 2)),
    "karate_chop": Family(strokes(ArmPose((0.75, -0.1, 0.5), (-0.55, 0.75, 0.35), 0.3), ArmPose((0.55, -0.45, 0.7), (0.25, -0.2, 0.95), 0.0), 0.75, 0.42), Words(
        ("(do|give|make) a karate chop {n}", "chop the air {n}", "fight like a karate fighter {n}", "chop (a board|a brick|bricks) {n}", "do {N} karate chops", "hit with the edge of your hand {n}", "practise karate chops {n}", "act like a (kung fu|karate) master {n}")), sides=ONE, counts=(1, 2)),
    "swim_crawl": Family(loops(_crawl, 1.5, ELBOW_OUT, offset=0.5), Words(
        ("swim( freestyle| front crawl| the crawl| forward|) {n}", "do the (front |)crawl {n}", "pretend to swim {n}", "swim with your arms {n}", "make {N} (crawl|swimming) strokes", "move your arms like a swimmer {n}", "swim in the air {n}", "crawl through the water {n}", "do {N} freestyle strokes", "act like a swimmer {n}")), sides=BOTH, counts=(2, 3)),
    "swim_back": Family(loops(lambda p: _crawl(-p), 1.5, ELBOW_OUT, offset=0.5), Words(
        ("swim (backstroke|on your back|backwards) {n}", "do the backstroke {n}", "make {N} backstrokes", "pretend to swim on your back {n}", "move your arms like in backstroke {n}", "do {N} backstroke strokes", "swim the backstroke {n}", "turn your arms backwards one after the other {n}", "windmill your arms backwards {n}", "row yourself backwards through the water {n}")), sides=BOTH, counts=(2, 3)),
    "swim_breast": Family(loops(_breast, 1.5, ELBOW_OUT, -0.6), Words(
        ("swim (breaststroke|the breaststroke|like a frog) {n}", "do the breaststroke {n}", "make {N} (breaststrokes|breast strokes)", "part the water with both hands {n}", "move your arms like in breaststroke {n}", "swim with both arms together {n}", "push the water apart {n}", "pretend to do breaststroke {n}", "part the curtains {n}", "swim calmly on your front {n}")), sides=BOTH, counts=(2, 3)),
    "march_arms": Family(_swing_arms(ArmPose((0.15, -0.55, 0.8), (0.05, -0.3, 0.95)), ArmPose((0.18, -0.88, -0.4), (0.12, -0.9, -0.3)), 1.05), Words(
        ("march (with your arms|like a soldier|with swinging arms|on the spot with your arms) {n}", "swing your arms (as if marching|as if walking|back and forth|like a soldier) {n}", "move your arms as if (walking|marching) {n}", "march your arms {n}", "parade with your arms {n}", "do marching arms {n}", "swing both arms to and fro {n}")), sides=BOTH, counts=(3, 4)),
    "run_arms": Family(_swing_arms(ArmPose((0.15, -0.85, 0.5), (-0.25, 0.6, 0.75)), ArmPose((0.25, -0.75, -0.6), (-0.05, -0.05, 1.0)), 0.62), Words(
        ("(pump|swing|move) your arms (as if running|like a runner|like a sprinter|like a jogger) {n}", "run with your arms( only|) {n}", "do running arms {n}", "pretend to run with your arms {n}", "sprint with your arms {n}", "jog with your arms {n}", "act like a runner without moving your legs {n}", "pump your arms {n}")), sides=BOTH, counts=(3, 4)),
    "row": Family(strokes(ArmPose((0.15, -0.35, 0.95), (0.0, -0.05, 1.0), -0.6), ArmPose((0.35, -0.65, -0.4), (-0.05, 0.2, 0.95), -0.6), 1.2), Words(
        ("row( a boat| the boat| with both arms| like a rower|) {n}", "pull the oars {n}", "pretend to row a boat {n}", "make {N} rowing strokes", "paddle a (boat|rowing boat) {n}", "work on a rowing machine {n}", "row across the lake {n}", "act like a rower {n}", "do {N} rows", "exercise with the oars {n}")), sides=BOTH, counts=(2, 3)),
    "jumping_jack": Family(strokes(ArmPose((0.35, -0.93, 0.1), (0.35, -0.93, 0.15)), ArmPose((0.35, 0.93, 0.1), (0.1, 0.98, 0.1)), 1.15), Words(
        ("do (the arms of |)jumping jacks( with your arms only|) {n}", "swing your arms up and down (at|by) the sides {n}", "make {N} snow angels", "make a snow angel {n}", "do {N} jumping jacks without jumping", "raise and ^lower both arms sideways {n}", "move your arms like a snow angel {n}", "swing both arms over your head from the sides {n}", "exercise with jumping jack arms {n}")), sides=BOTH, counts=(2, 3)),
    "basketball": Family(_throw(reach((0.03, 0.2, 0.26), (0.6, -0.7, 0.3)), ArmPose((0.1, 0.65, 0.75), (0.0, 0.9, 0.4)), ArmPose((0.1, 0.6, 0.8), (0.0, 0.5, 0.85))), Words(
        ("shoot (a basket|a basketball|hoops|a free throw) {n}", "throw a basketball {n}", "take a (shot at the basket|free throw) {n}", "make a (basketball shot|jump shot) {n}", "score a basket {n}", "play basketball", "act like a basketball player {n}", "aim at the hoop and ^throw {n}", "toss a ball into the basket with both hands {n}")), sides=BOTH, counts=(1,)),
    "tennis": Family(_throw(ArmPose((0.8, -0.45, -0.4), (0.8, -0.1, -0.5)), ArmPose((0.5, -0.45, 0.75), (0.5, -0.1, 0.85)), ArmPose((-0.2, -0.2, 0.95), (-0.75, 0.45, 0.35))), Words(
        ("play tennis {n}", "swing a (racket|tennis racket|racquet) {n}", "hit a (forehand|tennis ball) {n}", "make a forehand stroke {n}", "play (a forehand|ping pong|badminton) {n}", "return the ball with a racket {n}", "act like a tennis player {n}", "hit the ball with your racket {n}", "do {N} forehands")), sides=ONE, counts=(1, 2)),
    "golf": Family(_golf, Words(
        ("swing a (golf club|baseball bat|cricket bat) {n}", "play (golf|baseball|cricket) {n}", "hit a golf ball {n}", "make a golf swing {n}", "tee off", "do {N} golf swings", "bat the ball {n}", "act like a (golfer|batter) {n}", "swing a club {n}", "drive the ball down the fairway")), sides=BOTH, counts=(1,)),
    "lift_weight": Family(strokes(ArmPose((0.25, -0.96, 0.05), (0.05, -0.8, 0.55), 1.0), ArmPose((0.25, -0.95, 0.1), (-0.02, 0.85, 0.5), 1.0), 1.15), Words(
        ("(curl|lift) (a dumbbell|a weight|dumbbells|weights) {n}", "do (biceps curls|bicep curls|curls) {n}", "curl your (arm|biceps) {n}", "do {N} (biceps |)curls", "pump iron {n}", "train your biceps {n}", "work out with a dumbbell {n}", "bend and ^straighten your elbow {n}"),
        alternating=("do alternating (biceps |)curls {n}",)), sides=ALL, counts=(2, 3)),
    "overhead_press": Family(strokes(ArmPose((0.55, -0.78, 0.25), (0.0, 0.97, 0.2), -0.6), ArmPose((0.2, 0.93, 0.2), (0.0, 1.0, 0.05), -0.6), 1.2), Words(
        ("press a (barbell|weight) (over your head|overhead) {n}", "push the (ceiling|sky) up {n}", "lift (weights|a barbell) (over your head|overhead) {n}", "do {N} (shoulder|overhead) presses", "push (up|upwards|overhead) with both hands {n}", "raise the roof {n}", "act like a weightlifter {n}", "heave the barbell up {n}", "press upwards {n}", "do shoulder presses {n}")), sides=BOTH, counts=(2, 3)),
}  # fmt: skip
