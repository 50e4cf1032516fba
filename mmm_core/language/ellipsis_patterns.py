"""Patterns of clauses with omitted words, for `mmm_core.language.ellipsis`.

Clauses are in lower case and have no words of order around them.
"""

from __future__ import annotations

import re

_LIMB = r"(?:hands?|arms?|fists?|ones?|palms?|sides?|shoulders?|ears?|elbows?)"
_WAYS = r"(?:up|down|forwards?|back(?:wards?)?|ahead|straight ahead|upwards?|downwards?|sideways|behind you|in front(?: of you)?|(?:up |high )?above (?:you|your head)|up high|high up|up in the air|overhead|(?:out )?to the sides?|outwards?|inwards?|(?:anti-?|counter-?)?clockwise)"
_AFTER_VERB = (
    r"(?:go |come |move |switch |change |over |out |straight |now |finally |also |back |all the way |around )*"
)
WAY_PHRASE = re.compile(
    rf"\b(?:(?:up|down|over) (?:to|at|towards|into|on) (?:the|your|my) (?!left|right)\w+|(?:over |out |straight |up |down )*(?:to|towards?|at|on) (?:the |your )?(?:left|right)(?: side)?|(?:to )?(?:the )?(?:left|right)(?! {_LIMB}\b)(?! side)|{_WAYS})(?!\w)"
)
DIRECTION = re.compile(
    rf"^(?!(?:come|go|get|move|step) back)(?:one |another )?{_AFTER_VERB}(?P<way>(?:(?:up |down )?(?:to|towards?|at|on) )?(?:the |your )?(?P<side>left|right)(?: side| one| again)?|{_WAYS}|(?:up|down|back|over) (?:to|at|towards|into|on) (?:the |your |my )?\w+)$"
)
SIDED = re.compile(rf"\b(left|right)\b(?= {_LIMB}\b)|\b(?:the|your) (left|right)\b")
_THE_SAME = r"(?:also |and |now )?(?:(?:do )?(?:the same|same|likewise|it|that|so|again|another|one|another one)(?: thing)?(?: again)? )?"
ONLY_SIDE = re.compile(
    rf"^{_THE_SAME}(?:(?:just|only) )?(?:with|using|on|for|by|use|over)? ?(?:the |your )?(?P<side>left|right)(?: (?P<limb>{_LIMB}))?(?: (?:too|as well|again|instead|alone|does (?:the same|likewise|it too|so too|that too)))?$"
)
OTHER_ONE = re.compile(
    rf"^{_THE_SAME}(?:(?:with|using|on|to|in|for|by|use|your|at) )*(?:the |your )?(?:other|opposite|second(?= one))(?: (?:way|direction|{_LIMB}))?(?: (?:too|as well|round|around|does (?:the same|likewise|it too|so too|that too)))?$|^vice versa$|^(?:switch|swap|change)(?: sides?| hands?| arms?| over)?$"
)
ADVERBS = {"big": "with big movements", "bigger": "with big movements", "small": "with small movements", "smaller": "with small movements",
            "large": "with big movements", "larger": "with big movements", "wide": "with big movements", "wider": "with big movements"}  # fmt: skip
