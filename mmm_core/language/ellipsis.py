"""What a clause leaves out, taken from the clause before it: "look left" + "right" -> "look right".

Carried over are the verb, the limb and the side; "it" is the limb that was last named, "the other" the other side.
"""

from __future__ import annotations

import re

OTHER = {"left": "right", "right": "left", "up": "down", "down": "up", "forward": "back", "back": "forward",
         "forwards": "backwards", "backwards": "forwards"}  # fmt: skip
_LIMB = r"(?:hands?|arms?|fists?|ones?|palms?|sides?|shoulders?|ears?|elbows?)"
_WAYS = r"(?:up|down|forwards?|back(?:wards?)?|ahead|straight ahead|upwards?|downwards?|sideways|behind you|in front(?: of you)?|(?:up |high )?above (?:you|your head)|up high|high up|up in the air|overhead|(?:out )?to the sides?|outwards?)"
_AFTER_VERB = (
    r"(?:go |come |move |switch |change |over |out |straight |now |finally |also |back |all the way |around )*"
)
_WAY_PHRASE = re.compile(
    rf"\b(?:(?:up|down|over) (?:to|at|towards|into|on) (?:the|your|my) (?!left|right)\w+|(?:over |out |straight |up |down )*(?:to|towards?|at|on) (?:the |your )?(?:left|right)(?: side)?|(?:to )?(?:the )?(?:left|right)(?! {_LIMB}\b)(?! side)|{_WAYS})(?!\w)"
)
_DIRECTION = re.compile(
    rf"^(?!(?:come|go|get|move|step) back)(?:one |another )?{_AFTER_VERB}(?P<way>(?:(?:up |down )?(?:to|towards?|at|on) )?(?:the |your )?(?P<side>left|right)(?: side| one| again)?|{_WAYS}|(?:up|down|back|over) (?:to|at|towards|into|on) (?:the |your |my )?\w+)$"
)
_SIDED = re.compile(rf"\b(left|right)\b(?= {_LIMB}\b)|\b(?:the|your) (left|right)\b")
_THE_SAME = r"(?:also |and |now )?(?:(?:do )?(?:the same|same|it|that|so|likewise|again|another|one|another one)(?: thing)?(?: again)? )?"
_ONLY_SIDE = re.compile(
    rf"^{_THE_SAME}(?:with|using|on|for|by|use)? ?(?:the |your )?(?P<side>left|right)(?: (?P<limb>{_LIMB}))?(?: (?:too|as well|again|instead))?$"
)
_OTHER_ONE = re.compile(
    rf"^{_THE_SAME}(?:(?:with|using|on|to|in|for|by|use|your|at) )*(?:the |your )?(?:other|opposite)(?: (?:way|direction|{_LIMB}))?(?: (?:too|as well|round|around))?$|^vice versa$|^(?:switch|swap|change)(?: sides| hands| arms| over)?$"
)
_AGAIN = re.compile(
    r"^(?:(?:do )?(?:it|that|the same)(?: thing)? )?(?:again|once more|one more time)$|^repeat(?: it| that)?$|^(?:do )?the same(?: again)?$"
)
_ONLY_BOTH = re.compile(
    r"^(?:(?:with|using|use) )?(?:your )?both(?: of them)?(?: (?:hands|arms))?(?: together| at once| at the same time)?$"
)
_ONE_ARM = re.compile(r"\b(?:(?:your|the|a|one) )?(?:left|right) (?P<limb>hand|arm|fist)\b")
_ONE_LIMB = re.compile(r"\b(?:one|a|your) (?P<limb>hand|arm|fist)\b")
_FLOOR, _CEILING = (
    re.compile(r"^at (?:the|your) (?:floor|ground|feet|toes)$"),
    re.compile(r"^at the (?:ceiling|sky|roof|stars|moon)$"),
)
_BOTH_ARMS = re.compile(r"\bboth (?:your )?(?P<limb>hand|arm|fist)s\b")
_ONLY_TIMES = re.compile(
    r"^(?P<times>once|twice|thrice|\w+ times)(?: more| again)?$|^(?P<number>\w+) (?:more|further)(?: times?)?$"
)
_COUNTED = re.compile(
    r"^(?P<times>once|twice|thrice|(?:one|two|three|four|five|six|seven|eight|\d) times?) (?P<rest>(?:with|using|on|to) .+)$"
)
_SAID_TIMES = re.compile(r"\b(?:once|twice|thrice|(?:one|two|three|four|five|six|seven|eight|\d) times?)\b")
_A_PLACE = (
    r"(?:(?:on|to|over|above|behind|in front of|under|at|towards) (?:your |the )?(?:heart|hips?|waist|head|chest|belly|stomach|mouth|eyes|ears?|back|forehead|shoulders?|chin|neck|sides?|knees|face)"
    r"|(?:straight |wide |high |out )*(?:up|down|out|wide|forward|ahead|apart|crossed|folded|open)(?: (?:in the air|to the sides?|in front|wide|high))?)"
)
_PLACE, _AT_PLACE = re.compile(rf"^{_A_PLACE}$"), re.compile(rf"\b{_A_PLACE}$")
_TARGET = re.compile(r"^(?:at )?(?:me|yourself|you|us|the \w+)$")
_AT_TARGET = re.compile(r"\bat (?:me|yourself|you|us|the \w+)$")
_NAMED_LIMB = re.compile(
    r"\b(?:(?:your|the|both|one|a) )?(?:both )?(?:(?:left|right) )?(?:hands?|arms?|fists?|palms?|fingers?|head|shoulders)\b"
)
_LIMB_SUBJECT = re.compile(
    r"^(?P<limb>(?:your |the )?(?:both |left |right )?(?:arms?|hands?|head|eyes|gaze|chin|shoulders)) "
)
_VERB = re.compile(r"^(?:\w+) ")
_ONE_OTHER = re.compile(
    r"\bone (?P<what>way|side|direction|arm|hand|fist|one)\b(?P<between>.*?)\b(?:the |your )other(?: (?:way|side|direction|arm|hand|fist|one))?\b"
)


