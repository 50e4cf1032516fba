"""Hands that meet the body: head, face, chest, belly, hips, back."""

from __future__ import annotations

from mmm_core.corpus.families.gesture import ALL, BOTH, ONE, Family, Gesture, Words
from mmm_core.corpus.families.strokes import arms_to, circle, keep, loops, pair_to, repeat, still, strokes
from mmm_core.corpus.reach import (
    BELLY,
    BROW,
    CHIN,
    CROWN,
    EAR,
    ELBOW_DOWN,
    ELBOW_OUT,
    ELBOW_UP,
    EYES,
    FOREHEAD,
    HEART,
    HIP,
    LOWER_BACK,
    MOUTH,
    NAPE,
    OTHER_SHOULDER,
    STERNUM,
    reach,
)
from mmm_core.corpus.score import SIDE, ArmPose, Score, Vector


def _off(place: Vector, out: float = 0.0, up: float = 0.0, forward: float = 0.0) -> Vector:
    return (place[0] + out, place[1] + up, place[2] + forward)


_ABOVE, _BELOW = reach((-0.12, -0.19, 0.22), (0.6, -0.7, 0.1)), reach((-0.14, -0.24, 0.15), (0.6, -0.8, 0.0))
_X_HANDS = reach((-0.1, 0.02, 0.3), (0.5, -0.8, 0.0))
_KISS_OUT = ArmPose((0.2, -0.35, 0.9), (0.12, 0.15, 1.0), 1.0)


def _cross(score: Score, g: Gesture) -> None:
    """Folded arms: one forearm over the other, either way round."""
    lead = "left" if score.rng.random() < 0.5 else "right"
    pair_to(score, Gesture(g.family, lead, tempo=g.tempo), _ABOVE, _BELOW)
    keep(score, g, (0.8, 2.2))


def _kiss(score: Score, g: Gesture) -> None:
    for _ in range(g.count):
        arms_to(score, g, reach(MOUTH), amount=0.03)
        score.hold(score.rng.uniform(0.1, 0.3))
        arms_to(score, g, _KISS_OUT, amount=0.04)
        score.hold(score.rng.uniform(0.1, 0.4))


def _yawn(score: Score, g: Gesture) -> None:
    arms_to(score, g, reach(_off(MOUTH, forward=0.02)), amount=0.02)
    score.move(0.8 / g.tempo, trunk=(0.0, -0.09, 0.0), head=(0.0, -0.22, 0.0), shrug=0.5)
    score.hold(score.rng.uniform(0.3, 0.8))
    score.move(0.7 / g.tempo, trunk=(0.0, 0.03, 0.0), head=(0.0, 0.05, 0.0), shrug=0.0)


def _beat_chest(score: Score, g: Gesture) -> None:
    fist, away = reach((0.03, -0.12, 0.13), ELBOW_OUT), reach((0.2, -0.08, 0.33), ELBOW_OUT)
    arms_to(score, g, away)
    repeat(score, g, fist, away, 0.6)


