"""Denials in a text: "clap, but do not bow" -> "clap", denied "bow".

A clause is a denial if it begins with words of denial and continues with an act, a side or a direction; "no idea", "do not worry" and
"do not stop waving" are no denials. A denied side selects the other one: "wave without your left hand" means the right hand.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import partial

from mmm_core.language.alternatives import opposite
from mmm_core.language.clause_patterns import SPEAKS_OF_AN_ACT
from mmm_core.language.completed_at_once import base_of
from mmm_core.language.ellipsis import OTHER
from mmm_core.language.known_phrases import is_known_phrase
from mmm_core.language.limbs import SOME_ARM, is_gesture_verb, limbs_of
from mmm_core.language.requests import everyday
from mmm_core.language.word_tables import any_of

_any = partial(any_of, "denial")
_DENIES = re.compile(rf"^\W*(?:{_any('before')} )*(?:please )?{_any('not')} (?P<what>.+)$")
_BETWEEN = re.compile(
    r"\s*(?:,\s*(?:and |but )?instead\b,?|[,;:.!?]+(?=\s|$)|\s-+\s|\bbut(?= )(?! (?:not|no)\b)(?<!anything but)(?<!everything but)(?<!\bnothing but)(?<!\ball but)"
    r"|\binstead,? (?!of\b)|\binstead$)\s*"
)
_INLINE = re.compile(rf"\s*,?\s*\b(?P<not>{_any('inline')})\s+(?P<what>[^,;:.!]+)")
_GERUND_FIRST = re.compile(
    r"^\W*(?:instead of|rather than|without) (?P<what>(?:\w+ing)(?: (?:your|the|at|to|with) \w+(?: \w+)?)?|(?:a|an) \w+),? (?=\w)"
)
_ANYTHING_BUT = re.compile(
    r"\b(?:anything|everything|whatever(?: \w+){0,2}) (?:but|except(?: for)?|other than|besides|apart from)\b"
)
_IN_PLACE_OF = re.compile(r"^\W*(?:instead of|rather than|as opposed to|in place of)\b|^not .+, but\b")
"""Words of contrast, after which even what is no act is not to be done: "wave instead of just standing there"."""
_PLACE = re.compile(
    r"(?:at|to|towards|with|on|over|above|behind|near|for) (?:(?!your (?:left|right)\b|the (?:left|right)\b)\w+ ?){1,3}$"
)
"""A target that is denied: "point, but not at me"."""
_ALWAYS_DENIES = re.compile(rf"{_IN_PLACE_OF.pattern}|without (?:moving|using)$|except(?: for)?(?: with)?$")
_GERUND_CLAUSE = re.compile(r"^\W*(?:instead of|rather than|without|no) (?P<what>\w+ing\b[^,;:.]*), (?P<rest>\w.+)$")
_ONE_HAND_FOR_THE_OTHER = re.compile(
    r"^\W*(?:instead of|rather than|in place of) (?P<what>(?:using )?(?:the|your) (?:left|right)(?: hand| arm)?),? (?P<rest>(?:use|with|take|using)\b.+)$"
)
_NOT_A_BUT_B = re.compile(
    r"^\W*not (?!only\b)(?P<what>(?:an?|the|your|with|to)? ?[^,;]+?),? but (?:rather |instead )?(?P<rest>.+)$"
)
_NOT_THAT_PART = re.compile(
    r"^\W*not (?P<what>(?:with )?(?:the|your) (?:left|right) (?:hand|arm|shoulder|ear|eye|elbow|knee|cheek|wrist|hip)),? (?P<rest>(?!but\b).*\b(?:left|right) one\b.*)$"
)
_SIDE_ONLY = re.compile(
    rf"^(?:{_any('side verb')}\s+)?(?:your |the |that |my )?(?P<side>left|right)(?: (?:hand|arm|one|side|fist|palm|shoulder|ear|eye|elbow|knee|cheek|wrist))?"
    r"(?: (?:this time|at all|alone|though|please|either|now))?$"
)
_LEAVE = re.compile(
    r"(?:,?\s*(?:and|but|while)\s+)?\b(?:leave|keep|leaving|keeping|let)\s+(?:your |the )?(?P<side>left|right) (?:hand|arm|one)\s+"
    rf"{_any('left alone')}\b,?\s*(?:and\s+)?"
)
_RESTS = re.compile(
    rf"(?:,?\s*(?:and|but|while)\s+)?\b(?:your |the )(?P<side>left|right) (?:hand|arm) {_any('rests')}"
    r"(?=\s*(?:$|,|;|and\b|while\b)),?\s*(?:(?:and|while)\s+)?"
)
"""'The left hand rests, wave with the right.'"""
_KEEP_STILL = re.compile(
    r"(?:,?\s*(?:and|but|while)\s+)?\b(?:keep|keeping|leave|leaving|hold|holding)\s+(?:your |the )?"
    rf"{_any('kept')}\s+(?:{_any('how still')} )?{_any('kept still')},?\s*(?:and\s+)?"
    rf"|(?:,?\s*(?:and|but|while)\s+|,\s*)(?:your |the )?(?:{_any('kept')}|(?:left |right )?(?:arm|hand))\s+(?:"
    r"(?:(?:do|does|should|must|shall|will|may) not|never) (?:to )?(?:move|stir|budge|take part|join in)\b(?: at all)?"
    rf"|(?:stays?|remains?|(?:is|are) (?:kept|held|to stay)) (?:{_any('how still')} )?(?:still|motionless|put|in place|where (?:it is|they are))(?=$|[,.;])),?"
)
_DIRECTION_ONLY = re.compile(
    r"^(?:to |at |on )?(?:the |your )?(?:up|down|left|right|forward|forwards|back|backward|backwards)(?: side)?$"
)
_SIDEWAYS = re.compile(r"(?:to |at |on )?(?:the |your )?(?P<side>left|right)(?: side)?")
_WAVED_ASIDE = re.compile(rf"^{_any('waved aside')}$")
_NO_DENIAL = re.compile(rf"^\W*{_any('no denial')}")
_KEEP_DOING = re.compile(
    r"^\W*(?:please )?(?:do not|never) stop (?P<rest>\w.+)$|^\W*(?:please )?do not (?:forget|hesitate) to (?P<other>.+)$"
)
_ACTS_ALSO = re.compile(rf"\b{_any('act')}\w*")
_NOT_USING = re.compile(
    r"^\W*(?:please )?(?:do not|never) (?:use|take) (?:your |the )?(?P<side>left|right) (?:hand|arm|one) (?:to|for|when|and) (?P<rest>\w.+)$"
)
_GO_ON = re.compile(
    r"^(\W*(?:skip|forget|leave out|never mind|instead of|rather than) [^,]+?),? and (?:go (?:straight|right|directly) (?:to|on to|for)|just|do|give me|instead) "
    r"|^(\W*(?:skip|forget|leave out|never mind|ditch|scrap|bin|lose|nix|axe|forgo) (?:the|your|that) \w+),? and (?!(?:the|an?|your|no|any|not|all)\b)"
)
_STOP_AND = re.compile(
    r"^(\W*(?:please )?(?:stop|quit) \w+ing\b[^,]*?),? and (?!\w+ing\b|(?:left|right|up|down|back|forth|forwards?|out|round)\b|(?:your |the |both |left |right )*(?:hands?|arms?|head|fingers?|fists?|shoulders?)$)(?=\w+ \w)"
)
"""'Stop waving and clap your hands' asks for the second; 'stop waving and clapping' for neither."""
_SAYS_NOT_TO = re.compile(
    rf"^\W*(?:{_any('before')} )*(?:please )?(?:(?:do not|never) (?!(?:mind|rush|hurry|forget|stop|hesitate|worry)\b)\w|(?:stop|no|quit|avoid) \w+ing\b)"
)
"""A clause that asks for nothing, whatever it names: "do not warble on the recorder"."""
_STATES = re.compile(r"^(?!to )\S.*?(?:\b(?:is|are|was|were|am|has|have|had|does|did)\b|'s\b|'re\b)")
"""A finite verb behind a subject."""
_CANCELLED = re.compile(
    r"(?P<what>.+?)(?:[,.;!?]+|(?= (?:but|no|oh|ah|actually|wait|hmm)\b)) (?:(?:but|no|oh|ah|actually|wait|hmm|on second thoughts?)[, ]+)*"
    r"(?:never ?mind|forget (?:it|that|about it)|scrap that|cancel that)(?:[, ]+(?:forget it|never ?mind|thanks?|thank you|sorry|then|now|it is fine))*\W*"
)
"""A text that ends by taking all of it back."""
_THREATENS = re.compile(
    r"if (?:you|i (?:see|catch) you) (?P<what>(?=.*\b(?:again|one more|once more|another)\b).+?) (?:i|we|there|he|she|they|somebody)\b.*"
)
"""'If you bow once more I shall scream.'"""
_FORBIDDEN = re.compile(
    r"^(?P<what>.+?) (?:is|are|has been|have been) (?:banned|forbidden|not allowed(?! to)|off limits|off the table|cancelled|prohibited|out of the question)\b.*$"
)
_ANY_ARM_BUT = re.compile(
    r",? (?:with|using) (?:whichever|whatever|any|either) (?:hand|arm|one)(?: you (?:like|want|fancy|please|prefer))?,? "
    r"(?:(?:so|as|just as) long as it is not|but|except|other than) (?:the|your) (?P<side>left|right)(?: one| hand| arm)?"
)
_HAS_SIDE = re.compile(r"\b(?:left|right|both)\b")


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
    text = _ANY_ARM_BUT.sub(lambda m: f" with your {OTHER[m['side']]} hand", text)
    denied: list[str] = []
    text = _STOP_AND.sub(r"\1, ", _GO_ON.sub(lambda m: f"{m[1] or m[2]}, ", text))
    for pattern in (_LEAVE, _RESTS):
        text = pattern.sub(lambda m: _note(denied, f"the {m['side']} arm") + ", ", text)
    leaves = len(denied)
    side = "" if not leaves else "left" if "left" in denied[-1] else "right"
    text = _KEEP_STILL.sub(" ", text).strip(" ,")
    text = _without_opening_denials(text, denied)
    rest: list[str] = []
    anything = False
    parts = _BETWEEN.split(text)
    for part in parts:
        clause = part.strip(" ,")
        if not clause:
            continue
        if (forbidden := _FORBIDDEN.match(clause)) and _is_act(forbidden["what"]):
            denied.append(forbidden["what"])
            continue
        found = None if _NO_DENIAL.match(clause) else _DENIES.match(clause)
        if found and (what := found["what"].strip(" ,")):
            if only := denied_side(what):
                side = only
                denied.append(what)
                continue
            if _leads_the_other_way(rest, what):
                denied.append(what)
                continue
            if _WAVED_ASIDE.match(what) or _DIRECTION_ONLY.match(what):
                continue
            if _is_target(what, clause, rest) or _is_act(what) or _IN_PLACE_OF.match(clause):
                anything |= _ANYTHING_BUT.search(clause) is not None
                denied.append(re.sub(r"\s+(?:is|are) (?:fine|ok|okay|good).*$", "", what))
                continue
            if _SAYS_NOT_TO.match(clause) and any(_is_act(p) and not _DENIES.match(p) for p in parts if p != part):
                denied.append(what)
                continue
        inline = None if _NO_DENIAL.match(clause) else _INLINE.search(clause)
        if inline and inline.start() > 0:
            what = inline["what"].strip()
            only = denied_side(what)
            is_denied = only or _DIRECTION_ONLY.match(what) or _is_act(what) or _ALWAYS_DENIES.match(inline["not"])
            if is_denied or (inline["not"].startswith(("but ", "and ")) and _PLACE.match(what)):
                side = only or side
                denied.append(what)
                clause = (clause[: inline.start()] + clause[inline.end() :]).strip()
        if not re.fullmatch(
            r"(?:the|use the|with the|use) (?:other|opposite)(?: one| hand| arm| way| side| direction)?|instead|(?:and |but )?that is it|"
            r"(?:(?:lord|god|goodness|dear) )?(?:no|oh|hey|well|ok|please)(?:,? (?:no|please|sorry))*|(?:will|would|can|could) you|silly|got it|thanks?|not (?:another|one more|a single) \w+(?: \w+){0,4}",
            clause,
        ):
            rest.append(clause)
    rest = [
        clause
        for i, clause in enumerate(rest)
        if not (denied and (_is_said_again(clause, rest[:i]) or _is_statement(clause)))
    ]
    if not denied:
        return Denial(text if not rest or leaves else _as_it_was(text, rest))
    return Denial(with_other_side(", ".join(rest), side), tuple(denied), anything)


def _of_whole_text(text: str) -> Denial | None:
    """The denial of a form that takes the whole text; None where there is none."""
    kept = _KEEP_DOING.match(text)
    if kept:
        return Denial(kept["rest"] or kept["other"])
    if (turned := opposite(text))[0]:
        return Denial(turned[0], (turned[1],))
    if other := _NOT_USING.match(text):
        return Denial(_with_side(other["rest"], OTHER[other["side"]]), (f"use the {other['side']} hand",))
    if nothing := _CANCELLED.fullmatch(text) or _THREATENS.fullmatch(text):
        return Denial("", (nothing["what"],))
    return None


def denied_side(what: str) -> str:
    """The side that a denial of nothing but a side names ("the left hand", "use your right one"); "" for any other."""
    only = _SIDE_ONLY.match(what)
    return only["side"] if only else ""


def with_other_side(command: str, denied: str) -> str:
    """A command that takes an arm and names no side, completed with the hand that is not denied ("left", "right" or "")."""
    if not denied or not command or _HAS_SIDE.search(command) or limbs_of(command) - SOME_ARM:
        return command
    return _with_side(command, OTHER[denied])


def _without_opening_denials(text: str, denied: list[str]) -> str:
    """The text without a denial that it begins with: "instead of waving, bow". The denied words are added to `denied`."""
    for pattern in (_ONE_HAND_FOR_THE_OTHER, _GERUND_CLAUSE, _GERUND_FIRST, _NOT_A_BUT_B, _NOT_THAT_PART):
        found = pattern.match(text)
        if found and (pattern is _NOT_THAT_PART or _IN_PLACE_OF.match(found[0]) or _is_act(found["what"])):
            denied.append(found["what"].strip())
            text = found["rest"] if "rest" in pattern.groupindex else text[found.end() :]
            if limb := re.search(r"\b(hand|arm|fist|leg|shoulder|ear|eye|elbow|knee|cheek|wrist|hip)\b", found["what"]):
                text = re.sub(r"\b(left|right) one\b", rf"\1 {limb[0]}", text)
    return text


def _as_it_was(text: str, rest: list[str]) -> str:
    """The text; without its clauses that were waved aside, where there were some."""
    n = sum(bool(clause.strip(" ,")) for clause in _BETWEEN.split(text))
    return text if n == len(rest) else ", ".join(rest)


def _is_said_again(clause: str, before: list[str]) -> bool:
    """Whether an earlier clause contains this clause: "hammer" after "hammer with the left hand"."""
    return any(set(clause.split()) <= set(earlier.split()) for earlier in before)


def _is_statement(clause: str) -> bool:
    """Whether a clause beside a denial is its reason: "don't clap yet, the teacher is still talking"."""
    return _STATES.search(clause) is not None and not _is_act(clause)


def _leads_the_other_way(rest: list[str], what: str) -> bool:
    """Give the last clause the side opposite to the denied one, if it names none: "turn your head, but not to the left"."""
    way = _SIDEWAYS.fullmatch(what)
    if way is None or not rest or _HAS_SIDE.search(rest[-1]):
        return False
    rest[-1] = f"{rest[-1]} to the {OTHER[way['side']]}"
    return True


def _is_target(what: str, clause: str, rest: list[str]) -> bool:
    """Whether a denial is about where to, not about an act: "point, but not at me"; "look at me, not at the floor"."""
    if not rest or not _PLACE.match(what):
        return False
    return clause.startswith(("but not ", "and not ")) or f" {what.partition(' ')[0]} " in rest[-1]


def _note(denied: list[str], what: str) -> str:
    denied.append(what)
    return ""


def _is_act(what: str) -> bool:
    named = SPEAKS_OF_AN_ACT.search(what) or _ACTS_ALSO.search(what) or everyday(what) or is_known_phrase(what)
    return bool(named or is_gesture_verb(base_of(what.partition(" ")[0])))


def _with_side(clause: str, side: str) -> str:
    """A clause without a side, completed with the hand of `side`."""
    named, n = re.subn(r"\b(your|the|a|an|one) (hand|arm|fist)\b", rf"your {side} \2", clause, count=1)
    return named if n else f"{clause} with your {side} hand"
