"""Sentences for gestures: the families' phrases with counts, manner, contrast, order and simultaneity."""

from __future__ import annotations

import functools
import re

import numpy as np

from mmm_core.corpus.families import FAMILIES, MIMED, Gesture, Words
from mmm_core.corpus.styles import STYLES
from mmm_core.corpus.withheld import is_withheld
from mmm_core.language.inflection import (
    NUMBERS,
    expand,
    gerund,
    persons_words,
    plain,
    respell,
    singular,
    slip,
    third_person,
    times,
)

OTHER = {"left": "right", "right": "left"}
_WITH_HAND = (" with your {S} hand", " with your {S} arm", " with the {S} hand", " using your {S} hand", " with the {S} arm", " using the {S} arm")  # fmt: skip
_WITH_BOTH = (" with both hands", " with both arms", " with two hands", " using both hands")
_IN_TURNS = (" one after the other", " alternately", " in turns", " with alternating hands", " left and right in turn", " first one hand then the other")  # fmt: skip
_PRETEND = ("pretend to {v}", "act as if you {v}", "mime how you {v}", "make believe that you {v}", "do as if you {v}", "show me how you {v}")  # fmt: skip
_PRETENDING = ("pretend", "act", "be", "imitate", "do", "show", "dance", "perform")
"""Verbs of phrases that already say it."""
REQUESTS = ("please {v}", "could you {v}", "can you {v}", "{v} please", "robot, {v}", "now {v}", "I want you to {v}", "go ahead and {v}", "you should {v}", "try to {v}", "would you {v}", "I would like you to {v}", "hey, {v}", "ok, {v}", "hey robot, {v}", "robot please {v}", "can you please {v}", "could you {v} for me", "would you mind and {v}", "I need you to {v}", "just {v}", "um, {v}", "uh {v}", "ok so {v}", "well, {v}", "you can {v} now", "will you {v}", "{v}, thanks", "{v} for me", "{v} now", "kindly {v}", "come on, {v}", "mate, {v}", "you must {v}", "next, {v}", "let us {v}", "how about you {v}", "it is time to {v}", "you have to {v}", "make sure to {v}", "be so kind and {v}", "your task: {v}", "I wish you would {v}", "all I ask is: {v}")  # fmt: skip
_ABOUT_THE_ROBOT = ("have the robot {v}", "let the robot {v}", "make the robot {v}", "tell the robot to {v}", "the robot should {v}", "the robot must {v}")  # fmt: skip
PERSONS = ("a person {v}", "someone {v}", "the person {v}", "a man {v}", "a woman {v}", "the robot {v}", "a figure {v}", "the character {v}", "he {v}", "she {v}", "somebody {v}", "the humanoid {v}", "a human {v}", "a standing person {v}", "this person {v}")  # fmt: skip
_GERUNDS = ("a person {v}", "someone {v}", "a person is {v}", "the robot is {v}", "{v}", "start {v}", "a motion of {v}", "show {v}", "a man is {v}", "begin {v}", "someone who is {v}")  # fmt: skip
_SLOW = ("slowly", "gently", "in slow motion", "calmly", "at a slow pace", "carefully", "very slowly", "unhurriedly", "at a leisurely pace", "lazily", "at half speed", "taking your time", "without any hurry", "slow and steady", "really slow", "sluggishly")  # fmt: skip
_FAST = ("quickly", "fast", "rapidly", "briskly", "at a fast pace", "in a hurry", "energetically", "very fast", "hastily", "swiftly", "speedily", "at high speed", "as fast as you can", "at double speed", "at a rapid pace", "like lightning", "really fast", "at a quick pace")  # fmt: skip
_LARGE = ("widely", "with a big movement", "as far as you can", "strongly", "with large movements", "in a big way")
_SMALL = ("slightly", "a little", "with a small movement", "a bit", "a tiny bit", "only slightly")
_HEIGHTS = {
    ("wave", "high"): ("above your head", "up high", "high in the air", "with your arm raised"),
    ("wave", "low"): ("low at your side", "down low", "at hip height", "with a low arm"),
    ("raise", "low"): ("to shoulder height", "halfway", "only halfway", "to the level of your shoulder"),
    ("raise", "high"): ("as high as you can", "all the way up", "to the very top"),
}
_HOLDS = ("and ^hold it for {s}", "for {s}", "and ^keep it there for {s}", "and ^stay like that for {s}", "and ^hold the pose for {s}", "and ^hold it {s} long", "holding it for {s}", "and ^stay there {s}", "and ^wait like that for {s}", "{s} long", "and ^do not move for {s}")  # fmt: skip
_THEN = ("{a}, then {b}", "{a} and then {b}", "first {a}, then {b}", "{a}, after that {b}", "{a} and {b}", "{a}. then {b}", "{a}, next {b}", "first {a} and afterwards {b}", "{a} before you {b}", "{a}, followed by: {b}", "{a} then {b}", "{a}; {b}", "start with: {a}, then {b}", "after you {a}, {b}", "{a}, finally {b}", "{a}. now {b}")  # fmt: skip
_THEN_TERSE = ("{a}, then {b}", "{a} and then {b}", "first {a}, then {b}", "{a}, after that {b}", "{a}. then {b}", "{a}, next {b}", "first {a} and afterwards {b}", "{a}; {b}", "start with: {a}, then {b}", "{a}, finally {b}", "{a}. now {b}", "{a}, and then {b}", "{a}, followed by {b}")  # fmt: skip
_AT_ONCE_TERSE = ("{a} and {b} at the same time", "{a}, and at the same time {b}", "{a}, meanwhile {b}", "{a} together with {b}", "at the same time {a} and {b}", "{a}, and simultaneously {b}")  # fmt: skip
_ASKED_TERSE = ("{p}, please", "{p} please", "please, {p}", "now {p}", "{p} now", "robot, {p}", "ok, {p}", "just {p}", "{p}, thanks", "hey robot, {p}", "um, {p}", "and {p}", "next, {p}", "robot: {p}", "{p} for me")  # fmt: skip
_ASKED_NOUN = ("do {p}", "give me {p}", "show me {p}", "I want {p}", "make {p}", "perform {p}", "I would like {p}", "can I have {p}", "let us have {p}", "we need {p}", "how about {p}", "I would love {p}", "do me {p}", "it is time for {p}")  # fmt: skip
_NOUN_BEGINS = ("a", "an", "some", "another", *NUMBERS[2:], *"2345678")
_THEN_THIRD = ("{a}, then {b}", "{a} and then {b}", "{a} and afterwards {b}", "{a} and {b}", "first {a}, then {b}", "{a}, after that {b}", "{a} and finally {b}")  # fmt: skip
_LONG_WAY_WORDS = (
    "up",
    "above",
    "over",
    "high",
    "sky",
    "ceiling",
    "question",
    "pupil",
    "volunteer",
    "overhead",
    "upwards",
    "upward",
    "vertical",
    "vertically",
    "air",
    "top",
)


