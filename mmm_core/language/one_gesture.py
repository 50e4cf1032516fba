"""Phrases of the corpus that are one gesture although they look like two commands: "reach up and clap".

Only knowledge of the gesture tells them from two commands ("feel the beat and dance" from "nod your head and dance"), so they stand
in a table: the phrases that the rules alone would part or deny. In a sentence that has one, the words that join its parts are
hidden from the rules until the commands are found.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Sequence
from functools import cache, lru_cache

from mmm_core.language.word_tables import REMEMBERED, lines

TABLE = "one_gesture"
JOINING = (
    "and", ",", "then", ";", ":", "while", "whilst", "not", "no", "never", "avoid", "without", "stop", "before", "after", "as",
    "together", "meanwhile", "now", "next", "first", "last", "with", "time",
)  # fmt: skip
"""Words and punctuation that divide or deny commands."""
_HIDDEN = {word: chr(0xE000 + i) for i, word in enumerate(JOINING)}
_SHOWN = {hidden: word for word, hidden in _HIDDEN.items()}
_ANY_HIDDEN = re.compile(f"[{''.join(_SHOWN)}]")
_TOKEN = re.compile(r"[a-z']+|[,;:]")
_LEFT_OUT = frozenset("your the a an my his her their its yourself himself herself themselves".split())
_DOUBLED = re.compile(r"([bdgklmnprst])\1$")


def held_together(said: str) -> str:
    """A sentence in lower case whose phrases of one gesture have their joining words hidden.

    >>> as_said(held_together("reach up and clap, then nod")), "and" in held_together("reach up and clap, then nod")
    ('reach up and clap, then nod', False)
    """
    tokens = [m for m in _TOKEN.finditer(said) if m[0] not in _LEFT_OUT]
    stems = [stem(m[0]) for m in tokens]
    known = _phrases()
    hides: list[re.Match[str]] = []
    at = 0
    while at < len(stems):
        phrase = next((p for p in known.get(stems[at], ()) if tuple(stems[at : at + len(p)]) == p), ())
        last = at + len(phrase) - 1
        for m, following in zip(tokens[at : last + 1], [*stems[at + 1 : last + 1], ""], strict=True) if phrase else ():
            if m[0] in _HIDDEN and not (m[0] == "with" and following == "S"):
                hides.append(m)
        at += max(1, len(phrase))
    for m in reversed(hides):
        said = f"{said[: m.start()]}{_HIDDEN[m[0]]}{said[m.end() :]}"
    return said


def as_said(text: str) -> str:
    """A text with its hidden words restored."""
    return _ANY_HIDDEN.sub(lambda m: _SHOWN[m[0]], text) if _ANY_HIDDEN.search(text) else text


def stems_of(phrase: str) -> tuple[str, ...]:
    """The words that the sentences of a phrase have in common: without articles, sides and endings."""
    return tuple(stem(word) for word in _TOKEN.findall(phrase) if word not in _LEFT_OUT)


@lru_cache(maxsize=REMEMBERED)
def stem(word: str) -> str:
    """A word without its ending, "S" for a side.

    >>> stem("clapping"), stem("waves"), stem("left")
    ('clap', 'wav', 'S')
    """
    if word in ("left", "right"):
        return "S"
    if len(word) > 5 and word.endswith("ing"):
        word = word[:-3]
    elif word.endswith(("ies", "ied")):
        word = f"{word[:-3]}y"
    elif len(word) > 2 and word.endswith("s"):
        word = word[:-1]
    return _DOUBLED.sub(r"\1", word.removesuffix("e")) if len(word) > 3 else word


@cache
def _phrases() -> dict[str, Sequence[tuple[str, ...]]]:
    """The stems of each phrase by its first one, the longest phrase first.

    The hand at a phrase's end is left out: "play ducks and drakes three times with your left hand".
    """
    found: defaultdict[str, list[tuple[str, ...]]] = defaultdict(list)
    for line in lines(TABLE):
        stems = stems_of(line)
        stems = stems[:-3] if stems[-3:] == ("with", "S", "hand") else stems
        found[stems[0]].append(stems)
    return {first: sorted(several, key=len, reverse=True) for first, several in found.items()}