TOUCH: dict[str, Family] = {
    "cross_arms": Family(_cross, Words((
        "(cross|fold) your arms( in front of your chest| across your chest|)", "fold both arms", "stand with (crossed|folded) arms", "cross both arms over your chest", "put your arms across your chest",
        "keep your arms (folded|crossed)", "close your arms over your chest", "hold your arms crossed", "take a closed posture with folded arms", "wait with folded arms", "fold your arms (impatiently|sternly)",
        "lock your arms in front of your chest")), sides=BOTH, holds=True),
    "cross_hands_x": Family(still(_X_HANDS), Words((
        "make an X with your (arms|forearms)", "form an X( in front of you| with both arms|)", "cross your forearms (to say no|to refuse|in an X)", "make a big X", "show an X with your arms", "cross your wrists in front of your face",
        "hold your forearms up crossed", "say no with crossed (arms|wrists)", "make the wrong answer sign", "show that it is wrong with an X", "do the Wakanda (pose|salute)", "cross your arms in front of your face", "refuse with an X", "form the letter X with your arms")), sides=BOTH, holds=True),
    "hands_on_hips": Family(still(reach(HIP, ELBOW_OUT, -0.3), via=SIDE), Words(
        one=("(put|place|rest|set|lay) your {S} hand on (your|the|your {S}) hip", "hold your {S} hip( with your {S} hand|)", "bring your {S} hand to your (waist|hip)", "prop your {S} hand on your (hip|waist)", "put your {S} hand on your waist"),
        any=("put one hand on your hip", "rest a hand on your hip"),
        both=("(put|place|rest|set) (your|both) hands on your (hips|waist)", "stand with (your |)hands on (your |)hips", "hold your hips with both hands", "set your arms akimbo", "stand like a superhero with hands on hips",
              "prop both hands on your waist")), holds=True),
    "behind_head": Family(still(reach(NAPE, (0.9, 0.3, 0.1)), via=SIDE), Words(
        one=("(put|place|bring|hold) your {S} hand behind your (head|neck)", "touch the back of your head with your {S} hand", "place your {S} hand at the back of your neck", "rub your neck with your {S} hand", "hold your neck with your {S} hand",
             "lay your {S} hand on your neck"),
        any=("put one hand behind your head", "rub your neck"),
        both=("(put|place|hold) (your|both) hands behind your (head|neck)", "relax with your hands behind your head", "fold your hands behind your head", "clasp your hands behind your neck", "rest your head in both hands behind it",
              "lean into your hands behind your head")), holds=True),
    "behind_back": Family(still(reach(LOWER_BACK, (0.8, -0.3, -0.6)), via=SIDE), Words(
        one=("(put|place|hold|hide|move) your {S} (hand|arm) behind your back", "hide your {S} hand( behind you|)", "touch your (back|lower back) with your {S} hand", "hold your back with your {S} hand", "bring your {S} hand behind you",
             "put your {S} hand on your lower back"),
        any=("put one hand behind your back", "hide something behind your back with one hand"),
        both=("(put|place|hold|clasp|fold|hide) (your|both) hands behind your back", "stand at parade rest", "stand like a butler with your hands behind your back", "hold your hands together behind you", "hide your hands( behind you|)")), holds=True),
    "think": Family(still(reach(CHIN, (0.3, -0.9, 0.4)), head=(0.0, 0.06, -0.07)), Words(
        ("think( hard| about it|)", "look thoughtful", "ponder( the question|)", "act like you are thinking", "wonder( what to do|)", "reflect on it", "consider it"),
        one=("(put|bring|raise) your {S} hand to your chin", "think with your {S} hand on your chin", "(hold|touch|scratch|rub|support) your chin with your {S} hand", "rest your chin on your {S} hand"),
        any=("put your hand to your chin", "touch your chin", "scratch your chin")), sides=ONE, holds=True),
    "salute": Family(still(reach(BROW, (1.0, 0.25, 0.25), -0.3)), Words(
        ("salute( like a soldier| the captain| the general| me|)", "give a (military |)salute", "make a military salute", "greet (me |)like a soldier", "report for duty with a salute"),
        one=("give a {S} handed salute", "bring your {S} hand to your forehead in a salute", "put your {S} hand to your brow", "touch your {S} temple like a soldier", "raise your {S} hand in a salute")), sides=ONE, holds=True),
    "shade_eyes": Family(still(reach(_off(FOREHEAD, 0.0, 0.0, 0.07), (1.0, 0.1, 0.3), -0.9), head=(0.15, -0.05, 0.0)), Words(
        ("shade your eyes", "look into the distance", "look out for ships", "protect your eyes from the sun", "search the horizon", "scan the horizon", "keep a lookout", "look (far |)into the sun", "spy into the distance"),
        one=("shade your eyes with your {S} hand", "hold your {S} hand over your eyes like a visor", "put your {S} hand above your eyes against the sun", "make a visor with your {S} hand")), sides=ONE, holds=True),
    "facepalm": Family(still(reach(_off(EYES, 0.0, 0.0, 0.01), (0.7, -0.5, 0.6)), head=(0.0, 0.2, 0.0)), Words(
        ("(do|make) a facepalm", "facepalm", "be embarrassed", "hide your face in shame", "despair", "show that you cannot believe it", "regret what you did"),
        one=("(cover|hide) your (face|eyes) with your {S} hand", "put your {S} hand over your (face|eyes)", "lay your {S} palm on your face", "drop your face into your {S} hand"),
        any=("cover your face with one hand", "put your hand on your face")), sides=ONE, holds=True),
    "forehead": Family(still(reach(FOREHEAD, (0.8, 0.0, 0.5))), Words(
        ("check your temperature", "feel whether you have a fever", "feel your forehead", "act as if you have a headache"),
        one=("(put|lay|hold|press) your {S} hand (on|against|to) your forehead", "touch your forehead with your {S} hand", "feel your forehead with your {S} hand", "bring your {S} palm to your forehead", "hit your forehead with your {S} palm"),
        any=("touch your forehead", "put a hand on your forehead")), sides=ONE, holds=True),
    "wipe_brow": Family(strokes(reach(_off(FOREHEAD, -0.07), (0.9, 0.1, 0.5)), reach(_off(FOREHEAD, 0.14, 0.0, -0.03), (1, 0.1, 0.3)), 0.9), Words(
        ("wipe your (brow|forehead) {n}", "wipe the sweat (off|from) your (brow|forehead) {n}", "show that you are relieved by wiping your brow", "mop your brow {n}", "dry your forehead {n}", "brush your hair from your forehead {n}", "show that you are hot and sweating")),
        sides=ONE, counts=(1,)),
    "heart": Family(still(reach(HEART, (0.6, -0.8, 0.0), 0.2)), Words(
        ("show that you are (grateful|touched|moved)", "thank me from your heart", "sing the national anthem"),
        one=("(put|place|lay|hold|press) your {S} hand (on|over) your (heart|chest)", "touch your (chest|heart) with your {S} hand", "swear with your {S} hand on your heart", "bring your {S} hand to your heart"),
        any=("put your hand on your heart", "place a hand on your chest", "touch your heart", "hold your hand over your heart")), sides=ONE, holds=True),
    "beat_chest": Family(_beat_chest, Words(
        ("beat your chest {n}", "drum on your chest {n}", "act like (a gorilla|Tarzan|King Kong)", "hit your chest {n}", "thump your chest {n}", "pound (on |)your chest {n}"),
        one=("beat your chest with your {S} fist {n}",), both=("beat your chest with both fists {n}", "thump your chest with both hands {n}"),
        alternating=("beat your chest like a gorilla {n}", "drum on your chest with both fists one after the other {n}")), sides=ALL, counts=(3, 4)),
    "belly_rub": Family(loops(circle(BELLY, 0.075, "front"), 0.95), Words(
        ("rub your (belly|stomach|tummy) {n}", "(stroke|pat) your (belly|stomach|tummy) in circles {n}", "show that you are hungry", "show that it was tasty", "massage your (belly|stomach) {n}", "circle your hand on your (belly|stomach) {n}", "say yummy by rubbing your belly {n}")),
        sides=ONE, counts=(2, 3)),
    "hold_belly": Family(still(reach(BELLY, (0.9, -0.4, -0.1))), Words(
        one=("(put|place|lay|hold) your {S} hand on your (belly|stomach)", "hold your (belly|stomach) with your {S} hand", "touch your (belly|stomach) with your {S} hand"),
        any=("put a hand on your belly",),
        both=("(put|place|lay|hold) both hands on your (belly|stomach)", "hold your (belly|stomach|tummy)", "hold your stomach as if it hurts", "have a stomach ache", "laugh and ^hold your belly", "show that your stomach hurts")), holds=True),
    "listen": Family(still(reach(_off(EAR, 0.03, 0.0, 0.02), (0.9, -0.4, -0.2)), head=(0.1, 0.0, 0.12)), Words(
        ("listen( carefully| closely| to the noise|)", "show that you (are listening|cannot hear me)", "try to hear something", "strain your ears", "say speak up"),
        one=("cup your {S} ear", "(put|hold|cup) your {S} hand (to|behind) your {S} ear", "listen with your {S} hand at your ear", "listen with your {S} ear", "bring your {S} hand to your ear to listen"),
        any=("cup your ear", "cup a hand behind your ear")), sides=ONE, holds=True),
    "phone": Family(still(reach(_off(EAR, 0.01, -0.03, 0.03), (0.5, -0.85, 0.1), 0.3), (1.0, 2.4)), Words(
        ("answer the phone", "make a (phone |)call", "talk on the (phone|telephone)", "pretend to (call|phone) someone", "phone home", "call someone", "take a phone call", "pick up the telephone"),
        one=("hold a phone to your {S} ear", "put the phone to your {S} ear", "hold a (mobile|cell) phone with your {S} hand", "listen to the phone with your {S} ear")), sides=ONE, holds=True),
    "cover_ears": Family(still(reach(EAR, (0.9, 0.0, 0.2))), Words((
        "cover (your|both) ears( with both hands|)", "(put|press|hold) your hands (on|over) your ears", "close your ears", "block out the noise", "protect your ears from the noise", "plug your ears", "refuse to listen with your hands over your ears",
        "act as if it is too loud", "hear no evil", "hold (your|both) ears", "keep your ears covered", "stop your ears with both hands", "show that it is too loud")), sides=BOTH, holds=True),
    "cover_eyes": Family(still(reach(_off(EYES, 0.02, 0.0, 0.02), (0.8, -0.3, 0.5))), Words((
        "cover (your|both) eyes( with both hands|)", "(put|press|hold) both hands over your (eyes|face)", "hide your face (in|behind) (your|both) hands", "see no evil", "play hide and seek", "hide behind your hands", "bury your face in your hands",
        "cover your face( with both hands|)", "cry into your hands", "refuse to see it", "do not look and ^cover your eyes")), sides=BOTH, holds=True),
    "kiss": Family(_kiss, Words(
        ("blow (a kiss|me a kiss) {n}", "send (a kiss|me a kiss|kisses) {n}", "throw (a kiss|me a kiss|kisses to the audience) {n}", "blow {N} kisses", "give an air kiss {n}", "kiss your hand and ^blow", "blow a kiss goodbye"),
        both=("throw kisses with both hands {n}",)), counts=(1,)),
    "hush": Family(still(reach(_off(MOUTH, 0.0, -0.02, 0.02), (0.5, -0.85, 0.3))), Words(
        ("hush", "say (hush|shh|be quiet)", "tell (me|everybody) to be quiet", "(make|give) a (quiet|silence|hush) (sign|gesture)", "ask for silence", "call for quiet", "put a finger to your lips", "shush (me|everyone|the class)", "keep a secret", "show that it is secret"),
        one=("put your {S} (finger|index finger) to your lips", "hold your {S} finger to your mouth")), sides=ONE, holds=True),
    "cover_mouth": Family(still(reach(_off(MOUTH, 0.0, 0.0, 0.01), (0.8, -0.5, 0.4))), Words(
        ("cover your mouth", "gasp in shock", "act shocked", "cough( politely|)", "giggle( behind your hand|)", "sneeze into your hand", "show that you are shocked"),
        one=("(put|hold|press) your {S} hand (over|to|on) your mouth", "cover your mouth with your {S} hand", "cough into your {S} hand"),
        both=("cover your mouth with both hands", "put both hands over your mouth", "speak no evil")), holds=True),
    "yawn": Family(_yawn, Words(
        ("yawn( loudly| and ^lean back| sleepily|)", "act (sleepy|as if you just woke up)", "show that you are (sleepy|bored to death)", "give a (big |long |)yawn", "yawn behind your hand", "let out a yawn", "be sleepy", "cover a yawn", "pretend to yawn", "stifle a yawn")),
        sides=ONE),
    "drink": Family(still(reach(_off(MOUTH, 0.02, 0.0, 0.03), (0.7, -0.65, 0.3), 0.4), (0.6, 1.4), head=(0.0, -0.16, 0.0)), Words(
        ("drink( some water| a glass of water| a cup of tea|)", "take a (drink|sip|sip of coffee)", "pretend to drink( from a cup|)", "sip (your tea|a coffee)", "have a drink", "empty your glass"),
        one=("drink from a (glass|cup|bottle) with your {S} hand", "lift a (cup|glass) to your lips with the {S} hand", "bring your {S} hand to your mouth to drink", "hold a cup to your mouth with your {S} hand")), sides=ONE, holds=True),
    "eat": Family(strokes(reach((0.12, -0.3, 0.36), ELBOW_DOWN, 0.5), reach(_off(MOUTH, 0.0, -0.01, 0.02), (0.6, -0.75, 0.2), 0.6), 1.1, 0.48), Words(
        ("eat( with a spoon| soup| something| an apple|) {n}", "have (a meal|dinner|lunch)", "pretend to eat {n}", "take (a bite|{N} bites)", "bring food to your mouth {n}", "feed yourself {n}", "spoon up your soup {n}", "act as if you are eating {n}")),
        sides=ONE, counts=(2, 3)),
    "brush_teeth": Family(strokes(reach(_off(MOUTH, -0.03, 0.0, 0.03), (1, -0.2, 0.2)), reach(_off(MOUTH, 0.09, 0.0, 0.03), (1, -0.2, 0.2)), 0.55), Words(
        ("brush your teeth {n}", "clean your teeth {n}", "pretend to brush your teeth {n}", "use a toothbrush", "scrub your teeth {n}", "do your morning tooth brushing", "move a toothbrush in front of your mouth {n}", "(scrub|polish) your front teeth {n}", "brush (left and right|back and forth) in front of your mouth {n}")), sides=ONE, counts=(4, 5)),
    "scratch_head": Family(strokes(reach(_off(CROWN, 0.05, 0.0, 0.03), ELBOW_UP), reach(_off(CROWN, 0.08, -0.05, -0.09), ELBOW_UP), 0.55), Words(
        ("scratch (your|the top of your) head {n}", "scratch your head in confusion {n}", "ruffle your hair {n}", "comb your hair {n}", "look (puzzled|confused) and ^scratch your head", "wash your hair {n}", "run your hand through your hair {n}", "show that you are puzzled")),
        sides=ONE, counts=(3, 4)),
    "pat_head": Family(strokes(reach(_off(CROWN, 0.03, 0.11), ELBOW_UP), reach(CROWN, ELBOW_UP), 0.55), Words(
        ("pat (your head|yourself on the head|the top of your head) {n}", "tap (the top of your head|your head) {n}", "touch the top of your head {n}", "clap (yourself |)on the head {n}", "give your head {N} pats", "knock on your own head {n}")), sides=ONE, counts=(2, 3)),
    "touch_shoulder": Family(still(reach(OTHER_SHOULDER, (0.5, -0.4, 0.8))), Words(
        one=("(put|place|lay|rest) your {S} hand on your (other|opposite) shoulder", "touch your opposite shoulder with your {S} hand", "reach across to your other shoulder with your {S} hand", "hold your (other|opposite) shoulder with your {S} hand",
             "bring your {S} hand across to the other shoulder", "pat your own back with your {S} hand"),
        any=("touch your shoulder", "pat yourself on the shoulder"),
        both=("hug yourself", "(put|place) both hands on your (opposite |)shoulders", "hold your shoulders with crossed arms", "act as if you are cold", "wrap your arms around yourself", "shiver with cold", "give yourself a hug", "cross your hands on your shoulders")), holds=True),
    "pray": Family(still(reach((0.035, -0.14, 0.24), (0.9, -0.45, 0.0))), Words((
        "pray( silently|)", "put your (hands|palms) together( in prayer|)", "(make|say) a namaste", "greet (me |)with a namaste", "fold your hands in prayer", "press your palms together in front of your chest", "hold your hands together as if praying",
        "say namaste", "join your hands in front of your chest", "beg with folded hands", "say grace", "greet (me |)the Indian way", "thank me with folded hands", "ask for forgiveness with folded hands", "plead with me")), sides=BOTH, holds=True),
    "rub_hands": Family(strokes(reach((0.035, -0.22, 0.20), (0.8, -0.6, 0)), reach((0.035, -0.22, 0.30), (0.8, -0.6, 0)), 0.5), Words((
        "rub your (hands|palms)( together| against each other|) {n}", "warm your hands {n}", "wash your hands {n}", "rub both palms together {n}", "look forward to it and ^rub your hands", "rub your hands (with glee|in anticipation|because it is cold)", "soap your hands {n}",
        "put cream on your hands", "show that you are cold by rubbing your hands", "plot something evil", "(clean|disinfect) your hands {n}", "warm up your cold hands")), sides=BOTH, counts=(3, 4)),
    "clasp_hands": Family(still(reach((0.02, -0.32, 0.22), (0.8, -0.6, -0.1))), Words((
        "(clasp|fold|join) your hands( in front of you| in front of your belly|)", "hold your own hands", "stand with (clasped|folded) hands", "hold your hands together in front of you", "wait politely with your hands together", "interlace your fingers", "put one hand in the other",
        "rest your hands in front of your body", "stand like a waiter with hands joined", "link your hands at the front", "bring your hands together (low in front of you|before your belly)", "lay one hand over the other in front of you")), sides=BOTH, holds=True),
    "watch_time": Family(still(reach((0.02, -0.17, 0.34), (0.9, -0.5, 0.0), -0.7), head=(0.1, 0.3, 0.0)), Words(
        ("check the time", "look at (your watch|the time)", "show your watch", "read your (wrist watch|wristwatch|watch)", "tell me that it is late", "act as if you are late", "point out that time is short"),
        one=("look at the watch on your {S} (arm|wrist)", "check the time on your {S} wrist", "raise your {S} wrist to read the time", "show (me |)the watch on your {S} wrist"), any=("glance at your wrist",)), sides=ONE, holds=True),
    "sternum_fist": Family(strokes(reach(_off(STERNUM, 0.06, 0.02, 0.12)), reach(_off(STERNUM, -0.02, 0.03, -0.07)), 0.7), Words(
        ("tap your chest {n}", "pat your (chest|heart) {n}", "tap (on |)your heart {n}", "knock on your chest {n}", "give your chest {N} taps", "say it was me by tapping your chest {n}", "touch your chest {n}", "beat your heart (gently|softly) {n}")), sides=ONE, counts=(2, 3)),
}  # fmt: skip