_THAT_WAY = re.compile(r"(?<=\w )(?:(?:in )?(?:that|the same) (?:way|direction)|over there)$")
_OTHER_PART = re.compile(
    r"^(?:with |so )?(?:your|the) (?P<part>trunk|torso|upper body|body|waist|head|neck|shoulders|(?:left|right) (?:arm|hand)|arms)$"
)
_PART = "head|hair|forehead|ears?|eyes|nose|mouth|chin|cheeks?|face|neck|shoulders?|chest|heart|belly|stomach|tummy|hips?|back|knees?|thighs?|arms?"
_ONLY_PART = re.compile(rf"^(?:your|the) (?P<part>(?:(?:left|right) )?(?:{_PART}))$")
_RUBS = re.compile(
    rf"^(?P<verb>(?:rub|scratch|pat|touch|tap|cover|wipe|hold|brush|stroke)) (?:your|the) (?:(?:left|right) )?(?:{_PART})\b"
)
"""'Rub your belly', and what else may be rubbed: "then your head"."""
_TURNED = re.compile(
    r"\b(?:your|the) (?:trunk|torso|upper body|body|waist|head|neck|shoulders|(?:left |right )?(?:arms?|hands?))\b"
)


def with_sides(text: str) -> str:
    """A text with sides in place of "one" and "other": "one arm ..., then the other".

    >>> with_sides("one arm up, then the other"), with_sides("tilt your head one way, then the other")
    ('right arm up, then left arm', 'tilt your head to the left, then to the right')
    """
    found = _ONE_OTHER.search(text)
    if found is None or not re.search(r"\b(?:then|and|,|after|while|followed)\b|,", found["between"]):
        return text
    what = found["what"]
    if what in ("arm", "hand", "fist", "one"):
        first, second = f"right {what}", f"left {what}"
        before = text[: found.start()]
        yours = "" if not before.strip() else "your "
        put = f"{yours}{first}{found['between']}{'your ' if yours else ''}{second}"
    else:
        put = f"to the left{found['between']}to the right"
    return text[: found.start()] + put + text[found.end() :]


