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


def _point_words(there: tuple[str, ...], extra: Words | None = None) -> Words:
    where, extra = f"({'|'.join(there)})", extra or Words()
    return Words(
        (
            *(f"point {t}" for t in there), f"(aim|point|direct) a finger {where}", f"make a pointing (gesture|motion) {where}",
            f"~a pointing (gesture|motion|movement) {where}", f"~a finger pointing {where}", *extra.bare,
        ),
        any=(
            f"(point|aim|direct) (your finger|your index finger|the forefinger|one finger) {where}", f"use your (hand|finger|index finger) to point {where}",
            f"~your (finger|index finger|hand) (points|is pointing|should point) {where}", f"~(finger|index finger|arm|hand) pointing {where}",
            f"~(pointing|index finger pointed) {where}", *extra.any,
        ),
        one=(
            *(f"use (your|the) {{S}} (hand|arm) to point {t}" for t in there),
            f"(point|aim|direct) (your|the) {{S}} (hand|arm|finger|index finger|forefinger) {where}", f"(let|make|have) your {{S}} (hand|arm|finger) point {where}",
            f"let me see your {{S}} (hand|arm|finger) pointing {where}", f"keep your {{S}} (finger|hand) pointed {where}", f"use the {{S}} (forefinger|index finger) to point {where}",
            f"~your {{S}} (hand|arm|finger|index finger) (points|is pointing|should point) {where}", f"~the {{S}} (arm|hand|forefinger) (points|is pointed|is pointing) {where}",
            f"~{{S}} (arm|hand|finger|index finger) (pointing|pointed) {where}", f"~with (your|the) {{S}} (hand|arm|finger), point {where}", f"~{{S}} (hand|arm): point {where}", *extra.one,
        ),
    )  # fmt: skip


def _show_words(where: str) -> Words:
    return Words(any=(f"show me (what is|the way|where it is,|something) {where}",))


