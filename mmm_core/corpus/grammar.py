"""Makes sentences for gestures from the families' phrases, with counts, manner, contrast, order and simultaneity."""

from __future__ import annotations

import numpy as np

from mmm_core.corpus.families import FAMILIES, MIMED, Gesture, Words
from mmm_core.corpus.forms import (
    ABOUT_THE_ROBOT,
    ASKED_NOUN,
    ASKED_TERSE,
    AT_ONCE_TERSE,
    FAST,
    GERUNDS,
    HEIGHTS,
    HOLDS,
    IN_TURNS,
    LARGE,
    LONG_WAY_WORDS,
    NOUN_BEGINS,
    OTHER,
    PERSONS,
    PRETEND,
    PRETENDING,
    REQUESTS,
    SLOW,
    SMALL,
    THEN,
    THEN_TERSE,
    THEN_THIRD,
    WITH_BOTH,
    WITH_HAND,
)
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
from mmm_core.language.moods import MOODS


def words_of(g: Gesture) -> Words:
    """The words of a gesture's family and direction."""
    family = FAMILIES[g.family]
    return family.directed.get(g.direction, family.words)


def base_phrase(g: Gesture, rng: np.random.Generator) -> str:
    """One imperative phrase for a gesture with its slots filled; further verbs stay marked with `^`."""
    options = list(_patterns(g, words_of(g), rng))
    rng.shuffle(options)
    for pattern, after in options:
        phrases = [p for p in expand(pattern) if _fits(p, g)]
        if phrases:
            phrase = _pick(phrases, rng) + after
            if (
                g.family in MIMED
                and not is_terse(phrase)
                and phrase.split()[0] not in PRETENDING
                and rng.random() < 0.1
            ):
                phrase = _pick(PRETEND, rng).replace("{v}", plain(phrase))
            said = _fill(phrase, g, rng)
            if not is_withheld(plain(said)):
                return said
    raise AssertionError(f"no phrase of {g.family!r} says {g}")


def is_terse(phrase: str) -> bool:
    """Whether a phrase has no verb to inflect: "~left arm up", "~a bow"."""
    return phrase.startswith("~")


def _patterns(g: Gesture, words: Words, rng: np.random.Generator) -> list[tuple[str, str]]:
    """Patterns that can express the gesture, each with the words to add after it."""
    sides = FAMILIES[g.family].sides
    if g.side == "alternating":
        return [(p, "") for p in words.alternating] * 2 + [
            (p, _pick(IN_TURNS, rng)) for p in (*words.bare, *words.both) if not is_terse(p)
        ]
    if not g.side or (g.side == "both" and "right" not in sides):
        return [(p, "") for p in (*words.bare, *words.both)]
    if g.side == "both":
        return [(p, "") for p in words.both] + [(p, _pick(WITH_BOTH, rng)) for p in words.bare]
    if g.side == unnamed_side(g) and rng.random() < 0.28 and (words.any or words.bare):
        return [(p, "") for p in (*words.any, *words.bare)]
    return [(p, "") for p in words.one] + [(p, _pick(WITH_HAND, rng)) for p in words.bare]


def unnamed_side(g: Gesture) -> str:
    """The arm that acts if no side is named: the right, but for pointing to a side the arm of that side."""
    if g.family == "point" and g.direction:
        return {"left": "left"}.get(g.direction.split(" ")[-1], "right")
    return "right"


def _fits(phrase: str, g: Gesture) -> bool:
    says_count = "{n}" in phrase or "{N}" in phrase
    if FAMILIES[g.family].counts and g.count not in FAMILIES[g.family].counts and not says_count:
        return False  # an unusual count has to be named
    return not (g.family == "raise" and g.height == "low" and any(w in phrase.split() for w in LONG_WAY_WORDS))


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
    """Words for the height, tempo, size, style or hold of a gesture, if it has one; sometimes left out."""
    options: list[tuple[str, ...]] = []
    if (g.family, g.height) in HEIGHTS and (g.height == "low" or rng.random() < 0.7):
        return " " + _pick(HEIGHTS[g.family, g.height], rng)
    if g.hold_s:
        seconds = int(g.hold_s)
        word = NUMBERS[seconds] if rng.random() < 0.6 else str(seconds)
        holds = tuple(h for h in HOLDS if not h.startswith("and ")) if terse else HOLDS
        return " " + _pick(holds, rng).replace("{s}", f"{word} second{'s' if seconds > 1 else ''}")
    if g.style:
        return " " + _pick(MOODS[g.style].words, rng)
    options += [SLOW] if g.tempo < 0.8 else []
    options += [FAST] if g.tempo > 1.2 else []
    options += [LARGE] if g.size > 1.15 else []
    options += [SMALL] if g.size < 0.75 else []
    if options and rng.random() < 0.88:
        return " " + _pick(options[int(rng.integers(len(options)))], rng)
    return ""


def clause(g: Gesture, rng: np.random.Generator) -> str:
    """A phrase with its words of manner."""
    phrase = base_phrase(g, rng)
    return phrase + _manner(g, is_terse(phrase), rng)


def _contrast(g: Gesture, phrase: str, rng: np.random.Generator) -> str:
    """The phrase with another side, direction or gesture that it denies."""
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
        return _finish(plain(_joined(clauses, THEN, rng)), rng)
    if style < 0.7:
        joined = plain(_joined(clauses, ("{a}, then {b}", "{a} and then {b}", "{a} and {b}"), rng))
        if style > 0.66:
            return _finish(_pick(ABOUT_THE_ROBOT, rng).replace("{v}", persons_words(joined, "its")), rng)
        return _finish(_pick(REQUESTS, rng).replace("{v}", joined), rng)
    if style < 0.88 or len(clauses) > 1:
        third = [third_person(c, pronoun) for c in clauses]
        return _finish(_person(_joined(third, THEN_THIRD, rng), pronoun, rng), rng)
    form = _pick(GERUNDS, rng)
    return _finish(form.replace("{v}", gerund(clauses[0], None if form in ("{v}", "start {v}") else pronoun)), rng)


def _terse(clauses: list[str], parallel: bool, style: float, rng: np.random.Generator) -> str:
    """A sentence of phrases of which at least one has no verb; sometimes a request for it."""
    if parallel:
        return plain(_joined(clauses, AT_ONCE_TERSE, rng))
    sentence = plain(_joined(clauses, THEN_TERSE, rng))
    if len(clauses) > 1 or style < 0.5:
        return sentence
    is_noun = is_terse(clauses[0]) and sentence.split()[0] in NOUN_BEGINS
    return _pick(ASKED_NOUN if is_noun and style > 0.65 else ASKED_TERSE, rng).replace("{p}", sentence)


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
    """A sentence whose subject fits the pronoun, for verbs in the third person."""
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
    """The sentence, sometimes with another spelling, a capital letter and full stop, or a typing error."""
    sentence = respell(sentence, rng)
    draw = rng.random()
    if draw < 0.15:
        return sentence[0].upper() + sentence[1:] + "."
    if draw < 0.2:
        return sentence + "!"
    if draw < 0.24 and len(sentence) > 12:
        return slip(sentence, rng)
    return sentence


def usual_counts(family: str) -> tuple[int, ...]:
    """Counts that a family may have if none is named."""
    return FAMILIES[family].counts or (1,)