def words_of(g: Gesture) -> Words:
    """The words of a gesture's family and direction."""
    family = FAMILIES[g.family]
    return family.directed.get(g.direction, family.words)


def base_phrase(g: Gesture, rng: np.random.Generator) -> str:
    """One imperative phrase for a gesture, slots filled; further verbs stay marked `^`."""
    options = list(_patterns(g, words_of(g), rng))
    rng.shuffle(options)
    for pattern, after in options:
        phrases = [p for p in expand(pattern) if _fits(p, g)]
        if phrases:
            phrase = _pick(phrases, rng) + after
            if (
                g.family in MIMED
                and not is_terse(phrase)
                and phrase.split()[0] not in _PRETENDING
                and rng.random() < 0.1
            ):
                phrase = _pick(_PRETEND, rng).replace("{v}", plain(phrase))
            said = _fill(phrase, g, rng)
            if not is_withheld(plain(said)):
                return said
    raise AssertionError(f"no phrase of {g.family!r} says {g}")


def is_terse(phrase: str) -> bool:
    """Whether a phrase has no verb to be bent: "~left arm up", "~a bow"."""
    return phrase.startswith("~")


def _patterns(g: Gesture, words: Words, rng: np.random.Generator) -> list[tuple[str, str]]:
    """Patterns that can say the gesture, each with what is added to it."""
    sides = FAMILIES[g.family].sides
    if g.side == "alternating":
        return [(p, "") for p in words.alternating] * 2 + [
            (p, _pick(_IN_TURNS, rng)) for p in (*words.bare, *words.both) if not is_terse(p)
        ]
    if not g.side or (g.side == "both" and "right" not in sides):
        return [(p, "") for p in (*words.bare, *words.both)]
    if g.side == "both":
        return [(p, "") for p in words.both] + [(p, _pick(_WITH_BOTH, rng)) for p in words.bare]
    if g.side == unnamed_side(g) and rng.random() < 0.28 and (words.any or words.bare):
        return [(p, "") for p in (*words.any, *words.bare)]
    return [(p, "") for p in words.one] + [(p, _pick(_WITH_HAND, rng)) for p in words.bare]


