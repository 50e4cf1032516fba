"""Work and everyday things: pushing, pulling, lifting, knocking, wiping, painting, stirring, typing, turning."""

from __future__ import annotations

from mmm_core.corpus.families.gesture import ANY, BOTH, ONE, Family, Gesture, Perform, Words
from mmm_core.corpus.families.strokes import (
    arms_to,
    circle,
    cycle_s,
    loops,
    pair_to,
    reach_s,
    repeat,
    strokes,
    vary,
)
from mmm_core.corpus.reach import ELBOW_DOWN, ELBOW_OUT, reach
from mmm_core.corpus.score import ArmPose, Score

_PUSH_READY, _PUSH_OUT = (
    ArmPose((0.35, -0.8, 0.1), (0.0, 0.45, 0.9), -0.5),
    ArmPose((0.15, -0.12, 1), (0.0, 0.1, 1), -0.5),
)
_PULL_FAR, _PULL_NEAR = ArmPose((0.15, -0.15, 1), (0.0, 0.05, 1)), ArmPose((0.35, -0.75, -0.35), (-0.05, 0.25, 0.95))
_KEY_UP, _KEY_DOWN = (
    ArmPose((0.3, -0.88, 0.35), (-0.15, 0.28, 0.95), -1.0),
    ArmPose((0.3, -0.88, 0.35), (-0.15, -0.06, 1.0), -1.0),
)


def taps(up: ArmPose, down: ArmPose, beat_s: float, spread: float = 0.0) -> Perform:
    """Hands held low in front, tapping in turns; `spread` moves them sideways now and then."""

    def perform(score: Score, g: Gesture) -> None:
        start = {a: vary(score, up, 0.02) for a in g.arms}
        score.move(reach_s(score, g, up), **start)
        first = int(score.rng.integers(2))
        beat = max(0.26, beat_s / g.tempo)
        for i in range(2 * g.count):
            arm = ("left", "right")[(first + i) % 2] if len(g.arms) == 2 else g.arms[0]
            if len(g.arms) == 1 and i % 2:
                continue
            aside = score.rng.normal(0, spread)
            shifted = [ArmPose(p.upper, (p.fore[0] + aside, p.fore[1], p.fore[2]), p.twist_rad) for p in (down, up)]
            score.move(0.5 * beat * (2 if len(g.arms) == 1 else 1), **{arm: shifted[0]})
            score.move(0.5 * beat * (2 if len(g.arms) == 1 else 1), **{arm: shifted[1]})

    return perform


def _lift(score: Score, g: Gesture) -> None:
    """Both hands fetch something from low and bring it up."""
    low, high = (
        ArmPose((0.2, -0.85, 0.45), (-0.08, -0.7, 0.7), 0.4),
        ArmPose((0.15, 0.3, 0.95), (-0.05, 0.55, 0.85), 0.4),
    )
    for _ in range(g.count):
        posed = vary(score, low, 0.02)
        duration = reach_s(score, g, posed)
        score.move(duration, **dict.fromkeys(g.arms, posed), trunk=(0.0, 0.3 * g.size, 0.0), head=(0.0, 0.1, 0.0))
        score.hold(score.rng.uniform(0.1, 0.3))
        up = vary(score, high, 0.03)
        score.move(
            1.4 * reach_s(score, g, up), **dict.fromkeys(g.arms, up), trunk=(0.0, -0.03, 0.0), head=(0.0, 0.0, 0.0)
        )
        score.hold(score.rng.uniform(0.2, 0.6))


def _pick(score: Score, g: Gesture) -> None:
    """Reach up, close the hand, bring it down to a basket."""
    for _ in range(g.count):
        arms_to(score, g, ArmPose((0.25, 0.72, 0.6), (0.1, 0.9, 0.4)), amount=0.06)
        score.hold(0.12)
        arms_to(score, g, ArmPose((0.3, -0.8, 0.45), (-0.1, -0.1, 0.95)), amount=0.03)
        score.hold(0.1)


def _climb(score: Score, g: Gesture) -> None:
    """One hand over the other on a rope or ladder."""
    high, low = ArmPose((0.2, 0.6, 0.75), (0.0, 0.92, 0.35)), ArmPose((0.3, -0.55, 0.75), (-0.05, 0.6, 0.8))
    half = max(0.42, 0.62 / g.tempo)
    first = int(score.rng.integers(2))
    for i in range(g.count + 1):
        up = ("left", "right")[(first + i) % 2]
        down = "left" if up == "right" else "right"
        score.move(half * (1.5 if i == 0 else 1), **{up: vary(score, high, 0.03), down: vary(score, low, 0.03)})


