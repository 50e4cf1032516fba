"""Reads a sentence: plain commands in order and at once, each with its parameters, in words that the model knows.

This file fixes the order of the steps: correct spelling (`spelling`), remove the words around the request (`requests`), separate
denials (`denial`), divide commands in order (`clauses`) and complete them (`ellipsis`), divide commands at once (`at_once`), and
read manner (`manner`). A sentence without any of these is passed on unchanged. Rules and figures: docs/language.md.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

from mmm_core.language.alternatives import anything_but, otherwise
from mmm_core.language.at_once import divided, same_limbs
from mmm_core.language.clause_patterns import SPEAKS_OF_AN_ACT
from mmm_core.language.clauses import MOST_WORDS, commands_in_turn
from mmm_core.language.commands import MOST_AT_ONCE, MOST_STEPS, PlainCommand, Reading, read_exactly
from mmm_core.language.completed_at_once import base_of
from mmm_core.language.contrasts import contrasted
from mmm_core.language.corrections import corrected
from mmm_core.language.denial import Denial, names_an_act, without_denial
from mmm_core.language.denial_patterns import SOMETHING_ELSE
from mmm_core.language.each import each_done, without_number_of_each
from mmm_core.language.ellipsis import completed, with_sides
from mmm_core.language.limbs import SOME_ARM, limbs_of
from mmm_core.language.manner import Manner, manner_of
from mmm_core.language.one_arm import of_one_arm, with_hand_named_after
from mmm_core.language.one_gesture import as_said, held_together
from mmm_core.language.one_thing import of_one_thing
from mmm_core.language.positions import in_said_order
from mmm_core.language.requests import everyday, greeting, restated, rewritten, without_request
from mmm_core.language.run_on import with_marks
from mmm_core.language.spelling import mended, normalised
from mmm_core.language.stop_words import after_a_stop, before_a_stop
from mmm_core.language.word_tables import REMEMBERED

_PAST = re.compile(r"^(?!(?:raised|stretched|crossed|folded|extended|red)\b (?:hand|arm|fist)s?\b)(?!\w*eed\b)\w+ed\b")
"""The verb of "once you have clapped", "if you crossed"."""
_DO_IT = re.compile(
    r"(?:go ahead and )?(?:do (?:it|that|so|this)|prove it|show (?:me|us|him|her|them|everybody|it))"
    r"(?P<how> with (?:your|the) (?:left|right) (?:hand|arm))?(?: too| as well| also| now)*\W*"
)
_NOT_AT_ALL = re.compile(r"(?:so |but |please |just )*do not(?: (?:do|try) (?:it|that|this|so))?(?: please)?\W*")
"""A request that denies an act named before it: "i know you would like to clap, but please don't"."""
_ANYTHING = re.compile(r"(?:do )?(?:anything|a thing)(?: at all| now)?")
"""A denial of everything, beside which a statement is only a reason: "don't do anything, he is taking a picture"."""
_STATES = re.compile(
    r"(?:(?:he|she|they|we|i|it)(?:'s|'re|'m| is| are| am)|(?:(?:the|my|our|her|his|their|a) )?\w+(?: \w+)? (?:is|are|was)) (?!to\b)"
)
"""The beginning of a statement: "grandpa is just taking a picture"."""
_LIMB_OF_ALL = re.compile(
    r"(?P<limb>(?:your |the )?(?:(?:left|right|both) )?(?:arms?|hands?|head|body)): (?P<parts>.+)$"
)
_OWN_PART = re.compile(
    r"\byour (?:(?:left|right) )?(?:hand|arm|head|nose|ear|eye|chin|cheek|shoulder|elbow|belly|hair|back|chest|forehead|mouth|face|neck|brow)s?\b"
)
_ONE_OF_THEM = re.compile(
    r"\b(?P<verb>blow|give|show|throw|do|take|make)(?: (?:me|us|him|her|them))? one(?= too| as well| now|[.,!?]|$)"
)
"""A noun that was said before with the same verb: "he used to blow me a kiss, so please blow me one"."""
_ACT_ON_IT = re.compile(r"((?!do\b)\w+) (?:it|them)\b(?: (?:away|off)\b)?")
"""A part of the robot that a sentence names before a pronoun stands for it: "there is a fly on your nose, scratch it"."""


@lru_cache(maxsize=REMEMBERED)
def read(text: str, *, by_rules_alone: bool = False) -> Reading:
    """The commands of a sentence.

    Args:
        text: the sentence.
        by_rules_alone: whether phrases that only the corpus shows to be one gesture (`one_gesture`) are divided as well.

    >>> [[c.text for c in step] for step in read("turn your head left, then right").steps]
    [['turn your head left'], ['turn your head right']]
    """
    if (exact := read_exactly(text)) is not None:
        return exact
    if len(text.split(None, MOST_WORDS)) > MOST_WORDS:
        return Reading(text, ((PlainCommand(text),),), plain=True)
    said = contrasted(before_a_stop(after_a_stop(mended(text))))
    if known := everyday(said) or greeting(said):
        return _known(text, known)
    held = said if by_rules_alone else held_together(said)
    bare = in_said_order(without_request(held))
    if known := everyday(bare) or greeting(bare):
        return _known(text, known)
    bare, first_hand = _hand_first(restated(corrected(_referring(with_marks(bare), held))))
    if _NOT_AT_ALL.fullmatch(bare):
        return Reading(text, (), ("that",))
    denial = without_denial(rewritten(bare))
    if denial.denied and not denial.rest and not denial.anything:
        return Reading(text, (), _shown(denial.denied))
    if any(map(_ANYTHING.fullmatch, denial.denied)) and (_STATES.match(denial.rest) or not names_an_act(denial.rest)):
        return Reading(text, (), _shown(denial.denied))
    if (denial.anything and not denial.rest) or (denial.denied and SOMETHING_ELSE.fullmatch(denial.rest)):
        return Reading(text, ((command_of(anything_but(denial.denied)),),), _shown(denial.denied))
    rest = (
        _of_denied_limb(rewritten(everyday(denial.rest) or without_request(denial.rest)), denial)
        if denial.denied
        else denial.rest
    )
    steps: list[tuple[PlainCommand, ...]] = []
    notes: list[str] = []
    rest, times = without_number_of_each(rest)
    rest, hand = _for_all(rest)
    hand = hand or first_hand
    rest = rest if hand else with_hand_named_after(rest)
    clauses = of_one_arm(commands_in_turn(of_one_thing(with_sides(rest))))
    if len(clauses) > MOST_STEPS:
        return Reading(text, (), too_many=len(clauses))
    for clause in clauses:
        steps += _steps(clause + hand if hand and limbs_of(clause) == SOME_ARM else clause, notes)
    steps = each_done(steps, times)
    if _is_plain(text, said, steps):
        return Reading(text, ((replace(steps[0][0], text=normalised(text)),),), plain=True)
    if denial.denied:
        steps = _without_what_is_denied([tuple(_not_denied(c, denial) for c in step) for step in steps], denial.denied)
    return Reading(text, tuple(steps), _shown(denial.denied), tuple(notes))


def _without_what_is_denied(
    steps: list[tuple[PlainCommand, ...]], denied: Sequence[str]
) -> list[tuple[PlainCommand, ...]]:
    """Steps without commands that are denied in the same words: "wave, no, not wave, bow"; unchanged where nothing remains."""
    kept = [tuple(c for c in step if c.text not in denied) for step in steps]
    return [step for step in kept if step] or steps


def _not_denied(command: PlainCommand, denial: Denial) -> PlainCommand:
    """A command that shows the same without a denied act: a bow for "say hello without waving"."""
    words = otherwise(command.text, denial.rest, denial.denied)
    return command if words == command.text else replace(command, text=words, limbs=limbs_of(words))


def _of_denied_limb(rest: str, denial: Denial) -> str:
    """The requested part with the limb of the denial for its pronoun: "don't cross your arms, put them on your hips"."""
    if _ACT_ON_IT.match(rest) is None or _OWN_PART.search(denial.denied[-1]) is None:
        return rest
    return completed(rest, denial.denied[-1]) or rest


def _shown(denied: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(as_said(what) for what in denied)


def _referring(bare: str, said: str) -> str:
    """A request with the referent from the words before it: "that way" for a side, "do it" for an act that somebody cannot do."""
    before = said.rpartition(bare)[0] if bare else said
    side = re.search(r"\b(?:on|to|from|by) (?:your|the) (left|right)\b(?! (?:hand|arm))", before)
    if side and re.search(r"\b(?:that way|over there|in that direction)\b", bare):
        return re.sub(r"\b(?:that way|over there|in that direction)\b", f"to the {side[1]}", bare, count=1)
    part = _OWN_PART.search(before)
    if part is not None and (pronoun := _ACT_ON_IT.match(bare)):
        return f"{pronoun[1]} {part[0]}{bare[pronoun.end() :]}"
    if one := _ONE_OF_THEM.search(bare):
        named = re.search(rf"\b{one['verb']}(?:s|ing)?(?: (?:me|us|him|her|them|you))? (?P<noun>an? \w+)", before)
        return bare if named is None else f"{bare[: one.end('verb')]} {named['noun']}{bare[one.end() :]}"
    act = re.search(
        r"\b(?:can not|can|could|cannot|how to|how you|whether you|if you|"
        r"(?:people|everybody|everyone|others|they|we|one)(?: (?:usually|always|often|all|mostly|normally|generally|would))+) ((?:never |ever )?\w+.*?)(?=,|\.|$)",
        before,
    )
    again = _DO_IT.fullmatch(bare)
    if act and again and SPEAKS_OF_AN_ACT.match(act[1]):
        return act[1] + (again["how"] or "")
    return bare


def _known(text: str, command: str) -> Reading:
    """The reading of an everyday phrase."""
    return Reading(text, ((PlainCommand(command, Manner(), limbs_of(command)),),))


def _hand_first(said: str) -> tuple[str, str]:
    """A sentence without the hand named at its beginning for all commands, and that hand: "with your right arm first point up"."""
    listed = _LIMB_OF_ALL.match(said)
    if listed is not None:
        parts = re.split(r",?\s+(?:and|then)\s+|,\s*", listed["parts"])
        sided = [re.match(r"(left|right)(?: one| (?:arm|hand))? (.+)", part) for part in parts if part]
        if len(sided) > 1 and all(sided):
            limb = "hand" if "hand" in listed["limb"] else "arm"
            return ", ".join(f"{m[1]} {limb} {m[2]}" for m in sided if m), ""
        return ", then ".join(f"{listed['limb']} {part}" for part in parts if part), ""
    found = re.match(
        r"(?:with|using|use) (?:your |the )?(left|right)(?: (?:hand|arm)[:,]?|(?: one)?[:,]) (?:first |to )?"
        r"(?!(?:stretched|raised|held|extended|crossed|folded|lifted|placed|bent|straight|out|up|on|over|behind|against|in|at|down)\b)(?P<rest>.+)$",
        said,
    )
    rest = found["rest"] if found else ""
    if (
        found is None
        or not re.search(r"\b(?:then|afterwards|after that|next|finally)\b|,", rest)
        or re.search(r"\b(?:left|right|other) (?:hand|arm|one)\b|\bthe other\b|\bnot\b", rest)
    ):
        return said, ""
    verbs = "raise|lift|put|lower|drop|stretch|swing|bend|hold|let|move|bring|wave"
    return re.sub(rf"\b({verbs}) it\b", rf"\1 your {found[1]} arm", rest), f" with your {found[1]} hand"


def _for_all(said: str) -> tuple[str, str]:
    """A sentence without the hand named at its end for all commands, and that hand: "..., both with the right hand"."""
    found = re.search(
        r",? (?:both|all)(?: of (?:it|them|that))? (?:with|using) (?:your |the )?(left|right) hand$", said
    )
    return (said[: found.start()], f" with your {found[1]} hand") if found else (said, "")


def _steps(clause: str, notes: list[str]) -> list[tuple[PlainCommand, ...]]:
    """The steps of one clause: commands at once, or in order where they need the same limb."""
    clause = without_request(clause)
    at_once = divided(clause)
    if 1 < len(at_once) <= MOST_AT_ONCE:
        return [tuple(command_of(c) for c in at_once)]
    follow = same_limbs(clause)
    if len(follow) > 1:
        notes.append(f"'{follow[0]}' and '{follow[1]}' move the same limb, so one follows the other")
        return [(command_of(c),) for c in follow]
    return [(command_of(clause),)]


def command_of(clause: str) -> PlainCommand:
    """A clause as one command, with its manner."""
    rest, manner = manner_of(clause)
    bare = _PAST.sub(lambda m: base_of(m[0]), without_request(rest))
    words = rewritten(everyday(bare) or bare)
    if manner.plain and words != bare:
        words, manner = manner_of(words)
    words = as_said(words)
    return PlainCommand(words, manner, limbs_of(words))


def _is_plain(text: str, said: str, steps: list[tuple[PlainCommand, ...]]) -> bool:
    """Whether the only command equals the sentence, apart from case and final punctuation."""
    if len(steps) != 1 or len(steps[0]) != 1 or not steps[0][0].manner.plain:
        return False
    return _letters(steps[0][0].text) == _letters(said) == _letters(text)


def _letters(text: str) -> str:
    return re.sub(r"[^a-z0-9]+", " ", text.lower()).strip()
