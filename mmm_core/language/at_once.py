"""Simultaneous commands of a clause, each for its own limbs: "left hand on your heart and salute with the right"."""

from __future__ import annotations

import re
from functools import partial

from mmm_core.language.completed_at_once import ACTS, OTHER_HAND, freed, imperative, sided, there, with_verb
from mmm_core.language.limbs import ARMS, SOME_ARM, limbs_named, limbs_of
from mmm_core.language.word_tables import LIMB, any_of

_any = partial(any_of, "at_once")
_POSE = re.compile(rf"^(?:(?:and|also|with|please) )*{_any('pose')}\w*")
_NO_POSE = re.compile(rf"{_any('no pose')}\b")
_ENDS = re.compile(rf"\b{_any('by itself')}\b")
_VERB_FIRST = re.compile(rf"^(?:also )?(?!{_any('no verb')}\b)\w+")
_WHILE = re.compile(rf"\s*,?\s*\b(?:and )?{_any('while')}\b,?\s+(?:{_any('while also')}\s+)*")
_AS_YOU = re.compile(
    rf"\s*,?\s*(?<!fast )(?<!quickly )(?<!slowly )(?<!far )(?<!wide )(?<!high )(?<!hard )(?<!long )\bas (?:you(?! {_any('as you can')}\b)(?: are)?\s+|"
    rf"(?=(?:your|the|both) (?:left |right )?(?:{LIMB}|head|eyes|body|trunk)\b))"
)
_SAME_TIME = re.compile(rf"\s*,?\s*(?:\band )?(?:\bboth )?\b{_any('same time')}\b[,:]?\s*(?:and )?")
_LEADING = re.compile(
    r"^(?:while|whilst|as you(?: are)?|at the same time as)\s+(?:you are |you )?(?P<first>[^,]+),\s*(?P<second>.+)$"
)
_WITH_LEADING = re.compile(
    rf"^with (?P<first>(?:your |both |the |one )*(?:left |right )?{LIMB} {_any('held first')}\b[^,]*),\s*(?P<second>\w.+)$"
)
_WITH_POSE = re.compile(
    rf"\s*,?\s+with (?P<pose>(?:(?:your|both|one|the|a) )*(?:left |right )?{LIMB} (?:{_any('held')} )*"
    rf"(?:{_any('held at')}\b.*|{_any('is held')}))$"
)
_AND = re.compile(r"\s*,\s*(?:and\s+|but\s+)?(?:also\s+)?|\s+(?:and|plus|but)\s+(?:also\s+)?")
_RAISES = re.compile(r"^(?:raise|lift|put up|hold up) (?:your |the )?(?:left|right) (?:hand|arm)(?: up| high)?$")
_ONLY_WAVES = re.compile(r"^wave\b(?!.*\b(?:hand|arm|left|right|other)\b)")
"""'Raise your left hand and wave' is one gesture."""
_WITHOUT_OBJECT = re.compile(r"(?:an?|one)\b|[a-z]+$")
_HAND_TO = re.compile(r"(?:your |the )?(?:left|right) (?:hand|arm) to\b")
_BARE_LIMB = re.compile(
    rf"^(?:with )?(?:your |the |both |left |right |other )*(?:{LIMB}|head|body|eyes|face|chin|nose|mouth|ears?|cheeks?|neck|hair|forehead|shoulders?|chest|heart|belly|stomach|hips?|back|knees?)$"
)
"""A limb without a verb or place is no command."""
_LISTED = re.compile(r"\b(?:your|the|his|her|their|my|its|both) \w+$")
_LISTED_NEXT = re.compile(
    r"(?:shoulders?|arms?|hands?|head|body|trunk|hips?|chest|elbows?)(?: (?:over|on|to|towards|against|for|from|with|at)\b|$)"
)
"""'Your weight and shoulders over your right leg' names two things that do one thing."""
_HOLDS = re.compile(r"(?:hold|keep|stay|remain|freeze|wait)s?\b.*\b(?:seconds?|secs?)\b")
_WAY_LAST = re.compile(rf"\b{_any('way')}$")
_WAY_FIRST = re.compile(rf"^{_any('way')}\b(?! (?:hands?|arms?|fists?|palms?|one|elbow)\b)")
"""'Up and down' and 'back and forth' belong to one command."""
_RETURNS, _OWN_PART = re.compile(rf"^{_any('returns')}"), re.compile(rf"^{_any('own part')}")
_SOMEBODY = rf"^(?:{_any('somebody')} )?"
_SHARES, _PREPARES = re.compile(rf"{_SOMEBODY}{_any('shares')}$"), re.compile(rf"{_SOMEBODY}{_any('prepares')}\b")
_TAKES, _IT = re.compile(rf"\b{_any('takes')}"), re.compile(rf"^{_any('it')}")
_RESTS_AT, _TO_AND_FRO = re.compile(rf"\b{_any('rests at')}\b"), re.compile(rf"^{_any('to and fro')}\b")
_PLACE_FIRST = re.compile(
    r"^(?:directly |diagonally |straight )?(?:at|to|towards?|in|into|below|above|beside|from|(?:left|right|east|west)wards?) |"
    r"(?:up|down|across|over|back) (?:to|at|towards|across|over|the) |the (?:left|right) (?:only|once|twice|\w+ times|a bit)\b"
)
_OWN_PARTS = re.compile(
    r"(?:,? )with (?:the (?:palm|forearm|elbow|fist|finger|hand|arm|wrist|thumb)\b|"
    r"(?:(?:your|their|his|her|its|both|the) )*(?:hands|arms|fists|palms|elbows|forearms) "
    r"(?:(?:held|raised|stretched|straight|lifted) )*(?:up|raised|out|above|overhead|high|in the air|in front|forward|over (?:your|the) head|wide|together)\b)"
)
"""'Clap with your arms up' says where the arms are that clap."""
_RAISED_WITH = re.compile(
    r" with (?:your |the )?(?P<side>(?:left|right) )?(?:hand|arm|fist) (?:(?:held|raised|stretched|straight|lifted) )*"
    r"(?:up|out|high|overhead|raised|over|above|in|to the (?:left|right|front|sides?)|sideways|forward|across|low|at (?:the |your )?(?:hip|shoulder|chest|head|waist|eye) (?:height|level))\b"
)
"""'Signal with your left arm overhead' says where the arm is that signals."""


