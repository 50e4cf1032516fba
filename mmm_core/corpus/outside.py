"""Texts that the model cannot follow: legs, objects, acrobatics, talk, other languages, gibberish.

`OUTSIDE` stands beside the known commands in the scope index; the reason of a refusal names the nearest of these texts.
`outside_texts` builds thousands more from patterns, for the classifier behind the scope score (`mmm_core.language.scope`).
"""

from __future__ import annotations

import string
import tomllib
from collections.abc import Callable, Sequence
from importlib.resources import files

import numpy as np

from mmm_core.corpus.forms import PERSONS, REQUESTS
from mmm_core.corpus.withheld import is_withheld
from mmm_core.language.inflection import plain, third_person

Text = Callable[[np.random.Generator], str]

_TABLES = tomllib.loads(files("mmm_core.corpus").joinpath("prompts", "outside.toml").read_text(encoding="utf-8"))
OUTSIDE: tuple[str, ...] = tuple(_TABLES["plain"])
"""Short, plain texts of every kind, with which a refused text is compared to name a reason."""
WRITTEN_OUTSIDE: tuple[str, ...] = tuple(
    line
    for line in files("mmm_core.corpus")
    .joinpath("prompts", "outside_texts.txt")
    .read_text(encoding="utf-8")
    .splitlines()
    if not line.startswith("#") and not is_withheld(line)
)
"""Texts of a writer that request no gesture, though many have words of gestures; what the gesture classifier learns from."""
_WORDS: tuple[str, ...] = tuple(_TABLES["words"].split())


def outside_texts(n: int, rng: np.random.Generator) -> list[str]:
    """`n` texts of all kinds, some of them in the forms of known commands, such as requests."""
    return [_KINDS[int(rng.choice(len(_KINDS), p=_SHARES))](rng) for _ in range(n)]


def _pick(options: Sequence[str], rng: np.random.Generator) -> str:
    return options[int(rng.integers(len(options)))]


def _filled(pattern: str, rng: np.random.Generator) -> str:
    number, other = (str(int(rng.integers(2, 100))) for _ in range(2))
    slots = {
        "s": _pick(("left", "right"), rng), "o": _pick(_TABLES["things"], rng), "p": _pick(_TABLES["things"], rng), "a": _pick(_TABLES["tricks"], rng), "t": _pick(_TABLES["topics"], rng), "u": _pick(_TABLES["topics"], rng),
        "n": number, "m": other, "w": _pick(_TABLES["people"], rng), "l": _pick(_TABLES["languages"], rng), "c": _pick(_TABLES["names"], rng),
    }  # fmt: skip
    return pattern.format(**slots)


def _spoken(command: str, rng: np.random.Generator) -> str:
    """The command in a form that known commands have, too: plain, as a request, about a person, or followed by another one."""
    draw = rng.random()
    if draw < 0.2:
        return _pick(REQUESTS, rng).replace("{v}", command)
    if draw < 0.35:
        return _pick(PERSONS, rng).replace("{v}", plain(third_person(command, "their")))
    if draw < 0.45:
        return f"{command}, then {_command(rng)}"
    return command[0].upper() + command[1:] + "." if draw < 0.52 else command


def _command(rng: np.random.Generator) -> str:
    kind = rng.random()
    if kind < 0.35:
        return f"{_pick(_TABLES['leg_verbs'], rng)} {_pick(_TABLES['where'], rng)}".strip()
    if kind < 0.55:
        return _filled(_pick(_TABLES["legs"], rng), rng)
    if kind < 0.62:
        return _filled(_pick(_TABLES["acrobatics"], rng), rng)
    if kind < 0.85:
        return _filled(_pick(_TABLES["do_to_things"], rng), rng)
    return _filled(_pick(_TABLES["face"], rng), rng)


def _plain_outside(rng: np.random.Generator) -> str:
    return _pick(OUTSIDE, rng)


def _gibberish(rng: np.random.Generator) -> str:
    """Random letters, neighbouring keys, syllables, real words in random order, or one word repeated."""
    kind, length = int(rng.integers(5)), int(rng.integers(1, 7))
    if kind == 0:
        return " ".join(
            "".join(rng.choice(list(string.ascii_lowercase), int(rng.integers(1, 9)))) for _ in range(length)
        )
    if kind == 1:
        rows = ("qwertyuiop", "asdfghjkl", "zxcvbnm")
        return " ".join(_pick(rows, rng)[int(i := rng.integers(5)) : int(i) + 4] for _ in range(length))
    if kind == 2:
        return " ".join(
            "".join(rng.choice(list("bdfgklmnprstvz")) + rng.choice(list("aeiou")) + rng.choice(list("bgklmnrpz")) for _ in range(int(rng.integers(1, 3))))
            for _ in range(length)
        )  # fmt: skip
    if kind == 3:
        return " ".join(rng.permutation(_WORDS)[: length + 2])
    return " ".join([_pick(_WORDS, rng)] * (length + 1))


def _symbols(rng: np.random.Generator) -> str:
    alphabet = (string.punctuation, string.digits, string.digits + "+-*/=. ", "😀👍🔥🎉💃🤔→∞№€")[int(rng.integers(4))]
    return "".join(rng.choice(list(alphabet), int(rng.integers(1, 16))))


def _long(rng: np.random.Generator) -> str:
    parts = [
        _filled(_pick((*_TABLES["talk"], *_TABLES["tasks"], *_TABLES["questions"]), rng), rng)
        for _ in range(int(rng.integers(1, 4)))
    ]
    return " ".join(parts * int(rng.integers(4, 12)))


def _of(patterns: Sequence[str]) -> Text:
    return lambda rng: _filled(_pick(patterns, rng), rng)


_KINDS: tuple[Text, ...] = (
    lambda rng: _spoken(_command(rng), rng), _plain_outside, _of(_TABLES["questions"]), _of(_TABLES["talk"]), _of(_TABLES["tasks"]), _of(_TABLES["code"]), lambda rng: _pick(_TABLES["foreign"], rng), _gibberish, _symbols, _long,
)  # fmt: skip
_SHARES = np.array([0.42, 0.1, 0.09, 0.09, 0.07, 0.06, 0.06, 0.06, 0.03, 0.02])
