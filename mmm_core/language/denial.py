"""Denials in a text: "clap, but do not bow" -> "clap", denied "bow".

A clause is a denial if it begins with words of denial and continues with an act, a side or a direction; "no idea", "do not worry"
and "do not stop waving" are no denials. A denied side selects the other one: "wave without your left hand" means the right hand.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache

from mmm_core.language import denial_patterns as forms
from mmm_core.language.alternatives import opposite
from mmm_core.language.clause_patterns import SPEAKS_OF_AN_ACT
from mmm_core.language.completed_at_once import base_of
from mmm_core.language.ellipsis import OTHER
from mmm_core.language.known_phrases import is_known_phrase
from mmm_core.language.limbs import SOME_ARM, is_gesture_verb, limbs_of
from mmm_core.language.requests import everyday
from mmm_core.language.word_tables import lines


@dataclass(frozen=True)
class Denial:
    """A text without its denials.

    Attributes:
        rest: requested part of the text; empty where nothing remains.
        denied: denied acts, in the words of the text.
        anything: whether the text requests any other act: "anything but a bow".
    """

    rest: str
    denied: tuple[str, ...] = ()
    anything: bool = False


def without_denial(text: str) -> Denial:  # noqa: PLR0912  one branch for each form of denial
    """The text, in lower case and plain spelling, without what it denies.

    >>> without_denial("clap, but do not bow")
    Denial(rest='clap', denied=('bow',), anything=False)
    """
    if (found := _of_whole_text(text)) is not None:
        return found
    text = forms.ANY_ARM_BUT.sub(lambda m: f" with your {OTHER[m['side']]} hand", text)
    denied: list[str] = []
    text = forms.STOP_AND.sub(r"\1, ", forms.GO_ON.sub(lambda m: f"{m[1] or m[2] or m[3]}, ", text))
    for pattern in (forms.LEAVE, forms.RESTS):
        text = pattern.sub(lambda m: _note(denied, f"the {m['side']} arm") + ", ", text)
    leaves = len(denied)
    side = "" if not leaves else "left" if "left" in denied[-1] else "right"
    text = forms.KEEP_STILL.sub(" ", text).strip(" ,")
    text = _without_opening_denials(text, denied)
    rest: list[str] = []
    anything = False
    parts = forms.BETWEEN.split(text)
    for part in parts:
        clause = part.strip(" ,")
        if not clause:
            continue
        if (forbidden := _forbidden(clause)) and is_denied_act(forbidden):
            denied.append(forbidden)
            continue
        found = None if forms.NO_DENIAL.match(clause) else forms.DENIES.match(clause)
        if found and (what := found["what"].strip(" ,")):
            if only := denied_side(what):
                side = only
                denied.append(what)
                continue
            if _leads_the_other_way(rest, what):
                denied.append(what)
                continue
            if forms.WAVED_ASIDE.match(what) or forms.DIRECTION_ONLY.match(what):
                continue
            if (
                _is_target(what, clause, rest)
                or is_denied_act(what)
                or forms.IN_PLACE_OF.match(clause)
                or forms.SURELY_DENIES.match(clause)
            ):
                anything |= forms.ANYTHING_BUT.search(clause) is not None
                denied.append(re.sub(r"\s+(?:is|are) (?:fine|ok|okay|good).*$", "", what))
                continue
            if forms.SAYS_NOT_TO.match(clause) and any(
                _is_act(p) and not forms.DENIES.match(p) for p in parts if p != part
            ):
                denied.append(what)
                continue
        inline = None if forms.NO_DENIAL.match(clause) else forms.INLINE.search(clause)
        if inline and inline.start() > 0:
            what = inline["what"].strip()
            only = denied_side(what)
            is_denied = (
                only
                or forms.DIRECTION_ONLY.match(what)
                or is_denied_act(what)
                or forms.ALWAYS_DENIES.match(inline["not"])
            )
            if is_denied or (inline["not"].startswith(("but ", "and ")) and forms.PLACE.match(what)):
                side = only or side
                denied.append(what)
                clause = (clause[: inline.start()] + clause[inline.end() :]).strip()
        if not forms.SAYS_NOTHING.fullmatch(clause):
            rest.append(clause)
    rest = _requested(rest) if denied else rest
    if not denied:
        return Denial(text if not rest or leaves else _as_it_was(text, rest))
    return Denial(with_other_side(", ".join(rest), side), tuple(denied), anything)


def _of_whole_text(text: str) -> Denial | None:
    """The denial of a form that takes the whole text; None where there is none."""
    kept = forms.KEEP_DOING.match(text)
    if kept:
        return Denial(kept["rest"] or kept["other"])
    if (turned := opposite(text))[0]:
        return Denial(turned[0], (turned[1],))
    if other := forms.NOT_USING.match(text):
        return Denial(_with_side(other["rest"], OTHER[other["side"]]), (f"use the {other['side']} hand",))
    for form in forms.INSTEAD:
        if (
            (found := form.match(text))
            and is_denied_act(found["what"])
            and (not found["rest"] or is_denied_act(found["rest"]))
        ):
            return Denial(found["rest"], (found["what"],))
    if nothing := forms.CANCELLED.fullmatch(text) or forms.THREATENS.fullmatch(text):
        return Denial("", (nothing["what"],))
    return None


def _forbidden(clause: str) -> str:
    """The act that a clause forbids ("the bow is banned") or sets aside ("save the bow for later"); "" where it does neither."""
    found = forms.FORBIDDEN.match(clause) or forms.SET_ASIDE.match(clause)
    return next(filter(None, found.groups()), "") if found else ""


def denied_side(what: str) -> str:
    """The side that a denial of nothing but a side names ("the left hand", "use your right one"); "" for any other."""
    only = forms.SIDE_ONLY.match(what)
    return only["side"] if only else ""


def with_other_side(command: str, denied: str) -> str:
    """A command that takes an arm and names no side, completed with the hand that is not denied ("left", "right" or "")."""
    if not denied or not command or forms.HAS_SIDE.search(command) or limbs_of(command) - SOME_ARM:
        return command
    return _with_side(command, OTHER[denied])


def _without_opening_denials(text: str, denied: list[str]) -> str:
    """The text without a denial that it begins with: "instead of waving, bow". The denied words are added to `denied`."""
    for pattern in (
        forms.ONE_HAND_FOR_THE_OTHER,
        forms.GERUND_CLAUSE,
        forms.GERUND_FIRST,
        forms.NOT_A_BUT_B,
        forms.NOT_THIS_BUT_THAT,
        forms.IN_PLACE_FIRST,
        forms.NOT_THAT_PART,
    ):
        found = pattern.match(text)
        if found and (
            pattern is forms.NOT_THAT_PART or forms.IN_PLACE_OF.match(found[0]) or is_denied_act(found["what"])
        ):
            denied.append(found["what"].strip())
            text = found["rest"] if "rest" in pattern.groupindex else text[found.end() :]
            if limb := re.search(r"\b(hand|arm|fist|leg|shoulder|ear|eye|elbow|knee|cheek|wrist|hip)\b", found["what"]):
                text = re.sub(r"\b(left|right) one\b", rf"\1 {limb[0]}", text)
    return text


def _as_it_was(text: str, rest: list[str]) -> str:
    """The text; without its clauses that were waved aside, where there were some."""
    n = sum(bool(clause.strip(" ,")) for clause in forms.BETWEEN.split(text))
    return text if n == len(rest) else ", ".join(rest)


def _requested(clauses: list[str]) -> list[str]:
    """The clauses beside a denial that ask for something: without repetitions, reasons and names."""
    offered = [_offered(clause) for clause in clauses]
    return [
        clause
        for i, clause in enumerate(offered)
        if not (_is_said_again(clause, offered[:i]) or _is_statement(clause) or _is_name(clause))
    ]


def _offered(clause: str) -> str:
    """The act of a clause that offers it instead of what is denied: "guitar" of "I said guitar"; any other clause as it is."""
    found = forms.OFFERED.match(clause)
    act = (found["act"] or found["it"]) if found else ""
    return act if act and is_denied_act(act) else clause


def _is_said_again(clause: str, before: list[str]) -> bool:
    """Whether an earlier clause contains this clause: "hammer" after "hammer with the left hand"."""
    return any(set(clause.split()) <= set(earlier.split()) for earlier in before)


def _is_statement(clause: str) -> bool:
    """Whether a clause beside a denial is its reason: "don't clap yet, the teacher is still talking"."""
    return forms.STATES.search(clause) is not None and not _is_act(clause)


def _is_name(clause: str) -> bool:
    """Whether a clause beside a denial is a single word that the corpus does not know: "don't wave, Liam"."""
    return " " not in clause and not all(word in _corpus_words() for word in clause.split("-"))


@cache
def _corpus_words() -> frozenset[str]:
    return frozenset(lines("corpus_words"))


def _leads_the_other_way(rest: list[str], what: str) -> bool:
    """Give the last clause the side opposite to the denied one, if it names none: "turn your head, but not to the left"."""
    way = forms.SIDEWAYS.fullmatch(what)
    if way is None or not rest or forms.HAS_SIDE.search(rest[-1]):
        return False
    rest[-1] = f"{rest[-1]} to the {OTHER[way['side']]}"
    return True


def _is_target(what: str, clause: str, rest: list[str]) -> bool:
    """Whether a denial is about where to, not about an act: "point, but not at me"; "look at me, not at the floor"."""
    if not rest or not forms.PLACE.match(what):
        return False
    return clause.startswith(("but not ", "and not ")) or f" {what.partition(' ')[0]} " in rest[-1]


def _note(denied: list[str], what: str) -> str:
    denied.append(what)
    return ""


def surely_denies(text: str) -> bool:
    """Whether a text begins with words that deny all that follows: "under no circumstances"."""
    return forms.SURELY_DENIES.match(text.lower()) is not None


def names_an_act(text: str) -> bool:
    """Whether any of its words is an act that a command may ask for, the noun of one, or a limb: "a small wave", "left hand up"."""
    words = text.split()
    return bool(limbs_of(text)) or any(is_denied_act(" ".join(words[i:])) for i in range(len(words)))


def _is_act(what: str) -> bool:
    named = SPEAKS_OF_AN_ACT.search(what) or forms.ACTS_ALSO.search(what) or everyday(what) or is_known_phrase(what)
    return bool(named or is_gesture_verb(base_of(what.partition(" ")[0])))


def is_denied_act(what: str) -> bool:
    """Whether words after a denial are an act, or the noun of one: "no guitar"."""
    return _is_act(what) or forms.NOUN_OF_AN_ACT.match(what) is not None


def _with_side(clause: str, side: str) -> str:
    """A clause without a side, completed with the hand of `side`."""
    named, n = re.subn(r"\b(your|the|a|an|one) (hand|arm|fist)\b", rf"your {side} \2", clause, count=1)
    return named if n else f"{clause} with your {side} hand"
