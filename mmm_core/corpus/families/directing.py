"""Showing the way: pointing, presenting, calling, sending away, traffic."""

from __future__ import annotations

from mmm_core.corpus.families.gesture import ANY, BOTH, ONE, Family, Gesture, Words
from mmm_core.corpus.families.strokes import (
    SIGN,
    arms_to,
    keep,
    pair_to,
    reach_s,
    repeat,
    strokes,
    turn_s,
    vary,
)
from mmm_core.corpus.score import ArmPose, Score, Vector

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


def _traffic(score: Score, g: Gesture) -> None:
    """One arm bars the way sideways, the other waves the cars through."""
    lead = g.lead
    bar = ArmPose((1, 0.05, 0.1), (1, 0.1, 0.1), -0.6)
    out, back = ArmPose((0.75, -0.25, 0.55), (0.85, 0.1, 0.5)), ArmPose((0.6, -0.3, 0.7), (-0.5, 0.72, 0.45))
    pair_to(score, g, out, bar)
    one = Gesture(g.family, lead, g.count, tempo=g.tempo, size=g.size)
    repeat(score, one, back, out, 0.85)


_BECKON_READY, _BECKON_IN = (
    ArmPose((0.35, -0.6, 0.65), (0.05, 0.1, 1.0), 1.2),
    ArmPose((0.35, -0.6, 0.6), (-0.15, 0.85, 0.4), 1.2),
)
_NEAR, _FAR = ArmPose((0.4, -0.6, 0.6), (-0.2, 0.5, 0.75), 0.4), ArmPose((0.35, -0.3, 0.9), (0.2, -0.1, 1.0), -0.8)


def _point_words(there: tuple[str, ...], extra: Words | None = None) -> Words:
    where, extra = f"({'|'.join(there)})", extra or Words()
    return Words((*(f"point {t}" for t in there), f"(aim|point|direct) a finger {where}", f"make a pointing (gesture|motion) {where}",
        f"~a pointing (gesture|motion|movement) {where}", f"~a finger pointing {where}", f"(jab|stab|poke|train|level) a finger {where}",
        f"~a (jab|stab) of the finger {where}", f"~an index finger (extended|stretched|aimed|jabbing) {where}", f"uncurl a finger and ^point {where}",
        f"draw my attention by pointing {where}", f"single something out by pointing {where}", f"gesticulate with a pointing finger {where}",
        f"~a pointer finger aimed {where}", f"~the pointing of a finger {where}", f"~an arrow made by the index finger, {where}", f"flick a pointing finger {where}",
        f"steer my gaze with a finger {where}", *extra.bare),
        any=(f"(point|aim|direct) (your finger|your index finger|the forefinger|one finger) {where}", f"use your (hand|finger|index finger) to point {where}",
        f"~your (finger|index finger|hand) (points|is pointing|should point) {where}", f"~(finger|index finger|arm|hand) pointing {where}",
        f"~(pointing|index finger pointed) {where}", f"(jab|stab|train|level) your (index finger|forefinger|pointer finger) {where}",
        f"indicate with your (index |)finger: {where}", f"~your (index |)finger (jabs|stabs|is trained|is levelled|aims) {where}",
        f"use your arm as a (signpost|pointer|compass needle) {where}", f"~your arm like a (signpost|compass needle) {where}", f"~pointer finger {where}", *extra.any),
        one=(*(f"use (your|the) {{S}} (hand|arm) to point {t}" for t in there), f"(point|aim|direct) (your|the) {{S}} (hand|arm|finger|index finger|forefinger) {where}",
        f"(let|make|have) your {{S}} (hand|arm|finger) point {where}", f"let me see your {{S}} (hand|arm|finger) pointing {where}",
        f"keep your {{S}} (finger|hand) pointed {where}", f"use the {{S}} (forefinger|index finger) to point {where}",
        f"~your {{S}} (hand|arm|finger|index finger) (points|is pointing|should point) {where}", f"~the {{S}} (arm|hand|forefinger) (points|is pointed|is pointing) {where}",
        f"~{{S}} (arm|hand|finger|index finger) (pointing|pointed) {where}", f"~with (your|the) {{S}} (hand|arm|finger), point {where}", f"~{{S}} (hand|arm): point {where}",
        f"(jab|stab|train|level) your {{S}} (index finger|forefinger|pointer finger) {where}",
        f"~your {{S}} (index finger|forefinger) (jabs|stabs|is trained|is levelled|aims) {where}", f"~a (jab|stab) of the {{S}} index finger {where}",
        f"uncurl your {{S}} index finger and ^point {where}", f"use your {{S}} arm as a (signpost|pointer|compass needle) {where}",
        f"~the {{S}} arm like a (signpost|compass needle) {where}", f"~the {{S}} index finger (extended|aimed) {where}", f"single something out with the {{S}} finger {where}",
        *extra.one))  # fmt: skip


