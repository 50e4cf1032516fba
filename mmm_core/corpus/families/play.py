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
        ("play the drums", "drum( on a table| with sticks|) {n}", "beat (a|the) drum {n}", "drum with both hands {n}", "hit the (drum|drums) {n}", "pretend to play the drums {n}", "give {N} drum beats", "play a drum (roll|solo)", "act like a drummer", "bang (on |)the drums {n}", "play the (bongos|congas) {n}", "play percussion",
         "~a drum (roll|solo)", "~{N} (drum beats|drum strokes|beats on the drum|hits on the drum)", "~(drumming|drums|air drums|bongos|drum playing) {n}", "~both hands drumming {n}",
         "~your hands (beat|drum on|play) the drums in turn {n}", "~drumsticks up and down in turn {n}", "~hands up and down in turn on (a|the) drum {n}", "~some (drumming|percussion|air drumming)",
         "~a (rock drummer|little drummer boy|drummer on stage)", "play (air drums|the snare drum|the drum kit|the bodhran|the tabla|the djembe|the kettledrums) {n}", "thump the (drums|bongos) {n}",
         "hit the snare {n}", "give me a drum roll", "do a drum (roll|fill|solo)", "pound on the drums {n}", "bash (the|away at the) drums {n}", "tap out a rhythm on the drum {n}",
         "be the drummer (of|in) the band", "beat the (tom-toms|skins) {n}", "sound the drums {n}", "drum like (Ringo Starr|Phil Collins|a rock drummer) {n}",
         "rap out a beat with the drumsticks {n}", "(patter|rattle|thrum) on the drumhead {n}", "play a (paradiddle|backbeat|rimshot) {n}", "lay down a backbeat on the drums {n}",
         "(clobber|wallop|batter) the (drums|cymbals|drumheads) {n}", "play the (timpani|cymbals|hi-hat|cajon|taiko drums|steel drums) {n}", "go rat-a-tat-tat on the drum {n}",
         "~{N} (paradiddles|rimshots|drum taps|thumps on the drum|wallops on the drum)", "~a (paradiddle|rimshot|drumbeat|tattoo on the drum)", "~a (thumping|pounding|rumble|thunder) of drums {n}",
         "~wrists flicking the sticks down onto the drumhead in turn {n}", "~a (percussionist|timpanist|bongo player) (at work|in full swing)",
         "~palms slapping the (bongos|cajon) one after the other {n}", "~boom boom boom on the (drum|tom-tom) {n}")), sides=BOTH, counts=(2, 3, 4)),
    "piano": Family(taps(_PIANO_UP, _PIANO_DOWN, 0.56, 0.22), Words(
        ("play (the piano|piano|a piano|the organ|the keyboard) {n}", "pretend to play the piano {n}", "act like a pianist", "perform a piano (concert|sonata)", "hit the piano keys {n}", "give a piano recital", "play a (sonata|melody) on the piano", "practise the piano", "play (Mozart|Chopin) on the piano", "tickle the ivories",
         "~(piano playing|piano|air piano|some piano music) {n}", "~a (piano solo|piano recital|piano concert|pianist)", "~a (tune|melody|piece) on the piano", "~hands on the piano, playing {n}",
         "~both hands (playing|on) the piano keys {n}", "~your (hands|fingers) play the (piano|keyboard of a piano) {n}", "~hands on the black and white keys {n}",
         "~some (Mozart|Chopin|Beethoven) on the piano", "~a pianist at the (grand piano|keys)", "~{N} piano (chords|notes)",
         "play (a tune|a scale|scales|chords|a lullaby|boogie-woogie) on the piano {n}", "play (air piano|the harpsichord|the grand piano|the synthesizer|a ragtime on the piano) {n}",
         "accompany the singer on the piano", "thump the piano {n}", "run your fingers over the piano keys {n}", "sit at the (invisible |)piano and ^play {n}", "do some piano practice",
         "be a (pianist|piano player)", "strike (a chord|some chords) on the piano {n}", "give a piano concert", "do an impression of (Elton John at the piano|a concert pianist)",
         "pound the ivories {n}", "tinkle (away |)at the piano {n}", "plink a (ditty|nursery rhyme) on the piano {n}", "hammer out a (polka|hymn|honky-tonk) on the (piano|upright piano) {n}",
         "play (an etude|an arpeggio|a nocturne|a minuet) on the piano {n}", "(vamp|improvise|noodle) on the piano {n}", "play the (celesta|spinet|clavichord|harmonium|pianola) {n}",
         "glide your fingers along the piano keyboard {n}", "~{N} (arpeggios|keystrokes on the piano|piano octaves)", "~an (arpeggio|etude|impromptu) on the piano",
         "~(forearms|wrists) level, fingers (dancing|hopping|wandering) along the piano keys {n}", "~(an organist|a keyboardist|a virtuoso) at the (piano|organ)",
         "~some (stride|honky-tonk|jazz|salon) piano", "~fingertips (pressing|pushing) the (piano|organ) keys down by turns {n}")), sides=BOTH, counts=(3, 4)),
    "guitar": Family(_lead_strokes(_STRUM_UP, _STRUM_DOWN, _FRETS, 0.6), Words(
        ("play (the guitar|guitar|air guitar|a guitar|the ukulele|the banjo|the bass) {n}", "strum (a guitar|the guitar|the strings) {n}", "pretend to play the guitar {n}", "act like a (guitarist|rock star)", "rock on your guitar", "play a guitar solo", "do an air guitar solo", "give {N} strums", "perform a song on the guitar", "strum a chord {n}",
         "~(air guitar|guitar playing|guitar|strumming) {n}", "~a guitar (solo|riff)", "~an air guitar solo", "~a (guitarist|rock guitarist|guitar hero)",
         "~{N} (strums|guitar chords|guitar strums|strokes over the strings of a guitar)", "~a strum (on|of) the guitar", "~fingers on the frets, the other hand (strums|strumming) {n}",
         "~guitar neck in one hand, the other strums the strings {n}", "~hands playing the (guitar|banjo|ukulele) {n}", "~a (song|tune|ballad) on the guitar", "~some (guitar music|air guitar)",
         "play (the electric guitar|the bass guitar|the mandolin|the lute|a guitar riff|chords on the guitar) {n}", "pluck the guitar strings {n}", "pick (a|the) (guitar|banjo) {n}",
         "shred( on|) the guitar {n}", "jam on the guitar {n}", "rock out on air guitar {n}", "be a (guitar hero|guitarist|busker with a guitar)", "twang the guitar strings {n}",
         "serenade me with a guitar", "play like Jimi Hendrix", "thrash an air guitar {n}",
         "noodle on the (guitar|six-string) {n}", "fingerpick (a|the) guitar {n}", "(sweep|rake|brush) your fingers down across the guitar strings {n}",
         "play the (balalaika|sitar|bouzouki|flamenco guitar|Stratocaster|cittern) {n}", "blast out power chords {n}", "chug along on the bass guitar {n}",
         "entertain the campfire with your guitar {n}", "sling on a guitar and ^strum {n}", "wail on the electric guitar {n}",
         "~{N} (downstrokes on the guitar|power chords|twangs of the guitar|plucks of the guitar strings)", "~a (power chord|flamenco strum|guitar lick)",
         "~one hand up on the fretboard, the other brushing the strings at the belly {n}", "~a (troubadour|minstrel|rocker|folk singer) with a guitar",
         "~the plectrum (flicks|scrapes|skips) over the strings {n}")), sides=BOTH, counts=(3, 4)),
    "violin": Family(_lead_strokes(_BOW_IN, _BOW_OUT, _VIOLIN, 1.1, (0.25, 0.1, 0.2)), Words(
        ("play (the violin|violin|a violin|the fiddle|the viola) {n}", "draw the bow over the violin {n}", "pretend to play the violin {n}", "act like a (violinist|fiddler)", "fiddle( a tune|) {n}", "bow the violin {n}", "play a sad song on the violin", "perform on the violin", "practise the (violin|fiddle)", "make {N} bow strokes on the violin",
         "~(violin|fiddle|violin playing|air violin|fiddle playing) {n}", "~a (violinist|fiddler|fiddler on the roof)", "~a violin (solo|concerto)",
         "~{N} (violin strokes|bow strokes on the violin|strokes of the violin bow)", "~a stroke of the bow (on|over) the violin", "~violin in one hand, the other (moves|draws) the bow {n}",
         "~chin on the violin, bow to and fro {n}", "~violin at the chin, bow going back and forth {n}", "~the (bow goes|bow moves) to and fro over the violin {n}",
         "~a (sad tune|melody|jig) on the (violin|fiddle)", "~some (violin music|fiddle music)", "play (air violin|the tiniest violin|a violin solo|a jig on the fiddle|a Stradivarius) {n}",
         "put a violin under your chin and ^play {n}", "scrape (away at|on) (a|the) (violin|fiddle) {n}", "saw away at the fiddle {n}", "move the bow across the violin strings {n}",
         "play (first|second) violin in the orchestra", "be a (violinist|fiddler)", "serenade me with a violin", "stroke the violin strings with the bow {n}",
         "(coax|squeeze|wring) a tune out of the violin {n}", "rub the bow up and down the catgut {n}", "glide the bow back and forth across the violin {n}",
         "play a (czardas|reel|hoedown|partita|romance) on the (violin|fiddle) {n}", "tuck a fiddle under your jaw and ^play {n}", "screech on the violin {n}", "be Paganini (at|on) the violin",
         "entertain the (guests|diners) with your violin {n}", "~{N} (long bow sweeps|bow pulls|sawing strokes) on the violin", "~a (reel|hoedown|czardas|serenade) on the (fiddle|violin)",
         "~the (elbow|forearm) (sawing|gliding) to and fro with the violin bow {n}", "~fiddle clamped between jaw and shoulder, the bow (sweeping|sliding) {n}",
         "~a (concertmaster|virtuoso|street musician) (with a|on the) violin", "~horsehair gliding over the violin strings {n}")), sides=BOTH, counts=(2, 3)),
    "flute": Family(_lead_strokes(reach((-0.02, 0.13, 0.3), (0.8, -0.5, 0.0)), reach((0.0, 0.11, 0.31), (0.8, -0.5, 0.0)), reach((-0.02, 0.13, 0.25), (0.7, -0.6, 0.3)), 0.7), Words(
        ("play (the flute|a flute|the trumpet|the recorder|the clarinet|the oboe|a horn) {n}", "blow (a trumpet|the trumpet|a horn|the flute)", "pretend to play the (flute|trumpet)", "act like a (flautist|trumpeter)", "sound the (trumpet|horn)", "perform on the (trumpet|flute)",
         "~(flute|trumpet|flute playing|trumpet playing|recorder) {n}", "~a (flautist|flutist|trumpeter|bugler)", "~a (trumpet|flute) (solo|tune)", "~a (fanfare|tune) on the trumpet",
         "~both hands on the (flute|trumpet|clarinet), (blowing|playing) {n}", "~hands holding the (trumpet|flute|clarinet) to the mouth {n}", "~trumpet to the lips {n}",
         "~fingers dancing on the flute {n}", "~some (trumpet|flute|clarinet) music", "~your hands hold a (flute|trumpet) and play {n}", "~toot toot on the trumpet {n}",
         "play (the bugle|the saxophone|the bagpipe chanter|the tin whistle|the penny whistle|the cornet|the oboe|a fanfare) {n}", "toot (a|your) (horn|trumpet) {n}",
         "blow (the bugle|the clarinet|into a trumpet|your own trumpet) {n}", "pipe like the Pied Piper {n}", "be a (trumpeter|flautist|trumpet player|piper)",
         "play (a tune|a melody|jazz) on the (flute|clarinet|trumpet) {n}", "sound (a fanfare|the bugle|reveille)", "play like Louis Armstrong",
         "hold (a trumpet|a flute) to your lips and ^play {n}", "charm the snakes with your flute",
         "(parp|honk|blare|wail) on (a|the) trumpet {n}", "(tootle|trill|warble) on the (flute|recorder) {n}", "whistle a tune on the (piccolo|fife) {n}",
         "play the (piccolo|fife|ocarina|bassoon|flugelhorn|woodwind) {n}", "press the valves of a trumpet {n}", "finger the (holes|stops) of a (flute|clarinet|recorder) {n}",
         "announce the king with a trumpet {n}", "wake the (camp|barracks) with the bugle {n}", "puff into a (clarinet|recorder|flute) {n}", "~{N} (toots|blasts|blares) on the (trumpet|horn)",
         "~a (blast|blare|flourish) on the (trumpet|bugle)", "~wind instrument at the mouth, fingers fluttering on the (holes|valves) {n}",
         "~a (woodwind|brass) player with the instrument at the lips", "~a (shepherd|faun|satyr) piping on a flute")), sides=BOTH, counts=(2, 3)),
    "conduct": Family(_conduct, Words(
        ("conduct (an orchestra|the orchestra|the music|a choir|the band) {n}", "beat time {n}", "swing a baton {n}", "act like a conductor {n}", "direct the (choir|orchestra) {n}", "lead the orchestra {n}", "mark the beat {n}", "keep time for the musicians {n}", "give the beat {n}", "conduct {n}",
         "~(conducting|conducting an orchestra|time beating) {n}", "~{N} (beats of the baton|conducting strokes|strokes of the baton)", "~a conductor (at work|before the orchestra)",
         "~a (bar|few bars) of conducting", "~{N} bars of conducting", "~some conducting", "~an orchestra conductor's beat", "wave (a|the|your) (baton|conductor's baton) {n}",
         "lead (the band|the choir|the singers|the musicians) {n}", "direct (a symphony|the band|the musicians) {n}", "conduct (a symphony|Beethoven's fifth|a brass band|the singers|a waltz) {n}",
         "be the (conductor|maestro)", "set the tempo for the orchestra {n}", "give the (musicians|orchestra|choir) the beat {n}", "bring the orchestra in {n}", "beat time for the (choir|orchestra|band) {n}",
         "guide the (philharmonic|ensemble|quartet|musicians) {n}", "conduct the (sopranos|philharmonic|chorus|string section|brass section) {n}",
         "conduct like (Karajan|Toscanini|Bernstein|a bandleader) {n}", "beat (three-four|four-four|waltz) time {n}", "dictate the (pulse|metre) to the orchestra {n}", "swish a baton {n}",
         "~{N} (downbeats|upbeats|swishes of the baton)", "~a (maestro|bandleader|choirmaster|choir director) (beating time|giving the downbeat)",
         "~the (swishing|ticking|bouncing) of a conductor's baton {n}"),
        one=("~your {S} (hand|arm) (conducts|beats time|leads the orchestra) {n}", "~{S} hand conducting {n}", "~baton in the {S} hand, (conduct|beat time) {n}",
         "~the {S} hand goes down and up with the baton {n}", "~{S}-handed conducting {n}", "beat time with your {S} hand {n}", "conduct the orchestra with your {S} arm {n}",
         "swing the baton in your {S} hand {n}",
         "swish a baton with your {S} hand {n}", "shape the music with your {S} hand like a maestro {n}", "~baton in the {S} hand, (swishing|bouncing|ticking) in time {n}",
         "~your {S} forearm (bounces|dips) to the beat before the orchestra {n}"),
        both=("~both hands conducting {n}", "~both arms (conduct|beat time|lead the orchestra) {n}", "~a conductor using both arms", "beat time with both (hands|arms) {n}",
         "mould the sound of the choir with both hands {n}", "~both hands (shaping|sculpting) the music of the (ensemble|philharmonic) {n}")), sides=ANY, counts=(3, 4)),
    "arm_circle": Family(_arm_circle, Words(), sides=ANY, counts=(1, 2), directions=("forward", "back"), directed={
        "forward": Words(one=("circle your {S} arm( forward|) {n}", "(swing|rotate|spin) your {S} arm in circles {n}", "make (circles|forward circles) with your {S} arm {n}", "rotate your {S} arm forward {n}", "draw {N} circles with your {S} arm", "windmill your {S} arm {n}", "turn your {S} arm round {n}",
         "~{S} arm circles {n}", "~{N} {S} arm circles", "~{N} (forward |)circles with your {S} arm", "~your {S} arm (circles|goes round|rotates|turns in circles|swings in a circle) {n}",
         "~the {S} arm (goes|swings) round and round {n}", "~a (big |full |)circle with your {S} arm", "~a forward (circle|rotation|turn) of the {S} arm", "~a windmill with your {S} arm",
         "~{S} arm (forward in circles|round and round|windmill) {n}", "whirl your {S} arm (around|round|in circles) {n}", "wheel your {S} arm( forward|) {n}",
         "perform shoulder circles with a straight {S} arm {n}", "swing your {S} arm (full circle|over and round|right round) {n}",
         "rotate the {S} shoulder joint through full circles with a long arm {n}", "turn your {S} arm like a (windmill sail|Ferris wheel) {n}", "spin your straight {S} arm (forward|around) {n}",
         "(swirl|twirl|loop|revolve) your {S} arm( forward|) {n}", "spin your {S} arm like a (rotor|turbine|waterwheel) {n}", "describe wide circles with your straight {S} arm {n}",
         "circumduct (the|your) {S} (arm|shoulder) {n}", "loosen your {S} shoulder with big arm circles {n}", "~a (revolution|loop|whirl) of the {S} arm",
         "~{N} (revolutions|loops|whirls|windmills) of the {S} arm", "~the {S} arm (revolves|orbits) around the shoulder {n}", "~{S} (shoulder|arm) circumduction {n}",
         "~your {S} fingertips trace a large wheel beside you {n}"),
                         any=("make circles with one arm {n}",
         "~{N} circles with one arm", "~a (big |)circle with one arm", "swing one arm (round|around|in circles) {n}", "windmill one arm {n}",
         "twirl one arm like a rotor {n}", "~a revolution of one arm {n}"), both=("circle your arms( forward|) {n}", "make arm circles {n}", "do {N} (forward |)arm circles", "rotate both arms( forward|) {n}", "swing both arms in circles {n}", "windmill both arms {n}", "warm up your shoulders with arm circles {n}",
         "~{N} (forward |big |)arm circles", "~arm circles {n}", "~both arms (circle|circling|going round|rotating|in circles) {n}",
         "~your arms (circle|go round|go round like windmills|rotate|turn in big circles) {n}", "~(arms like windmills|windmill arms) {n}", "~a (big |forward |full |)circle with both arms",
         "~{N} circles with both arms", "~forward rotations of both arms {n}", "whirl (your|both) arms (around|in circles) {n}", "wheel both arms forward {n}",
         "swing both arms (full circle|over and round|right round) {n}", "perform forward arm circles {n}", "turn your arms like (windmill sails|a windmill|big wheels) {n}", "be a windmill {n}",
         "spin both arms like wheels {n}", "draw big circles with both arms at your sides {n}",
         "(twirl|revolve|loop|swirl) both arms( forward|) {n}", "circumduct both (arms|shoulders) {n}", "swing both arms like a (waterwheel|mill wheel|turbine) {n}",
         "loosen your shoulders with big arm circles {n}", "churn the air with both straight arms in big circles {n}", "describe wide circles with both straight arms {n}",
         "~{N} (revolutions|loops|whirls) of both arms", "~bilateral shoulder circumduction {n}", "~both arms (revolving|whirling|orbiting) about the shoulders {n}",
         "~hands tracing giant wheels at your sides {n}")),
        "back": Words(one=("circle your {S} arm backward {n}", "(rotate|spin|swing|turn) your {S} arm backward {n}", "make backward circles with your {S} arm {n}", "windmill your {S} arm backward {n}", "draw {N} backward circles with your {S} arm",
         "~{S} arm circles backward {n}", "~{N} backward (circles|rotations) with your {S} arm", "~your {S} arm (circles|goes round|rotates|turns) backward {n}",
         "~the {S} arm (goes|swings) round backward {n}", "~a backward circle with your {S} arm", "~a backward (rotation|turn|swing) of the {S} arm in a full circle",
         "~{S} arm backward in circles {n}", "~a backward windmill with your {S} arm", "whirl your {S} arm backward {n}", "wheel your {S} arm backward {n}",
         "swing your {S} arm up and round to the back in a circle {n}", "perform backward circles with a straight {S} arm {n}", "rotate the {S} arm in reverse {n}",
         "circle your {S} arm (the other way, backward|in reverse) {n}",
         "(twirl|loop|revolve|swirl) your {S} arm backward {n}", "circumduct your {S} (arm|shoulder) backward {n}", "wind your {S} arm backward in wide circles {n}",
         "describe backward circles with the {S} arm {n}", "rotate your {S} arm rearward {n}", "lead your {S} arm up in front, over your head and down behind you in a circle {n}",
         "~a backward (revolution|loop|whirl) of the {S} arm", "~{N} backward (loops|revolutions|whirls) of the {S} arm", "~backward circumduction of the {S} shoulder {n}",
         "~your {S} arm (wheels|whirls|revolves) backward {n}", "~a rearward (circle|rotation) of the {S} arm"),
                      any=("make backward circles with one arm {n}",
         "~{N} backward circles with one arm", "~a backward circle with one arm", "circle one arm backward {n}", "windmill one arm backward {n}",
         "loop one arm backward {n}", "~one arm (revolving|whirling) backward {n}"), both=("circle your arms backward {n}", "do {N} backward arm circles", "(rotate|spin|swing) both arms backward {n}", "windmill both arms backward {n}", "make backward arm circles {n}",
         "~{N} backward arm circles", "~{N} (reverse arm circles|backward circles with both arms)", "~(backward|reverse) arm circles {n}",
         "~both arms (circle|circling|going round|rotating) backward {n}", "~your arms (circle|go round|rotate|turn) backward {n}", "~a backward circle with both arms",
         "~backward windmill arms {n}", "~arms round and round to the back {n}", "whirl both arms backward {n}", "wheel both arms backward together {n}",
         "circle both arms (in reverse|up and to the back) {n}", "perform backward arm circles {n}", "turn both arms like windmills going backward {n}",
         "roll both straight arms backward in big circles {n}",
         "(twirl|loop|revolve) both arms backward {n}", "circumduct both shoulders backward {n}", "describe backward circles with both arms {n}",
         "loosen your shoulders with backward arm circles {n}", "rotate both arms rearward {n}", "~{N} backward (loops|revolutions|whirls) of both arms",
         "~backward circumduction of both shoulders {n}", "~both arms (revolving|whirling|wheeling) backward {n}", "~both arms up in front, over the head and down behind in loops {n}",
         "~rearward arm (circles|rotations) {n}")),
    }),
    "flap": Family(_flap, Words(
        ("flap (your arms|your wings|both arms|your arms like a bird) {n}", "fly like (a bird|an eagle|a butterfly|a swan) {n}", "pretend to (fly like a bird|be a bird) {n}", "move your arms up and down at your sides {n}", "beat your (arms like wings|wings) {n}", "give {N} flaps with your arms", "be a (bird|butterfly|bat)", "act like a (bird|flying eagle) {n}",
         "~(arms|wings) flapping {n}", "~{N} (flaps of the arms|flaps of your wings|wing beats|arm flaps)", "~a (bird|butterfly|swan|bat) (in flight|flying|beating its wings)",
         "~your arms (flap|beat|go up and down) like wings {n}", "~both arms up and down at the sides like wings {n}", "~the wings (beat|flap) {n}", "~a (flap|beat) of the wings",
         "~flying like (a bird|an eagle|a butterfly) {n}", "~bird (wings|arms|flight) {n}", "~arms out, flap {n}", "~(wings|arms) up and down like a bird {n}", "flap away like a (seagull|pigeon|bat|swan) {n}",
         "flutter (your arms|your wings|like a butterfly) {n}", "soar like an eagle {n}", "spread your wings and ^(fly|flap) {n}", "fly (away|south) like a (bird|swallow|wild goose) {n}",
         "move your long arms like wings {n}", "wing your way through the air {n}", "turn into a bird and ^fly {n}", "imitate (a bird in flight|a butterfly|a flying swan) {n}",
         "take off like a (bird|swan) {n}", "be Dumbo and ^flap {n}",
         "hover like a (hummingbird|dragonfly|kestrel) {n}", "beat the air with outspread arms {n}", "try to take wing like a (fledgling|stork) {n}",
         "fan your long arms up and down at your sides {n}", "abduct and ^adduct both arms like wings {n}", "be a (dragonfly|heron|pelican|pterodactyl|dragon) and ^flap {n}",
         "play the (fairy|stork) and ^flap your wings {n}", "migrate like a wild goose with beating wings {n}", "~a (stork|heron|albatross|crow|goose) (flapping|taking wing)",
         "~{N} (wingbeats|wing strokes|flutters of the wings)", "~a (flutter|fluttering) of (wings|both arms)", "~both outspread arms rising and falling like (pinions|wings) {n}",
         "~your arms (rise and sink|lift and fall) at the sides like the wings of a heron {n}", "~flappy (wings|arms) {n}")), sides=BOTH, counts=(2, 3)),
    "chicken": Family(_chicken, Words(
        ("flap your elbows( like a chicken|) {n}", "do the chicken dance {n}", "act like a (chicken|hen|duck) {n}", "be a chicken", "move your elbows up and down {n}", "dance like a chicken {n}", "imitate a (chicken|hen) {n}", "pretend to be a (chicken|hen|duck) {n}", "raise and ^lower your elbows {n}", "flap like a chicken {n}",
         "~(the chicken dance|chicken wings|the funky chicken) {n}", "~a (chicken|hen|duck|rooster)", "~{N} (flaps of the elbows|elbow flaps|chicken flaps)",
         "~elbows (flapping|up and down) (like a chicken's|) {n}", "~your elbows (flap|go up and down|beat like a chicken's wings) {n}", "~both elbows up and down {n}",
         "~bent arms flapping like a (chicken|hen) {n}", "~hands at the chest, elbows flapping {n}", "~the birdie song {n}", "~chicken arms {n}",
         "do (the funky chicken|the birdie dance|chicken wings|a chicken impression) {n}", "flap your bent arms {n}", "imitate a (rooster|turkey|cockerel) {n}",
         "cluck like a (chicken|hen) and ^flap {n}", "show me a (chicken|hen) {n}", "strut like a rooster with flapping elbows {n}", "flap your (short|little|chicken) wings {n}",
         "make chicken wings with your elbows {n}", "dance the birdie song {n}", "waggle your elbows like a (hen|duck) {n}", "turn into a chicken",
         "play the (farmyard|barnyard) fowl and ^flap your elbows {n}", "pump your elbows up and down at your ribs {n}", "beat your elbows against your (ribs|flanks) {n}",
         "tuck your thumbs into your armpits and ^flap {n}", "work your elbows like (bellows|stubby wings) {n}", "(squawk|cackle|crow) like a hen and ^flap your elbows {n}",
         "taunt me with chicken wings {n}", "lay an egg like a hen with flapping elbows {n}", "~a (clucking hen|farmyard fowl|bantam|broody hen)",
         "~{N} (pumps of the bent elbows|beats of the elbows|stubby wing flaps)", "~hands tucked in the armpits, elbows (bobbing|pumping) {n}", "~stubby wings, flap flap {n}",
         "~the elbows (hinge|bounce|bob) out and in like the wings of a hen {n}", "~a (wedding|carnival|Oktoberfest) chicken dance {n}")), sides=BOTH, counts=(2, 3)),
    "robot": Family(_robot, Words(
        ("do the robot {n}", "dance like a robot {n}", "do (the|a) robot dance {n}", "move like (a machine|an android|a mechanical doll) {n}", "act like a (robot|machine) {n}", "imitate a robot {n}", "be a mechanical man {n}", "move your arms stiffly like a robot {n}", "perform the robot {n}", "dance the robot {n}", "(dance|move) mechanically {n}", "behave like an automaton {n}",
         "~(the robot|the robot dance|robot arms|robotic moves|robot moves) {n}", "~a robot dance", "~arms (moving|dancing) like a (robot|machine) {n}",
         "~your arms (jerk|move) (stiffly |)like a robot's {n}", "~(jerky|stiff|mechanical) robot arms {n}", "~stiff right-angled arms, one up and one down {n}",
         "~arms at right angles, (jerking up and down|changing places in jerks) {n}", "~a (mechanical|clockwork) doll", "~a dancing (robot|android|machine)",
         "~some (robot dancing|popping and locking)", "~beep beep, robot arms {n}", "(pop and ^lock|lock and ^pop) {n}",
         "dance (robotically|a robot dance|in jerks like a machine|stiffly like a robot) {n}", "move (robotically|stiffly like a robot|in mechanical jerks|like R2-D2|like C-3PO) {n}",
         "do (robot arms|robot moves|the mechanical man|your robot dance) {n}", "jerk your arms like a (robot|machine|clockwork toy) {n}",
         "act like (an android|a wind-up toy|the Tin Man|the Terminator) {n}", "play a robot {n}", "turn into a dancing robot {n}", "imitate a (machine|clockwork doll|wind-up toy) {n}",
         "perform a robotic dance {n}",
         "dance like a (cyborg|droid|showroom dummy|rusty machine) {n}", "move like a (droid|cyborg|rusty automaton|factory robot) {n}", "tick like a clockwork robot {n}",
         "judder your arms like a (droid|rusty machine) {n}", "twitch your arms from one right angle to the next {n}", "whirr and ^beep like a dancing robot {n}",
         "impersonate a (droid|cyborg|dancing robot) {n}", "dance the (mechanoid|eighties robot|street robot) {n}", "~a (droid|cyborg) (dancing|on the dance floor)",
         "~{N} (robotic jerks|robot ticks|stop-and-go robot moves)", "~a (staccato|stop-motion|juddering) robot dance", "~forearms (snapping|clicking|jolting) up and down at right angles {n}",
         "~one forearm hanging, the other upright, then swapped with a jolt {n}", "~the dance of the rusty Tin Man {n}")), sides=BOTH, counts=(3, 4)),
    "disco": Family(_disco, Words(
        ("dance disco( style|) {n}", "disco-dance {n}", "dance like (John Travolta|in the seventies) {n}", "do the disco( point|) {n}", "point up and down like a disco dancer {n}", "do Saturday night fever {n}", "dance the night fever {n}", "do the boogie {n}", "show me your disco moves {n}", "do {N} disco points",
         "~(disco dancing|disco|disco moves|the disco point|Saturday night fever) {n}", "~{N} (disco points|disco moves)", "~a disco (dance|move|point)", "~a (seventies|70s) disco dance",
         "~the (John Travolta|Travolta) (move|dance|pose) {n}", "~some (disco|disco dancing|disco moves)",
         "dance (disco in the style of the seventies|like a disco queen|like in Saturday Night Fever|under the disco ball) {n}", "do the (Travolta|John Travolta|night fever dance|disco finger) {n}",
         "strut your disco stuff {n}", "show me (the disco point|some disco) {n}", "hit the disco floor {n}", "dance to Stayin' Alive {n}", "perform a disco dance {n}",
         "do the disco hustle {n}", "groove like a disco diva {n}", "dance to the Bee Gees {n}", "~a (groovy|retro|flashy) disco move",
         "~{N} (disco fingers|diagonal disco points|glitterball points)"),
        one=("~{S} (hand|finger|arm) pointing up and then across down, disco style {n}", "~your {S} (hand|arm|finger) goes up to the ceiling and down across the body, disco style {n}",
         "~disco dancing with the {S} arm {n}", "~{S} arm disco point {n}", "~{N} disco points with your {S} hand", "~{S} (hand|finger) pointing up and down in turn, the other hand on the hip {n}",
         "~a disco move with your {S} (arm|hand)", "point your {S} finger up to the disco ball and down to the floor {n}", "disco-dance with your {S} arm up and down {n}",
         "keep one hand on the hip and ^point up and down with the {S} one {n}", "do the disco point with your {S} (finger|hand) {n}",
         "(jab|stab|poke) your {S} finger up at the mirror ball and down across to the opposite hip {n}", "slice your {S} finger diagonally from the ceiling to the opposite hip {n}",
         "strike the Travolta pose with your {S} arm and ^point high and low {n}", "work the dance floor with your {S} disco finger {n}",
         "~{S} index diagonally up to the glitterball, then down to the opposite (hip|knee) {n}", "~a diagonal disco point (of|with) the {S} (arm|index) {n}",
         "~your {S} arm (cuts|sweeps|slices) the diagonal between mirror ball and dance floor {n}", "~a glitterball point with your {S} hand", "~{N} {S} disco (fingers|jabs)")), sides=ONE, counts=(2, 3)),
    "sway_arms": Family(_sway_arms, Words(
        ("(sway|swing|wave) your arms (above|over) your head from side to side {n}", "(sway|wave) your arms (in the air |)to the (music|song) {n}", "sway your raised arms {n}", "wave your arms like at a concert {n}", "move your arms like (seaweed|grass in the wind) {n}", "dance with your arms in the air {n}", "swing your raised arms left and right {n}", "wave along to the slow song {n}", "sway with both arms up {n}",
         "~arms (swaying|waving) (overhead|above the head|in the air|from side to side overhead) {n}", "~{N} sways of the raised arms",
         "~your (raised |)arms sway (overhead |above your head |in the air |)from side to side {n}", "~(concert|festival) arms {n}",
         "~both arms (up|overhead), swaying (left and right|to the music|from side to side) {n}", "~hands in the air, (swaying|side to side) {n}",
         "~raised arms (left and right|from side to side) {n}", "~a sway with both arms (overhead|in the air)", "~arms like trees in the wind {n}", "~swaying arms overhead {n}",
         "sway like a tree in the wind with your arms up {n}", "wave your hands in the air like you just don't care {n}",
         "rock your raised arms (from side to side|left and right|to the ballad) {n}", "swing both hands above your head like at a (concert|festival) {n}", "put your hands up and ^sway {n}",
         "sway along to a ballad with both arms up {n}", "swing along with the crowd, arms overhead {n}", "move both raised arms (together |)to the left and the right {n}",
         "be a palm tree in the wind {n}", "let your raised arms (swing|sway|drift) from side to side {n}",
         "let your raised arms swing like (reeds|kelp|willow branches|palm fronds|pendulums) {n}", "rock both uplifted arms from left to right {n}",
         "wave imaginary (lighters|glow sticks|candles) above your head to the ballad {n}", "hold a lighter up in each hand and ^sway {n}",
         "hold your arms aloft and ^swing them from side to side {n}", "brush the sky with both hands from left to right {n}", "move both raised arms like (windscreen|windshield) wipers {n}",
         "sway your raised arms like a gospel (choir|singer) {n}", "join in the (anthem|chorus|hymn) with your arms swaying overhead {n}",
         "~{N} (overhead sways|rocks of the raised arms|pendulum swings of the raised arms)", "~an overhead (pendulum|metronome) with both arms {n}",
         "~both uplifted arms (tilting|drifting|rocking) left and right together {n}", "~arms aloft, (rocking|drifting|swinging) from side to side {n}",
         "~a (stadium|fan block|campfire) sway with both hands aloft {n}")), sides=BOTH, counts=(2, 3)),
    "arm_wave": Family(_arm_wave, Words(
        ("do (the|an) arm wave( dance|) {n}", "let a wave run through your arms {n}", "dance (the wave|the snake) with your arms {n}", "ripple your arms {n}", "do a body wave with your arms {n}", "move your arms like a snake {n}", "make a wave from one hand to the other {n}", "move your arms like waves {n}", "do the snake with your arms {n}", "send a ripple through both arms {n}",
         "~(the arm wave|an arm wave|the snake with your arms|a ripple through the arms) {n}", "~{N} (arm waves|waves through the arms|ripples through the arms)",
         "~a wave (running|rolling|travelling) (through|along) (your|the|both) arms", "~a (wave|ripple) from (hand to hand|one hand to the other|fingertip to fingertip)",
         "~arms (rippling|like a snake|like waves|like a rope with a wave in it) {n}", "~your arms ripple (like water|like a snake|from one end to the other) {n}",
         "~the wave goes from one hand through the shoulders to the other {n}", "~a (body wave|breakdance wave) with the arms", "~liquid arms {n}", "~snake arms {n}",
         "~both arms out, a wave running through them {n}", "do (the breakdance arm wave|a liquid dance with your arms|snake arms|the electric wave) {n}",
         "pass a wave (from hand to hand|along your arms) {n}", "run a (wave|ripple) (through|along) your arms {n}", "undulate your arms {n}", "roll a wave from one fingertip to the other {n}",
         "break-dance with a wave through your arms {n}", "make your outstretched arms (ripple|undulate) {n}", "let your arms (ripple|undulate|flow like water) {n}", "perform an arm wave {n}",
         "snake your arms {n}",
         "let a (pulse|current|swell) (travel|roll|pass) along both arms {n}", "ripple both outspread arms like (an eel|a ribbon|silk) {n}",
         "articulate wrist, elbow and shoulder in a chain from one hand to the other {n}", "isolate wrist, elbow and shoulder in a wave across both arms {n}",
         "relay a ripple from your fingertips across the shoulders to the other hand {n}", "slither your arms like (a serpent|an eel|a cobra) {n}", "worm a wave from one arm into the other {n}",
         "~a (pulse|swell|surge|undulation) (travelling|passing) from one arm to the other", "~{N} (undulations of the arms|pulses through the arms|swells through both arms)",
         "~wrist, elbow, shoulder, shoulder, elbow, wrist: a wave {n}", "~arms (billowing|undulating|slithering) like (silk|a ribbon|an eel) {n}", "~boneless arms, a wave rolling across them {n}",
         "~the (popping|street dance|hip-hop) arm wave {n}", "~a (serpentine|sinuous|wavelike) (movement|motion) of both outstretched arms {n}")), sides=BOTH, counts=(1, 2)),
    "dance_pump": Family(strokes(ArmPose((0.4, -0.75, 0.4), (-0.1, 0.6, 0.75)), ArmPose((0.35, -0.3, 0.85), (0.0, 0.85, 0.5)), 0.6), Words(
        ("dance( with your arms| to the music| happily|) {n}", "dance with both arms {n}", "pump your arms to the beat {n}", "move (your arms |)to the beat {n}", "groove {n}", "do a little dance {n}", "show me a dance {n}", "bop to the music {n}", "move your arms in rhythm {n}", "party with your arms {n}",
         "~a (little|happy|short|) dance", "~some (dancing|grooving|dance moves)", "~dancing (arms|with the arms) {n}", "~arms (pumping|dancing|moving) to the (beat|music|rhythm) {n}",
         "~your arms (dance|pump|move|bop) to the (beat|music|rhythm) {n}", "~(dance|party) time {n}", "~a party dance with the arms", "~dance moves with the arms {n}",
         "dance to the music with bent arms {n}", "dance (at a party|to a pop song|in rhythm|for joy|to the beat|like nobody is watching) {n}", "jive {n}",
         "do (a dance|a happy dance|some dancing|your dance|a jig with your arms) {n}", "bust a move {n}", "let your arms dance {n}", "jig your arms to the (beat|music) {n}",
         "rave( to the beat|) {n}", "get (down to the music|your groove on) {n}", "feel the beat and ^dance {n}",
         "(bounce|vibe|bob) to the (bassline|techno|tune) {n}", "throw some shapes {n}", "cut a rug {n}", "hit the nightclub and ^dance {n}", "let loose on the dance floor {n}",
         "enjoy the (tune|song) and ^dance {n}", "pump your (forearms|bent elbows) up and down to the bassline {n}", "do some (zumba|aerobics) arms to the music {n}",
         "~forearms (bouncing|bobbing|jigging) to the (beat|bassline) {n}", "~{N} (dance pumps|bounces of the forearms to the beat)", "~a (bop|little shindig|nightclub dance|knees-up)",
         "~your bent arms (bounce|bob|jiggle) to the (tune|bassline|techno) {n}"),
        alternating=("dance with one arm after the other {n}", "pump your arms in turns {n}",
         "~arms pumping to the beat in turn {n}", "~arms (dancing|pumping) to the music, left and right in turn {n}", "~left arm, right arm, (dancing|dance|to the beat) {n}",
         "dance with your arms left and right in turn {n}",
         "jiggle your forearms in turn to the (tune|bassline) {n}", "~alternate pumps of the forearms to the music {n}"),
        both=("~both arms (pumping|dancing) to the beat {n}", "~both fists up and down to the music {n}", "bop up and down with both arms to the beat {n}",
         "bounce both forearms to the (tune|bassline) {n}", "~both bent arms bobbing to the tune {n}")), sides=("both", "alternating"), counts=(3, 4)),
    "dab": Family(_dab, Words(
        ("dab", "do (a|the) dab", "make a dab pose", "dab like a footballer", "hit a dab", "show me a dab", "celebrate with a dab", "do the dab dance", "throw a dab", "hide your face in your elbow and ^dab",
         "~a (cool |quick |)dab", "~the dab", "~a dab pose", "~dab (dance|move|pose)", "~a footballer's dab", "do a (quick dab|footballer's dab|dab move)", "strike a dab( pose|)",
         "bust (out |)a dab", "drop a dab", "perform a dab", "pull off a dab", "dab (like Paul Pogba|like a rapper|on them|to celebrate)",
         "whip out a dab", "nail a (crisp|stylish|textbook) dab", "flaunt a dab", "do the (hip-hop|touchdown|victory) dab", "~a (hip-hop|swaggering|touchdown|crisp|stylish) dab"),
        one=("dab to the {S}", "dab with your {S} arm long", "do a dab to your {S}",
         "~a dab to the {S}", "~{S} dab", "~dab to the {S}", "~your {S} arm (stretches|goes) out and up, the face (goes|dips) into the other elbow",
         "~{S} arm out and up, face in the (other|bent) elbow", "~face in the elbow, {S} arm long", "~a dab with the {S} arm (long|straight|stretched out)",
         "(throw|hit|strike|bust) a dab to the {S}", "stretch your {S} arm out and up and ^hide your face in the other elbow",
         "point your {S} arm up to the side and ^bury your face in the other elbow",
         "tuck your (nose|forehead) into the crook of one elbow and ^point the {S} arm skyward to the side",
         "lower your (brow|forehead|nose) into the bent elbow and ^shoot the {S} arm out diagonally upwards", "sling your {S} arm out into a dab",
         "sneeze into your elbow with the {S} arm stretched out and up", "aim both arms to the upper {S} and ^bury your face in the elbow",
         "~nose in the crook of the elbow, {S} arm (diagonally|slanting) up", "~{S} arm slanting up, head (bowed|buried|hidden) in the opposite elbow",
         "~forehead (on|against) the bent forearm, {S} arm extended diagonally", "~a dab (aimed|directed) at the upper {S}")), sides=ONE, holds=True),
    "shake_out": Family(_shake_out, Words(
        ("shake out your (arms|hands|arms and hands) {n}", "shake your (arms|hands)( loose|) {n}", "loosen your arms {n}", "relax your arms by shaking them {n}", "shake the water off your hands {n}", "wiggle your arms {n}", "loosen up {n}", "shake your arms at your sides {n}", "shake off the tension {n}", "get rid of the tension in your arms {n}",
         "~(arms|hands|arms and hands) shaking loose {n}", "~{N} (loose shakes of the arms|shakes of the arms|loosening shakes)", "~a (good |loosening |loose |)shake of the (arms|hands)",
         "~your arms shake (loosely |)(at|by) your sides {n}", "~your hands shake (loosely|off the water|loose at your sides) {n}", "~both (arms|hands) shaken out {n}",
         "~(loose|floppy) arms, shaking {n}", "~arms (hanging and shaking|loose and shaking) {n}", "~a bit of arm shaking", "~shaking the (arms|hands) out at the sides {n}",
         "shake (the stiffness|the stress|it all) out of your arms {n}", "shake your hands dry {n}", "jiggle your arms( loosely|) {n}", "flick the water off your (hands|fingers) {n}",
         "shake both (arms|hands) (out|loose|out at your sides) {n}", "loosen (your hands by shaking them|up your arms|both arms with a shake) {n}",
         "let your arms (shake loosely|flop and ^shake|jiggle) {n}", "get the stiffness out of your arms {n}", "shake out your muscles like (a swimmer before the start|an athlete) {n}",
         "dangle your arms and ^shake them {n}", "give your arms a (good |)shake {n}",
         "(wobble|jostle|waggle|rattle) your loose arms {n}", "let your (limbs|wrists) (wobble|dangle) and ^shake {n}", "make (spaghetti|noodle|rubber|jelly) arms {n}",
         "fling the (droplets|drips|raindrops) off your fingers {n}", "unwind your arms with a loose shake {n}", "release the (cramp|knots|tightness) from your arms with a shake {n}",
         "vibrate your hanging arms loosely {n}", "get the pins and needles out of your arms {n}", "shake the (sand|rain|droplets) off your hands {n}",
         "~{N} (wobbles|jiggles|jostles) of the loose arms", "~a (wobble|jiggle|rattle) of the (limp|slack) arms", "~(limp|slack|spaghetti|rubber) arms (wobbling|shaking|jiggling) {n}",
         "~wrists slack, hands dangling and shaking {n}", "~a cool-down with the arms shaken loose {n}")), sides=BOTH, counts=(3, 4)),
    "heart_over_head": Family(still(reach((0.02, 0.45, 0.1), (1.0, 0.2, 0.1)), via=SIDE), Words(
        ("make a heart (above|over) your head", "form a (big |)heart( with your arms|)", "show (me |)a heart( with both arms|)", "send (me |)love with a big heart", "hold your hands together over your head", "stand like a ballerina( with your arms up|)", "make an O (above|over) your head with your arms",
         "put your hands together above your head", "join your hands overhead", "say I love you with your arms", "form a circle above your head", "do a ballet pose", "make a tree pose with your arms",
         "~a (big |)heart (with your arms|over your head|above your head)", "~a heart made with both arms", "~(arms|hands) (forming|in) a heart (above|over) the head",
         "~your arms (form|make|draw) a (big |)heart (above|over) your head", "~your arms (form|make) (a circle|an O|a ring) (above|over) your head",
         "~hands (meeting|together|joined) (overhead|above the head)", "~your hands (meet|touch|join|come together) (overhead|above your head)", "~arms rounded overhead (like a ballerina's|)",
         "~ballerina arms (above the head|overhead|)", "~fingertips (touching|together) (overhead|above the head)", "~a (circle|ring|round arch) of both arms (above|over) your head",
         "~a ballet pose with rounded arms overhead", "~palms together (overhead|above the head)", "~(ballet arms|fifth position arms) overhead",
         "form a (ring|circle|round arch|halo) with your arms (above|over) your head", "bring your (hands|fingertips|palms) together (overhead|above your head)",
         "make a (heart|love heart|big heart|halo|ring) with your arms (above|over) your head", "press your palms together above your head", "round your arms (above|over) your head",
         "take the fifth position of ballet with your arms up", "hold your arms in a (circle|heart) (above|over) your head", "show your love with a big arm heart",
         "touch your fingertips together above your head",
         "bend both arms into a dome (overhead|above your head)", "curve your arms into a (heart|ring|hoop) (above|over) your head", "frame your head from above with rounded arms",
         "crown your head with a heart made of your arms", "express your (affection|adoration) with a giant heart overhead",
         "become a (prima ballerina|music-box dancer) with your arms rounded overhead", "close your arms into a circle above your head", "spell the letter O above your head with both arms",
         "tell the (fans|crowd) you love them with a big heart overhead", "form a (steeple|gable|wreath) over your head with both arms",
         "~a (hoop|wreath|garland|Valentine|love symbol) made of both arms above the head", "~a giant (Valentine's |)heart overhead", "~elbows out, fingertips meeting above the crown of the head",
         "~arms (curved|arched|bent round) overhead, fingertips meeting", "~arms (en haut|en couronne) like a (prima |)ballerina", "~a yoga pose with the palms joined above the head")), sides=BOTH, holds=True),
    "binoculars": Family(still(reach((0.06, 0.25, 0.2), (0.8, -0.6, 0.1))), Words(
        ("look through (binoculars|a telescope|field glasses|a camera)", "hold binoculars (to|in front of) your eyes", "use binoculars", "watch (birds|the birds) with binoculars", "take a (photo|picture|photograph)( of me|)", "photograph me", "pretend to hold binoculars", "act like a (photographer|bird watcher)",
         "make glasses with your hands", "film me", "hold a camera to your eye", "spy through binoculars",
         "~binoculars (up |)(to|at|in front of) (your|the) eyes", "~both hands (hold|holding) binoculars( to your eyes|)", "~your hands hold (binoculars|a camera) (to|in front of) your eyes",
         "~(binoculars|field glasses|spyglass|opera glasses) up", "~a look through (binoculars|the binoculars|field glasses|a telescope)", "~a (photo|photograph|snapshot|picture) of me",
         "~hands (like|forming) binoculars (around|in front of|at) the eyes", "~hands making (glasses|goggles|binoculars)", "~camera (up |)to the eye", "~a photographer taking a picture",
         "~a bird watcher with binoculars", "raise (binoculars|the binoculars|field glasses|opera glasses) to your eyes", "put (binoculars|a camera) to your eyes",
         "snap (a photo|a picture|me with your camera)", "shoot (a photo|a film with your camera|a picture of me)",
         "make (goggles|binoculars|a pair of glasses) with your hands (around|in front of) your eyes", "spot the (birds|ships) through binoculars", "go bird watching with binoculars",
         "click the shutter of your camera", "follow the horse race through field glasses", "be the (photographer|cameraman|paparazzi)", "take (my photo|my picture|a snapshot|a family photo)",
         "hold your hands like binoculars",
         "(observe|scan|survey|inspect) the (horizon|landscape|stage) through binoculars", "zoom in with (your camera|binoculars)", "focus (your binoculars|the camera)",
         "train your binoculars on the horizon", "gaze through (field glasses|opera glasses|binoculars)", "form two (tubes|rings) with your hands and ^look through them",
         "capture the (moment|wedding|sunset) with your camera", "scout the (enemy|horizon) through field glasses", "take a (portrait|holiday snap|group shot) of me",
         "press the shutter release of your camera", "~a (lookout|birder|twitcher|ornithologist|sailor) with binoculars", "~curled hands around the eyes like (goggles|lenses)",
         "~thumbs and fingers ringed around both eyes", "~a (tourist|reporter|snapper) taking a photo", "~eyes to the (viewfinder|eyepiece|lenses)",
         "~a (glimpse|glance|peep) through the opera glasses")), sides=BOTH, holds=True),
    "juggle": Family(loops(circle((0.2, -0.2, 0.35), 0.09, "front", 1.5), 0.75, ELBOW_DOWN, 1.0, offset=0.5), Words(
        ("juggle( balls| three balls| apples| in the air|) {n}", "pretend to juggle {n}", "act like a juggler {n}", "be a juggler", "throw balls from hand to hand {n}", "show me how you juggle {n}", "do a juggling act {n}", "juggle like a clown {n}", "keep three balls in the air {n}", "toss balls up and ^catch them in turns {n}",
         "~(juggling|a juggling act|juggling with three balls|some juggling) {n}", "~a (juggler|circus juggler|juggling clown)", "~hands juggling {n}",
         "~both hands (juggle|juggling) (balls|three balls|apples|) {n}", "~your hands (juggle|toss and catch balls in turn|throw and catch balls in turn) {n}", "~balls in the air, juggling {n}",
         "~balls (going|flying) from hand to hand {n}", "~{N} rounds of juggling", "~hands up and down in turn, juggling {n}",
         "juggle (clubs|oranges|plates|four balls|torches|like in the circus) {n}", "perform a juggling (act|trick) {n}", "keep (the|four|several) balls (up |)in the air {n}",
         "do some juggling {n}", "throw and ^catch three balls in turn {n}", "play the juggler at the circus", "practise juggling {n}", "toss (apples|oranges) from hand to hand {n}",
         "act like (a circus artist juggling|a clown juggling) {n}", "try your hand at juggling {n}",
         "(flip|lob|chuck) balls up in turn and ^catch them {n}", "keep the (beanbags|lemons|knives|batons) (aloft|airborne|flying) {n}", "juggle (knives|beanbags|lemons|eggs|skittles) {n}",
         "entertain the (court|kids) by juggling {n}", "circulate three balls through the air {n}", "swap balls between your hands through the air {n}", "scoop and ^toss beanbags alternately {n}",
         "be a (jester|busker|acrobat) with three flying balls {n}", "~a (cascade|shower|fountain) of juggling balls {n}", "~{N} (cascades of juggling balls|flips of the juggling balls)",
         "~a (jester|busker|street artist|acrobat) juggling", "~palms up, balls (bouncing|hopping|arcing) from one to the other {n}", "~hands (scooping|popping|bobbing) the balls up alternately {n}",
         "~a juggler's (cascade|routine|number)")), sides=BOTH, counts=(3, 4)),
    "pull_hat": Family(strokes(reach((0.09, 0.33, 0.06), (0.9, 0.2, 0.0)), reach((0.2, 0.42, 0.22), (0.9, 0.2, 0.0)), 1.0), Words(
        ("tip your hat {n}", "raise your hat( politely|) {n}", "take off your (hat|cap) {n}", "lift your hat {n}", "greet me by raising your hat {n}", "doff your (hat|cap) {n}", "say good day with your hat {n}", "touch your hat like a gentleman {n}", "greet like a cowboy {n}",
         "~a (polite |)(tip|lift|doff) of the hat", "~{N} (tips of the hat|lifts of the hat)", "~a hat tip", "~{N} hat tips", "~hats off {n}", "~hat off (politely|for the ladies) {n}",
         "~a (gentleman's|cowboy's) greeting with the hat", "tip (the|your) (cap|bowler|top hat|cowboy hat|stetson|trilby) {n}", "lift your (cap|top hat|bowler hat) {n}",
         "raise your (cap|top hat|bowler hat|trilby) {n}", "take your hat off to me {n}", "doff your (bonnet|bowler|top hat) {n}", "remove your hat politely {n}", "say howdy with your hat {n}",
         "greet the lady with your hat {n}", "lift the brim of your hat {n}",
         "uncover your head politely {n}", "(doff|tip|raise) your (fedora|boater|sombrero|panama|derby|beret) {n}", "pay your respects by lifting your hat {n}",
         "raise the bowler like (Charlie Chaplin|Fred Astaire|an Edwardian gentleman) {n}", "(pinch|grasp) the brim of your hat and ^raise it {n}",
         "~a (raising|flourish|doffing) of the (hat|bowler)", "~a (courteous|chivalrous|gallant|old-fashioned) lift of the hat", "~{N} (lifts|tips) of the (fedora|derby|boater)"),
        one=("~your {S} hand (tips|lifts|raises|takes off) (your|the) hat {n}", "~{S} hand (to the hat and lift|lifting the hat|at the hat brim, tip it) {n}", "~a tip of the hat from the {S} hand",
         "~hat off with the {S} hand {n}", "~the {S} hand takes the hat off and puts it back {n}", "take your hat in your {S} hand and ^lift it {n}",
         "reach for your hat with your {S} hand and ^raise it {n}",
         "pinch the (brim|crown|peak) of your hat with your {S} (fingers|hand) and ^lift it {n}", "remove your headgear with the {S} hand and ^replace it {n}",
         "flip your hat up with the {S} hand {n}", "acknowledge the lady by lifting your hat with your {S} hand {n}", "~{S} fingers pinching the brim, the hat comes off and returns {n}",
         "~a (courtly|gallant|courteous) doff of the hat from the {S} hand", "~headgear up and back on with the {S} hand {n}")), sides=ONE, counts=(1,)),
}  # fmt: skip
