"""Completes a clause with words that it omits, from the clause before it: "look left" + "right" -> "look right".

The clause takes over verb, limb and side; "it" is the limb named last, "the other" the other side.
"""

from __future__ import annotations

import re

from mmm_core.language import ellipsis_patterns as forms
from mmm_core.language.count_words import SAID_TIMES
from mmm_core.language.manner import manner_of

OTHER = {"left": "right", "right": "left", "up": "down", "down": "up", "forward": "back", "back": "forward",
         "forwards": "backwards", "backwards": "forwards"}  # fmt: skip


def with_sides(text: str) -> str:
    """A text with sides in place of "one" and "other": "one arm ..., then the other".

    >>> with_sides("one arm up, then the other"), with_sides("tilt your head one way, then the other")
    ('right arm up, then left arm', 'tilt your head to the left, then to the right')
    """
    found = forms.ONE_OTHER.search(text)
    if found is None or not re.search(r"\b(?:then|and|,|after|while|followed)\b|,", found["between"]):
        return text
    if found["between"].split() in (["after"], ["after", "the"]):
        return text  # "one fist after the other" is one command, for both arms by turns
    what = found["what"]
    if what not in ("way", "side", "direction"):
        first, second = f"right {what}", f"left {what}"
        before = text[: found.start()]
        if re.search(r"\bleft\b", before):  # "point left with one hand and right with the other"
            first, second = second, first
        yours = "your " if before.strip() else ""
        named = "your " if yours or re.search(r"\b(?:with|using|use|in|on)\s*$", found["between"]) else ""
        put = f"{yours}{first}{found['between']}{named}{second}"
    else:
        put = f"to the left{found['between']}to the right".replace(" to to ", " to ")
        return text[: found.start()].removesuffix("to ") + put + text[found.end() :]
    return text[: found.start()] + put + text[found.end() :]


def is_manner(clause: str) -> bool:
    """Whether a clause has only words of manner, like "slowly"; after a comma they belong to the command before."""
    return bool(forms.ONLY_MANNER.match(clause))


def _in_manner(before: str, clause: str) -> str:
    """The command before in the manner of a clause instead of its own: "slowly"."""
    bare = manner_of(before)[0]
    bare = forms.SIZE_LAST.sub("", bare) if manner_of(f"nod {clause}")[1].size != 1 else bare
    return f"{bare} {forms.ADVERBS.get(clause, clause)}"


def completed(clause: str, before: str) -> str | None:  # noqa: PLR0912  one branch for each form of ellipsis
    """A clause completed with omitted words from the command before; None where the clause is complete.

    Args:
        clause: clause in lower case, without words of order around it.
        before: the command before it, already completed.

    >>> completed("right", "turn your head left"), completed("with the other hand", "wave with your right hand")
    ('turn your head right', 'wave with your left hand')
    """
    if forms.ONE_MORE.match(clause.strip(" ,.!")) and SAID_TIMES.search(before):
        return SAID_TIMES.sub("once", before)
    if forms.AGAIN.match(clause.strip(" ,.!")):
        return before
    if (found := forms.ONLY_TIMES.match(clause.strip(" ,.!"))) and not re.match(r"(?:some|many|other)", clause):
        times = found["times"] or f"{found['number']} times"
        said, n = SAID_TIMES.subn(times, before, count=1)
        return said if n else None
    if forms.ANOTHER.match(clause.strip(" ,.!")):
        return before
    clause = re.sub(
        r"^(?:and |then |now |next |finally |again |but )+|(?: again| too| as well| also| instead)+$",
        "",
        clause.strip(" ,.!"),
    ).strip()
    if not clause:
        return None
    clause = forms.CEILING.sub("up", forms.FLOOR.sub("down", clause))
    if (counted := forms.COUNTED.match(clause)) and (
        whole := completed(counted["rest"], SAID_TIMES.sub("", before).strip())
    ):
        return f"{whole} {counted['times']}"
    if (counted := forms.COUNTED_LAST.match(clause)) and (
        whole := completed(counted["rest"], SAID_TIMES.sub("", before).strip())
    ):
        return f"{whole} {counted['times']}"
    if (again := forms.AGAIN_BUT.match(clause)) and forms.ONLY_MANNER.match(again["how"]):
        clause = again["how"]
    if (last := forms.MANNER_LAST.match(clause)) and forms.ONLY_MANNER.match(last["how"]):
        whole = completed(last["rest"], manner_of(before)[0])
        return None if whole is None else f"{whole} {forms.ADVERBS.get(last['how'], last['how'])}"
    if (over := forms.OVER_A_SHOULDER.match(clause)) and forms.LOOKED.match(before):
        return f"look {over['over']}"
    if forms.ONLY_MANNER.match(clause):
        return _in_manner(before, clause)
    if (first := forms.MANNER_FIRST.match(clause)) and (whole := completed(first["rest"], manner_of(before)[0])):
        return f"{whole} {first['how']}"
    if (way := forms.WAY_WITH.match(clause)) and (verb := forms.POINTS.match(before)):
        return f"{verb[0]} {way[0]}"
    if forms.ONLY_BOTH.match(clause):
        both, n = forms.ONE_ARM.subn(lambda m: f"both {m['limb']}s", before, count=1)
        if not n:
            both, n = forms.WITH_SIDE.subn("with both hands", before, count=1)
        if not n:
            both, n = forms.ONE_OF_TWO.subn(lambda m: f"both your {m['part']}s", before, count=1)
        return both if n else None
    if (noun := forms.SIDED_NOUN.match(clause)) and (said := forms.SIDED_GESTURE.search(before)):
        return f"{before[: said.start('side')]}{noun['side']}{before[said.end('side') :]}"
    if (found := forms.ONLY_SIDE.match(clause)) and forms.BOTH_ARMS.search(before):
        return forms.BOTH_ARMS.sub(lambda m: f"your {found['side']} {m['limb']}", before)
    if forms.OTHER_ONE.match(clause):
        return _other_way(before)
    if found := forms.ONLY_SIDE.match(clause) or forms.SIDED_PLACE.match(clause):
        if sided := _to_side(before, found["side"]):
            return sided
    if found := forms.DIRECTION.match(clause):
        if moved := _to_way(before, found["way"]):
            return moved
    if forms.DIRECTION.match(clause) and (limb := forms.LIMB_SUBJECT.match(before)):
        return f"{limb['limb']} {clause}"
    if (found := forms.DIRECTION.match(clause)) and not found["side"] and (verb := forms.LOOKS_AT.match(before)):
        return f"{verb[1]} {clause}"
    if found := forms.ONLY_SIDE.match(clause):
        limb = forms.ONE_LIMB.search(before)
        if limb is not None:
            return f"{before[: limb.start()]}your {found['side']} {limb['limb']}{before[limb.end() :]}"
        return f"{before} with your {found['side']} hand"
    if (part := forms.OTHER_PART.match(clause)) and (limb := forms.TURNED.search(before)) and not limb.start() == 0:
        return f"{before[: limb.start()]}your {part['part']}{before[limb.end() :]}"
    if (part := forms.ONLY_PART.match(clause)) and (rubbed := forms.RUBS.match(before)):
        return f"{rubbed['verb']} your {part['part']}{before[rubbed.end() :]}"
    if (there := forms.THAT_WAY.search(clause)) and (
        way := re.search(r"\b(?:to (?:the |your )?)?(?:left|right|up|down)\b(?! (?:hand|arm))", before)
    ):
        return f"{clause[: there.start()]}{way[0]}{clause[there.end() :]}"
    if (place := forms.BODY_PLACE.match(clause)) and (at := forms.ON_PLACE.search(before)):
        return f"{before[: at.start()]}{at['on']} your {place['part']}"
    if forms.PLACE.match(clause) and forms.AT_PLACE.search(before):
        return forms.AT_PLACE.sub(clause, before)
    if forms.PLACE.match(clause) and (limb := forms.LIMB_SUBJECT.match(before)):
        return f"{limb['limb']} {clause}"
    if clause.startswith("at ") and forms.TARGET.match(clause) and (verb := forms.LOOKS.match(before)):
        return f"{verb[0]} {clause}"
    if forms.THING.match(clause) and (verb := forms.GOES_TO_THING.match(before)):
        return f"{verb[0]} {clause}"
    if forms.TARGET.match(clause) and forms.AT_TARGET.search(before):
        return forms.AT_TARGET.sub(clause if clause.startswith("at ") else f"at {clause}", before)
    if moved := _other_object(clause, before):
        return moved
    pronoun = _with_pronoun("lower it" if clause == "lower" else clause, before)
    return _with_limb(pronoun or clause, before) or pronoun