def are_at_once(a: str, b: str, *, joined: bool = True) -> bool:
    """Whether "a and b" (with `joined`) or "a, b" means both at once: different limbs, and a pose or no verb.

    "nod and clap" is at once as well; "nod, clap" and "clap and bow" are successive.
    """
    moved = limbs_of(a), limbs_of(b)
    if not are_apart(*moved):
        return False
    if set(moved) == {frozenset({"left_arm"}), frozenset({"right_arm"})} or not (
        _VERB_FIRST.match(a) and _VERB_FIRST.match(b)
    ):
        return True
    return joined and (bool(_POSE.match(a)) or not any(_ENDS.search(part) for part in (a, b)))


def is_pose(clause: str) -> bool:
    """Whether a command is a pose, which lasts as long as the simultaneous command."""
    return bool(_POSE.match(clause)) and not _NO_POSE.match(clause)


def are_apart(a: frozenset[str], b: frozenset[str]) -> bool:
    """Whether two commands move different limbs, by the limbs that each names."""
    if not a or not b or a & b - SOME_ARM:
        return False
    return not (a == SOME_ARM == b) and not (a | b >= ARMS | SOME_ARM)


def divided(clause: str) -> list[str]:
    """The simultaneous commands of a clause; a clause with one command gives that command.

    >>> divided("wave with your right hand while nodding")
    ['wave with your right hand', 'nod']
    """
    for pair, asked in _pairs(clause):
        first, second = (imperative(part) for part in pair)
        second = with_verb(second, first)
        a, b = limbs_of(first), limbs_of(second)
        if _OWN_PART.match(second) and a & ARMS and b == SOME_ARM:
            continue
        if _BARE_LIMB.match(first) or _BARE_LIMB.match(second):
            continue
        if not asked and _LISTED.search(pair[0]) and _LISTED_NEXT.match(pair[1]):
            continue
        if _HOLDS.match(second) or (not asked and _RAISES.match(first) and _ONLY_WAVES.match(second)):
            continue
        if a == SOME_ARM and not asked and _WITHOUT_OBJECT.match(first) and _HAND_TO.match(second):
            continue  # "a salute, right hand to the brow" says how
        if a == SOME_ARM == b and (asked or OTHER_HAND.search(second)):
            sides = ("left", "right") if re.search(r"\bleft\b", first) else ("right", "left")
            return (
                [sided(p, side) for p, side in zip((first, second), sides, strict=True)]
                if "hand" in clause
                else [first, second]
            )
        if not are_apart(a, b):
            continue
        if not asked and a | b <= ARMS | SOME_ARM and not (limbs_named(first) and limbs_named(second)):
            continue  # "lift your right hand and swear an oath" is one gesture
        if not asked and _is_one_gesture(first, second):
            continue
        of_limbs = any(ACTS.match(part.strip(" ,.")) for part in pair)  # "drum, your head nodding"
        if (
            not asked
            and not of_limbs
            and not are_at_once(first, second, joined="," not in clause[len(pair[0]) : len(pair[0]) + 2])
        ):
            continue
        return [*divided(freed(first, b)), *divided(there(freed(second, a), first))]
    return [clause]


