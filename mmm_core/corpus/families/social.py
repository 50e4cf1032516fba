"""Between people: greeting, pointing, calling, sending away, applause, joy."""

from __future__ import annotations

from mmm_core.corpus.families.gesture import ALL, ANY, BOTH, ONE, Family, Gesture, Words
from mmm_core.corpus.families.strokes import (
    SIGN,
    arms_to,
    cycle_s,
    keep,
    pair_to,
    reach_s,
    repeat,
    still,
    strokes,
    turn_s,
    vary,
)
from mmm_core.corpus.reach import ELBOW_OUT, reach
from mmm_core.corpus.score import SIDE, ArmPose, Score, Vector

_WAVE_HIGH, _WAVE_USUAL, _WAVE_LOW = (0.55, 0.62, 0.4), (0.75, -0.15, 0.5), (0.5, -0.8, 0.35)


def _wave(score: Score, g: Gesture) -> None:
    rng, s = score.rng, g.size
    high = g.height == "high" or (not g.height and rng.random() < 0.3)
    upper: Vector = _WAVE_HIGH if high else _WAVE_LOW if g.height == "low" else _WAVE_USUAL
    middle = ArmPose(upper, (0.12, 0.95, 0.25), -0.5)
    arms_to(score, g, middle, amount=0.03)
    cycle = cycle_s(score, g, 0.62)
    first = int(rng.integers(2))
    for i in range(g.count):
        arms = (("left", "right")[(first + i) % 2],) if g.side == "alternating" else g.arms
        for swing in (0.14 + 0.58 * s, 0.14 - 0.45 * s):
            pose = vary(score, ArmPose(upper, (swing, 0.87, 0.22), -0.5), 0.03)
            score.move(cycle * 0.5 * rng.uniform(0.92, 1.08), **dict.fromkeys(arms, pose))


def _big_wave(score: Score, g: Gesture) -> None:
    """The whole straight arm swings overhead."""
    inner, outer = ArmPose((-0.12, 0.97, 0.2), (-0.2, 0.97, 0.12)), ArmPose((0.75, 0.65, 0.15), (0.78, 0.62, 0.1))
    arms_to(score, g, outer, via=SIDE)
    repeat(score, g, inner, outer, 0.95)


_POINT_AT: dict[str, Vector] = {
    "left": (1, 0.04, 0.14), "right": (-1, 0.04, 0.14), "forward": (0.02, 0.05, 1), "up": (0.05, 1, 0.1), "down": (0.1, -0.75, 0.65),
    "up left": (0.7, 0.68, 0.2), "up right": (-0.7, 0.68, 0.2), "down left": (0.72, -0.6, 0.35), "down right": (-0.72, -0.6, 0.35),
}  # fmt: skip
"""Left, up, forward; turned to outward for the acting arm."""
_POINT_SELF = ArmPose((0.35, -0.75, 0.45), (-0.75, 0.35, -0.1))
_POINT_BACK = ArmPose((0.65, -0.1, 0.55), (0.15, 0.7, -0.75))


def _pointing(direction: str, sign: float) -> ArmPose:
    """The arm along a direction; across the body the elbow stays nearer."""
    if direction in ("self", "back"):
        return _POINT_SELF if direction == "self" else _POINT_BACK
    left, up, forward = _POINT_AT[direction]
    out = sign * left
    if out < -0.3:
        return ArmPose((-0.35, 0.75 * up - 0.1, 0.9), (out, up, forward + 0.25))
    lift = 0.06 if direction == "down" else 0.0
    return ArmPose((0.9 * out + 0.12, 0.95 * up - 0.05 + lift, forward + 0.1), (out, up, forward))


def _point(score: Score, g: Gesture) -> None:
    pose = vary(score, _pointing(g.direction, SIGN[g.lead]), 0.035)
    gaze = {}
    if g.direction not in ("self", "forward", "back") and score.rng.random() < 0.5:
        yaw = (SIGN["left"] if "left" in g.direction else -1.0 if "right" in g.direction else 0.0) * score.rng.uniform(
            0.2, 0.5
        )
        pitch = (-1.0 if "up" in g.direction else 1.0 if "down" in g.direction else 0.0) * score.rng.uniform(0.1, 0.3)
        gaze = {"head": (yaw, pitch, 0.0)}
    score.move(reach_s(score, g, pose), **dict.fromkeys(g.arms, pose), **gaze)
    keep(score, g, (0.6, 1.8))


