"""Between people: greeting, applause, joy."""

from __future__ import annotations

from mmm_core.corpus.families.gesture import ALL, ANY, BOTH, ONE, Family, Gesture, Words
from mmm_core.corpus.families.strokes import (
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


SOCIAL: dict[str, Family] = {
    "wave": Family(_wave, Words(("wave {n}", "wave (hello|goodbye|hi) {n}", "wave (at|to) (me|the camera|your friends|the crowd|everybody) {n}", "say (hello|hi|goodbye|bye)",
        "greet (me|the visitors|the guests|everyone)", "give (a|a friendly|me a) wave", "say goodbye to (me|everyone)", "welcome me with a wave",
        "bid (me|us|everyone) (farewell|goodbye|good day)", "(do|perform|make) a (wave|waving motion|greeting wave|goodbye wave|hello wave)",
        "give (us|them|the camera|the crowd|your fans|the neighbours|Grandma|the kids) a (wave|cheery wave|friendly wave)",
        "wave (bye-bye|bye bye|ta-ta|farewell|good morning|good night|welcome|so long|howdy) {n}",
        "wave (like the queen|like a king|from a balcony|at the passers-by|to the fans|at the neighbours|to the people|at Grandma|in greeting|as a greeting) {n}",
        "say (cheerio|hiya|howdy|so long|farewell|ta-ta) with a wave", "~say see you later with a wave", "greet (me|us|the people|your friends) (by waving|with a wave)",
        "acknowledge (the crowd|your fans|the applause) with a wave", "wave (me|us|them) goodbye {n}", "wave back( at me| to the children| to your friend|) {n}",
        "(answer|return) my (greeting with a wave|wave)", "take your leave with a wave", "make a waving (gesture|movement|motion) {n}",
        "~a (friendly |cheery |polite |welcoming |goodbye |hello |)wave", "~{N} (friendly |goodbye |cheery |)waves",
        "~{N} waves (goodbye|hello|to the crowd|at me|at the camera)", "~a wave (hello|goodbye|to the camera|at the audience|to everybody|to me)",
        "~a waving (motion|gesture|movement) {n}", "~some (friendly |)waving", "~waving {n}", "flap a (goodbye|hello) at me {n}",
        "~(cheerio|toodle-oo|adieu|aloha|ciao|adios|au revoir|bon voyage|godspeed), with a wave", "say (toodle-oo|ciao|adios|aloha|au revoir|bon voyage|hey there) with a wave",
        "~a (royal|regal|shy|cheeky|neighbourly|parting|jaunty|coy|wristy|nonchalant) wave {n}", "~{N} (royal|regal|shy|parting|jaunty) waves",
        "salute me with a friendly wave {n}", "wave like a (royal|celebrity|beauty queen|pageant queen|film star|toddler) {n}", "~a farewell( wave| gesture|) {n}",
        "~a (valediction|leave-taking) with a wave", "~a (greeting|salutation|hello) with a waving hand", "~a send-off with a wave",
        "wave me off at the (platform|airport|station) {n}", "see me off with a wave", "~a pageant wave {n}", "flutter a handkerchief at the departing train {n}",
        "~waves of welcome", "acknowledge my arrival with a wave", "bid adieu {n}", "take leave of (me|us) with a wave {n}",
        "~a hand like a windscreen wiper, saying hello {n}", "do the windscreen wiper with a raised hand to greet me {n}", "~a wiggle of the hand in greeting {n}",
        "gesticulate hello {n}", "attract my attention with a small wave {n}", "~a (parade|red carpet|balcony) wave {n}", "charm the crowd with a wave {n}",
        "~the waving of a hand {n}"),
        one=("wave (your|the) {S} (hand|arm) {n}", "wave {n} with your {S} arm", "(raise|lift) your {S} hand and ^wave {n}", "give {N} waves with your {S} hand",
        "do a {S} hand wave {n}", "do {N} {S} hand waves",
        "(move|swing) your {S} hand (from side to side|to and fro|left and right) (in greeting|to say hello|to say goodbye) {n}",
        "use (your|the) {S} (hand|arm) to (wave|say hello|say goodbye|greet me) {n}", "let me see your {S} (hand|arm) (wave|waving) {n}",
        "(let|make|have) your {S} (hand|arm) wave {n}", "execute a (wave|waving motion) with the {S} (arm|hand) {n}", "perform {N} waves with (your|the) {S} (hand|arm)",
        "get your {S} hand waving", "flutter your {S} hand (at me|in greeting) {n}", "wave that {S} (hand|arm) of yours {n}", "~a wave (of|with) (the|your) {S} hand",
        "~a {S}-handed (wave|greeting wave|goodbye wave)", "~{N} waves (of|with) (the|your) {S} (hand|arm)", "~{S}( |-)hand (wave|waving) {n}",
        "~your {S} (hand|arm) (waves|is waving|should wave|should be waving) {n}", "~the {S} (hand|arm) waves (hello|goodbye|at me|to the crowd|) {n}",
        "~{S} (hand|arm) waving {n}", "~with (your|the) {S} (hand|arm), wave {n}", "~{S} (hand|arm): wave {n}", "~(hello|goodbye|bye-bye|hi) with (the|your) {S} hand",
        "~a (friendly |cheery |)wave with your {S} arm", "wiggle your {S} hand (hello|goodbye|in greeting) {n}", "waggle your {S} hand (at me|in greeting|goodbye) {n}",
        "~a (waggle|wiggle) of (the|your) {S} hand in greeting {n}", "rock your raised {S} hand from side to side {n}",
        "~your raised {S} hand (rocks|sways|swishes|tilts) from side to side {n}", "swish your raised {S} hand left and right {n}", "~the {S} hand as a windscreen wiper {n}",
        "shake your raised {S} hand hello {n}", "~{S} forearm (swaying|rocking|pivoting) from side to side in greeting {n}",
        "pivot your raised {S} forearm at the elbow to greet me {n}", "~the {S} hand (flutters|swishes) goodbye {n}",
        "~a (royal|regal|parting|shy) wave with (the|your) {S} hand {n}", "bid me farewell with your {S} hand {n}", "greet the neighbours by waggling your {S} hand {n}",
        "salute me with a friendly wave of your {S} hand {n}", "~a friendly {S} paw waving {n}", "wave a hanky with your {S} hand {n}",
        "fan your raised {S} hand in greeting {n}", "~the waving of (the|your) {S} hand {n}"),
        any=("wave your hand {n}", "give {N} waves", "raise your hand and ^wave {n}", "use (a|one) hand to wave {n}", "~let me see you wave {n}",
        "move your hand from side to side (in greeting|to say hello|to say goodbye) {n}", "~your hand (waves|is waving|should wave) {n}", "~hand waving {n}",
        "~a wave of (the|your|one) hand", "~{N} waves of (the|your) hand", "waggle your hand (at me|goodbye|in greeting) {n}", "wiggle your hand hello {n}",
        "rock your raised hand from side to side {n}", "~your raised hand (rocks|sways|swishes) from side to side {n}", "~the hand (flutters|swishes) goodbye {n}",
        "~a raised hand waggling {n}", "flap your hand goodbye {n}"),
        both=("wave both (hands|arms) {n}", "wave both your arms {n}", "give {N} waves with both hands", "use both (hands|arms) to wave {n}",
        "wave with (two|both) (hands|arms) {n}", "(let|make) both hands wave {n}", "greet (me|everyone) by waving both hands {n}", "~a wave with both (hands|arms)",
        "~a (two-handed|double) wave", "~{N} (two-handed|double) waves", "~both (hands|arms) waving {n}", "~both (your |)(hands|arms) (wave|are waving|should wave) {n}",
        "~with both (hands|arms), wave {n}", "waggle both hands (hello|goodbye|at me) {n}", "~both raised hands (rock|sway|swish) from side to side in greeting {n}",
        "flutter both hands goodbye {n}", "wiggle both hands hello {n}", "~a royal wave with both hands {n}", "bid me farewell with both hands {n}",
        "swish both raised hands left and right {n}", "~both forearms like windscreen wipers {n}", "~a bimanual wave {n}", "salute the fans with both waving hands {n}"),
        alternating=("wave (first |)with one hand and then with the other {n}", "wave your hands (in turn|alternately|one after the other) {n}",
        "wave (left and right|with the left and the right hand) in turn {n}", "alternate hands and ^wave {n}", "give {N} waves with alternating hands",
        "~{N} waves with alternating hands", "~hands waving (in turn|alternately|one after the other) {n}", "~your hands wave (in turn|alternately|one after the other) {n}",
        "~first one hand waves, then the other {n}", "~a wave with each hand by turns {n}", "switch hands with every wave {n}", "swap hands while waving {n}",
        "waggle your hands hello by turns {n}", "~alternate-handed waving {n}", "flutter first one hand and then the other in greeting {n}",
        "wiggle one hand hello, then its twin {n}")), sides=ALL, counts=(2, 3), heights=True),
    "big_wave": Family(_big_wave, Words(("wave (wildly|with a straight arm|in a big arc|from far away|like on a sinking ship|for help) {n}",
        "swing your (straight |)arm (above|over) your head {n}", "give a (huge|big|giant) wave {n}", "flag down a (taxi|car|ship) {n}", "call for help by waving {n}",
        "wave at the helicopter {n}",
        "wave (madly|frantically|like crazy|like mad|like a castaway|like a shipwrecked sailor|across a football field|at a ship on the horizon|at a passing plane|to someone far away|as big as you can) {n}",
        "signal (for rescue|for help|to the rescue plane|to a distant ship) by waving overhead {n}", "attract (my|their) attention by waving overhead {n}",
        "make (huge|big|giant|sweeping|enormous) waves {n}", "give (me |us |)(an enormous|a massive|a great big|an exaggerated|a gigantic) wave {n}",
        "catch the (pilot's|taxi driver's|captain's) eye with (big|wide) waves {n}", "do (a full-arm|a whole-arm|an overhead|a giant) wave {n}",
        "wave (down a cab|down a passing car|for a taxi) {n}", "~a (huge|giant|massive|great big|gigantic) wave {n}",
        "~an (overhead|enormous|exaggerated|over-the-top) wave {n}", "~{N} (big|huge|giant|overhead|sweeping) waves",
        "~a (wide|wild|frantic|big) wave (above|over) your head {n}", "~waving (wildly|frantically|for help|overhead) {n}", "~a (castaway's|drowning man's) wave {n}",
        "~a wave (for help|for a rescue plane|for someone far away) {n}", "semaphore with a straight arm over your head {n}", "~a full-arm (swing|sweep|arc) overhead {n}",
        "~{N} full-arm (swings|sweeps|arcs) overhead",
        "wave (like a marooned sailor|like a shipwreck survivor|to the lifeboat|to the coastguard|from a desert island|from the far shore|from the mountain top) {n}",
        "~an SOS wave {n}", "signal SOS with your whole arm {n}", "~a (survivor's|marooned sailor's|festival-goer's) overhead wave {n}",
        "~a (colossal|monumental|whopping|humongous|sweeping|theatrical|extravagant|flamboyant) wave {n}",
        "give a (colossal|whopping|humongous|flamboyant|theatrical) wave {n}", "trace a rainbow over your head with your outstretched arm {n}",
        "~a rainbow traced by your outstretched arm overhead {n}", "alert the (lifeguard|coastguard|search plane) with huge waves {n}",
        "~a distress signal with the whole arm {n}", "make a distress signal with your whole arm {n}", "flag down the (bus|train|lorry|helicopter) {n}",
        "wave an enormous invisible (flag|banner) {n}", "~a flag-waver's swing overhead {n}", "~a lighter-at-a-concert wave overhead {n}",
        "guide the helicopter in with huge waves {n}", "~a wave visible for miles {n}"),
        one=("(swing|sweep) your (straight |whole |outstretched |){S} arm (above|over) your head( from side to side| to and fro|) {n}",
        "wave your (whole|entire|straight) {S} arm( over your head| overhead|) {n}", "use your whole {S} arm to wave {n}",
        "move your stretched {S} arm in a big arc over your head {n}",
        "~your (straight |outstretched |whole |){S} arm (swings|sweeps) (from side to side |back and forth |)(above|over) your head {n}",
        "~{S} arm (swinging|sweeping|waving) overhead {n}", "~a (huge|giant|big|enormous) wave (with|of) (the|your) whole {S} arm {n}",
        "~with your whole {S} arm, wave (overhead|over your head) {n}", "~the whole {S} arm waves (overhead|over the head) {n}",
        "trace a rainbow over your head with your {S} arm {n}", "~a rainbow traced by the {S} arm overhead {n}", "~a full {S} arm (swing|sweep|arc) overhead {n}",
        "~{N} {S} arm sweeps overhead", "~your {S} arm is a giant windscreen wiper overhead {n}", "wave a huge invisible flag with your {S} arm {n}",
        "~a (colossal|whopping|sweeping) wave with the {S} arm {n}", "signal SOS with your whole {S} arm {n}", "flag down a taxi with your straight {S} arm {n}",
        "swish your straight {S} arm overhead {n}", "arc your outstretched {S} arm over your head from side to side {n}", "~the {S} arm like a metronome overhead {n}",
        "make a distress signal with your {S} arm overhead {n}"),
        any=("wave your whole arm( over your head|) {n}", "(swing|sweep) your (outstretched|whole) arm over your head (from side to side|to and fro) {n}",
        "~a (big |huge |)wave with your whole arm {n}", "~your straight arm (swings|sweeps) over your head {n}", "trace a rainbow over your head with your whole arm {n}",
        "swish your straight arm overhead {n}", "~a full-arm swing over the head {n}", "arc your outstretched arm over your head from side to side {n}"),
        both=("swing both arms (above|over) your head {n}", "wave for rescue {n}", "wave both arms (wildly|frantically|madly|for help|for rescue) {n}",
        "wave both your whole arms {n}", "~a (huge|giant|massive) wave with both arms {n}", "~both arms waving (wildly|frantically|for help|for rescue) {n}",
        "~your arms wave (wildly|frantically|for help) overhead {n}", "~{N} (huge|giant) waves with both arms", "signal SOS with both arms overhead {n}",
        "~a distress signal with both arms overhead {n}", "flail both arms overhead for help {n}", "~both arms flailing overhead for help {n}",
        "~a (colossal|whopping|flamboyant) wave with both arms {n}", "swish both straight arms overhead {n}", "alert the search plane with both arms {n}",
        "semaphore for help with both arms overhead {n}")), sides=ANY, counts=(2, 3)),
    "clap": Family(_clap, Words(), sides=BOTH, counts=(3, 4), directions=("", "up"), directed={"": Words(("clap {n}",
        "clap (your hands|your hands together|with both hands|for me) {n}", "give (me |){N} claps", "applaud( the speaker| politely| me|)", "give a round of applause",
        "hit your hands together {n}", "do {N} claps", "bring your palms together {n}", "give {N} hand claps", "put your hands together for (me|the band) {n}",
        "congratulate me with applause", "(slap|beat|bang|strike) your (hands|palms) together {n}",
        "clap (for the winner|for the band|in time|along to the music|to the beat|along|like at the theatre|like an audience|like a seal|hands|in appreciation|with delight) {n}",
        "make a clapping (noise|sound|motion|movement) {n}", "show your (appreciation|approval) by clapping {n}",
        "give (me|them|the winner|the band|the artists) (a hand|a big hand|a round of applause|an ovation|some applause)", "let (us|me) hear (some|your) applause",
        "~let me hear you clap {n}", "strike one hand against the other {n}", "perform {N} (hand |)claps", "reward (me|the singer|the actors) with applause",
        "thank the (artists|band|players) by clapping {n}", "do some (hand |)clapping", "bring the hands together (sharply|with a bang) {n}",
        "applaud (the band|the actors|the winner|the show|our guests)", "play pat-a-cake", "acclaim the (winner|singer) by clapping",
        "~{N} claps( of the hands| of your hands| for me| for the band|)", "~{N} (hand|polite|loud) claps",
        "~a (round of applause|burst of applause|standing ovation|big hand for the band)", "~applause( for the band|, please| for me| for everybody| for the winner|)",
        "~some (clapping|applause|handclaps)", "~hands clapping( together|) {n}",
        "~your (hands|palms) (clap|are clapping|come together in a clap|strike each other|slap together|should clap) {n}", "~both hands (clap|clapping|clap together) {n}",
        "~clapping {n}", "~the hands (clap|are clapped|hit each other|beat together) {n}", "~with both hands, clap {n}", "smite your palms together {n}",
        "whack your hands together {n}", "crack your palms together {n}", "clash your palms together like cymbals {n}",
        "~(plaudits|kudos|bravo|an ovation|encore) for the (singer|band|cast)", "shout bravo and ^clap {n}", "demand an encore by clapping {n}", "~a smattering of applause",
        "~a clapping of hands {n}", "~a (slow|golf|polite|thunderous|rhythmic|sarcastic) (clap|handclap) {n}", "~thunderous applause",
        "~{N} (rhythmic|brisk|crisp) (claps|handclaps)", "~palm against palm, {N} claps", "clap out the (beat|rhythm) {n}", "~percussion with the palms {n}",
        "make a bang with your palms {n}", "~the (meeting|collision) of two palms, with a clap {n}", "cheer the band by clapping {n}", "laud the artist with applause",
        "~a seal clapping its flippers {n}", "clap your (flippers|mitts|paws) {n}", "clap your (flippers|mitts|paws) {n}", "shut your palms like a book with a clap {n}",
        "accompany the song with handclaps {n}", "clap flamenco palmas {n}", "~your palms (collide|bang together|snap together) in a clap {n}",
        "~a clap to wake up the sleepers {n}", "startle the birds with a clap {n}")), "up": Words(("clap (above|over) your head {n}", "clap overhead {n}",
        "clap your hands (above|over) your head {n}", "raise your arms and ^clap {n}", "clap high in the air {n}", "give {N} overhead claps", "clap up high {n}",
        "clap with your arms up {n}", "(clap|applaud) with (your |both )hands above you {n}", "(slap|strike|beat|bang) your (palms|hands) together (above|over) your head {n}",
        "clap like (a football fan|a festival crowd) with your arms (up|raised) {n}", "(stretch|put|get) your arms up and ^clap {n}",
        "lift both hands over your head and ^clap {n}", "reach up and ^clap {n}", "bring your hands together in a clap over your head {n}", "perform {N} claps overhead",
        "clap (above|over) the head {n}", "applaud (overhead|above your head|over your head) {n}", "~let me see you clap (overhead|over your head) {n}",
        "clap with (raised|lifted) (arms|hands) {n}", "~{N} (overhead claps|claps overhead|claps above your head|claps over the head|claps up high|claps with raised arms)",
        "~overhead (clapping|applause) {n}", "~hands clapping (overhead|above the head|over your head|up high) {n}", "~your hands clap (above|over) your head {n}",
        "~applause (above|over) your head", "~clapping with (your arms up|raised arms|your hands above your head) {n}", "~arms up and clapping {n}",
        "~both hands (clap|meet in a clap|are clapping) (above|over) (your|the) head {n}", "~hands over your head, clapping {n}", "~an aerial clap {n}",
        "crash your palms together overhead like cymbals {n}", "whack your palms together overhead {n}", "~(plaudits|an ovation|bravo) with the hands overhead",
        "~{N} (sky-high|aloft) claps", "~sky-high (applause|clapping) {n}", "clap with both arms stretched aloft {n}", "~handclaps above the (head|crown) {n}",
        "~a (stadium|rock concert|terrace) clap overhead {n}", "clap like a (rock concert|stadium) crowd overhead {n}",
        "make your palms meet above your (head|crown) with a clap {n}", "~the palms (collide|meet|bang together) above the (head|crown) {n}",
        "lift your handclaps above your head {n}", "clap along at the concert with your hands overhead {n}", "rally the crowd with overhead claps {n}",
        "do the Viking thunderclap overhead {n}", "~a Viking thunderclap overhead {n}", "clap your palms up at the ceiling, arms overhead {n}",
        "encourage the long jumper's crowd by clapping overhead {n}", "start a slow handclap overhead {n}")),}),
    "shrug": Family(_shrug, Words(("shrug( your shoulders| helplessly| and ^show your palms|) {n}", "give a shrug", "(raise|lift|pull up) your shoulders {n}",
        "lift your shoulders as if you do not know", "show that you (do not know|have no clue|do not care)", "say I don't know( with your shoulders|)", "give {N} shrugs",
        "make a shrug", "say (who knows|whatever)", "show (indifference|cluelessness)", "tell me that you do not know",
        "(hunch|hike up|hitch up|scrunch up|bring up|draw up) (your|both) shoulders {n}", "move your shoulders up and down {n}",
        "(pull|bring|draw|lift) (your|both) shoulders up to your ears {n}", "shrug it off {n}", "(answer|reply) with a shrug( of the shoulders|)",
        "say (search me|beats me|no idea|I have no idea|dunno|how should I know|I could not care less|so what|don't ask me)", "turn your palms up and ^shrug {n}",
        "spread your hands and ^shrug {n}", "act (clueless|indifferent|ignorant|as if you have no idea|as if you do not care)", "plead ignorance",
        "signal (ignorance|that you have no idea|that you could not care less)", "do the I don't know gesture", "perform (a shoulder shrug|a shrug) {n}",
        "do {N} (shoulder |)shrugs", "shrug like (a Frenchman|you do not care) {n}", "~a (helpless |clueless |shoulder |Gallic |)shrug {n}",
        "~a shrug of (the|your) shoulders {n}", "~{N} (big |shoulder |clear |)shrugs", "~{N} shrugs of (the|your) shoulders",
        "~your shoulders (go up|rise|lift|come up|go up and down|should go up|go up to your ears) {n}", "~both shoulders (go up|up|raised|lifted|up and down) {n}",
        "~shoulders (up|raised|up to the ears|up and down|hunched in a shrug) {n}", "~the shoulders (rise|are raised|come up|go up and down) {n}",
        "~an I don't know gesture {n}", "~a gesture (of cluelessness|of not knowing|that says I don't know)", "~palms up and shoulders raised",
        "heave your shoulders up and ^let them drop {n}", "jerk both shoulders up {n}", "twitch both shoulders up {n}", "shoot your shoulders up to your ears {n}",
        "heighten your shoulders {n}", "~a (heave|hunch|hitch|lift|jerk|twitch) of (the|your) shoulders {n}", "hoick your shoulders up {n}",
        "~both (scapulae|shoulder blades|collarbones|clavicles) (slide|go|move) up {n}", "raise both (scapulae|shoulder blades|collarbones) {n}",
        "contract your (upper traps|trapezius) to lift the shoulders {n}", "do a trap shrug {n}", "~a (trap|trapezius) shrug {n}",
        "~a (nonchalant|noncommittal|resigned|baffled|puzzled|bewildered|apathetic|dismissive) shrug {n}", "~{N} (nonchalant|resigned|baffled) shrugs",
        "express (bafflement|bewilderment|puzzlement|resignation|apathy) with your shoulders", "look (baffled|puzzled|perplexed|bewildered|stumped) with raised shoulders",
        "say (meh|no clue|go figure|que sera sera|it is what it is|your guess is as good as mine|haven't the foggiest)", "~(meh|no clue|dunno|beats me|haven't the foggiest)",
        "~the shrug emoji {n}", "do the shrug emoji {n}", "profess (ignorance|that you know nothing)", "disclaim all knowledge", "~a what-can-you-do gesture {n}",
        "turtle your head between your raised shoulders {n}", "~your neck (vanishes|disappears) between your raised shoulders {n}", "~your shoulders (bob|bounce|hop) up {n}",
        "be stumped by my question", "feign ignorance")), sides=BOTH, counts=(1,)),
    "hug": Family(_hug, Words(), sides=BOTH, directions=("", "in"), directed={"": Words(("open your arms( wide|)", "welcome (me|everybody) with open arms",
        "spread your arms for a hug", "hold your arms open", "open both arms( to welcome everybody|)", "invite me for a hug", "ask for a hug", "stand with open arms",
        "(fling|throw) your arms open( in welcome| to welcome me| for me|)", "offer (me |us |)a hug", "get ready (for a hug|to give me a hug)",
        "open your arms (to me|to embrace me|for a cuddle|for a hug|like a loving mother|to greet me)", "hold your arms (out|wide|apart|ready) for a hug",
        "invite me into your (arms|embrace)", "receive (me|us|the guests) with open arms", "beg for a hug", "say (give me a hug|come and hug me|come to my arms)",
        "wait for a hug with open arms", "greet (me|the world|the guests) with open arms", "extend your arms (for a hug|in welcome)", "make a hug-me gesture",
        "~arms (open|wide open|opened|out|ready) for a (hug|cuddle)", "~(open arms|arms wide open|arms open in welcome)",
        "~both arms (open|opened wide) (in welcome|to welcome me|for an embrace)", "~your arms (open|are open|open wide|should be open) (for a hug|to welcome me|in welcome)",
        "~an invitation to (hug|a hug|cuddle)", "~a (welcome|greeting) with open arms", "~an open-armed (welcome|greeting)", "~the arms open (in welcome|for a hug)",
        "~a hug invitation", "await a hug with outspread arms", "unfold your arms for a hug", "~outspread arms (for a hug|in welcome)",
        "~a (hospitable|motherly|heartfelt|homecoming) welcome with open arms", "stretch out your arms for a hug", "solicit a hug", "request (a hug|an embrace|a cuddle)",
        "crave a (hug|cuddle)", "propose a hug", "~a bid for a hug", "~arms agape for a hug", "~ready for a (snuggle|hug|squeeze), arms open", "~come to Daddy, arms open",
        "~bring it in, mate, arms open", "~who wants a hug", "make room for me in your arms", "open up your arms for a (snuggle|squeeze)",
        "make a space between your open arms for me", "~an (offer|request) of a hug", "~the opening of the arms for a hug", "long for a hug with open arms",
        "greet your (long-lost brother|sweetheart|grandchildren) with open arms", "widen your arms for an embrace", "~free hugs", "offer (free hugs|a snuggle)",
        "~an embrace waiting to happen, arms open")), "in": Words(("give (a|me a|someone a) (big |)hug", "hug (me|someone|a friend|a tree)", "embrace (me|a friend|someone)",
        "wrap your arms around (someone|me)", "take me in your arms", "cuddle (me|a teddy bear)", "squeeze me in a hug", "(fold|gather|hold|enfold|clasp) me in your arms",
        "hold me (tight|close)( in your arms|)", "press (me|your friend) to your (chest|heart)",
        "give (me|us|your friend|Grandma|the children) (a cuddle|a squeeze|a bear hug|a warm hug|an embrace|a hug)",
        "hug (an invisible person|the air|your best friend|Mum|a big teddy bear|a tree trunk|me tightly)", "pretend to hug (someone|me|a tree)",
        "show me how you hug (someone|a friend)", "(close|put|throw) your arms around (me|a friend|somebody)", "comfort (me|a friend) with a hug",
        "embrace (the air|your grandmother|an old friend|me warmly)", "pull me into (a hug|your arms|an embrace)",
        "~a (big |warm |bear |close |tight |loving |)hug( for me| for a friend|)", "~an embrace( for a friend| for me|)", "~a (warm|close|loving|tight) embrace",
        "~a cuddle( for me| for a teddy bear|)", "~your arms (wrap|close|fold|go) around (me|someone|a friend)",
        "~both arms (around|wrapped around|closed around) (me|someone|a friend)", "~arms around (me|someone|a friend|a tree)", "~hugging (someone|a friend|me|a tree)",
        "~the arms close (around somebody|in a hug)", "snuggle (me|a teddy bear|a pillow)", "nestle me in your arms against your chest", "envelop me in your arms",
        "encircle (me|a tree) with your arms", "enclose me in your arms", "clinch me in a hug", "smother me with a hug", "engulf me in a bear hug",
        "wind your arms around (me|a friend)", "loop your arms around (me|a friend)", "entwine your arms around me", "squish me in a hug", "bundle me up in your arms",
        "cling to me in a hug", "~a (snuggle|loving clinch|group hug|heartfelt squeeze)", "~an (affectionate|tender|consoling|enveloping) (hug|embrace)",
        "~a (tender|consoling|snug|cosy) (hug|cuddle)", "~the (embracing|hugging|enfolding) of a (friend|loved one)", "~a tree-hugger in action", "be a tree-hugger",
        "~your arms (encircle|envelop|enclose|enfold|clasp) (me|a friend)", "console (me|a mourner) with an embrace", "reunite with a long-lost friend in a hug",
        "~a ring of arms around me", "hold your sweetheart close in both arms", "~arms wound around (me|a pillow)")),}, holds=True),
    "handshake": Family(_handshake, Words(("shake hands {n}", "shake my hand {n}", "give me a handshake", "greet me with a handshake",
        "shake hands with (me|a friend|the president) {n}", "take my hand and ^shake it {n}", "introduce yourself with a handshake", "seal the deal with a handshake",
        "offer a handshake", "(give|offer) me a (firm |friendly |hearty |)handshake", "greet (me|the guest|the ambassador|your new boss) by shaking hands {n}",
        "shake (my hand|hands) (firmly|heartily|warmly|like a businessman|like a politician|on the deal|in greeting) {n}",
        "congratulate me (with a handshake|by shaking my hand)", "welcome (me|the visitor) with a handshake", "shake on it {n}",
        "~say (how do you do|pleased to meet you|nice to meet you) with a handshake", "pump my hand up and down {n}", "(grasp|grip|seize|clasp) my hand and ^shake it {n}",
        "make peace with a handshake", "press the flesh", "introduce yourself by shaking hands {n}", "close the deal with a handshake", "do a handshake( with me|)",
        "~a (firm |friendly |warm |hearty |polite |)handshake", "~a shake of (hands|my hand) {n}", "~{N} shakes of (my|the) hand",
        "~a handshake (with me|to seal the deal|in greeting|for the visitor|among friends)", "~shaking hands( with me| with a friend|) {n}", "~an old-fashioned handshake",
        "clasp hands with me and ^shake {n}", "wring my hand {n}", "~a (clasp|wring) of the hand in greeting {n}", "conclude the (bargain|contract|treaty) with a handshake",
        "strike a bargain with a handshake", "~it's a deal, with a handshake", "ratify the treaty with a handshake", "settle the (dispute|bet) with a handshake",
        "~a (businesslike|gentlemanly|presidential|diplomatic|cordial|vigorous|formal) handshake {n}", "~a (diplomat's|salesman's|gentleman's|candidate's) handshake {n}",
        "make my acquaintance with a handshake", "~{N} (hearty|formal) handshakes", "~a deal-sealing (shake|handshake) {n}", "~a gentlemen's agreement, shaken on {n}",
        "reconcile with me by shaking hands {n}", "glad-hand the voters {n}", "~a paw shake with me {n}", "shake paws with me {n}",
        "take the ambassador by the hand and ^shake it {n}", "jiggle my hand up and down in a handshake {n}", "~the shaking of hands {n}", "bury the hatchet with a handshake",
        "exchange a handshake with me", "swap handshakes with the captain of the other team {n}", "~an up-and-down shake of joined hands {n}"),
        one=("(hold|put|stick) out your {S} hand (for a handshake|to shake mine|to be shaken)", "(extend|offer) your {S} hand for a (handshake|shake)",
        "shake my hand with (your|the) {S} (hand|one) {n}", "use your {S} hand to shake mine {n}", "give me your {S} hand to shake",
        "~your {S} hand (shakes mine|shakes my hand|is shaking my hand|should shake mine) {n}", "~{S} hand (out for a handshake|extended to shake hands|shaking mine)",
        "~a {S}-handed handshake", "~a handshake with (your|the) {S} hand", "~with (your|the) {S} hand, shake (mine|my hand) {n}",
        "~the {S} hand shakes (mine|a visitor's hand) {n}", "~{S} hand: handshake", "clasp my hand with your {S} (one|hand) and ^shake it {n}",
        "wring my hand with your {S} (one|hand) {n}", "pump my hand with your {S} one {n}", "~the {S} hand pumps mine up and down {n}", "proffer your {S} hand for a handshake",
        "present your {S} hand for a handshake", "~a (formal|cordial|vigorous) handshake with the {S} hand {n}", "~your {S} forearm bobs up and down in a handshake {n}",
        "~{S} hand clasping and shaking mine {n}", "seal the bargain with your {S} hand in mine {n}", "jiggle my hand with your {S} (hand|one) {n}",
        "~the {S} hand of a politician shaking hands {n}", "shake paws with your {S} (paw|hand) {n}"),
        any=("(hold|put|stick) out your hand (for a handshake|to shake mine|to be shaken)", "extend your hand for a (handshake|shake)",
        "~your hand (shakes mine|is shaking mine) {n}", "~hand out for a handshake", "proffer your hand for a handshake", "present your hand for a handshake",
        "~the hand pumps mine up and down {n}", "pump my hand in a handshake {n}", "~your forearm bobs up and down in a handshake {n}")), sides=ONE, counts=(2, 3)),
    "high_five": Family(still(ArmPose((0.4, 0.35, 0.7), (0.08, 0.8, 0.62), -0.4), (0.4, 1.2)), Words(("give (me |)a high five", "high-five me", "~high five( me|)",
        "slap my raised hand", "do a high five", "ask for a high five", "celebrate with a high five", "raise your palm for a high five",
        "(give|offer|slap) me (a high-five|five|a high five)", "high-five (me|a friend|your teammate|the team)", "go for a high five", "get ready for a high five",
        "do the high-five gesture", "(congratulate|greet) (me|your friend|your teammate) with a high five", "share a high five (with me|with a friend)",
        "meet my palm in a high five", "reward me with a high five", "~a (friendly |celebratory |winner's |)high( |-)five( for me| with a friend|)", "~gimme five",
        "~a give-me-five (pose|gesture)", "~an air five", "~a (palm|hand) slap up high", "~up top, mate", "say (up top|gimme five|put it there, up high)",
        "exchange a high five", "trade high fives with me", "receive my high five", "~a (congratulatory|sporty|basketball player's|buddy's) high five",
        "clap my raised palm with yours", "~a clap of palms with a (friend|teammate) up high", "slap palms with (me|a friend|a teammate) up high", "collect a high five",
        "~a slap on my raised palm", "~a five from the robot, up high", "acknowledge my goal with a high five", "land a high five", "await my high five"),
        one=("give me five with your {S} hand", "(raise|hold up|put up) your {S} (hand|palm) for (a high five|me to slap)", "hold out your {S} palm for me to slap",
        "let me slap your {S} (palm|hand)", "offer your {S} palm for a high five", "use your {S} hand for a high five", "high-five me with (your|the) {S} (hand|palm)",
        "~high five me with (your|the) {S} (hand|palm)", "~{S} (hand|palm) up for a high five",
        "~your {S} (hand|palm) (is up|goes up|is raised|should be up|comes up) for a high five", "~a {S}-handed high five",
        "~a high five (from|with) (the|your) {S} (hand|palm)", "~with (your|the) {S} hand, (high five me|give me five|give me a high five)",
        "~the {S} palm is up for me to slap", "~{S} hand: high five", "present your {S} palm for a high five", "slap my raised palm with your {S} (hand|palm)",
        "clap my raised palm with your {S} one", "~{S} palm up top for a slap", "~up top with the {S} hand", "~the {S} palm waits for a slap up high",
        "~a palm slap with the {S} hand up high", "trade a high five with your {S} hand", "~an air five with the {S} hand", "ready your {S} palm for a high five",
        "~the {S} hand flat and high, waiting for mine to slap it", "~the {S} palm as a target for my high five", "exchange a high five with your {S} hand",
        "display your {S} palm at head height for a high five"),
        any=("(hold|put) up your palm for (me to slap|a high five)", "let me slap your palm", "raise a hand for a high five",
        "~your (hand|palm) (goes up|is up|is ready) for a high five", "~(hand|palm) up for a high five", "~high( |-)five(, mate|, buddy|)", "present your palm for a high five",
        "ready a palm for a high five", "~a palm up top for a slap", "~a palm waiting for a slap up high", "exchange a high five with one hand"),
        both=("give (me |)a high ten", "high-five me with both hands", "~high five me with (both|two) hands", "hold (up|out) both palms for me to slap",
        "do a (double high five|high ten)", "let me slap both your palms", "~a (high ten|double high five|two-handed high five)",
        "~both (hands|palms) up for a high (five|ten)", "~your (hands|palms) (are|go) up for a high ten", "~high ten", "present both palms for a high ten",
        "slap both my palms with both of yours up high", "~up top with both hands", "~a two-palm slap up high", "~both palms wait for a slap up high",
        "ready both palms for a high ten", "exchange a high ten with me", "trade a double high five with me", "~an air ten", "~both palms as targets for my high ten")),
        holds=True),
    "fist_bump": Family(still(ArmPose((0.2, -0.5, 0.8), (-0.02, 0.12, 1.0), -0.9), (0.3, 1.0)), Words(("give (me |)a fist bump", "~fist bump me",
        "bump (my fist|fists with me)", "offer your fist", "greet me with a fist bump", "hold out your fist for a bump", "do a fist bump", "~bro fist me",
        "touch my fist with yours", "pound my fist", "bump (knuckles|fists) with (me|a friend|your mate)", "knock (fists|knuckles) with me",
        "(perform|share|make) a fist bump( with me|)", "give me (some knuckles|some dap|a knuckle bump|a fist-bump|a friendly fist bump)",
        "greet (a friend|your mate|your bro|your teammate) with a fist bump", "meet my fist with yours", "tap fists with (me|a friend)", "offer (me |us |)a fist bump",
        "celebrate with a fist bump", "fist-bump (me|a friend|your bro|your teammate)", "congratulate me with a fist bump", "go for a fist bump",
        "~a (friendly |cool |)fist( |-)bump( for me| with a friend|)", "~a (knuckle|bro) bump", "~a bump of (the |)fists", "~some (knuckles|dap) for me", "~fist bumping",
        "dap me up with your fist", "~a brofist", "~a (fist|knuckle) (tap|knock|touch) in greeting", "~a meeting of (fists|knuckles)",
        "~a (germ-free|pandemic|covid|hygienic) greeting with the fist", "~pound it, bro", "say (pound it|respect, bro) with a fist bump",
        "lock knuckles with me in a fist bump", "nudge my fist with yours", "clink fists with me", "~knuckles against knuckles", "~respect, with a fist bump",
        "~props, with a fist bump", "rap knuckles with me in greeting", "~a Baymax fist bump", "press your knuckles against mine", "acknowledge me with a fist bump",
        "~a (mate's|teammate's|gamer's|boxers') (knuckle|fist) tap", "trade fist bumps with me", "poke your fist forward for a bump"),
        one=("(hold|put|stick) out your {S} fist (for a bump|to bump mine|for me to bump)", "extend your {S} fist (for a bump|to bump mine)",
        "bump my fist with your {S} (fist|one)", "offer (me |)your {S} fist for a bump", "touch my fist with your {S} fist", "make a fist with your {S} hand and ^bump mine",
        "fist-bump me with (your|the) {S} (hand|fist)", "~fist bump me with (your|the) {S} (hand|fist)",
        "~your {S} fist (is out for a bump|comes forward for a bump|bumps mine|meets mine|touches mine|should bump mine)",
        "~{S} fist (out|forward|extended) for a (bump|fist bump)", "~a {S}-handed fist bump", "~a fist bump with (your|the) {S} (hand|fist|arm)",
        "~with (your|the) {S} hand, (give me a fist bump|bump my fist)", "~the {S} fist (bumps|meets|touches) mine", "~{S} hand: fist bump", "nudge my fist with your {S} fist",
        "press your {S} knuckles against mine", "~{S} knuckles (against mine|forward for a bump)", "present your {S} (fist|knuckles) for a bump",
        "~a brofist with the {S} hand", "~a {S}-handed (knuckle|fist) tap", "tap my knuckles with your {S} (fist|knuckles)", "poke your {S} fist forward for a bump",
        "dap me up with your {S} fist", "proffer your {S} (fist|knuckles) for a bump", "ball your {S} hand and ^bump my fist", "~the {S} knuckles nudge mine",
        "clink fists with me using your {S} one", "pound my fist with your {S} one"),
        any=("stick your fist out for a bump", "~your fist (bumps|meets|touches) mine", "~fist (out|forward|ready) for a bump", "~fist( |-)bump(, mate|, bro|)",
        "present your (fist|knuckles) for a bump", "~knuckles forward for a bump", "nudge my fist with your own fist", "press your knuckles against mine with one hand",
        "ball one hand and ^bump my fist")), sides=ONE, holds=True),
    "fist_pump": Family(_fist_pump, Words(("pump your fist {n}", "do (a fist pump|{N} fist pumps)", "pull your fist down (in triumph|and ^say yes) {n}",
        "say yes with your fist {n}", "celebrate with a fist pump", "do a yes gesture {n}", "pump a fist in triumph {n}", "draw your fist down like a winner {n}",
        "do a (triumphant|victorious|winner's) fist pump {n}", "celebrate (a goal|a point|your win) with a fist pump", "say (yes|get in|come on|got it) with a fist pump {n}",
        "shout yes and ^pump your fist {n}", "make a fist and ^pull it down in triumph {n}", "do the (tennis champion's|winner's) fist {n}",
        "fist-pump( like a winner| in triumph|) {n}", "~fist pump( like a winner| in triumph|) {n}", "mark the point with a fist pump", "perform (a fist pump|{N} fist pumps)",
        "give (a fist pump|{N} fist pumps)", "~a (triumphant |victorious |winner's |)fist( |-)pump {n}", "~{N} (triumphant |winning |)fist( |-)pumps",
        "~a pump of the fist {n}", "~a triumphant yes with the fist {n}", "~fist pumping {n}", "~a yes! fist", "~a fist (pumped|pulled down) in triumph {n}",
        "~a (tennis player's|golfer's|Tiger Woods|scorer's|striker's|victor's) fist( |-)pump {n}", "do the Tiger Woods fist pump {n}",
        "ball your fist and ^yank it down in triumph {n}", "clinch the (match|point) with a fist pump {n}", "~get in, with the fist {n}",
        "say (boom|bingo|get in there|nailed it|yes, I did it) with a fist pump {n}", "~a (jubilant|fierce|exultant|elated) (pump|tug|jerk) of the fist {n}",
        "~{N} (jubilant|fierce|elated) fist( |-)pumps", "~the pumping of a fist {n}", "tug an imaginary (chain|bell rope) down in triumph with a fist {n}",
        "punctuate your win with a fist pump {n}", "hammer home your triumph with a fist pump {n}", "~an elbow (jerk|snap) down with the fist in triumph {n}",
        "~nailed it, with a fist pump {n}", "fist-pump like a (scorer|gamer|golfer) {n}", "express your triumph with a fist pump {n}"),
        one=("pump your {S} fist( in triumph| in celebration| like a winner| to say yes|) {n}", "pump the air with your {S} fist {n}",
        "(pull|jerk|yank|draw|bring) your {S} fist down (in triumph|to celebrate|as if to say yes|like a winner) {n}", "celebrate with your {S} fist {n}",
        "say yes with your {S} fist {n}", "do a fist pump with (your|the) {S} (hand|arm) {n}",
        "~your {S} fist (pumps|comes down in triumph|is pulled down in triumph|jerks down in triumph|should pump) {n}", "~{S} fist pumping {n}", "~{S}( |-)hand fist pump {n}",
        "~a fist pump with (your|the) {S} (arm|hand) {n}", "~{N} fist pumps with (your|the) {S} (hand|arm)", "~a pump of (the|your) {S} fist {n}",
        "~with (your|the) {S} hand, (pump your fist|do a fist pump) {n}", "~the {S} fist (pumps|is pumped) {n}", "~{S} hand: fist pump {n}",
        "ball your {S} fist and ^yank it down in triumph {n}", "tug your {S} fist down in triumph {n}", "~a (jubilant|fierce|elated) (tug|jerk|pump) of the {S} fist {n}",
        "snap your {S} elbow down with a triumphant fist {n}", "~the {S} elbow snaps down with a triumphant fist {n}",
        "~your {S} fist drops from up high to the ribs in triumph {n}", "clinch the point with a pump of your {S} fist {n}", "~get in, with the {S} fist {n}",
        "say (boom|bingo|nailed it) with your {S} fist {n}", "tug an imaginary chain down with your {S} fist in triumph {n}", "~a Tiger Woods pump with the {S} fist {n}",
        "~{N} triumphant (tugs|jerks) of the {S} fist", "wrench your {S} fist down in triumph {n}"),
        any=("(jerk|yank|bring) your fist down (in triumph|as if to say yes) {n}", "~your fist (pumps|comes down in triumph) {n}", "~fist pulled down in triumph {n}",
        "tug your fist down in triumph {n}", "~the elbow snaps down with a triumphant fist {n}", "~a (tug|jerk) of the fist in triumph {n}",
        "ball your fist and ^wrench it down in triumph {n}")), sides=ONE, counts=(1, 2)),
    "cheer": Family(_cheer, Words(("cheer( loudly| for the team| for me|) {n}", "pump both fists in the air {n}", "cheer with both arms {n}", "give {N} cheers",
        "raise both arms and ^cheer {n}", "shout hooray {n}", "root for your team", "throw your arms up in joy {n}", "cheer me on {n}", "be a cheerleader", "shout with joy",
        "pump your arms up {n}", "(yell|shout) hurray {n}", "encourage (me|the players) {n}", "support your team with raised arms {n}",
        "shout (hip hip hooray|hurrah|go team|come on, lads) {n}", "root for (the home team|me|us|the runners)",
        "cheer (like a football fan|like a supporter|at the match|the runners on|for the winner|us on) {n}", "(urge|spur) (me|the team|the players|the runners) on {n}",
        "give (a|a loud) cheer {n}", "(raise|let out) a cheer {n}", "cry (hooray|hurrah|yippee) {n}",
        "pump (both|your) (fists|arms) (above your head|skywards|towards the sky) {n}", "act like a (cheerleader|football fan|supporter) {n}",
        "do a (cheer|hooray|cheerleading move) {n}", "whoop and ^pump both fists in the air {n}", "be a (football fan|loud supporter)",
        "say (hooray|hurrah|hip hip hooray) {n}", "~{N} (loud |big |)cheers for (me|the team|the winner|us)",
        "~a (loud |big |)cheer( for the team| for me| for the winner|) {n}", "~hip hip hooray {n}",
        "~both fists (pumping|pump) (in the air|above your head|over your head|up high) {n}", "~fists pumping in the air {n}",
        "~your (fists|arms) (pump|are pumping) (in the air|over your head) {n}", "~hooray( for the team| for me| for the winner|) {n}",
        "~some cheering( for the team| for me|)", "~(loud |)cheering {n}", "~raised fists, cheering {n}", "~with both fists up, cheer {n}", "hurrah the team {n}",
        "holler for (the team|your side|the champions) with both fists up {n}", "bellow go, go, go with both fists in the air {n}",
        "rally the (team|troops|players) with both fists in the air {n}", "chant for your (club|team|side) with both fists in the air {n}",
        "~a (rally cry|battle cry|war whoop), fists in the air {n}", "~a (supporter's|rooter's|ultra's|hooligan's|superfan's) cheer {n}", "~three cheers for the birthday boy",
        "~(huzzah|yay|yahoo|woohoo|yeehaw|attaboy|rah rah rah), fists up {n}", "shout (huzzah|yay|woohoo|yahoo|olé|bravo) with both fists up {n}",
        "jab both fists at the sky {n}", "punch the sky with both fists {n}", "~both fists (jab|punch) at the sky {n}", "~a double fist pump overhead {n}",
        "do a double fist pump overhead {n}", "galvanise the team with both fists in the air {n}", "motivate the runners with both fists in the air {n}",
        "boost the team's morale with cheering {n}", "whip up the crowd with both fists {n}", "bob both fists up and down overhead {n}",
        "~both fists (bob|bounce) up and down overhead {n}", "~the cheering of the (fans|stands|terraces) {n}", "~vocal support for the team, fists up {n}",
        "~a pom-pom routine {n}", "shake your pom-poms overhead like a cheerleader {n}", "egg the team on with both fists up {n}", "~go team, fists up {n}")), sides=BOTH,
        counts=(2, 3)),
    "celebrate": Family(_celebrate, Words(("celebrate( your victory| a goal| wildly| with your arms up|)", "rejoice", "jubilate", "be (overjoyed|very happy|thrilled)",
        "show that you are (happy|overjoyed)", "act as if you won the (lottery|race|world cup)", "go crazy with joy", "party", "express your joy", "exult",
        "cry hurray with your arms in the air", "be (over the moon|on cloud nine|ecstatic|jubilant|delighted|beside yourself with joy)", "show (your|great|wild) joy",
        "make merry", "whoop it up", "celebrate (like you won the lottery|like a champion|your birthday|the New Year|our win|the winning goal|the good news)",
        "go (wild|nuts|bananas|mad) with (joy|happiness)", "act (overjoyed|ecstatic|as if you just won|like the happiest person on earth)",
        "express (great happiness|delight|your happiness)", "let your joy out", "react (as if you scored the winning goal|to wonderful news|as if you won the lottery)",
        "jump for joy without leaving the ground", "burst with (joy|happiness)", "do a (goal|winner's|joyful) celebration",
        "show me how you celebrate( a goal| your birthday|)", "~a (joyful |wild |happy |victory |goal |big |)celebration", "~an (outburst|explosion|expression) of joy",
        "~a (show|burst) of (joy|happiness|delight)", "~a celebration of (the goal|your win|a great success|the New Year)", "~celebrating( a goal| the win| your birthday|)",
        "~arms (thrown|flung) up in celebration", "~your arms fly up in celebration", "~(great|wild|sheer|pure) (joy|happiness|jubilation)",
        "~both arms (go|fly) up in (celebration|jubilation)", "revel( in your success|)",
        "be (elated|euphoric|exultant|rapturous|overjoyed and elated|tickled pink|chuffed to bits|stoked|gleeful)",
        "~(euphoria|elation|exultation|exhilaration|rapture|ecstasy|glee|triumph and delight), arms up", "~a (jubilee|revelry|festivity|victory party)",
        "carouse with your arms up", "whoop with delight, arms up", "~an (elated|ecstatic|exuberant|euphoric|exultant) (celebration|reaction)",
        "act (elated|euphoric|ecstatic|exuberant)", "~an exuberant outburst, arms flung up", "erupt with (joy|delight)", "explode with (joy|happiness)", "overflow with joy",
        "~bingo, I won", "shout (bingo|eureka|we won|we did it|jackpot) with your arms up", "~(eureka|jackpot|we won|yippee|yay, we did it)", "react as if you hit the jackpot",
        "~the celebration of a (footballer|goalscorer|jackpot winner)", "~a goalscorer's celebration", "fete the (winner|hero) with your arms up",
        "party like it is New Year's Eve", "~pure bliss, arms up and shaking", "glory in your win", "let loose with joy", "toss your arms up and ^rejoice",
        "~an arms-up hooray of pure happiness", "~New Year's Eve at midnight", "welcome the New Year at midnight with your arms thrown up")), sides=BOTH),
    "toast": Family(_toast, Words(("raise (a|your) glass", "make a toast", "propose a toast", "say cheers", "toast (me|the happy couple|to your health)",
        "lift your glass to (me|the winner)", "drink to our health with a raised glass", "clink glasses with me", "hold up your glass",
        "raise (a toast|your cup|your champagne|your beer|a mug|a glass of wine|your tankard)( to me| to the bride| to our success|)",
        "(give|offer) a toast( to the host| to the bride| to me|)", "say (bottoms up|good health|here's to us|here's to the bride|chin chin)",
        "lift (a|your) (glass|cup|mug) in (a toast|honour of the winner)", "toast (the bride|the New Year|our friendship|the champion|us|the host)",
        "touch glasses with (me|the guests)", "hold (a|your) (glass|drink) (high|up|out) for a toast", "honour the (couple|host|winner) with a toast",
        "drink a toast( to the bride| to us| to absent friends|)", "extend your glass for a toast", "charge your glass and ^raise it",
        "~a toast( to you| to the bride| to the New Year| to friendship| to us| to your health|)", "~glass (raised|up|held up|lifted)( for a toast|)",
        "~a raised glass( to the bride| to us|)", "~here's to (you|us|the bride|the happy couple|your health)",
        "~your glass (goes up|is raised|should be raised|is lifted) (in|for) a toast", "~glasses up", "~an imaginary glass raised for a toast",
        "~(cheers|prost|santé|skol|salud|slainte|l'chaim), with a glass", "~(skol|prost|slainte|salud)", "say (prost|skol|slainte|salud|santé) with a glass",
        "chink glasses with me", "clink (tankards|goblets|flutes|mugs) with me",
        "raise your (goblet|tankard|chalice|flute|stein|tumbler|pint|beaker|champagne|bubbly|beer|wineglass)", "lift your (goblet|tankard|chalice|stein|champagne flute|pint)",
        "~a (best man's|toastmaster's|wedding|birthday|jubilee|christening|champagne|New Year's) toast", "propose a (best man's|wedding) toast",
        "~a (tankard|goblet|stein|champagne flute|pint) raised to (you|the host)", "pledge the bride and groom with your glass", "drink to the newlyweds with a raised glass",
        "salute the (host|newlyweds) with your glass", "~a libation to friendship, glass raised", "commemorate the day with a raised glass",
        "wish (me|the couple) well with a raised glass", "~a salute with the glass", "~the raising of (glasses|a glass)", "~the clinking of glasses", "be the toastmaster",
        "honour absent friends with your glass", "celebrate the launch with a raised flute"),
        one=("raise (a|your|the) glass with your {S} (hand|arm)", "lift the glass in your {S} hand (to toast me|for a toast)",
        "hold a glass (up|out) in your {S} hand for a toast", "use your {S} hand to raise a glass", "toast me with the glass in your {S} hand",
        "~glass in your {S} hand, raised for a toast", "~a toast with (your|the) {S} (hand|arm)", "~your {S} (hand|arm) (raises|lifts|holds up) a glass",
        "~{S} hand (lifting|raising) a glass", "~with (your|the) {S} hand, (raise a glass|make a toast)", "~the {S} (hand|arm) raises a glass to (me|the couple)",
        "~{S} hand: glass up for a toast", "raise a (goblet|tankard|stein|pint|flute) with your {S} hand", "clink your glass on mine with your {S} hand",
        "chink glasses with me using your {S} hand", "~a (goblet|tankard|stein|pint) in your {S} hand, raised to the host", "~the {S} hand lifts a (goblet|tankard|wineglass)",
        "salute the host with the glass in your {S} hand", "propose a toast with the wineglass in your {S} hand", "drink to my health with a raised glass in your {S} hand",
        "~a {S}-handed toast", "~a champagne toast with the {S} hand", "stretch your {S} arm out with a goblet to say cheers", "~{S} hand: cheers with a pint")), sides=ONE,
        holds=True),
    "pat_back": Family(strokes(ArmPose((0.25, -0.35, 0.9), (0.0, 0.3, 1.0), -0.8), ArmPose((0.2, -0.3, 0.95), (-0.1, -0.1, 1.0), -0.8), 0.6),
        Words(("pat (me on the back|me on the shoulder|a friend on the back|the dog|a child on the head) {n}", "pet (the dog|a cat|the horse) {n}", "stroke the (cat|dog) {n}",
        "comfort me with a pat {n}", "clap me on the shoulder {n}", "give me {N} pats", "give (me|your friend|a colleague) (a pat|{N} pats) on the (back|shoulder)",
        "pat (my|your friend's|a colleague's|somebody's) (back|shoulder) {n}", "(congratulate|praise|encourage|console) me with a pat on the (back|shoulder) {n}",
        "pet (an animal|the puppy|a kitten|the rabbit) {n}", "pat (the pony|the puppy|a big dog|the horse's neck|a cow) {n}", "tap me on the shoulder {n}",
        "stroke the (puppy|rabbit|horse|kitten) {n}", "say (well done|good boy|good dog|there, there) with a pat {n}", "reassure (me|a friend|the child) with a pat {n}",
        "comfort a friend by patting them on the back {n}", "slap me on the back {n}", "give the (dog|horse|pony) (a pat|{N} pats)",
        "~a pat on (my|the|a friend's) (back|shoulder) {n}", "~a friendly pat (on the back|on the shoulder|for the dog) {n}",
        "~{N} (friendly |gentle |)pats (on the back|on my shoulder|for the dog|for the horse)", "~a (well-done|comforting|reassuring) pat {n}",
        "~a clap on (my|the) shoulder {n}", "~(petting|stroking|patting) (the dog|a cat|the horse) {n}", "fondle the dog {n}", "fuss over the (dog|puppy) {n}",
        "give the dog a fuss {n}", "ruffle the dog's fur {n}", "soothe the (horse|pony|crying child) with pats {n}", "thump me on the back {n}", "thwack me on the back {n}",
        "~a (congratulatory|paternal|brotherly|consoling|chummy|matey|hearty|fatherly) (pat|slap|clap) on the back {n}",
        "~{N} (brotherly|consoling|hearty) (pats|slaps|claps) on my back", "~a back( |-)(pat|slap) {n}", "~shoulder( |-)patting {n}", "burp the baby by patting its back {n}",
        "dab me gently on the shoulder {n}", "~the (petting|patting|stroking) of a (dog|pony|calf|donkey) {n}", "console (me|the loser) with a pat on the shoulder {n}",
        "commend me with a pat on the back {n}", "cheer me up with a pat on the shoulder {n}", "pacify the horse with pats {n}",
        "pat the (donkey|calf|goat|labrador|spaniel|mare) {n}", "stroke the (donkey|lamb|guinea pig) {n}", "calm the nervous horse with pats {n}", "~nice doggy, with pats {n}",
        "~attaboy, with a pat on the back {n}", "~good girl, with a pat for the mare {n}"),
        one=("use your {S} hand to (pat the dog|pat me on the back|stroke the cat|pet the horse) {n}", "lay your {S} hand on my shoulder and ^pat it {n}",
        "pat my (back|shoulder) with (your|the) {S} (hand|palm) {n}", "let your {S} hand pat (the dog|my shoulder|my back) {n}",
        "~your {S} hand (pats|is patting) (me on the back|the dog|my shoulder|a friend's shoulder) {n}", "~{S} hand patting (my back|the dog|me on the shoulder) {n}",
        "~a pat on my (back|shoulder) (with|from) your {S} hand {n}", "~with (your|the) {S} hand, pat (the dog|me on the back|my shoulder) {n}",
        "~the {S} hand (pats|strokes) the (dog|cat|horse) {n}", "~{N} pats on my (back|shoulder) (with|from) your {S} hand",
        "thump me on the back with your {S} (hand|palm) {n}", "ruffle the dog's fur with your {S} hand {n}", "soothe the horse with pats of your {S} (hand|palm) {n}",
        "~a (brotherly|consoling|hearty) (pat|slap) on my back with the {S} (hand|palm) {n}", "burp the baby with pats of your {S} hand {n}",
        "~the {S} palm (dabs|taps|thumps) my shoulder {n}", "fondle the spaniel with your {S} hand {n}", "~{N} gentle {S} hand pats on my shoulder",
        "give the donkey a pat with your {S} hand {n}", "console me by patting my shoulder with your {S} hand {n}", "commend me with a pat from your {S} hand {n}",
        "pet the (mare|donkey|labrador) with your {S} palm {n}")), sides=ONE, counts=(2, 3)),
}  # fmt: skip