def completed(clause: str, before: str) -> str | None:  # noqa: PLR0912  one branch for each form of ellipsis
    """A clause with what it leaves out of the one before; None where it stands by itself.

    Args:
        clause: in lower case, without words of order around it.
        before: the command before it, itself completed.

    >>> completed("right", "turn your head left"), completed("with the other hand", "wave with your right hand")
    ('turn your head right', 'wave with your left hand')
    """
    if _AGAIN.match(clause.strip(" ,.!")):
        return before
    if (found := _ONLY_TIMES.match(clause.strip(" ,.!"))) and not re.match(r"(?:some|many|other)", clause):
        times = found["times"] or f"{found['number']} times"
        said, n = _SAID_TIMES.subn(times, before, count=1)
        return said if n else None
    clause = re.sub(
        r"^(?:and |then |now |next |finally |again )+|(?: again| too| as well| instead)+$",
        "",
        clause.strip(" ,.!"),
    ).strip()
    if not clause:
        return None
    clause = _CEILING.sub("up", _FLOOR.sub("down", clause))
    if (counted := _COUNTED.match(clause)) and (
        whole := completed(counted["rest"], _SAID_TIMES.sub("", before).strip())
    ):
        return f"{whole} {counted['times']}"
    if _ONLY_BOTH.match(clause):
        both, n = _ONE_ARM.subn(lambda m: f"both {m['limb']}s", before, count=1)
        return both if n else None
    if (found := _ONLY_SIDE.match(clause)) and _BOTH_ARMS.search(before):
        return _BOTH_ARMS.sub(lambda m: f"your {found['side']} {m['limb']}", before)
    if _OTHER_ONE.match(clause):
        return _other_way(before)
    if found := _ONLY_SIDE.match(clause):
        if sided := _to_side(before, found["side"]):
            return sided
    if found := _DIRECTION.match(clause):
        if moved := _to_way(before, found["way"]):
            return moved
    if _DIRECTION.match(clause) and (limb := _LIMB_SUBJECT.match(before)):
        return f"{limb['limb']} {clause}"
    if found := _ONLY_SIDE.match(clause):
        return f"{before} with your {found['side']} hand"
    if (part := _OTHER_PART.match(clause)) and (limb := _TURNED.search(before)) and not limb.start() == 0:
        return f"{before[: limb.start()]}your {part['part']}{before[limb.end() :]}"
    if (part := _ONLY_PART.match(clause)) and (rubbed := _RUBS.match(before)):
        return f"{rubbed['verb']} your {part['part']}{before[rubbed.end() :]}"
    if (there := _THAT_WAY.search(clause)) and (
        way := re.search(r"\b(?:to (?:the |your )?)?(?:left|right|up|down)\b(?! (?:hand|arm))", before)
    ):
        return f"{clause[: there.start()]}{way[0]}{clause[there.end() :]}"
    if _PLACE.match(clause) and _AT_PLACE.search(before):
        return _AT_PLACE.sub(clause, before)
    if _PLACE.match(clause) and (limb := _LIMB_SUBJECT.match(before)):
        return f"{limb['limb']} {clause}"
    if _TARGET.match(clause) and _AT_TARGET.search(before):
        return _AT_TARGET.sub(clause if clause.startswith("at ") else f"at {clause}", before)
    if moved := _other_object(clause, before):
        return moved
    pronoun = _with_pronoun(clause, before)
    return _with_limb(pronoun or clause, before) or pronoun


