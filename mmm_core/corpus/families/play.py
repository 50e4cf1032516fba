"""Music, dance and pretending: instruments, conducting, circling, flapping, robots."""

from __future__ import annotations

import numpy as np

from mmm_core.corpus.families.gesture import ANY, BOTH, ONE, Family, Gesture, Perform, Words
from mmm_core.corpus.families.strokes import (
    arms_to,
    circle,
    cycle_s,
    keep,
    loops,
    pair_to,
    reach_s,
    repeat,
    still,
    strokes,
    vary,
)
from mmm_core.corpus.families.work import taps
from mmm_core.corpus.reach import ELBOW_DOWN, ELBOW_OUT, reach
from mmm_core.corpus.score import SIDE, ArmPose, Score, Vector

_DRUM_UP, _DRUM_DOWN = (
    ArmPose((0.3, -0.85, 0.3), (0.0, 0.5, 0.88), -0.9),
    ArmPose((0.3, -0.88, 0.3), (0.0, -0.15, 1.0), -0.9),
)
_PIANO_UP, _PIANO_DOWN = (
    ArmPose((0.35, -0.85, 0.4), (0.05, 0.25, 0.95), -1.0),
    ArmPose((0.35, -0.85, 0.4), (0.05, -0.08, 1.0), -1.0),
)
_OTHER = {"left": "right", "right": "left"}


def _lead_strokes(
    ready: ArmPose, out: ArmPose, other: ArmPose, usual_s: float, head: Vector = (0.0, 0.0, 0.0)
) -> Perform:
    """The leading hand repeats a stroke, the other holds its place: strings and the like."""

    def perform(score: Score, g: Gesture) -> None:
        if head != (0.0, 0.0, 0.0):
            start_s = score.time_s
            score.move(0.5, head=head)
            score.time_s = start_s
        pair_to(score, g, ready, other)
        repeat(score, Gesture(g.family, g.lead, g.count, tempo=g.tempo, size=g.size), out, ready, usual_s)

    return perform


def _arm_circle(score: Score, g: Gesture) -> None:
    """Long arms draw circles in the side plane, forward over the top or the other way."""
    turn = -1.0 if g.direction == "back" else 1.0
    wide = 0.6 * g.size

    def pose(phase: float) -> ArmPose:
        a = 2 * np.pi * phase
        v = (0.8, -wide * float(np.cos(a)), 0.1 - turn * wide * float(np.sin(a)))
        return ArmPose(v, v)

    arms_to(score, g, pose(0.0), amount=0.0, via=SIDE)
    duration = g.count * max(0.9, 1.25 / g.tempo * score.rng.uniform(0.93, 1.08))
    score.trace(duration, **dict.fromkeys(g.arms, lambda u: pose(g.count * u)))


def _flap(score: Score, g: Gesture) -> None:
    low, high = ArmPose((0.85, -0.5, 0.1), (0.8, -0.6, 0.1)), ArmPose((0.85, 0.45, 0.1), (0.9, 0.3, 0.1))
    arms_to(score, g, low, via=SIDE)
    repeat(score, g, high, low, 0.8)


def _conduct(score: Score, g: Gesture) -> None:
    up, down = ArmPose((0.4, -0.4, 0.75), (0.05, 0.75, 0.7)), ArmPose((0.45, -0.6, 0.6), (0.25, -0.05, 0.95))
    arms_to(score, g, up)
    repeat(score, g, down, up, 0.75)


def _robot(score: Score, g: Gesture) -> None:
    """Right-angled arms that change places in jerks, with stops between."""
    up, down = ArmPose((0.95, -0.25, 0.1), (0.1, 0.99, 0.05)), ArmPose((0.95, -0.25, 0.1), (0.1, -0.99, 0.15))
    front = ArmPose((0.15, -0.98, 0.05), (0.0, 0.0, 1.0))
    score.move(0.4, left=front, right=front)
    score.hold(0.2)
    first = "left" if score.rng.random() < 0.5 else "right"
    for i in range(g.count):
        a = first if i % 2 == 0 else _OTHER[first]
        score.move(0.3 / g.tempo**0.5, **{a: up, _OTHER[a]: down}, head=((0.35 if a == "left" else -0.35), 0.0, 0.0))
        score.hold(0.26 / g.tempo)


