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
        ("push {n}", "push (forward|something away|a wall|a door|the door open|a shopping cart|a pram) {n}", "shove (forward|something away) {n}", "push an invisible (box|wall) away {n}", "press against (a wall|the door) {n}", "give (a push|{N} pushes)", "slide a heavy (box|cupboard) forward {n}",
         "~a (hard |big |strong |firm |)(push|shove)", "~{N} (hard |big |strong |)(pushes|shoves)", "~a (push|shove) (forward|to the front|against a wall|against the door)",
         "~pushing (something away|a wall|a heavy box|forward) {n}", "~{N} pushes (forward|against a wall)", "~shoving (something away|a wall|a heavy box) {n}", "shift a heavy (wardrobe|box) by pushing {n}",
         "push (the piano|a swing|a wheelbarrow|a stalled car|a trolley|a heavy boulder|me away|everything away) {n}", "shove (a wall|a heavy wardrobe|a crate|me back) {n}",
         "press (forward|straight ahead|something away from you) {n}", "put your weight behind a push {n}", "push (straight out|away from your chest|straight ahead) {n}",
         "perform a (push|chest press) {n}",
         "nudge a (crate|heavy table) forward {n}", "shunt a (railway wagon|heavy carton) forward {n}", "bulldoze (everything|the rubble) out of the way {n}",
         "force the jammed (door|gate) open by pushing {n}", "exert pressure on the wall in front of you {n}", "heave a (sofa|fridge) forward across the floor {n}",
         "muscle the (sofa|refrigerator) across the room by pushing {n}", "give the broken-down (van|jeep) a shove {n}", "~a forward (nudge|shunt|ram)",
         "~{N} (nudges|shunts|rams) straight ahead"),
        one=("~your {S} (hand|arm|palm) pushes (forward|straight ahead|something away|against a wall) {n}", "~the {S} (hand|palm) pushes out from the chest {n}", "~{S}-handed push {n}",
         "~{S} hand (push|pushing) (forward|something away) {n}", "~a push (forward |)with (your|the) {S} (hand|arm|palm)", "~{N} pushes with your {S} (hand|arm|palm)",
         "push (off |forward |)with (your|the) {S} palm {n}", "press your {S} palm forward {n}", "drive the {S} palm (forward|away from the chest) {n}", "push the {S} hand forward and ^return {n}",
         "ram the {S} palm forward {n}", "~your {S} elbow straightens and the palm drives something away {n}", "~{S} palm ramming straight ahead from the chest {n}",
         "~{S} arm (extension|straightening) against a heavy door {n}", "nudge a crate forward with your {S} (hand|palm) {n}"),
        both=("~both (hands|arms|palms) push (forward|straight ahead|something away|against a wall) {n}", "~a two-handed (push|shove)", "~both palms forward from the chest, pushing {n}",
         "~{N} two-handed pushes", "~{N} standing push-ups", "push off with both palms {n}", "press both palms forward {n}", "do wall push-ups {n}", "do a chest press with both arms {n}",
         "bulldoze forward with both palms {n}", "brace both palms against the (boulder|wall) and ^push {n}", "~a two-palmed (shove|ram) straight ahead",
         "ram both palms forward from the chest {n}", "~both elbows straighten and the palms drive something away {n}")), sides=ANY, counts=(1,)),
    "pull": Family(strokes(_PULL_FAR, _PULL_NEAR, 1.0), Words(
        ("pull {n}", "pull (a rope|something towards you|a door open|on the rope|a lever) {n}", "pull an invisible rope {n}", "drag something towards you {n}", "tug (at |on |)a rope {n}", "play tug of war {n}", "draw something (near|towards you) {n}", "give (a pull|{N} pulls)", "haul in a net {n}", "yank the handle {n}",
         "~a (hard |strong |big |firm |)(pull|tug|yank)", "~{N} (hard |strong |)(pulls|tugs|yanks)", "~a (pull|tug) (on|at) (a|the) rope", "~{N} (pulls|tugs) (on|at) (a|the) (rope|lever)",
         "~pulling (a rope|on a rope|something closer|something in) {n}", "~tug of war {n}", "tug (hard |)on (a|the) (rope|line|dog's lead) {n}", "haul (on a rope|in the anchor|in the line) {n}",
         "pull (the starter cord|the cord of a lawnmower|on the reins|a sledge|a stubborn donkey|the plug|the handbrake) {n}", "heave on (a|the) rope {n}",
         "drag a (heavy sack|box|cart) (closer|towards you) {n}", "pull (something|a drawer) (in|open|closer) {n}", "bring something closer by pulling {n}", "draw back a lever {n}",
         "tow a (barge|boat|broken-down car) in by its rope {n}", "lug a sack of coal towards you {n}", "jerk the (leash|halter|cord) back {n}", "wrench a jammed drawer open {n}",
         "rein in (a|the) (horse|stallion) {n}", "pull the mule by its halter {n}", "open the (oven|fridge|refrigerator) by its handle {n}", "~a (jerk|wrench) on the (leash|rope|cord)",
         "~{N} (jerks|heaves) on the (leash|rope)", "~rope hauling {n}", "~a tug-of-war (contestant|athlete) at the rope", "heave in the (hawser|mooring line) {n}"),
        one=("~your {S} (hand|arm) pulls (back|a rope|something closer|something towards you) {n}", "~{S}-handed (pull|tug) {n}", "~{S} elbow back in a pull {n}",
         "~a (pull|tug|yank) with (your|the) {S} (hand|arm)", "~{N} (pulls|tugs|yanks) with your {S} (hand|arm)", "~the {S} arm reaches out and pulls back {n}",
         "reach out with your {S} hand and ^pull (back|it in) {n}", "pull back your {S} elbow from a stretched arm {n}", "pull a lever with your {S} arm {n}",
         "jerk something towards you with your {S} hand {n}", "wrench the door open with your {S} hand {n}", "~your {S} elbow bends and hauls the rope in {n}",
         "~a jerk of the {S} hand towards the body", "tow a boat in with your {S} arm {n}"),
        both=("~both (hands|arms) pull (a rope|back|something in|on the rope) {n}", "~both hands on the rope, (pull|pulling) {n}", "~a two-handed (pull|tug)", "~{N} two-handed (pulls|tugs)",
         "grab (a|the) rope with both hands and ^pull {n}", "reach out with both hands and ^pull (back|something in) {n}",
         "tow something in with both hands {n}", "~a two-handed (heave|wrench) on the rope", "~both elbows bend and haul the rope in {n}", "jerk the rope back with both arms {n}")), sides=ANY, counts=(1, 2)),
    "lift": Family(_lift, Words(
        ("lift (a box|something heavy|a crate|a child) (up |up from the table |from below |){n}", "pick up a (heavy |)box {n}", "raise a heavy (box|load) with both (hands|arms) {n}", "heave a (box|sack) up {n}", "pick something up( with both hands|) {n}", "load a box onto a shelf {n}", "put a box on a high shelf {n}", "lift a heavy weight from the ground {n}",
         "~(box|heavy box|heavy crate) (up|lifted|coming up) from the (floor|ground) {n}", "~a (big|heavy) lift with both arms from (low down|the ground)",
         "~both (hands|arms) (lift|pick up) a (heavy |)(box|crate) {n}", "~both hands (fetch|bring) (something heavy|a box) up from below {n}", "~your arms lift a (box|crate|heavy box) {n}",
         "~box lifting {n}", "~(box|crate|load) up from the floor {n}", "~{N} (box lifts|lifts of a heavy box|boxfuls from the floor)", "~bend down, box up {n}", "~a mover lifting a (box|crate)",
         "~lifting a (heavy |)(box|load|crate|sack) {n}", "bend down and ^lift (a box|something heavy|a crate) {n}", "take a (box|crate|suitcase) up from the floor {n}",
         "pick up (a suitcase|a crate of beer|a sack of potatoes|a big stone|the child) {n}", "get a heavy (box|crate) off the ground {n}", "scoop (a child|a big box) up in your arms {n}",
         "lug a crate up from the floor {n}", "lift (a suitcase|a boulder|a sack of flour|a log|the baby up) {n}", "stack boxes {n}", "load (boxes|crates) onto a lorry {n}",
         "act like a removal man with a box {n}", "bring a heavy (box|load|pot) up from the ground {n}",
         "heft a (sandbag|keg|bale of hay) off the floor {n}", "raise a (barrel|trunk|bale) from the floor {n}", "bend down and ^retrieve a (parcel|package|basket) {n}",
         "gather up (an armful of firewood|the laundry basket|a pile of bricks) from the floor {n}", "stow your (luggage|holdall) in the overhead rack {n}",
         "pick (a toddler|a puppy|your kid) up off the ground {n}", "stoop and ^raise a (barrel|basket) {n}", "load hay bales onto a wagon {n}",
         "heave (an anvil|a cauldron|a rock) up from the ground {n}", "~a hefty (carton|package|parcel) coming up from the floor {n}", "~{N} (parcels|cartons|bales) lifted from the ground",
         "~a (porter|docker|warehouse worker) heaving a trunk up", "~both hands scooping up a (bundle|tub|basin) from down low {n}",
         "~your arms bring a (bundle|basket|toolbox) up from the floor {n}")), sides=BOTH, counts=(1,)),
    "pick": Family(_pick, Words(
        ("pick (an apple|apples|fruit|a cherry|cherries)( from a tree|) {n}", "take something (off|from) (a high|the top) shelf {n}", "reach up and ^grab something {n}", "harvest (apples|fruit) {n}", "fetch a book from the top shelf {n}", "pluck an apple {n}", "pick {N} apples", "get something down from above {n}", "grab something above you {n}",
         "~(apple|fruit|cherry) picking {n}", "~{N} (apples|pears|plums|oranges) (from|off) the tree", "~an apple (from|off) the tree", "~something (down |)from the top shelf",
         "~a grab at something overhead", "~a jar from the top shelf {n}", "~picking (apples|cherries|fruit|pears) {n}", "pick (a pear|pears|plums|an orange|oranges|a lemon) from the tree {n}",
         "take down (a book|a jar) from the top shelf {n}", "fetch (a jar|a cup) from the (top shelf|high cupboard) {n}", "reach (up |)for the top shelf and ^take something down {n}",
         "gather (apples|cherries|fruit) from the branches {n}", "pluck (fruit|a cherry|a pear|an orange) (off|from) the tree {n}", "pull an apple off the branch {n}",
         "get the (biscuits|cookie jar) down from the top shelf {n}", "help with the apple harvest {n}", "get a coat down from a high hook {n}",
         "snatch a balloon out of the tree {n}", "pick (a banana|a coconut|a fig|a peach|an apricot|a mango) from the tree {n}", "take a tin down from the wall cabinet {n}",
         "unhook a (lantern|hat) from above you {n}", "collect (olives|walnuts|chestnuts) from the boughs {n}", "scrump (apples|pears) {n}", "retrieve the (ball|kite) from the tree {n}",
         "snag an item off the upper shelf {n}", "pluck a star from the sky {n}", "~(orchard work|fruit gathering|olive harvesting) {n}", "~{N} (peaches|figs|apricots|olives) off the branch",
         "~a (snatch|grasp) at something above your head {n}", "~an orchard picker at work {n}"),
        one=("~your {S} hand (picks|plucks|grabs) (an apple|a fruit|something) from (above|overhead) {n}", "~{S} hand up, grab, and down {n}",
         "~the {S} hand reaches up, (grabs|takes) something and brings it down {n}", "~{S} hand picking (apples|fruit|cherries) {n}", "~an apple picked with the {S} hand",
         "reach up with your {S} hand, ^grab something and ^bring it down {n}", "grab something (overhead|above you) with the {S} hand and ^take it down {n}",
         "pick fruit from the tree with your {S} hand {n}",
         "snatch something from overhead with your {S} hand and ^lower it {n}", "~the {S} hand stretches up, closes on a (peach|pear) and sinks {n}",
         "~a (snatch|grasp) upwards with your {S} hand {n}", "~{S}-handed fruit gathering {n}", "collect (peaches|olives) from the tree with your {S} hand {n}",
         "retrieve a tin from the top shelf with the {S} hand {n}")), sides=ONE, counts=(1, 2)),
    "climb": Family(_climb, Words(
        ("climb (a rope|a ladder|up a rope|a tree|with your arms|hand over hand) {n}", "pull yourself up hand over hand {n}", "pretend to climb( a ladder| a rope|) {n}", "move your arms as if climbing {n}", "grip the rungs one after the other {n}", "act like a climber {n}", "climb {N} rungs", "haul yourself up a rope {n}", "ring the church bells {n}", "work your way up a pole {n}",
         "~(climbing|rope climbing|ladder climbing) {n}", "~{N} rungs (up|of) (a|the) ladder", "~{N} pulls up (a|the) rope", "~hand over hand up (a|the) (rope|ladder|pole) {n}",
         "~arms climbing {n}", "~your (hands|arms) climb (a rope|a ladder|up) {n}", "~hand above hand, (climbing|up the rope|up the ladder) {n}",
         "~hands (gripping|grabbing) higher and higher in turn {n}", "~a climber on (a rope|a ladder|the rock face)", "~a (fireman|sailor) up a (ladder|rope)",
         "~up the (ladder|rope), hand over hand {n}", "scale a (wall|cliff|mountain|ladder) {n}", "shin up a (pole|drainpipe|tree) {n}", "go up (a ladder|a rope|the ladder|the rope|the rigging) hand over hand {n}",
         "climb (a mountain|a rock face|the rigging|the wall bars|a pole|up the ladder|the beanstalk) {n}", "clamber up (a tree|the rocks|the ropes) {n}",
         "grab higher and higher with one hand after the other {n}", "pull down (on |)a bell rope hand over hand {n}", "swarm up (a|the) rope {n}", "boulder like a rock climber {n}",
         "be (a mountaineer|a rock climber|Jack on the beanstalk) {n}", "go up the wall bars with your hands {n}",
         "ascend a (rope|ladder|chimney) {n}", "mount the ladder rung by rung {n}", "scramble up (the cargo net|the rope ladder) {n}", "shimmy up a (rope|palm tree|lamp post) {n}",
         "inch your way up a (cable|rope) {n}", "go up a (vine|liana) like a (monkey|chimpanzee) {n}", "scale the (crag|facade|ramparts) {n}",
         "climb up (the mast|the trellis|Rapunzel's hair|the fire escape) {n}", "toll the church bell by its rope {n}", "~the ascent of a (ladder|rope) {n}",
         "~{N} (handholds|grips) up the rock face", "~an (alpinist|steeplejack|escaping prisoner) on a rope", "~fists taking turns to reach higher and tug down {n}",
         "~one arm stretches up while the other draws down, like on a rope {n}")), sides=BOTH, counts=(3, 4)),
    "knock": Family(strokes(ArmPose((0.35, -0.5, 0.75), (-0.02, 0.85, 0.5)), ArmPose((0.35, -0.45, 0.8), (-0.02, 0.5, 0.85)), 0.5, 0.45), Words(
        ("knock {n}", "knock (on|at) (the door|a door|my door) {n}", "rap (on|at) the door {n}", "give (a knock|{N} knocks)", "bang on the door {n}", "knock on wood {n}", "pound on the door {n}", "ask to come in by knocking {n}", "hammer on the door with your fist {n}",
         "~a (loud |polite |soft |)knock", "~{N} (loud |polite |soft |)(knocks|raps)", "~a (knock|rap) (on|at) the door", "~{N} (knocks|raps) (on|at) the door", "~knock knock",
         "~knocking (on|at) (a|the) door {n}", "~door knocking {n}", "knock (on wood|at the gate|on the window pane|before you enter|politely|like the postman|at the office door) {n}",
         "rap (your knuckles on the door|on the window) {n}", "let me know that you are at the door by knocking {n}", "tap on the (door|window pane) with your knuckles {n}",
         "use the door knocker {n}", "announce yourself with a knock", "thump (on |)the door {n}",
         "tap at the cottage door {n}", "pummel the door {n}", "chap on the door {n}", "give the door a rat-a-tat {n}", "request (entry|admittance) by knocking {n}",
         "call at a neighbour's house by knocking {n}", "beat on the (shutters|hatch) {n}", "strike the door with bent fingers {n}",
         "knock like a (salesman|landlord|trick-or-treater|chambermaid|policeman) {n}", "rouse the household by knocking {n}", "~rat-a-tat-tat at the door {n}",
         "~{N} (knuckle taps|thumps on the door|bangs on the door)", "~a (tapping|thumping|drumming) of knuckles on the door {n}", "~a visitor at the door, knocking {n}"),
        one=("~your {S} (hand|fist) knocks (on|at) (a|the) door {n}", "~{S} knuckles (on|at) the door {n}", "~{S}-handed (knock|knocking) {n}", "~a (knock|rap) with (your|the) {S} (hand|knuckles|fist)",
         "~{N} (knocks|raps) with (your|the) {S} (hand|fist)", "~the {S} fist raps on the door {n}", "knock with (your|the) {S} (knuckles|fist) {n}",
         "rap on the door with your {S} (knuckles|fist) {n}", "pound on the door with your {S} fist {n}",
         "~your {S} wrist bobs, tapping the knuckles on the door {n}", "rap the {S} knuckles on the timber {n}", "~{N} knuckle taps with the {S} hand", "clobber the door with your {S} fist {n}",
         "pummel the door with the {S} fist {n}")), sides=ONE, counts=(2, 3)),
    "wipe": Family(strokes(reach((-0.1, 0.0, 0.5), (0.9, -0.5, 0)), reach((0.38, 0.02, 0.46), (0.9, -0.5, 0)), 1.0), Words(
        ("wipe (a window|the window|the board|a mirror|the blackboard|the glass) {n}", "clean (a window|the mirror|the board|the windscreen|the windshield) {n}", "wash (a window|the windows) {n}", "wipe (from side to side|left and right|in front of you) {n}", "polish (a mirror|the window) {n}", "rub the glass clean {n}", "erase the board {n}",
         "~(window cleaning|window washing|window wiping|mirror polishing) {n}", "~a wipe (of|over) the (window|mirror|board|glass)", "~{N} wipes (of|over) the (window|mirror|board|glass)",
         "~wiping (a|the) (window|mirror|board|glass pane) {n}", "~some window cleaning", "scrub the (window|tiles|whiteboard|glass) {n}",
         "wipe (the whiteboard|the chalk off|the steam off the mirror|the shower door|a window pane) {n}", "clean (the glass|the whiteboard|the chalkboard|a window pane|the shop window) {n}",
         "squeegee the (window|windscreen|windshield) {n}", "rub the (chalk off the board|window|mirror) {n}", "clear the mist off the (windscreen|mirror|window) {n}", "do the windows {n}",
         "polish the (glass|shop window|window pane) {n}", "wash the (windscreen|windshield|car window) {n}",
         "swab the (window|mirror) {n}", "buff the (window|mirror|glass) {n}", "sponge the (shower screen|bathroom tiles) {n}", "demist the (bathroom mirror|windscreen) {n}",
         "rub out the (sums|writing) on the blackboard {n}", "scour the tiled wall {n}", "take the (smudges|fingerprints|streaks|grime) off the window {n}",
         "mop the condensation off the window pane {n}", "wash the car window with a chamois {n}", "shine up the mirror {n}", "~a (swipe|swish) of the (cloth|rag|sponge) across the window",
         "~{N} (swipes|swishes) of the (rag|sponge) across the window", "~a window cleaner at work {n}", "~glass cleansing {n}"),
        one=("~your {S} (hand|arm) wipes (a|the) (window|board|mirror|glass) {n}", "~{S} hand wiping (a|the) (window|board|mirror|glass) {n}", "~the {S} palm goes to and fro over the glass {n}",
         "~a wipe of the (window|glass) with your {S} hand", "~{N} wipes of the window with your {S} hand", "~cloth in the {S} hand, wipe the (window|board|mirror) {n}",
         "rub the window with your {S} (hand|palm) {n}", "move your {S} palm from side to side over an upright pane {n}", "wipe a pane in front of your face with your {S} hand {n}",
         "swish the {S} palm from side to side across the pane {n}", "~rag in the {S} hand, buff the (window|mirror) {n}", "~sideways swipes of the {S} hand on an upright window {n}",
         "sponge the mirror with your {S} hand {n}", "swab the glass with a rag in your {S} hand {n}"),
        both=("~both hands wiping (a|the) (window|board|mirror|glass) {n}", "~both (hands|palms) wipe the (window|glass|mirror) {n}", "wipe the whole window with both hands {n}",
         "rub the glass with both palms {n}",
         "buff the mirror with both (hands|palms) {n}", "swab the glass with a rag in each hand {n}", "~both hands buffing the window {n}")), sides=ANY, counts=(2, 3)),
    "wipe_table": Family(strokes(reach((-0.12, -0.34, 0.36), ELBOW_OUT, -1.0), reach((0.38, -0.34, 0.34), ELBOW_OUT, -1.0), 1.0), Words(
        ("wipe (the|a) (table|desk|counter) {n}", "clean the (table|desk|counter|kitchen counter) {n}", "dust the (table|desk|furniture) {n}", "polish the (table|desk) {n}", "sweep the crumbs off the table {n}", "iron a shirt {n}", "brush the table clean {n}", "smooth the table cloth {n}",
         "~(table wiping|table cleaning|ironing|dusting the table) {n}", "~a wipe (of|over) the (table|desk|counter|kitchen table)", "~{N} wipes (of|over) the (table|desk|counter)",
         "~wiping (a|the) (table|desk|counter|table top) {n}", "~crumbs off the table {n}",
         "wipe (down |)the (table top|kitchen table|bar|worktop|work surface|breakfast table) {n}", "do the ironing {n}", "iron (the laundry|your shirt|a pair of trousers) {n}",
         "dust (the shelf|the sideboard) {n}", "rub the table (clean|dry|down) {n}", "scrub the (table|desk|worktop) {n}", "mop up a spill on the table {n}",
         "brush the crumbs off the (table|tablecloth) {n}", "smooth out the (tablecloth|bedsheet) {n}", "wax the table {n}", "clean up the table after dinner {n}",
         "swab the (tabletop|bar) {n}", "buff the (tabletop|dining table) {n}", "sponge down the (kitchen island|table) {n}", "press (a skirt|a blouse|your uniform) with an iron {n}",
         "flatten the (creases|wrinkles) out of the tablecloth {n}", "clear the (spilt sugar|flour) off the table {n}", "sandpaper the tabletop {n}", "burnish the (oak|mahogany) table {n}",
         "mop the puddle off the table {n}", "~a (swipe|swish) of the (dishcloth|rag|sponge) over the table", "~{N} (swipes|swishes) of the (duster|rag|dishcloth) across the table",
         "~a (barmaid|waitress|bartender) wiping the counter {n}", "~crease smoothing on the tablecloth {n}"),
        one=("~your {S} (hand|arm) wipes (the|a) (table|desk|counter) {n}", "~{S} hand wiping the (table|desk|counter) {n}", "~the {S} hand goes to and fro (over|on) the table {n}",
         "~cloth in the {S} hand, wipe the (table|desk|counter) {n}", "~{N} wipes of the table with your {S} hand", "slide your {S} hand to and fro over the (table|desk) {n}",
         "sweep the table with your {S} hand {n}", "move an iron to and fro with your {S} hand {n}",
         "~the flat of the {S} hand skims across the tabletop {n}", "~{S} hand smoothing the (sheet|blanket|tablecloth) {n}", "~rag in the {S} hand, buff the table {n}",
         "swish your {S} hand from side to side across the tabletop {n}", "flatten the tablecloth with your {S} hand {n}")), sides=ONE, counts=(2, 3)),
    "paint": Family(strokes(reach((0.17, -0.25, 0.45), (0.9, -0.5, 0)), reach((0.17, 0.28, 0.45), (0.9, -0.5, 0)), 1.15), Words(
        ("paint (a wall|the wall|a fence|the fence) {n}", "paint up and down {n}", "move a (paint brush|roller) up and down {n}", "brush paint on the wall {n}", "roll paint onto the wall {n}", "whitewash the fence {n}", "make {N} brush strokes", "colour the wall {n}", "pretend to be a painter {n}", "coat a wall with paint {n}",
         "~(wall painting|fence painting|house painting|painting) {n}", "~{N} (brush strokes|strokes of the brush|strokes with the roller) on the wall", "~a (stroke|coat) of paint on the wall",
         "~(brush|paint roller) up and down the wall {n}", "~painting (a|the) (wall|fence|house) {n}", "~a house painter at work", "~a few strokes with the paint roller",
         "paint (the house|the ceiling edge to the floor|the garden fence|a door|the room) {n}", "whitewash (a|the) wall {n}", "stroke the wall with a paint brush {n}",
         "apply paint to the wall {n}", "decorate the room with a paint roller {n}", "put (a coat of|some) paint on the (wall|fence) {n}", "slap paint on the wall {n}",
         "varnish (a|the) (door|fence) {n}", "give the (wall|fence) a coat of paint {n}", "paint like Tom Sawyer {n}", "move the brush up and down on the wall {n}",
         "daub paint on the (wall|fence) {n}", "creosote the fence {n}", "lacquer the (door|gate|cupboard) {n}", "stain the (fence|shed) {n}", "prime the wall before painting it {n}",
         "emulsion the wall {n}", "redecorate the (bedroom|hallway|nursery) with a roller {n}", "spruce up the (shed|gate) with a lick of paint {n}", "paint vertical stripes on the wall {n}",
         "~a (lick|daub|layer) of paint on the wall", "~{N} (daubs|swipes) with the paint roller", "~vertical brushwork on the wall {n}", "~a (decorator|handyman) painting the fence {n}"),
        one=("~your {S} (hand|arm) paints (a|the) (wall|fence) {n}", "~{S} hand painting (a|the) (wall|fence) {n}", "~brush in the {S} hand, paint the (wall|fence) {n}",
         "~the {S} hand goes up and down with (a|the) (paint brush|roller) {n}", "~{N} strokes of paint with the {S} hand", "paint up and down with your {S} (hand|arm) {n}",
         "move a paint roller up and down with your {S} hand {n}", "stroke paint up and down the wall with the {S} hand {n}",
         "daub the wall up and down with the brush in your {S} hand {n}", "~vertical brushwork with the {S} hand {n}", "~your {S} wrist bobs up and down behind a paint brush {n}",
         "creosote the fence with your {S} hand {n}", "~{N} vertical swipes of the paint brush with the {S} hand")), sides=ONE, counts=(2, 3)),
    "draw_circle": Family(loops(circle((0.15, 0.0, 0.42), 0.17, "front"), 1.35, (0.9, -0.5, 0)), Words(
        ("draw (a circle|{N} circles)( in the air|)", "draw a (big |)circle in front of you {n}", "make (a circle|circles) in the air {n}", "trace a circle {n}", "write an O in the air {n}", "wax on {n}", "paint a sun in the air {n}", "circle in front of you {n}", "draw (a|the) letter O {n}",
         "~a (big |large |round |)circle in (the air|front of you)", "~{N} (big |large |)circles in (the air|front of you)", "~a circle drawn in the air", "~an O (in the air|in front of you)",
         "~{N} air circles", "~circle drawing in the air {n}", "~round and round in front of you {n}", "~a (sun|wheel|hoop|ring) drawn in the air",
         "trace (circles|a big circle|an O|a ring) in (the air|front of you) {n}", "write a zero in the air {n}", "sketch a (circle|full moon) in the air {n}",
         "describe a circle in (the air|front of your chest) {n}", "draw (a ring|a wheel|a full moon|a zero|a hoop) in the air {n}", "do {N} circles in front of your chest", "wax on, wax off {n}",
         "write the letter O big in the air {n}", "paint (circles|an O|a big circle) in the air {n}",
         "outline a (disc|circle|clock face) in the air {n}", "inscribe a circle in the air {n}", "scribble (loops|circles) in the air in front of you {n}",
         "doodle (rings|loops) in the air {n}", "etch a (halo|ring) in the air in front of you {n}", "trace the (rim|outline) of a (dartboard|big clock) in front of you {n}",
         "draw a (doughnut|planet|bubble|pizza|bagel) in the air {n}", "mark a circular (track|path) in the air in front of you {n}", "~{N} (loops|rings|orbits) in the air in front of you",
         "~a circular (path|figure|sweep) in front of your chest {n}", "~an aerial circle in front of you {n}"),
        one=("~your {S} hand (draws|traces|makes) (a circle|circles|an O) in (the air|front of you) {n}", "~your {S} hand (goes round|circles) in front of (you|your chest) {n}",
         "~{S} hand (in a circle|in circles|round and round) in front of (you|your chest) {n}", "~a circle in the air with your {S} hand", "~{N} circles in the air with your {S} hand",
         "~the {S} hand goes round like the hand of a clock in front of you {n}", "move your {S} hand in (a circle|circles) in front of you {n}",
         "trace a circle with your {S} (hand|index finger) {n}", "circle your {S} hand in front of your chest {n}",
         "whirl your {S} hand in rings in front of your chest {n}", "let your {S} hand (orbit|revolve) in front of your chest {n}",
         "~{N} (orbits|laps|revolutions) of the {S} hand in front of the chest", "~your {S} hand follows the rim of a clock face in front of you {n}",
         "outline a disc in the air with your {S} hand {n}", "~a circular path of the {S} hand in front of the chest {n}"),
        both=("~both hands (draw|drawing|trace) circles in (the air|front of you) {n}", "~both hands in circles in front of (you|the chest) {n}", "~{N} circles in the air with both hands",
         "circle both hands in front of your chest {n}", "move both hands in circles in front of you {n}",
         "outline (hoops|rings) in the air with both hands {n}", "~both hands follow the rim of a plate in front of you {n}", "let both hands orbit in front of your chest, drawing circles {n}")), sides=ANY, counts=(1, 2)),
    "stir": Family(loops(circle((0.1, -0.3, 0.33), 0.085, "flat"), 0.85, ELBOW_OUT, -0.5), Words(
        ("stir (the soup|a pot|the pot|your tea|the coffee|a cauldron|the dough) {n}", "stir {n}", "mix (the dough|a salad|a cake|paint) {n}", "cook( soup|) {n}", "move a spoon round in a pot {n}", "whisk the eggs {n}", "brew a potion {n}", "turn a spoon in the pot {n}", "pretend to cook {n}",
         "~(stirring|soup stirring|pot stirring|cooking) {n}", "~a (good |quick |)stir", "~{N} (stirs|stirs of the soup|stirs of the pot|rounds with the spoon in the pot)",
         "~a stir of the (soup|pot|tea|sauce)", "~stirring (the soup|a pot|your coffee|the porridge|the sauce) {n}", "~a cook stirring the (soup|pot)", "~a witch at the cauldron",
         "~spoon going round in the pot {n}", "stir (the sauce|the porridge|the paint|the batter|the risotto|the sugar in|the cauldron like a witch) {n}",
         "mix (the batter|the ingredients|a potion|a cocktail with a spoon|the cake mix) {n}", "beat the eggs {n}", "blend the batter with a spoon {n}", "give the (soup|pot|tea|sauce) a stir {n}",
         "whip the cream {n}", "make (soup|porridge|a stew|scrambled eggs) {n}", "be a (cook at the pot|witch at the cauldron) {n}", "go round in the pot with a ladle {n}",
         "swirl the (broth|gravy) with a spoon {n}", "agitate the mixture with a spoon {n}", "fold in the flour {n}", "concoct a (brew|magic remedy) in the cauldron {n}",
         "prepare (gravy|custard|polenta|goulash) in the pot {n}", "whirl the wooden spoon round the (saucepan|bowl|wok) {n}", "dissolve the (honey|tablet) with a teaspoon {n}",
         "churn the batter with a spoon {n}", "~a (swirl|twirl) of the (spoon|ladle|whisk) in the saucepan", "~{N} (swirls|twirls|laps) of the ladle in the saucepan",
         "~the (chef|wizard|alchemist|dinner lady) stirring the cauldron {n}", "~flat circles with a ladle over the (stove|hob|cooker) {n}"),
        one=("~your {S} hand (stirs|is stirring) (the soup|a pot|the pot|the tea|the sauce) {n}", "~{S} hand stirring (a pot|the soup) {n}", "~spoon in the {S} hand, stir {n}",
         "~a stir of the pot with your {S} hand", "~{N} stirs of the pot with your {S} hand", "~the {S} hand goes round above the pot with a spoon {n}", "stir with the spoon in your {S} hand {n}",
         "take the ladle in your {S} hand and ^stir {n}", "move the {S} hand round in a flat circle over the pot {n}",
         "swirl the spoon in your {S} hand round the (bowl|mug|saucepan) {n}", "~your {S} wrist makes level circles above the (stove|saucepan) {n}",
         "~{N} swirls of the spoon with your {S} hand", "~ladle in the {S} hand, circling in the saucepan {n}", "agitate the mixture with the spoon in your {S} hand {n}")), sides=ONE, counts=(2, 3)),
    "crank": Family(loops(circle((0.12, -0.15, 0.38), 0.13, "side"), 1.0, ELBOW_OUT), Words(
        ("turn a crank {n}", "crank (the engine|a handle|a winch) {n}", "wind (a winch|a wheel|up a clock) {n}", "grind coffee {n}", "play a barrel organ {n}", "roll (down|up) the car window {n}", "reel in a fish {n}", "turn a handle round and round {n}", "operate a winch {n}",
         "~(cranking|coffee grinding|crank turning) {n}", "~{N} (turns of the crank|turns of a handle|turns of the winch|cranks of the handle)", "~a turn (of|on) (a|the) (crank|winch|coffee mill)",
         "~(crank|handle) turned round and round {n}", "~turning (a|the) (crank|winch|coffee mill) {n}", "~an organ grinder", "~fish on the line, reel it in {n}",
         "crank (up the old car|up a gramophone|the well|the wheel) {n}", "turn (a winch|the winch|a coffee mill|a mincer|a pepper mill with a crank|the handle of the well) {n}",
         "wind (up the bucket from the well|up a gramophone|the handle) {n}", "reel in (the line|a big fish|your catch) {n}", "work (the|a) (crank|winch) {n}",
         "grind (pepper|coffee beans|the organ) {n}", "be an organ grinder {n}", "draw water from the well with a winch {n}", "start an old car with the crank {n}",
         "wind (the car window down|the awning in) {n}",
         "winch up the (drawbridge|anchor) {n}", "work the (mangle|windlass|capstan) {n}", "mill (corn|spices) with a hand crank {n}", "put the washing through the mangle {n}",
         "spool in the (cable|hose) with a crank {n}", "play the hurdy-gurdy {n}", "turn the handle of a (music box|jack-in-the-box|meat grinder|pencil sharpener) {n}",
         "crank-start the (tractor|biplane|motor) {n}", "lower the shutter with the winder {n}", "~a (spin|revolution|rotation) of the (crank|handwheel)",
         "~{N} (rotations|revolutions|spins) of the (crank|handwheel)", "~an angler reeling in a (trout|pike) {n}", "~crank rotation, round and round {n}"),
        one=("~your {S} (hand|arm) (turns|cranks|works) (a|the) (crank|handle|winch) {n}", "~{S} hand on the (crank|winch), turn {n}", "~{S} hand cranking {n}",
         "~the {S} hand goes round and round on a (crank|handle) {n}", "~{N} turns of the crank with your {S} hand", "turn the winch with your {S} (hand|arm) {n}",
         "wind the handle with your {S} hand {n}", "crank with your {S} arm {n}",
         "~your {S} fist travels round and round with the windlass {n}", "rotate the (windlass|handwheel) with your {S} hand {n}", "~{N} (rotations|spins) of the winch with the {S} arm",
         "spin the crank handle with the {S} hand {n}", "~mangle handle in the {S} hand, turn {n}")), sides=ONE, counts=(2, 3)),
    "roll_arms": Family(loops(circle((0.03, -0.2, 0.33), 0.1, "side"), 0.75, ELBOW_OUT, offset=0.5), Words(
        ("roll your (forearms|arms|hands)( around each other| over each other|) {n}", "wind your (forearms|hands) around each other {n}", "turn your (hands|forearms) round each other {n}", "spin your (forearms|hands) around each other {n}", "call for a substitution", "tell me to hurry up by rolling your hands {n}", "make a rolling motion with both (arms|hands) {n}", "do the wheels on the bus {n}", "make a travelling sign {n}", "wind the bobbin up {n}",
         "~(forearm|hand|arm) rolls {n}", "~{N} (forearm|hand) rolls", "~(forearms|hands|arms) rolling (round|around|over) each other {n}",
         "~your (forearms|hands|arms) (roll|turn|go|wind) (round|around) each other {n}", "~a (rolling motion|roll) of the (forearms|hands) (round|around) each other",
         "~the (substitution|travelling) (sign|signal) {n}", "~rolling (arms|forearms|hands) {n}", "~hands going round each other in front of the chest {n}", "~the wheels on the bus {n}",
         "~a referee's travelling signal", "~the disco roll of the arms {n}", "rotate your (forearms|hands) (round|around) each other {n}",
         "tumble your (hands|forearms) (over|around) each other {n}", "circle your (hands|forearms) around each other {n}",
         "roll (one hand over the other|your fists around each other|both forearms) {n}", "signal (a substitution|travelling) {n}",
         "sing the wheels on the bus go round and round with your arms {n}", "make (a barrel roll|rolls) with your forearms {n}", "ask for a substitution", "wind wool around your hands {n}",
         "do (forearm rolls|the arm roll) {n}", "reel your forearms around each other {n}",
         "whirl your (forearms|fists) around each other {n}", "twirl your (forearms|hands) round one another {n}", "churn your (fists|forearms) over each other {n}",
         "revolve your forearms about one another {n}", "wheel your fists round each other in front of the chest {n}", "orbit your hands around each other {n}",
         "do the (paddle wheel|eggbeater|mill wheel) with your forearms {n}", "tell the speaker to wrap up by rolling your hands {n}", "wind a ball of yarn with both hands {n}",
         "~forearms whirling around each other like a (mill wheel|paddle steamer|tumble dryer) {n}", "~{N} (revolutions|whirls|twirls|tumbles) of the forearms around each other",
         "~forearms chasing each other in circles in front of the belly {n}", "~fists tumbling over one another {n}", "~bobbin winding with both forearms {n}",
         "~an eggbeater with the forearms {n}")), sides=BOTH, counts=(3, 4)),
    "type": Family(taps(_KEY_UP, _KEY_DOWN, 0.5), Words(
        ("type( on a keyboard| a letter| an essay| an email|) {n}", "use a (keyboard|computer)", "work at (a computer|your computer)", "write an email", "hit the keys {n}", "write on a (typewriter|keyboard) {n}", "pretend to type {n}", "program (a computer|something)", "hack into a computer", "act like a typist", "tap the keys with both hands {n}", "answer your emails",
         "~(typing|keyboard typing|computer work|typewriting) {n}", "~hands on the keyboard, typing {n}", "~fingers (flying|tapping|dancing) over the keyboard {n}",
         "~your (hands|fingers) (type|tap the keys|type on a keyboard) {n}", "~both hands typing {n}", "~{N} (key strokes|taps on the keyboard|keyboard taps)",
         "~a (typist|secretary|programmer|hacker) at (work|the keyboard)", "~email (typing|writing) at the computer", "~some (typing|coding)", "~both hands tapping on a computer keyboard {n}",
         "~a (bit|burst) of typing", "type (a report|your password|a message|your name|something|with ten fingers|on your laptop|a novel) {n}",
         "write (a program|some code|a report on your computer|a novel on a typewriter)", "tap away at the keyboard {n}", "bash out (an email|a letter) on the keyboard",
         "hammer away at the keyboard {n}", "do some (typing|coding|office work at the computer)", "key in (your password|the data|a code)", "use (your laptop|a typewriter|the computer)",
         "code (a program|like a hacker)", "play a hacker", "chat on your computer", "enter data on the keyboard {n}",
         "touch-type (a memo|an invoice|the minutes) {n}", "peck at the keys {n}", "draft (a contract|a blog post) on your laptop {n}", "compose (a memo|an article) on the typewriter {n}",
         "transcribe (an interview|the dictation) on the keyboard {n}", "rattle off an essay on the typewriter {n}", "clack away at the keys {n}", "word-process a letter {n}",
         "fill in a spreadsheet at the computer {n}", "log in at the terminal {n}", "~fingertips (pattering|drumming|clattering) on the keyboard {n}",
         "~(secretarial|clerical) work at the keyboard {n}", "~a (stenographer|journalist|blogger|clerk|copywriter) at the keyboard {n}", "~{N} (keypresses|pecks at the keys)",
         "~the clatter of a typewriter {n}")), sides=BOTH, counts=(3, 4, 5)),
    "hammer": Family(strokes(ArmPose((0.4, -0.35, 0.6), (0.0, 0.98, -0.05)), ArmPose((0.3, -0.5, 0.8), (-0.05, 0.0, 1.0)), 0.75, 0.42), Words(
        ("hammer( a nail| a nail into the wall|) {n}", "hit a nail {n}", "drive in a nail {n}", "swing a hammer {n}", "pound (a nail|the anvil) {n}", "use a hammer {n}", "forge iron {n}", "bang with a hammer {n}", "knock in a nail {n}", "beat the anvil {n}",
         "~(hammering|nail hammering|blacksmithing) {n}", "~a (blow|hit|strike|stroke) with (a|the) hammer",
         "~{N} (hammer blows|hammer strokes|blows of the hammer|hits on the nail|hammer hits)", "~hammering (a nail|nails|the anvil|on the anvil) {n}", "~a (blacksmith|carpenter) with a hammer",
         "~nail into the (wall|wood) {n}", "~bang bang with the hammer {n}", "nail (a picture to the wall|a board down|two boards together) {n}",
         "drive a nail (in|into the wall|home|into the wood) {n}", "knock a nail (into the wall|into a plank|home) {n}", "hit the nail on the head {n}",
         "beat iron (on the anvil|like a blacksmith) {n}", "forge (a sword|a horseshoe) {n}", "work as a blacksmith at the anvil {n}", "wield a (hammer|mallet) {n}",
         "pound in a (nail|tent peg|stake) {n}", "bang (in a nail|a nail into the wall|tent pegs into the ground) {n}", "bring (a|the) (hammer|gavel) down {n}", "bash a nail in {n}",
         "whack (the nail|a wedge) with a (mallet|hammer) {n}", "tack (a poster|a notice) to the wall with a hammer {n}", "wallop a (stake|fence post) with a hammer {n}",
         "strike the chisel with a mallet {n}", "tenderise the (steak|meat) with a mallet {n}", "crack (walnuts|rocks) with a hammer {n}", "drive home a (spike|rivet|wedge) {n}",
         "batter the (copper|tin) flat with a hammer {n}", "call the (court|auction) to order with the gavel {n}", "smite the anvil {n}",
         "~a (whack|wallop|clout|thwack) of the (mallet|hammer)", "~{N} (whacks|wallops|clouts|bashes) of the (mallet|hammer)", "~a (cobbler|roofer|shoemaker|mason) hammering {n}",
         "~(an auctioneer|a judge) banging the gavel {n}"),
        one=("~your {S} (hand|arm) (hammers|hits a nail|swings a hammer) {n}", "~hammer in the {S} hand, (strike|hit|bang) {n}", "~{S} hand hammering {n}", "~{N} hammer blows with your {S} (hand|arm)",
         "~a hammer blow with your {S} (hand|arm)", "~the {S} arm brings the hammer down {n}", "hammer with your {S} (arm|fist) {n}", "drive in the nail with your {S} (hand|arm) {n}",
         "swing the hammer in your {S} hand {n}",
         "whack a nail with the mallet in your {S} hand {n}", "~your {S} forearm drops sharply with the mallet {n}", "~{S} hand whacking the nails in {n}",
         "~{N} (whacks|clouts) of the hammer with your {S} arm", "wallop a tent peg with the mallet in your {S} hand {n}", "~gavel in the {S} hand, pounding the judge's bench {n}")), sides=ONE, counts=(3, 4)),
    "saw": Family(_saw, Words(
        ("saw( wood| a board| a branch| a log|) {n}", "cut (wood|a board) with a saw {n}", "use a saw {n}", "pretend to saw {n}", "work with a hand saw {n}", "pull a saw back and forth {n}", "act like a carpenter {n}", "slice (bread|a loaf) {n}", "cut the (bread|cake) {n}", "make {N} saw strokes",
         "~(sawing|wood sawing|bread slicing|bread cutting) {n}", "~{N} (saw strokes|strokes of the saw|pulls of the saw|saw cuts)", "~a (stroke|cut) with (a|the) saw",
         "~sawing (wood|a board|a log|a plank|through a branch) {n}", "~saw going (back and forth|to and fro) {n}", "~board in one hand, the other (saws|sawing) {n}",
         "~loaf in one hand, the other (slices|slicing) {n}", "~hand on the saw, to and fro {n}", "~a carpenter with a saw", "~saw back and forth {n}",
         "~hand saw to and fro through the wood {n}", "saw (a plank|through a log|a beam in two|the branch off|a lady in half|like a carpenter) {n}",
         "cut (a plank|a log|a branch off) with a hand saw {n}", "move a saw (back and forth|to and fro) {n}", "work the saw {n}", "slice (a baguette|the roast|a ham|the sausage) {n}",
         "carve the (turkey|roast|ham) {n}", "cut (a slice of bread|a loaf of bread|the birthday cake|slices of ham) {n}", "do some (sawing|carpentry with a saw)", "push and ^pull a saw {n}",
         "saw away at a (log|plank) {n}",
         "fell a (pine|spruce|tree) with a saw {n}", "prune a (bough|shrub) with a saw {n}", "lop a bough off with a saw {n}", "hack through a (pipe|bone|bar) with a hacksaw {n}",
         "divide a (joist|beam) with a handsaw {n}", "sever a branch with a saw {n}", "trim a (timber|board) with a saw {n}", "operate a (fretsaw|handsaw|hacksaw) {n}",
         "portion the (meatloaf|loaf) with a bread knife {n}", "cut slices off a (salami|pumpkin|melon) {n}", "~a (lumberjack|woodcutter|joiner|cabinetmaker) at the saw {n}",
         "~{N} (rasps|passes) of the saw", "~the (blade|hacksaw|handsaw) (grating|gliding) to and fro through the wood {n}", "~timber cutting with a handsaw {n}")), sides=BOTH, counts=(3, 4)),
    "sow": Family(strokes(reach((-0.12, -0.3, 0.25), ELBOW_DOWN), ArmPose((0.75, -0.5, 0.45), (0.85, 0.0, 0.5), -0.6), 1.1), Words(
        ("sow (seeds|grain) {n}", "scatter seeds {n}", "feed the (chickens|birds|ducks) {n}", "spread (seeds|salt|confetti) {n}", "throw (flowers|corn) sideways {n}", "deal (cards|the cards) {n}", "sling a frisbee {n}", "throw a frisbee {n}", "toss seeds across the field {n}", "hand out (cards|sweets) {n}",
         "~(sowing|seed sowing|card dealing|frisbee) {n}", "~{N} handfuls of seed over the field", "~a handful of seed over the field", "~a (frisbee|sideways frisbee) throw", "~{N} frisbee throws",
         "~sowing (seeds|grain|corn) {n}", "~feeding the (chickens|birds|ducks) {n}", "~a sower on the field", "~corn for the chickens {n}", "sow (a field|corn|wheat|the lawn|like a farmer) {n}",
         "scatter (grain|corn|salt|petals|rice|birdseed) {n}", "sprinkle (grain|seeds) (about|across the field|sideways) {n}", "deal out (cards|a hand of cards) {n}",
         "cast seeds (across the field|to the wind) {n}", "spread (grain|birdseed|fertiliser|flower petals) with a sweep {n}", "strew (flowers|petals|sand) {n}", "play frisbee {n}",
         "feed the (hens|pigeons|geese|swans) {n}", "skim a stone over the water {n}", "toss (corn|grain|seed) to the (chickens|hens|birds) {n}",
         "broadcast (wheat|barley|oats|clover) {n}", "fling (breadcrumbs|confetti|gravel) sideways {n}", "disperse (pellets|seed) over the (meadow|soil) {n}", "seed the (meadow|furrows) {n}",
         "chuck (crumbs|stale bread) to the ducks {n}", "grit the icy (pavement|path) {n}", "play ducks and drakes {n}", "hurl a flying disc sideways {n}", "litter the aisle with petals {n}",
         "distribute the playing cards {n}", "skip a pebble over the (lake|pond) {n}", "~a fling of (barley|oats) across the (meadow|soil)", "~{N} (flings|flicks) of seed across the soil",
         "~a (croupier|card dealer) dealing {n}", "~a flower girl scattering blossoms {n}"),
        one=("~your {S} (hand|arm) (sows|scatters|spreads) (seeds|grain) {n}", "~{S} hand (sowing seeds|scattering grain|dealing cards) {n}", "~the {S} hand flings seeds out sideways {n}",
         "~{S}-handed frisbee throw {n}", "~{N} handfuls of seed with your {S} hand", "~a sweep of the {S} arm scattering seeds", "fling seeds outward with your {S} hand {n}",
         "sweep your {S} arm outward to scatter seeds {n}", "deal the cards with your {S} hand {n}",
         "flick grain outward with your {S} hand {n}", "~your {S} arm unfolds sideways to scatter (wheat|oats) {n}", "~a backhand toss of a flying disc with the {S} hand",
         "~{N} flings of barley with your {S} hand", "broadcast wheat with your {S} hand {n}", "~the {S} elbow opens outward as the hand lets the grain fly {n}")), sides=ONE, counts=(2, 3)),
    "turn_key": Family(_twist_forearm(ArmPose((0.3, -0.75, 0.55), (-0.02, 0.15, 1.0)), -1.0, 1.0, 1.0), Words(
        ("turn (a key|the key|a knob|the doorknob|a screwdriver) {n}", "unlock (the|a) door {n}", "lock the door {n}", "screw in a (screw|light bulb) {n}", "use a screwdriver {n}", "open a jar {n}", "twist a (knob|dial) {n}", "turn up the volume {n}", "open a bottle {n}",
         "~a turn of (a|the) (key|doorknob|knob|screwdriver)", "~{N} turns of (a|the) (key|knob|screwdriver|screw)", "~a twist of (a|the) (key|knob|doorknob|dial)",
         "~{N} twists of (a|the) (key|knob|dial)", "~turning (a|the) (key|knob|doorknob|screwdriver) {n}", "~key in the lock, turn {n}", "~unlocking (a|the) door {n}",
         "turn (the dial|the volume up|the ignition key|a tap|the tap on|the lock) {n}", "unlock (the car|the gate|the safe|your front door) {n}", "lock (the gate|the safe|up the house) {n}",
         "open the (lock|door with a key|bottle cap) {n}", "unscrew (a|the) (lid|bottle cap|jar lid|light bulb) {n}", "screw (the lid on|a bulb into the socket|a screw into the wood) {n}",
         "fasten a screw {n}", "tighten a screw {n}", "start the car with the key {n}", "put the key in the lock and ^turn it {n}", "crack a safe {n}",
         "twiddle the (dial|knob) {n}", "tune the (radio|wireless) with its knob {n}", "adjust the (thermostat|burner) knob {n}", "undo the (padlock|bottle top) by twisting it {n}",
         "secure the (padlock|vault) with a key {n}", "loosen a (bolt|screw) with a screwdriver {n}", "uncork a bottle with a corkscrew {n}", "twist the (faucet|spigot|valve) open {n}",
         "wind the clockwork mouse with its little key {n}", "twist the lid off the (pickle|marmalade) jar {n}", "set the combination lock {n}",
         "~a (half turn|quarter turn) of the (key|doorknob)", "~{N} (half turns|quarter turns) of the key", "~a (jailer|caretaker|locksmith) turning the key {n}",
         "~a twiddle of the (knob|dial)"),
        one=("~your {S} hand turns (a|the) (key|knob|doorknob|screwdriver|dial) {n}", "~{S} hand turning a (key|knob|screwdriver) {n}", "~key in the {S} hand, turn {n}",
         "~a turn of the key with your {S} hand", "~{N} turns of the key with your {S} hand", "~the {S} hand twists a (key|knob|dial) {n}", "~{S} hand on the doorknob, turn {n}",
         "turn the key with your {S} hand {n}", "use a screwdriver in your {S} hand {n}", "twist the doorknob with your {S} hand {n}",
         "rotate a key in the lock with your {S} hand {n}", "~a twiddle of the knob with your {S} hand", "~your {S} wrist swivels to work the (key|screwdriver) {n}",
         "~{N} half turns of the key with your {S} hand", "loosen a screw with the screwdriver in your {S} hand {n}", "~corkscrew in the {S} hand, twist {n}")), sides=ONE, counts=(1, 2)),
    "flip_palm": Family(_twist_forearm(ArmPose((0.3, -0.75, 0.55), (0.08, 0.08, 1.0)), -1.1, 1.25, 1.1), Words(
        ("(turn|flip) your (palm|hand) (up and down|over) {n}", "rotate your (forearm|wrist) {n}", "twist your (forearm|wrist) {n}", "flip your hand {n}", "show the palm and the back of your hand {n}", "turn your palm to the ceiling and to the floor {n}",
         "~a (turn|flip) of the palm", "~{N} (palm turns|palm flips|turns of the palm|flips of the palm)", "~palm up, palm down {n}",
         "~(pronation and supination|supination and pronation|forearm rotation) {n}", "~a rotation of the forearm", "~{N} (forearm rotations|rotations of the forearm)", "pronate and ^supinate {n}",
         "supinate and ^pronate {n}", "do {N} (forearm rotations|palm flips)", "show the back and the front of the hand {n}", "turn the palm (up and down|over and back) {n}",
         "flip the palm (over|over and back|up and down) {n}", "rotate the forearm {n}", "turn your hand like a page {n}",
         "invert the palm and ^turn it back {n}", "swivel the forearm over and back {n}", "toggle between palm up and palm down {n}", "turn the palm over like a pancake {n}",
         "upturn the palm and ^face it down again {n}", "flop the hand over and back {n}", "turn the inside of the hand skyward and then groundward {n}", "~a (swivel|reversal) of the palm",
         "~{N} (palm reversals|palm swivels|forearm swivels)", "~axial rotation of the forearm {n}", "~a forearm swivel, palm over and back {n}"),
        both=("(turn|flip) both palms (up and down|over) {n}", "rotate both (forearms|wrists) {n}", "twist both forearms {n}", "flip both hands {n}",
         "~both palms (turn|flip) (up and down|over|over and back) {n}", "~palms up, palms down {n}", "~both forearms (rotate|twist) {n}", "~both hands turning over and back {n}",
         "~{N} (turns|flips) of both palms", "turn both hands over and back {n}", "pronate and ^supinate both forearms {n}",
         "swivel both forearms over and back {n}", "invert both palms and ^turn them back {n}", "~{N} (swivels|reversals) of both palms", "~axial rotation of both forearms {n}",
         "flop both hands over and back {n}", "turn both palms over like pancakes {n}"),
        one=("~your {S} palm (turns|flips) (up and down|over|up and then down) {n}", "~{S} palm up, {S} palm down {n}", "~your {S} (forearm|wrist) (rotates|twists|turns) {n}",
         "~{N} (turns|flips) of your {S} (palm|hand)", "~a (turn|flip) of your {S} palm", "~{S} forearm rotation {n}", "~the {S} hand turns over and back {n}",
         "(turn|flip) your {S} (palm|hand) (over|over and back|up and down) {n}", "rotate (the|your) {S} (forearm|wrist) {n}", "pronate and ^supinate (the|your) {S} forearm {n}",
         "show me the palm and the back of your {S} hand {n}", "twist the {S} forearm to and fro {n}",
         "swivel your {S} (forearm|palm) over and back {n}", "invert your {S} palm and ^turn it back {n}", "upturn your {S} palm and ^face it down again {n}",
         "~{N} (swivels|reversals) of your {S} palm", "~axial rotation of the {S} forearm {n}", "flop your {S} hand over and back {n}",
         "~the inside of the {S} hand faces skyward, then groundward {n}")), sides=ANY, counts=(1, 2)),
    "pour": Family(_pour, Words(
        ("pour (water|tea|coffee|a drink|wine|a glass of water|me a drink)( from a jug|)", "fill (a|my) glass", "empty a (jug|bottle)", "tip out a bucket", "water the (plants|flowers)", "serve the (tea|wine)", "pretend to pour a drink", "hold a watering can over the flowers", "pour out the milk",
         "~(pouring|tea pouring|a drink poured from a jug|plant watering)", "~the (tea|wine|coffee|drinks) poured (out|for me)",
         "~(water|tea|wine|coffee|juice) poured into (a|the|my) (glass|cup)", "~(water|tea|wine|coffee|juice) into the (glass|cup) from (a|the) (jug|pot|bottle)",
         "~pouring (water|tea|wine|a drink|coffee) (from a jug|into a glass|out|)", "~the waiter pouring the wine", "~(jug|teapot) tipped over a glass",
         "pour (out the tea|some juice|the wine|the beer|lemonade|milk into a cup|syrup on the pancakes|me a glass)", "fill (up |)(the|a) (glass|cup|mug) from (a|the) (jug|bottle|pot)",
         "top up (my|the) (glass|cup)", "refill (my|the) (glass|cup)", "empty (a|the) (bucket|bottle|watering can|jug) (by tipping it|into the sink)", "tip (a|the) (jug|teapot|bottle|watering can)",
         "tilt the (jug|teapot|bottle) over the glass", "water the (garden|roses|pot plants)", "be mother and ^pour the tea", "serve (coffee|a drink) from a pot",
         "pour like a (waiter|barman|tea lady)", "decant the wine",
         "slosh (water|wine) into the (beaker|glass)", "drain the (pan|teapot) into the sink", "tip out the (dregs|dishwater)", "dispense (cider|ale|juice) from a (pitcher|carafe)",
         "irrigate the (seedlings|flowerbed) from a can", "sprinkle the (geraniums|lawn) with the watering can", "replenish (my|the) (goblet|tankard) from the jug",
         "drizzle (olive oil|dressing|honey) over the salad", "do the honours with the teapot", "upend the (flask|kettle) over the cup",
         "~a (splash|trickle|slosh) of (milk|wine|vinegar) from the bottle", "~a (refill|top-up) from the (pitcher|carafe|decanter)",
         "~the (sommelier|butler|barista|hostess) pouring (champagne|a drink|sherry)", "let the liquid flow out of the jug"),
        one=("~your {S} hand pours (water|tea|wine|a drink|coffee)( from a jug| from a pot|)", "~{S} hand pouring (water|tea|a drink|wine)", "~jug in the {S} hand, (pour|tip it)",
         "~the {S} hand tips (a|the) (jug|bottle|teapot|watering can)", "~{S}-handed pouring from a jug", "tip the jug in your {S} hand", "pour a drink from the bottle in your {S} hand",
         "water the flowers with the can in your {S} hand",
         "~your {S} wrist tilts a (pitcher|carafe|kettle)", "upend the (carafe|flask) in your {S} hand", "tilt the kettle in the {S} hand over the teapot",
         "~a {S}-handed refill from the pitcher", "slosh wine into the glass with your {S} hand", "drizzle oil over the salad with the {S} hand")), sides=ONE),
    "steer": Family(_steer, Words(
        ("steer( a car| a ship| a bus| a wheel|) {n}", "drive a car( with a steering wheel|) {n}", "turn (the|a) steering wheel {n}", "pretend to drive {n}", "hold the wheel and ^steer {n}", "act like a (driver|captain) {n}", "take the wheel {n}", "turn the wheel left and right {n}", "drive a (bus|truck|lorry) {n}",
         "~(steering|driving|car driving|driving a car) {n}", "~both hands on the (wheel|steering wheel), (steering|turning it|driving) {n}", "~{N} turns of the (wheel|steering wheel)",
         "~a turn of the (wheel|steering wheel)", "~hands at ten to two on the steering wheel {n}", "~your hands (turn|hold and turn) the (steering wheel|wheel of a car) {n}",
         "~a (driver|bus driver|lorry driver|captain|racing driver) at the wheel", "~steering wheel left and right {n}", "~a drive (in a car|round the bends|in the bus)", "~a car ride at the wheel",
         "~brum brum, driving a car {n}", "drive (a racing car|a tractor|a taxi|round the bend|home in your car|to work|a go-kart) {n}",
         "steer (round a bend|the boat|the tractor|the car round the corner|left and right|through the traffic) {n}", "turn the wheel of (a car|a ship|the bus) {n}",
         "be a (bus driver|taxi driver|lorry driver|racing driver) {n}", "sit at the wheel and ^drive {n}", "grip the (wheel|steering wheel) and ^(turn it|steer|drive) {n}", "man the helm {n}",
         "navigate a (ship|car) with the wheel {n}", "play at driving a car {n}", "motor along a winding road {n}",
         "chauffeur (a limousine|the boss) {n}", "pilot (the ferry|a lorry|a submarine) with the wheel {n}", "helm the (yacht|frigate) with both hands on the wheel {n}",
         "veer left and right at the wheel {n}", "swerve round the potholes at the wheel {n}", "manoeuvre the (van|caravan) round the bollards {n}",
         "wheel the (coach|bus) round the (roundabout|hairpin bend) {n}", "guide the jeep with the steering wheel {n}", "spin the helm to port and starboard {n}",
         "cruise along the (motorway|highway) at the wheel {n}", "drive a (dodgem|bumper car|dragster|hearse) {n}", "~a (chauffeur|cabbie|trucker|motorist|helmsman|skipper) at the wheel {n}",
         "~{N} (swerves|corrections) at the steering wheel", "~a (zigzag|slalom) with the steering wheel {n}", "~vroom vroom, hands on the steering wheel {n}")), sides=BOTH, counts=(1, 2)),
}  # fmt: skip