def unnamed_side(g: Gesture) -> str:
    """The arm that acts where no side is said: the right; pointing sideways the arm of that side."""
    if g.family == "point" and g.direction:
        return {"left": "left"}.get(g.direction.split(" ")[-1], "right")
    return "right"


def _fits(phrase: str, g: Gesture) -> bool:
    says_count = "{n}" in phrase or "{N}" in phrase
    if FAMILIES[g.family].counts and g.count not in FAMILIES[g.family].counts and not says_count:
        return False  # an unusual count has to be said
    return not (g.family == "raise" and g.height == "low" and any(w in phrase.split() for w in _LONG_WAY_WORDS))


def _fill(phrase: str, g: Gesture, rng: np.random.Generator) -> str:
    if "{N}" in phrase and g.count == 1:
        phrase = singular(phrase)
    number = NUMBERS[g.count] if rng.random() < 0.65 else str(g.count)
    usual = g.count in FAMILIES[g.family].counts
    often = "" if usual and rng.random() < 0.4 else times(g.count, rng)
    phrase = phrase.replace("{S}", g.side).replace("{D}", g.direction).replace("{N}", number).replace("{n}", often)
    return " ".join(phrase.split())


def _pick(options: tuple[str, ...] | list[str], rng: np.random.Generator) -> str:
    return options[int(rng.integers(len(options)))]


def _manner(g: Gesture, terse: bool, rng: np.random.Generator) -> str:
    """Height, tempo, size, style and hold in words, only where the motion has them, and then not always."""
    options: list[tuple[str, ...]] = []
    if (g.family, g.height) in _HEIGHTS and (g.height == "low" or rng.random() < 0.7):
        return " " + _pick(_HEIGHTS[g.family, g.height], rng)
    if g.hold_s:
        seconds = int(g.hold_s)
        word = NUMBERS[seconds] if rng.random() < 0.6 else str(seconds)
        holds = tuple(h for h in _HOLDS if not h.startswith("and ")) if terse else _HOLDS
        return " " + _pick(holds, rng).replace("{s}", f"{word} second{'s' if seconds > 1 else ''}")
    if g.style:
        return " " + _pick(STYLES[g.style].words, rng)
    options += [_SLOW] if g.tempo < 0.8 else []
    options += [_FAST] if g.tempo > 1.2 else []
    options += [_LARGE] if g.size > 1.15 else []
    options += [_SMALL] if g.size < 0.75 else []
    if options and rng.random() < 0.88:
        return " " + _pick(options[int(rng.integers(len(options)))], rng)
    return ""


def clause(g: Gesture, rng: np.random.Generator) -> str:
    """A phrase with its manner; an adverb may come first."""
    phrase = base_phrase(g, rng)
    return phrase + _manner(g, is_terse(phrase), rng)


def _contrast(g: Gesture, phrase: str, rng: np.random.Generator) -> str:
    """Name the other side, direction or gesture to say that it is not meant."""
    if g.side in OTHER and g.side in phrase:
        o = OTHER[g.side]
        forms = (
            f"{phrase}, not the {o}", f"{phrase}, not your {o} one", f"not the {o} hand, {phrase}", f"not the {o}, {phrase}",
            f"don't use your {o} arm, {phrase}", f"{phrase} instead of the {o}", f"{phrase} and leave the {o} arm still",
            f"{phrase} but not with the {o}", f"no, not the {o} one, {phrase}", f"{phrase}, not with the {o} hand",
            f"{phrase} and not your {o}", f"keep your {o} arm down and {phrase}", f"{phrase} without using the {o} hand",
            f"the {o} hand rests, {phrase}", f"I said {g.side}, not {o}: {phrase}",
        )  # fmt: skip
        return _pick(forms, rng)
    if g.direction in OTHER and g.direction in phrase:
        o = OTHER[g.direction]
        forms = (
            f"{phrase}, not {o}", f"{phrase}, not to the {o}", f"not to the {o}, {phrase}", f"not {o}, {phrase}", f"{phrase} instead of {o}",
            f"no, {g.direction}, not {o}: {phrase}", f"{phrase} and not to the {o}",
        )  # fmt: skip
        return _pick(forms, rng)
    others = [name for name in _PLAIN if name != g.family and FAMILIES[name].limb]
    verbs = [p for p in FAMILIES[_pick(others, rng)].words.bare if not is_terse(p)]
    bare = _pick(expand(_pick(verbs, rng)), rng)
    no = " ".join(bare.replace("{n}", "").replace("{N} ", "").split())
    no, ing = plain(no), gerund(no, None)
    forms = (f"don't {no}, {phrase}", f"do not {no}, {phrase} instead", f"{phrase} instead of {ing}", f"rather than {ing}, {phrase}", f"no {ing}, {phrase}", f"stop {ing} and {phrase}")  # fmt: skip
    return _pick(forms, rng)