def _present(score: Score, g: Gesture) -> None:
    """An open hand sweeps from the middle outward: this way, please."""
    arms_to(score, g, ArmPose((0.2, -0.75, 0.6), (-0.35, 0.15, 0.9), 0.9))
    out = vary(score, ArmPose((0.75, -0.6, 0.25), (0.95, 0.12, 0.3), 1.2), 0.03)
    yaw = SIGN[g.lead] * score.rng.uniform(0.25, 0.5)
    score.move(turn_s(score, g, 0.7), **dict.fromkeys(g.arms, out), head=(yaw, 0.05, 0.0))
    keep(score, g)


def _clap(score: Score, g: Gesture) -> None:
    if g.direction == "up":
        together, apart = reach((0.03, 0.42, 0.2), ELBOW_OUT), reach((0.27, 0.42, 0.2), ELBOW_OUT)
    else:
        together, apart = reach((0.02, -0.18, 0.32), (0.6, -0.8, 0)), reach((0.17, -0.18, 0.34), (0.6, -0.8, 0))
    arms_to(score, g, apart, amount=0.02)
    cycle = cycle_s(score, g, 0.56)
    for _ in range(g.count):
        close = cycle * score.rng.uniform(0.42, 0.5)
        wide = g.size * score.rng.uniform(0.92, 1.08)
        away = ArmPose(apart.upper, (apart.fore[0] + 0.3 * (wide - 1), apart.fore[1], apart.fore[2]))
        score.move(close, left=together, right=together)
        score.move(cycle - close, left=away, right=away)


def _shrug(score: Score, g: Gesture) -> None:
    palms = vary(score, ArmPose((0.3, -0.85, 0.25), (0.65, 0.15, 0.7), 1.1), 0.04)
    for _ in range(g.count):
        tilt = score.rng.uniform(-0.15, 0.15)
        up = turn_s(score, g, 0.45)
        score.move(up, shrug=1.0 * g.size, left=palms, right=palms, head=(0.0, 0.0, tilt))
        score.hold(score.rng.uniform(0.2, 0.6))
        score.move(turn_s(score, g, 0.42), shrug=0.0, **({} if g.count == 1 else {"head": (0.0, 0.0, 0.0)}))


def _hug(score: Score, g: Gesture) -> None:
    wide = vary(score, ArmPose((0.85, -0.15, 0.45), (0.75, 0.1, 0.65), 0.6), 0.04)
    score.move(reach_s(score, g, wide), left=wide, right=wide)
    if g.direction != "in":
        keep(score, g)
        return
    score.hold(score.rng.uniform(0.2, 0.5))
    pair_to(score, g, reach((-0.12, -0.1, 0.34), (0.9, 0.1, 0.4)), reach((-0.1, -0.18, 0.28), (0.9, 0.0, 0.4)))
    keep(score, g, (0.4, 1.2))


def _handshake(score: Score, g: Gesture) -> None:
    low, high = ArmPose((0.2, -0.72, 0.6), (-0.05, -0.16, 1.0)), ArmPose((0.2, -0.7, 0.62), (-0.05, 0.22, 1.0))
    arms_to(score, g, low, amount=0.03)
    repeat(score, g, high, low, 0.55)


def _fist_pump(score: Score, g: Gesture) -> None:
    high = ArmPose((0.5, 0.5, 0.5), (0.05, 0.98, 0.1))
    low = ArmPose((0.45, -0.8, 0.15), (0.02, 0.9, 0.45))
    arms_to(score, g, high)
    for i in range(g.count):
        arms_to(score, g, low, 0.3 / g.tempo**0.5, 0.02)
        if i < g.count - 1:
            arms_to(score, g, high, 0.34 / g.tempo**0.5, 0.02)
    score.hold(score.rng.uniform(0.2, 0.5))


def _traffic(score: Score, g: Gesture) -> None:
    """One arm bars the way sideways, the other waves the cars through."""
    lead = g.lead
    bar = ArmPose((1, 0.05, 0.1), (1, 0.1, 0.1), -0.6)
    out, back = ArmPose((0.75, -0.25, 0.55), (0.85, 0.1, 0.5)), ArmPose((0.6, -0.3, 0.7), (-0.5, 0.72, 0.45))
    pair_to(score, g, out, bar)
    one = Gesture(g.family, lead, g.count, tempo=g.tempo, size=g.size)
    repeat(score, one, back, out, 0.85)


