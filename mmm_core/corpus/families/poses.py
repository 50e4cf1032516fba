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
             "ask a question with your {S} hand raised", "stick your {S} (hand|arm) up", "raise your {S} (hand|arm) like a pupil",
             "~{S} (arm|hand) up", "~{S} (arm|hand) (raised|lifted)", "~{S} (arm|hand) (up high|up in the air|up above your head|straight up)",
             "~(your|the) {S} (arm|hand) (goes|comes|moves|is|should be) up", "~(your|the) {S} (arm|hand) (rises|is raised|is lifted|should be raised)", "~a raised {S} (arm|hand)",
             "~a raise of the {S} arm", "~the {S} arm goes (up high|up above the head|up over the head)", "~your {S} (hand|arm) reaches for the (sky|ceiling)", "~only the {S} (arm|hand) up",
             "~(all the way up|up) with (your|the) {S} (arm|hand)", "~up goes (your|the) {S} (arm|hand)", "let me see your {S} (arm|hand) up in the air", "get (your|the) {S} (arm|hand) up",
             "pop your {S} hand up", "shoot your {S} (hand|arm) up", "throw your {S} arm up in the air", "set (your|the) {S} arm straight up", "flex the {S} shoulder until your hand is up high",
             "extend (your|the) {S} arm (up|straight up|up above your head)", "have your {S} (arm|hand) up", "keep (your|the) {S} arm up", "send your {S} arm up", "reach up high with your {S} arm",
             "touch the (ceiling|sky) with your {S} hand", "vote with your {S} hand up", "put up your {S} hand like a pupil in class", "bid at the auction with your {S} hand up"),
        any=("raise (your|a|one) hand", "put your hand up", "raise one arm", "lift one hand up", "volunteer", "raise your hand to ask a question", "put one arm up",
             "~one (arm|hand) up", "~a raised (arm|hand)", "~an arm up in the air", "~a hand (up in the air|goes up)", "~(hand|arm) up", "~one (arm|hand) (raised|lifted|goes up)",
             "~up goes (your|one) (arm|hand)", "~your (arm|hand) goes up", "raise an arm", "stick (your|one|a) hand up", "put an arm up in the air", "get (your|a) hand up", "let me see a hand up",
             "ask for permission to speak with your hand up", "vote with your hand up")),
        sides=ONE, holds=True, heights=True),
    "hands_up": Family(_hands_up, Words(
        ("(raise|lift) (both|your) (hands|arms)( up|)", "put (your|both) (hands|arms) up( in the air|)", "(raise|lift) (your|both) (arms|hands) (above|over) your head",
         "stretch both arms up", "hold (both|your) (arms|hands) up( high|)", "reach for the sky with both hands", "surrender( with your hands up|)", "bring both hands up over your head",
         "give up with your hands raised", "stick both (hands|arms) up",
        "~(hands|arms) up (high|in the air|above your head|)", "~both (hands|arms) up (high|in the air|)", "~(your|both) (hands|arms) (go|come|should be) up",
        "~both arms (rise above the head|are raised|are up|are above the head)", "~both arms raised (straight up|overhead|)", "~(two|both) hands in the air", "~arms (overhead|straight up)",
        "~hands in the air like in a bank robbery", "~up with (your hands|both arms|both hands)", "~up go (both|your) (arms|hands)", "~a surrender (with raised hands|)",
        "~your (hands|arms) are high above your head", "get (your|both) hands up", "throw (your|both) (hands|arms) up", "put your hands in the air (like you just do not care|)",
        "let me see (your|both) hands up", "act as if you are (under arrest|being robbed)", "give yourself up with both hands raised", "capitulate with your hands up", "shoot both arms up",
        "extend both arms (up|overhead|upwards)", "set both arms straight up", "hold (your|both) arms (overhead|straight up)", "lift both arms (overhead|to the heavens)",
        "flex both shoulders until your arms are overhead", "reach up high with both (arms|hands)", "raise your arms (overhead|to the sky|to the heavens)", "have both (arms|hands) up")), sides=BOTH, holds=True),
    "arms_down": Family(_arms_down, Words(
        one=("lower (your|the) {S} (arm|hand)", "put your {S} (arm|hand) (down|back down)", "drop your {S} arm", "bring (your|the) {S} (hand|arm) down", "let your {S} arm hang( down|)", "relax your {S} arm",
             "take your {S} (hand|arm) down", "move your {S} (hand|arm) down", "rest your {S} arm at your side",
             "~{S} (arm|hand) down", "~{S} arm (lowered|back at your side|by your side)", "~(your|the) {S} (arm|hand) (goes|comes|moves|sinks|drops|should go) (down|back down)",
             "~your {S} (arm|hand) (returns|goes back) to your side", "~a lowered {S} arm", "~down with (your|the) {S} (arm|hand)", "~down goes your {S} (arm|hand)",
             "~the {S} arm (is lowered|hangs down|hangs loose|hangs limp)", "let (your|the) {S} (arm|hand) (sink|fall|drop)", "return (your|the) {S} (arm|hand) to your side",
             "get your {S} (arm|hand) down", "bring your {S} (arm|hand) back to your side", "set (your|the) {S} arm to the rest position", "place your {S} arm at your side",
             "ease your {S} (arm|hand) down", "park your {S} arm by your side", "hang your {S} arm (down|by your side)", "lower the {S} arm (again|to your side)", "take the {S} (arm|hand) down again"),
        any=("lower your arm", "put your hand down", "lower one arm",
             "~(arm|hand) down", "~one arm (down|goes down|sinks|is lowered)", "~your (arm|hand) (comes|goes|sinks) down", "~the arm (goes|comes) back down", "let your arm (drop|sink|hang)",
             "get your (hand|arm) down", "take your (hand|arm) down", "return your arm to your side"),
        both=("lower (both|your) (arms|hands)", "put (your|both) (arms|hands) down", "bring both arms down", "let (your|both) arms hang( by your sides|)", "relax (your|both) arms",
              "put both arms by your sides", "drop (both|your) arms", "rest your arms", "take your (hands|arms) down",
             "~(arms|hands|both arms|both hands) down", "~(your|both) (arms|hands) (go|come|sink|drop) (down|back down)", "~arms (at|by) your sides", "~(your|both) arms (return|go back) to your sides",
             "~down with (your arms|both arms|your hands)", "~both arms (are lowered|hang down|hang loose)", "~lowered arms", "~down go both (arms|hands)", "let (your|both) (arms|hands) (sink|fall|drop)",
             "return (your|both) arms to (your sides|the rest position)", "get your (hands|arms) down", "hang both arms (down|by your sides)", "set both arms to the rest position",
             "bring (your|both) arms back to your sides", "ease both arms down", "put your hands by your trouser seams", "straighten both arms down along your body")), starts_away=True),
    "arm_forward": Family(still(ArmPose((0.1, -0.03, 1), (0.02, 0.03, 1), -0.5)), Words(
        one=("(stretch|extend) (your|the) {S} arm (forward|in front of you|to the front)", "hold your {S} arm out in front( of you|)", "reach forward with your {S} (hand|arm)",
             "put your {S} arm straight out in front", "raise your {S} arm forward( to shoulder height|)", "lift your {S} arm to the front", "reach out your {S} hand to the front",
             "straighten your {S} arm forward", "move your {S} arm (forward|to the front)",
             "~{S} arm (forward|straight ahead|out in front|to the front|straight out in front)", "~(your|the) {S} arm (goes|reaches|is stretched|stretches|extends|should be) forward",
             "~(your|the) {S} arm (stretched|held) out in front (of you|)", "~your {S} arm sticks out in front of you", "~a forward reach with (your|the) {S} arm", "~a forward stretch of the {S} arm",
             "~{S} arm horizontal in front of you", "~a front raise of the {S} arm", "flex (your|the) {S} shoulder to ninety degrees", "set (your|the) {S} arm to horizontal in front of you",
             "stick your {S} arm (straight |)out in front (of you|)", "hold the {S} arm out ahead of you", "lengthen your {S} arm forward", "reach (ahead|out in front) with your {S} (arm|hand)",
             "bring (your|the) {S} arm (forward|to the front) to shoulder height", "raise your {S} arm straight ahead", "make your {S} arm (long|straight) in front of you",
             "lock your {S} elbow with the arm out in front", "do a front raise with your {S} arm", "hold your {S} arm parallel to the floor in front of you"),
        any=("reach forward", "stretch one arm forward",
             "~one arm (forward|straight out in front|to the front)", "~an arm (stretched|held) out in front", "~a forward reach (with one arm|)", "extend one arm (forward|to the front)",
             "stick (one|an) arm out in front", "raise (one|an) arm forward", "do a front raise with one arm"),
        both=("(stretch|extend|raise) both arms forward", "hold (your|both) arms out in front of you", "put both arms straight out in front", "reach forward with both hands",
              "lift both arms to the front", "stretch your arms out (forward|in front of you)",
             "~(both arms|arms) (forward|straight ahead|out in front|straight out in front of you)", "~(your|both) arms (go|reach|stretch|extend) forward", "~a forward reach with both arms",
             "~both arms horizontal in front of you", "~both arms (stretched|held) out in front", "~a front raise of both arms", "stick both arms (straight |)out in front (of you|)",
             "flex both shoulders to ninety degrees", "set both arms to horizontal in front of you", "bring both arms (forward|to the front) to shoulder height", "do a front raise with both arms",
             "reach (ahead|out in front) with both (arms|hands)", "lengthen both arms forward", "hold both arms parallel to the floor in front of you",
             "raise your arms (straight ahead|forward to shoulder height)")), holds=True),
    "zombie": Family(still(ArmPose((0.12, 0.02, 1), (-0.02, -0.08, 1), -0.9), trunk=(0.0, 0.08, 0.0), head=(0.0, -0.05, 0.22)), Words(
        ("act like a zombie", "be a zombie", "hold your arms out like a zombie", "pretend to be (a zombie|the living dead|Frankenstein's monster|a mummy)", "make (a zombie|a mummy) pose",
         "stand like a (zombie|mummy)", "sleepwalk on the spot", "stretch your arms out like a (sleepwalker|zombie|mummy)", "imitate a (zombie|sleepwalker)", "play a zombie", "scare me like a zombie",
         "do the zombie", "turn into a zombie", "look like a zombie",
        "~a (zombie|mummy|sleepwalker) (pose|impression|)", "~(zombie|mummy) (arms|pose|mode)", "~an imitation of (a zombie|a sleepwalker|Frankenstein's monster)", "~the (walking|living) dead",
        "~arms out like a (zombie|sleepwalker|mummy)", "~your arms (stick out|are stretched out) like a zombie's", "~you are (a zombie|one of the undead|walking in your sleep)",
        "~a zombie apocalypse", "~a monster like Frankenstein's", "impersonate (the undead|Frankenstein's monster|a mummy|a sleepwalker)", "copy (a zombie|a mummy|a sleepwalker)",
        "walk in your sleep", "rise from the (dead|grave)", "pose (as|like) a (zombie|mummy|sleepwalker)", "go zombie", "groan like a zombie with outstretched arms",
        "behave like (a zombie|the undead|the walking dead)", "move like a (zombie|sleepwalker)", "stagger like one of the undead", "haunt me like a mummy", "reach for brains")), sides=BOTH, holds=True),
    "arm_side": Family(still(_SIDEWAYS, via=SIDE), Words(
        one=("raise your {S} arm to the side", "(hold|put) your {S} arm out to the side", "stretch your {S} arm out sideways", "extend (your|the) {S} arm (to the side|sideways)", "lift (your|the) {S} arm (sideways|to the side)",
             "stretch (your|the) {S} (arm|hand) to the side", "move your {S} arm out to the side", "reach out to the side with your {S} (arm|hand)", "spread your {S} arm", "straighten your {S} arm to the side",
             "raise the {S} arm sideways to shoulder height",
             "~{S} arm (to|out to) the side", "~{S} arm (sideways|out sideways|straight out to the side|horizontal to the side)",
             "~(your|the) {S} arm (goes|stretches|is stretched|reaches|extends|should be) out to the side", "~your {S} arm (sticks|is held) out (sideways|to the side)",
             "~a sideways reach with (your|the) {S} arm", "~a lateral raise (of|with) the {S} arm", "~the {S} arm away from the body to the side", "~half a T pose with the {S} arm",
             "~{S} arm out like a wing", "abduct (your|the) {S} (arm|shoulder) (to ninety degrees|)", "stick your {S} arm out (sideways|to the side)", "do a lateral raise with your {S} arm",
             "set (your|the) {S} arm to horizontal at the side", "signal like a cyclist with your {S} arm out", "lift your {S} arm away from your body to the side", "swing your {S} arm out to the side",
             "bring (your|the) {S} arm (up |)out to the side", "open your {S} arm to the side", "hold your {S} arm like (one half of a T|a wing)", "make half a T with your {S} arm",
             "reach sideways with your {S} (arm|hand)", "lengthen your {S} arm sideways", "keep your {S} arm (straight |)out to the side"),
        any=("raise one arm to the side", "stretch one arm out sideways",
             "~one arm (out sideways|to the side|straight out to the side)", "~an arm out to the side", "~a lateral raise with one arm", "~half a T pose", "stick one arm out (sideways|to the side)",
             "spread one arm", "hold one arm out to the side", "do a lateral raise with one arm", "make half a T")), sides=ONE, holds=True),
    "t_pose": Family(still(_SIDEWAYS, via=SIDE), Words(
        ("hold your arms out to the sides", "(make|do|take|strike) a T pose", "spread (your|both) arms", "(stretch|extend|raise|lift) both arms (out |)to the sides", "raise both arms (sideways |)to shoulder height",
         "hold both arms out sideways", "extend your arms sideways", "put your arms out like a scarecrow", "spread both arms wide like a T", "form the letter T", "put both arms out",
         "stand (with arms out|like a scarecrow|like a cross)", "balance with your arms out", "fly like (a plane|an airplane|an aeroplane)",
        "~a (T pose|letter T|scarecrow|human cross)", "~(T pose|scarecrow pose|airplane arms|aeroplane arms)", "~(both arms|arms) (out to the sides|out sideways|straight out to the sides)",
        "~arms (outstretched|spread) like a (plane|tightrope walker|scarecrow)", "~(your|both) arms (go|stretch|reach|extend|are held) out to (the|both) sides", "~both arms horizontal to the sides",
        "~your body makes (a T|the letter T|a cross)", "~a lateral raise with both arms", "~one arm out to each side", "abduct both (arms|shoulders) (to ninety degrees|)",
        "set both arms to horizontal at the sides", "stick both arms out (sideways|to the sides)", "balance like a tightrope walker", "do a lateral raise with both arms",
        "be a (scarecrow|plane|glider)", "glide like a (plane|glider)", "make (airplane|aeroplane) arms", "pose like (a scarecrow|Christ the Redeemer|the statue in Rio)",
        "hold both arms level out to the sides", "go into (a|the) T pose", "assume the T pose", "form a (T|cross) with your body", "straighten both arms sideways",
        "hold your arms like the wings of a plane", "show me your arm span")), sides=BOTH, holds=True),
    "stretch": Family(_stretch, Words(), sides=BOTH, directions=("up", "left", "right"), directed={
        "up": Words(("stretch( yourself|)", "stretch your (whole body|back|arms and back)", "stretch up( high| tall|)", "stretch like (a cat|after a long sleep)", "have a (good |long |)stretch",
                     "wake up and ^stretch", "make yourself tall", "reach up and ^stretch", "lengthen your body upwards",
        "~a (good|long|big|morning|lazy|) stretch", "~a (full body|whole body|cat's|morning) stretch", "~a stretch (upwards|up tall|after a nap)",
        "~your (whole body|spine) (stretches|lengthens|grows) (up|upwards)", "~your whole body gets long and tall", "~a stretch to wake up", "~the stretch of (a cat|somebody who just got up)",
        "~a stretch for your (tired |)(back|limbs)", "give (your body|your back|yourself) a (good |)stretch", "stretch out (your spine|your whole body|your tired back|)",
        "stretch (your spine|yourself awake|your limbs|your tired bones)", "limber up with a stretch", "get the kinks out of your back", "grow (tall|as tall as you can)",
        "extend your (spine|whole body) upwards", "pull yourself up tall", "stretch like (after a nap|in the morning|when you get out of bed)", "elongate your body",
        "do a (morning|full body|standing) stretch", "make yourself as (long|tall) as you can")),
        "left": Words(("stretch (to the |to your |)left( side|)", "do a side stretch to the left", "bend to the left with your arms (overhead|over your head)", "stretch your body (over |)to the left",
                       "lean left with both arms up", "raise both arms and ^bend to the left",
        "~a (side|lateral) stretch to the left", "~a stretch to (the|your) left (side|)", "~a side bend to the left with (arms overhead|both arms up)", "~side stretch to the left",
        "~both arms (up|overhead) and over to the left", "~your raised arms (lean|go|bend) over to the left with your body", "~a (crescent moon|half moon) pose to the left",
        "~arms overhead, body bent (to the |)left", "make a (crescent|half moon) to the left", "reach over your head to the left with both (arms|hands)",
        "reach up and over to the left with both arms", "arch your body to the left with (arms overhead|both arms up)", "do a lateral stretch (over |)to the left",
        "take your raised arms over to the left", "lift your arms and ^lean (over |)to the left", "bend left like a palm tree with your arms up",
        "raise your arms overhead and ^tip your body to the left")),
        "right": Words(("stretch (to the |to your |)right( side|)", "do a side stretch to the right", "bend to the right with your arms (overhead|over your head)", "stretch your body (over |)to the right",
                        "lean right with both arms up", "raise both arms and ^bend to the right",
        "~a (side|lateral) stretch to the right", "~a stretch to (the|your) right (side|)", "~a side bend to the right with (arms overhead|both arms up)", "~side stretch to the right",
        "~both arms (up|overhead) and over to the right", "~your raised arms (lean|go|bend) over to the right with your body", "~a (crescent moon|half moon) pose to the right",
        "~arms overhead, body bent (to the |)right", "make a (crescent|half moon) to the right", "reach over your head to the right with both (arms|hands)",
        "reach up and over to the right with both arms", "arch your body to the right with (arms overhead|both arms up)", "do a lateral stretch (over |)to the right",
        "take your raised arms over to the right", "lift your arms and ^lean (over |)to the right", "bend right like a palm tree with your arms up",
        "raise your arms overhead and ^tip your body to the right")),
    }, holds=True),
    "victory": Family(still(_WIDE_UP, via=SIDE), Words(
        ("raise your arms in a V", "make a (V|Y) (with your arms|pose)", "form the letter (V|Y)( with your arms|)", "do a victory pose", "hold your arms up in victory", "raise both arms in triumph", "pose like a winner",
         "spread your arms up (wide|to the sky)", "stand like a champion", "show that you won", "lift both arms up and out", "raise both arms wide above you", "strike a victory pose",
        "~a (victory|winner's|champion's|triumphant) pose", "~a (big |)(V|Y) with (your|both) arms", "~arms (up |)in a (V|Y) shape", "~your arms (form|make) a (V|Y)",
        "~the letter (V|Y) (with your arms|)", "~both arms (up and out|up and apart|up and wide)", "~arms raised (in triumph|in victory|in a V)", "~the pose of a (winner|champion|gold medallist)",
        "~your arms go up and (apart|wide) in triumph", "~V for victory with your arms", "raise your arms like (a champion|a winner|a gold medallist)",
        "strike a (winner's|champion's|triumphant) pose", "hold both arms up wide", "make the Y of YMCA", "do the Y (of|in) YMCA", "set both arms diagonally up and out", "throw your arms up in a V",
        "present yourself as the winner", "pose (victoriously|triumphantly|on the winners' podium)", "claim victory with your arms up wide", "cross the finish line with your arms up wide",
        "open your raised arms wide to the sky", "stand like an Olympic winner with your arms up")), sides=BOTH, holds=True),
    "superhero": Family(_superhero, Words(
        ("fly like (Superman|a superhero)", "(make|strike|do) a superhero pose", "act like Superman", "stretch one fist up and ^fly", "pose like a flying hero",
        "~a (superhero|Superman) (flight|pose|impression)", "~the Superman pose", "~a flying superhero", "~up and away like Superman", "~the flight of a superhero", "~superhero (pose|flight)",
        "take off like (Superman|a superhero)", "soar like (Superman|a superhero)", "fly off like (Superman|a superhero)", "strike the Superman pose", "save the world like Superman",
        "fly to the rescue like a superhero", "play (Superman|a flying superhero)", "do a Superman", "zoom through the sky like Superman"),
        one=("fly like a superhero with your {S} (fist|arm) first", "stretch your {S} fist to the sky like Superman", "strike a superhero pose with your {S} arm up",
             "~{S} fist (first|up) like Superman", "~your {S} fist (goes|shoots|is) up like Superman's", "~a flying hero with the {S} fist in front", "~a Superman pose with the {S} (arm|fist) up",
             "~{S} arm up, other hand on the hip, like a flying hero", "~a superhero flight, {S} fist first", "lead with your {S} fist like (Superman|a flying superhero)",
             "lift your {S} fist to the sky and the other hand to your hip", "soar with your {S} fist ahead", "fly with your {S} fist (up|first)", "pose like Superman with your {S} arm up",
             "stretch your {S} fist up and ^fly",)), sides=ONE, holds=True),
    "flex": Family(still(ArmPose((1, 0.05, 0.1), (-0.15, 0.98, 0.1), 0.5), via=SIDE), Words(
        one=("flex (your|the) {S} (arm|biceps|bicep|muscles)", "show (your|me your) {S} (muscle|biceps)", "show off your {S} arm muscle", "tense your {S} (biceps|arm)", "make a muscle with your {S} arm", "pose your {S} biceps",
             "~a (flexed|tensed) {S} biceps", "~{S} biceps (flexed|tensed|on show)", "~a (muscle|biceps|bodybuilder) pose with (your|the) {S} arm", "~your {S} biceps (bulges|is flexed|is tensed)",
             "~a (show|flex) of (your|the) {S} biceps", "~your {S} arm bends up to show the (biceps|muscle)", "~a show of strength with your {S} arm", "bulge your {S} biceps",
             "let me see your {S} (biceps|muscle)", "display your {S} (biceps|muscle)", "contract (your|the) {S} biceps", "make your {S} (biceps|muscle) bulge", "do a biceps pose with your {S} arm",
             "bend your {S} arm to show the (muscle|biceps)", "harden your {S} biceps", "show how strong your {S} arm is", "flex the {S} elbow to show off your muscle"),
        any=("flex one arm", "make a muscle",
             "~a flexed arm", "~one biceps (flexed|on show)", "~a (muscle|biceps) pose with one arm", "~a show of muscle with one arm", "flex a biceps", "show your muscle", "tense one biceps"),
        both=("flex (your muscles|both arms|your biceps)", "show (your muscles|me your muscles|how strong you are)", "pose like a (bodybuilder|strong man)", "make a strong man pose", "show off your muscles", "tense both biceps",
             "~a (strongman|bodybuilder|Popeye|muscle man) pose", "~a double biceps (pose|)", "~both biceps (flexed|tensed|on show)", "~both arms flexed", "~your muscles (bulge|are on show)",
             "~a show of (strength|muscle)", "~a bodybuilder at a contest", "do a (double biceps|bodybuilder|strongman) pose", "pose like (Mr Universe|Arnold Schwarzenegger|Popeye|Hercules)",
             "flaunt your (muscles|biceps)", "let me see your muscles", "make muscles", "prove how strong you are", "bulge both biceps", "act like (Hercules|Popeye|a strongman|a bodybuilder)",
             "display your muscles", "contract both biceps", "strike a bodybuilding pose", "show off your (biceps|physique)")), holds=True),
    "stop": Family(still(ArmPose((0.2, -0.25, 0.95), (0.02, 0.62, 0.8), -0.6)), Words(
        ("make a (stop|halt) (sign|gesture)", "stop (the traffic|the cars|me)", "tell me to stop", "show (me |)a stop gesture", "give a (halt|stop) sign", "refuse",
        "~a (stop|halt) (sign|gesture|signal)", "~a sign to (stop|halt)", "~a signal that says stop", "~a clear (halt|stop)", "~an order to (stop|halt)", "~the sign for stop",
        "halt (the traffic|the cars|the car|everyone)", "signal (me |)to (stop|halt)", "tell (the driver|them|everyone) to (stop|halt)", "order (me|the car|everyone) to stop",
        "motion (me |)to (stop|halt)", "bar my way", "say (halt|no further|not so fast)", "warn me not to come closer", "call a halt", "keep me at bay", "bid me halt"),
        one=("hold up your {S} hand to say stop", "show (your|me your) {S} palm", "put your {S} palm out( to stop me|)", "hold your {S} palm out in front of you", "say stop with your {S} hand", "keep me away with your {S} palm",
             "~{S} palm (out|forward|towards me|to the front)", "~your {S} palm (faces forward|is held out|says stop)", "~{S} hand out to (stop|halt) (me|the traffic)", "~a flat {S} (hand|palm) held out",
             "~a stop sign (with|from) the {S} hand", "~{S} hand raised in a stop sign", "~your {S} hand says stop", "hold (your|the) {S} hand out flat to stop me",
             "hold up your {S} (palm|hand) to halt the traffic", "show me the flat of your {S} hand", "stop me with your {S} (palm|hand)", "put your {S} hand up in a stop sign",
             "raise your {S} palm to (halt|stop) me", "turn your {S} palm towards me and ^hold it out", "tell me to talk to your {S} hand", "bring your {S} palm forward to say halt"),
        any=("hold your palm out", "say stop",
             "~(a|one) flat palm held out", "~palm out", "~a hand held up to stop (me|the traffic)", "~talk to the hand", "hold up your palm to stop me", "tell me to talk to the hand",
             "put your palm out", "show me your palm"), both=("hold up both palms", "put both palms out in front of you", "show (me |)both your palms", "keep me away with both palms",
             "~both palms (out|forward|towards me|held out in front)", "~your palms (face me|face forward|say stop)", "~two flat palms held out", "~a stop sign with both hands",
             "stop me with both (palms|hands)", "hold both hands out flat to stop me", "show me the flat of both hands", "tell me to stop with both palms", "turn both palms towards me")), holds=True),
    "oath": Family(still(ArmPose((0.7, -0.68, 0.15), (0.22, 0.95, 0.2), -0.4)), Words(
        ("swear an oath", "take an oath", "swear to tell the truth", "make a promise", "promise( me something| solemnly|)", "vow( solemnly|)", "swear in court",
        "~a (solemn |)(oath|vow|promise)", "~an oath (in court|)", "~a pledge", "~a witness (in court|swearing to tell the truth)", "~scout's honour", "~the oath of a (witness|scout|president)",
        "~a swearing gesture", "pledge (your word|loyalty|solemnly)", "swear (solemnly|on the bible|that it is true|to me)", "take (a vow|the oath of office|the witness oath)",
        "give (your word of honour|your solemn word)", "testify (under oath|in court)", "be sworn in", "make (a vow|an oath|a pledge|a solemn promise)", "affirm that you tell the truth",
        "say scout's honour"),
        one=("raise your {S} hand to swear", "hold your {S} palm up beside your shoulder", "hold up your {S} hand like a witness", "swear in court with your {S} hand up", "raise your {S} palm next to your head",
             "~{S} hand (up|raised) (to swear|for an oath|under oath|like a witness)", "~your {S} (hand|palm) is up beside your head as if swearing", "~an oath with the {S} hand (up|raised)",
             "~{S} palm (up|raised) beside the (shoulder|head)", "~the {S} hand of a witness under oath", "raise your {S} hand (to take the oath|for the oath|to be sworn in|and ^swear)",
             "swear the oath with your {S} hand raised", "show your {S} palm beside your (head|shoulder)", "lift your {S} hand to swear", "hold your {S} hand up for scout's honour",
             "promise with your {S} hand up")), sides=ONE, holds=True),
    "offer": Family(still(ArmPose((0.3, -0.75, 0.5), (0.15, 0.05, 1.0), 1.3)), Words(
        one=("offer (your|me your) {S} hand", "hold out (your|the) {S} hand", "hold your {S} hand out palm up", "(ask for|offer|present|give me) something with your {S} hand", "reach out your {S} hand", "give me your {S} hand", "beg with your {S} hand",
             "turn your {S} palm up in front of you",
             "~{S} palm up (in front of you|)", "~an open {S} hand held out (to me|palm up)", "~{S} hand (out, palm up|held out palm up|open in front of you)",
             "~your {S} hand (is held out|reaches out) to (receive|give) something", "~a (begging|giving|asking) {S} hand", "~the {S} hand of a beggar", "~an upturned {S} palm",
             "ask for (money|a tip|alms) with your {S} hand", "extend your {S} hand palm up", "hand me something with your {S} hand", "let me put something in your {S} hand",
             "hold your {S} palm open to me", "pass me something with your {S} hand", "supinate your {S} (forearm|hand) in front of you", "receive something (in|with) your {S} hand",
             "serve me something on your {S} palm", "hold the {S} hand out like a beggar"),
        any=("offer (a hand|me something|me your hand)", "hold out your hand", "give me your hand", "beg for money",
             "~an open (hand|palm) held out", "~a (begging|giving|helping) hand (held out|)", "~palm up in front of you", "~hand out, palm up", "ask for (money|a tip|alms|some change)",
             "beg like a beggar", "hold your open (hand|palm) out", "extend a hand palm up", "let me put something in your hand", "panhandle"),
        both=("hold out both hands( palms up|)", "(offer|present|receive|give me) something with both hands", "beg with both hands", "show me your empty hands", "turn both palms up",
             "~both palms up (in front of you|)", "~(open|empty) hands held out", "~both hands (held out|out) palms up", "~your hands are open and (empty|palms up)", "~two open hands held out",
             "~both hands out to receive a gift", "hold both palms (open|up) (to me|)", "ask for something with both hands", "supinate both forearms in front of you", "hand me something with both hands",
             "receive a gift with both hands", "show that your hands are empty", "extend both hands palms up", "serve me something on both palms", "present your open hands")), sides=ANY, holds=True),
    "carry": Family(still(ArmPose((0.25, -0.9, 0.25), (-0.12, 0.02, 1.0), 1.0)), Words(
        ("carry (a box|a tray|a crate|a parcel|a basket|something heavy)( in front of you| in your arms|)", "hold a (box|tray|crate|big ball|baby) in (front of you|your arms)", "hold something big( in your arms|)", "pretend to (hold|carry) a (box|baby|heavy box)",
         "cradle a baby", "carry (wood|the shopping) with both arms", "hold your forearms out in front",
        "~a (heavy |)(box|tray|crate) in your arms", "~a (heavy |)(box|tray|crate) carried in front of you", "~something (heavy|big) in your arms",
        "~your arms (hold|carry) (a box|a tray|a baby|firewood)", "~arms (full of firewood|full of shopping|loaded with parcels)", "~forearms out in front (like a tray|as if carrying a box)",
        "~a baby in your arms", "~an armful of (wood|books|laundry)", "~both arms (around|under) a big box", "~elbows bent, forearms forward", "~a servant with a big tray",
        "carry (firewood|a pile of books|a birthday cake|a stack of plates|a big present) (in front of you|)", "bear a (heavy load|tray|burden) in front of you",
        "lug a (heavy box|crate|suitcase in both arms)", "tote a box", "hold an armful of (wood|books|laundry)", "transport a box in your arms", "bring (me |)a (tray|box|parcel|pile of books)",
        "deliver a (parcel|package|pizza)", "hold a (parcel|birthday cake|pile of books|stack of plates|heavy pot) in both hands", "balance a tray on both arms",
        "bend both elbows to a right angle with the forearms forward", "cradle (something|a child) in your arms", "hold your arms as if you carry a tray")), sides=BOTH, holds=True),
    "block": Family(still(ArmPose((0.35, -0.25, 0.9), (-0.35, 0.93, 0.15), 0.3)), Words(
        ("block( a punch| the hit| the blow|)", "guard your face", "protect (your face|yourself|your head)", "parry( the blow|)", "defend yourself", "cover up",
        "~a (guard|parry)", "~a (defensive|boxer's) (block|guard)", "~a block (against a punch|)", "~the guard of a boxer", "~a shield for your face", "ward off (a blow|the punch|an attacker)",
        "shield (your face|yourself|your head)", "stop a punch", "deflect (a punch|the blow|a hit)", "guard (against a punch|your head|yourself)", "avert the blow", "save your face from a punch",
        "intercept a punch", "defend (your face|your head)"),
        one=("block with your {S} (forearm|arm)", "guard your face with your {S} (arm|forearm)", "hold your {S} forearm up in front of your face", "parry with your {S} forearm",
             "~{S} (forearm|arm) (raised as a shield|raised in defence|up to block|in front of your face)", "~a block with (your|the) {S} (arm|forearm)", "~{S} guard up",
             "~your {S} forearm (shields|guards|protects|covers) your face", "~a {S} (forearm|arm) block", "shield (your face|yourself) with your {S} (arm|forearm)",
             "raise your {S} forearm to (block|protect your face|parry)", "bring your {S} forearm up (as a shield|in defence)", "ward off a (blow|punch) with your {S} (arm|forearm)",
             "do a {S} (arm|forearm) block", "cover up with your {S} arm", "take cover behind your {S} (arm|forearm)", "deflect the blow with your {S} forearm", "use your {S} arm as a shield"),
        both=("block with both (forearms|arms)", "put your guard up", "hold both forearms in front of your face", "take a boxing guard", "guard yourself with both arms",
             "~both forearms (up|in front of the face|up as a shield)", "~guard up", "~a (boxing|double) guard", "~a block with both (arms|forearms)",
             "~your forearms (shield|cover|guard|protect) your face", "raise your guard", "get your guard up", "shield (your face|yourself) with both (arms|forearms)",
             "cover your face with both forearms", "stand like a boxer in defence", "protect your face with both (arms|forearms)", "defend yourself with both arms", "put up your dukes",
             "hide behind your forearms", "bring both forearms up in defence")), holds=True),
}  # fmt: skip