_PLAIN = tuple(n for n, f in FAMILIES.items() if f.words.bare and not f.directions and "{D}" not in str(f.words.bare))


def caption(gestures: list[Gesture], parallel: bool, rng: np.random.Generator) -> str:
    """A sentence for the gestures in order, or for two at the same time."""
    clauses = [clause(g, rng) for g in gestures]
    first = gestures[0]
    if len(gestures) == 1 and first.family not in ("point", "stand") and rng.random() < 0.1:
        return _finish(plain(_contrast(first, clauses[0], rng)), rng)
    style = rng.random()
    if any(is_terse(c) for c in clauses):
        return _finish(_terse(clauses, parallel, style, rng), rng)
    pronoun = _pick(("their", "their", "his", "her"), rng)
    if parallel:
        return _finish(_at_once(clauses[0], clauses[1], style, pronoun, rng), rng)
    if style < 0.46:
        return _finish(plain(_joined(clauses, _THEN, rng)), rng)
    if style < 0.7:
        joined = plain(_joined(clauses, ("{a}, then {b}", "{a} and then {b}", "{a} and {b}"), rng))
        if style > 0.66:
            return _finish(_pick(_ABOUT_THE_ROBOT, rng).replace("{v}", persons_words(joined, "its")), rng)
        return _finish(_pick(REQUESTS, rng).replace("{v}", joined), rng)
    if style < 0.88 or len(clauses) > 1:
        third = [third_person(c, pronoun) for c in clauses]
        return _finish(_person(_joined(third, _THEN_THIRD, rng), pronoun, rng), rng)
    form = _pick(_GERUNDS, rng)
    return _finish(form.replace("{v}", gerund(clauses[0], None if form in ("{v}", "start {v}") else pronoun)), rng)


def _terse(clauses: list[str], parallel: bool, style: float, rng: np.random.Generator) -> str:
    """Phrases of which one at least has no verb, joined; asked for, now and then."""
    if parallel:
        return plain(_joined(clauses, _AT_ONCE_TERSE, rng))
    sentence = plain(_joined(clauses, _THEN_TERSE, rng))
    if len(clauses) > 1 or style < 0.5:
        return sentence
    is_noun = is_terse(clauses[0]) and sentence.split()[0] in _NOUN_BEGINS
    return _pick(_ASKED_NOUN if is_noun and style > 0.65 else _ASKED_TERSE, rng).replace("{p}", sentence)


def _at_once(a: str, b: str, style: float, pronoun: str, rng: np.random.Generator) -> str:
    if style < 0.6:
        forms = (
            f"{a} while {gerund(b, None)}", f"{a} and {b} at the same time", f"{a} while you {b}", f"{a} and simultaneously {b}",
            f"while you {b}, {a}", f"{a} as you {b}", f"at the same time {a} and {b}",
        )  # fmt: skip
        sentence = plain(_pick(forms, rng))
        return _pick(REQUESTS, rng).replace("{v}", sentence) if style < 0.15 else sentence
    return _person(f"{third_person(a, pronoun)} while {gerund(b, pronoun)}", pronoun, rng)


def _person(verbs: str, pronoun: str, rng: np.random.Generator) -> str:
    """Somebody, of the sex that the pronoun has, does it."""
    excluded = {"his": ("a woman", "she"), "her": ("a man", "he"), "their": ("he", "she")}[pronoun]
    subjects = [p for p in PERSONS if p.removesuffix(" {v}") not in excluded]
    return _pick(subjects, rng).replace("{v}", verbs)