def _twist_forearm(pose: ArmPose, from_rad: float, to_rad: float, usual_s: float) -> Perform:
    """The forearm turns about its own length: only the 6-D channels show it."""
    there, back = ArmPose(pose.upper, pose.fore, to_rad), ArmPose(pose.upper, pose.fore, from_rad)

    def perform(score: Score, g: Gesture) -> None:
        arms_to(score, g, back, amount=0.02)
        cycle = cycle_s(score, g, usual_s)
        for _ in range(g.count):
            score.move(cycle / 2, **dict.fromkeys(g.arms, vary(score, there, 0.008)))
            score.move(cycle / 2, **dict.fromkeys(g.arms, vary(score, back, 0.008)))

    return perform


def _steer(score: Score, g: Gesture) -> None:
    """Both hands on a wheel, turned one way and the other."""

    def hold(turn: float) -> dict[str, ArmPose]:
        return {"left": reach((0.17, -0.2 - turn, 0.42)), "right": reach((0.17, -0.2 + turn, 0.42))}

    score.move(reach_s(score, g, hold(0)["left"]), **hold(0.0))
    first = 1 if score.rng.random() < 0.5 else -1
    for i in range(2 * g.count):
        score.move(max(0.4, 0.55 / g.tempo), **hold(first * (1 - 2 * (i % 2)) * 0.13 * g.size))
    score.move(0.4 / g.tempo, **hold(0.0))


def _pour(score: Score, g: Gesture) -> None:
    pose = ArmPose((0.45, -0.35, 0.8), (-0.15, 0.2, 0.95), 0.2)
    arms_to(score, g, pose, amount=0.02)
    tipped = vary(score, ArmPose((0.6, -0.2, 0.75), (-0.25, 0.0, 0.95), -1.5), 0.02)
    score.move(0.6 / g.tempo, **dict.fromkeys(g.arms, tipped))
    score.hold(score.rng.uniform(0.6, 1.3))
    score.move(0.5 / g.tempo, **dict.fromkeys(g.arms, pose))


def _saw(score: Score, g: Gesture) -> None:
    held = ArmPose((0.3, -0.85, 0.4), (-0.2, -0.25, 0.95), -0.8)
    near, far = ArmPose((0.3, -0.7, -0.65), (-0.1, -0.1, 1.0)), ArmPose((0.25, -0.75, 0.6), (-0.1, -0.3, 0.95))
    pair_to(score, g, near, held)
    repeat(score, Gesture(g.family, g.lead, g.count, tempo=g.tempo, size=g.size), far, near, 0.75)


