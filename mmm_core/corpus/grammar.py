"""Sentences for gestures: phrases bent to imperative, third person, request and gerund; counts, tempo, contrast, order."""

from __future__ import annotations

import re

import numpy as np

from mmm_core.corpus.families import Gesture
from mmm_core.corpus.phrases import DIRECTED, PHRASES, Phrases

_NUMBERS = ("zero", "one", "two", "three", "four", "five", "six", "seven", "eight")
_USUAL_COUNTS = {
    "wave": (2, 3), "clap": (3, 4), "nod": (2,), "shake_head": (1, 2), "beckon": (2,), "punch": (1, 2), "flap": (3,),
    "arm_circle": (2,), "go_away": (2,), "conduct": (3, 4), "drum": (4, 5), "cheer": (2, 3), "push": (1,), "pull": (1, 2),
}  # fmt: skip
_OTHER = {"left": "right", "right": "left"}
_THIRD = {"do": "does", "have": "has", "be": "is", "pray": "prays", "say": "says", "play": "plays", "stay": "stays", "lay": "lays", "punch": "punches", "do not": "does not"}  # fmt: skip
_GERUND = {
    "put": "putting", "hit": "hitting", "clap": "clapping", "nod": "nodding", "hug": "hugging", "drop": "dropping",
    "flap": "flapping", "shrug": "shrugging", "drum": "drumming", "set": "setting", "stop": "stopping", "tip": "tipping",
    "jab": "jabbing", "swim": "swimming", "let": "letting", "scan": "scanning", "cup": "cupping", "wrap": "wrapping",
    "beg": "begging", "be": "being", "agree": "agreeing", "disagree": "disagreeing", "lie": "lying",
}  # fmt: skip
_REQUESTS = ("please {v}", "could you {v}", "can you {v}", "{v} please", "robot, {v}", "now {v}", "I want you to {v}", "go ahead and {v}", "you should {v}", "try to {v}", "would you {v}", "I would like you to {v}", "hey, {v}", "ok, {v}")  # fmt: skip
_PERSONS = ("a person {v}", "someone {v}", "the person {v}", "a man {v}", "a woman {v}", "the robot {v}", "a figure {v}", "the character {v}", "he {v}", "she {v}")  # fmt: skip
_GERUNDS = ("a person {v}", "someone {v}", "a person is {v}", "the robot is {v}", "{v}", "start {v}", "a motion of {v}")
_SLOW = ("slowly", "gently", "in slow motion", "calmly", "at a slow pace", "carefully")
_FAST = ("quickly", "fast", "rapidly", "briskly", "at a fast pace", "in a hurry", "energetically")
_LARGE = ("widely", "with a big movement", "as far as you can", "strongly")
_SMALL = ("slightly", "a little", "with a small movement", "a bit")
_THEN = ("{a}, then {b}", "{a} and then {b}", "first {a}, then {b}", "{a}, after that {b}", "{a} and {b}", "{a}. then {b}", "{a}, next {b}", "first {a} and afterwards {b}", "{a} before you {b}", "{a}, followed by: {b}")  # fmt: skip
_THEN_THIRD = ("{a}, then {b}", "{a} and then {b}", "{a} and afterwards {b}", "{a} and {b}", "first {a}, then {b}")


def base_phrase(g: Gesture, rng: np.random.Generator) -> str:
    """One imperative phrase for a gesture, slots filled."""
    if g.family in DIRECTED and g.direction in DIRECTED[g.family]:
        table: Phrases = DIRECTED[g.family][g.direction]
    else:
        table = PHRASES[g.family]
    options = table[_row(g, table, rng)]
    if g.count not in usual_counts(g.family):  # an unusual count has to be said
        options = [p for p in options if "{n}" in p or "{N}" in p]
    return _fill(_pick(options, rng), g, rng)


