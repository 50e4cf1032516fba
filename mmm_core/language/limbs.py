"""Limbs that a command moves, by its words; verbs of the corpus's gestures stand in a table (`words/limb_words.txt`)."""

from __future__ import annotations

import re
from functools import cache

from mmm_core.language.word_tables import pairs

ARMS = frozenset({"left_arm", "right_arm"})
HEAD, TRUNK = frozenset({"head"}), frozenset({"trunk"})
SOME_ARM = frozenset({"some_arm"})
"""One arm, whichever is free."""
LIMB = r"(?:hands?|arms?|fists?|palms?|fingers?|elbows?|forearms?|biceps|thumbs?)"
_ARM_SIDE = re.compile(
    rf"\b(left|right)[- ](?:handed\b|{LIMB}\b|index finger)|\b(?:with|using|use|in) (?:your |the )?(left|right)\b(?! side)|^(?:your |the )?(left|right) (?:up|out|down|forward|on|to|behind|over)\b"
)
_BOTH = re.compile(
    r"\bboth\b|\b(?:hands|arms|fists|palms|elbows|forearms|ears|eyes)\b|\b(?:clap|applaud|applause|shrug|hug|embrace|pray|cheer|flap|drum|juggle|zombie|cross your arms|guitar|piano|violin|flute|binoculars|hands on|T pose)"
)
_ARM = re.compile(
    rf"\b{LIMB}\b|\b(?:wav|clap|salut|point(?!less)|shrug|beckon|punch|scratch|pat\b|pats|patting|rub|cover|cross|hug|flex|applau|pray|throw|catch|knock|push|pull|"
    r"stir|wip|shad|facepalm|blow|play|drum|conduct|cheer|reach|stretch|high five|toast|raise (?:a|your) glass|brush|eat|drink|yawn|hush|swim|row|climb|"
    r"beat|bang|hold|carry|offer|touch|wring|clasp|steer|flap|jab|hammer|dab|dance|greet|signal|celebrat|victory)\w*"
)
_HEAD = re.compile(
    r"\b(?:nod|nods|nodding|look|looks|looking|glanc|gaz|star(?:e|es|ing)|peek|peer|fac(?:e|ing) (?:left|right|up|down))\w*|"
    r"^(?:\w+ )?(?:turn|shake|shaking|tilt|tilting|turning|move|moving|roll|rolling|wobble|bob|bobbing|raise|lift|lower|drop|bend|lean|tip|cock|rotate|wag|swivel|hang|throw|bow|bowing) (?:your |the )?(?:head|chin|gaze|eyes|face|nose|neck)\b|"
    r"^(?:your |the )?(?:head|chin|gaze|eyes|face)\b|\b(?:your|the) head (?:tilted|to|turned|up|down|bent|shak|nod)\w*"
)
_TRUNK = re.compile(
    r"\b(?:bow|bows|bowing|lean|leans|leaning|bend|bends|bending|sway|sways|swaying|twist|twists|twisting|slump|slouch|curts)\w*\b|\b(?:torso|trunk|upper body|waist twist|body)\b"
)
_TRUNK_NOT = re.compile(
    r"\b(?:bow and arrow|longbow|the (?:\w+ )?bow is|bowstring|(?:draw|pull|aim|shoot|fire|loose|raise|lift|hold|release|string|pluck|grip|grab)\w* (?:back |off |with )?(?:an? |the |your )?(?:\w+ )?bow|sway (?:your|both) arms|bend (?:your|the|one) (?:left |right )?(?:arm|elbow)|around your body)\b"
)
_HEAD_NOT = re.compile(
    r"\b(?:look|looking|glanc\w*|gaz\w*|peer\w*|peek\w*|star\w+) (?:at|on|through|to|down at) (?:the time\b|(?:your |the |a )?(?:\w+ )?(?:wrist|watch|wristwatch|binoculars|telescope|spyglass|opera glasses|field glasses)\b)"
)
SAYS_NO_LIMB = frozenset(
    (
        "a an the some any one two three four several few another your you both each it its this that these those here there so then now "
        "also just please with to of in on at for from by off over around round up down out back away left right forward backward "
        "forwards backwards upwards downwards sideways and or not no like as if me us him her them my his their self yourself "
        "make do give have take let keep get go come be become act try start use show put hold stay remain turn move bring send set "
        "want need pretend perform imagine big small little full half high low deep soft hard heavy light large huge giant gentle "
        "quick slow strong loud single straight friendly again once twice time times something talk tell say speak walk step sit "
        "dance jump laugh smile sing mind complete respond ask find feel enjoy appear test after during while when before"
    ).split()
)
"""Words from which no limb can be told, whatever gestures of the corpus have them."""
_BEGINS_NO_GESTURE = frozenset(
    (
        "over above under below behind in on at to towards low high overhead across around against beside between near through "
        "go come get walk step sit jump talk tell say speak laugh smile sing count want need and or not"
    ).split()
)
"""Words with which a place begins, or an act that moves neither arms, head nor trunk."""
_WORDS = re.compile(r"[a-z]+")
_HEAD_PLACE = re.compile(r"\b(?:your|the) (?:head|chin|neck|nose|gaze|eyes|face|skull|crown)\b")
_TRUNK_PLACE = re.compile(r"\b(?:your|the) (?:chest|ribs|spine|waist|hips|breastbone|sternum|weight|back)\b")


def limbs_of(clause: str) -> frozenset[str]:
    """Limbs that a clause moves: left_arm, right_arm, some_arm, head, trunk; empty where its words do not say.

    >>> sorted(limbs_of("wave with your left hand")), sorted(limbs_of("scratch your head")), sorted(limbs_of("shake your head"))
    (['left_arm'], ['some_arm'], ['head'])
    >>> sorted(limbs_of("pour some tea")), sorted(limbs_of("totter to the side")), sorted(limbs_of("smile"))
    (['some_arm'], ['trunk'], [])
    """
    return limbs_named(clause) or _limb_of_words(clause)


def limbs_named(clause: str) -> frozenset[str]:
    """Limbs that a clause names, or that the commonest verbs and gestures move; the same as `limbs_of` without its table."""
    if _HEAD.search(clause) and not _HEAD_NOT.search(clause) and not re.search(rf"\b{LIMB}\b", clause):
        return HEAD
    if (
        _TRUNK.search(clause)
        and not _TRUNK_NOT.search(clause)
        and not re.search(rf"\b(?:left|right|your|both|the) {LIMB}\b", clause)
    ):
        return TRUNK
    if sided := _ARM_SIDE.search(clause):
        sides = {s for m in _ARM_SIDE.finditer(clause) for s in m.groups() if s}
        return frozenset(f"{side}_arm" for side in sides) if sided else SOME_ARM
    if _BOTH.search(clause):
        return ARMS
    return SOME_ARM if _ARM.search(clause) or _HEAD_NOT.search(clause) else frozenset()


def _limb_of_words(clause: str) -> frozenset[str]:
    """The limb of a clause by its verb or, where that says none, by its nouns, else by the part of the body that it names."""
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


@cache
def _limb_words() -> dict[str, dict[str, str]]:
    """The limb of each verb and noun of the table."""
    found: dict[str, dict[str, str]] = {"verbs": {}, "nouns": {}}
    for kind, words in pairs("limb_words"):
        found[kind.split()[0]] |= dict.fromkeys(words.split(), kind.split()[1])
    return found