SOCIAL: dict[str, Family] = {
    "wave": Family(_wave, Words(
        ("wave {n}", "wave (hello|goodbye|hi) {n}", "wave (at|to) (me|the camera|your friends|the crowd|everybody) {n}", "say (hello|hi|goodbye|bye)", "greet (me|the visitors|the guests|everyone)", "give (a|a friendly|me a) wave", "say goodbye to (me|everyone)", "welcome me with a wave",
         "bid (me|us|everyone) (farewell|goodbye|good day)", "(do|perform|make) a (wave|waving motion|greeting wave|goodbye wave|hello wave)", "give (us|them|the camera|the crowd|your fans|the neighbours|Grandma|the kids) a (wave|cheery wave|friendly wave)",
         "wave (bye-bye|bye bye|ta-ta|farewell|good morning|good night|welcome|so long|howdy) {n}", "wave (like the queen|like a king|from a balcony|at the passers-by|to the fans|at the neighbours|to the people|at Grandma|in greeting|as a greeting) {n}",
         "say (cheerio|hiya|howdy|so long|farewell|ta-ta) with a wave", "~say see you later with a wave", "greet (me|us|the people|your friends) (by waving|with a wave)", "acknowledge (the crowd|your fans|the applause) with a wave", "wave (me|us|them) goodbye {n}",
         "wave back( at me| to the children| to your friend|) {n}", "(answer|return) my (greeting with a wave|wave)", "take your leave with a wave", "make a waving (gesture|movement|motion) {n}",
         "~a (friendly |cheery |polite |welcoming |goodbye |hello |)wave", "~{N} (friendly |goodbye |cheery |)waves", "~{N} waves (goodbye|hello|to the crowd|at me|at the camera)", "~a wave (hello|goodbye|to the camera|at the audience|to everybody|to me)",
         "~a waving (motion|gesture|movement) {n}", "~some (friendly |)waving", "~waving {n}"),
        one=("wave (your|the) {S} (hand|arm) {n}", "wave {n} with your {S} arm", "(raise|lift) your {S} hand and ^wave {n}", "give {N} waves with your {S} hand", "do a {S} hand wave {n}", "do {N} {S} hand waves",
             "(move|swing) your {S} hand (from side to side|to and fro|left and right) (in greeting|to say hello|to say goodbye) {n}", "use (your|the) {S} (hand|arm) to (wave|say hello|say goodbye|greet me) {n}", "let me see your {S} (hand|arm) (wave|waving) {n}",
             "(let|make|have) your {S} (hand|arm) wave {n}", "execute a (wave|waving motion) with the {S} (arm|hand) {n}", "perform {N} waves with (your|the) {S} (hand|arm)", "get your {S} hand waving", "flutter your {S} hand (at me|in greeting) {n}", "wave that {S} (hand|arm) of yours {n}",
             "~a wave (of|with) (the|your) {S} hand", "~a {S}-handed (wave|greeting wave|goodbye wave)", "~{N} waves (of|with) (the|your) {S} (hand|arm)", "~{S}( |-)hand (wave|waving) {n}",
             "~your {S} (hand|arm) (waves|is waving|should wave|should be waving) {n}", "~the {S} (hand|arm) waves (hello|goodbye|at me|to the crowd|) {n}", "~{S} (hand|arm) waving {n}", "~with (your|the) {S} (hand|arm), wave {n}", "~{S} (hand|arm): wave {n}",
             "~(hello|goodbye|bye-bye|hi) with (the|your) {S} hand", "~a (friendly |cheery |)wave with your {S} arm"),
        any=("wave your hand {n}", "give {N} waves", "raise your hand and ^wave {n}", "use (a|one) hand to wave {n}", "~let me see you wave {n}", "move your hand from side to side (in greeting|to say hello|to say goodbye) {n}",
             "~your hand (waves|is waving|should wave) {n}", "~hand waving {n}", "~a wave of (the|your|one) hand", "~{N} waves of (the|your) hand"),
        both=("wave both (hands|arms) {n}", "wave both your arms {n}", "give {N} waves with both hands", "use both (hands|arms) to wave {n}", "wave with (two|both) (hands|arms) {n}", "(let|make) both hands wave {n}", "greet (me|everyone) by waving both hands {n}",
              "~a wave with both (hands|arms)", "~a (two-handed|double) wave", "~{N} (two-handed|double) waves", "~both (hands|arms) waving {n}", "~both (your |)(hands|arms) (wave|are waving|should wave) {n}", "~with both (hands|arms), wave {n}"),
        alternating=("wave (first |)with one hand and then with the other {n}", "wave your hands (in turn|alternately|one after the other) {n}", "wave (left and right|with the left and the right hand) in turn {n}", "alternate hands and ^wave {n}", "give {N} waves with alternating hands",
                     "~{N} waves with alternating hands", "~hands waving (in turn|alternately|one after the other) {n}", "~your hands wave (in turn|alternately|one after the other) {n}", "~first one hand waves, then the other {n}")), sides=ALL, counts=(2, 3), heights=True),
    "big_wave": Family(_big_wave, Words(
        ("wave (wildly|with a straight arm|in a big arc|from far away|like on a sinking ship|for help) {n}", "swing your (straight |)arm (above|over) your head {n}", "give a (huge|big|giant) wave {n}", "flag down a (taxi|car|ship) {n}", "call for help by waving {n}", "wave at the helicopter {n}",
         "wave (madly|frantically|like crazy|like mad|like a castaway|like a shipwrecked sailor|across a football field|at a ship on the horizon|at a passing plane|to someone far away|as big as you can) {n}", "signal (for rescue|for help|to the rescue plane|to a distant ship) by waving overhead {n}",
         "attract (my|their) attention by waving overhead {n}", "make (huge|big|giant|sweeping|enormous) waves {n}", "give (me |us |)(an enormous|a massive|a great big|an exaggerated|a gigantic) wave {n}", "catch the (pilot's|taxi driver's|captain's) eye with (big|wide) waves {n}",
         "do (a full-arm|a whole-arm|an overhead|a giant) wave {n}", "wave (down a cab|down a passing car|for a taxi) {n}",
         "~a (huge|giant|massive|great big|gigantic) wave {n}", "~an (overhead|enormous|exaggerated|over-the-top) wave {n}", "~{N} (big|huge|giant|overhead|sweeping) waves", "~a (wide|wild|frantic|big) wave (above|over) your head {n}", "~waving (wildly|frantically|for help|overhead) {n}",
         "~a (castaway's|drowning man's) wave {n}", "~a wave (for help|for a rescue plane|for someone far away) {n}"),
        one=("(swing|sweep) your (straight |whole |outstretched |){S} arm (above|over) your head( from side to side| to and fro|) {n}", "wave your (whole|entire|straight) {S} arm( over your head| overhead|) {n}", "use your whole {S} arm to wave {n}",
             "move your stretched {S} arm in a big arc over your head {n}", "~your (straight |outstretched |whole |){S} arm (swings|sweeps) (from side to side |back and forth |)(above|over) your head {n}", "~{S} arm (swinging|sweeping|waving) overhead {n}",
             "~a (huge|giant|big|enormous) wave (with|of) (the|your) whole {S} arm {n}", "~with your whole {S} arm, wave (overhead|over your head) {n}", "~the whole {S} arm waves (overhead|over the head) {n}"),
        any=("wave your whole arm( over your head|) {n}", "(swing|sweep) your (outstretched|whole) arm over your head (from side to side|to and fro) {n}", "~a (big |huge |)wave with your whole arm {n}", "~your straight arm (swings|sweeps) over your head {n}"),
        both=("swing both arms (above|over) your head {n}", "wave for rescue {n}", "wave both arms (wildly|frantically|madly|for help|for rescue) {n}", "wave both your whole arms {n}", "~a (huge|giant|massive) wave with both arms {n}", "~both arms waving (wildly|frantically|for help|for rescue) {n}",
              "~your arms wave (wildly|frantically|for help) overhead {n}", "~{N} (huge|giant) waves with both arms")), sides=ANY, counts=(2, 3)),
    "point": Family(_point, Words(), sides=ONE, directions=(*_POINT_AT, "self", "back"), directed={
        "left": _point_words(("to the left", "left", "to your left", "at the left wall", "towards the left side", "at something on your left", "leftwards", "over to the left", "to the left-hand side"), _show_words("to the left")),
        "right": _point_words(("to the right", "right", "to your right", "at the right wall", "towards the right side", "at something on your right", "rightwards", "over to the right", "to the right-hand side"), _show_words("to the right")),
        "forward": _point_words(("forward", "straight ahead", "at me", "to the front", "in front of you", "at the listener", "at the person in front of you", "at the camera", "straight at me", "dead ahead", "at the audience", "in my direction", "at the horizon"), Words(
            ("point the finger at (me|the culprit)", "~an accusing finger( at me|)"), any=("pick me out with your finger", "accuse me with (a|your) finger", "show me (what is|the way|where it is,|something) straight ahead", "~your finger is (on|aimed at) me"))),
        "up": _point_words(("up", "upwards", "at the ceiling", "to the sky", "at the stars", "above you", "straight up", "skywards", "at the moon", "overhead", "to heaven"), _show_words("up there")),
        "down": _point_words(("down", "downwards", "at the floor", "to the ground", "at your feet", "below you", "straight down", "at the ground", "at something on the floor", "at the carpet", "at your shoes"), _show_words("down there")),
        "up left": _point_words(("up to the left", "up and to the left", "up left", "to the upper left", "at the top left corner", "diagonally up to the left", "at the upper left corner", "to the top left", "left and up"), _show_words("up on the left")),
        "up right": _point_words(("up to the right", "up and to the right", "up right", "to the upper right", "at the top right corner", "diagonally up to the right", "at the upper right corner", "to the top right", "right and up"), _show_words("up on the right")),
        "down left": _point_words(("down to the left", "down and to the left", "down left", "to the lower left", "at the bottom left corner", "diagonally down to the left", "at the lower left corner", "to the bottom left", "left and down"), _show_words("down on the left")),
        "down right": _point_words(("down to the right", "down and to the right", "down right", "to the lower right", "at the bottom right corner", "diagonally down to the right", "at the lower right corner", "to the bottom right", "right and down"), _show_words("down on the right")),
        "self": _point_words(("at yourself", "to yourself", "to your own chest", "at your own chest", "to your heart", "towards yourself", "at your own body", "back at yourself"), Words(
            ("jab a (finger|thumb) at yourself", "~a (finger|thumb) at yourself"), one=("point your {S} thumb at yourself", "~{S} (thumb|finger) to your own chest"), any=("point your thumb at (yourself|your chest)", "~thumb pointing at yourself"))),
        "back": _point_words(("behind you", "backwards", "over your shoulder", "to the back", "at the wall behind you", "at something behind you", "to the rear", "at the person behind you", "back over your shoulder"), Words(
            ("jerk a thumb over your shoulder", "~a thumb over the shoulder"), one=("(jerk|point) your {S} thumb (over your shoulder|behind you|backwards)", "~{S} thumb (over the shoulder|pointing behind you)"),
            any=("show me (what is|the way|where it is,|something) behind you", "(jerk|point) your thumb (over your shoulder|behind you)", "~thumb over (your|the) shoulder"))),
    }, holds=True),
    "present": Family(_present, Words(
        ("present (the stage|the product|the next speaker|the room)", "show me the way( in| out|)", "invite me in( with a sweep of your arm|)", "usher me in", "~say after you", "show (me |)this way please", "make a sweeping gesture to the side", "introduce (your friend|the next act)", "give me the floor",
         "show (me|the guests|the lady) to (a seat|the table|the door)", "usher (me|the guests|the visitors) (through|inside|to the table)", "invite me to (take a seat|go first|go ahead|go through)", "make (an ushering|an inviting|a presenting) (gesture|sweep) to the side", "gesture (me|us) (in|inside|through)",
         "say (voila|behold|come this way|right this way|be my guest)", "unveil (the painting|the prize|the new car)", "showcase (the product|the prize)", "act like a (butler|doorman|game show host|ring master) and ^show me in", "offer me (a seat|the chair)",
         "~a (sweeping|presenting|ushering|inviting|this-way) gesture( to the side|)", "~a (presentation|game show|showman's) gesture", "~an invitation to (come in|enter|go ahead)", "~ladies and gentlemen, the next act"),
        one=("(sweep|move) your {S} hand out to the side with an open palm", "present something on your {S} side", "show the way with your {S} (hand|arm)", "introduce the person on your {S}",
             "use your {S} (hand|arm) to (show me in|present the stage|usher me in|show me the way|introduce the next act)", "let your {S} (arm|hand) sweep outwards to present (it|the stage)", "open your {S} (hand|arm) (to|towards) the (stage|door|exit) like a host", "indicate the (door|stage|seat) with an open {S} hand", "unfold your {S} arm to the side (in welcome|to present something)",
             "~your {S} (hand|arm) (sweeps|opens|swings) out to the side with the palm up", "~your {S} hand (shows|shows me|indicates) the way", "~{S} (hand|arm) showing the way", "~{S} palm open, sweeping to the side", "~a (sweep|sweeping gesture) (of|with) (the|your) {S} (arm|hand) to the side", "~with (your|the) {S} (hand|arm), (show me the way|show me in|present the stage)",
             "~{S} hand: this way, please"),
        any=("~this way(, please|, sir|, madam|)", "~after you(, please|, sir|, madam|)", "~a sweep of (the|your) (open hand|arm) to the side", "~your (hand|arm) sweeps out to the side to present (it|the stage)", "~open hand showing the way")), sides=ONE, holds=True),
    "beckon": Family(strokes(_BECKON_READY, _BECKON_IN, 0.7), Words(
        ("beckon {n}", "beckon me (over|to come|closer) {n}", "call me over {n}", "tell me to come (here|closer) {n}", "wave me over {n}", "invite me over", "ask me to come (here|closer|to you) {n}", "make a come here (sign|gesture) {n}", "say come here", "motion me closer {n}",
         "(motion|signal|gesture) for me to (come|come over|come closer|approach) {n}", "bid me (come|approach|come nearer) {n}", "summon (me|the waiter|your servant|your assistant) {n}", "call (the dog|the waiter|a child|somebody|your friend) over {n}", "(lure|coax|entice|wave) me (closer|nearer) {n}", "wave (somebody|the waiter|your friend|us) (over|closer|towards you) {n}",
         "say (come closer|come to me|get over here|come on over|step closer)", "crook a finger at me {n}", "make a beckoning (motion|gesture|sign) {n}", "tell (them|the others|the dog|the child) to come (here|over|nearer) {n}", "show me that I (should|may|can) come (closer|over|to you)", "beckon (somebody|the waiter|the children|your friend) (over|closer) {n}",
         "~a beckoning (gesture|motion|movement|sign) {n}", "~a come(-| )here (gesture|sign|motion) {n}", "~a (signal|sign|gesture) to come (closer|over|nearer|here) {n}", "~an invitation to come (closer|over)", "~{N} beckoning (gestures|motions|movements)", "~beckoning {n}", "~a beckon {n}"),
        one=("curl your {S} (hand|forearm) towards (you|yourself) to (call|beckon) me {n}", "beckon me with (your|the) {S} (hand|arm|index finger) {n}", "use your {S} (hand|arm) to (call me over|beckon|wave me over|wave me closer) {n}", "draw me closer with your {S} hand {n}",
             "~your {S} (hand|arm) (beckons|calls me over|waves me closer|is beckoning|should beckon) {n}", "~{S} (hand|arm) beckoning {n}", "~a beckoning {S} hand", "~with (your|the) {S} hand, (beckon|call me over|wave me over) {n}", "~the {S} hand (waves me over|beckons me) {n}", "~{S} hand: come here"),
        any=("beckon with (a|one|your) (hand|finger) {n}", "~your hand (beckons|beckons me over|calls me closer) {n}", "~hand beckoning {n}"),
        both=("beckon with both (hands|arms) {n}", "wave me (closer|over) with both arms {n}", "guide me towards you with both hands {n}", "~both hands (beckoning|beckon|call me over|wave me closer) {n}", "~both arms wave me (over|closer) {n}", "~a two-handed come-here gesture {n}")), sides=ANY, counts=(2,)),
    "go_away": Family(strokes(_NEAR, _FAR, 0.75), Words(
        ("shoo me away {n}", "make a go away (gesture|sign) {n}", "tell me to (go away|leave|get lost) {n}", "send me away {n}", "wave me (away|off) {n}", "dismiss me {n}", "shoo (the fly|the cat|the dog|the birds) away {n}", "chase me off {n}", "drive away (a fly|the flies) {n}",
         "make a shooing (gesture|motion|movement) {n}", "(send|wave|motion|chase) (the fly|the dog|them|the pigeons|the salesman|the wasp) away {n}", "tell (the dog|him|them|the salesman) to (go away|clear off|scram|buzz off|push off|back off) {n}", "say (shoo|go away|be off|scram|clear off)",
         "dismiss (the servant|him|the idea|the waiter|my suggestion) {n}", "wave (off|aside) (the idea|the question|my objection|the flies|my worries) {n}", "banish me {n}", "give me the brush-off {n}", "get rid of (the fly|the wasp|me) by waving {n}", "scare (the pigeons|the crows|the cat) away {n}", "bid me (leave|be gone) {n}", "signal (me|them) to (leave|go|clear off) {n}",
         "~a shooing (gesture|motion|movement) {n}", "~a dismissive (wave|gesture) {n}", "~a go(-| )away (gesture|sign|wave) {n}", "~{N} (shooing|dismissive|go-away) (gestures|waves|motions)", "~shoo", "~off with you", "~a (sign|signal) to (leave|go away|clear off) {n}", "~away with (the flies|the wasps|you)", "~shooing {n}"),
        one=("flick your {S} (hand|wrist) outwards to (dismiss me|send me away) {n}", "use your {S} (hand|arm) to (shoo|wave|send|chase) me away {n}", "send me off with your {S} hand {n}", "drive the flies away with your {S} (hand|arm) {n}",
             "~your {S} (hand|arm) (shoos me away|sends me away|waves me away|chases the flies away) {n}", "~{S} hand shooing {n}", "~a shooing {S} hand", "~a dismissive (wave|flick) of (the|your) {S} hand {n}", "~with (your|the) {S} hand, (shoo me away|send me away|chase the flies off) {n}", "~{S} hand: go away"),
        any=("~shoo, (shoo|go away|be off)", "flick your hand to send me away {n}", "~a dismissive (wave|flick) of the hand {n}", "~your hand (shoos me away|waves me away|sends me off) {n}"),
        both=("chase the (geese|hens|flies) away with both (hands|arms) {n}", "drive the (geese|sheep) off with both arms {n}", "~both hands (shooing|shoo me away|wave me away|send me away) {n}", "~both arms (shoo|chase|wave) the (geese|birds) away {n}")), sides=ANY, counts=(2,)),
    "clap": Family(_clap, Words(), sides=BOTH, counts=(3, 4), directions=("", "up"), directed={
        "": Words(("clap {n}", "clap (your hands|your hands together|with both hands|for me) {n}", "give (me |){N} claps", "applaud( the speaker| politely| me|)", "give a round of applause", "hit your hands together {n}", "do {N} claps", "bring your palms together {n}", "give {N} hand claps", "put your hands together for (me|the band) {n}", "congratulate me with applause",
                   "(slap|beat|bang|strike) your (hands|palms) together {n}", "clap (for the winner|for the band|in time|along to the music|to the beat|along|like at the theatre|like an audience|like a seal|hands|in appreciation|with delight) {n}", "make a clapping (noise|sound|motion|movement) {n}", "show your (appreciation|approval) by clapping {n}",
                   "give (me|them|the winner|the band|the artists) (a hand|a big hand|a round of applause|an ovation|some applause)", "let (us|me) hear (some|your) applause", "~let me hear you clap {n}", "strike one hand against the other {n}", "perform {N} (hand |)claps", "reward (me|the singer|the actors) with applause",
                   "thank the (artists|band|players) by clapping {n}", "do some (hand |)clapping", "bring the hands together (sharply|with a bang) {n}", "applaud (the band|the actors|the winner|the show|our guests)", "play pat-a-cake", "acclaim the (winner|singer) by clapping",
                   "~{N} claps( of the hands| of your hands| for me| for the band|)", "~{N} (hand|polite|loud) claps", "~a (round of applause|burst of applause|standing ovation|big hand for the band)", "~applause( for the band|, please| for me| for everybody| for the winner|)", "~some (clapping|applause|handclaps)", "~hands clapping( together|) {n}",
                   "~your (hands|palms) (clap|are clapping|come together in a clap|strike each other|slap together|should clap) {n}", "~both hands (clap|clapping|clap together) {n}", "~clapping {n}", "~the hands (clap|are clapped|hit each other|beat together) {n}", "~with both hands, clap {n}")),
        "up": Words(("clap (above|over) your head {n}", "clap overhead {n}", "clap your hands (above|over) your head {n}", "raise your arms and ^clap {n}", "clap high in the air {n}", "give {N} overhead claps", "clap up high {n}", "clap with your arms up {n}", "(clap|applaud) with (your |both )hands above you {n}",
                     "(slap|strike|beat|bang) your (palms|hands) together (above|over) your head {n}", "clap like (a football fan|a festival crowd) with your arms (up|raised) {n}", "(stretch|put|get) your arms up and ^clap {n}", "lift both hands over your head and ^clap {n}", "reach up and ^clap {n}",
                     "bring your hands together in a clap over your head {n}", "perform {N} claps overhead", "clap (above|over) the head {n}", "applaud (overhead|above your head|over your head) {n}", "~let me see you clap (overhead|over your head) {n}", "clap with (raised|lifted) (arms|hands) {n}",
                     "~{N} (overhead claps|claps overhead|claps above your head|claps over the head|claps up high|claps with raised arms)", "~overhead (clapping|applause) {n}", "~hands clapping (overhead|above the head|over your head|up high) {n}", "~your hands clap (above|over) your head {n}", "~applause (above|over) your head",
                     "~clapping with (your arms up|raised arms|your hands above your head) {n}", "~arms up and clapping {n}", "~both hands (clap|meet in a clap|are clapping) (above|over) (your|the) head {n}", "~hands over your head, clapping {n}")),
    }),
    "shrug": Family(_shrug, Words(
        ("shrug( your shoulders| helplessly| and ^show your palms|) {n}", "give a shrug", "(raise|lift|pull up) your shoulders {n}", "lift your shoulders as if you do not know", "show that you (do not know|have no clue|do not care)", "say I don't know( with your shoulders|)", "give {N} shrugs", "make a shrug", "say (who knows|whatever)", "show (indifference|cluelessness)", "tell me that you do not know",
         "(hunch|hike up|hitch up|scrunch up|bring up|draw up) (your|both) shoulders {n}", "move your shoulders up and down {n}", "(pull|bring|draw|lift) (your|both) shoulders up to your ears {n}", "shrug it off {n}", "(answer|reply) with a shrug( of the shoulders|)", "say (search me|beats me|no idea|I have no idea|dunno|how should I know|I could not care less|so what|don't ask me)",
         "turn your palms up and ^shrug {n}", "spread your hands and ^shrug {n}", "act (clueless|indifferent|ignorant|as if you have no idea|as if you do not care)", "plead ignorance", "signal (ignorance|that you have no idea|that you could not care less)", "do the I don't know gesture", "perform (a shoulder shrug|a shrug) {n}", "do {N} (shoulder |)shrugs", "shrug like (a Frenchman|you do not care) {n}",
         "~a (helpless |clueless |shoulder |Gallic |)shrug {n}", "~a shrug of (the|your) shoulders {n}", "~{N} (big |shoulder |clear |)shrugs", "~{N} shrugs of (the|your) shoulders", "~your shoulders (go up|rise|lift|come up|go up and down|should go up|go up to your ears) {n}", "~both shoulders (go up|up|raised|lifted|up and down) {n}", "~shoulders (up|raised|up to the ears|up and down|hunched in a shrug) {n}",
         "~the shoulders (rise|are raised|come up|go up and down) {n}", "~an I don't know gesture {n}", "~a gesture (of cluelessness|of not knowing|that says I don't know)", "~palms up and shoulders raised")), sides=BOTH, counts=(1,)),
    "hug": Family(_hug, Words(), sides=BOTH, directions=("", "in"), directed={
        "": Words(("open your arms( wide|)", "welcome (me|everybody) with open arms", "spread your arms for a hug", "hold your arms open", "open both arms( to welcome everybody|)", "invite me for a hug", "ask for a hug", "stand with open arms",
                   "(fling|throw) your arms open( in welcome| to welcome me| for me|)", "offer (me |us |)a hug", "get ready (for a hug|to give me a hug)", "open your arms (to me|to embrace me|for a cuddle|for a hug|like a loving mother|to greet me)", "hold your arms (out|wide|apart|ready) for a hug", "invite me into your (arms|embrace)", "receive (me|us|the guests) with open arms",
                   "beg for a hug", "say (give me a hug|come and hug me|come to my arms)", "wait for a hug with open arms", "greet (me|the world|the guests) with open arms", "extend your arms (for a hug|in welcome)", "make a hug-me gesture",
                   "~arms (open|wide open|opened|out|ready) for a (hug|cuddle)", "~(open arms|arms wide open|arms open in welcome)", "~both arms (open|opened wide) (in welcome|to welcome me|for an embrace)", "~your arms (open|are open|open wide|should be open) (for a hug|to welcome me|in welcome)", "~an invitation to (hug|a hug|cuddle)",
                   "~a (welcome|greeting) with open arms", "~an open-armed (welcome|greeting)", "~the arms open (in welcome|for a hug)", "~a hug invitation")),
        "in": Words(("give (a|me a|someone a) (big |)hug", "hug (me|someone|a friend|a tree)", "embrace (me|a friend|someone)", "wrap your arms around (someone|me)", "take me in your arms", "cuddle (me|a teddy bear)", "squeeze me in a hug",
                     "(fold|gather|hold|enfold|clasp) me in your arms", "hold me (tight|close)( in your arms|)", "press (me|your friend) to your (chest|heart)", "give (me|us|your friend|Grandma|the children) (a cuddle|a squeeze|a bear hug|a warm hug|an embrace|a hug)", "hug (an invisible person|the air|your best friend|Mum|a big teddy bear|a tree trunk|me tightly)",
                     "pretend to hug (someone|me|a tree)", "show me how you hug (someone|a friend)", "(close|put|throw) your arms around (me|a friend|somebody)", "comfort (me|a friend) with a hug", "embrace (the air|your grandmother|an old friend|me warmly)", "pull me into (a hug|your arms|an embrace)",
                     "~a (big |warm |bear |close |tight |loving |)hug( for me| for a friend|)", "~an embrace( for a friend| for me|)", "~a (warm|close|loving|tight) embrace", "~a cuddle( for me| for a teddy bear|)", "~your arms (wrap|close|fold|go) around (me|someone|a friend)", "~both arms (around|wrapped around|closed around) (me|someone|a friend)",
                     "~arms around (me|someone|a friend|a tree)", "~hugging (someone|a friend|me|a tree)", "~the arms close (around somebody|in a hug)")),
    }, holds=True),
    "handshake": Family(_handshake, Words(
        ("shake hands {n}", "shake my hand {n}", "give me a handshake", "greet me with a handshake", "shake hands with (me|a friend|the president) {n}", "take my hand and ^shake it {n}", "introduce yourself with a handshake", "seal the deal with a handshake", "offer a handshake",
         "(give|offer) me a (firm |friendly |hearty |)handshake", "greet (me|the guest|the ambassador|your new boss) by shaking hands {n}", "shake (my hand|hands) (firmly|heartily|warmly|like a businessman|like a politician|on the deal|in greeting) {n}", "congratulate me (with a handshake|by shaking my hand)", "welcome (me|the visitor) with a handshake", "shake on it {n}",
         "~say (how do you do|pleased to meet you|nice to meet you) with a handshake", "pump my hand up and down {n}", "(grasp|grip|seize|clasp) my hand and ^shake it {n}", "make peace with a handshake", "press the flesh", "introduce yourself by shaking hands {n}", "close the deal with a handshake", "do a handshake( with me|)",
         "~a (firm |friendly |warm |hearty |polite |)handshake", "~a shake of (hands|my hand) {n}", "~{N} shakes of (my|the) hand", "~a handshake (with me|to seal the deal|in greeting|for the visitor|among friends)", "~shaking hands( with me| with a friend|) {n}", "~an old-fashioned handshake"),
        one=("(hold|put|stick) out your {S} hand (for a handshake|to shake mine|to be shaken)", "(extend|offer) your {S} hand for a (handshake|shake)", "shake my hand with (your|the) {S} (hand|one) {n}", "use your {S} hand to shake mine {n}", "give me your {S} hand to shake",
             "~your {S} hand (shakes mine|shakes my hand|is shaking my hand|should shake mine) {n}", "~{S} hand (out for a handshake|extended to shake hands|shaking mine)", "~a {S}-handed handshake", "~a handshake with (your|the) {S} hand", "~with (your|the) {S} hand, shake (mine|my hand) {n}", "~the {S} hand shakes (mine|a visitor's hand) {n}", "~{S} hand: handshake"),
        any=("(hold|put|stick) out your hand (for a handshake|to shake mine|to be shaken)", "extend your hand for a (handshake|shake)", "~your hand (shakes mine|is shaking mine) {n}", "~hand out for a handshake")), sides=ONE, counts=(2, 3)),
    "high_five": Family(still(ArmPose((0.4, 0.35, 0.7), (0.08, 0.8, 0.62), -0.4), (0.4, 1.2)), Words(
        ("give (me |)a high five", "high-five me", "~high five( me|)", "slap my raised hand", "do a high five", "ask for a high five", "celebrate with a high five", "raise your palm for a high five",
         "(give|offer|slap) me (a high-five|five|a high five)", "high-five (me|a friend|your teammate|the team)", "go for a high five", "get ready for a high five", "do the high-five gesture", "(congratulate|greet) (me|your friend|your teammate) with a high five", "share a high five (with me|with a friend)", "meet my palm in a high five", "reward me with a high five",
         "~a (friendly |celebratory |winner's |)high( |-)five( for me| with a friend|)", "~gimme five", "~a give-me-five (pose|gesture)", "~an air five"),
        one=("give me five with your {S} hand", "(raise|hold up|put up) your {S} (hand|palm) for (a high five|me to slap)", "hold out your {S} palm for me to slap", "let me slap your {S} (palm|hand)", "offer your {S} palm for a high five", "use your {S} hand for a high five", "high-five me with (your|the) {S} (hand|palm)", "~high five me with (your|the) {S} (hand|palm)",
             "~{S} (hand|palm) up for a high five", "~your {S} (hand|palm) (is up|goes up|is raised|should be up|comes up) for a high five", "~a {S}-handed high five", "~a high five (from|with) (the|your) {S} (hand|palm)", "~with (your|the) {S} hand, (high five me|give me five|give me a high five)", "~the {S} palm is up for me to slap", "~{S} hand: high five"),
        any=("(hold|put) up your palm for (me to slap|a high five)", "let me slap your palm", "raise a hand for a high five", "~your (hand|palm) (goes up|is up|is ready) for a high five", "~(hand|palm) up for a high five", "~high( |-)five(, mate|, buddy|)"),
        both=("give (me |)a high ten", "high-five me with both hands", "~high five me with (both|two) hands", "hold (up|out) both palms for me to slap", "do a (double high five|high ten)", "let me slap both your palms", "~a (high ten|double high five|two-handed high five)", "~both (hands|palms) up for a high (five|ten)", "~your (hands|palms) (are|go) up for a high ten", "~high ten")), holds=True),
    "fist_bump": Family(still(ArmPose((0.2, -0.5, 0.8), (-0.02, 0.12, 1.0), -0.9), (0.3, 1.0)), Words(
        ("give (me |)a fist bump", "~fist bump me", "bump (my fist|fists with me)", "offer your fist", "greet me with a fist bump", "hold out your fist for a bump", "do a fist bump", "~bro fist me", "touch my fist with yours", "pound my fist",
         "bump (knuckles|fists) with (me|a friend|your mate)", "knock (fists|knuckles) with me", "(perform|share|make) a fist bump( with me|)", "give me (some knuckles|some dap|a knuckle bump|a fist-bump|a friendly fist bump)", "greet (a friend|your mate|your bro|your teammate) with a fist bump", "meet my fist with yours", "tap fists with (me|a friend)",
         "offer (me |us |)a fist bump", "celebrate with a fist bump", "fist-bump (me|a friend|your bro|your teammate)", "congratulate me with a fist bump", "go for a fist bump",
         "~a (friendly |cool |)fist( |-)bump( for me| with a friend|)", "~a (knuckle|bro) bump", "~a bump of (the |)fists", "~some (knuckles|dap) for me", "~fist bumping"),
        one=("(hold|put|stick) out your {S} fist (for a bump|to bump mine|for me to bump)", "extend your {S} fist (for a bump|to bump mine)", "bump my fist with your {S} (fist|one)", "offer (me |)your {S} fist for a bump", "touch my fist with your {S} fist", "make a fist with your {S} hand and ^bump mine", "fist-bump me with (your|the) {S} (hand|fist)", "~fist bump me with (your|the) {S} (hand|fist)",
             "~your {S} fist (is out for a bump|comes forward for a bump|bumps mine|meets mine|touches mine|should bump mine)", "~{S} fist (out|forward|extended) for a (bump|fist bump)", "~a {S}-handed fist bump", "~a fist bump with (your|the) {S} (hand|fist|arm)", "~with (your|the) {S} hand, (give me a fist bump|bump my fist)", "~the {S} fist (bumps|meets|touches) mine", "~{S} hand: fist bump"),
        any=("stick your fist out for a bump", "~your fist (bumps|meets|touches) mine", "~fist (out|forward|ready) for a bump", "~fist( |-)bump(, mate|, bro|)")), sides=ONE, holds=True),
    "fist_pump": Family(_fist_pump, Words(
        ("pump your fist {n}", "do (a fist pump|{N} fist pumps)", "pull your fist down (in triumph|and ^say yes) {n}", "say yes with your fist {n}", "celebrate with a fist pump", "do a yes gesture {n}", "pump a fist in triumph {n}", "draw your fist down like a winner {n}",
         "do a (triumphant|victorious|winner's) fist pump {n}", "celebrate (a goal|a point|your win) with a fist pump", "say (yes|get in|come on|got it) with a fist pump {n}", "shout yes and ^pump your fist {n}", "make a fist and ^pull it down in triumph {n}", "do the (tennis champion's|winner's) fist {n}", "fist-pump( like a winner| in triumph|) {n}", "~fist pump( like a winner| in triumph|) {n}",
         "mark the point with a fist pump", "perform (a fist pump|{N} fist pumps)", "give (a fist pump|{N} fist pumps)",
         "~a (triumphant |victorious |winner's |)fist( |-)pump {n}", "~{N} (triumphant |winning |)fist( |-)pumps", "~a pump of the fist {n}", "~a triumphant yes with the fist {n}", "~fist pumping {n}", "~a yes! fist", "~a fist (pumped|pulled down) in triumph {n}"),
        one=("pump your {S} fist( in triumph| in celebration| like a winner| to say yes|) {n}", "pump the air with your {S} fist {n}", "(pull|jerk|yank|draw|bring) your {S} fist down (in triumph|to celebrate|as if to say yes|like a winner) {n}", "celebrate with your {S} fist {n}", "say yes with your {S} fist {n}", "do a fist pump with (your|the) {S} (hand|arm) {n}",
             "~your {S} fist (pumps|comes down in triumph|is pulled down in triumph|jerks down in triumph|should pump) {n}", "~{S} fist pumping {n}", "~{S}( |-)hand fist pump {n}", "~a fist pump with (your|the) {S} (arm|hand) {n}", "~{N} fist pumps with (your|the) {S} (hand|arm)", "~a pump of (the|your) {S} fist {n}",
             "~with (your|the) {S} hand, (pump your fist|do a fist pump) {n}", "~the {S} fist (pumps|is pumped) {n}", "~{S} hand: fist pump {n}"),
        any=("(jerk|yank|bring) your fist down (in triumph|as if to say yes) {n}", "~your fist (pumps|comes down in triumph) {n}", "~fist pulled down in triumph {n}")), sides=ONE, counts=(1, 2)),
    "cheer": Family(_cheer, Words(
        ("cheer( loudly| for the team| for me|) {n}", "pump both fists in the air {n}", "cheer with both arms {n}", "give {N} cheers", "raise both arms and ^cheer {n}", "shout hooray {n}", "root for your team", "throw your arms up in joy {n}", "cheer me on {n}", "be a cheerleader", "shout with joy", "pump your arms up {n}", "(yell|shout) hurray {n}", "encourage (me|the players) {n}", "support your team with raised arms {n}",
         "shout (hip hip hooray|hurrah|go team|come on, lads) {n}", "root for (the home team|me|us|the runners)", "cheer (like a football fan|like a supporter|at the match|the runners on|for the winner|us on) {n}", "(urge|spur) (me|the team|the players|the runners) on {n}", "give (a|a loud) cheer {n}", "(raise|let out) a cheer {n}", "cry (hooray|hurrah|yippee) {n}",
         "pump (both|your) (fists|arms) (above your head|skywards|towards the sky) {n}", "act like a (cheerleader|football fan|supporter) {n}", "do a (cheer|hooray|cheerleading move) {n}", "whoop and ^pump both fists in the air {n}", "be a (football fan|loud supporter)", "say (hooray|hurrah|hip hip hooray) {n}",
         "~{N} (loud |big |)cheers for (me|the team|the winner|us)", "~a (loud |big |)cheer( for the team| for me| for the winner|) {n}", "~hip hip hooray {n}", "~both fists (pumping|pump) (in the air|above your head|over your head|up high) {n}", "~fists pumping in the air {n}", "~your (fists|arms) (pump|are pumping) (in the air|over your head) {n}",
         "~hooray( for the team| for me| for the winner|) {n}", "~some cheering( for the team| for me|)", "~(loud |)cheering {n}", "~raised fists, cheering {n}", "~with both fists up, cheer {n}")), sides=BOTH, counts=(2, 3)),
    "celebrate": Family(_celebrate, Words(
        ("celebrate( your victory| a goal| wildly| with your arms up|)", "rejoice", "jubilate", "be (overjoyed|very happy|thrilled)", "show that you are (happy|overjoyed)", "act as if you won the (lottery|race|world cup)", "go crazy with joy", "party", "express your joy", "exult", "cry hurray with your arms in the air",
         "be (over the moon|on cloud nine|ecstatic|jubilant|delighted|beside yourself with joy)", "show (your|great|wild) joy", "make merry", "whoop it up", "celebrate (like you won the lottery|like a champion|your birthday|the New Year|our win|the winning goal|the good news)", "go (wild|nuts|bananas|mad) with (joy|happiness)", "act (overjoyed|ecstatic|as if you just won|like the happiest person on earth)",
         "express (great happiness|delight|your happiness)", "let your joy out", "react (as if you scored the winning goal|to wonderful news|as if you won the lottery)", "jump for joy without leaving the ground", "burst with (joy|happiness)", "do a (goal|winner's|joyful) celebration", "show me how you celebrate( a goal| your birthday|)",
         "~a (joyful |wild |happy |victory |goal |big |)celebration", "~an (outburst|explosion|expression) of joy", "~a (show|burst) of (joy|happiness|delight)", "~a celebration of (the goal|your win|a great success|the New Year)", "~celebrating( a goal| the win| your birthday|)", "~arms (thrown|flung) up in celebration", "~your arms fly up in celebration",
         "~(great|wild|sheer|pure) (joy|happiness|jubilation)", "~both arms (go|fly) up in (celebration|jubilation)")), sides=BOTH),
    "toast": Family(_toast, Words(
        ("raise (a|your) glass", "make a toast", "propose a toast", "say cheers", "toast (me|the happy couple|to your health)", "lift your glass to (me|the winner)", "drink to our health with a raised glass", "clink glasses with me", "hold up your glass",
         "raise (a toast|your cup|your champagne|your beer|a mug|a glass of wine|your tankard)( to me| to the bride| to our success|)", "(give|offer) a toast( to the host| to the bride| to me|)", "say (bottoms up|good health|here's to us|here's to the bride|chin chin)", "lift (a|your) (glass|cup|mug) in (a toast|honour of the winner)", "toast (the bride|the New Year|our friendship|the champion|us|the host)",
         "touch glasses with (me|the guests)", "hold (a|your) (glass|drink) (high|up|out) for a toast", "honour the (couple|host|winner) with a toast", "drink a toast( to the bride| to us| to absent friends|)", "extend your glass for a toast", "charge your glass and ^raise it",
         "~a toast( to you| to the bride| to the New Year| to friendship| to us| to your health|)", "~glass (raised|up|held up|lifted)( for a toast|)", "~a raised glass( to the bride| to us|)", "~here's to (you|us|the bride|the happy couple|your health)", "~your glass (goes up|is raised|should be raised|is lifted) (in|for) a toast", "~glasses up", "~an imaginary glass raised for a toast"),
        one=("raise (a|your|the) glass with your {S} (hand|arm)", "lift the glass in your {S} hand (to toast me|for a toast)", "hold a glass (up|out) in your {S} hand for a toast", "use your {S} hand to raise a glass", "toast me with the glass in your {S} hand",
             "~glass in your {S} hand, raised for a toast", "~a toast with (your|the) {S} (hand|arm)", "~your {S} (hand|arm) (raises|lifts|holds up) a glass", "~{S} hand (lifting|raising) a glass", "~with (your|the) {S} hand, (raise a glass|make a toast)", "~the {S} (hand|arm) raises a glass to (me|the couple)", "~{S} hand: glass up for a toast")), sides=ONE, holds=True),
    "traffic": Family(_traffic, Words(
        ("direct (the |)traffic {n}", "act like a traffic (cop|policeman|officer) {n}", "regulate the traffic {n}", "wave the cars through {n}", "control the traffic {n}", "guide the cars {n}", "let the cars pass {n}", "play traffic police", "manage a crossing {n}", "send the cars on {n}", "stop one lane and ^wave the other through {n}", "(guide|route|direct) the (vehicles|cars) {n}", "stand in for the traffic lights {n}",
         "play (traffic cop|the traffic policeman|the traffic warden)", "do the job of a traffic (light|officer|policeman|warden) {n}", "do point duty {n}", "wave (the traffic|the vehicles|the lorries|the trucks) (through|on|past|along) {n}", "keep the (traffic|cars) (moving|flowing) {n}", "(bar|block|hold back) one lane and ^wave the other (on|along) {n}", "show the (cars|drivers) where to go {n}",
         "marshal the (cars|traffic) {n}", "police the (crossroads|junction|intersection) {n}", "usher the cars through the (junction|crossing) {n}", "stand at the (crossroads|junction) and ^direct (the |)traffic {n}", "sort out the traffic (jam|chaos) {n}", "be a traffic (cop|policeman|officer) {n}",
         "~traffic (control|policing|duty|direction) {n}", "~a traffic (cop's|policeman's|officer's) (signals|gestures) {n}", "~traffic cop (signals|gestures|moves) {n}", "~{N} traffic signals", "~hand signals for the (cars|drivers|traffic) {n}", "~the cars are waved through {n}", "~the traffic is (directed|waved through|regulated) {n}",
         "~a policeman directing traffic {n}", "~directing (the |)(traffic|cars) {n}", "~your arms direct the (traffic|cars) {n}")), sides=BOTH, counts=(2, 3)),
    "pat_back": Family(strokes(ArmPose((0.25, -0.35, 0.9), (0.0, 0.3, 1.0), -0.8), ArmPose((0.2, -0.3, 0.95), (-0.1, -0.1, 1.0), -0.8), 0.6), Words(
        ("pat (me on the back|me on the shoulder|a friend on the back|the dog|a child on the head) {n}", "pet (the dog|a cat|the horse) {n}", "stroke the (cat|dog) {n}", "comfort me with a pat {n}", "clap me on the shoulder {n}", "give me {N} pats",
         "give (me|your friend|a colleague) (a pat|{N} pats) on the (back|shoulder)", "pat (my|your friend's|a colleague's|somebody's) (back|shoulder) {n}", "(congratulate|praise|encourage|console) me with a pat on the (back|shoulder) {n}", "pet (an animal|the puppy|a kitten|the rabbit) {n}", "pat (the pony|the puppy|a big dog|the horse's neck|a cow) {n}", "tap me on the shoulder {n}",
         "stroke the (puppy|rabbit|horse|kitten) {n}", "say (well done|good boy|good dog|there, there) with a pat {n}", "reassure (me|a friend|the child) with a pat {n}", "comfort a friend by patting them on the back {n}", "slap me on the back {n}", "give the (dog|horse|pony) (a pat|{N} pats)",
         "~a pat on (my|the|a friend's) (back|shoulder) {n}", "~a friendly pat (on the back|on the shoulder|for the dog) {n}", "~{N} (friendly |gentle |)pats (on the back|on my shoulder|for the dog|for the horse)", "~a (well-done|comforting|reassuring) pat {n}", "~a clap on (my|the) shoulder {n}", "~(petting|stroking|patting) (the dog|a cat|the horse) {n}"),
        one=("use your {S} hand to (pat the dog|pat me on the back|stroke the cat|pet the horse) {n}", "lay your {S} hand on my shoulder and ^pat it {n}", "pat my (back|shoulder) with (your|the) {S} (hand|palm) {n}", "let your {S} hand pat (the dog|my shoulder|my back) {n}",
             "~your {S} hand (pats|is patting) (me on the back|the dog|my shoulder|a friend's shoulder) {n}", "~{S} hand patting (my back|the dog|me on the shoulder) {n}", "~a pat on my (back|shoulder) (with|from) your {S} hand {n}", "~with (your|the) {S} hand, pat (the dog|me on the back|my shoulder) {n}", "~the {S} hand (pats|strokes) the (dog|cat|horse) {n}", "~{N} pats on my (back|shoulder) (with|from) your {S} hand")),
        sides=ONE, counts=(2, 3)),
}  # fmt: skip