def _show_words(where: str) -> Words:
    return Words(any=(f"show me (what is|the way|where it is,|something) {where}", f"(locate|pinpoint|single out) something {where} with your finger",
        f"draw my attention to something {where} with your finger", f"indicate (something|the thing|the item) {where}", f"~a pointing finger says: it is {where}",
        f"identify (the object|the item) {where} by pointing"))  # fmt: skip


DIRECTING: dict[str, Family] = {
    "point": Family(_point, Words(), sides=ONE, directions=(*_POINT_AT, "self", "back"), directed={"left": _point_words(("to the left", "left", "to your left",
        "at the left wall", "towards the left side", "at something on your left", "leftwards", "over to the left", "to the left-hand side", "at your left-hand neighbour",
        "at whoever stands to your left", "westwards on a map", "to the portside", "at the far left end", "in the left direction"), _show_words("to the left")),
        "right": _point_words(("to the right", "right", "to your right", "at the right wall", "towards the right side", "at something on your right", "rightwards",
        "over to the right", "to the right-hand side", "at your right-hand neighbour", "at whoever stands to your right", "eastwards on a map", "to the starboard side",
        "at the far right end", "in the right-hand direction"), _show_words("to the right")), "forward": _point_words(("forward", "straight ahead", "at me", "to the front",
        "in front of you", "at the listener", "at the person in front of you", "at the camera", "straight at me", "dead ahead", "at the audience", "in my direction",
        "at the horizon", "onwards", "at your opponent", "at the opposite wall", "at my nose", "at the spectators", "at the person opposite", "directly to the front",
        "at the lens", "into the distance ahead"), Words(("point the finger at (me|the culprit)", "~an accusing finger( at me|)", "single me out with a finger",
        "blame me with a pointing finger", "~Uncle Sam wants you, with the finger", "pose like Uncle Sam on the poster, finger at me", "~it was you, with a pointing finger",
        "nominate me by pointing", "denounce the culprit in front of you with a finger", "~finger-pointing at the (suspect|culprit) in front"),
        any=("pick me out with your finger", "accuse me with (a|your) finger", "show me (what is|the way|where it is,|something) straight ahead",
        "~your finger is (on|aimed at) me", "pinpoint me with your finger", "indicate me with your finger", "choose me with your finger",
        "identify the thief in front of you with your finger"))), "up": _point_words(("up", "upwards", "at the ceiling", "to the sky", "at the stars", "above you",
        "straight up", "skywards", "at the moon", "overhead", "to heaven", "at the clouds", "at the lamp above you", "at the roof", "heavenwards", "at an aeroplane overhead",
        "at the treetops", "vertically upwards", "at the zenith", "at the chandelier"), _show_words("up there")), "down": _point_words(("down", "downwards", "at the floor",
        "to the ground", "at your feet", "below you", "straight down", "at the ground", "at something on the floor", "at the carpet", "at your shoes", "at your toes",
        "at the rug", "floorwards", "earthwards", "at a puddle at your feet", "at the soil", "at the floorboards", "at a coin on the pavement", "at the doormat"),
        _show_words("down there")), "up left": _point_words(("up to the left", "up and to the left", "up left", "to the upper left", "at the top left corner",
        "diagonally up to the left", "at the upper left corner", "to the top left", "left and up", "diagonally left and upwards", "at the lamp high on the left",
        "at a bird high up on your left", "at the left end of the ceiling"), _show_words("up on the left")), "up right": _point_words(("up to the right", "up and to the right",
        "up right", "to the upper right", "at the top right corner", "diagonally up to the right", "at the upper right corner", "to the top right", "right and up",
        "diagonally right and upwards", "at the lamp high on the right", "at a bird high up on your right", "at the right end of the ceiling"), _show_words("up on the right")),
        "down left": _point_words(("down to the left", "down and to the left", "down left", "to the lower left", "at the bottom left corner", "diagonally down to the left",
        "at the lower left corner", "to the bottom left", "left and down", "diagonally left and downwards", "at the floor on your left", "at a puddle low on your left",
        "at the ground on the left-hand side"), _show_words("down on the left")), "down right": _point_words(("down to the right", "down and to the right", "down right",
        "to the lower right", "at the bottom right corner", "diagonally down to the right", "at the lower right corner", "to the bottom right", "right and down",
        "diagonally right and downwards", "at the floor on your right", "at a puddle low on your right", "at the ground on the right-hand side"),
        _show_words("down on the right")), "self": _point_words(("at yourself", "to yourself", "to your own chest", "at your own chest", "to your heart", "towards yourself",
        "at your own body", "back at yourself", "at your own breastbone", "at your sternum", "inwards at yourself", "at your own ribs", "at your own shirt",
        "at your own torso", "at number one, yourself"), Words(("jab a (finger|thumb) at yourself", "~a (finger|thumb) at yourself", "say who, me, with a finger at yourself",
        "~who, me, with a finger at the chest", "nominate yourself with a finger at your chest", "single yourself out with a finger", "take credit with a thumb at your chest",
        "~the thumb prodding your own chest", "identify yourself with a finger at your chest"),
        one=("point your {S} thumb at yourself", "~{S} (thumb|finger) to your own chest", "prod your own chest with your {S} (finger|thumb)",
        "~the {S} thumb jabbing back at yourself", "indicate yourself with your {S} (finger|thumb|hand)", "~yours truly, with the {S} thumb at your chest"),
        any=("point your thumb at (yourself|your chest)", "~thumb pointing at yourself", "indicate yourself with (a|your) (finger|thumb)",
        "prod your own chest with (a|your) (finger|thumb)"))), "back": _point_words(("behind you", "backwards", "over your shoulder", "to the back", "at the wall behind you",
        "at something behind you", "to the rear", "at the person behind you", "back over your shoulder", "rearwards", "backward past your ear", "at your pursuer behind you",
        "at what lies behind you", "to the area behind your back", "over the shoulder to the rear", "at somebody lurking behind you"), Words(("jerk a thumb over your shoulder",
        "~a thumb over the shoulder", "hitch a thumb over your shoulder", "flick a thumb backwards over your shoulder", "indicate the people behind you with a thumb",
        "signal to the rear with a thumb", "gesture over your shoulder with a thumb"),
        one=("(jerk|point) your {S} thumb (over your shoulder|behind you|backwards)", "~{S} thumb (over the shoulder|pointing behind you)",
        "(hitch|flick|cock|hook) your {S} thumb over your shoulder", "indicate (what is|the door|the person) behind you with your {S} (thumb|hand)",
        "gesture over your shoulder with your {S} (thumb|hand)", "~a backward (jerk|flick|jab) of the {S} thumb over the shoulder"),
        any=("show me (what is|the way|where it is,|something) behind you", "(jerk|point) your thumb (over your shoulder|behind you)", "~thumb over (your|the) shoulder",
        "(hitch|flick|cock|hook) your thumb over your shoulder", "indicate what is behind you with your thumb", "~a backward (jerk|flick) of the thumb over the shoulder"))),},
        holds=True),
    "present": Family(_present, Words(("present (the stage|the product|the next speaker|the room)", "show me the way( in| out|)", "invite me in( with a sweep of your arm|)",
        "usher me in", "~say after you", "show (me |)this way please", "make a sweeping gesture to the side", "introduce (your friend|the next act)", "give me the floor",
        "show (me|the guests|the lady) to (a seat|the table|the door)", "usher (me|the guests|the visitors) (through|inside|to the table)",
        "invite me to (take a seat|go first|go ahead|go through)", "make (an ushering|an inviting|a presenting) (gesture|sweep) to the side",
        "gesture (me|us) (in|inside|through)", "say (voila|behold|come this way|right this way|be my guest)", "unveil (the painting|the prize|the new car)",
        "showcase (the product|the prize)", "act like a (butler|doorman|game show host|ring master) and ^show me in", "offer me (a seat|the chair)",
        "~a (sweeping|presenting|ushering|inviting|this-way) gesture( to the side|)", "~a (presentation|game show|showman's) gesture",
        "~an invitation to (come in|enter|go ahead)", "~ladies and gentlemen, the next act",
        "(exhibit|advertise|promote|flaunt) the (product|goods|new model) with a sweep of the arm", "reveal the (prize|winner's car|curtain) with a sweep of the arm",
        "escort me in with a sweep of the arm", "gesticulate welcome, come in, with an arm to the side", "~tada",
        "say (tada|without further ado|welcome to my humble abode|ladies first|do come in)",
        "~a (maitre d's|hostess's|doorkeeper's|concierge's|compere's|magician's assistant's|usher's) gesture",
        "act like a (concierge|maitre d'|compere|hostess|tour guide|estate agent) and ^show me in",
        "announce the (next act|star guest|main attraction) with a sweep of the arm", "guide me (inside|to my place|to the exit) with an open hand",
        "~a (flourish|unveiling) with the arm to the side", "make a flourish to the side with an open hand", "yield the floor to me with a sweep of the arm",
        "grant me (entry|passage) with a sweep of the arm", "direct me to my seat with an open hand", "give the spotlight to (the singer|your colleague) with an open hand",
        "~a weather presenter's gesture to the map", "~an open-handed (invitation|offer) to the side",
        "~the (unveiling|introduction|presentation) of (the statue|the next guest|the new car)", "let me pass first with a courteous gesture",
        "~a courteous gesture that lets me go first"),
        one=("(sweep|move) your {S} hand out to the side with an open palm", "present something on your {S} side", "show the way with your {S} (hand|arm)",
        "introduce the person on your {S}", "use your {S} (hand|arm) to (show me in|present the stage|usher me in|show me the way|introduce the next act)",
        "let your {S} (arm|hand) sweep outwards to present (it|the stage)", "open your {S} (hand|arm) (to|towards) the (stage|door|exit) like a host",
        "indicate the (door|stage|seat) with an open {S} hand", "unfold your {S} arm to the side (in welcome|to present something)",
        "~your {S} (hand|arm) (sweeps|opens|swings) out to the side with the palm up", "~your {S} hand (shows|shows me|indicates) the way", "~{S} (hand|arm) showing the way",
        "~{S} palm open, sweeping to the side", "~a (sweep|sweeping gesture) (of|with) (the|your) {S} (arm|hand) to the side",
        "~with (your|the) {S} (hand|arm), (show me the way|show me in|present the stage)", "~{S} hand: this way, please",
        "fan your open {S} hand out to the side to show me in", "~a flourish of (the|your) open {S} hand to the side", "make a flourish with the open {S} hand to the side",
        "~your {S} (arm|hand) (unfolds|fans|glides|wafts) out to the side, palm up, in invitation", "escort me in with your {S} (arm|hand)",
        "glide your open {S} palm from the middle out to the side", "announce the next act with your {S} (arm|hand)", "reveal the prize with your {S} (arm|hand)",
        "~tada with the {S} hand", "~the {S} hand of a (doorman|concierge|compere) showing me in", "~a {S}-handed (invitation to enter|after-you)",
        "~an open-palmed {S} sweep, this way", "give way to me with a sweep of your {S} (arm|hand)", "advertise the new car with a sweep of your {S} arm"),
        any=("~this way(, please|, sir|, madam|)", "~after you(, please|, sir|, madam|)", "~a sweep of (the|your) (open hand|arm) to the side",
        "~your (hand|arm) sweeps out to the side to present (it|the stage)", "~open hand showing the way", "~tada, with an open hand to the side",
        "make a flourish to the side with your open hand", "~your open hand (unfolds|fans|glides) out to the side in invitation", "~a flourish of the open hand to the side",
        "~do come in, with an open hand to the side")), sides=ONE, holds=True),
    "beckon": Family(strokes(_BECKON_READY, _BECKON_IN, 0.7), Words(("beckon {n}", "beckon me (over|to come|closer) {n}", "call me over {n}",
        "tell me to come (here|closer) {n}", "wave me over {n}", "invite me over", "ask me to come (here|closer|to you) {n}", "make a come here (sign|gesture) {n}",
        "say come here", "motion me closer {n}", "(motion|signal|gesture) for me to (come|come over|come closer|approach) {n}", "bid me (come|approach|come nearer) {n}",
        "summon (me|the waiter|your servant|your assistant) {n}", "call (the dog|the waiter|a child|somebody|your friend) over {n}",
        "(lure|coax|entice|wave) me (closer|nearer) {n}", "wave (somebody|the waiter|your friend|us) (over|closer|towards you) {n}",
        "say (come closer|come to me|get over here|come on over|step closer)", "crook a finger at me {n}", "make a beckoning (motion|gesture|sign) {n}",
        "tell (them|the others|the dog|the child) to come (here|over|nearer) {n}", "show me that I (should|may|can) come (closer|over|to you)",
        "beckon (somebody|the waiter|the children|your friend) (over|closer) {n}", "~a beckoning (gesture|motion|movement|sign) {n}",
        "~a come(-| )here (gesture|sign|motion) {n}", "~a (signal|sign|gesture) to come (closer|over|nearer|here) {n}", "~an invitation to come (closer|over)",
        "~{N} beckoning (gestures|motions|movements)", "~beckoning {n}", "~a beckon {n}", "(hook|reel|wheedle|draw) me closer with a gesture {n}", "make a hither gesture {n}",
        "~come hither {n}", "~a come-hither (gesture|motion|sign) {n}", "say (come hither|over here|this way to me|c'mere|come along|psst, come here)",
        "attract me over with a gesture {n}", "call for me to draw near with a gesture {n}", "cue me to (come|approach) {n}", "gather the children round with a gesture {n}",
        "whistle the dog over with a gesture {n}", "signal a waiter to your table {n}", "~a (witch's|siren's) beckoning gesture {n}",
        "tempt me (closer|nearer) with a gesture {n}", "urge me (closer|nearer|to hurry over) {n}", "~a (summons|summoning gesture) {n}",
        "~a request to (approach|draw near|come across) {n}", "invite me to (approach|step up|come across) with a gesture {n}", "recall the dog with a gesture {n}",
        "~{N} come-here (scoops|gestures)", "~the beckoning of a (hand|finger) {n}", "~hurry over here {n}", "~an approach-me sign {n}",
        "ask your opponent to bring it on like (Bruce Lee|Neo|Morpheus) {n}", "~bring it on, like Bruce Lee {n}", "~come to Mama {n}", "get me to come over by waving {n}",
        "guide the driver towards you {n}"),
        one=("curl your {S} (hand|forearm) towards (you|yourself) to (call|beckon) me {n}", "beckon me with (your|the) {S} (hand|arm|index finger) {n}",
        "use your {S} (hand|arm) to (call me over|beckon|wave me over|wave me closer) {n}", "draw me closer with your {S} hand {n}",
        "~your {S} (hand|arm) (beckons|calls me over|waves me closer|is beckoning|should beckon) {n}", "~{S} (hand|arm) beckoning {n}", "~a beckoning {S} hand",
        "~with (your|the) {S} hand, (beckon|call me over|wave me over) {n}", "~the {S} hand (waves me over|beckons me) {n}", "~{S} hand: come here",
        "scoop the air towards you with your {S} (hand|forearm) {n}", "~the {S} hand scoops the air towards the chest {n}",
        "(crook|hook|curl) your {S} (index finger|forefinger) towards you {n}", "~a crooked {S} (finger|forefinger) calling me {n}",
        "curl the {S} fingers towards you to call me {n}", "~the {S} fingers curl (in|inwards) to call me {n}", "~a come-hither with the {S} hand {n}",
        "reel me in with your {S} hand {n}", "fan me closer with your {S} hand {n}", "summon me with your {S} (hand|finger) {n}", "tempt me nearer with your {S} finger {n}",
        "lure me over with your {S} (hand|finger) {n}", "~{S} forearm flexing towards you, palm up, to call me {n}", "~your {S} hand scoops me closer {n}",
        "~the {S} forearm folds back towards the shoulder to call me {n}", "~{N} {S} hand come-here scoops", "cue me to come over with your {S} hand {n}",
        "urge me closer with your {S} hand {n}"),
        any=("beckon with (a|one|your) (hand|finger) {n}", "~your hand (beckons|beckons me over|calls me closer) {n}", "~hand beckoning {n}",
        "(crook|hook) your (finger|index finger) at me to come {n}", "~a crooked finger calling me {n}", "scoop the air towards you with your hand {n}",
        "reel me in with your hand {n}", "fan me closer with your hand {n}", "~a come-hither with the hand {n}", "~the fingers curl towards you to call me {n}",
        "summon me with a finger {n}"),
        both=("beckon with both (hands|arms) {n}", "wave me (closer|over) with both arms {n}", "guide me towards you with both hands {n}",
        "~both hands (beckoning|beckon|call me over|wave me closer) {n}", "~both arms wave me (over|closer) {n}", "~a two-handed come-here gesture {n}",
        "scoop the air towards you with both (hands|arms) to call me {n}", "gather everyone round with both arms {n}", "reel me in with both hands {n}",
        "fan me closer with both hands {n}", "~both hands scoop me closer {n}", "~a come-hither with both hands {n}",
        "guide the lorry backwards towards you with both hands {n}", "summon the crowd with both (hands|arms) {n}", "urge me closer with both hands {n}",
        "usher the plane towards you with both arms {n}", "~both forearms flexing towards you to call me {n}")), sides=ANY, counts=(2,)),
    "go_away": Family(strokes(_NEAR, _FAR, 0.75), Words(("shoo me away {n}", "make a go away (gesture|sign) {n}", "tell me to (go away|leave|get lost) {n}", "send me away {n}",
        "wave me (away|off) {n}", "dismiss me {n}", "shoo (the fly|the cat|the dog|the birds) away {n}", "chase me off {n}", "drive away (a fly|the flies) {n}",
        "make a shooing (gesture|motion|movement) {n}", "(send|wave|motion|chase) (the fly|the dog|them|the pigeons|the salesman|the wasp) away {n}",
        "tell (the dog|him|them|the salesman) to (go away|clear off|scram|buzz off|push off|back off) {n}", "say (shoo|go away|be off|scram|clear off)",
        "dismiss (the servant|him|the idea|the waiter|my suggestion) {n}", "wave (off|aside) (the idea|the question|my objection|the flies|my worries) {n}", "banish me {n}",
        "give me the brush-off {n}", "get rid of (the fly|the wasp|me) by waving {n}", "scare (the pigeons|the crows|the cat) away {n}", "bid me (leave|be gone) {n}",
        "signal (me|them) to (leave|go|clear off) {n}", "~a shooing (gesture|motion|movement) {n}", "~a dismissive (wave|gesture) {n}",
        "~a go(-| )away (gesture|sign|wave) {n}", "~{N} (shooing|dismissive|go-away) (gestures|waves|motions)", "~shoo", "~off with you",
        "~a (sign|signal) to (leave|go away|clear off) {n}", "~away with (the flies|the wasps|you)", "~shooing {n}", "(oust|evict|eject) me with a gesture {n}",
        "(brush|fan|flap|whisk) the flies away {n}", "~(begone|vamoose|skedaddle|hop it|beat it)",
        "say (begone|vamoose|skedaddle|hop it|beat it|leave me alone|get out of here)", "spurn me with a wave {n}", "rebuff me with a wave {n}",
        "snub me with a dismissive wave {n}", "~a (disdainful|contemptuous|haughty|brusque) wave, away with you {n}", "waft the (smell|smoke|fumes) away {n}",
        "disperse the (pigeons|onlookers|smoke) {n}", "scatter the pigeons {n}", "repulse the salesman with a wave {n}", "frighten the crows away {n}",
        "whoosh the cat off the table {n}", "~a (dismissal|brush-off|send-off gesture) {n}", "~the shooing of the (hens|pigeons|flies) {n}",
        "usher the (cat|children) out of the kitchen {n}", "~a fly-chasing (motion|wave) {n}", "pooh-pooh the idea with a wave {n}", "discard the thought with a wave {n}",
        "order me to (retreat|step back|back up|keep my distance) {n}", "exile me with a wave {n}", "send the dog packing {n}", "~a flick that means get lost {n}",
        "~a wave that means scram {n}"),
        one=("flick your {S} (hand|wrist) outwards to (dismiss me|send me away) {n}", "use your {S} (hand|arm) to (shoo|wave|send|chase) me away {n}",
        "send me off with your {S} hand {n}", "drive the flies away with your {S} (hand|arm) {n}",
        "~your {S} (hand|arm) (shoos me away|sends me away|waves me away|chases the flies away) {n}", "~{S} hand shooing {n}", "~a shooing {S} hand",
        "~a dismissive (wave|flick) of (the|your) {S} hand {n}", "~with (your|the) {S} hand, (shoo me away|send me away|chase the flies off) {n}", "~{S} hand: go away",
        "(brush|whisk|waft|fan) the (fly|smoke|wasp) away with your {S} hand {n}", "~a brush-off with the {S} hand {n}", "sweep me away with the back of your {S} hand {n}",
        "~the back of the {S} hand (brushes|sweeps|whisks) me away {n}", "oust me with a wave of your {S} hand {n}",
        "~a (disdainful|haughty|contemptuous) flick of (the|your) {S} (wrist|hand) {n}", "scatter the pigeons with your {S} arm {n}",
        "disperse the smoke with your {S} hand {n}", "shove the idea away with a flick of your {S} hand {n}", "~your {S} hand flaps outwards to send me away {n}",
        "flap your {S} hand outwards to scare off the birds {n}", "~{S} wrist flicking outwards, get lost {n}",
        "dismiss the (waiter|servant) with the back of your {S} hand {n}", "~{N} outward flicks of the {S} hand"),
        any=("~shoo, (shoo|go away|be off)", "flick your hand to send me away {n}", "~a dismissive (wave|flick) of the hand {n}",
        "~your hand (shoos me away|waves me away|sends me off) {n}", "flap your hand outwards to send me off {n}", "(brush|whisk|waft|fan) the fly away with your hand {n}",
        "sweep me away with the back of your hand {n}", "~a (disdainful|haughty) flick of the wrist {n}", "~a brush-off with the hand {n}"),
        both=("chase the (geese|hens|flies) away with both (hands|arms) {n}", "drive the (geese|sheep) off with both arms {n}",
        "~both hands (shooing|shoo me away|wave me away|send me away) {n}", "~both arms (shoo|chase|wave) the (geese|birds) away {n}",
        "(waft|fan) the (smoke|smell) away with both hands {n}", "scatter the pigeons with both arms {n}", "herd the geese off with both (arms|hands) {n}",
        "~both hands flap outwards to scare off the hens {n}", "disperse the onlookers with both arms {n}", "whisk the flies away with both hands {n}",
        "banish me with both hands {n}", "~a two-handed shoo {n}", "~{N} two-handed shoos", "brush me off with both hands {n}")), sides=ANY, counts=(2,)),
    "traffic": Family(_traffic, Words(("direct (the |)traffic {n}", "act like a traffic (cop|policeman|officer) {n}", "regulate the traffic {n}", "wave the cars through {n}",
        "control the traffic {n}", "guide the cars {n}", "let the cars pass {n}", "play traffic police", "manage a crossing {n}", "send the cars on {n}",
        "stop one lane and ^wave the other through {n}", "(guide|route|direct) the (vehicles|cars) {n}", "stand in for the traffic lights {n}",
        "play (traffic cop|the traffic policeman|the traffic warden)", "do the job of a traffic (light|officer|policeman|warden) {n}", "do point duty {n}",
        "wave (the traffic|the vehicles|the lorries|the trucks) (through|on|past|along) {n}", "keep the (traffic|cars) (moving|flowing) {n}",
        "(bar|block|hold back) one lane and ^wave the other (on|along) {n}", "show the (cars|drivers) where to go {n}", "marshal the (cars|traffic) {n}",
        "police the (crossroads|junction|intersection) {n}", "usher the cars through the (junction|crossing) {n}",
        "stand at the (crossroads|junction) and ^direct (the |)traffic {n}", "sort out the traffic (jam|chaos) {n}", "be a traffic (cop|policeman|officer) {n}",
        "~traffic (control|policing|duty|direction) {n}", "~a traffic (cop's|policeman's|officer's) (signals|gestures) {n}", "~traffic cop (signals|gestures|moves) {n}",
        "~{N} traffic signals", "~hand signals for the (cars|drivers|traffic) {n}", "~the cars are waved through {n}", "~the traffic is (directed|waved through|regulated) {n}",
        "~a policeman directing traffic {n}", "~directing (the |)(traffic|cars) {n}", "~your arms direct the (traffic|cars) {n}", "steward the (car park|cars) {n}",
        "coordinate the traffic at the (roundabout|junction) {n}", "choreograph the traffic {n}",
        "~a (lollipop man's|crossing guard's|constable's|gendarme's|bobby's|steward's) traffic signals {n}",
        "act like a (constable|bobby|gendarme|carabiniere) on point duty {n}", "~point duty {n}", "~(crossroads|junction|intersection|roundabout) duty {n}",
        "unblock the (junction|intersection|crossroads) {n}", "disentangle the gridlock {n}", "clear the (gridlock|tailback|bottleneck) at the junction {n}",
        "~a human traffic light {n}", "be a human traffic light {n}", "replace the broken traffic lights {n}", "~the (marshalling|regulation|policing) of the traffic {n}",
        "hold one lane with an arm out and ^wave the other lane on {n}", "~one arm bars a lane, the other waves the motorists on {n}",
        "wave the (motorists|buses|cyclists|vans) through like a policeman {n}", "divert the traffic around the accident {n}", "filter the cars through the roadworks {n}",
        "manage the school run traffic {n}", "~traffic management {n}", "escort the convoy through the junction {n}", "let one lane stand still and ^wave the other past {n}",
        "~a cop with white gloves at the crossroads {n}", "~car park marshalling {n}", "~{N} traffic cop gestures")), sides=BOTH, counts=(2, 3)),
}  # fmt: skip
