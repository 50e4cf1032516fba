"""English inflection: "wave your hand" becomes "waves their hand" or "waving"; counts as words and digits; slips and spelling."""

from __future__ import annotations

import re
from functools import cache
from itertools import product

import numpy as np

NUMBERS = ("zero", "one", "two", "three", "four", "five", "six", "seven", "eight")
_THIRD = {"have": "has", "be": "is", "shoo": "shoos"}
_GERUND = {"lie": "lying", "be": "being", "tie": "tying", "die": "dying", "program": "programming", "swivel": "swiveling", "unplug": "unplugging", "control": "controlling", "regret": "regretting", "forbid": "forbidding", "begin": "beginning", "concur": "concurring", "demur": "demurring", "defer": "deferring", "permit": "permitting", "admit": "admitting", "transfer": "transferring", "transmit": "transmitting", "eavesdrop": "eavesdropping", "enwrap": "enwrapping", "expel": "expelling", "lollygag": "lollygagging", "patrol": "patrolling", "reset": "resetting", "boogie": "boogieing"}  # fmt: skip
_DOUBLED = re.compile(r"^[^aeiou]*(?:qu)?[aeiou][bdgklmnprtv]$")
_SPELLINGS = (("forward", "forwards"), ("backward", "backwards"), ("upwards", "upward"), ("downwards", "downward"), ("towards", "toward"), ("favourite", "favorite"), ("colour", "color"), ("practise", "practice"), ("rhythm", "rythm"))  # fmt: skip
"""British and American (and one common slip); the first is what the patterns say."""
_NEVER_MISSPELT = ("instead", "without", "leave", "keep", "rests", "rather", "stop", "said")
"""Words that decide the sense of a contrast."""


@cache
def expand(pattern: str) -> tuple[str, ...]:
    """Every phrase of a pattern: `(a|b|)` stands for each of its alternatives."""
    parts = re.split(r"(\([^()]*\|[^()]*\))", pattern)
    options = [p[1:-1].split("|") if p.startswith("(") else [p] for p in parts]
    return tuple(dict.fromkeys(re.sub(r"\s+", " ", "".join(choice)).strip() for choice in product(*options)))


def third_person(phrase: str, pronoun: str) -> str:
    """The phrase in the third person singular; further verbs are marked `^` in `phrase`."""
    words = phrase.split(" ")
    words[0] = f"^{words[0]}"
    if words[1:2] == ["not"]:
        words[0] = "does" if words[0] == "^do" else words[0]
    bent = [_third_verb(w[1:]) if w.startswith("^") else w for w in words]
    return persons_words(" ".join(bent), pronoun)


def gerund(phrase: str, pronoun: str | None) -> str:
    """The phrase as a gerund; `pronoun` replaces "your" where it is given."""
    words = phrase.split(" ")
    if words[:2] == ["do", "not"]:
        words[:2] = ["not"]
        words[1] = f"^{words[1]}"
    elif words[0] != "^":
        words[0] = f"^{words[0]}"
    bent = " ".join(_gerund_verb(w[1:]) if w.startswith("^") else w for w in words)
    return persons_words(bent, pronoun) if pronoun else bent


def plain(phrase: str) -> str:
    """The imperative, or the phrase without a verb, itself: without marks."""
    return phrase.replace("^", "").replace("~", "")


def persons_words(phrase: str, pronoun: str) -> str:
    """The phrase with "your" and "yourself" in the third person."""
    self_word, other = {
        "their": ("themselves", "them"),
        "his": ("himself", "him"),
        "her": ("herself", "her"),
        "its": ("itself", "it"),
    }[pronoun]
    phrase = re.sub(r"\byourself\b", self_word, phrase)
    phrase = re.sub(r"\byour\b", pronoun, phrase)
    phrase = re.sub(
        r"\b(behind|around|in front of|towards|below|above|to|from|over|about|beside|near|beneath|under|for|of) you\b",
        rf"\1 {other}",
        phrase,
    )
    return re.sub(r"\byou\b", "they", phrase)  # the subject of a clause; "they" needs no other verb form


def times(count: int, rng: np.random.Generator) -> str:
    """A number of times, in words or digits."""
    if count == 1:
        return ("once", "one time", "a single time", "1 time", "just once", "only once")[int(rng.integers(6))]
    if count == 2 and rng.random() < 0.5:
        return "twice"
    word = NUMBERS[count] if rng.random() < 0.6 and count < len(NUMBERS) else str(count)
    form = ("{} times", "{} times", "{} times", "{}x", "{} times in a row", "exactly {} times")[int(rng.integers(6))]
    return form.replace("{}", word if "x" not in form else str(count))


def singular(phrase: str) -> str:
    """A phrase with {N} and a plural, for a count of one: "give {N} nods" becomes "give one nod"."""

    def one(match: re.Match[str]) -> str:
        ending = {"ches": "ch", "shes": "sh", "ves": "ve", "sses": "ss", "s": ""}[match[2]]
        return f"one {match[1]}{ending}"

    return re.sub(r"\{N\} (.*?)(ches|shes|sses|ves|s)\b", one, phrase, count=1)


def respell(sentence: str, rng: np.random.Generator) -> str:
    """The phrase with one of the two spellings of each word that has two."""
    for british, american in _SPELLINGS:
        if british in sentence and rng.random() < 0.4:
            sentence = re.sub(rf"\b{british}\b", american, sentence)
    return sentence


def slip(sentence: str, rng: np.random.Generator) -> str:
    """A slip of the finger: two letters swapped, one lost or one doubled; sides and numbers keep their letters."""
    i = int(rng.integers(3, max(4, len(sentence) - 3)))
    start, end = sentence.rfind(" ", 0, i) + 1, sentence.find(" ", i)
    word = sentence[start : end if end > 0 else len(sentence)].strip(".,!").lower()
    if (
        len(word) < 4
        or word in _NEVER_MISSPELT
        or not word.isalpha()
        or not sentence[i : i + 2].isalpha()
        or i + 1 >= start + len(word)
    ):
        return sentence
    kind = rng.random()
    if kind < 0.5:
        return sentence[:i] + sentence[i + 1] + sentence[i] + sentence[i + 2 :]
    if word in ("left", "right", *NUMBERS) or word in ("once", "twice"):
        return sentence
    return sentence[:i] + sentence[i + 1 :] if kind < 0.75 else sentence[:i] + sentence[i] + sentence[i:]


def _third_verb(verb: str) -> str:
    if verb in _THIRD:
        return _THIRD[verb]
    if verb.endswith(("ch", "sh", "s", "x", "z", "o")):
        return verb + "es"
    if verb.endswith("y") and verb[-2] not in "aeiou":
        return verb[:-1] + "ies"
    return verb + "s"


def _gerund_verb(verb: str) -> str:
    if verb in _GERUND:
        return _GERUND[verb]
    if verb.endswith("e") and not verb.endswith(("ee", "ye", "oe")):
        return verb[:-1] + "ing"
    return f"{verb}{verb[-1]}ing" if _DOUBLED.match(verb) else verb + "ing"
