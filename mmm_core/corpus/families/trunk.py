"""Trunk and whole stance: bowing, leaning, twisting, swaying, breathing, standing."""

from __future__ import annotations

import numpy as np

from mmm_core.corpus.families.gesture import LEFT_RIGHT, Family, Gesture, Perform, Words
from mmm_core.corpus.families.strokes import SIGN, keep, turn_s
from mmm_core.corpus.score import Score


def _bow(score: Score, g: Gesture) -> None:
    for _ in range(g.count):
        depth = np.deg2rad(38) * g.size * score.rng.uniform(0.85, 1.15)
        score.move(turn_s(score, g, 0.85), trunk=(0.0, depth, 0.0), head=(0.0, 0.3 * depth, 0.0))
        score.hold(g.hold_s or score.rng.uniform(0.15, 0.7))
        score.move(turn_s(score, g, 0.85), trunk=(0.0, 0.0, 0.0), head=(0.0, 0.0, 0.0))


def _lean(score: Score, g: Gesture) -> None:
    angle = np.deg2rad(score.rng.uniform(16, 24)) * g.size
    target = {
        "left": (0.0, 0.0, angle),
        "right": (0.0, 0.0, -angle),
        "forward": (0.0, angle, 0.0),
        "back": (0.0, -0.6 * angle, 0.0),
    }
    score.move(turn_s(score, g, 0.75), trunk=target[g.direction])
    keep(score, g, (0.5, 1.5))


def _twist(score: Score, g: Gesture) -> None:
    angle = np.deg2rad(score.rng.uniform(26, 40)) * SIGN[g.direction] * g.size
    score.move(turn_s(score, g, 0.7), trunk=(angle, 0.0, 0.0))
    keep(score, g, (0.5, 1.6))


def _side_to_side(axis: int, angle_deg: float, half_s: float) -> Perform:
    def perform(score: Score, g: Gesture) -> None:
        first = 1 if score.rng.random() < 0.5 else -1
        half = max(0.35, half_s / g.tempo)
        for i in range(2 * g.count):
            angles = [0.0, 0.0, 0.0]
            angles[axis] = first * (1 - 2 * (i % 2)) * np.deg2rad(angle_deg) * g.size * score.rng.uniform(0.92, 1.08)
            score.move(half * (0.75 if i == 0 else 1.0), trunk=angles, head=[-0.5 * a for a in angles])
        score.move(half * 0.75, trunk=(0.0, 0.0, 0.0), head=(0.0, 0.0, 0.0))

    return perform


def _circle(score: Score, g: Gesture) -> None:
    turn = -1 if score.rng.random() < 0.5 else 1
    wide = np.deg2rad(15) * g.size
    score.move(turn_s(score, g, 0.5), trunk=(0.0, wide, 0.0))
    score.trace(
        g.count * max(1.0, 1.7 / g.tempo),
        trunk=lambda u: np.array([
            0.0, wide * np.cos(2 * np.pi * g.count * u), turn * wide * np.sin(2 * np.pi * g.count * u)
        ]),
    )  # fmt: skip
    score.move(turn_s(score, g, 0.5), trunk=(0.0, 0.0, 0.0))


def _breathe(score: Score, g: Gesture) -> None:
    for _ in range(g.count):
        depth = g.size * score.rng.uniform(0.9, 1.1)
        half = max(0.7, 1.0 / g.tempo * score.rng.uniform(0.9, 1.1))
        score.move(half, trunk=(0.0, -0.12 * depth, 0.0), shrug=0.75 * depth, head=(0.0, -0.08 * depth, 0.0))
        score.move(1.15 * half, trunk=(0.0, 0.05, 0.0), shrug=-0.05, head=(0.0, 0.03, 0.0))


def _slump(score: Score, g: Gesture) -> None:
    depth = np.deg2rad(score.rng.uniform(15, 21)) * g.size
    score.move(turn_s(score, g, 1.1), trunk=(0.0, depth, 0.0), head=(0.0, 1.1 * depth, 0.0), shrug=-0.4)
    keep(score, g, (0.7, 1.8))


def _stand(score: Score, g: Gesture) -> None:
    score.hold(g.hold_s or score.rng.uniform(1.2, 3.0))


def _shift(score: Score, g: Gesture) -> None:
    """Small idle movements: weight from one foot to the other, a short glance."""
    side = 1 if score.rng.random() < 0.5 else -1
    for _ in range(int(score.rng.integers(2, 4))):
        roll = side * np.deg2rad(score.rng.uniform(1.5, 3.0))
        score.move(score.rng.uniform(0.7, 1.1), trunk=(0.5 * roll, 0.01, roll), head=(0.8 * roll, 0.02, -0.8 * roll))
        score.hold(score.rng.uniform(0.3, 0.8))
        side = -side


