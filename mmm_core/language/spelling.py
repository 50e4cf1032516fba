"""Corrects the spelling of typed and spoken text: chat words, fillers, restarts, homophones and misspellings.

`slips` corrects misspellings of single words.
"""

from __future__ import annotations

import re
import unicodedata
from functools import cache, lru_cache
from itertools import pairwise

from mmm_core.language.meant_command import with_meant_command
from mmm_core.language.slips import without_slips
from mmm_core.language.word_tables import REMEMBERED, WAY, RuleTable, pairs, replaced, substitutions

_FILLER = r"(?:u+h+m*|u+m+|e+r+m*|h+m+|ah+|eh+)"
_RESTART = re.compile(
    rf"\b(\w+(?: \w+){{0,2}}),? (?:{_FILLER}|i mean|you know|sorry|no wait)(?:,|\.{{2,}})? (?=\1\b)", re.IGNORECASE
)
_STUTTER = re.compile(r"\b(the|your|to|at|with|a|and|then|left|right|hand|arm|raise|turn|look|wave|lift|put|clap|nod|bow|shrug|point)(?:,|\.{2,}|-)? (?=\1\b)(?!\1 (?:and|then) \1)(?!left right|right left)(?<!left right )(?<!right left )", re.IGNORECASE)  # fmt: skip
_TWICE = re.compile(r"\b((?:(?!(?:then|and)\b)\w+ ){2,}(?!(?:then|and)\b)\w+) \1\b")
"""A command repeated at once: "lift your right arm lift your right arm". "Nod then bow then nod then bow" are four commands."""
_PAUSES = re.compile(rf"\b(?:{_FILLER}|i mean|you know|sorry|no wait)\b")
"""Words that mark a restart."""
_FILLERS = re.compile(
    rf"(?:^|(?<=[\s,.]))(?:{_FILLER}|(?<!do )(?<!did )(?<!if )(?<!whether )(?<!that )(?<!what )(?<!because )(?<!since )(?<!behind )(?<!around )(?<!near )(?<!beside )you know(?! how\b)|i mean|kinda|sorta)(?:\s*,|\s*\.{{2,}})?(?:\s+|$)",
    re.IGNORECASE,
)
_PAUSE_IN_PHRASE = re.compile(rf"\b(your|the|my|an?|with|to|at|on),? (?:{_FILLER}),? (?=\w)")
"""A pause between an article or preposition and its noun, whose commas divide nothing: "raise your, um, left arm"."""
_DRAWN_OUT = re.compile(r"([a-z])\1{2,}", re.IGNORECASE)
_DROPPED_G = re.compile(r"(?<=[a-z]{2})in'$")
"""The end of "wavin'"."""
_MARKS = str.maketrans({"’": "'", "‘": "'", "“": '"', "”": '"', "–": "-", "—": ", ", "…": "... ", "´": "'", "`": "'"})  # noqa: RUF001


def normalised(text: str) -> str:
    """Text with one form of each quote and dash, single blanks, and no letters drawn out.

    >>> normalised("wave  —  sloooowly")
    'wave , sloowly'
    """
    plain = unicodedata.normalize("NFKC", text).translate(_MARKS)
    plain = _DRAWN_OUT.sub(_shortened, plain)
    return " ".join(plain.split())


def _shortened(found: re.Match[str]) -> str:
    """A drawn-out letter twice where the word has it twice, else once: "loook" -> "look", "stooop" -> "stop" by `mended`."""
    return found[1] * 2 if found[1].lower() in "oeh" else found[1]


@lru_cache(maxsize=REMEMBERED)
def mended(text: str) -> str:
    """Text in lower case with chat words, fillers, restarts, homophones and misspellings corrected; punctuation stays.

    >>> mended("bwo deeply pls"), mended("wave um wave your left hand"), mended("Rays your write hand")
    ('bow deeply please', 'wave your left hand', 'raise your right hand')
    """
    said = normalised(text).lower()
    said = _taken_back(_chat(said))
    if _PAUSES.search(said) is not None:
        said = _PAUSE_IN_PHRASE.sub(r"\1 ", _RESTART.sub("", said))
    said = _FILLERS.sub("", said)
    if len(set(words := said.split())) < len(words) - 2:
        said = _TWICE.sub(r"\1", said)
    if _repeats(said):
        said = _STUTTER.sub("", said)
    said = _homophones(said)
    without = without_slips(said)
    said = said if without == said else _taken_back(_homophones(without))
    return " ".join(_without_other_senses(said).split())


def _without_other_senses(said: str) -> str:
    """A text with "left" and "right" replaced by synonyms where they name no side: "what is left", "look right at me"."""
    return replaced(said, substitutions("no_side")) if "left" in said or "right" in said else said


def _repeats(said: str) -> bool:
    """Whether a word may follow itself: two words in a row begin with the same two letters, or a hyphen stands between."""
    begins = [word[:2] for word in said.split()]
    return "-" in said or any(a == b for a, b in pairwise(begins)) or re.search(r"[,.]\S", said) is not None


def _chat(said: str) -> str:
    return " ".join(_chat_word(token, _chat_words()) for token in said.split(" "))


@cache
def _chat_words() -> dict[str, str]:
    return dict(pairs("chat"))


def _chat_word(token: str, words: dict[str, str]) -> str:
    bare = token.strip(',.!?;:"()')
    said = words.get(bare) or _DROPPED_G.sub("ing", bare)
    if said == bare or not bare:
        return token
    start = token.index(bare)
    return token[:start] + said + token[start + len(bare) :]


def _taken_back(said: str) -> str:
    """A text without words that the speaker corrects at once: "left, I mean right" -> "right"."""
    return with_meant_command(replaced(said, _corrections()))


@cache
def _corrections() -> RuleTable:
    said = ((pattern.replace("@WAY", f"({WAY})"), words) for pattern, words in pairs("corrections"))
    return RuleTable(said)


def _homophones(said: str) -> str:
    return replaced(said, substitutions("homophones"))
