"""Arm poses that are taken and kept: raised, stretched, lowered, held out."""

from __future__ import annotations

from mmm_core.corpus.families.gesture import ANY, BOTH, ONE, Family, Gesture, Words
from mmm_core.corpus.families.strokes import arms_to, keep, pair_to, reach_s, still, vary
from mmm_core.corpus.reach import ELBOW_OUT, HIP, reach
from mmm_core.corpus.score import SIDE, ArmPose, Score

_UP = ArmPose((0.22, 0.9, 0.3), (0.08, 0.98, 0.12))
_HALF_UP = ArmPose((0.2, -0.05, 0.97), (0.08, 0.3, 0.95))
_SIDEWAYS = ArmPose((1, 0.02, 0.08), (1, 0.04, 0.1), -0.6)
_WIDE_UP = ArmPose((0.62, 0.75, 0.12), (0.62, 0.78, 0.08))


def _raise(score: Score, g: Gesture) -> None:
    pose = _HALF_UP if g.height == "low" else _UP
    arms_to(score, g, pose, amount=0.035, via=SIDE if score.rng.random() < 0.25 else (0.35, 0.0, 0.95))
    keep(score, g)


def _hands_up(score: Score, g: Gesture) -> None:
    pose = vary(score, ArmPose((0.28, 0.92, 0.15), (0.1, 0.98, 0.08)))
    via = SIDE if score.rng.random() < 0.3 else (0.35, 0.0, 0.95)
    score.move(reach_s(score, g, pose), via, left=pose, right=pose)
    keep(score, g)


def _arms_down(score: Score, g: Gesture) -> None:
    """Starts away from rest: the acting arms come down to the sides."""
    start = vary(score, _UP if score.rng.random() < 0.4 else ArmPose((0.5, 0.1, 0.75), (0.35, 0.3, 0.85))).vector()
    for arm in g.arms:
        score.start_at(arm, start)
    score.hold(score.rng.uniform(0.1, 0.3))
    duration = reach_s(score, g, score.rest[g.arms[0]])
    score.move(duration, SIDE if score.rng.random() < 0.3 else (0.4, 0, 0.9), **{a: score.rest[a] for a in g.arms})
    score.hold(score.rng.uniform(0.3, 1.2))


def _stretch(score: Score, g: Gesture) -> None:
    """Both arms long overhead; to a side the trunk bends with them."""
    side = {"left": 1.0, "right": -1.0}.get(g.direction, 0.0)
    pose = vary(score, ArmPose((0.12, 0.97, 0.12), (-0.18, 0.97, 0.08), 0.8), 0.03)
    duration = 1.2 * reach_s(score, g, pose)
    score.move(duration, SIDE, left=pose, right=pose, trunk=(0.0, -0.05, 0.0), head=(0.0, -0.1, 0.0))
    if side:
        score.move(reach_s(score, g) * 1.6, trunk=(0.0, 0.0, side * score.rng.uniform(0.26, 0.36) * g.size))
    keep(score, g, (0.6, 1.6))


def _superhero(score: Score, g: Gesture) -> None:
    pair_to(score, g, ArmPose((0.15, 0.72, 0.68), (0.02, 0.72, 0.7), -0.8), reach(HIP, ELBOW_OUT))
    keep(score, g)