def _cheer(score: Score, g: Gesture) -> None:
    low, high = ArmPose((0.5, 0.45, 0.45), (0.05, 0.98, 0.05)), ArmPose((0.3, 0.92, 0.2), (0.1, 1.0, 0.05))
    score.move(reach_s(score, g, low), left=low, right=low)
    repeat(score, g, high, low, 0.62)


def _celebrate(score: Score, g: Gesture) -> None:
    """Both arms thrown up and out, shaken, chest open."""
    high = vary(score, ArmPose((0.55, 0.8, 0.15), (0.45, 0.88, 0.1)), 0.04)
    score.move(0.8 * reach_s(score, g, high), left=high, right=high, trunk=(0.0, -0.08, 0.0), head=(0.0, -0.18, 0.0))
    low = ArmPose((0.6, 0.5, 0.35), (0.35, 0.9, 0.2))
    repeat(score, Gesture(g.family, "both", int(score.rng.integers(2, 5)), tempo=g.tempo), low, high, 0.55)


def _toast(score: Score, g: Gesture) -> None:
    arms_to(score, g, ArmPose((0.3, -0.8, 0.4), (-0.1, 0.55, 0.8)))
    score.hold(score.rng.uniform(0.1, 0.4))
    arms_to(score, g, ArmPose((0.15, 0.05, 0.95), (0.03, 0.42, 0.9)))
    keep(score, g, (0.5, 1.3))


_BECKON_READY, _BECKON_IN = (
    ArmPose((0.35, -0.6, 0.65), (0.05, 0.1, 1.0), 1.2),
    ArmPose((0.35, -0.6, 0.6), (-0.15, 0.85, 0.4), 1.2),
)
_NEAR, _FAR = ArmPose((0.4, -0.6, 0.6), (-0.2, 0.5, 0.75), 0.4), ArmPose((0.35, -0.3, 0.9), (0.2, -0.1, 1.0), -0.8)


def _point_words(there: tuple[str, ...]) -> Words:
    return Words(
        tuple(f"point {t}" for t in there),
        any=tuple(f"show me (what is|the way|where it is,|something) {t}" for t in there[:1]),
        one=tuple(f"use (your|the) {{S}} (hand|arm) to point {t}" for t in there),
    )