def _lean_words(where: str) -> Words:
    return Words((
        f"lean (to the |to your |over to the |){where}", f"bend (your body |your upper body |sideways |)to the {where}", f"(tilt|tip) your (upper body|torso) (to the |){where}",
        f"lean over to your {where} side", f"lean your (body|torso) (to the |){where}", f"bend over to the {where} side",
        f"~a (slight |)lean to (the|your) {where}", f"~a (side bend|sideways lean|sideways tilt of the trunk) to the {where}", f"~your (upper body|torso|trunk|body) (leans|tilts|tips|bends) (over |)to the {where}",
        f"~(torso|trunk|body|upper body) (tilted|leaning|bent) (to the |){where}", f"~your {where} shoulder (sinks|drops|goes down) towards your {where} hip", f"~your body is slanted to the {where}",
        f"~a (list|slant) to the {where} like (a sinking ship|the tower of Pisa)", f"~a lean towards your {where} neighbour", f"~trunk side bend, {where}",
        f"tilt (over |)to the {where} from the waist", f"flex your (trunk|spine) (laterally|sideways) to the {where}", f"do a (small |)side bend to the {where}", f"list to the {where} like a (ship|sinking ship)",
        f"slant your (body|torso|trunk) (to the |){where}", f"tip (over |)to your {where}", f"let your (upper body|torso) (fall|sink|tip) to the {where}", f"lean {where} like (the tower of Pisa|a motorcyclist|a tree in a storm)",
        f"drop your {where} shoulder towards your {where} hip", f"shift your chest sideways to the {where}", f"lean towards your {where} neighbour", f"lean on an invisible wall to your {where}", f"put your body at a slant to the {where}",
        f"bend your (waist|trunk) (over |)to the {where}", f"dip your (upper body|torso) to the {where}",
        f"(heel|bank|keel|careen|cant|lurch|veer) (over |)to the {where}", f"(heel|bank) over to the {where} like a (sailing boat|yacht|plane in a curve)", f"(crook|curve|arc|slope|angle) your (torso|trunk|spine) to the {where}", f"shorten your {where} (flank|waist|side)", f"crunch your {where} side, ribs to hip", f"bring your {where} (ribs|armpit|elbow) closer to your {where} hip",
        f"sidebend to the {where}", f"stretch the opposite flank by leaning to the {where}", f"loll to the {where}", f"sag sideways to the {where}", f"stoop sideways to the {where}", f"bow sideways to the {where} like a (reed|willow|blade of grass)",
        f"tip {where} like a little teapot", f"do a (lateral|standing) (flexion|crunch|crescent) to the {where}", f"make a crescent moon of your body to the {where}", f"duck sideways to the {where} with your upper body", f"put your weight and shoulders over your {where} (foot|leg)",
        f"lean (askew|aslant|crooked|lopsided|diagonally|obliquely) to the {where}", f"take a (bend|curve) to the {where} like a (biker|cyclist|racing driver)", f"skew your torso to the {where}", f"~a (lateral|sideward) (flexion|bend|lean) of the (trunk|spine|torso) to the {where}", f"~lateral trunk flexion, {where}", f"~a (cant|heel|bank|tip|lurch) of the upper body to the {where}",
        f"~your spine (curves|arcs|bows) (sideways |)to the {where}", f"~your {where} flank (shortens|crumples|contracts)", f"~your ribs (slide|shift|move) towards your {where} hip", f"~your (shoulders|head and shoulders) (tip|shift|drift) over to the {where}", f"~torso (askew|aslant|lopsided|crooked) to the {where}", f"~a crescent pose to the {where}",
        f"~a bend of the waist to the {where}", f"~the body like a bow, curved to the {where}",
    ))  # fmt: skip