WORK: dict[str, Family] = {
    "push": Family(strokes(_PUSH_READY, _PUSH_OUT, 1.0), Words(
        ("push {n}", "push (forward|something away|a wall|a door|the door open|a shopping cart|a pram) {n}", "shove (forward|something away) {n}", "push an invisible (box|wall) away {n}", "press against (a wall|the door) {n}", "give (a push|{N} pushes)", "slide a heavy (box|cupboard) forward {n}")), sides=ANY, counts=(1,)),
    "pull": Family(strokes(_PULL_FAR, _PULL_NEAR, 1.0), Words(
        ("pull {n}", "pull (a rope|something towards you|a door open|on the rope|a lever) {n}", "pull an invisible rope {n}", "drag something towards you {n}", "tug (at |on |)a rope {n}", "play tug of war {n}", "draw something (near|towards you) {n}", "give (a pull|{N} pulls)", "haul in a net {n}", "yank the handle {n}")), sides=ANY, counts=(1, 2)),
    "lift": Family(_lift, Words(
        ("lift (a box|something heavy|a crate|a child) (up |up from the table |from below |){n}", "pick up a (heavy |)box {n}", "raise a heavy (box|load) with both (hands|arms) {n}", "heave a (box|sack) up {n}", "pick something up( with both hands|) {n}", "load a box onto a shelf {n}", "put a box on a high shelf {n}", "lift a heavy weight from the ground {n}")), sides=BOTH, counts=(1,)),
    "pick": Family(_pick, Words(
        ("pick (an apple|apples|fruit|a cherry|cherries)( from a tree|) {n}", "take something (off|from) (a high|the top) shelf {n}", "reach up and ^grab something {n}", "harvest (apples|fruit) {n}", "fetch a book from the top shelf {n}", "pluck an apple {n}", "pick {N} apples", "get something down from above {n}", "grab something above you {n}")), sides=ONE, counts=(1, 2)),
    "climb": Family(_climb, Words(
        ("climb (a rope|a ladder|up a rope|a tree|with your arms|hand over hand) {n}", "pull yourself up hand over hand {n}", "pretend to climb( a ladder| a rope|) {n}", "move your arms as if climbing {n}", "grip the rungs one after the other {n}", "act like a climber {n}", "climb {N} rungs", "haul yourself up a rope {n}", "ring the church bells {n}", "work your way up a pole {n}")), sides=BOTH, counts=(3, 4)),
    "knock": Family(strokes(ArmPose((0.35, -0.5, 0.75), (-0.02, 0.85, 0.5)), ArmPose((0.35, -0.45, 0.8), (-0.02, 0.5, 0.85)), 0.5, 0.45), Words(
        ("knock {n}", "knock (on|at) (the door|a door|my door) {n}", "rap (on|at) the door {n}", "give (a knock|{N} knocks)", "bang on the door {n}", "knock on wood {n}", "pound on the door {n}", "ask to come in by knocking {n}", "hammer on the door with your fist {n}")), sides=ONE, counts=(2, 3)),
    "wipe": Family(strokes(reach((-0.1, 0.0, 0.5), (0.9, -0.5, 0)), reach((0.38, 0.02, 0.46), (0.9, -0.5, 0)), 1.0), Words(
        ("wipe (a window|the window|the board|a mirror|the blackboard|the glass) {n}", "clean (a window|the mirror|the board|the windscreen|the windshield) {n}", "wash (a window|the windows) {n}", "wipe (from side to side|left and right|in front of you) {n}", "polish (a mirror|the window) {n}", "rub the glass clean {n}", "erase the board {n}")), sides=ANY, counts=(2, 3)),
    "wipe_table": Family(strokes(reach((-0.12, -0.34, 0.36), ELBOW_OUT, -1.0), reach((0.38, -0.34, 0.34), ELBOW_OUT, -1.0), 1.0), Words(
        ("wipe (the|a) (table|desk|counter) {n}", "clean the (table|desk|counter|kitchen counter) {n}", "dust the (table|desk|furniture) {n}", "polish the (table|desk) {n}", "sweep the crumbs off the table {n}", "iron a shirt {n}", "brush the table clean {n}", "smooth the table cloth {n}")), sides=ONE, counts=(2, 3)),
    "paint": Family(strokes(reach((0.17, -0.25, 0.45), (0.9, -0.5, 0)), reach((0.17, 0.28, 0.45), (0.9, -0.5, 0)), 1.15), Words(
        ("paint (a wall|the wall|a fence|the fence) {n}", "paint up and down {n}", "move a (paint brush|roller) up and down {n}", "brush paint on the wall {n}", "roll paint onto the wall {n}", "whitewash the fence {n}", "make {N} brush strokes", "colour the wall {n}", "pretend to be a painter {n}", "coat a wall with paint {n}")), sides=ONE, counts=(2, 3)),
    "draw_circle": Family(loops(circle((0.15, 0.0, 0.42), 0.17, "front"), 1.35, (0.9, -0.5, 0)), Words(
        ("draw (a circle|{N} circles)( in the air|)", "draw a (big |)circle in front of you {n}", "make (a circle|circles) in the air {n}", "trace a circle {n}", "write an O in the air {n}", "wax on {n}", "paint a sun in the air {n}", "circle in front of you {n}", "draw (a|the) letter O {n}")), sides=ANY, counts=(1, 2)),
    "stir": Family(loops(circle((0.1, -0.3, 0.33), 0.085, "flat"), 0.85, ELBOW_OUT, -0.5), Words(
        ("stir (the soup|a pot|the pot|your tea|the coffee|a cauldron|the dough) {n}", "stir {n}", "mix (the dough|a salad|a cake|paint) {n}", "cook( soup|) {n}", "move a spoon round in a pot {n}", "whisk the eggs {n}", "brew a potion {n}", "turn a spoon in the pot {n}", "pretend to cook {n}")), sides=ONE, counts=(2, 3)),
    "crank": Family(loops(circle((0.12, -0.15, 0.38), 0.13, "side"), 1.0, ELBOW_OUT), Words(
        ("turn a crank {n}", "crank (the engine|a handle|a winch) {n}", "wind (a winch|a wheel|up a clock) {n}", "grind coffee {n}", "play a barrel organ {n}", "roll (down|up) the car window {n}", "reel in a fish {n}", "turn a handle round and round {n}", "operate a winch {n}"),), sides=ONE, counts=(2, 3)),
    "roll_arms": Family(loops(circle((0.03, -0.2, 0.33), 0.1, "side"), 0.75, ELBOW_OUT, offset=0.5), Words(
        ("roll your (forearms|arms|hands)( around each other| over each other|) {n}", "wind your (forearms|hands) around each other {n}", "turn your (hands|forearms) round each other {n}", "spin your (forearms|hands) around each other {n}", "call for a substitution", "tell me to hurry up by rolling your hands {n}", "make a rolling motion with both (arms|hands) {n}", "do the wheels on the bus {n}", "make a travelling sign {n}", "wind the bobbin up {n}")), sides=BOTH, counts=(3, 4)),
    "type": Family(taps(_KEY_UP, _KEY_DOWN, 0.5), Words(
        ("type( on a keyboard| a letter| an essay| an email|) {n}", "use a (keyboard|computer)", "work at (a computer|your computer)", "write an email", "hit the keys {n}", "write on a (typewriter|keyboard) {n}", "pretend to type {n}", "program (a computer|something)", "hack into a computer", "act like a typist", "tap the keys with both hands {n}", "answer your emails")), sides=BOTH, counts=(3, 4, 5)),
    "hammer": Family(strokes(ArmPose((0.4, -0.35, 0.6), (0.0, 0.98, -0.05)), ArmPose((0.3, -0.5, 0.8), (-0.05, 0.0, 1.0)), 0.75, 0.42), Words(
        ("hammer( a nail| a nail into the wall|) {n}", "hit a nail {n}", "drive in a nail {n}", "swing a hammer {n}", "pound (a nail|the anvil) {n}", "use a hammer {n}", "forge iron {n}", "bang with a hammer {n}", "knock in a nail {n}", "beat the anvil {n}")), sides=ONE, counts=(3, 4)),
    "saw": Family(_saw, Words(
        ("saw( wood| a board| a branch| a log|) {n}", "cut (wood|a board) with a saw {n}", "use a saw {n}", "pretend to saw {n}", "work with a hand saw {n}", "pull a saw back and forth {n}", "act like a carpenter {n}", "slice (bread|a loaf) {n}", "cut the (bread|cake) {n}", "make {N} saw strokes")), sides=BOTH, counts=(3, 4)),
    "sow": Family(strokes(reach((-0.12, -0.3, 0.25), ELBOW_DOWN), ArmPose((0.75, -0.5, 0.45), (0.85, 0.0, 0.5), -0.6), 1.1), Words(
        ("sow (seeds|grain) {n}", "scatter seeds {n}", "feed the (chickens|birds|ducks) {n}", "spread (seeds|salt|confetti) {n}", "throw (flowers|corn) sideways {n}", "deal (cards|the cards) {n}", "sling a frisbee {n}", "throw a frisbee {n}", "toss seeds across the field {n}", "hand out (cards|sweets) {n}")), sides=ONE, counts=(2, 3)),
    "turn_key": Family(_twist_forearm(ArmPose((0.3, -0.75, 0.55), (-0.02, 0.15, 1.0)), -1.0, 1.0, 1.0), Words(
        ("turn (a key|the key|a knob|the doorknob|a screwdriver) {n}", "unlock (the|a) door {n}", "lock the door {n}", "screw in a (screw|light bulb) {n}", "use a screwdriver {n}", "open a jar {n}", "twist a (knob|dial) {n}", "turn up the volume {n}", "open a bottle {n}")), sides=ONE, counts=(1, 2)),
    "flip_palm": Family(_twist_forearm(ArmPose((0.3, -0.75, 0.55), (0.08, 0.08, 1.0)), -1.1, 1.25, 1.1), Words(
        ("(turn|flip) your (palm|hand) (up and down|over) {n}", "rotate your (forearm|wrist) {n}", "twist your (forearm|wrist) {n}", "flip your hand {n}", "show the palm and the back of your hand {n}", "turn your palm to the ceiling and to the floor {n}"),
        both=("(turn|flip) both palms (up and down|over) {n}", "rotate both (forearms|wrists) {n}", "twist both forearms {n}", "flip both hands {n}")), sides=ANY, counts=(1, 2)),
    "pour": Family(_pour, Words(
        ("pour (water|tea|coffee|a drink|wine|a glass of water|me a drink)( from a jug|)", "fill (a|my) glass", "empty a (jug|bottle)", "tip out a bucket", "water the (plants|flowers)", "serve the (tea|wine)", "pretend to pour a drink", "hold a watering can over the flowers", "pour out the milk")), sides=ONE),
    "steer": Family(_steer, Words(
        ("steer( a car| a ship| a bus| a wheel|) {n}", "drive a car( with a steering wheel|) {n}", "turn (the|a) steering wheel {n}", "pretend to drive {n}", "hold the wheel and ^steer {n}", "act like a (driver|captain) {n}", "take the wheel {n}", "turn the wheel left and right {n}", "drive a (bus|truck|lorry) {n}")), sides=BOTH, counts=(1, 2)),
}  # fmt: skip