POSES: dict[str, Family] = {
    "raise": Family(_raise, Words(
        one=("(raise|lift) (your|the) {S} (hand|arm)", "(raise|lift) your {S} (hand|arm) up", "put (your|the) {S} (hand|arm) up", "put your {S} arm up in the air",
             "hold (your|the) {S} hand up high", "raise the {S} arm above your head", "stretch your {S} arm up", "bring your {S} hand up", "reach up with your {S} hand",
             "move your {S} arm up", "lift the {S} hand over your head", "reach for the (sky|ceiling) with your {S} (hand|arm)", "volunteer with your {S} hand",
             "ask a question with your {S} hand raised", "stick your {S} (hand|arm) up", "raise your {S} (hand|arm) like a pupil"),
        any=("raise (your|a|one) hand", "put your hand up", "raise one arm", "lift one hand up", "volunteer", "raise your hand to ask a question", "put one arm up")),
        sides=ONE, holds=True, heights=True),
    "hands_up": Family(_hands_up, Words(
        ("(raise|lift) (both|your) (hands|arms)( up|)", "put (your|both) (hands|arms) up( in the air|)", "(raise|lift) (your|both) (arms|hands) (above|over) your head",
         "stretch both arms up", "hold (both|your) (arms|hands) up( high|)", "reach for the sky with both hands", "surrender( with your hands up|)", "bring both hands up over your head",
         "give up with your hands raised", "stick both (hands|arms) up")), sides=BOTH, holds=True),
    "arms_down": Family(_arms_down, Words(
        one=("lower (your|the) {S} (arm|hand)", "put your {S} (arm|hand) (down|back down)", "drop your {S} arm", "bring (your|the) {S} (hand|arm) down", "let your {S} arm hang( down|)", "relax your {S} arm",
             "take your {S} (hand|arm) down", "move your {S} (hand|arm) down", "rest your {S} arm at your side"),
        any=("lower your arm", "put your hand down", "lower one arm"),
        both=("lower (both|your) (arms|hands)", "put (your|both) (arms|hands) down", "bring both arms down", "let (your|both) arms hang( by your sides|)", "relax (your|both) arms",
              "put both arms by your sides", "drop (both|your) arms", "rest your arms", "take your (hands|arms) down")), starts_away=True),
    "arm_forward": Family(still(ArmPose((0.1, -0.03, 1), (0.02, 0.03, 1), -0.5)), Words(
        one=("(stretch|extend) (your|the) {S} arm (forward|in front of you|to the front)", "hold your {S} arm out in front( of you|)", "reach forward with your {S} (hand|arm)",
             "put your {S} arm straight out in front", "raise your {S} arm forward( to shoulder height|)", "lift your {S} arm to the front", "reach out your {S} hand to the front",
             "straighten your {S} arm forward", "move your {S} arm (forward|to the front)"),
        any=("reach forward", "stretch one arm forward"),
        both=("(stretch|extend|raise) both arms forward", "hold (your|both) arms out in front of you", "put both arms straight out in front", "reach forward with both hands",
              "lift both arms to the front", "stretch your arms out (forward|in front of you)")), holds=True),
    "zombie": Family(still(ArmPose((0.12, 0.02, 1), (-0.02, -0.08, 1), -0.9), trunk=(0.0, 0.08, 0.0), head=(0.0, -0.05, 0.22)), Words(
        ("act like a zombie", "be a zombie", "hold your arms out like a zombie", "pretend to be (a zombie|the living dead|Frankenstein's monster|a mummy)", "make (a zombie|a mummy) pose",
         "stand like a (zombie|mummy)", "sleepwalk on the spot", "stretch your arms out like a (sleepwalker|zombie|mummy)", "imitate a (zombie|sleepwalker)", "play a zombie", "scare me like a zombie",
         "do the zombie", "turn into a zombie", "look like a zombie")), sides=BOTH, holds=True),
    "arm_side": Family(still(_SIDEWAYS, via=SIDE), Words(
        one=("raise your {S} arm to the side", "(hold|put) your {S} arm out to the side", "stretch your {S} arm out sideways", "extend (your|the) {S} arm (to the side|sideways)", "lift (your|the) {S} arm (sideways|to the side)",
             "stretch (your|the) {S} (arm|hand) to the side", "move your {S} arm out to the side", "reach out to the side with your {S} (arm|hand)", "spread your {S} arm", "straighten your {S} arm to the side",
             "raise the {S} arm sideways to shoulder height"),
        any=("raise one arm to the side", "stretch one arm out sideways")), sides=ONE, holds=True),
    "t_pose": Family(still(_SIDEWAYS, via=SIDE), Words(
        ("hold your arms out to the sides", "(make|do|take|strike) a T pose", "spread (your|both) arms", "(stretch|extend|raise|lift) both arms (out |)to the sides", "raise both arms (sideways |)to shoulder height",
         "hold both arms out sideways", "extend your arms sideways", "put your arms out like a scarecrow", "spread both arms wide like a T", "form the letter T", "put both arms out",
         "stand (with arms out|like a scarecrow|like a cross)", "balance with your arms out", "fly like (a plane|an airplane|an aeroplane)")), sides=BOTH, holds=True),
    "stretch": Family(_stretch, Words(), sides=BOTH, directions=("up", "left", "right"), directed={
        "up": Words(("stretch( yourself|)", "stretch your (whole body|back|arms and back)", "stretch up( high| tall|)", "stretch like (a cat|after a long sleep)", "have a (good |long |)stretch",
                     "wake up and ^stretch", "make yourself tall", "reach up and ^stretch", "lengthen your body upwards")),
        "left": Words(("stretch (to the |to your |)left( side|)", "do a side stretch to the left", "bend to the left with your arms (overhead|over your head)", "stretch your body (over |)to the left",
                       "lean left with both arms up", "raise both arms and ^bend to the left")),
        "right": Words(("stretch (to the |to your |)right( side|)", "do a side stretch to the right", "bend to the right with your arms (overhead|over your head)", "stretch your body (over |)to the right",
                        "lean right with both arms up", "raise both arms and ^bend to the right")),
    }, holds=True),
    "victory": Family(still(_WIDE_UP, via=SIDE), Words(
        ("raise your arms in a V", "make a (V|Y) (with your arms|pose)", "form the letter (V|Y)( with your arms|)", "do a victory pose", "hold your arms up in victory", "raise both arms in triumph", "pose like a winner",
         "spread your arms up (wide|to the sky)", "stand like a champion", "show that you won", "lift both arms up and out", "raise both arms wide above you", "strike a victory pose")), sides=BOTH, holds=True),
    "superhero": Family(_superhero, Words(
        ("fly like (Superman|a superhero)", "(make|strike|do) a superhero pose", "act like Superman", "stretch one fist up and ^fly", "pose like a flying hero"),
        one=("fly like a superhero with your {S} (fist|arm) first", "stretch your {S} fist to the sky like Superman", "strike a superhero pose with your {S} arm up",)), sides=ONE, holds=True),
    "flex": Family(still(ArmPose((1, 0.05, 0.1), (-0.15, 0.98, 0.1), 0.5), via=SIDE), Words(
        one=("flex (your|the) {S} (arm|biceps|bicep|muscles)", "show (your|me your) {S} (muscle|biceps)", "show off your {S} arm muscle", "tense your {S} (biceps|arm)", "make a muscle with your {S} arm", "pose your {S} biceps"),
        any=("flex one arm", "make a muscle"),
        both=("flex (your muscles|both arms|your biceps)", "show (your muscles|me your muscles|how strong you are)", "pose like a (bodybuilder|strong man)", "make a strong man pose", "show off your muscles", "tense both biceps")), holds=True),
    "stop": Family(still(ArmPose((0.2, -0.25, 0.95), (0.02, 0.62, 0.8), -0.6)), Words(
        ("make a (stop|halt) (sign|gesture)", "stop (the traffic|the cars|me)", "tell me to stop", "show (me |)a stop gesture", "give a (halt|stop) sign", "refuse"),
        one=("hold up your {S} hand to say stop", "show (your|me your) {S} palm", "put your {S} palm out( to stop me|)", "hold your {S} palm out in front of you", "say stop with your {S} hand", "keep me away with your {S} palm"),
        any=("hold your palm out", "say stop"), both=("hold up both palms", "put both palms out in front of you", "show (me |)both your palms", "keep me away with both palms")), holds=True),
    "oath": Family(still(ArmPose((0.7, -0.68, 0.15), (0.22, 0.95, 0.2), -0.4)), Words(
        ("swear an oath", "take an oath", "swear to tell the truth", "make a promise", "promise( me something| solemnly|)", "vow( solemnly|)", "swear in court"),
        one=("raise your {S} hand to swear", "hold your {S} palm up beside your shoulder", "hold up your {S} hand like a witness", "swear in court with your {S} hand up", "raise your {S} palm next to your head")), sides=ONE, holds=True),
    "offer": Family(still(ArmPose((0.3, -0.75, 0.5), (0.15, 0.05, 1.0), 1.3)), Words(
        one=("offer (your|me your) {S} hand", "hold out (your|the) {S} hand", "hold your {S} hand out palm up", "(ask for|offer|present|give me) something with your {S} hand", "reach out your {S} hand", "give me your {S} hand", "beg with your {S} hand",
             "turn your {S} palm up in front of you"),
        any=("offer (a hand|me something|me your hand)", "hold out your hand", "give me your hand", "beg for money"),
        both=("hold out both hands( palms up|)", "(offer|present|receive|give me) something with both hands", "beg with both hands", "show me your empty hands", "turn both palms up")), sides=ANY, holds=True),
    "carry": Family(still(ArmPose((0.25, -0.9, 0.25), (-0.12, 0.02, 1.0), 1.0)), Words(
        ("carry (a box|a tray|a crate|a parcel|a basket|something heavy)( in front of you| in your arms|)", "hold a (box|tray|crate|big ball|baby) in (front of you|your arms)", "hold something big( in your arms|)", "pretend to (hold|carry) a (box|baby|heavy box)",
         "cradle a baby", "carry (wood|the shopping) with both arms", "hold your forearms out in front")), sides=BOTH, holds=True),
    "block": Family(still(ArmPose((0.35, -0.25, 0.9), (-0.35, 0.93, 0.15), 0.3)), Words(
        ("block( a punch| the hit| the blow|)", "guard your face", "protect (your face|yourself|your head)", "parry( the blow|)", "defend yourself", "cover up"),
        one=("block with your {S} (forearm|arm)", "guard your face with your {S} (arm|forearm)", "hold your {S} forearm up in front of your face", "parry with your {S} forearm"),
        both=("block with both (forearms|arms)", "put your guard up", "hold both forearms in front of your face", "take a boxing guard", "guard yourself with both arms")), holds=True),
}  # fmt: skip