def known_commands() -> set[str]:
    """Every phrase in its plainest form: each side and direction, without counts or with three."""
    found: set[str] = set()
    tables = [(family, "", table) for family, table in PHRASES.items()]
    tables += [(family, d, table) for family, by_d in DIRECTED.items() for d, table in by_d.items()]
    for _, direction, table in tables:
        for row, phrases in table.items():
            for phrase in phrases:
                for side in ("left", "right") if row == "one" or "{S}" in phrase else ("",):
                    for where in ("left", "right") if "{D}" in phrase else (direction,):
                        for times, number in (("", "three"), ("three times", "3")):
                            text = phrase.replace("{S}", side).replace("{D}", where)
                            text = text.replace("{n}", times).replace("{N}", number)
                            found.add(re.sub(r"\s+", " ", text).strip())
    return found


def usual_counts(family: str) -> tuple[int, ...]:
    """Counts that a family has when none is said."""
    return _USUAL_COUNTS.get(family, (1,))


def _row(g: Gesture, table: Phrases, rng: np.random.Generator) -> str:
    if not g.side:
        return "none"
    if g.side == "both":
        return "both"
    # without a side in the words the right arm acts; pointing sideways uses the arm of that side
    unnamed = g.direction if g.family == "point" and g.direction in _OTHER else "right"
    if "any" in table and g.side == unnamed and rng.random() < 0.3:
        return "any"
    return "one"


def _fill(phrase: str, g: Gesture, rng: np.random.Generator) -> str:
    number = _NUMBERS[g.count] if rng.random() < 0.65 else str(g.count)
    if "{N}" in phrase and g.count == 1:
        phrase = re.sub(r"\{N\} (\{S\} )?(.*?)(ches|ves|s)\b", _singular, phrase, count=1)
    times = _times(g, rng)
    phrase = phrase.replace("{S}", g.side).replace("{D}", g.direction).replace("{N}", number).replace("{n}", times)
    return re.sub(r"\s+", " ", phrase).strip()


def _singular(match: re.Match[str]) -> str:
    ending = {"ches": "ch", "ves": "ve", "s": ""}[match[3]]
    return f"one {match[1] or ''}{match[2]}{ending}"


def _times(g: Gesture, rng: np.random.Generator) -> str:
    """How often, in words or digits; usual counts may stay unsaid."""
    if g.count in usual_counts(g.family) and rng.random() < 0.4:
        return ""
    if g.count == 1:
        return str(rng.choice(["once", "one time", "a single time", "1 time"]))
    if g.count == 2 and rng.random() < 0.5:
        return "twice"
    word = _NUMBERS[g.count] if rng.random() < 0.6 else str(g.count)
    return f"{word} times"


def _pick(options: list[str] | tuple[str, ...], rng: np.random.Generator) -> str:
    return options[int(rng.integers(len(options)))]


def _adverb(g: Gesture, rng: np.random.Generator) -> str:
    """Tempo or size in words, only where the motion really has it, and then not always."""
    options: list[tuple[str, ...]] = []
    if g.tempo < 0.8:
        options.append(_SLOW)
    if g.tempo > 1.2:
        options.append(_FAST)
    if g.size > 1.15:
        options.append(_LARGE)
    if g.size < 0.75:
        options.append(_SMALL)
    if options and rng.random() < 0.75:
        return " " + _pick(options[int(rng.integers(len(options)))], rng)
    return ""


def _third(phrase: str, pronoun: str) -> str:
    """Third person of an imperative: "wave your hand" becomes "waves their hand"."""
    words = phrase.split(" ")
    if words[:2] == ["do", "not"]:
        words[:2] = ["does", "not"]
    else:
        words[0] = _third_verb(words[0])
    for i in range(len(words) - 1):
        if words[i] == "and" and words[i + 1] in ("wave", "clap", "cheer", "stand", "look"):
            words[i + 1] = _third_verb(words[i + 1])
    return _persons_words(" ".join(words), pronoun)


def _third_verb(verb: str) -> str:
    if verb in _THIRD:
        return _THIRD[verb]
    if verb.endswith(("ch", "sh", "s", "x")):
        return verb + "es"
    if verb.endswith("y") and verb[-2] not in "aeiou":
        return verb[:-1] + "ies"
    return verb + "s"


