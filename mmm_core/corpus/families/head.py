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
        f"(rotate|swivel|pivot|swing|yaw) (your|the) head (to the |to your |){where}", f"turn your (face|nose|chin|gaze|eyes) (to the |towards the |to your ){where}", f"(direct|shift|cast|move) your (gaze|eyes) (to the |to your |){where}",
        f"(have|take) a look (to the|to your|on the) {where}", f"see what is (going on |there |)(on|to) (the|your) {where}", f"set (your|the) head to (face|look) {where}", f"check your {where}-hand (side|mirror)", f"look out of the {where} window",
        f"look (at|towards) (the person|your neighbour|somebody|the door) (on|to) your {where}", f"look {where}wards", f"turn your head so that you face {where}", f"(let|make) your (eyes|head) turn (to the |){where}", f"~let me see you look (to the |){where}", f"follow something to the {where} with your eyes",
        f"~eyes (to the |){where}", f"~head (turned to the|turned|rotated to the|turning to the|facing) {where}", f"~head to the {where}", f"~face (turned |)to the {where}", f"~your head (turns|rotates|swivels|should turn|is turned) (to the |to your |){where}",
        f"~your gaze (goes|moves|wanders|shifts) to the {where}", f"~your eyes (go|move|turn|shift|should be) to the {where}", f"~the head (turns|rotates|swings|is turned) to the {where}( side|)", f"~a (look|glance|gaze) (to the |to your |){where}",
        f"~a turn of (the|your) head to the {where}", f"~a head turn (to the |){where}", f"~looking (to the |to your |){where}", f"~nose (pointing |)to the {where}", f"~with your (head|eyes), look (to the |){where}", f"~a look at what is on (the|your) {where}",
        f"(avert|divert|switch|steer|flick|whip|jerk|angle) your (gaze|head|face) to the {where}", f"(spin|twist|wheel|veer) your head (round |)to the {where}", f"squint to the {where}", f"(spy|spot|observe|view|regard|behold|study|examine) (something|somebody) (on|to) (the|your) {where}", f"ogle (the waiter|somebody) on your {where}", f"gawk (to the|at somebody on your) {where}",
        f"gape at (the|your) {where} side", f"keep an eye on {place}", f"(inspect|survey|scan|monitor) {place}", f"notice (the cat|the bus|a car) coming from the {where}", f"let your nose (point|aim) (to the |){where}", f"aim your (nose|chin|eyes|face) (to the |){where}",
        f"attend to (the speaker|your neighbour) on your {where} by turning your head", f"rotate the neck (to the |){where}", f"do a neck rotation to the {where}", f"swing your (nose|chin|face) round to the {where}", f"eye (the neighbour|the stranger|the passenger) on your {where}", f"check the traffic coming from the {where}",
        f"mind the car coming from the {where}", f"take a (peep|gander|butcher's|squint) to the {where}", f"pan your head to the {where} like a camera", f"orient your head to the {where}", f"show me your profile by turning your head to the {where}", f"have a gander (to the|to your) {where}",
        f"watch (the ball|the bird|the car) fly off to the {where}", f"focus on (the object|the picture|the clock) to your {where}", f"~a (squint|peep|gander|glimpse) to the {where}", f"~a (swivel|rotation|pivot|swing|yaw) of the head (to the |){where}", f"~neck (rotation|rotated|twisted) to the {where}", f"~attention to the {where}",
        f"~a sideways (glance|look) to the {where}", f"~chin (above|over towards) the {where} collarbone", f"~your line of sight (swings|moves) to the {where}", f"~head yaw, {where}", f"~your nose (points|swings) to the {where}", f"~visual focus on the {where}",
    ))  # fmt: skip


