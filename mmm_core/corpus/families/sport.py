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
        ("punch( forward| straight ahead| the air|) {n}", "jab {n}", "hit forward {n}", "throw (a punch|a jab)", "box {n}",
         "~a (quick|straight|hard|) punch", "~a (boxing |quick |)jab", "~{N} (straight |quick |)punches", "~{N} (jabs|boxing punches)", "~(punch|jab) (straight |)forward {n}",
         "~(boxing|punching|shadow boxing|jabbing) {n}", "~{N} blows at (a|the) (punchbag|punching bag|sandbag)", "hit the (punchbag|punching bag|heavy bag|sandbag) {n}",
         "sock someone in the (jaw|nose) {n}", "strike straight ahead {n}", "deliver (a straight punch|a jab|{N} straight punches)", "land (a punch|{N} punches|a straight punch)",
         "execute (a straight punch|{N} punches)",
         "(slug|biff|deck|bop) someone straight in the face {n}", "throw a boxing cross {n}", "let the (attacker|burglar) have it with a straight punch {n}",
         "~a (wallop|bash|poke) straight to the (nose|face|solar plexus)", "~{N} (knuckle strikes|fist blows|straight blows)"),
        one=("punch with your {S} fist {n}", "throw a {S} punch {n}", "throw {N} punches with your {S} arm", "hit forward with your {S} fist {n}", "give {N} {S} punches", "throw {N} {S} jabs",
         "~a {S} (jab|straight|punch)", "~your {S} fist (shoots|goes|flies|jabs) (straight |)forward {n}", "~{S} fist (straight |)forward {n}", "~{S} (jab|punch) {n}", "~{N} {S} (jabs|punches)",
         "~a (jab|punch|straight blow) with (your|the) {S} fist", "drive your {S} fist (straight |)forward {n}", "jab (straight ahead |)with your {S} fist {n}",
         "let your {S} fist fly (forward|straight ahead) {n}", "shoot your {S} fist out in front of you {n}", "extend the {S} fist sharply to the front {n}",
         "(ram|snap|spear|slam) your {S} (fist|knuckles) straight out {n}", "hit the (pad|target|focus mitt) with a {S} straight {n}", "slug the (air|opponent) with a {S} straight {n}",
         "~your {S} elbow (extends|straightens) explosively, fist first {n}", "~your {S} knuckles (slam|crash|smash) straight into the pad {n}", "~a lightning {S} jab"),
        both=("punch with alternating fists {n}", "throw {N} punches with both hands", "do some boxing", "box with both fists {n}", "punch left and right {n}", "shadow-box {n}",
         "~(boxing|shadow boxing|punching) with both fists {n}", "~fists (flying|punching) (forward|straight ahead) {n}", "~both fists (punching|boxing) {n}",
         "~a (one-two|boxing combination|flurry of punches)", "~{N} punches with both fists", "spar (with an invisible opponent|in the air) {n}", "box like (a champion|Muhammad Ali|Rocky) {n}",
         "act like a (boxer|prize fighter) {n}", "put up your dukes and ^box {n}", "work the (punchbag|punching bag|speed bag) with both fists {n}",
         "pummel (the heavy bag|a sandbag|an invisible foe) {n}", "unleash a (barrage|volley|salvo) of straight punches {n}", "~a (barrage|volley|salvo) of straight punches with both fists",
         "~a pugilist (in training|in the ring)"),
        alternating=("punch with alternating fists {n}", "box left and right {n}", "throw {N} alternating punches",
         "~left jab, right jab {n}", "~{N} punches left and right", "~(jabs|punches) left and right in turn {n}", "~left fist, right fist, (punching|jabbing) {n}",
         "jab with one fist and then the other {n}", "rain punches left and right {n}",
         "pummel the bag, left and right in turn {n}", "~(piston-like|machine-gun) jabs left and right {n}")), sides=ALL, counts=(1, 2)),
    "hook": Family(_strike("hook"), Words(
        ("throw a hook", "throw {N} hooks", "punch from the side {n}", "swing a hook {n}", "box with a hook {n}", "hook {n}",
         "~a (boxing |nasty |swinging |)hook", "~{N} (boxing |)hooks", "~a (curved|roundhouse) punch", "~a punch from the side", "~{N} (roundhouse|curved|swinging) punches", "~a haymaker",
         "~{N} haymakers", "throw a (haymaker|roundhouse punch) {n}", "deliver (a hook|{N} hooks)", "land (a hook|{N} hooks)", "box in a curve {n}", "swing a punch from the side {n}",
         "take a swing at (someone|a punchbag) {n}", "hit (an opponent|a punchbag|the punching bag) from the side {n}",
         "(clip|slug|clout|wallop|belt) someone (on|round) the ear {n}", "loop a punch (at the temple|around the guard) {n}", "~a (looping|sweeping|sideways|crescent) punch",
         "~{N} (looping|sweeping|swiping) punches", "~a (clout|wallop) (to the temple|on the ear)"),
        one=("throw a {S} hook {n}", "throw {N} {S} hooks", "punch in a curve with your {S} fist {n}", "land a {S} hook {n}", "hit from the side with your {S} fist {n}",
         "~a {S} (hook|haymaker|roundhouse)", "~{N} {S} hooks", "~{S} hook {n}", "~your {S} fist (swings|comes|flies|hits) in from the side {n}", "~{S} fist in from the side {n}",
         "~the {S} fist (swings|strikes) (round |)in a curve {n}", "~a (hook|curved punch) with (your|the) {S} fist", "swing your {S} fist (in from the side|in an arc|in a curve) {n}",
         "drive your {S} fist in from the side {n}", "bring your {S} fist round in a hook {n}", "punch across with a bent {S} arm {n}",
         "arc your {S} (fist|knuckles) inward at jaw height {n}", "whip your bent {S} arm across to the (temple|jaw|cheek) {n}", "clobber the bag from the side with your {S} fist {n}",
         "loop your {S} fist around the guard of the opponent {n}", "~{S} elbow crooked at shoulder level, the fist (whipping|looping) inward {n}", "~a {S} clout (to the ear|on the temple)",
         "~{N} {S} (clouts to the ear|looping punches)"),
        alternating=("throw left and right hooks {n}",
         "~left hook, right hook {n}", "~{N} hooks left and right", "~(hooks|roundhouse punches) (left and right|from both sides) {n}", "throw hooks from both sides {n}",
         "swing hooks left and right {n}",
         "clout the bag from both sides in turn {n}", "~looping punches left and right {n}")), sides=(*ONE, "alternating"), counts=(1, 2)),
    "uppercut": Family(_strike("uppercut"), Words(
        ("throw an (uppercut|upper cut)", "punch upwards {n}", "throw {N} (uppercuts|upper cuts)", "hit upwards {n}", "box upwards {n}",
         "~an (uppercut|upper cut)", "~{N} (uppercuts|upper cuts)", "~a punch (upwards|from below|under the chin)", "~{N} punches (upwards|from below)", "~a blow (to|under) the chin from below",
         "deliver (an uppercut|{N} uppercuts)", "land (an uppercut|{N} uppercuts)", "punch (someone|an opponent|a giant) under the chin {n}", "box from below {n}", "hit the chin from below {n}",
         "drive a punch up from below {n}", "execute (an uppercut|{N} uppercuts)",
         "(sock|slug|clip|clout) someone under the jaw from below {n}", "rip a punch up into the (jaw|ribs) {n}", "send the opponent flying with an uppercut {n}",
         "~a (rising|ascending|scooping|upward) punch", "~{N} (rising|ascending|scooping) punches", "~a shoryuken {n}"),
        one=("throw a {S} (uppercut|upper cut) {n}", "throw {N} {S} uppercuts", "punch upwards with your {S} fist {n}", "hit from below with your {S} fist {n}", "land a {S} uppercut {n}",
         "~a {S} (uppercut|upper cut)", "~{N} {S} uppercuts", "~{S} uppercut {n}", "~your {S} fist (shoots|comes|punches|drives) up from below {n}",
         "~the {S} fist (punches|strikes|hits) (up|upwards) {n}", "~{S} fist up under the chin {n}", "~an uppercut with (your|the) {S} fist",
         "drive your {S} fist (up from below|up under the chin|upwards) {n}", "swing your {S} fist up (from below|under an imaginary chin) {n}", "scoop your {S} fist up in a punch {n}",
         "bring a {S} punch up from the hip {n}",
         "rip your {S} fist up into the (jaw|ribs) {n}", "dig your {S} fist upwards under the ribcage {n}", "shovel your {S} (fist|knuckles) upwards {n}",
         "launch your {S} fist skyward under the chin {n}", "~your {S} fist (rockets|surges|rips|rises) from the waist to the chin {n}", "~a rising {S} (punch|blow)",
         "~{N} rising {S} (punches|blows)", "~{S} elbow bent, fist (scooping|ripping|rising) upwards {n}"),
        alternating=("throw left and right uppercuts {n}",
         "~left uppercut, right uppercut {n}", "~{N} uppercuts left and right", "~(uppercuts|punches from below) left and right {n}", "throw uppercuts with both fists in turn {n}",
         "punch upwards left and right {n}",
         "rip punches upwards, left and right {n}", "~rising blows from below, left and right in turn {n}")), sides=(*ONE, "alternating"), counts=(1, 2)),
    "throw": Family(_throw(ArmPose((0.75, 0.2, -0.35), (0.1, 0.9, -0.4)), ArmPose((0.35, 0.3, 0.85), (0.05, 0.55, 0.85)), ArmPose((0.0, -0.6, 0.8), (-0.35, -0.75, 0.6))), Words(
        ("throw (a ball|a ball overarm|something|a stone|a baseball|it away|a snowball) {n}", "pitch (a ball|a baseball) {n}", "toss (a ball|something) (away |forward |){n}", "hurl (a stone|a spear) {n}", "fling something (away|forward) {n}", "make {N} throws", "bowl a cricket ball {n}",
         "~a (long |hard |good |)throw", "~an (overarm|overhand) throw", "~{N} (overarm |overhand |long |)throws", "~a (baseball|fast) pitch", "~{N} (overarm|baseball) pitches", "~a javelin throw",
         "~(ball|stone|snowball) throwing {n}", "~{N} (stone|ball|snowball|javelin) throws", "chuck (a stone|a ball|it away|a snowball) {n}",
         "throw (a javelin|a dart|the ball overhand|a grenade|a stick for the dog|a paper plane) {n}", "launch a paper plane {n}", "cast (a stone|a fishing line) {n}",
         "let fly with a (stone|snowball) {n}", "play (darts|dodgeball) {n}", "have a snowball fight", "pitch (a fastball|a curveball) {n}",
         "(heave|bung|sling|shy|zing) a (rock|pebble|boomerang) {n}", "throw a (touchdown pass|boomerang|harpoon|tomahawk|rock) {n}",
         "pelt the (wall|target) with (snowballs|tomatoes|rotten eggs) {n}", "bombard the (fort|enemy) with snowballs {n}", "play quarterback and ^throw a long pass {n}",
         "~a (hurl|fling|heave) of the (ball|stone|rock)", "~{N} (hurls|javelin casts|overarm flings)", "~a (quarterback's pass|fastball|spear cast)"),
        one=("~your {S} (arm|hand) (throws|hurls|flings|pitches) a (ball|stone) {n}", "~an (overarm|overhand) throw from the {S} shoulder", "~{S}-(handed|arm) (throw|overarm throw) {n}",
         "~{S} arm back, then (a throw|throw) {n}", "~throwing with the {S} (arm|hand) {n}", "~the {S} arm swings back and throws {n}", "(draw|take) your {S} arm back and ^throw {n}",
         "wind up your {S} arm and ^throw {n}", "(whip|sling) your {S} arm forward to throw a (ball|spear) {n}",
         "cock your {S} arm behind your (head|ear) and ^fling a ball {n}", "catapult a (stone|ball) with your {S} arm {n}", "bung it away with your {S} hand {n}",
         "let the (harpoon|tomahawk|spear) fly from your {S} hand {n}", "~{S} elbow (cocked|high), snapping forward to launch the ball {n}",
         "~a (javelin|spear|fastball) (launch|heave) with the {S} arm", "~your {S} arm (catapults|whips|lashes) forward over the shoulder and lets the ball go {n}")), sides=ONE, counts=(1,)),
    "throw_low": Family(_throw(ArmPose((0.3, -0.75, -0.6), (0.15, -0.8, -0.55)), ArmPose((0.12, -0.75, 0.65), (0.05, -0.5, 0.85), 1.0), ArmPose((0.12, -0.1, 1.0), (0.05, 0.45, 0.9), 1.0)), Words(
        ("throw (a ball |something |)underarm {n}", "roll a (ball|bowling ball) {n}", "go bowling", "bowl (a strike|) {n}", "toss (a ball|it) (up from below|underhand) {n}", "pitch (underhand|underarm) {n}", "swing your arm from below to throw {n}", "play skittles", "throw a frisbee from below {n}", "play boules",
         "~an (underarm|underhand) (throw|toss|pitch)", "~{N} (underarm|underhand) (throws|tosses|pitches)", "~a (throw|toss) from below",
         "~(bowling|skittles|ninepins|tenpin bowling|lawn bowls) {n}", "~a (softball|horseshoe) pitch", "~{N} rolls of the (bowling |)ball", "~(underarm|underhand) throwing {n}",
         "play (bowls|boccia|petanque|ninepins|tenpin bowling)", "roll the ball (down the alley|down the lane|at the skittles|along the floor) {n}",
         "bowl down (the pins|all ten pins|the skittles) {n}", "lob (a ball |it |)underarm {n}", "pitch (a horseshoe|a softball) {n}", "send the bowling ball rolling {n}",
         "toss me (the keys|the ball) from below {n}", "throw low from the hip {n}",
         "trundle the ball towards the (pins|skittles) {n}", "knock the pins over with a bowling ball {n}", "play (bocce|cornhole|horseshoes|duckpins|quoits) {n}",
         "toss the (beanbag|ring) underhand {n}", "aim for a strike at the bowling alley {n}", "serve up an underhand pitch for the batter {n}", "~a (bocce|petanque|duckpin) throw",
         "~{N} (underarm lobs|underhand flips)", "~an underarm lob from (hip|knee) height"),
        one=("~your {S} (arm|hand) swings up from below and (throws|lets go) {n}", "~{S}-handed (underarm|underhand) (throw|toss) {n}", "~{S} arm (swinging|throwing) from below {n}",
         "~the {S} hand (rolls|bowls) a ball along the floor {n}", "~a bowling throw with the {S} arm", "swing your {S} arm (back and |)forward from the hip to bowl {n}",
         "let a bowling ball roll out of your {S} hand {n}", "scoop your {S} arm forward to throw from below {n}",
         "let your {S} arm swing low past the thigh and ^release the ball {n}", "loft a ball up from below with your {S} hand {n}", "trundle a bowling ball with your {S} hand {n}",
         "~{S} arm brushing the (thigh|hip), ball released at knee height {n}", "~an (underhand|underarm) (lob|flip|delivery) (with|from) the {S} hand", "~{N} {S}-handed underarm lobs")), sides=ONE, counts=(1,)),
    "catch": Family(_catch, Words(
        ("catch (a ball|the ball|something|it|a beach ball) {n}", "reach out and ^catch (a ball|the ball) {n}", "play catch {n}", "receive a (pass|ball) {n}", "grab (a ball out of the air|something from the air) {n}", "make {N} catches", "save the ball like a goalkeeper", "catch what I throw {n}",
         "~a (good |clean |safe |quick |)catch", "~{N} (clean |safe |)catches", "~a catch of the ball", "~ball catching {n}", "~a goalkeeper's save",
         "snatch (the ball|it|a ball) (from|out of) the air {n}", "intercept (the ball|a pass) {n}", "make a (catch|save)", "stop a flying ball {n}", "(snag|nab|collect) the flying ball {n}",
         "wait for the ball and ^catch it {n}", "get hold of a flying ball {n}", "catch (the keys|an egg|a fly|a butterfly|a frisbee|a flying ball) {n}",
         "take a catch (like a cricketer|at the boundary)",
         "field the (ball|fly ball) {n}", "(seize|clutch|secure) the flying (ball|frisbee) {n}", "pluck (a ball|an apple|a mosquito) out of the air {n}",
         "catch (the bride's bouquet|a falling vase|a mosquito|a parcel) {n}", "~a (grab|snatch|interception|reception) of the flying ball",
         "~{N} (interceptions|grabs in mid-air|snatches out of the air)", "~a (fielder|goalie|wicketkeeper|outfielder) catching the ball"),
        one=("~your {S} hand (catches|snatches|grabs) (a|the) ball( in the air| out of the air|) {n}", "~{S}-handed catch {n}", "~{N} {S}-handed catches", "~{S} hand out to catch (a|the) ball {n}",
         "~a catch in (your|the) {S} hand", "(stretch|put) out your {S} hand and ^catch the ball {n}", "snap your {S} hand shut on a flying ball {n}", "let the ball land in your {S} hand {n}",
         "pluck the ball from the air with your {S} hand {n}", "shoot out your {S} hand to intercept the ball and ^draw it in {n}", "cushion the flying ball in your {S} (palm|mitt|glove) {n}",
         "~your {S} hand (plucks|seizes|traps) the ball out of mid-air {n}", "~ball into the {S} (palm|glove|mitt), fingers closing {n}"),
        both=("~both hands (catch|grab|receive|snatch) (a|the) ball {n}", "~both hands out to catch (a|the) ball {n}", "~a two-handed catch", "~{N} two-handed catches",
         "cup your hands and ^catch the ball {n}", "catch the ball and ^bring it to your chest {n}",
         "cradle the (incoming|falling) ball in both hands {n}", "absorb the incoming ball with both hands {n}", "~both hands (cradle|seize|cushion) the incoming ball {n}",
         "~a safe grab of the ball with both (palms|mitts)")), sides=ANY, counts=(1,)),
    "archery": Family(_archery, Words(
        ("shoot (an arrow|a bow|with a bow and arrow) {n}", "draw (a bow|the bow) {n}", "pull a bow string {n}", "act like (an archer|Robin Hood)", "practise archery {n}", "fire an arrow {n}", "aim (a|with a) bow {n}", "do archery", "be an archer", "shoot {N} arrows",
         "~an archer (drawing|aiming) a bow", "~(archery|archery practice|bow shooting) {n}", "~bow and arrow {n}", "~{N} (arrows shot with a bow|bow shots|shots with the bow)",
         "~a shot with (a|the|your) bow( and arrow|)", "~bow in one hand, the other (draws|pulls|pulling) the string {n}", "~bow arm out, the other hand pulling the string back {n}",
         "~Robin Hood (with his bow|drawing his bow|shooting an arrow)", "~bow drawn, arrow on the string", "~bowstring back to the cheek {n}",
         "~the bow is (drawn|stretched) and the arrow flies {n}", "loose (an|your) arrow {n}", "let an arrow fly {n}", "release an arrow from (a|your) bow {n}",
         "nock an arrow and ^(draw|shoot) {n}", "pull (back |)the bowstring {n}", "hit the bullseye with an arrow {n}", "play (Robin Hood|Cupid) with bow and arrow", "stretch a (longbow|bow) {n}",
         "take aim with (a longbow|a bow|bow and arrow)", "shoot arrows like (an elf|Cupid|Robin Hood) {n}",
         "twang the bowstring {n}", "tense (a|the) (bow|longbow) {n}", "fit an arrow to the string and ^loose it {n}", "bend a (yew|recurve) bow {n}", "aim an arrow at the (deer|apple|target) {n}",
         "take an arrow from your quiver and ^shoot it {n}", "pierce the (apple|target) with an arrow {n}", "hunt (deer|boar) with bow and arrow {n}",
         "be (Legolas|Katniss|Hawkeye|a bowman|Artemis)( with the bow|)", "~a (bowman|longbowman|huntress|centaur) drawing the bow",
         "~{N} (full draws of the bow|releases of the bowstring|twangs of the bowstring)", "~a full draw of the (recurve|longbow)",
         "~one arm rigid to the side with the bow, the other hauling the string to the (ear|jaw) {n}", "~the bow is (bent|tensed), the string twangs {n}")), sides=BOTH, counts=(1,), holds=True),
    "sword": Family(strokes(ArmPose((0.5, 0.6, 0.5), (0.1, 0.85, -0.35)), ArmPose((0.05, -0.3, 0.95), (-0.25, -0.4, 0.9)), 0.8, 0.45), Words(
        ("swing (a sword|your sword) {n}", "cut with a sword {n}", "fight with a (sword|lightsaber|light sabre) {n}", "slash (down |)with a (sword|blade) {n}", "chop (wood|down|with an axe) {n}", "act like a (knight|samurai|swordsman) {n}", "swing an axe {n}", "make {N} (chops|slashes)",
         "~a sword (stroke|cut|slash|swing|blow)", "~{N} sword (strokes|cuts|slashes|swings|blows)", "~an axe (blow|swing|stroke)", "~{N} (axe blows|swings of the axe|swings of the sword)",
         "~(swordplay|sword fighting) {n}", "~(wood chopping|log splitting) {n}", "~a (swing|sweep|slash) of the (sword|blade|lightsaber|axe)",
         "swing a (katana|sabre|scimitar|cutlass|machete|broadsword|hatchet) {n}", "wield (a|your) (sword|blade|axe|lightsaber) {n}", "slay (a|the) dragon {n}", "split (logs|firewood|a log) {n}",
         "fell a tree {n}", "hack at (a|the) (tree|bush|jungle) {n}", "cleave (the air|a helmet|a log) {n}", "duel like (a pirate|a musketeer|Zorro) {n}",
         "fight like a (pirate|Jedi|gladiator|musketeer) {n}",
         "hew (wood|timber|logs) {n}", "smite the (foe|ogre|dragon) with your sword {n}", "lop off branches with a (machete|sword|hatchet) {n}",
         "(behead|decapitate) the (dragon|hydra) with a sword {n}", "swing a (claymore|tomahawk|battleaxe|cleaver|glaive) {n}", "clear the (undergrowth|brambles) with a machete {n}",
         "~a (hack|swipe) with the (cutlass|machete|claymore)", "~{N} (hacks|swipes) with the (blade|hatchet|claymore)", "~a (Viking|lumberjack|woodcutter) swinging an axe",
         "~a (swashbuckler|crusader|ninja|ronin) swinging a sword"),
        one=("~your {S} (arm|hand) swings (a|the) (sword|blade|axe) {n}", "~sword in the {S} hand, (strike|swing|slash) {n}", "~{S} arm (bringing|swinging) the sword down {n}",
         "~a sword (stroke|cut) from the {S} arm", "bring (the|your) sword down with your {S} arm {n}", "strike with the sword in your {S} hand {n}",
         "cut through the air with the blade in your {S} hand {n}",
         "hew at the (foe|trunk) with the axe in your {S} hand {n}", "smite with the blade in your {S} hand {n}", "~your {S} arm (cleaves|hews|slices) the air with a blade {n}",
         "~{S} arm high behind the ear, then a (downward|diagonal) cut of the sword {n}"),
        both=("~a two-handed (sword|axe) (stroke|swing|blow)", "~both hands on the (sword|axe), (swing|strike) {n}", "~both arms bring the (sword|axe) down {n}",
         "grip the (sword|axe) with both hands and ^strike {n}",
         "hew wood with both hands on the axe {n}", "~a lumberjack's two-handed (chop|stroke|swing)", "smite the foe with a two-handed claymore {n}")), sides=ANY, counts=(1, 2)),
    "karate_chop": Family(strokes(ArmPose((0.75, -0.1, 0.5), (-0.55, 0.75, 0.35), 0.3), ArmPose((0.55, -0.45, 0.7), (0.25, -0.2, 0.95), 0.0), 0.75, 0.42), Words(
        ("(do|give|make) a karate chop {n}", "chop the air {n}", "fight like a karate fighter {n}", "chop (a board|a brick|bricks) {n}", "do {N} karate chops", "hit with the edge of your hand {n}", "practise karate chops {n}", "act like a (kung fu|karate) master {n}",
         "~a (karate |judo |kung fu |)chop", "~{N} (karate |judo |kung fu |)chops", "~a (knife-hand|knife hand) strike", "~{N} knife-hand strikes", "~karate {n}", "~karate chops {n}",
         "do karate chops( in the air| on a board| on a brick|) {n}", "break (a board|a brick|a plank|the tiles|bricks) karate style {n}", "smash a (brick|board) like a karate master {n}",
         "execute a (knife-hand strike|karate chop) {n}", "deliver a karate chop {n}", "strike like Bruce Lee {n}", "do (karate|kung fu) {n}", "perform a knife-hand strike {n}",
         "crack a (tile|slab|roof tile) karate style {n}", "split a watermelon with a karate chop {n}", "fell your opponent with a (judo|karate) chop {n}",
         "disable the guard with a karate chop to the neck {n}", "~a (shuto|tegatana|ninja chop)", "~{N} (shuto strikes|hand-edge blows|ninja chops)",
         "~a (ninja|black belt|sensei) (breaking|cracking) a (board|brick)"),
        one=("~your {S} hand chops (down|through the air) {n}", "~{S}-hand (karate |)chop {n}", "~the edge of your {S} hand (strikes|chops|hits) (down|a board|a brick) {n}",
         "~a (blow|strike|hit) with the edge of your {S} hand", "~{N} (chops|strikes) with the edge of your {S} hand", "~{S} hand chopping (down|like an axe) {n}",
         "chop with (the edge of |)your {S} hand {n}", "strike (a board |)with the edge of your {S} hand {n}", "bring the edge of your {S} hand down( on a board| on a brick|) {n}",
         "slice the air with the (rigid|stiff) edge of your {S} hand {n}", "strike downward with the pinkie edge of the {S} hand {n}", "use your {S} hand as a (cleaver|hatchet) {n}",
         "deliver a {S}-handed (shuto|ninja chop) {n}", "snap the edge of your {S} hand outward and down {n}", "~your {S} (little-finger|pinkie) side (hits|cracks) the (plank|tile) {n}",
         "~{S} hand stiff as a (blade|cleaver), coming down sharply {n}", "~a diagonal slice of the {S} hand edge", "~a {S} (shuto|ninja chop)")), sides=ONE, counts=(1, 2)),
    "swim_crawl": Family(loops(_crawl, 1.5, ELBOW_OUT, offset=0.5), Words(
        ("swim( freestyle| front crawl| the crawl| forward|) {n}", "do the (front |)crawl {n}", "pretend to swim {n}", "swim with your arms {n}", "make {N} (crawl|swimming) strokes", "move your arms like a swimmer {n}", "swim in the air {n}", "crawl through the water {n}", "do {N} freestyle strokes", "act like a swimmer {n}",
         "~(front crawl|freestyle|the crawl|crawl stroke|freestyle swimming) {n}", "~{N} (front crawl|crawl|freestyle|swimming|swim) strokes", "~a (length|lap) of (front crawl|freestyle|crawl)",
         "~a few strokes of (front crawl|freestyle|crawl)", "~arms (swimming|doing the crawl|in front crawl|going like a swimmer's) {n}",
         "~your arms (swim|do the crawl|go over and forward in turn like a swimmer's) {n}", "~arms over and forward one after the other, swimming {n}",
         "~swimming (freestyle|forward|through the air) {n}", "~crawl arms {n}", "~a freestyle swimmer (in the pool|at full stroke)", "swim (a length|a lap|across the pool|to the shore|for your life|like a shark) {n}",
         "do (freestyle|front crawl|crawl) arms {n}", "go for a swim", "do a few lengths of (crawl|freestyle)", "reach over and ^pull through the water, one arm after the other {n}",
         "practise (your |)(front crawl|freestyle) {n}", "bring your arms over and forward one by one as in the crawl {n}", "perform (front crawl arms|a front crawl) {n}",
         "splash through the pool (with the crawl|in freestyle) {n}", "be a freestyle swimmer",
         "(plough|surge|power) through the (waves|sea|lake) in freestyle {n}", "do the (Australian crawl|trudgen) {n}", "swim (the English Channel|out to the buoy|laps|against the current) {n}",
         "dig into the water hand over hand {n}", "stroke through the (waves|lake) hand over hand {n}", "scoop the water back with alternate overarm strokes {n}",
         "race down the lane in freestyle {n}", "rotate your arms forward alternately through the water {n}", "~a (triathlete|lifeguard|Olympian) doing front crawl",
         "~{N} (arm pulls of the front crawl|freestyle pulls|overarm strokes in the water)", "~the Australian crawl {n}", "~arms (arcing|reaching) over the water by turns {n}",
         "~recovery over the surface, pull underwater, arm by arm {n}")), sides=BOTH, counts=(2, 3)),
    "swim_back": Family(loops(lambda p: _crawl(-p), 1.5, ELBOW_OUT, offset=0.5), Words(
        ("swim (backstroke|on your back|backwards) {n}", "do the backstroke {n}", "make {N} backstrokes", "pretend to swim on your back {n}", "move your arms like in backstroke {n}", "do {N} backstroke strokes", "swim the backstroke {n}", "turn your arms backwards one after the other {n}", "windmill your arms backwards {n}", "row yourself backwards through the water {n}",
         "~(backstroke|the backstroke|back crawl|backstroke swimming) {n}", "~{N} (backstrokes|back crawl strokes)", "~a (length|lap) of (backstroke|back crawl)",
         "~a few strokes of backstroke", "~arms (in backstroke|doing the backstroke|swimming backwards|wheeling backwards in turn) {n}",
         "~your arms (swim backwards|do the backstroke|go up and back in turn as in backstroke) {n}", "~swimming (on your back|backwards) {n}", "~backstroke arms {n}",
         "~arms up and back one after the other, swimming {n}", "~a backstroke swimmer (in the pool|at full stroke)", "do (backstroke|back crawl) arms {n}", "do the back crawl {n}", "lie on your back and ^swim {n}",
         "practise (your |)backstroke {n}", "reach up and back with one arm after the other {n}", "perform (the|a) (backstroke|back crawl) {n}", "swim (a length of backstroke|belly up|face up) {n}",
         "bring your arms over backwards one by one like a swimmer {n}", "wheel your arms backwards in turn {n}",
         "float on your back and ^stroke with alternate arms {n}", "backstroke across the (pool|lake) {n}", "swim (facing the sky|supine|with your belly to the sky) {n}",
         "scoop the water overhead and behind you with alternate arms {n}", "paddle supine across the (lake|lagoon) {n}", "stroke through the water lying face up {n}",
         "rotate your arms backwards alternately through the water {n}", "practise the supine crawl {n}", "~{N} (supine strokes|backstroke cycles|pulls of the back crawl)", "~a supine crawl {n}",
         "~reverse freestyle {n}", "~a backstroker (in lane four|at the Olympics)", "~alternate arms (arcing|sweeping) up past the ears and behind, face to the sky {n}")), sides=BOTH, counts=(2, 3)),
    "swim_breast": Family(loops(_breast, 1.5, ELBOW_OUT, -0.6), Words(
        ("swim (breaststroke|the breaststroke|like a frog) {n}", "do the breaststroke {n}", "make {N} (breaststrokes|breast strokes)", "part the water with both hands {n}", "move your arms like in breaststroke {n}", "swim with both arms together {n}", "push the water apart {n}", "pretend to do breaststroke {n}", "part the curtains {n}", "swim calmly on your front {n}",
         "~(breaststroke|the breaststroke|breaststroke swimming|frog swimming) {n}", "~{N} (breaststrokes|frog strokes)", "~a (length|lap) of breaststroke",
         "~a few strokes of breaststroke", "~arms (in breaststroke|doing the breaststroke|parting the water) {n}", "~your arms (part the water|do the breaststroke|swim like a frog's) {n}",
         "~both hands forward, outward and back, (swimming|like a frog) {n}", "~hands together, out and round as in breaststroke {n}", "~breaststroke arms {n}", "~swimming like a frog {n}",
         "~a breaststroke swimmer (in the pool|at full stroke)", "do (breaststroke|frog) arms {n}", "swim (frog style|a length of breaststroke|with your head above the water) {n}", "practise (your |)breaststroke {n}",
         "reach forward and ^sweep both arms outward in the water {n}", "push your hands forward together and ^part the water {n}", "perform (the |)breaststroke {n}",
         "clear a path through the water with both arms {n}", "paddle like a frog {n}",
         "(glide|bob) along in breaststroke {n}", "swim like a (toad|granny keeping her hair dry) {n}", "draw both hands apart through the water {n}",
         "spread the (waves|reeds|water lilies) with both hands {n}", "open the (drapes|stage curtain) wide with both hands {n}", "brush aside the (reeds|undergrowth|tall grass) with both arms {n}",
         "do (symmetrical|simultaneous) swimming strokes with both arms {n}", "pull the water apart in a heart shape {n}", "~{N} (froggy strokes|breaststroke pulls|outward sweeps through the water)",
         "~a (froggy|toad-like|granny) swimming stroke", "~both palms (scooping|sweeping|pressing) the water apart {n}", "~symmetrical arm sweeps out and back in the water {n}",
         "~hands gliding forward, then spreading outward in the pool {n}", "~a breaststroker (in the lake|doing laps)")), sides=BOTH, counts=(2, 3)),
    "march_arms": Family(_swing_arms(ArmPose((0.15, -0.55, 0.8), (0.05, -0.3, 0.95)), ArmPose((0.18, -0.88, -0.4), (0.12, -0.9, -0.3)), 1.05), Words(
        ("march (with your arms|like a soldier|with swinging arms|on the spot with your arms) {n}", "swing your arms (as if marching|as if walking|back and forth|like a soldier) {n}", "move your arms as if (walking|marching) {n}", "march your arms {n}", "parade with your arms {n}", "do marching arms {n}", "swing both arms to and fro {n}",
         "~arms (marching|swinging as in marching|swinging like a soldier's|swinging as in walking) {n}", "~(marching|parade|walking) arms {n}",
         "~your arms (swing|move) (like a soldier's|as on parade|back and forth in turn|as in a march|as when walking) {n}", "~{N} (marching|parade|military) arm swings", "~a soldier on parade",
         "~a (military|soldier's) march with the arms", "~alternating arm swings (back and forth|at your sides|as in walking) {n}", "~arms forward and back by your sides, (marching|walking) {n}",
         "~an arm swing as (in walking|in marching|on parade)", "~marching on the spot with the arms {n}", "swing your arms (by your sides|in step|like a toy soldier|in marching time) {n}",
         "march like a (toy soldier|guardsman|tin soldier|drum major)( on the spot|) {n}", "march (in place|up and down on the spot) {n}", "stride with your arms {n}",
         "walk with your arms( only|) {n}", "parade like the royal guard {n}", "mark time like a soldier {n}", "perform (reciprocal|alternating) arm swings {n}",
         "alternate your arms forward and back at your sides {n}", "go for a (walk|stroll|march) with your arms {n}",
         "(tramp|hike|troop|trudge) along with swinging arms {n}", "(stroll|amble|saunter|promenade) with swinging arms {n}", "step out smartly like a (cadet|sergeant|grenadier|legionnaire) {n}",
         "do (foot drill|square-bashing) {n}", "quick-march on the spot {n}", "let your arms swing like pendulums as in walking {n}",
         "join the (brass band|regiment|procession) with marching arms {n}", "~a (cadet|grenadier|legionnaire|recruit) marching",
         "~{N} (strides with swinging arms|walking swings of the arms|pendulum swings of the arms as in walking)", "~the long arms hanging and swinging in opposition at the hips {n}",
         "~a (ramble|hike|stroll|promenade) with swinging arms {n}", "~left, right, left, right, quick march {n}", "~a (pedestrian|wanderer|hiker) with swinging arms")), sides=BOTH, counts=(3, 4)),
    "run_arms": Family(_swing_arms(ArmPose((0.15, -0.85, 0.5), (-0.25, 0.6, 0.75)), ArmPose((0.25, -0.75, -0.6), (-0.05, -0.05, 1.0)), 0.62), Words(
        ("(pump|swing|move) your arms (as if running|like a runner|like a sprinter|like a jogger) {n}", "run with your arms( only|) {n}", "do running arms {n}", "pretend to run with your arms {n}", "sprint with your arms {n}", "jog with your arms {n}", "act like a runner without moving your legs {n}", "pump your arms {n}",
         "~(running|sprinting|jogging) arms {n}", "~arms (running|sprinting|jogging|pumping like a runner's|pumping as in a sprint) {n}",
         "~(running|jogging|sprinting) on the spot with the arms( only|) {n}", "~your arms (run|sprint|jog|pump like pistons|pump as in running) {n}",
         "~bent arms (swinging|pumping) back and forth {n}", "~elbows bent, arms (pumping|running|going like pistons) {n}", "~a (sprint|jog|run) with the arms( only|)",
         "~a (runner|sprinter|jogger) on the spot", "~the arms of a (runner|sprinter|jogger) {n}", "run (on the spot|in place|a race|a marathon|for the bus) {n}", "jog (on the spot|in place) {n}",
         "sprint (on the spot|for the finish line) {n}", "race like a sprinter {n}", "drive your (elbows|arms) back and forth like a sprinter {n}",
         "swing your bent arms (as in running|like a runner|at a run) {n}", "chug your arms like a (steam |)train {n}", "move your arms like (pistons|Usain Bolt|a steam engine) {n}",
         "do a (runner's|sprinter's) arm drill {n}", "go for a (run|jog) with your arms {n}", "play trains with your arms {n}",
         "(dash|bolt|gallop|trot|scamper) on the spot {n}", "flee from the (bear|monster|wolf) with pumping arms {n}", "leg it for the train {n}", "run on the treadmill with your arms {n}",
         "work your elbows like (connecting rods|a locomotive) {n}", "chuff like a locomotive {n}", "hurtle along with pumping arms {n}",
         "practise the arm action of a (hundred-metre dash|hurdler) {n}", "~a (dash|trot|gallop) with the arms {n}",
         "~{N} (arm drives of a sprinter|piston strokes of the arms|running strokes of the arms)", "~an athlete (on the treadmill|in the hundred metres|on the home straight)",
         "~choo choo, arms like a locomotive {n}", "~right-angled elbows (driving|shuttling) past the ribs in turn {n}", "~fists shuttling between hip and chin in turn, as in a dash {n}")), sides=BOTH, counts=(3, 4)),
    "row": Family(strokes(ArmPose((0.15, -0.35, 0.95), (0.0, -0.05, 1.0), -0.6), ArmPose((0.35, -0.65, -0.4), (-0.05, 0.2, 0.95), -0.6), 1.2), Words(
        ("row( a boat| the boat| with both arms| like a rower|) {n}", "pull the oars {n}", "pretend to row a boat {n}", "make {N} rowing strokes", "paddle a (boat|rowing boat) {n}", "work on a rowing machine {n}", "row across the lake {n}", "act like a rower {n}", "do {N} rows", "exercise with the oars {n}",
         "~(rowing|rowing a boat|rowing machine) {n}", "~{N} (rowing strokes|strokes with the oars|pulls on the oars|seated rows)", "~a (rowing stroke|stroke at the oars|pull on the oars)",
         "~both (hands|arms) (pull|work|pulling) the oars {n}", "~your arms (row|pull the oars|row a boat) {n}", "~arms rowing {n}", "~row row row your boat {n}", "~oars forward and back {n}",
         "~a rower (in a boat|at the oars)", "~both elbows pull back as in rowing {n}", "row (the boat ashore|your boat|gently down the stream|upstream|like a galley slave|to the island) {n}",
         "ply the oars {n}", "man the oars {n}", "do seated rows {n}", "heave on the oars {n}", "scull( a boat|) {n}", "use the (rowing machine|ergometer|oars) {n}",
         "take (the|to the) oars and ^row {n}", "pull both elbows back as if rowing {n}", "train for the boat race {n}",
         "(tug|haul|strain) at the oars {n}", "pull for the (shore|harbour) in a (dinghy|skiff|lifeboat) {n}", "row a (dinghy|skiff|lifeboat|longboat|galley|rowboat) {n}",
         "dip the oars into the water and ^pull {n}", "ferry me across the river with the oars {n}", "train your (back|lats|rhomboids) with rows {n}",
         "squeeze your shoulder blades with both elbows going back as in rowing {n}", "compete in the regatta with both oars {n}", "~{N} (oar strokes|cable rows|heaves on the oars|tugs at the oars)",
         "~an (oarsman|oarswoman) (at work|in a skiff)", "~a (galley slave|sculler|ferryman) at the oars", "~a (tug|heave|haul) on the oars",
         "~the handle comes to the ribs and goes out again, as on the ergometer {n}", "~arms extend to the catch, then haul back the oars {n}")), sides=BOTH, counts=(2, 3)),
    "jumping_jack": Family(strokes(ArmPose((0.35, -0.93, 0.1), (0.35, -0.93, 0.15)), ArmPose((0.35, 0.93, 0.1), (0.1, 0.98, 0.1)), 1.15), Words(
        ("do (the arms of |)jumping jacks( with your arms only|) {n}", "swing your arms up and down (at|by) the sides {n}", "make {N} snow angels", "make a snow angel {n}", "do {N} jumping jacks without jumping", "raise and ^lower both arms sideways {n}", "move your arms like a snow angel {n}", "swing both arms over your head from the sides {n}", "exercise with jumping jack arms {n}",
         "~{N} (jumping jacks|star jumps|snow angels)", "~(jumping jack|star jump|snow angel) arms {n}", "~both arms (swing|go|fly) out and up over your head and down again {n}",
         "~arms out, up and down again {n}", "~a (snow angel|star jump|jumping jack)( with the arms|)", "~your arms (make|form) a snow angel {n}", "~your arms do (jumping jacks|star jumps) {n}",
         "~the arms of a (jumping jack|star jump) {n}", "~jumping jacks without the legs {n}", "~both arms from your sides to overhead and back {n}",
         "do (star jumps|side-straddle hops)( with the arms| without jumping|) {n}", "swing both arms out and up until your hands meet over your head {n}",
         "abduct both arms overhead and ^return them {n}", "move your arms like (a jumping jack|in a star jump) {n}", "sweep both arms (out and |)up over your head and down again {n}",
         "make angels in the snow {n}", "raise both arms out to the sides over your head and ^lower them {n}", "bring your arms from your sides up over your head and back {n}",
         "do the PE warm-up with jumping jacks {n}",
         "fan both arms out and up overhead and down again {n}", "describe semicircles with both arms from the thighs to overhead {n}", "lie in the snow and ^draw an angel with your arms {n}",
         "spread both arms and ^bring them together overhead, then back to the thighs {n}", "do calisthenics with both arms going out and overhead {n}",
         "perform star-jump arms without (hopping|leaping) {n}", "open and ^close your arms like scissors from the thighs to overhead {n}",
         "~{N} (lateral raises to overhead|side-to-overhead arm swings|star-jump arm swings)", "~a (fan|semicircle) of both arms from the thighs to overhead {n}",
         "~arms (scissoring|fanning) from the thighs to overhead {n}", "~an angel imprint in the (snow|sand) {n}", "~abduction and adduction of both arms, overhead and down {n}",
         "~gym class arms: out, overhead, down {n}")), sides=BOTH, counts=(2, 3)),
    "basketball": Family(_throw(reach((0.03, 0.2, 0.26), (0.6, -0.7, 0.3)), ArmPose((0.1, 0.65, 0.75), (0.0, 0.9, 0.4)), ArmPose((0.1, 0.6, 0.8), (0.0, 0.5, 0.85))), Words(
        ("shoot (a basket|a basketball|hoops|a free throw) {n}", "throw a basketball {n}", "take a (shot at the basket|free throw) {n}", "make a (basketball shot|jump shot) {n}", "score a basket {n}", "play basketball", "act like a basketball player {n}", "aim at the hoop and ^throw {n}", "toss a ball into the basket with both hands {n}",
         "~a (basketball|jump|set|three-point) shot", "~a free throw", "~{N} (basketball shots|free throws|jump shots|shots at the basket|shots at the hoop)", "~a shot at the (hoop|basket)",
         "~(basketball|hoops|shooting hoops|basketball practice) {n}", "~a three-pointer", "~{N} three-pointers",
         "~both hands (shoot|send|toss|push) the ball (into|towards) the (basket|hoop) {n}", "~ball into the (basket|hoop) {n}", "~the ball goes (up and |)into the (hoop|basket) {n}",
         "~a basketball player (shooting|at the free throw line)", "sink (a basket|a three-pointer|a free throw) {n}", "dunk (a|the) ball {n}",
         "shoot (a three-pointer|at the hoop|for the basket) {n}", "go for (a three-pointer|the hoop) {n}", "play (netball|a game of hoops|streetball)",
         "put the ball (in the basket|through the hoop) {n}", "send the ball through the (net|hoop) {n}", "nail a (jump shot|three-pointer) {n}", "be a basketball (player|star)",
         "shoot like (Michael Jordan|an NBA player) {n}",
         "swish a (three-pointer|free throw) {n}", "drain a (bucket|three-pointer) {n}", "slam-dunk the ball {n}", "score (a bucket|a slam dunk|two points at the hoop) {n}",
         "lob a basketball (at the backboard|towards the rim) {n}", "flick the ball over the rim with both hands {n}", "attempt a (layup|foul shot) {n}", "arc the ball towards the (ring|rim) {n}",
         "be (LeBron James|Kobe Bryant|a point guard|a Harlem Globetrotter)", "~a (slam dunk|layup|buzzer-beater|foul shot)", "~{N} (layups|foul shots|buzzer-beaters)",
         "~ball from the forehead in a high arc towards the (rim|backboard) {n}", "~both wrists (flick|flip|snap) the ball up towards the (rim|ring) {n}",
         "~elbows straighten, the ball rolls off the fingertips towards the hoop {n}")), sides=BOTH, counts=(1,)),
    "tennis": Family(_throw(ArmPose((0.8, -0.45, -0.4), (0.8, -0.1, -0.5)), ArmPose((0.5, -0.45, 0.75), (0.5, -0.1, 0.85)), ArmPose((-0.2, -0.2, 0.95), (-0.75, 0.45, 0.35))), Words(
        ("play tennis {n}", "swing a (racket|tennis racket|racquet) {n}", "hit a (forehand|tennis ball) {n}", "make a forehand stroke {n}", "play (a forehand|ping pong|badminton) {n}", "return the ball with a racket {n}", "act like a tennis player {n}", "hit the ball with your racket {n}", "do {N} forehands",
         "~a (tennis |)forehand", "~{N} forehands", "~a (tennis|badminton|ping pong|table tennis|squash) (stroke|shot|swing)", "~{N} (racket|forehand|badminton|squash) strokes",
         "~a swing of the (racket|racquet|tennis racket)", "~{N} swings of the (racket|racquet)", "~(tennis|badminton|squash|ping pong|table tennis) {n}", "~a forehand return",
         "return (a serve|the serve|a tennis ball) {n}", "play (squash|table tennis|a forehand shot|a tennis stroke) {n}", "drive the tennis ball (over the net|back|down the line) {n}",
         "knock the ball over the net {n}", "hit the (shuttlecock|ping pong ball|squash ball) {n}", "practise your (forehand|tennis swing|tennis stroke) {n}", "be a tennis (player|star|champion)",
         "act like a Wimbledon champion {n}",
         "volley the tennis ball over the net {n}", "play (padel|pickleball|racquetball) {n}", "rally from the baseline {n}", "swipe at the (tennis ball|shuttlecock) with a racket {n}",
         "whack the (shuttle|tennis ball) over the net {n}", "act like (Federer|Nadal|Serena Williams) on court {n}", "~a (topspin shot|groundstroke|passing shot|crosscourt shot)",
         "~{N} (groundstrokes|topspin drives|racket volleys)"),
        one=("~your {S} arm swings (a|the) (racket|tennis racket|racquet) {n}", "~{S}-(hand|handed) (forehand|tennis stroke) {n}", "~racket in the {S} hand, (swing|stroke|hit the ball) {n}",
         "~a forehand from the {S}( side|)", "~{S} arm swinging the (racket|racquet) {n}", "swing your {S} arm across as if (hitting a tennis ball|holding a racket) {n}",
         "take the racket in your {S} hand and ^swing it {n}",
         "sweep the racket in your {S} hand through the ball {n}", "volley with the racket in your {S} hand {n}", "brush up the back of the tennis ball with the racket in your {S} hand {n}",
         "~your {S} arm (sweeps|brushes|whips) a racket across {n}", "~a {S}-handed (groundstroke|topspin drive)", "~{N} {S}-handed (groundstrokes|topspin drives)",
         "~{S} arm taken back, racket sweeping through the ball {n}")), sides=ONE, counts=(1, 2)),
    "golf": Family(_golf, Words(
        ("swing a (golf club|baseball bat|cricket bat) {n}", "play (golf|baseball|cricket) {n}", "hit a golf ball {n}", "make a golf swing {n}", "tee off", "do {N} golf swings", "bat the ball {n}", "act like a (golfer|batter) {n}", "swing a club {n}", "drive the ball down the fairway",
         "~a (golf swing|golf stroke|golf shot|baseball swing|cricket shot|cricket stroke)", "~{N} (golf swings|golf strokes|swings of the club|swings of the bat|baseball swings)",
         "~a swing (of|with) (a|the|your) (golf club|baseball bat|cricket bat)", "~a (golf drive|tee shot|drive off the tee|tee shot down the fairway)", "~a home run",
         "~(golf|golfing|baseball batting|batting practice) {n}", "~both hands swing (the|a) (golf club|baseball bat|cricket bat) {n}", "~golf club back, then swing through {n}",
         "~both hands on the (golf club|bat), (swing|swing through) {n}", "~a (golfer|batter|batsman) taking a swing", "hit (a home run|a golf drive|the golf ball off the tee|a six) {n}",
         "knock the baseball out of the park {n}", "slog the cricket ball to the boundary {n}", "swing for the fences {n}", "play (a round of golf|a tee shot|rounders|golf like Tiger Woods)",
         "drive a golf ball {n}", "take a swing with (a|your) (golf club|baseball bat) {n}", "step up to bat and ^swing {n}", "whack the (golf ball|baseball) {n}", "be a (golfer|batsman|batter)",
         "swing a (nine iron|seven iron|wedge|hockey stick|mallet) {n}", "(clout|wallop|clobber|smite) the (golf ball|baseball) {n}", "send the golf ball soaring towards the flag {n}",
         "blast the golf ball out of the bunker {n}", "hit a homer {n}", "aim for a hole in one {n}", "take a backswing and ^strike the golf ball {n}", "sweep the club from shoulder to shoulder {n}",
         "~{N} (iron shots|wedge shots|swipes with the club)", "~a (nine iron|sand wedge|fairway) shot", "~a (line drive|base hit|cover drive|hole in one)",
         "~a slugger (at the plate|swinging for a homer)", "~hands together on the shaft, backswing, downswing, follow-through {n}", "~a backswing and follow-through with the (club|bat)")), sides=BOTH, counts=(1,)),
    "lift_weight": Family(strokes(ArmPose((0.25, -0.96, 0.05), (0.05, -0.8, 0.55), 1.0), ArmPose((0.25, -0.95, 0.1), (-0.02, 0.85, 0.5), 1.0), 1.15), Words(
        ("(curl|lift) (a dumbbell|a weight|dumbbells|weights) {n}", "do (biceps curls|bicep curls|curls) {n}", "curl your (arm|biceps) {n}", "do {N} (bicep |)curls", "pump iron {n}", "train your biceps {n}", "work out with a dumbbell {n}", "bend and ^straighten your elbow {n}",
         "~a (biceps |bicep |dumbbell |hammer |)curl", "~{N} (bicep |dumbbell |arm |)curls", "~(dumbbell|biceps) training {n}", "~(bicep|dumbbell|hammer) curls {n}", "~{N} elbow bends",
         "~elbow (flexion and extension|bends) {n}", "do (dumbbell|arm|hammer) curls {n}", "knock out {N} (bicep |dumbbell |)curls", "work (your|the) biceps {n}",
         "perform (a biceps curl|elbow flexion and extension) {n}", "bring a dumbbell (up |)to your shoulder {n}", "lift a (kettlebell|dumbbell) to your shoulder {n}", "build up your biceps {n}",
         "flex and ^extend the elbow {n}", "curl some iron {n}",
         "do (preacher|concentration) curls {n}", "do {N} reps with the dumbbell", "hinge at the elbow and ^bring the weight up {n}", "beef up your biceps {n}",
         "~{N} (preacher curls|concentration curls|elbow flexions|reps of bicep curls)", "~a rep of (bicep|dumbbell) curls"),
        alternating=("do alternating (biceps |)curls {n}",
         "~alternating (biceps|dumbbell|arm) curls {n}", "~left curl, right curl {n}", "~(bicep|dumbbell) curls left and right in turn {n}", "curl dumbbells left and right {n}",
         "curl one arm and then the other {n}",
         "hinge up one forearm and then the other with weights {n}", "~dumbbell reps left and right by turns {n}"),
        one=("~your {S} arm (curls|lifts) (a|the) dumbbell {n}", "~{S} (arm|biceps) curl {n}", "~your {S} elbow (bends and straightens|flexes and extends) {n}",
         "~the {S} forearm comes up and goes down with a dumbbell {n}", "~dumbbell in the {S} hand, curl {n}", "~{N} {S} arm curls", "~a curl (of|with) the {S} arm",
         "curl (the|your) {S} (arm|forearm) {n}", "(flex|bend) and ^(extend|straighten) (the|your) {S} elbow {n}", "lift a dumbbell to your {S} shoulder {n}",
         "train your {S} (biceps|bicep) with a weight {n}",
         "fold your {S} forearm up against the upper arm and ^unfold it {n}", "contract and ^relax the {S} biceps with a dumbbell {n}", "strengthen your {S} upper arm with a curl {n}",
         "~your {S} forearm (folds|hinges) up to the upper arm and unfolds again {n}", "~{S} palm up, forearm hinging at the elbow with a weight {n}", "~{N} reps of the {S} bicep curl"),
        both=("~both arms (curl|curling|lift) dumbbells {n}", "~dumbbells up to the shoulders and down {n}", "~both elbows (bend and straighten|flex and extend) {n}", "~a two-arm curl",
         "curl both (arms|forearms) {n}", "(bend|flex) and ^(straighten|extend) both elbows {n}", "bring the dumbbells up to your shoulders {n}",
         "curl an EZ-bar with both hands {n}", "fold both forearms up with weights {n}", "~both forearms (hinge|fold) up to the shoulders and down with weights {n}")), sides=ALL, counts=(2, 3)),
    "overhead_press": Family(strokes(ArmPose((0.55, -0.78, 0.25), (0.0, 0.97, 0.2), -0.6), ArmPose((0.2, 0.93, 0.2), (0.0, 1.0, 0.05), -0.6), 1.2), Words(
        ("press a (barbell|weight) (over your head|overhead) {n}", "push the (ceiling|sky) up {n}", "lift (weights|a barbell) (over your head|overhead) {n}", "do {N} (shoulder|overhead) presses", "push (up|upwards|overhead) with both hands {n}", "raise the roof {n}", "act like a weightlifter {n}", "heave the barbell up {n}", "press upwards {n}", "do shoulder presses {n}",
         "~{N} (overhead|shoulder|military|barbell) presses", "~a (shoulder|military|overhead|barbell) press", "~(weightlifting|shoulder pressing|overhead pressing) {n}",
         "~both (hands|arms) (push|press) (up towards the ceiling|the ceiling up|upwards|up from the shoulders) {n}", "~barbell (up over your head|overhead)( and back down|) {n}",
         "~weights from the shoulders up over the head {n}", "~arms pressing (upwards|overhead) {n}", "~a (clean and press|weightlifter at work)", "~barbell to the ceiling {n}",
         "~your hands push the (sky|ceiling|roof) up {n}", "perform (a military press|an overhead press|a shoulder press) {n}", "do (military|barbell|overhead) presses {n}",
         "push (a heavy lid|the roof|a weight) up (over|above) your head {n}", "press (dumbbells|both hands) from your shoulders (to|towards) the ceiling {n}",
         "lift a barbell like an Olympic champion {n}", "power the weight up over your head {n}", "push against the ceiling {n}", "get the barbell (over|above) your head {n}",
         "train your shoulders with overhead presses {n}", "drive both hands up from your shoulders {n}",
         "(shove|jerk|boost) the barbell above your head {n}", "do {N} (push|Arnold|kettlebell) presses", "shove the (trapdoor|loft hatch|ceiling) up with both hands {n}",
         "lock out the (barbell|weights) overhead {n}", "tone your (deltoids|delts) with overhead presses {n}", "press (kettlebells|a log|a keg) overhead {n}",
         "extend both elbows overhead under a heavy load {n}", "~a (push press|clean and jerk|barbell jerk|Arnold press)",
         "~{N} (push presses|barbell jerks|kettlebell presses|upward shoves with both hands)", "~a strongman pressing the barbell", "~both palms (driving|shoving) skyward from the shoulders {n}",
         "~elbows extending overhead with the load, then bending again {n}", "~deltoid training with the hands from the shoulders to the ceiling {n}", "~a raise-the-roof dance move {n}")), sides=BOTH, counts=(2, 3)),
}  # fmt: skip