def _gerund(phrase: str, pronoun: str | None) -> str:
    words = phrase.split(" ")
    if words[:2] == ["do", "not"]:
        words[:2] = ["not", "doing"]
    elif words[0] in _GERUND:
        words[0] = _GERUND[words[0]]
    elif words[0].endswith("e") and not words[0].endswith("ee"):
        words[0] = words[0][:-1] + "ing"
    else:
        words[0] += "ing"
    for i in range(len(words) - 1):
        if words[i] == "and" and words[i + 1] in ("wave", "clap", "cheer", "stand", "look"):
            words[i + 1] = _gerund(words[i + 1], None)
    return _persons_words(" ".join(words), pronoun) if pronoun else " ".join(words)


def _persons_words(phrase: str, pronoun: str) -> str:
    self_word = {"their": "themselves", "his": "himself", "her": "herself"}[pronoun]
    other = {"their": "them", "his": "him", "her": "her"}[pronoun]
    phrase = re.sub(r"\byourself\b", self_word, phrase)
    phrase = re.sub(r"\byour\b", pronoun, phrase)
    return re.sub(r"\byou\b", other, phrase)


def _contrast(g: Gesture, phrase: str, rng: np.random.Generator) -> str:
    """Name the other side to say that it is not meant."""
    o = _OTHER[g.side]
    forms = (
        f"{phrase}, not the {o}", f"{phrase}, not your {o} one", f"not the {o} hand, {phrase}", f"not the {o}, {phrase}",
        f"don't use your {o} arm, {phrase}", f"{phrase} instead of the {o}", f"{phrase} and leave the {o} arm still",
        f"{phrase} but not with the {o}", f"no, not the {o} one, {phrase}",
    )  # fmt: skip
    return _pick(forms, rng)


def caption(gestures: list[Gesture], parallel: bool, rng: np.random.Generator) -> str:
    """A sentence for the gestures in order, or for two at the same time."""
    clauses = [base_phrase(g, rng) + _adverb(g, rng) for g in gestures]
    if len(gestures) == 1 and gestures[0].side in _OTHER and gestures[0].side in clauses[0] and rng.random() < 0.08:
        return _finish(_contrast(gestures[0], clauses[0], rng), rng)
    style = rng.random()
    pronoun = _pick(("their", "their", "his", "her"), rng)
    if parallel:
        a, b = clauses
        if style < 0.5:
            return _finish(
                _pick((f"{a} while {_gerund(b, None)}", f"{a} and {b} at the same time", f"{a} while you {b}"), rng),
                rng,
            )
        subject = _pick(_PERSONS, rng)
        return _finish(subject.replace("{v}", f"{_third(a, pronoun)} while {_gerund(b, pronoun)}"), rng)
    if style < 0.5:
        return _finish(_joined(clauses, _THEN, rng), rng)
    if style < 0.68:
        joined = _joined(clauses, ("{a}, then {b}", "{a} and then {b}", "{a} and {b}"), rng)
        return _finish(_pick(_REQUESTS, rng).replace("{v}", joined), rng)
    if style < 0.88 or len(clauses) > 1:
        third = [_third(c, pronoun) for c in clauses]
        return _finish(_pick(_PERSONS, rng).replace("{v}", _joined(third, _THEN_THIRD, rng)), rng)
    form = _pick(_GERUNDS, rng)
    return _finish(form.replace("{v}", _gerund(clauses[0], None if form in ("{v}", "start {v}") else pronoun)), rng)


def _joined(clauses: list[str], forms: tuple[str, ...], rng: np.random.Generator) -> str:
    return clauses[0] if len(clauses) == 1 else _pick(forms, rng).replace("{a}", clauses[0]).replace("{b}", clauses[1])


def _finish(sentence: str, rng: np.random.Generator) -> str:
    """Capital letter, full stop and a slip of the finger, now and then."""
    draw = rng.random()
    if draw < 0.15:
        sentence = sentence[0].upper() + sentence[1:] + "."
    elif draw < 0.2:
        sentence += "!"
    elif draw < 0.23 and len(sentence) > 12:
        i = int(rng.integers(3, len(sentence) - 3))
        if sentence[i].isalpha() and sentence[i + 1].isalpha():
            sentence = sentence[:i] + sentence[i + 1] + sentence[i] + sentence[i + 2 :]
    return sentence