AGAIN = re.compile(
    r"^(?:(?:do )?(?:it|that|the same)(?: thing)? )?(?:again|once more|one more time)$|^repeat(?: it| that)?$|^(?:do )?the same(?: again)?$"
)
SIDED_PLACE = re.compile(r"^(?:the|a|an|my|that) \w+(?: \w+)? (?:on|to|at) (?:the|your) (?P<side>left|right)$")
"""A thing beside the robot that the verb of the command before goes for: "turn to the bar on your right, then the door on your left"."""
ANOTHER = re.compile(r"^(?:and |then |now )*(?:again|once more|another(?: one)?|one more(?: time)?|the same again)$")
ONE_MORE = re.compile(r"^(?:and |then |now )*(?:once more|(?:one|another) more(?: time)?|another(?: one)?)$")
"""A clause that asks for one more stroke of a command that names a number: "nod three times, wait, and once more"."""
ONLY_MANNER = re.compile(
    r"^(?:but |and |only )*(?:(?:a (?:bit|little|lot)|much|very|really|even|more|again) )*(?:slow(?:ly|er)?|fast(?:er)?|quick(?:ly|er)?|gently|softly|big(?:ger)?|small(?:er)?|large(?:r)?|wide(?:r|ly)?|deep(?:er|ly)?|slightly|hugely|(?:just )?a (?:bit|little))$"
)
SIZE_LAST = re.compile(r" (?:deep|deeply|low)$")
"""Size in words of a gesture of its own ("bow deeply"), which a clause of another size replaces: "bow deeply, then slightly"."""
MANNER_FIRST = re.compile(
    r"^(?P<how>(?:very |really )?(?:slowly|quickly|fast|gently|briskly|rapidly)|a (?:lot|little|bit)|slightly|way|far|deeply) (?P<rest>.+)$"
)
MANNER_LAST = re.compile(r"^(?P<rest>.+?),? (?:but|only|just)(?: a (?:bit|little|lot)| much)? (?P<how>\w+)$")
"""'The other one, but slower.'"""
OVER_A_SHOULDER = re.compile(r"^(?:back )?(?P<over>over (?:your|the) (?:left|right) shoulder)$")
LOOKED = re.compile(r"^(?:look|glance|turn your head|peek)\b")
AGAIN_BUT = re.compile(
    r"^(?:do (?:it|that) |and |then )*(?:again|once more|the same|one more)(?: again)?,? (?:but |only |and )*(?P<how>.+)$"
)
ONLY_BOTH = re.compile(
    r"^(?:(?:with|using|use|only|just) )*(?:your )?both(?: of them)?(?: (?:hands|arms))?(?: together| at once| at the same time)?$"
)
ONE_ARM = re.compile(r"\b(?:(?:your|the|a|one) )?(?:left|right) (?P<limb>hand|arm|fist)\b")
ONE_LIMB = re.compile(r"\b(?:one|a|your) (?P<limb>hand|arm|fist)\b")
SIDED_NOUN = re.compile(r"^(?:an?|the|another|one) (?P<side>left|right)(?: one| hand)?$")
SIDED_GESTURE = re.compile(r"\ban? (?P<side>left|right) (?=(?:hook|jab|punch|uppercut|wave|salute|handed)\b)")
FLOOR, CEILING = (
    re.compile(r"^at (?:the|your) (?:floor|ground|feet|toes)$"),
    re.compile(r"^at the (?:ceiling|sky|roof|stars|moon)$"),
)
WITH_SIDE = re.compile(r"\bwith (?:the |your )?(?:left|right)$")
ONE_OF_TWO = re.compile(r"\b(?:your |the )(?:left |right )(?P<part>eye|ear|shoulder|knee|elbow|cheek|side|biceps?)\b")
BOTH_ARMS = re.compile(r"\bboth (?:your )?(?P<limb>hand|arm|fist)s\b")
ONLY_TIMES = re.compile(
    r"^(?:again )?(?P<times>once|twice|thrice|\w+ times)(?: more| again)?$|^(?:(?:give|do|make|show)(?: (?:me|us|them|him|her))? )?(?P<number>\w+) (?:more|further)(?: times?)?$"
)
COUNTED = re.compile(
    r"^(?P<times>once|twice|thrice|(?:one|two|three|four|five|six|seven|eight|\d) times?) (?P<rest>(?:with|using|on|to) .+|left|right|up|down|forwards?|back(?:wards?)?)$"
)
COUNTED_LAST = re.compile(
    r"^(?P<rest>(?:with|using|on|to) .+?|left|right|up|down|forwards?|back(?:wards?)?) (?P<times>once|twice|thrice|(?:one|two|three|four|five|six|seven|eight|\d) times?)$"
)
WAY_WITH = re.compile(
    r"^(?:to the )?(?:left|right|up|down|forward|ahead|straight ahead|back) (?:with|using) (?:your |the )?(?:left|right|other)\b.*$"
)
LOOKS = re.compile(r"^(?:look|point|glance|gaze)\b(?! at\b)")
LOOKS_AT = re.compile(r"^(look|point|glance|gaze) at\b")
POINTS = re.compile(r"^(?:point|punch|reach|wave|swing|push|stretch|lean|look)\b")
_A_PLACE = (
    r"(?:(?:on|to|over|above|behind|in front of|under|at|towards) (?:your |the )?(?:heart|hips?|waist|head|chest|belly|stomach|mouth|eyes|ears?|back|forehead|shoulders?|chin|neck|sides?|knees|face)"
    r"|(?:straight |wide |high |out )*(?:up|down|out|wide|forward|ahead|apart|crossed|folded|open)(?: (?:in the air|to the sides?|in front|wide|high))?)"
)
PLACE, AT_PLACE = re.compile(rf"^{_A_PLACE}$"), re.compile(rf"\b{_A_PLACE}$")
TARGET = re.compile(r"^(?:at )?(?:me|yourself|you|us|the \w+)$")
AT_TARGET = re.compile(r"\bat (?:me|yourself|you|us|the \w+)$")
THING = re.compile(
    r"^(?:the|that|this|my) (?!(?:left|right|other|same|first|second|last|next|one)\b)(?:(?!one\b)[a-z]+ ?){1,2}"
    r"(?: (?:on|to|at|in|behind|above|over) (?:your|the|my) \w+)?$"
)
GOES_TO_THING = re.compile(
    r"^(?:point|look|wave|bow|nod|glance|gaze|stare|reach|turn|lean|salute|beckon|knock|aim|gesture)\b.*? (?:to|at|towards)(?= (?:the|that|this|my) (?!left|right))"
)
"""'Point to the door on your right', and 'the window on your left' to which a command without a verb points."""
NAMED_LIMB = re.compile(
    r"\b(?:(?:your|the|both|one|a) )?(?:both )?(?:(?:left|right) )?(?:hands?|arms?|fists?|palms?|fingers?|fingertips|head|shoulders)\b"
)
THAT_LIMB = re.compile(r"\b(?:that|the same|this) (?P<limb>hand|arm)\b")
KEEPS_ON = re.compile(
    r"(?:hold|keep|do|repeat|stop|continue|stay|leave)(?:s|es|ing)?\b"
    r"(?! (?:it|them) (?:out|forward|away|above|against|behind|in front|over your|to your|towards?)\b)"
)
"""Verbs of a clause that keeps the pose of the command before it; "hold it out to me" asks for another pose."""
BODY_PLACE = re.compile(
    r"^(?:(?:the|your) )?(?P<part>hips?|waist|heads?|shoulders?|knees?|heart|chest|belly|chin|nose|eyes|ears|mouth|back|neck|forehead|face)$"
)
ON_PLACE = re.compile(
    r"\b(?P<on>on|over|behind|to|at) (?:your |the )?(?:hips?|waist|head|shoulders?|knees?|heart|chest|belly|chin|nose|eyes|ears|mouth|back|neck|forehead|face)$"
)
LIMB_SUBJECT = re.compile(
    r"^(?P<limb>(?:your |the )?(?:both |left |right )?(?:arms?|hands?|head|eyes|gaze|chin|shoulders)) "
)
_VERB = re.compile(r"^(?:\w+) ")
_PAIRED = "shoulder|ear|eye|cheek|temple|elbow|wrist|knee|thigh"
ONE_OTHER = re.compile(
    rf"\bone (?P<what>way|side|direction|arm|hand|fist|one|{_PAIRED})\b(?P<between>.*?)\b(?:the |your )?other(?: (?:way|side|direction|arm|hand|fist|one|{_PAIRED}))?\b"
)
THAT_WAY = re.compile(r"(?<=\w )(?:(?:in )?(?:that|the same) (?:way|direction)|over there)$")
OTHER_PART = re.compile(
    r"^(?:with |so )?(?:your|the) (?P<part>trunk|torso|upper body|body|waist|head|neck|shoulders|(?:left|right) (?:arm|hand)|arms)$"
)
_PART = "head|hair|forehead|ears?|eyes|nose|mouth|chin|cheeks?|face|neck|shoulders?|chest|heart|belly|stomach|tummy|hips?|back|knees?|thighs?|arms?"
ONLY_PART = re.compile(rf"^(?:your|the) (?P<part>(?:(?:left|right) )?(?:{_PART}))$")
_RUB = "rub|scratch|pat|touch|tap|cover|wipe|hold|brush|stroke"
RUBS_IT = re.compile(rf"^(?P<verb>{_RUB}) (?:it|them)\b")
RUBS = re.compile(rf"^(?P<verb>(?:{_RUB})) (?:your|the) (?:(?:left|right) )?(?:{_PART})\b")
"""'Rub your belly', and what else may be rubbed: "then your head"."""
TURNED = re.compile(
    r"\b(?:your|the) (?:trunk|torso|upper body|body|waist|head|neck|shoulders|(?:left |right )?(?:arms?|hands?))\b"
)