SOCIAL: dict[str, Family] = {
    "wave": Family(_wave, Words(
        ("wave {n}", "wave (hello|goodbye|hi) {n}", "wave (at|to) (me|the camera|your friends|the crowd|everybody) {n}", "say (hello|hi|goodbye|bye)", "greet (me|the visitors|the guests|everyone)", "give (a|a friendly|me a) wave", "say goodbye to (me|everyone)", "welcome me with a wave"),
        one=("wave (your|the) {S} (hand|arm) {n}", "wave {n} with your {S} arm", "(raise|lift) your {S} hand and ^wave {n}", "give {N} waves with your {S} hand", "do a {S} hand wave {n}", "do {N} {S} hand waves"),
        any=("wave your hand {n}", "give {N} waves", "raise your hand and ^wave {n}"),
        both=("wave both (hands|arms) {n}", "wave both your arms {n}", "give {N} waves with both hands")), sides=ALL, counts=(2, 3), heights=True),
    "big_wave": Family(_big_wave, Words(
        ("wave (wildly|with a straight arm|in a big arc|from far away|like on a sinking ship|for help) {n}", "swing your (straight |)arm (above|over) your head {n}", "give a (huge|big|giant) wave {n}", "flag down a (taxi|car|ship) {n}", "call for help by waving {n}", "wave at the helicopter {n}"),
        both=("swing both arms (above|over) your head {n}", "wave for rescue {n}")), sides=ANY, counts=(2, 3)),
    "point": Family(_point, Words(), sides=ONE, directions=(*_POINT_AT, "self", "back"), directed={
        "left": _point_words(("to the left", "left", "to your left", "at the left wall", "towards the left side")),
        "right": _point_words(("to the right", "right", "to your right", "at the right wall", "towards the right side")),
        "forward": _point_words(("forward", "straight ahead", "at me", "to the front", "in front of you", "at the listener", "at the person in front of you", "at the camera")),
        "up": _point_words(("up", "upwards", "at the ceiling", "to the sky", "at the stars", "above you")),
        "down": _point_words(("down", "downwards", "at the floor", "to the ground", "at your feet", "below you")),
        "up left": _point_words(("up to the left", "up and to the left", "up left", "to the upper left", "at the top left corner")),
        "up right": _point_words(("up to the right", "up and to the right", "up right", "to the upper right", "at the top right corner")),
        "down left": _point_words(("down to the left", "down and to the left", "down left", "to the lower left", "at the bottom left corner")),
        "down right": _point_words(("down to the right", "down and to the right", "down right", "to the lower right", "at the bottom right corner")),
        "self": _point_words(("at yourself", "to yourself", "to your own chest", "at your own chest", "to your heart")),
        "back": _point_words(("behind you", "backwards", "over your shoulder", "to the back", "at the wall behind you")),
    }, holds=True),
    "present": Family(_present, Words(
        ("present (the stage|the product|the next speaker|the room)", "show me the way( in| out|)", "invite me in( with a sweep of your arm|)", "usher me in", "say after you", "show (me |)this way please", "make a sweeping gesture to the side", "introduce (your friend|the next act)", "give me the floor"),
        one=("(sweep|move) your {S} hand out to the side with an open palm", "present something on your {S} side", "show the way with your {S} (hand|arm)", "introduce the person on your {S}")), sides=ONE, holds=True),
    "beckon": Family(strokes(_BECKON_READY, _BECKON_IN, 0.7), Words(
        ("beckon {n}", "beckon me (over|to come|closer) {n}", "call me over {n}", "tell me to come (here|closer) {n}", "wave me over {n}", "invite me over", "ask me to come (here|closer|to you) {n}", "make a come here (sign|gesture) {n}", "say come here", "motion me closer {n}")), sides=ANY, counts=(2,)),
    "go_away": Family(strokes(_NEAR, _FAR, 0.75), Words(
        ("shoo me away {n}", "make a go away (gesture|sign) {n}", "tell me to (go away|leave|get lost) {n}", "send me away {n}", "wave me (away|off) {n}", "dismiss me {n}", "shoo (the fly|the cat|the dog|the birds) away {n}", "chase me off {n}", "drive away (a fly|the flies) {n}")), sides=ANY, counts=(2,)),
    "clap": Family(_clap, Words(), sides=BOTH, counts=(3, 4), directions=("", "up"), directed={
        "": Words(("clap {n}", "clap (your hands|your hands together|with both hands|for me) {n}", "give (me |){N} claps", "applaud( the speaker| politely| me|)", "give a round of applause", "hit your hands together {n}", "do {N} claps", "bring your palms together {n}", "give {N} hand claps", "put your hands together for (me|the band) {n}", "congratulate me with applause")),
        "up": Words(("clap (above|over) your head {n}", "clap overhead {n}", "clap your hands (above|over) your head {n}", "raise your arms and ^clap {n}", "clap high in the air {n}", "give {N} overhead claps", "clap up high {n}", "clap with your arms up {n}", "(clap|applaud) with (your |both )hands above you {n}")),
    }),
    "shrug": Family(_shrug, Words(
        ("shrug( your shoulders| helplessly| and ^show your palms|) {n}", "give a shrug", "(raise|lift|pull up) your shoulders {n}", "lift your shoulders as if you do not know", "show that you (do not know|have no clue|do not care)", "say I don't know( with your shoulders|)", "give {N} shrugs", "make a shrug", "say (who knows|whatever)", "show (indifference|cluelessness)", "tell me that you do not know")), sides=BOTH, counts=(1,)),
    "hug": Family(_hug, Words(), sides=BOTH, directions=("", "in"), directed={
        "": Words(("open your arms( wide|)", "welcome (me|everybody) with open arms", "spread your arms for a hug", "hold your arms open", "open both arms( to welcome everybody|)", "invite me for a hug", "ask for a hug", "stand with open arms")),
        "in": Words(("give (a|me a|someone a) (big |)hug", "hug (me|someone|a friend|a tree)", "embrace (me|a friend|someone)", "wrap your arms around (someone|me)", "take me in your arms", "cuddle (me|a teddy bear)", "squeeze me in a hug")),
    }, holds=True),
    "handshake": Family(_handshake, Words(
        ("shake hands {n}", "shake my hand {n}", "give me a handshake", "greet me with a handshake", "shake hands with (me|a friend|the president) {n}", "take my hand and ^shake it {n}", "introduce yourself with a handshake", "seal the deal with a handshake", "offer a handshake")), sides=ONE, counts=(2, 3)),
    "high_five": Family(still(ArmPose((0.4, 0.35, 0.7), (0.08, 0.8, 0.62), -0.4), (0.4, 1.2)), Words(
        ("give (me |)a high five", "high five( me|)", "slap my raised hand", "do a high five", "ask for a high five", "celebrate with a high five", "raise your palm for a high five"), one=("give me five with your {S} hand",), both=("give (me |)a high ten", "high five me with both hands")), holds=True),
    "fist_bump": Family(still(ArmPose((0.2, -0.5, 0.8), (-0.02, 0.12, 1.0), -0.9), (0.3, 1.0)), Words(
        ("give (me |)a fist bump", "fist bump me", "bump (my fist|fists with me)", "offer your fist", "greet me with a fist bump", "hold out your fist for a bump", "do a fist bump", "bro fist me", "touch my fist with yours", "pound my fist")), sides=ONE, holds=True),
    "fist_pump": Family(_fist_pump, Words(
        ("pump your fist {n}", "do (a fist pump|{N} fist pumps)", "pull your fist down (in triumph|and ^say yes) {n}", "say yes with your fist {n}", "celebrate with a fist pump", "do a yes gesture {n}", "pump a fist in triumph {n}", "draw your fist down like a winner {n}")), sides=ONE, counts=(1, 2)),
    "cheer": Family(_cheer, Words(
        ("cheer( loudly| for the team| for me|) {n}", "pump both fists in the air {n}", "cheer with both arms {n}", "give {N} cheers", "raise both arms and ^cheer {n}", "shout hooray {n}", "root for your team", "throw your arms up in joy {n}", "cheer me on {n}", "be a cheerleader", "shout with joy", "pump your arms up {n}", "(yell|shout) hurray {n}", "encourage (me|the players) {n}", "support your team with raised arms {n}")), sides=BOTH, counts=(2, 3)),
    "celebrate": Family(_celebrate, Words(
        ("celebrate( your victory| a goal| wildly| with your arms up|)", "rejoice", "jubilate", "be (overjoyed|very happy|thrilled)", "show that you are (happy|overjoyed)", "act as if you won the (lottery|race|world cup)", "go crazy with joy", "party", "express your joy", "exult", "cry hurray with your arms in the air")), sides=BOTH),
    "toast": Family(_toast, Words(
        ("raise (a|your) glass", "make a toast", "propose a toast", "say cheers", "toast (me|the happy couple|to your health)", "lift your glass to (me|the winner)", "drink to our health with a raised glass", "clink glasses with me", "hold up your glass")), sides=ONE, holds=True),
    "traffic": Family(_traffic, Words(
        ("direct (the |)traffic {n}", "act like a traffic (cop|policeman|officer) {n}", "regulate the traffic {n}", "wave the cars through {n}", "control the traffic {n}", "guide the cars {n}", "let the cars pass {n}", "play traffic police", "manage a crossing {n}", "send the cars on {n}", "stop one lane and ^wave the other through {n}", "(guide|route|direct) the (vehicles|cars) {n}", "stand in for the traffic lights {n}")), sides=BOTH, counts=(2, 3)),
    "pat_back": Family(strokes(ArmPose((0.25, -0.35, 0.9), (0.0, 0.3, 1.0), -0.8), ArmPose((0.2, -0.3, 0.95), (-0.1, -0.1, 1.0), -0.8), 0.6), Words(
        ("pat (me on the back|me on the shoulder|a friend on the back|the dog|a child on the head) {n}", "pet (the dog|a cat|the horse) {n}", "stroke the (cat|dog) {n}", "comfort me with a pat {n}", "clap me on the shoulder {n}", "give me {N} pats")), sides=ONE, counts=(2, 3)),
}  # fmt: skip