def _other_way(before: str) -> str:
    """The command before, to the other side; without a side, with the left hand."""
    if re.search(r"\b(?:left|right)\b", before):
        return re.sub(r"\b(left|right)\b", lambda m: OTHER[m[1]], before)
    if found := forms.ONE_LIMB.search(before):
        return f"{before[: found.start()]}your left {found['limb']}{before[found.end() :]}"
    for way, other in OTHER.items():
        if re.search(rf"\b{way}\b", before):
            return re.sub(rf"\b{way}\b", other, before)
    return f"{before} with your left hand"


def _to_side(before: str, side: str) -> str | None:
    """The command before with another side of the limb; None where it names no side of a limb."""
    if not forms.SIDED.search(before):
        return None
    return re.sub(r"\b(?:left|right)\b", side, before)


def _to_way(before: str, way: str) -> str | None:
    """The command before in another direction; None where it has none."""
    found = list(forms.WAY_PHRASE.finditer(before))
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
    if (rubbed := forms.RUBS.match(before)) and (again := forms.RUBS_IT.match(clause)):
        return f"{again['verb']}{rubbed[0].removeprefix(rubbed['verb'])}{clause[again.end() :]}"
    limbs = forms.NAMED_LIMB.findall(before)
    if forms.KEEPS_ON.match(clause):
        return None
    several = [limb for limb in limbs if limb.endswith("s") and not limb.endswith("fists")]
    if re.search(r"\bthem\b", clause):
        limbs = several
    limbs = [limb for limb in limbs if not limb.endswith("head")] or limbs
    if not limbs or not re.search(
        r"\b(?:it|them|that (?:hand|arm|one)|the same (?:hand|arm|one)|this (?:hand|arm))\b", clause
    ):
        return None
    if (same := forms.THAT_LIMB.search(clause)) and (side := re.search(r"\b(?:left|right)\b", limbs[-1])):
        return f"{clause[: same.start()]}your {side[0]} {same['limb']}{clause[same.end() :]}"
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
        if inside is None:
            return None
        named = side[1] if side else "right"  # the default hand of a gesture without a side
        limb = inside["limb"] if inside["limb"] not in (None, "one") else side[2] if side else "hand"
        lead = "with " if inside[0].startswith(("with", "using")) else ""
        return f"{clause[: inside.start()]}{lead}your {OTHER[named]} {limb}{clause[inside.end() :]}"
    if side is None:
        return None
    limb = found["limb"] if found["limb"] not in (None, "one") else side[2]
    return f"{OTHER[side[1]]} {limb} {found['rest']}"
