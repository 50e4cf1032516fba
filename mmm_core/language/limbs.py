"""Limbs that the words of a command move.

`words/limb_phrases.txt` has words and phrases that decide a limb, `words/limb_words.txt` verbs and nouns of the corpus's gestures.
"""

from __future__ import annotations

import re
from functools import cache, partial

from mmm_core.language.clause_patterns import BEGINS_WITH_A_VERB
from mmm_core.language.word_tables import LIMB, any_of, pairs, phrases

ARMS = frozenset({"left_arm", "right_arm"})
HEAD, TRUNK = frozenset({"head"}), frozenset({"trunk"})
SOME_ARM = frozenset({"some_arm"})
"""One arm, whichever is free."""
_phrases, _any = partial(phrases, "limb_phrases"), partial(any_of, "limb_phrases")
_ARM_SIDE = re.compile("|".join(_phrases("side")))
_BOTH, _ARM = re.compile(rf"\b{_any('both')}"), re.compile(rf"\b{_any('arm')}")
_HEAD = re.compile(
    rf"\b{_any('head verb')}|^(?:\w+ )?{_any('head moved')} (?:your |the )?{_any('head part')}\b|"
    rf"^(?:your |the )?{_any('head first')}\b|\b(?:your|the) head {_any('head is')}"
)
_HEAD_NOT = re.compile(
    r"\b(?:look|looking|glanc\w*|gaz\w*|peer\w*|peek\w*|star\w+) (?:at|on|through|to|down at) "
    rf"(?:the time\b|(?:your |the |a )?(?:\w+ )?{_any('looks at')}\b)"
)
_TRUNK = re.compile(rf"\b{_any('trunk')}")
_TRUNK_NOT = re.compile(
    rf"\b(?:{_any('draws a bow')}\w* (?:back |off |with )?(?:an? |the |your )?(?:\w+ )?bow\b|{_any('no trunk')})"
)
_A_LIMB, _NAMED_LIMB = re.compile(rf"\b{LIMB}\b"), re.compile(rf"\b(?:left|right|your|both|the) {LIMB}\b")
SAYS_NO_LIMB = frozenset(_phrases("says no limb"))
"""Words that decide no limb, whatever gestures of the corpus have them."""
_BEGINS_NO_GESTURE = frozenset(_phrases("begins no gesture"))
"""Words with which a place begins, or an act that moves neither arms, head nor trunk."""
_WORDS = re.compile(r"[a-z]+")
_HEAD_PLACE = re.compile(r"\b(?:your|the) (?:head|chin|neck|nose|gaze|eyes|face|skull|crown)\b")
_TRUNK_PLACE = re.compile(r"\b(?:your|the) (?:chest|ribs|spine|waist|hips|breastbone|sternum|weight|back)\b")


def limbs_of(clause: str) -> frozenset[str]:
    """Limbs that a clause moves: left_arm, right_arm, some_arm, head, trunk; empty where its words decide none.

    >>> sorted(limbs_of("wave with your left hand")), sorted(limbs_of("scratch your head")), sorted(limbs_of("shake your head"))
    (['left_arm'], ['some_arm'], ['head'])
    >>> sorted(limbs_of("pour some tea")), sorted(limbs_of("totter to the side")), sorted(limbs_of("smile"))
    (['some_arm'], ['trunk'], [])
    """
    return limbs_named(clause) or _limb_of_words(clause)


def limbs_named(clause: str) -> frozenset[str]:
    """Limbs that a clause names, or that the commonest verbs and gestures move: `limbs_of` without the table of limb words."""
    if _HEAD.search(clause) and not _HEAD_NOT.search(clause) and not _A_LIMB.search(clause):
        return HEAD
    if _TRUNK.search(clause) and not _TRUNK_NOT.search(clause) and not _NAMED_LIMB.search(clause):
        return TRUNK
    if sided := _ARM_SIDE.search(clause):
        sides = {s for m in _ARM_SIDE.finditer(clause) for s in m.groups() if s}
        return frozenset(f"{side}_arm" for side in sides) if sided else SOME_ARM
    if _BOTH.search(clause):
        return ARMS
    return SOME_ARM if _ARM.search(clause) or _HEAD_NOT.search(clause) else frozenset()


def _limb_of_words(clause: str) -> frozenset[str]:
    """The limb of a clause by its verb; if the verb decides none by its nouns, else by the part of the body that it names."""
    first, *others = _WORDS.findall(clause) or [""]
    if first in _BEGINS_NO_GESTURE:
        return frozenset()
    told = {limb for word in others if (limb := _limb_words()["nouns"].get(word))} if first in SAYS_NO_LIMB else set()
    limb = _limb_words()["verbs"].get(first, "") or (told.pop() if len(told) == 1 else "")
    if limb:
        return {"arm": SOME_ARM, "head": HEAD, "trunk": TRUNK}[limb]
    if _HEAD_PLACE.search(clause):
        return HEAD
    return TRUNK if _TRUNK_PLACE.search(clause) else frozenset()


def is_gesture_verb(word: str) -> bool:
    """Whether phrases of the corpus begin with this word and the word decides their limb: "shovel", "knit"."""
    return word in _limb_words()["verbs"]


def begins_with_a_verb(words: str) -> bool:
    """Whether words in lower case begin as a command does."""
    return BEGINS_WITH_A_VERB.match(words) is not None or is_gesture_verb(words.partition(" ")[0])


@cache
def _limb_words() -> dict[str, dict[str, str]]:
    """The limb of each verb and noun of the table."""
    found: dict[str, dict[str, str]] = {"verbs": {}, "nouns": {}}
    for kind, words in pairs("limb_words"):
        found[kind.split()[0]] |= dict.fromkeys(words.split(), kind.split()[1])
    return found