def _diagonal(height: str, side: str) -> Words:
    corner, raised = ("upper", "(raise|lift)") if height == "up" else ("lower", "(lower|drop)")
    edge, surface = ("top", "ceiling") if height == "up" else ("bottom", "floor")
    return Words((
        f"look {height} (to the|and to the|to your) {side}", f"(glance|gaze) {height} to the {side}",
        f"turn your head {height} and to the {side}", f"look (at|to|towards) the {corner} {side}( corner|)",
        f"move your head {height} to the {side}", f"look diagonally {height} (to the |){side}",
        f"face {height} and (to the |){side} with your head", f"look {side} and {height}",
        f"(rotate|swing|turn|swivel) (your|the) head {height} and (to the |){side}", f"(direct|cast|shift|turn) your (eyes|gaze|face) {height} and to the {side}", f"{raised} your (head|chin|face) and ^turn it to the {side}",
        f"look {height}wards and to the {side}", f"see what is {height} there on the {side}", f"(look|glance|gaze) (at|to|towards) the {edge} {side}( corner|)", f"aim your nose {height} and to the {side}", f"look at the {surface} on (the|your) {side}",
        f"(take|have) a look {height} to the {side}", f"check the ({edge}|{corner}) {side} corner", f"set your head to look {height} and {side}", f"turn your head to the {side} and ^look {height}", f"look to the {side} and {height}", f"let your (eyes|gaze) go {height} and to the {side}",
        f"~head {height} and (turned |)to the {side}", f"~eyes {height} and (to the |){side}", f"~a (look|glance|gaze) {height} (and |)to the {side}", f"~your head (turns|goes|moves|should turn) {height} and to the {side}", f"~your gaze (goes|moves|wanders) {height} and to the {side}",
        f"~your eyes (go|move|turn) {height} and to the {side}", f"~a (look|glance) (at|to|towards) the ({corner}|{edge}) {side}( corner|)", f"~looking {height} (and |)to the {side}", f"~chin {height}, (head|face) turned to the {side}", f"~face turned {height} and to the {side}",
        f"~eyes on the {corner} {side} corner", f"~a diagonal (look|glance) {height} to the {side}", f"~the head (turns|moves|is turned) {height} and to the {side}",
        f"(squint|gawk|gape|goggle) {height} to the {side}", f"(spot|observe|view|regard|behold|study) something {height} on the {side}", f"(angle|tilt|orient|steer|twist|wheel) your (face|head) {height} and to the {side}", f"point your (nose|chin|forehead) {height} and to the {side}", f"(inspect|examine|survey|scan) the {corner} {side} (quadrant|corner|edge)", f"follow the (fly|butterfly|wasp) {height} and to the {side} with your eyes",
        f"(pivot|rotate|yaw) your neck {height} and to the {side}", f"focus on a (spot|spider|lamp) {height} on the {side}", f"(avert|divert|switch|flick) your gaze {height} and to the {side}", f"pan and ^tilt your head {height} and to the {side} like a camera", f"take a (peep|gander|squint) {height} to the {side}", f"look obliquely {height} to the {side}",
        f"~a (squint|peep|gander|glimpse) {height} to the {side}", f"~an oblique (look|glance|gaze) {height} to the {side}", f"~a (swivel|rotation|turn|twist) of the head {height} and to the {side}", f"~your nose (points|aims) {height} and to the {side}", f"~your line of sight (goes|slants|runs) {height} and to the {side}", f"~attention to the {corner} {side} corner",
        f"~neck (rotated|twisted) {side} with the gaze {height}", f"~your chin (swings|moves|travels) {height} and to the {side}", f"~visual focus {height} on the {side}",
    ))  # fmt: skip