def _other_way(before: str) -> str:
    """The command before, to the other side; without a side, with the left hand."""
    if re.search(r"\b(?:left|right)\b", before):
        return re.sub(r"\b(left|right)\b", lambda m: OTHER[m[1]], before)
    if found := _ONE_LIMB.search(before):
        return f"{before[: found.start()]}your left {found['limb']}{before[found.end() :]}"
    for way, other in OTHER.items():
        if re.search(rf"\b{way}\b", before):
            return re.sub(rf"\b{way}\b", other, before)
    return f"{before} with your left hand"


def _to_side(before: str, side: str) -> str | None:
    """The command before with another side of the limb; None where it names no side of a limb."""
    if not _SIDED.search(before):
        return None
    return re.sub(r"\b(?:left|right)\b", side, before)


def _to_way(before: str, way: str) -> str | None:
    """The command before in another direction; None where it has none."""
    found = list(_WAY_PHRASE.finditer(before))
    if not found:
        return None
    last = found[-1]
    way = re.sub(r"^(?:the|your) (left|right)", r"to the \1", re.sub(r" (?:again|one)$", "", way))
    return before[: last.start()] + way + before[last.end() :]


def _other_object(clause: str, before: str) -> str | None:
    """The command before with another object of its preposition: "to the window" after "point to the door"; None without one."""
    found = re.match(r"(?:back )?(to|at|towards|over|behind|under) (?:(?:the|your|a|my) )?\w+", clause)
    place = found and re.search(rf"\b{found[1]} ", before)
    return f"{before[: place.start()]}{clause.removeprefix('back ')}".replace(" first ", " ") if place else None


def _with_pronoun(clause: str, before: str) -> str | None:
    """A clause with its pronoun resolved: "wave it" after "raise your right arm" -> "wave your right arm"; None without one."""
    limbs = _NAMED_LIMB.findall(before)
    if re.match(r"(?:hold|keep|do|does|repeat|stop|continue|stay|leave)\b", clause):
        return None
    several = [limb for limb in limbs if limb.endswith("s") and not limb.endswith("fists")]
    if re.search(r"\bthem\b", clause):
        limbs = several
    limbs = [limb for limb in limbs if not limb.endswith("head")] or limbs
    if not limbs or not re.search(
        r"\b(?:it|them|that (?:hand|arm|one)|the same (?:hand|arm|one)|this (?:hand|arm))\b", clause
    ):
        return None
    limb = limbs[-1] if limbs[-1].startswith(("your", "both")) else "your " + re.sub(r"^(?:the|one|a) ", "", limbs[-1])
    return re.sub(
        r"\b(?:it|them|that (?:hand|arm|one)|the same (?:hand|arm|one)|this (?:hand|arm))\b", limb, clause, count=1
    )


def _with_limb(clause: str, before: str) -> str | None:
    """A clause with the other limb named: "the other up" after "right hand on your heart" -> "left hand up"; None without one."""
    found = re.match(r"^(?:the |your )?other(?: (?P<limb>hand|arm|one|fist|palm))? (?P<rest>.+)$", clause)
    side = re.search(r"\b(left|right) (hand|arm|fist|palm)\b", before)
    if found is None:
        inside = re.search(
            r"\b(?:the |your )?other (?P<limb>hand|arm|one|fist|palm)\b|\b(?:with|using) the other\b(?! (?:hand|arm|one|fist|palm)\b)",
            clause,
        )
        if inside is None or side is None:
            return None
        limb = inside["limb"] if inside["limb"] not in (None, "one") else side[2]
        lead = "with " if inside[0].startswith(("with", "using")) else ""
        return f"{clause[: inside.start()]}{lead}your {OTHER[side[1]]} {limb}{clause[inside.end() :]}"
    if side is None:
        return None
    limb = found["limb"] if found["limb"] not in (None, "one") else side[2]
    return f"{OTHER[side[1]]} {limb} {found['rest']}"