def goes_on(first: str, second: str) -> bool:
    """Whether two parts are one command: the second returns, acts on the object of the first, or shares its limb."""
    return bool(_SHARES.match(first) or _RETURNS.match(second) or (_TAKES.search(first) and _IT.search(second)))


def _is_one_gesture(first: str, second: str) -> bool:
    """Whether the second part continues the first, moves a part of its arm, or is the act that the first prepares."""
    if goes_on(first, second):
        return True
    a, b = limbs_of(first), limbs_of(second)
    if _PLACE_FIRST.match(second) or (a == SOME_ARM and _WAY_FIRST.match(second)) or _TO_AND_FRO.match(second):
        return True
    if not (a | b <= ARMS | SOME_ARM and SOME_ARM in (a, b)):
        return False
    if _OWN_PART.match(second) or _OWN_PART.match(first):
        return True
    return bool(_PREPARES.match(first)) and not _RESTS_AT.search(first)


def same_limbs(clause: str) -> list[str]:
    """Two commands that a clause requests at once of equal limbs and that must follow each other; else the clause alone."""
    for pair, asked in _pairs(clause):
        first, second = (imperative(part) for part in pair)
        a, b = limbs_named(first), limbs_named(second)
        if asked and a and b and (a & b or ARMS <= (a | b)) and not are_apart(a, b):
            return [first, second]
    return [clause]


def _pairs(clause: str) -> list[tuple[tuple[str, str], bool]]:
    """Divisions of a clause into two parts, each with whether its words state that both are simultaneous."""
    found: list[tuple[tuple[str, str], bool]] = []
    if (lead := _LEADING.match(clause)) or (lead := _WITH_LEADING.match(clause)):
        found.append(((lead["first"], lead["second"]), True))
    for pattern in (_WHILE, _AS_YOU):
        if (m := pattern.search(clause)) and m.start() > 0:
            found.append(((clause[: m.start()], clause[m.end() :]), True))
    if (m := _WITH_POSE.search(clause)) and limbs_named(clause[: m.start()]) and not _is_its_own_arm(clause, m.start()):
        found.append(((clause[: m.start()], m["pose"]), True))
    same = _SAME_TIME.search(clause)
    if same and 0 < same.start() and same.end() < len(clause):
        found.append(((clause[: same.start()], clause[same.end() :]), True))
    rest = _SAME_TIME.sub(" ", clause).strip(" ,") if same else clause
    found += [
        ((rest[: m.start()], rest[m.end() :]), bool(same))
        for m in _AND.finditer(rest)
        if not (_WAY_LAST.search(rest[: m.start()]) and _WAY_FIRST.match(rest[m.end() :]))
    ]
    return [(pair, asked) for pair, asked in found if all(len(p.strip()) > 2 for p in pair)]


def _is_its_own_arm(clause: str, start: int) -> bool:
    """Whether the arm in "... with your left arm overhead" is the arm of the words before, which name no other."""
    raised, moved = _RAISED_WITH.match(clause, start), limbs_of(clause[:start])
    if moved & (ARMS | SOME_ARM) and _OWN_PARTS.match(clause, start):
        return True
    if raised is None or not moved & (ARMS | SOME_ARM):
        return False
    return moved == SOME_ARM or not raised["side"] or f"{raised['side'].strip()}_arm" in moved