HEAD: dict[str, Family] = {
    "nod": Family(_nod, Words((
        "nod (your head|yes|in agreement|approvingly|politely|) {n}", "say yes with your head", "give (a nod|me a nod|a short nod)", "give (me |){N} nods",
        "agree by nodding {n}", "move your head up and down {n}", "show that you agree with a nod", "nod your head up and down {n}",
        "make {N} nods", "answer yes with (a nod|your head)", "bob your head {n}",
        "nod (in approval|in assent|to say yes|to agree|encouragingly|knowingly|to me|at me|in greeting|as if you understand|if you agree|like a good pupil) {n}", "move your chin (up and down|down and up) {n}", "bring your chin (down|towards your chest) and back up {n}", "flex and ^extend (your|the) neck {n}",
        "(pitch|bounce|rock) (your|the) head (up and down|down and up) {n}", "tip your head forward and back {n}", "give (the nod|a nod of approval|a nod of the head|me the nod|your consent with a nod)", "signal (yes|agreement|approval|that you understand) with (your head|a nod)", "say (aye|okay|of course|you are right|sure) with (a nod|your head)",
        "confirm (it|this|what I say) (by nodding|with a nod) {n}", "show me (a nod|{N} nods)", "answer (in the affirmative|me) with a nod", "(affirm|approve|accept) it with a nod", "let your head (nod|bob|go up and down) {n}", "~let me see you nod {n}", "(acknowledge|greet) me with a nod", "nod along( to the music| to what I say|) {n}", "do {N} nods( of the head|)",
        "~a nod( of the head| of approval| of agreement| of your head| to say yes| in my direction|)", "~{N} (approving |polite |)nods", "~{N} nods of (the|your) head", "~a yes (from your head|with the head)", "~yes with (your|the) head", "~your head (nods|goes up and down|moves up and down|bobs up and down|is nodding|should nod) {n}",
        "~the head (nods|moves up and down|bobs) {n}", "~head (up and down|nodding|going up and down) {n}", "~nodding {n}", "~your chin goes (down and up|up and down) {n}", "~chin down and up {n}", "~an (approving|affirmative|agreeing) nod", "~up and down with your head {n}", "~with your head, (nod|say yes) {n}",
        "dip your (head|chin) and ^bring it back up {n}", "duck your head (briefly |)and ^bring it back up {n}", "jerk your chin (down and up|up and down) {n}", "concur (with me |)by nodding {n}", "assent (with a nod|by nodding) {n}", "(endorse|second|ratify) (it|what I say|the plan) with a nod",
        "(jig|joggle|pump|jiggle) your head up and down {n}", "say (yep|yup|yeah|roger|agreed|absolutely|exactly|amen) with your head", "(grant|permit|allow) it with a nod", "give (your blessing|the go-ahead|permission) with a nod", "reply positively with your head {n}", "respond with (a nod|{N} nods)",
        "indicate (consent|assent|comprehension) (by nodding|with a nod) {n}", "let your (forehead|brow) (dip|drop) and ^rise {n}", "nod like (a nodding dog|a dashboard dog|a horse|a yes-man) {n}", "reassure me with (a nod|{N} nods)", "encourage (me|the speaker) (with a nod|by nodding) {n}", "~a (dip|bob|jerk) of the (head|chin) and back up",
        "~{N} (head|chin) (bobs|dips)", "~{N} bobs of the head", "~a (curt|brisk|grave|solemn|thoughtful|emphatic|vigorous|wordless|silent|hearty) nod", "~the (gesture|sign|motion) (for yes|of assent|of affirmation) with the head {n}", "~a vertical (movement|rocking) of the head, down and up {n}", "~{N} vertical head movements",
        "~neck flexion and extension in (alternation|turn) {n}", "~a (consenting|confirming|reassuring|understanding|comprehending) nod", "~your (forehead|skull|crown) (dips|bobs) (down and up|forward and back) {n}", "~a mute yes with the head", "~agreement without words, from the head alone", "~{N} head pitches, down and up",
    )), "head", (), (2,)),
    "shake_head": Family(_shake, Words((
        "shake (your|the) head (no|in disagreement|) {n}", "say no (by shaking|with) your head", "turn your head from side to side {n}",
        "disagree by shaking your head {n}", "(reject|decline) it by shaking your head {n}", "move your head left and right {n}", "show disagreement with your head", "give {N} head shakes",
        "refuse by shaking your head {n}", "answer no with your head", "deny it with a shake of (your|the) head", "swing your head from side to side {n}",
        "shake (your|the) head (at me|disapprovingly|to say no|to refuse|in disbelief|in refusal|from side to side|left and right) {n}", "say (nope|no way|never|not at all|no thanks|certainly not) with (your|the) head", "(rotate|swivel|yaw|twist) (your|the) head (left and right|from side to side) {n}", "turn your (face|chin|nose) from side to side {n}",
        "signal (no|refusal|disagreement|disapproval) with your head {n}", "show (disapproval|that you disagree|that the answer is no) (with your head|by shaking your head)", "turn (me|the offer|it) down by shaking your head {n}", "veto it with a shake of your head", "give (a shake of the head|me a head shake|your head a shake)",
        "do {N} (head shakes|shakes of the head)", "let your head (shake|go from side to side|swing left and right) {n}", "~let me see you shake your head {n}", "answer (in the negative|me) with a shake of your head", "protest by shaking your head {n}", "rule it out with a shake of the head",
        "~a (firm |disapproving |)shake of (the|your) head", "~a (disapproving |)head( |-)shake {n}", "~{N} (firm |)head shakes", "~{N} shakes of (the|your) head", "~a no (with the head|from your head)", "~no with (your|the) head", "~your head (shakes|goes from side to side|turns left and right|is shaking|moves left and right|should shake) {n}",
        "~the head (shakes|swings from side to side|turns left and right|says no) {n}", "~head (shaking|turning left and right|going from side to side) {n}", "~left and right with your head, as in no {n}", "~with your head, (say no|shake no) {n}", "~shaking (your|the) head {n}",
        "(wiggle|waggle|jiggle|joggle|whip|jerk|toss|flick) your head left and right {n}", "(demur|object|dissent|differ) by shaking your head {n}", "(dismiss|repudiate|spurn|rebuff) (it|the idea|the proposal) with a shake of the head", "(contradict|oppose|gainsay) me by shaking your head {n}", "(forbid|prohibit|disallow) it with a shake of your head", "negate it by shaking your head {n}",
        "say (nay|nah|nix|negative|out of the question|forget it) with your head", "vote against it by shaking your head", "tell me off by shaking your head {n}", "give (the no sign|a sign of denial|a negative reply) with your head", "pivot your skull on your neck left and right {n}", "shake your head like (a wet dog|a stubborn child|a horse with flies|a toddler who hates spinach) {n}",
        "shake your head (in dismay|in despair|in disgust|sadly|regretfully|ruefully|incredulously|sceptically|vehemently|emphatically) {n}", "let your ponytail fly from side to side by shaking your head {n}", "withhold your consent by shaking your head {n}", "express (dissent|denial|rejection|negation|reluctance) by shaking your head {n}", "do the no (gesture|motion|sign) with your head {n}",
        "respond with a (head shake|shake of the head)", "~a (vehement|sad|slow|weary|incredulous|rueful|curt|wordless) shake of the head", "~{N} horizontal head movements, left and right", "~a horizontal (back and forth|to and fro) of the head {n}", "~{N} turns of the head from side to side, as in no", "~the (gesture|motion) for no with the head {n}",
        "~a (negating|denying|refusing|negative|dissenting) (head movement|head shake|movement of the head) {n}", "~a silent no", "~your (nose|chin) (swings|sweeps|swishes) from left to right and back {n}", "~neck rotation left and right in quick alternation {n}", "~denial, expressed by the head alone", "~a headshake of (dismay|disbelief|refusal)",
        "~your face whips from side to side {n}",
    )), "head", (), (1, 2)),
    "tilt_head": Family(_tilt, Words((
        "(tilt|tip|lean|bend|cock) your head (to the |to your |){D}", "drop your head towards your {D} shoulder",
        "put your {D} ear to your {D} shoulder", "lay your head on your {D} shoulder", "bring your head down to the {D} shoulder",
        "let your head fall to the {D}", "tilt the head over to the {D}( side|)",
        "(tilt|cant|slant|angle|tip|flop) (your|the) head (sideways |over |)(to the|towards the|to your) {D}", "bring your {D} ear (down |)(to|towards|close to) your (shoulder|{D} shoulder)", "(sink|rest) your head on your {D} shoulder", "(lower|drop|dip) your {D} ear (to|towards) your shoulder",
        "(flex|bend) (your|the) neck (sideways |laterally |)to the {D}", "do a (lateral|sideways) neck (bend|stretch) to the {D}", "stretch your neck by tilting your head (to the |){D}", "hang your head to the {D}( side|)", "cock your head {D} like a (puppy|curious dog|parrot)", "tilt your head to the {D} like a (puppy|curious bird|portrait painter)",
        "let your {D} ear sink (to|towards) your shoulder", "let your head (sink|drop|tip|loll) to the {D}", "touch your {D} shoulder with your {D} ear", "put your head over to the {D} as if listening to your shoulder", "hold your head at an angle to the {D}", "set the head to a {D} tilt",
        "~a (head tilt|tilt of the head|tilt of your head|sideways tilt of the head) to the {D}", "~a {D} head tilt", "~head (tilted|cocked|leaning|bent|tipped) (to the |to your |){D}", "~your head (tilts|leans|tips|falls|sinks|is tilted|should be tilted) to the {D}", "~{D} ear (to|on|towards|down to) (the|your) (shoulder|{D} shoulder)",
        "~your {D} ear (goes|sinks|moves|drops) (to|towards) your shoulder", "~the head (tilts|leans|is tilted|tips over) to the {D}( side|)", "~head on (the|your) {D} shoulder", "~neck bent to the {D}", "~a sideways lean of the head to the {D}", "~tilting your head (to the |){D}", "~with your head, lean to the {D}",
        "(loll|list|droop|crook|quirk|lower|drop) your head (to the |over to the |){D}", "(heel|keel|lurch) your head over to the {D}", "let your {D} (earlobe|temple) sink towards your shoulder", "bring your {D} (temple|cheek|earlobe) towards your {D} shoulder", "nestle your {D} cheek against your {D} shoulder",
        "snuggle your head onto your {D} shoulder", "pillow your head on your {D} shoulder", "lay your {D} cheek down as if on a pillow", "flop your {D} ear down onto your shoulder",
        "skew your head to the {D}", "set your head askew to the {D}", "hold your head (askew|crooked|lopsided|aslant|obliquely|diagonally) to the {D}", "put your head on one side, the {D} one", "act (quizzical|puzzled|intrigued) with your head cocked to the {D}", "roll (your|the) head about its forward axis to the {D}",
        "lengthen the opposite side of your neck by tilting your head to the {D}", "~a (quizzical|curious|inquisitive|coy|coquettish|puzzled|questioning) tilt of the head to the {D}", "~a (lateral|sideward) (flexion|bend) of the neck to the {D}", "~lateral neck flexion, {D}", "~a head (cant|slant|lean|roll) to the {D}", "~a slant of the head to the {D}",
        "~head (askew|crooked|lopsided|aslant|on one side) to the {D}", "~your {D} (temple|cheek|earlobe) (sinks|dips|comes) towards your shoulder", "~the crown of your head tips over to the {D}", "~your head droops (sideways |)to the {D}", "~{D} cheek towards the {D} shoulder", "~a crick in your neck: head bent to the {D}",
        "~a {D} (ear-to-shoulder stretch|neck side bend)",
    )), "head", (), (), LEFT_RIGHT, holds=True),
    "wobble_head": Family(_wobble, Words((
        "(wobble|rock|waggle) your head {n}", "(wobble|rock|tilt) your head from side to side {n}", "tilt your head left and right {n}",
        "bob your head from shoulder to shoulder {n}", "do an Indian head (wobble|bobble) {n}", "show that you are unsure with your head",
        "swing your ears towards your shoulders {n}", "make {N} head wobbles", "tip your head to one side and then the other {n}",
        "say (maybe|perhaps) with your head", "show that you are (undecided|in two minds) with your head", "weigh it up with your head {n}", "tip your head from side to side {n}", "swing your head like a pendulum {n}",
        "(rock|tip|lean|tilt|loll) your head (one way and then the other|from shoulder to shoulder|to both sides) {n}", "tilt your head to (each|either) side in turn {n}", "bring your ears to your shoulders in turn {n}", "weigh your options with your head", "make a so-so (motion|movement|gesture) with your head {n}",
        "say (so-so|more or less|kind of|I am not sure|well, maybe|it depends) with your head", "move your head like (a metronome|a bobblehead|the pendulum of a clock) {n}", "show (doubt|hesitation|indecision) with your head", "let your head (rock|wobble|sway|loll) from (side to side|shoulder to shoulder) {n}", "sway your head {n}",
        "do (a|the) head (wobble|bobble|waggle) {n}", "bend your neck to one side and then the other {n}", "alternate head tilts to the left and the right {n}", "(tilt|lean) the head alternately left and right {n}", "touch your shoulders with your ears in turn {n}",
        "~a (head wobble|wobble of the head|head waggle|head bobble) {n}", "~{N} head (wobbles|waggles|bobbles)", "~{N} wobbles of (the|your) head", "~your head (wobbles|rocks|sways|tilts|tips) from (side to side|shoulder to shoulder) {n}", "~head (rocking|wobbling|swaying|tilting) from side to side {n}",
        "~the head (wobbles|rocks from shoulder to shoulder|tips to one side and then the other) {n}", "~ear to shoulder, left and right in turn {n}", "~a (maybe|so-so|perhaps) with your head", "~a pendulum movement of (the|your) head {n}", "~head tilts to both sides {n}", "~an undecided (wobble|rocking) of the head {n}", "~wobbling your head {n}",
        "(jiggle|joggle|wiggle|teeter|seesaw|roll|swing) your head from shoulder to shoulder {n}", "tick your head left and right like a (grandfather clock|cuckoo clock|windscreen wiper) {n}", "hesitate with your head {n}", "waver with your head {n}", "hum and ^haw with your head {n}", "ponder the offer with your head rocking from side to side {n}",
        "tilt your temples towards your shoulders in turn {n}", "wobble your head like (a jelly|a nodding doll from India|a newborn|a doll on a spring) {n}", "flop your head from one shoulder to the other {n}", "express (ambivalence|uncertainty|mixed feelings) with your head {n}", "say (possibly|fifty-fifty|not sure|could be|I suppose|hmm, well) with your head", "give a (noncommittal|vague|wishy-washy|half-hearted) answer with your head",
        "stretch both sides of your neck, ear to shoulder, by turns {n}", "cant your head left and then right {n}", "tip your crown from left to right {n}", "slant your head to alternate sides {n}", "dither with your head from side to side {n}", "~a head (bobble|seesaw|waver|jiggle) from shoulder to shoulder {n}",
        "~{N} head tilts by turns, left and right", "~{N} swings of the head from shoulder to shoulder", "~lateral neck flexion to both sides {n}", "~your crown (swings|swerves|tips) from side to side like an upturned pendulum {n}", "~your earlobes sink towards your shoulders by turns {n}", "~a (noncommittal|ambivalent|hesitant|uncertain|dubious|wavering) (wobble|rock) of the head {n}",
        "~a tick-tock of the head {n}", "~head like a metronome needle, left and right {n}", "~a seesaw of the ears {n}", "~your ears take turns dipping towards your shoulders {n}",
    )), "head", (), (2,)),
    "look": Family(_look, Words(), "head", (), (), tuple(_AIM_DEG), {
        "left": _looks("left", "the left side"), "right": _looks("right", "the right side"),
        "up": Words((
            "look (up|upwards|up high|up to heaven)", "look (up |)at (the ceiling|the sky|the stars|a bird in the sky)", "(raise|lift) (your|the) head",
            "turn your eyes up", "gaze (upwards|up|at the sky)", "lift your head and ^look up", "tilt your head back", "glance (up|upwards)", "watch the clouds",
            "(tip|lean|throw|bend|drop) (your|the) head back", "(raise|lift|stick) your chin up", "(raise|lift|turn|cast|direct) your (gaze|eyes|face) (up|upwards|to the sky|heavenwards|to the ceiling)", "(rotate|tilt|pitch|turn) (your|the) head (up|upwards)", "see what is (above you|up there)", "watch (the plane|the birds|the fireworks|the rain clouds) (above|overhead|in the sky)",
            "admire the (starry sky|chandelier|painted ceiling|moon)", "search the sky( for a plane| for birds|)", "look (heavenwards|skywards|overhead|straight up|to the ceiling|up in the air|up there|above you)", "bring your head up", "lift up your (head|eyes|face)", "extend your neck to look up", "turn your face to the (sun|sky|ceiling)", "count the stars", "look for rain clouds", "(take|have) a look (up|upwards|at the ceiling|at the sky)",
            "~head (up|back|raised|lifted|tipped back|tilted back)", "~chin (up|raised|lifted)", "~eyes (up|to the sky|to the ceiling|to heaven|skywards|on the ceiling)", "~your head (tips|tilts|goes) (up|back|upwards)", "~your gaze (goes up|rises|goes to the ceiling)", "~your eyes (go up|turn upwards|go to the ceiling|are on the sky)", "~the head (is raised|comes up|tilts back|lifts|rises)",
            "~your chin (goes up|rises|lifts|should be up)", "~a (look|glance|gaze) (up|upwards|at the ceiling|at the sky|overhead)", "~an upward (look|glance|gaze)", "~face (to the sky|up|turned upwards)", "~nose (in the air|up)", "~looking (up|upwards|at the ceiling|at the sky)", "~a raised head",
            "(jut|jerk|tilt|poke) your chin upwards", "arch your neck (back|upwards)", "(scan|contemplate|behold|survey|study|examine) the (heavens|ceiling|firmament|night sky)", "stargaze", "goggle at the (ceiling|sky)",
            "gape at the (skyscraper|ceiling|fireworks)", "marvel at the (rainbow|full moon|northern lights|comet|rafters)", "gawk up at the (skyscraper|tower|giant)", "ogle the moon", "spot the (helicopter|kite|balloon|airship|eagle) (above|overhead)", "follow the (helicopter|rocket|kite|balloon) up with your eyes",
            "bare your throat to the sky", "expose your throat by tipping your head back", "check the (roof|ceiling lamp|attic|treetops|rooftops) above you", "implore heaven with a look", "examine the (beams|light bulb|cobwebs) (above|overhead)",
            "look at the (balcony|treetop|steeple|top shelf|roof|gable) high above", "look aloft", "pitch your (face|nose) skyward", "uplift your (face|gaze|eyes)", "bring your gaze to the zenith", "extend the (neck|cervical spine) backwards",
            "~neck (extension|extended|arched back)", "~a (glimpse|squint) (of the sky|up|skyward)", "~a skyward (look|glance|gaze|squint)", "~head flung back", "~head tossed back", "~a (lift|raise|rise|tilt) of the (chin|head) towards the ceiling",
            "~an (upturned|uplifted) face", "~your throat is bared to the sky", "~your line of sight (climbs|goes up)", "~your nose points at the (ceiling|sky)", "~eyes (aloft|heavenward|skyward|on the rafters)", "~forehead back, chin to the ceiling",
        )),
        "down": Words((
            "look (down|downwards|to the ground)", "look (down |)at (the floor|your feet|the ground)", "(lower|drop|hang|bow) (your|the) head",
            "gaze (down|at the ground|at the floor)", "bend your head down", "glance (down|downwards)", "watch your feet", "tilt your head down",
            "(tuck|drop|lower|bring|pull) your chin (to|towards|down to) your chest", "flex (your|the) neck (forward|to look down)", "(lower|drop|cast|direct) your (gaze|eyes) (down|to the floor|to the ground|downwards)", "(rotate|tilt|pitch|turn) (your|the) head (down|downwards)", "(check|inspect|study) your (shoes|shoelaces|toes)", "look at your (toes|shoes|shoelaces|belly button|knees)",
            "study the (floor|carpet|pattern of the carpet)", "search the (floor|ground) (for a coin|for a needle|with your eyes)", "see what is (below you|at your feet|on the floor)", "look for (a coin|a needle|something you dropped) on the (ground|floor)", "turn your (eyes|face|gaze) (down|downwards|to the floor)", "look at the (carpet|grass|ants on the ground)", "sink your head", "lower your (eyes|gaze|chin|face)",
            "(take|have) a look (down|at the floor|at your feet)", "let your chin sink to your chest",
            "~head (down|lowered|bowed|dropped|bent down)", "~chin (down|to chest|on the chest|to your chest|tucked in)", "~eyes (down|to the floor|to the ground|on the floor|on your shoes|on your feet)", "~your head (goes|drops|sinks|tilts) (down|downwards)", "~your chin (drops|sinks|goes) (to|towards) your chest", "~the head (is lowered|goes down|sinks|drops|is bowed)",
            "~a (look|glance|gaze) (down|downwards|at the floor|at your feet|at your shoes)", "~a downward (look|glance|gaze)", "~a lowered head", "~face turned (down|to the floor|downwards)", "~looking (down|at your feet|at the floor)", "~your gaze (drops|falls|sinks|goes) (to the floor|to the ground|down)", "~your eyes (go down|drop to the floor|are on the ground)",
            "(dip|duck|droop|sag|bend|dangle) your head towards the floor", "(avert|sink|cast) your eyes to the ground", "(examine|scan|survey|contemplate|regard|behold) the (floorboards|tiles|doormat|rug|pavement|lawn)", "contemplate your navel","inspect your (navel|belt|buttons|shirt front|laces|sandals)",
            "check whether your (flies|zip|zipper|laces) are done up", "look at (the puddle|the doorstep|the kerb|your shins|your ankles|your slippers)", "look for your contact lens on the floor", "hunt for (a lost earring|a dropped coin) on the floor", "look ashamed with your eyes on the floor", "spot a (beetle|worm|snail|mouse) at your feet",
            "observe the (beetle|snail|worm|mouse) on the ground", "read the (manhole cover|doormat) in front of your feet", "press your chin on your (breastbone|collarbone|sternum)", "drop your (forehead|brow) towards your chest", "look into the (well|pit|abyss|drain) below you", "look earthwards",
            "point your nose (at the floor|at your shoes)", "let your gaze (plummet|sink|descend) to the floor", "tuck in your chin and ^look at your belly", "squint at your (shoes|toes)", "~a (glimpse|squint) (down|at the floor|at your shoes)",
            "~(neck flexion|neck flexed forward), chin to chest", "~a (drop|dip|lowering|sinking|droop) of the (head|chin) (to the chest|towards the floor)", "~downcast (eyes|gaze)", "~a (downcast|ashamed|shamefaced|bashful|contrite) look at the floor", "~chin on the (breastbone|sternum|collarbone)", "~your forehead (sinks|dips) towards your chest",
            "~your line of sight (descends|falls) to the floor", "~your nose points at the (floor|ground|shoes)", "~eyes on the (tiles|rug|pavement|doormat)", "~your neck bends forward and your eyes find the floor",
        )),
        "up left": _diagonal("up", "left"), "up right": _diagonal("up", "right"),
        "down left": _diagonal("down", "left"), "down right": _diagonal("down", "right"),
    }, holds=True),
    "look_back": Family(_look_back, Words((
        "look (back |)over your {D} shoulder", "glance (back |)over (your|the) {D} shoulder", "look behind you (to|on|over) the {D}( side|)",
        "turn (around |)and ^look behind you on the {D}", "check (what is |)behind you over your {D} shoulder", "turn your head back over the {D} shoulder",
        "look backwards (to|on) (the|your) {D}", "see who is behind your {D} shoulder",
        "check your {D} blind spot", "check the blind spot on your {D}", "(twist|turn|swivel) (round|around) to (see|look at) what is behind you on (the|your) {D}", "look (right |)round over (your|the) {D} shoulder", "(cast|throw) a (look|glance) (back |)over your {D} shoulder", "see (who|what) is behind you over your {D} shoulder",
        "bring your chin over your {D} shoulder", "rotate (your|the) head (as far as it goes|all the way) to the {D} to look behind you", "(watch|check) your back over the {D} shoulder", "look to the rear over (your|the) {D} shoulder", "check behind you on (the|your) {D}", "reverse the car and ^look over your {D} shoulder", "look at the person behind you over your {D} shoulder",
        "turn your face back past your {D} shoulder", "look back (to|on) the {D}( side|)", "gaze (back |)over your {D} shoulder", "(take|have) a look over (your|the) {D} shoulder", "see if you are being followed over your {D} shoulder",
        "~a (look|glance|gaze) (back |)over (your|the) {D} shoulder", "~a (shoulder|blind spot|over-the-shoulder) check (to|on) the {D}", "~eyes (back |)over the {D} shoulder", "~head turned (back|backwards|round) over the {D} shoulder", "~your head turns (back|round|backwards) over your {D} shoulder", "~your gaze (goes|wanders) (back |)over your {D} shoulder",
        "~looking (back |)over (your|the) {D} shoulder", "~chin over (the|your) {D} shoulder", "~the head (turns|looks) back over the {D} shoulder", "~a look behind (you|yourself) (on|over|to) the {D}", "~a backward (look|glance) over (the|your) {D} shoulder", "~your eyes (go|look) back over your {D} shoulder", "~face turned back over the {D} shoulder",
        "(squint|gawk|gape|goggle|peep) (back |)over your {D} shoulder", "(spy|spot|observe|regard|behold) (somebody|something) behind you over your {D} shoulder", "crank your head round over the {D} shoulder", "wrench your head round to look behind you on the {D}", "whip your head round over your {D} shoulder", "(screw|wind) your neck round to look behind you on the {D}",
        "do a (shoulder check|lifesaver check|mirror-and-shoulder check) on the {D}", "take a (gander|peep|squint) (back |)over your {D} shoulder", "mind your back over the {D} shoulder", "turn your head like an owl over the {D} shoulder", "look aft over your {D} shoulder",
        "look rearwards over your {D} shoulder", "look for pursuers over your {D} shoulder", "see your own (back|heels) over the {D} shoulder", "inspect the (zip|label) on your back over your {D} shoulder", "park the car backwards, eyes over your {D} shoulder", "flirt back over your {D} shoulder with a look",
        "spare a backward glance over the {D} shoulder", "heed the footsteps behind you with a look over your {D} shoulder", "check for cyclists over your {D} shoulder before you change lanes", "~a (furtive|stealthy|wary|longing|nervous|wistful|suspicious|parting|flirtatious) (look|glance) back over your {D} shoulder", "~a rearward (look|glance) over your {D} shoulder", "~a (peep|squint|gander) (back |)over your {D} shoulder",
        "~maximal neck rotation to the {D}, eyes to the rear", "~your (nose|chin) (passes|crosses) the {D} shoulder until you see behind you", "~an owl-like turn of the head over the {D} shoulder", "~a {D} (lifesaver|shoulder) check",
    )), "head", (), (), LEFT_RIGHT, holds=True),
    "look_around": Family(_look_around, Words((
        "look around", "look (left and right|right and left)", "look around (the room|you|carefully|in all directions)", "look to both sides", "scan (the room|the area)",
        "look from side to side", "search the room with your eyes", "glance (around|about)", "have a look (around|round)", "check both sides", "watch the whole room",
        "look for somebody", "see what is around you", "look (everywhere|about)",
        "(survey|observe|inspect) (the room|the area|your surroundings|the scene|the crowd)", "take in (the room|your surroundings|the view)", "cast your eyes (around|about)( the room|)", "let your (eyes|gaze) wander( around the room| left and right| about|)", "sweep (the room|the area) with your (eyes|gaze)", "get your bearings", "pan (your|the) head (across the room|from one side to the other)",
        "case the joint", "check out (the place|the room|your surroundings)", "(have|take) a (good |)look about", "look both ways( before crossing the road| before crossing the street|)", "check the road (both ways|on both sides)", "look (first |)to one side and then to the other", "search for (your friend|me|someone in the crowd|the exit)", "look for (your keys|me|a friend|the exit|a seat)",
        "act (lost|as if you are lost|like a tourist who is lost)", "orient yourself", "scout the (area|room)", "look all around( you|)", "rubberneck", "look (hither and thither|this way and that|here and there|right round the room)", "turn your head both ways to see the room", "monitor (the room|your surroundings)",
        "~a look (around|round|about|around the room|to both sides|left and right|both ways)", "~a (good |long |curious )look (around|round|about)", "~a glance (around|about|to both sides|around the room)", "~your eyes (wander|roam|go) (around|about) the room", "~your gaze (wanders|sweeps|roams) (around|over|across) the room", "~your head turns (to one side and then the other|both ways) to (see|look at|scan) the room",
        "~looking (around|about|everywhere|in all directions|left and right|both ways)", "~a scan of (the room|the area|your surroundings)", "~eyes (everywhere|on both sides|all around the room)", "~a sweep of the room with your (eyes|gaze)", "~eyes left, then eyes right", "~a search of the room with your eyes", "~some looking around",
        "reconnoitre the (area|room)", "(explore|examine|study|size up|view) the (room|place|hall) with your eyes", "gawk (around|about) like a tourist", "gander about", "(peep|squint|gape|goggle) (around|about)", "roam the room with your eyes",
        "rake the room with your eyes", "comb the room with your eyes", "keep (watch|guard|vigil) on all sides", "be (watchful|vigilant|alert|on the lookout|wary) and ^look around", "act like a (bodyguard|meerkat|security guard|watchman|lighthouse|periscope)",
        "make sure that the coast is clear", "check for (danger|traffic|enemies|spies) on both sides", "hunt for (a parking space|your glasses|the waiter) with your eyes", "cast about for (help|an idea|a way out)", "take stock of (the room|your surroundings)", "acquaint yourself with the room",
        "seek (somebody|the exit|your friend) in the crowd", "spy out the room", "do a (visual sweep|panorama|recce) of the room", "admire the (scenery|panorama) on all sides", "browse the (shelves|room) with your eyes",
        "rotate your head left and then right to (explore|examine) the room", "patrol the room with your eyes", "watch for (predators|hazards) like a (deer|meerkat)", "~a (survey|inspection|panorama|recce) of (the room|your surroundings)", "~a (wary|furtive|searching|cautious|nervous|watchful|bewildered) look around", "~a (gander|peep|squint) around the room",
        "~your eyes (rove|scour|explore|comb|rake) the room", "~your gaze (roves|travels|strays|flits) round the room", "~your head (swivels|pans|scans) like a (radar|lighthouse|security camera|periscope)", "~a tourist in a cathedral, looking everywhere", "~visual exploration of the surroundings",
    )), "head", ()),
    "roll_head": Family(_roll, Words((
        "roll your (head|neck) {n}", "(circle|rotate) your (head|neck) {n}", "make (a circle|circles) with your head {n}", "move your head in (a circle|circles) {n}",
        "do {N} (neck|head) rolls", "loosen your neck by rolling your head {n}", "turn your head in circles {n}", "stretch your neck in circles {n}",
        "draw {N} circles with your head", "roll your head (around|all the way round) {n}", "let your head circle on your neck {n}", "loosen up your neck {n}",
        "(circle|swirl|swing|turn|spin) (your|the) head (round and round|full circle|in a circle|all the way round|through a full circle) {n}", "(trace|draw|describe) (a circle|circles) with your (nose|chin|head) {n}", "do (a|the) (neck|head) (roll|circle|rotation) {n}", "perform {N} (neck|head) (rolls|circles|rotations)", "circumduct (the|your) neck {n}", "make your head go round {n}",
        "let your head roll (round|around|in a circle) {n}", "warm up your neck with (head circles|neck rolls) {n}", "relax your neck with (circles|head rolls) {n}", "move your (nose|chin) in (a circle|circles) {n}", "complete {N} (full |)circles with (your|the) head", "release the tension in your neck by rolling your head {n}", "ease your stiff neck with head rolls {n}", "roll (the|your) head from shoulder to chest to shoulder and back {n}",
        "~a (head|neck) (roll|circle|rotation) {n}", "~a roll of (the|your) (head|neck) {n}", "~{N} (head|neck) (rolls|circles|rotations)", "~{N} circles (of|with) (the|your) (head|neck)", "~your head (rolls|circles|goes round|goes round in a circle|moves in a circle|turns in circles) {n}", "~the (head|neck) (rolls|circles|goes round and round|rotates in a circle) {n}",
        "~head (rolling|circling|going round and round|round and round) {n}", "~(head|neck) (circles|rolls) {n}", "~a full circle (of|with) (the|your) head {n}", "~round and round with your head {n}", "~rolling (your|the) (head|neck) {n}", "~with your head, (make|draw) (a circle|circles) {n}",
        "(whirl|twirl|wheel|revolve) your head (round|round and round) {n}", "(orbit|loop) your head around your neck {n}", "limber up your neck with head circles {n}", "(unkink|unwind|mobilise|massage) your neck with slow head circles {n}", "stir the air with your (nose|crown) {n}", "(paint|sketch|outline) a (hoop|ring|wheel) with your (nose|chin|crown) {n}",
        "describe an (orbit|arc all the way round) with your head {n}", "work out the (kinks|knots|crick) in your neck with head circles {n}", "send your head round (in an orbit|on its orbit) {n}", "swivel your head round and round on your neck {n}", "swing your hair in a circle {n}", "whirl your hair round like a (rocker|metalhead|helicopter) {n}",
        "do a (neck circumduction|windmill headbang|circular neck stretch) {n}", "make your head (orbit|revolve|spin|rotate) {n}", "windmill your head {n}", "imagine that you are dizzy and ^circle your head {n}", "let your skull roll round on your spine {n}", "~a (circumduction|revolution|whirl|twirl|loop|orbit) of the (head|neck) {n}",
        "~{N} (revolutions|loops|orbits|turns in a circle|whirls) of the head", "~{N} neck circumductions", "~neck (mobility circles|mobilisation in circles|loosening circles) {n}", "~your (crown|nose) describes a (ring|hoop|loop) {n}", "~your head (revolves|orbits|whirls|travels round) on your neck {n}", "~a circular (movement|motion|neck stretch) of the head {n}",
        "~forward, sideways, back and sideways again with your head, in one sweep {n}", "~ear, chest, other ear, back: your head goes the whole way round {n}",
    )), "head", (), (1, 2)),
}  # fmt: skip