def _disco(score: Score, g: Gesture) -> None:
    """One arm points up and out, then down across the body; the other hand rests on the hip."""
    up, down = ArmPose((0.6, 0.75, 0.25), (0.6, 0.78, 0.2)), ArmPose((-0.1, -0.8, 0.6), (-0.6, -0.7, 0.4))
    hip = reach((0.17, -0.45, 0.06), ELBOW_OUT)
    pair_to(score, g, up, hip)
    one = Gesture(g.family, g.lead, g.count, tempo=g.tempo, size=g.size)
    repeat(score, one, down, up, 0.95)


def _sway_arms(score: Score, g: Gesture) -> None:
    """Both long arms overhead swing together to one side and the other, the trunk with them."""
    first = 1.0 if score.rng.random() < 0.5 else -1.0
    half = cycle_s(score, g, 1.25) / 2
    for i in range(2 * g.count + 1):
        side = first * (1 if i % 2 == 0 else -1) * g.size * score.rng.uniform(0.92, 1.08)
        pose = {"left": (0.2 + 0.45 * side, 0.9, 0.15), "right": (0.2 - 0.45 * side, 0.9, 0.15)}
        arms = {k: ArmPose(v, v) for k, v in pose.items()}
        score.move(reach_s(score, g, arms["left"]) if i == 0 else half, SIDE, **arms, trunk=(0.0, 0.0, 0.12 * side))


def _arm_wave(score: Score, g: Gesture) -> None:
    """A wave runs from one hand through the shoulders to the other."""
    flat = {"left": ArmPose((1, 0.0, 0.1), (1, 0.0, 0.1)), "right": ArmPose((1, 0.0, 0.1), (1, 0.0, 0.1))}
    score.move(reach_s(score, g, flat["left"]), SIDE, **flat)
    step = max(0.22, 0.27 / g.tempo)
    bump, dip = ArmPose((1, 0.4, 0.1), (0.9, -0.45, 0.1)), ArmPose((1, -0.12, 0.1), (0.9, 0.5, 0.1))
    for _ in range(g.count):
        a = "left" if score.rng.random() < 0.5 else "right"
        for arm, pose in ((a, dip), (a, bump), (_OTHER[a], bump), (_OTHER[a], dip)):
            score.move(step, **{arm: pose, _OTHER[arm]: flat[arm]})
        score.move(1.3 * step, **flat)


def _chicken(score: Score, g: Gesture) -> None:
    low, high = ArmPose((0.45, -0.88, 0.0), (0.05, 0.75, 0.55)), ArmPose((0.97, -0.1, 0.0), (-0.45, 0.1, 0.6))
    arms_to(score, g, low)
    repeat(score, g, high, low, 0.6)


def _shake_out(score: Score, g: Gesture) -> None:
    a, b = ArmPose((0.35, -0.93, 0.05), (0.5, -0.83, 0.25)), ArmPose((0.3, -0.93, 0.15), (0.12, -0.78, 0.62))
    arms_to(score, g, a, amount=0.02)
    repeat(score, g, b, a, 0.5)


def _dab(score: Score, g: Gesture) -> None:
    side = 1.0 if g.lead == "left" else -1.0
    long, bent = ArmPose((0.85, 0.5, 0.15), (0.85, 0.52, 0.1)), ArmPose((0.0, 0.05, 1.0), (-0.8, 0.6, 0.1))
    a, b = vary(score, long, 0.03), vary(score, bent, 0.03)
    score.move(0.42 / g.tempo, **{g.lead: a, _OTHER[g.lead]: b}, head=(-0.5 * side, 0.5, 0.0))
    keep(score, g, (0.5, 1.5))