TRUNK: dict[str, Family] = {
    "bow": Family(_bow, Words((
        "bow (politely|down|respectfully|to the audience|to me|in front of the king|) {n}", "(take|make|give) a (deep |polite |)bow", "make {N} bows",
        "bend forward in a bow {n}", "give {N} bows", "bow your upper body {n}", "greet (me |)with a bow", "thank the audience with a bow",
        "bend at the waist {n}", "greet (me |)like a Japanese host",
        "~a (polite|deep|respectful|formal|small|courtly|low|) bow", "~a bow (to the audience|before the king|of thanks|from the waist|in greeting|for the crowd)",
        "~a bow like (an actor|a butler|a samurai) at the end", "~a Japanese bow", "~{N} (deep|polite|low|) bows", "~{N} bows to the (audience|crowd|judges)", "~(deep|polite|formal) bow",
        "~a bow is called for", "~your (upper body|torso) (dips|goes down) in a bow {n}", "~your (upper body|torso|back) bends down in a bow and comes up again {n}", "take (your|a) final bow {n}",
        "do (a bow|{N} bows)", "pay your respects with a bow {n}", "bow and ^scrape {n}", "bow from the (waist|hips) {n}", "bow like (an actor|a butler|a gentleman|a judo fighter|a servant) {n}",
        "fold at the hips and ^come back up {n}", "hinge at the hips and ^straighten up again {n}", "accept the applause with a (deep |)bow {n}", "acknowledge the (crowd|audience) with a bow {n}",
        "show your (respect|reverence) with a bow {n}", "say thank you with a (deep |)bow", "pay homage with a bow", "make (obeisance|a deep reverence)", "execute {N} bows",
        "let me see a (nice |deep |)bow",
        "kowtow (respectfully|) {n}", "salaam with a deep bow {n}", "jackknife politely at the waist and ^straighten up again {n}", "lower your upper body (humbly|reverently) and ^rise again {n}", "dip your (trunk|torso) in (reverence|deference|gratitude|salutation) {n}", "(honour|revere|venerate|salute) the (emperor|queen|master|sensei) with a bow {n}",
        "bow (humbly|courteously|ceremoniously|graciously|gallantly|submissively|solemnly) {n}", "defer to the king with a bow", "humble yourself with a bow {n}", "double over in a bow {n}", "crook your back in a bow {n}",
        "perform (a rei|an ojigi|the karate bow|a curtain-call bow) {n}", "take a curtain call", "thank your fans from the stage with a bow {n}", "show (deference|humility|devotion|submission|gratitude) by bowing {n}", "bend (reverently|double|humbly) at the waist {n}", "do a good morning (exercise|hip hinge) without weights {n}",
         "make a (jackknife|ninety degree) bow {n}", "ask the lady for a dance with a bow", "apologise with a deep bow {n}", "beg pardon with a bow {n}", "~an (obeisance|ojigi|obsequious bow|elegant bow)",
        "~a (humble|reverent|ceremonial|courteous|gallant|theatrical|sweeping|submissive|chivalrous) bow", "~a (bending|lowering|dipping|folding) of the upper body in greeting", "~a (kowtow|salaam|reverence|curtain call)", "~{N} (kowtows|salaams|curtain calls)", "~{N} (hinges|bends) at the hips", "~a (hinge|fold) at the hips and back up",
        "~hip flexion with a straight back, then upright again {n}", "~your trunk folds forward at the hips and unfolds again {n}", "~your head and chest go down in (deference|homage|respect) and come back up {n}", "~respect, shown with your (back|spine)",
    )), "trunk", (), (1,)),
    "lean": Family(_lean, Words(), "trunk", (), (), ("left", "right", "forward", "back"), {
        "left": _lean_words("left"), "right": _lean_words("right"),
        "forward": Words(("lean (forward|towards me|to the front)", "bend forward a little", "lean your (body|torso|upper body) forward", "tilt your (upper body|torso) forward",
                          "bend your (back|body) forward", "come closer with your upper body", "lean in( to listen|)", "bring your chest forward",
        "~a (slight |)lean (forward|to the front|towards me)", "~a lean over the (table|railing|counter)", "~a forward (lean|tilt) of the (trunk|torso|upper body)",
        "~your (upper body|torso|trunk|chest) (leans|tilts|tips|comes) forward", "~(body|torso|upper body|trunk) (tilted|leaning|tipped) forward", "~upper body bent forward (a little|slightly)",
        "~your upper body comes closer to me", "~your shoulders move forward over your toes", "tip forward a little with your upper body", "lean in closer", "lean into the wind",
        "slant your body forward", "lean towards (the microphone|the screen|the mirror|the listener)", "lean over the (table|railing|counter|desk)", "pitch your (trunk|torso|upper body) forward",
        "tilt the (trunk|torso) (forward|to the front)", "come towards me with your upper body", "bring your shoulders forward over your toes", "lean forward like a (ski jumper|skier|cyclist)",
        "stoop (forward |)a little", "hinge forward a little at the hips", "angle your (trunk|torso|upper body) forward", "inch forward with your upper body", "advance your (chest|shoulders|upper body)",
        "protrude your upper body a little to the front", "loom over me", "loom forward", "tip your weight onto your toes with your chest ahead of your hips", "hang over the (fence|balustrade|rail|parapet|bannister)", "bend over the (pram|cradle|map|sink|cooking pot|chessboard)",
        "huddle in closer", "lean in (confidentially|conspiratorially|nosily|inquisitively|eagerly|attentively)", "lean into the (gale|breeze|storm|slope|harness)", "lean forward like (a sprinter at the finish|a jockey|a speed skater|an eager student)", "bring your face and chest closer (to the shop window|to the keyhole|)", "flex (the|your) (trunk|spine|hips) forward a little",
        "shift your (shoulders|trunk) ahead of your hips", "edge forward with your upper body", "stick your (chest and head|upper body) out over the balcony", "list forward like a ship's figurehead", "draw near me with your upper body", "~a (stoop|slant|pitch|hinge) of the (trunk|torso|upper body) to the front",
        "~(slight |)(trunk|hip) flexion, leaning to the front", "~a (confidential|curious|eager|interested|attentive|conspiratorial) lean towards me", "~your (spine|trunk|back) slopes forward", "~your (breastbone|sternum|belly button) moves ahead of your toes", "~your weight moves onto the balls of your feet, chest first", "~an anterior lean of the trunk",
        "~shoulders ahead of the hips", "~your nose and chest approach me",
        "let your (torso|upper body) tip forward")),
        "back": Words(("lean (back|backward|away from me)", "bend (backward|back)", "lean your (body|torso|upper body) (back|backward)", "tilt your upper body (back|backward)",
                       "bend your (back|body) backward", "draw your upper body back", "move your chest back", "lean away",
        "~a (slight |)lean (back|backward|away from me)", "~a (small |)back bend", "~a backward (lean|tilt) of the (trunk|torso|upper body)",
        "~your (upper body|torso|trunk) (leans|tilts|goes|tips) (back|backward)", "~(body|torso|upper body|trunk) (tilted|leaning) (back|backward)", "~shoulders back behind the hips",
        "~your chest opens and your back arches", "~a lean back as if against a wall", "lean back as if in a (deckchair|rocking chair)", "lean back against an invisible wall",
        "lean back like a (limbo dancer|water skier)", "do the limbo", "do a (small |)back bend", "arch (your back|backward)", "tip backward (a little |)with your upper body",
        "pull your upper body away from me", "take your upper body back", "tilt the (trunk|torso) backward", "pitch your (trunk|torso|upper body) (back|backward)",
        "recline (a little|)", "lounge back as if in an (armchair|easy chair)", "loll back", "rear back", "recoil (from me|from the smell|from the heat|a little|)", "flinch back with your upper body",
        "cringe away backward", "withdraw your (upper body|torso|chest)", "retract your upper body", "retreat a little with your upper body", "distance yourself with your chest", "hollow your back",
        "extend your (spine|trunk|back) backward", "hyperextend your spine a little", "do a (standing|gentle) (backbend|extension) of the spine", "rock back on your heels", "slant your (torso|trunk|upper body) back", "angle your (torso|trunk|upper body) (back|backward)",
        "curve your spine (back|backward)", "duck back under the limbo (stick|bar|pole)", "lean back to dodge a (blow|slap|bee)", "lean back like (the tug-of-war team|a windsurfer|a satisfied diner)", "open your ribcage and ^lean back", "put your weight on your heels and ^lean back",
        "let your shoulders travel behind your hips", "yield backward with your upper body", "~a (backbend|recoil|recline|limbo)", "~(trunk|spinal|back) extension", "~a (posterior lean|retreat|withdrawal) of the upper body",
        "~your (spine|back) (curves|bends|hollows) (backward|to the rear)", "~your (ribs|breastbone|sternum) lift and your shoulders travel to the rear", "~your weight moves onto your heels, shoulders behind", "~a reclining (posture|stance)", "~upper body in (recline|retreat)",
        "let your (torso|upper body) tip back", "shrink back from me", "dodge backward with your upper body")),
    }, holds=True),
    "twist": Family(_twist, Words((
        "(turn|rotate|twist) your (upper body|torso|waist|body|shoulders) (to the |to your |){D}", "(twist|swivel) (to the |){D}",
        "turn at the waist to the {D}", "rotate your chest to the {D}",
        "~a (turn|twist|rotation) of the (torso|upper body|waist|trunk|shoulders) to the {D}", "~a {D} twist of the (torso|waist|body)", "~a (torso|waist|trunk|body) twist to the {D}",
        "~your (upper body|torso|waist|chest|trunk) (turns|twists|rotates|swivels) to the {D}", "~(torso|chest|upper body|trunk) turned (to the |){D}", "~(torso|trunk|waist) rotation to the {D}",
        "~chest facing {D}", "~hips still, shoulders round to the {D}", "~your shoulders (turn|swing round) to the {D}", "pivot your (chest|upper body|torso) (to the |){D}", "twist round to the {D}",
        "twist from the waist to the {D}", "twist your spine to the {D}", "screw your body round to the {D}", "swing your shoulders round to the {D}", "aim your chest to the {D}",
        "rotate the trunk (to the |){D}", "yaw your (torso|trunk) to the {D}", "face {D} with your (chest|shoulders|upper body)", "keep your feet still and ^turn your shoulders to the {D}",
        "spin your upper body to the {D}", "wring your waist to the {D}", "set the waist rotation to the {D}", "turn {D} from the (hips|waist) up",
        "(wind|coil|torque|crank|corkscrew|wrench|slew|veer) your (torso|trunk|upper body) (round |)to the {D}", "(wheel|revolve) your upper body to the {D}", "orient your (chest|sternum|breastbone|navel|ribcage) to the {D}", "point your (sternum|breastbone|navel|belly button|ribcage) (to the |){D}", "(steer|direct|present) your (chest|breastbone) to the {D}", "turn your (trunk|ribcage|back|midsection|middle|belly|abdomen) to the {D}",
        "do a (standing|spinal|yoga|torso) (twist|rotation) to the {D}", "coil up to the {D} like a (discus thrower|spring|golfer)", "wind up to the {D} like a discus thrower", "contort your waist to the {D}", "turn your body to the {D} as if to talk to your neighbour, feet planted", "swing your (shoulder girdle|chest|trunk) to the {D}",
        "engage your obliques and ^twist to the {D}", "turn your shoulder line to the {D}", "pivot at the (waist|hips) to the {D}", "slue round to the {D} from the waist", "show your chest to the (wall|neighbour|crowd) on your {D}", "turn round to the {D} on the spot without moving your feet",
        "unscrew your upper body to the {D} like a lid", "~a (corkscrew|coil|wrench|swivel|pivot) of the (trunk|torso|upper body) to the {D}", "~(axial|spinal|thoracic) rotation (of the trunk |)to the {D}", "~a {D} (trunk|spinal|thoracic|waist) (rotation|turn|twist)", "~your (ribcage|breastbone|sternum|navel|belly button) (turns|swivels|points) to the {D}", "~feet (planted|rooted), upper body turned to the {D}",
        "~your (shoulder girdle|shoulder line) rotates to the {D}", "~a yoga twist to the {D}", "~your spine (winds|spirals|corkscrews) to the {D}", "~legs to the front, chest to the {D}", "~a turn from the waist to the {D}",
    )), "trunk", (), (), LEFT_RIGHT, holds=True),
    "sway": Family(_side_to_side(2, 11, 0.62), Words((
        "sway (from side to side|left and right|to the music|) {n}", "(sway|rock) your (body|upper body) (from side to side|left and right) {n}", "lean left and right {n}",
        "rock (from side to side|gently) {n}", "swing your upper body from side to side {n}", "sway like a tree in the wind {n}", "move your body to the rhythm {n}",
        "lean from one side to the other {n}", "do {N} side bends",
        "~a (gentle |slow |)sway (from side to side|to the left and right) {n}", "~{N} sways (from side to side|to each side)", "~{N} side bends, left and right", "~{N} leans to each side",
        "~your (body|upper body|torso) (sways|rocks) (from side to side|left and right) {n}", "~your body goes left and right like a (tree|reed|mast) in the wind {n}",
        "~body swaying (from side to side|left and right|in the breeze) {n}", "~a rocking of the body from side to side {n}", "~your body is a (reed|palm tree) in the wind {n}",
        "~the (trunk|torso) leans left, then right {n}", "sway (to and fro|gently|along with the song|along with the tune) {n}", "sway like (a reed|a palm tree|a drunk|a drunken sailor|a ship) {n}",
        "rock like a boat (on the waves|) {n}", "rock yourself from side to side {n}", "tilt your (trunk|torso|upper body) left and right {n}", "move your body like a (metronome|pendulum) {n}",
        "bend (your body |)from one side to the other {n}", "bend your body left and then right {n}", "list left and right like a ship {n}", "flex your trunk to both sides {n}",
        "tip your upper body from side to side {n}", "do {N} (sways|side bends) to the music",
        "(teeter|totter|roll|wave|undulate|waver|swing) (gently |)from side to side with your (body|upper body) {n}", "seesaw from side to side {n}", "rock gently as if you hold a baby in a (sling|carrier) {n}", "lilt (from side to side|to the melody) {n}", "swing to the (ballad|waltz|lullaby|beat|tune) from side to side {n}", "sway like (a cornstalk|a willow|a poplar|seaweed|wheat|kelp|a hammock|a bell|a cobra|a snake charmer's snake) {n}",
        "bob from side to side like a (buoy|cork|dinghy) {n}", "roll like a ship at sea, left and right {n}", "keep time with your whole trunk, left and right {n}", "sidebend to the left and right {n}", "stretch your flanks, left and right in turn {n}", "groove (gently |)from side to side {n}",
        "waltz on the spot with your upper body, left and right {n}", "heel to port and ^heel to starboard {n}", "flex your spine laterally, left and right {n}", "wobble your (torso|trunk) from side to side like a (punching clown|roly-poly toy|skittle) {n}", "swing and ^sway with the crowd {n}",
        "sway like guests in a beer tent {n}", "~{N} lateral (bends|flexions), left and right", "~{N} swings of the trunk from side to side", "~a (lilt|seesaw|roll|wobble|lilting) of the (trunk|torso|body) from side to side {n}", "~a pendulum swing of the upper body {n}", "~your shoulders (tip|seesaw|dip) left and right by turns {n}",
        "~your (spine|trunk) (curves|bends|tips) left and right in turn {n}", "~the swaying of a (drunkard|willow|buoy|ship's mast) {n}", "~an inverted pendulum: your body, left and right {n}", "~lateral trunk flexion to both sides {n}", "~your flanks stretch by turns {n}",
    )), "trunk", (), (2, 3)),
    "twist_repeat": Family(_side_to_side(0, 30, 0.6), Words((
        "(twist|turn|rotate) your (upper body|torso|waist|shoulders) (from side to side|left and right) {n}", "twist (from side to side|left and right) {n}",
        "do {N} (torso|waist) twists", "swivel left and right {n}", "warm up your waist by turning left and right {n}", "swing your shoulders from side to side {n}",
        "~{N} (torso|waist|trunk) (twists|rotations)", "~{N} twists of the (torso|waist|upper body)", "~{N} (body twists to both sides|standing Russian twists)",
        "~a (torso|waist|trunk) twist to both sides {n}", "~your (upper body|torso|waist) (twists|turns|rotates) (left and right|from side to side|to both sides) {n}",
        "~shoulders turning left and right {n}", "~torso (rotation|rotations) to both sides {n}", "~the (waist|trunk) rotates one way and then the other {n}",
        "~chest round to the left, chest round to the right {n}", "do the twist (like Chubby Checker|) {n}", "swivel your (torso|waist|trunk|upper body) (from side to side|both ways) {n}",
        "rotate (left and right|both ways) at the waist {n}", "wring your waist both ways {n}", "twist one way and then the other {n}", "turn your chest left and then right {n}",
        "loosen (your waist|your lower back) with twists {n}", "do {N} (trunk rotations|waist turns|body twists)", "rotate your (trunk|spine) to both sides {n}",
        "turn your body like a washing machine {n}", "twist your body to and fro {n}", "swing your shoulders round to one side and then the other {n}",
        "(swing|wheel|slew|crank|wind) your (trunk|torso|upper body) left and right about the vertical {n}", "(coil|corkscrew|screw) your body one way and then the other {n}", "turn your (breastbone|sternum|ribcage|navel) left and then right {n}", "swish your upper body round to the left and the right {n}", "rotate your shoulder girdle to both sides {n}", "twist your midsection to both sides {n}",
        "mobilise your (spine|thoracic spine) by turning to both sides {n}", "limber up with (trunk|torso|waist) twists {n}", "pivot your (chest|torso|upper body) left and right {n}", "alternate trunk turns to the left and the right {n}", "work your obliques with twists to both sides {n}", "agitate like the drum of a washing machine {n}",
         "swivel your torso like a (fan|table fan|sprinkler|surveillance camera) {n}", "turn your upper body like a (rattle drum|pellet drum) {n}", "boogie with twists of the waist {n}", "rock and ^roll with twists of the waist {n}", "do the (twist dance|sixties twist) {n}",
        "reverse your torso rotation again and again {n}", "~{N} (standing twists|waist rotations|spinal twists|trunk turns)", "~{N} swivels of the torso to each side", "~a (standing|gymnastic|warm-up) trunk rotation to both sides {n}", "~(axial|thoracic|spinal) rotation to both sides {n}", "~your (breastbone|ribcage|navel|chest) swings left and right {n}",
        "~your (trunk|spine) (winds|turns|pivots) both ways {n}", "~a swivel of the (chest|torso) to and fro {n}", "~your shoulder line sweeps left and right over still hips {n}", "~the twist (from the sixties|as a dance) {n}", "~a rotary movement of the trunk, left and right {n}",
    )), "trunk", (), (2,)),
    "trunk_circle": Family(_circle, Words((
        "circle your (upper body|torso|waist|trunk) {n}", "(rotate|roll) your (upper body|torso|trunk) in (a circle|circles) {n}", "make circles with your (upper body|torso|waist) {n}",
        "move your (upper body|torso) in (a circle|circles) {n}", "draw {N} circles with your (upper body|torso)", "do {N} torso circles", "swing your upper body round in a circle {n}",
        "roll your waist (around|) {n}",
        "~{N} circles with the (upper body|torso|trunk)", "~{N} (torso|trunk|waist|upper body) circles", "~a (big |)circle with your (upper body|torso|trunk) {n}",
        "~(torso|trunk|waist) circles {n}", "~your (upper body|torso|trunk) (circles|goes round in a circle|describes a circle) {n}", "~your chest travels round in a circle {n}",
        "~a (trunk|torso) roll (all the way round|) {n}", "~{N} rolls of the (torso|trunk)", "~round and round with your (upper body|torso) {n}", "~upper body (circling|going round) {n}",
        "swirl your (upper body|torso) round {n}", "stir the air with your upper body {n}", "do {N} (waist|trunk|upper body) circles", "move your trunk round in (a circle|circles) {n}",
        "trace (a circle|circles) with your (chest|trunk|torso) {n}", "go round in circles with your (upper body|torso) {n}", "sweep your (upper body|torso) round in a circle {n}",
        "loosen your waist in circles {n}", "spin a hula hoop {n}", "pretend to (hula hoop|spin a hula hoop) {n}", "circumduct your trunk {n}", "orbit your hips with your shoulders {n}",
        "(whirl|twirl|wheel|revolve|loop|orbit) your (upper body|torso|trunk) (round |round and round ){n}", "churn butter with your whole upper body as the paddle {n}", "(mix|grind) round and round with your torso like a (pestle|spoon) {n}", "rotate your body above the hips like a (spinning top that slows down|wobbling top|joystick) {n}", "describe (a cone|an orbit|a ring|a loop) with your (trunk|torso|chest) {n}", "bend forward, sideways, back and sideways again in one round sweep {n}",
        "lean round in every direction in turn, in a circle {n}", "limber up your (back|waist|spine) with (torso|trunk) circles {n}", "mobilise your (lower back|lumbar spine) with torso circles {n}", "do a (trunk circumduction|torso rotation in a circle|waist roll) {n}", "wobble round in a circle like a (spinning plate|spinning coin|gyroscope) {n}", "twirl a (hoop|hula hoop|ring) round your waist {n}",
        "hula with an invisible hoop round your waist {n}", "windmill your upper body round {n}", "travel round in a circle with your (shoulders|breastbone) {n}", "encircle your hips with your upper body {n}", "~{N} (revolutions|loops|whirls|orbits) of the (torso|trunk)", "~{N} trunk circumductions",
        "~a (circumduction|revolution|loop|whirl|orbit) of the (trunk|torso|upper body) {n}", "~a circular (movement|motion|bend|sweep) of the (trunk|torso|upper body) {n}", "~the hula hoop (movement|motion|exercise) {n}", "~your (breastbone|shoulders) (orbit|trace a ring around) your hips {n}", "~your trunk (revolves|whirls|wheels) round above the hips {n}", "~your spine describes a cone {n}",
        "~forward, left, back and right with your upper body, in one sweep {n}",
    )), "trunk", (), (1, 2)),
    "breathe": Family(_breathe, Words((
        "breathe (deeply|in and out|in deeply and ^breathe out|) {n}", "take (a deep breath|deep breaths) {n}", "take {N} (deep |)breaths", "inhale and ^exhale {n}",
        "fill your lungs {n}", "breathe in and out (slowly|deeply) {n}", "do {N} breathing exercises", "sigh (deeply|) {n}", "let your chest rise and fall {n}", "draw {N} deep breaths",
        "calm down with deep breaths", "take (a long breath|some air)", "catch your breath",
        "~a (deep|long|big|slow) breath", "~a (deep|heavy|long|big) sigh", "~a (lungful|chest full) of air", "~a sigh of relief", "~{N} (deep|long|slow|) breaths", "~{N} breaths in and out",
        "~{N} deep sighs", "~breath in, breath out {n}", "~in with the air and out again {n}", "~your chest (rises and falls|swells and sinks) {n}", "~your lungs fill (with air|up) {n}",
        "~breathing (in and out|deeply) {n}", "inhale (deeply|slowly) and ^exhale {n}", "suck in air and ^let it out {n}", "get some air into your lungs {n}", "take (a breather|a lungful of air)",
        "take in (air|oxygen) {n}", "breathe like (in yoga|in meditation|a yogi) {n}", "draw breath {n}", "let out a (deep |long |big |)sigh", "heave a (deep |)sigh",
        "practise (deep|yoga) breathing {n}", "expand your chest with air {n}", "breathe the fresh (mountain|sea|morning) air {n}", "breathe a sigh of relief", "let the air in and out {n}",
        "pump your lungs full of air {n}",
        "(respire|ventilate) deeply {n}", "puff yourself up with air and ^let it go {n}", "(gulp|gasp|swallow) some (fresh |)air {n}", "huff and ^puff {n}", "pant (heavily|) {n}", "wheeze {n}",
        "inflate your (lungs|chest|ribcage) and ^deflate {n}", "swell your (chest|ribcage) with a breath {n}", "expel the air from your lungs after a deep breath {n}", "sniff the sea breeze deeply {n}", "exhale with relief {n}",
        "aerate your lungs {n}", "use your diaphragm and ^breathe {n}", "lift your ribcage with each (inhalation|breath) {n}", "recover from the (sprint|race|marathon) with deep breaths {n}", "compose yourself with a deep breath", "steady your nerves with a deep breath",
        "meditate with deep breaths {n}", "relax with breathing exercises {n}", "blow off steam with a deep breath", "count your breaths {n}", "oxygenate your (blood|body) with deep breaths {n}", "breathe (heavily|loudly|audibly|calmly|evenly|abdominally|like Darth Vader|like a diver before the plunge) {n}",
        "smell the (roses|flowers) with a deep breath", "~{N} (inhalations|exhalations|respirations|breathing cycles|gasps|lungfuls of air)", "~{N} heaves of the chest", "~an (inhalation|inspiration) and an exhalation {n}", "~a (gasp|gulp|mouthful|breather) of (fresh |)air", "~a (heave|swell|rise and fall) of the (chest|ribcage) {n}",
        "~(respiration|ventilation|belly breathing|deep breathing|pranayama) {n}", "~your (ribcage|diaphragm|torso) (expands and contracts|lifts and lowers) {n}", "~your shoulders lift with the breath in and sink with the breath out {n}", "~oxygen for your lungs {n}", "~a (weary|contented|wistful|relieved|exasperated) sigh",
    )), "", (), (1, 2)),
    "slump": Family(_slump, Words((
        "slump (down|forward|sadly|)", "slouch", "let your (head and shoulders|shoulders|head and upper body) (hang|drop|sink)", "look (sad|tired|exhausted|disappointed|defeated)",
        "act (sad|tired|exhausted|disappointed|defeated)", "sink into yourself", "be (sad|tired|exhausted)", "show that you are (sad|tired|disappointed)", "collapse forward a little", "droop",
        "~a (sad|tired|weary|slumped|dejected) posture", "~a (slump|slouch)", "~(drooping|hanging|slumped|sagging) shoulders", "~head and shoulders (drooping|hanging)",
        "~your (shoulders and head|head and shoulders) (sink|drop|droop|hang down)", "~your (whole |)upper body (sags|slumps|droops|goes limp)", "~all the (air|energy|strength) goes out of you",
        "~a picture of (misery|sadness|dejection)", "~back rounded, (head hanging|shoulders hanging)", "~you are (exhausted|dead tired|worn out|crestfallen)", "~a (defeated|dejected|hangdog) stance",
        "sag (into yourself|)", "hunch over", "hang your head and shoulders", "go limp (in the upper body|)", "wilt like a flower", "deflate like a balloon", "mope", "cave in at the chest",
        "lose (heart|all hope)", "appear (miserable|crestfallen|downcast|worn out|weary)", "act (miserable|depressed|worn out|weary|hopeless)",
        "look (gloomy|miserable|worn out|downcast|heartbroken|like a loser)", "stand like (a sad clown|a loser|a sack of potatoes|a puppet with cut strings)", "let yourself sag",
        "round your (back|spine) and ^let your head hang", "feel sorry for yourself", "have the blues",
        "sulk", "despair", "grieve", "mourn", "lament with hanging shoulders",
        "brood", "moon about with hanging shoulders", "flag with fatigue", "crumple (at the chest|into yourself)", "fold in on yourself", "shrivel (up|)",
        "shrink into yourself", "subside into yourself", "flop (forward|down) like a rag doll", "let your spine collapse", "let your chest cave in",
        "give up (all hope|) with drooping shoulders", "resign yourself to defeat", "admit defeat with your posture", "be (crestfallen|glum|downhearted|dejected|dispirited|despondent|sorrowful|forlorn|knackered|bushed|pooped|shattered|drained|burnt out|heartbroken|lonely|melancholy|blue)", "look (glum|dejected|despondent|sorrowful|forlorn|woebegone|mournful|knackered|drained|weary|beaten|let down)", "act (glum|dejected|despondent|heartbroken|forlorn|drained|beaten|discouraged)",
        "express (grief|sorrow|despair|dejection|fatigue|exhaustion|disappointment|hopelessness|sadness) with your posture", "show (fatigue|grief|sorrow|despair|exhaustion|sadness)", "drop your posture", "stoop like an old man", "sag like (a wet sack|a dying tulip|an empty sack|melting wax)", "melt like (a snowman|a candle)",
        "run out of (battery|energy|steam)", "switch yourself off and ^sag", "~a (sagging|drooping|wilted|crumpled|stooped|hunched|glum|forlorn|despondent|mournful|listless) (posture|stance|figure)", "~a (droop|sag|slackening) of the (shoulders|shoulders and head)", "~a (hunch|hunchback|rounded back) with a hanging head",
        "~(thoracic kyphosis|rounded spine), head hanging", "~a (wilted flower|rag doll|deflated balloon|burst balloon|puppet without strings)", "~the (blues|doldrums|misery) in your shoulders", "~the posture of (a loser|grief|exhaustion|despair)", "~your (spine|chest) (collapses|caves in|crumples)", "~your battery is (empty|flat|dead)",
        "~the weight of the world on your shoulders",
    )), "trunk", (), holds=True),
    "stand": Family(_stand, Words((
        "stand (still|there|quietly|at ease|motionless|)", "do nothing", "stay (still|where you are|put|calm)", "wait (quietly|for me|)", "rest", "hold still", "do not move", "be idle",
        "keep (still|quiet|your arms down)", "relax and ^stand", "remain still", "freeze", "stand with your arms hanging",
        "~no (movement|motion) (at all|)", "~a (quiet|still|neutral|relaxed) stance", "~a (neutral|resting|motionless) pose", "~(standing still|just standing|standing there quietly)",
        "~arms at your sides, no movement", "~a (short |)(pause|break|rest)", "~a moment of (rest|calm|stillness)", "~stillness", "~your body (stays|remains|is) (still|motionless)",
        "~not a (muscle|finger) moves", "~statue (mode|pose)", "~idle (mode|position|pose)", "~nothing at all", "stay (motionless|as you are|in place)", "take a (break|rest|pause)",
        "pause (for a moment|)", "stand like a (statue|pillar|post)", "be (still|a statue|motionless)", "play the statue", "stand (upright|up straight) and ^do nothing", "keep your position",
        "(halt|cease|stop) all movement", "stop moving", "do not (budge|move a muscle|lift a finger)", "go (idle|into standby)", "stay in (idle|rest|neutral) mode", "stand by", "turn to stone",
        "rest on your feet", "assume the neutral position", "hold your horses",
        "(abide|tarry|repose|laze) on the spot without a movement", "desist from all movement", "refrain from (moving|any movement|gestures)", "(suspend|end|quit|discontinue|finish|avoid) all (movement|motion|activity)", "(petrify|solidify|fossilise)", "be (inert|immobile|stationary|static|passive|inactive|silent and still|a mannequin|a rock|as still as a mouse|a lamp post)",
        "remain (immobile|stationary|static|inert|inactive|frozen|in your place)", "stay (immobile|stationary|static|frozen|rooted to the spot|upright|calm and still)", "stand (stock-still|stock still|immobile|erect|frozen|rooted to the spot|like a mannequin|like a lamp post|like a tree without wind|like a rock)", "chill", "take it easy",
        "unwind and ^stand", "imitate a (mannequin|statue|rock|shop dummy|wax figure|monument)", "play (freeze|musical statues)", "do a mannequin challenge", "keep your (arms|hands|limbs) (idle|at rest|inactive)",
        "let your arms dangle", "leave your arms where they are", "hang loose", "wait for (instructions|further orders|the next command|my signal)", "hibernate", "enter (sleep|standby|rest) mode",
        "reset to the (default|neutral|home) (pose|position)", "return to (rest|neutral|the home position|the default pose)", "adopt a (neutral|natural|relaxed) stance",
        "bide your time", "~(immobility|inactivity|inertia|motionlessness|repose|tranquillity|standstill|peace and quiet)", "~a (standstill|freeze|freeze frame|respite|timeout|breathing space)", "~a (static|frozen|stationary|idle|default|upright) (posture|pose|stance)", "~(feet planted|standing), arms (dangling|hanging|loose)", "~zero (motion|movement|action|activity)",
        "~nothing (happens|moves)", "~frozen (to the spot|like ice|)", "~arms idle", "~your joints (stay|are) locked", "~the (default|home|rest|neutral) (pose|position)",
    )), "", ()),
    "shift": Family(_shift, Words((
        "shift your weight( from foot to foot| from side to side|)", "(stand|wait) (impatiently|casually|restlessly|around)", "shift from one foot to the other", "fidget( a little|)",
        "move a little while standing", "act bored", "be restless", "stand around", "idle( around|)", "wait for the bus", "look bored", "loiter",
        "change your standing leg", "hang around", "kill time",
        "~a shift of weight (from foot to foot|from leg to leg|)", "~your weight (goes|moves|shifts) from (one foot|one leg) to the other", "~weight on one leg, then on the other",
        "~(restless|fidgety|impatient) (standing|waiting)", "~a (restless|bored|fidgety) wait (at the bus stop|)", "~small restless movements", "~a bit of fidgeting",
        "~you are (bored|restless|fidgety|waiting for the bus)", "~an idle animation", "~ants in your pants", "~a bored (teenager|customer) in a queue", "shuffle from foot to foot",
        "act (restless|impatient|fidgety)", "wait (in a queue|in line|for your turn|for a taxi)", "pass the time", "dawdle", "look (restless|impatient)", "rock your weight from one leg to the other",
        "move your weight over from one leg to the other", "squirm a little", "stand about", "linger", "stand there like a bored teenager", "get (restless|fidgety|impatient)",
        "have ants in your pants", "be (bored|fidgety|impatient)", "cool your heels", "play an idle animation",
        "transfer your weight from one leg to the other", "redistribute your weight (a little|from leg to leg)", "change from your standing leg to your free leg and back", "favour one leg and then the other", "alternate your weight between your (legs|feet)", "jiggle from leg to leg",
        "dither on the spot", "fiddle about on the spot", "lounge (around|about) on your feet", "laze (around|about) on your feet", "mooch about on the spot",
        "dally", "loaf (around|about)", "lollygag", "dilly-dally", "while away the time",
        "mill about on the spot", "lurk around", "fret a little while you wait", "stew in impatience on the spot", "queue (up|for the toilet|at the till|for tickets)", "wait (for the lift|for the train|at the tram stop|at the traffic light|for a late friend|on the platform|in the lobby|at the counter)",
        "act (antsy|fed up|twitchy|uneasy|jittery|nervous|unoccupied|uncomfortable|awkward)", "be (antsy|impatient for the bus|twitchy|jittery|ill at ease|unoccupied)", "look (antsy|uneasy|awkward|fed up|unoccupied)", "stand (awkwardly|uneasily|nervously|idly|like someone with sore feet)", "relieve your tired legs in turn", "ease your sore feet in turn",
        "settle your weight on one hip and then on the other", "take the load off one leg and then off the other", "adjust your stance (a little|now and then)", "readjust your footing a little", "make (small|tiny|natural) idle movements", "act like a background character",
        "act like an (extra|NPC|onlooker|avatar that waits for its player)", "~a weight (transfer|shift|change) (from foot to foot|from leg to leg|)", "~a (transfer|redistribution|change) of weight between the legs", "~a change of the standing leg", "~an (idle loop|idle cycle|idle motion|waiting animation)", "~a (jittery|nervous|antsy|fretful|listless) wait",
        "~(boredom|impatience|restlessness|loitering|dawdling|fidgets)", "~the fidgets", "~(small|subtle|slight) postural adjustments", "~your hips drift from one leg to the other", "~your (pelvis|centre of gravity) (drifts|moves) from one foot to the other", "~an impatient (passenger|commuter|pupil) on the platform",
        "~one leg bears your weight, then the other",
    )), "", ()),
}  # fmt: skip