def _joined(clauses: list[str], forms: tuple[str, ...], rng: np.random.Generator) -> str:
    sentence = clauses[0]
    for i, following in enumerate(clauses[1:]):
        form = _pick(forms if i == 0 else ("{a}, then {b}", "{a} and then {b}", "{a}, finally {b}"), rng)
        sentence = form.replace("{a}", sentence).replace("{b}", following)
    return sentence


def _finish(sentence: str, rng: np.random.Generator) -> str:
    """Spelling, a capital letter, a full stop or a slip of the finger, now and then."""
    sentence = respell(sentence, rng)
    draw = rng.random()
    if draw < 0.15:
        return sentence[0].upper() + sentence[1:] + "."
    if draw < 0.2:
        return sentence + "!"
    if draw < 0.24 and len(sentence) > 12:
        return slip(sentence, rng)
    return sentence


def plain_phrases(family: str, direction: str = "") -> list[tuple[str, str]]:
    """(row, phrase) for every phrase of a family and direction, slots open; bare ones with a hand where there are sides."""
    g = Gesture(family, direction=direction)
    words, sides = words_of(g), FAMILIES[family].sides
    rows: list[tuple[str, tuple[str, ...], tuple[str, ...]]] = [
        ("one", words.one, ("",)), ("any", words.any, ("",)), ("both", words.both, ("",)), ("alternating", words.alternating, ("",)),
    ]  # fmt: skip
    if "right" in sides:
        rows += [("any", words.bare, ("",)), ("one", words.bare, _WITH_HAND[:1])]
        rows += [("both", words.bare, _WITH_BOTH[:1])] if "both" in sides else []
    else:
        rows += [("both" if sides else "none", words.bare, ("",))]
    if "alternating" in sides:
        verbs = tuple(p for p in (*words.bare, *words.both) if not is_terse(p))
        rows += [("alternating", verbs, _IN_TURNS[:1])]
    said = [(row, f"{p}{end}") for row, patterns, ends in rows for q in patterns for p in expand(q) for end in ends]
    if family in MIMED:
        said += [
            (row, _PRETEND[0].replace("{v}", p))
            for row, p in said
            if row != "one" and not is_terse(p) and p.split()[0] not in _PRETENDING
        ]
    return [(row, plain(p)) for row, p in said]


@functools.cache
def known_commands(most_of_a_row: int = 12) -> frozenset[str]:
    """Plain commands of every family: each side and direction, without counts or with three.

    Of each row they are the shortest phrase, beside it about `most_of_a_row` others: its first ones, which are what people say
    most, and as many spread over the rest.
    """
    found: set[str] = set()
    for name, family in FAMILIES.items():
        for direction in family.directions or ("",):
            rows: dict[str, list[str]] = {}
            for row, phrase in plain_phrases(name, direction):
                rows.setdefault(row, []).append(phrase)
            for row, phrases in rows.items():
                first = -(-most_of_a_row // 2)
                rest = phrases[first:]
                spread = rest[:: max(1, -(-len(rest) // max(1, most_of_a_row - first)))]
                shortest = min(phrases, key=lambda p: len(p.replace("{n}", "").split()))
                for phrase in dict.fromkeys((shortest, *phrases[:first], *spread)):
                    for side in ("left", "right") if row == "one" or "{S}" in phrase else ("",):
                        for often, number in (("", "three"), ("three times", "3")) if "{" in phrase else (("", ""),):
                            text = phrase.replace("{S}", side).replace("{D}", direction)
                            found.add(" ".join(text.replace("{n}", often).replace("{N}", number).split()))
    return frozenset(text for text in found if not is_withheld(text))


def manner_phrases() -> tuple[str, ...]:
    """Words of manner, of order, of requests and of persons, as sentences have them around the phrases."""
    forms = (*_SLOW, *_FAST, *_LARGE, *_SMALL, *_HOLDS, *_THEN, *_AT_ONCE_TERSE, *REQUESTS, *_PRETEND, *_IN_TURNS)
    return tuple(re.sub(r"\{.\}|\^", " ", form) for form in forms)


def usual_counts(family: str) -> tuple[int, ...]:
    """Counts that a family has when none is said."""
    return FAMILIES[family].counts or (1,)