_STRUM_UP, _STRUM_DOWN = reach((-0.02, -0.22, 0.22), ELBOW_OUT), reach((0.05, -0.40, 0.22), ELBOW_OUT)
_FRETS = ArmPose((0.55, -0.7, 0.35), (0.4, 0.6, 0.6), 0.9)
_BOW_IN, _BOW_OUT = reach((-0.12, 0.06, 0.3), (0.7, -0.4, 0.3)), reach((0.3, -0.1, 0.42), (0.7, -0.5, 0.2))
_VIOLIN = ArmPose((0.45, -0.55, 0.7), (0.1, 0.62, 0.75), 1.2)

PLAY: dict[str, Family] = {
    "drum": Family(taps(_DRUM_UP, _DRUM_DOWN, 0.56), Words(
        ("play the drums", "drum( on a table| with sticks|) {n}", "beat (a|the) drum {n}", "drum with both hands {n}", "hit the (drum|drums) {n}", "pretend to play the drums {n}", "give {N} drum beats", "play a drum (roll|solo)", "act like a drummer", "bang (on |)the drums {n}", "play the (bongos|congas) {n}", "play percussion")), sides=BOTH, counts=(2, 3, 4)),
    "piano": Family(taps(_PIANO_UP, _PIANO_DOWN, 0.56, 0.22), Words(
        ("play (the piano|piano|a piano|the organ|the keyboard) {n}", "pretend to play the piano {n}", "act like a pianist", "perform a piano (concert|sonata)", "hit the piano keys {n}", "give a piano recital", "play a (sonata|melody) on the piano", "practise the piano", "play (Mozart|Chopin) on the piano", "tickle the ivories")), sides=BOTH, counts=(3, 4)),
    "guitar": Family(_lead_strokes(_STRUM_UP, _STRUM_DOWN, _FRETS, 0.6), Words(
        ("play (the guitar|guitar|air guitar|a guitar|the ukulele|the banjo|the bass) {n}", "strum (a guitar|the guitar|the strings) {n}", "pretend to play the guitar {n}", "act like a (guitarist|rock star)", "rock on your guitar", "play a guitar solo", "do an air guitar solo", "give {N} strums", "perform a song on the guitar", "strum a chord {n}")), sides=BOTH, counts=(3, 4)),
    "violin": Family(_lead_strokes(_BOW_IN, _BOW_OUT, _VIOLIN, 1.1, (0.25, 0.1, 0.2)), Words(
        ("play (the violin|violin|a violin|the fiddle|the viola) {n}", "draw the bow over the violin {n}", "pretend to play the violin {n}", "act like a (violinist|fiddler)", "fiddle( a tune|) {n}", "bow the violin {n}", "play a sad song on the violin", "perform on the violin", "practise the (violin|fiddle)", "make {N} bow strokes on the violin")), sides=BOTH, counts=(2, 3)),
    "flute": Family(_lead_strokes(reach((-0.02, 0.13, 0.3), (0.8, -0.5, 0.0)), reach((0.0, 0.11, 0.31), (0.8, -0.5, 0.0)), reach((-0.02, 0.13, 0.25), (0.7, -0.6, 0.3)), 0.7), Words(
        ("play (the flute|a flute|the trumpet|the recorder|the clarinet|the oboe|a horn) {n}", "blow (a trumpet|the trumpet|a horn|the flute)", "pretend to play the (flute|trumpet)", "act like a (flautist|trumpeter)", "sound the (trumpet|horn)", "perform on the (trumpet|flute)")), sides=BOTH, counts=(2, 3)),
    "conduct": Family(_conduct, Words(
        ("conduct (an orchestra|the orchestra|the music|a choir|the band) {n}", "beat time {n}", "swing a baton {n}", "act like a conductor {n}", "direct the (choir|orchestra) {n}", "lead the orchestra {n}", "mark the beat {n}", "keep time for the musicians {n}", "give the beat {n}", "conduct {n}")), sides=ANY, counts=(3, 4)),
    "arm_circle": Family(_arm_circle, Words(), sides=ANY, counts=(1, 2), directions=("forward", "back"), directed={
        "forward": Words(one=("circle your {S} arm( forward|) {n}", "(swing|rotate|spin) your {S} arm in circles {n}", "make (circles|forward circles) with your {S} arm {n}", "rotate your {S} arm forward {n}", "draw {N} circles with your {S} arm", "windmill your {S} arm {n}", "turn your {S} arm round {n}"),
                         any=("make circles with one arm {n}",), both=("circle your arms( forward|) {n}", "make arm circles {n}", "do {N} (forward |)arm circles", "rotate both arms( forward|) {n}", "swing both arms in circles {n}", "windmill both arms {n}", "warm up your shoulders with arm circles {n}")),
        "back": Words(one=("circle your {S} arm backward {n}", "(rotate|spin|swing|turn) your {S} arm backward {n}", "make backward circles with your {S} arm {n}", "windmill your {S} arm backward {n}", "draw {N} backward circles with your {S} arm"),
                      any=("make backward circles with one arm {n}",), both=("circle your arms backward {n}", "do {N} backward arm circles", "(rotate|spin|swing) both arms backward {n}", "windmill both arms backward {n}", "make backward arm circles {n}")),
    }),
    "flap": Family(_flap, Words(
        ("flap (your arms|your wings|both arms|your arms like a bird) {n}", "fly like (a bird|an eagle|a butterfly|a swan) {n}", "pretend to (fly like a bird|be a bird) {n}", "move your arms up and down at your sides {n}", "beat your (arms like wings|wings) {n}", "give {N} flaps with your arms", "be a (bird|butterfly|bat)", "act like a (bird|flying eagle) {n}")), sides=BOTH, counts=(2, 3)),
    "chicken": Family(_chicken, Words(
        ("flap your elbows( like a chicken|) {n}", "do the chicken dance {n}", "act like a (chicken|hen|duck) {n}", "be a chicken", "move your elbows up and down {n}", "dance like a chicken {n}", "imitate a (chicken|hen) {n}", "pretend to be a (chicken|hen|duck) {n}", "raise and ^lower your elbows {n}", "flap like a chicken {n}")), sides=BOTH, counts=(2, 3)),
    "robot": Family(_robot, Words(
        ("do the robot {n}", "dance like a robot {n}", "do (the|a) robot dance {n}", "move like (a machine|an android|a mechanical doll) {n}", "act like a (robot|machine) {n}", "imitate a robot {n}", "be a mechanical man {n}", "move your arms stiffly like a robot {n}", "perform the robot {n}", "dance the robot {n}", "(dance|move) mechanically {n}", "behave like an automaton {n}")), sides=BOTH, counts=(3, 4)),
    "disco": Family(_disco, Words(
        ("dance disco( style|) {n}", "disco dance {n}", "dance like (John Travolta|in the seventies) {n}", "do the disco( point|) {n}", "point up and down like a disco dancer {n}", "do Saturday night fever {n}", "dance the night fever {n}", "boogie {n}", "show me your disco moves {n}", "do {N} disco points")), sides=ONE, counts=(2, 3)),
    "sway_arms": Family(_sway_arms, Words(
        ("(sway|swing|wave) your arms (above|over) your head from side to side {n}", "(sway|wave) your arms (in the air |)to the (music|song) {n}", "sway your raised arms {n}", "wave your arms like at a concert {n}", "move your arms like (seaweed|grass in the wind) {n}", "dance with your arms in the air {n}", "swing your raised arms left and right {n}", "wave along to the slow song {n}", "sway with both arms up {n}")), sides=BOTH, counts=(2, 3)),
    "arm_wave": Family(_arm_wave, Words(
        ("do (the|an) arm wave( dance|) {n}", "let a wave run through your arms {n}", "dance (the wave|the snake) with your arms {n}", "ripple your arms {n}", "do a body wave with your arms {n}", "move your arms like a snake {n}", "make a wave from one hand to the other {n}", "move your arms like waves {n}", "do the snake with your arms {n}", "send a ripple through both arms {n}")), sides=BOTH, counts=(1, 2)),
    "dance_pump": Family(strokes(ArmPose((0.4, -0.75, 0.4), (-0.1, 0.6, 0.75)), ArmPose((0.35, -0.3, 0.85), (0.0, 0.85, 0.5)), 0.6), Words(
        ("dance( with your arms| to the music| happily|) {n}", "dance with both arms {n}", "pump your arms to the beat {n}", "move (your arms |)to the beat {n}", "groove {n}", "do a little dance {n}", "show me a dance {n}", "bop to the music {n}", "move your arms in rhythm {n}", "party with your arms {n}"),
        alternating=("dance with one arm after the other {n}", "pump your arms in turns {n}")), sides=("both", "alternating"), counts=(3, 4)),
    "dab": Family(_dab, Words(
        ("dab", "do (a|the) dab", "make a dab pose", "dab like a footballer", "hit a dab", "show me a dab", "celebrate with a dab", "do the dab dance", "throw a dab", "hide your face in your elbow and ^dab"),
        one=("dab to the {S}", "dab with your {S} arm long", "do a dab to your {S}")), sides=ONE, holds=True),
    "shake_out": Family(_shake_out, Words(
        ("shake out your (arms|hands|arms and hands) {n}", "shake your (arms|hands)( loose|) {n}", "loosen your arms {n}", "relax your arms by shaking them {n}", "shake the water off your hands {n}", "wiggle your arms {n}", "loosen up {n}", "shake your arms at your sides {n}", "shake off the tension {n}", "get rid of the tension in your arms {n}")), sides=BOTH, counts=(3, 4)),
    "heart_over_head": Family(still(reach((0.02, 0.45, 0.1), (1.0, 0.2, 0.1)), via=SIDE), Words(
        ("make a heart (above|over) your head", "form a (big |)heart( with your arms|)", "show (me |)a heart( with both arms|)", "send (me |)love with a big heart", "hold your hands together over your head", "stand like a ballerina( with your arms up|)", "make an O (above|over) your head with your arms",
         "put your hands together above your head", "join your hands overhead", "say I love you with your arms", "form a circle above your head", "do a ballet pose", "make a tree pose with your arms")), sides=BOTH, holds=True),
    "binoculars": Family(still(reach((0.06, 0.25, 0.2), (0.8, -0.6, 0.1))), Words(
        ("look through (binoculars|a telescope|field glasses|a camera)", "hold binoculars (to|in front of) your eyes", "use binoculars", "watch (birds|the birds) with binoculars", "take a (photo|picture|photograph)( of me|)", "photograph me", "pretend to hold binoculars", "act like a (photographer|bird watcher)",
         "make glasses with your hands", "film me", "hold a camera to your eye", "spy through binoculars")), sides=BOTH, holds=True),
    "juggle": Family(loops(circle((0.2, -0.2, 0.35), 0.09, "front", 1.5), 0.75, ELBOW_DOWN, 1.0, offset=0.5), Words(
        ("juggle( balls| three balls| apples| in the air|) {n}", "pretend to juggle {n}", "act like a juggler {n}", "be a juggler", "throw balls from hand to hand {n}", "show me how you juggle {n}", "do a juggling act {n}", "juggle like a clown {n}", "keep three balls in the air {n}", "toss balls up and ^catch them in turns {n}")), sides=BOTH, counts=(3, 4)),
    "pull_hat": Family(strokes(reach((0.09, 0.33, 0.06), (0.9, 0.2, 0.0)), reach((0.2, 0.42, 0.22), (0.9, 0.2, 0.0)), 1.0), Words(
        ("tip your hat {n}", "raise your hat( politely|) {n}", "take off your (hat|cap) {n}", "lift your hat {n}", "greet me by raising your hat {n}", "doff your (hat|cap) {n}", "say good day with your hat {n}", "touch your hat like a gentleman {n}", "greet like a cowboy {n}")), sides=ONE, counts=(1,)),
}  # fmt: skip
