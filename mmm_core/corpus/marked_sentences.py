"""Sentences with marks around their commands or their manner: what the sentence tagger learns from.

A sentence is written with all its words, and brackets around those that matter: `[1 ...]` a command of the first step, `[2a ...]` and
`[2b ...]` commands of the second step at the same time, `[- ...]` an act that is denied, `[* ...]` words for all commands, `[x ...]` words that
the speaker takes back. Words outside brackets are not needed: politeness, audiences, reasons, words of order. A command may name
the corpus's gesture that it means in its sentence, with hyphens for spaces: `[2:point/up-left the other one at the lamp]`.

Other sentences have braces around the words that say tempo or size: `{slow: ...}`, `{fast: ...}`, `{small: ...}`, `{large: ...}`.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from mmm_core.errors import TrainingDataError
from mmm_core.language.plain_gestures import OUTSIDE as NO_GESTURE
from mmm_core.language.tagged_words import (
    AGAIN,
    BEFORE,
    DENIED,
    FOR_ALL,
    INSIDE,
    NO_MANNER,
    OUTSIDE,
    THEN,
    WITH,
    words_of,
)

_PROMPTS = Path(__file__).parent / "prompts"
MARKED_SENTENCES, MANNER_SENTENCES = _PROMPTS / "marked_sentences.txt", _PROMPTS / "manner_sentences.txt"
"""The sentences that ship, with marked commands and with marked manner, one a line; lines that begin with # are comments."""
_MARK = re.compile(r"\[(?P<label>\d[a-z]?|[-*xX])(?::(?P<gesture>[a-z_/-]+))? (?P<words>[^\[\]]*)\]")
_MANNER_MARK = re.compile(r"\{(?P<label>slow|fast|small|large): *(?P<words>[^{}]*)\}")
_BEFORE_MARK = re.compile(r" (?=[,.;:!?])")
_BESIDE = {"-": DENIED, "*": FOR_ALL, "x": OUTSIDE}


@dataclass(frozen=True)
class TaggedSentence:
    """The words of a sentence, punctuation marks included, with what was marked.

    Attributes:
        words: the words.
        tags: of each word, one of `mmm_core.language.tagged_words.TAGS`; empty where commands were not marked.
        manners: of each word, one of `mmm_core.language.tagged_words.MANNERS`; empty where manner was not marked.
        gestures: commands whose gesture is known: first word, word after the last, and the gesture's name.
    """

    words: tuple[str, ...]
    tags: tuple[str, ...] = ()
    manners: tuple[str, ...] = ()
    gestures: tuple[tuple[int, int, str], ...] = ()


def read_marked(line: str, path: Path = MARKED_SENTENCES) -> tuple[str, list[str]]:
    """A marked sentence as plain text, and the tag of each of its words; see `read_commands`."""
    sentence, tags, _ = read_commands(line, path)
    return sentence, tags


def read_commands(line: str, path: Path = MARKED_SENTENCES) -> tuple[str, list[str], list[tuple[int, int, str]]]:
    """A marked sentence as plain text, the tag of each of its words, and its commands of known gesture, as in `TaggedSentence`.

    Args:
        line: the marked sentence.
        path: its file, which an error names.

    Raises:
        TrainingDataError: a bracket is open, nested or without a label.

    >>> read_commands("before you [2:clap clap], [1 raise your arms]")
    ('before you clap, raise your arms', ['outside', 'outside', 'then', 'outside', 'before', 'inside', 'inside'], [(2, 3, 'clap')])
    """
    sentence, marks = _without_marks(line, _MARK)
    if "[" in sentence or "]" in sentence:
        raise TrainingDataError(
            path, "", f"a bracket that is no mark in {line!r}", "[1 ...], [2a ...], [- ...], [* ...] or [x ...]"
        )
    spans = words_of(sentence)
    tags = [OUTSIDE] * len(spans)
    seen: list[str] = []
    gestures: list[tuple[int, int, str]] = []
    for start, end, mark in marks:
        label = mark["label"].lower()
        inside = [i for i, (a, b) in enumerate(spans) if a >= start and b <= end]
        for i in inside:
            tags[i] = _BESIDE.get(label, INSIDE)
        if label not in _BESIDE and inside:
            tags[inside[0]] = _relation(label, seen)
            seen = [*(other for other in seen if other != label), label]
            if mark["gesture"]:
                gestures.append((inside[0], inside[-1] + 1, mark["gesture"].replace("-", " ")))
    return sentence, tags, gestures


def read_manner(line: str, path: Path = MANNER_SENTENCES) -> tuple[str, list[str]]:
    """A sentence with marked manner as plain text, and the manner of each of its words.

    Args:
        line: the marked sentence.
        path: its file, which an error names.

    Raises:
        TrainingDataError: a brace is open, nested or without a manner.

    >>> read_manner("nod {slow: at a crawl}")
    ('nod at a crawl', ['none', 'slow', 'slow', 'slow'])
    """
    sentence, marks = _of_manner(line, path)
    manners = [
        next((mark["label"] for start, end, mark in marks if start <= a and b <= end), NO_MANNER)
        for a, b in words_of(sentence)
    ]
    return sentence, manners


def marked_manners(line: str, path: Path = MANNER_SENTENCES) -> tuple[str, list[tuple[str, str]]]:
    """A sentence with marked manner as plain text, and each manner with its words.

    Raises:
        TrainingDataError: as `read_manner`.

    >>> marked_manners("nod {slow: at a crawl}")
    ('nod at a crawl', [('slow', 'at a crawl')])
    """
    sentence, marks = _of_manner(line, path)
    return sentence, [(mark["label"], mark["words"]) for _, _, mark in marks]


def _of_manner(line: str, path: Path) -> tuple[str, list[tuple[int, int, re.Match[str]]]]:
    sentence, marks = _without_marks(line, _MANNER_MARK)
    if "{" in sentence or "}" in sentence:
        raise TrainingDataError(
            path, "", f"a brace that is no mark in {line!r}", "{slow: ...}, {fast: ...}, {small: ...} or {large: ...}"
        )
    return sentence, marks


def _without_marks(line: str, pattern: re.Pattern[str]) -> tuple[str, list[tuple[int, int, re.Match[str]]]]:
    """A line without its marks; each mark with first character and end of its words."""
    sentence, at = "", 0
    marks: list[tuple[int, int, re.Match[str]]] = []
    for mark in pattern.finditer(line):
        sentence += line[at : mark.start()]
        marks.append((len(sentence), len(sentence) + len(mark["words"]), mark))
        sentence, at = sentence + mark["words"], mark.end()
    return sentence + line[at:], marks


def load_marked_sentences(path: Path = MARKED_SENTENCES) -> list[TaggedSentence]:
    """The sentences of a file with marked commands.

    Raises:
        TrainingDataError: the file is missing, or a line is not well marked.
    """
    read = [read_commands(line, path) for line in lines_of(path)]
    return [
        TaggedSentence(_words(sentence), tags=tuple(tags), gestures=tuple(gestures))
        for sentence, tags, gestures in read
    ]


def load_manner_sentences(path: Path = MANNER_SENTENCES) -> list[TaggedSentence]:
    """The sentences of a file with marked manner.

    Raises:
        TrainingDataError: the file is missing, or a line is not well marked.
    """
    read = [read_manner(line, path) for line in lines_of(path)]
    return [TaggedSentence(_words(sentence), manners=tuple(manners)) for sentence, manners in read]


def joined(words: Sequence[str]) -> str:
    """A sentence of words and punctuation marks."""
    return _BEFORE_MARK.sub("", " ".join(words))


def asked_in(one: TaggedSentence) -> list[tuple[str, str, tuple[int, int]]]:
    """The sentence with each of its commands of known gesture, and with each denied act, which is no gesture that is asked for.

    Each comes with its gesture, or the class of texts that are none, and with its first character and its end.
    """
    denied = [i for i, tag in enumerate(one.tags) if tag == DENIED]
    runs = [(i, next(k for k in range(i, len(one.tags) + 1) if k not in denied)) for i in denied if i - 1 not in denied]
    return [
        (joined(one.words), name, (len(joined((*one.words[:start], "x"))) - 1, len(joined(one.words[:end]))))
        for start, end, name in (*one.gestures, *((start, end, NO_GESTURE) for start, end in runs))
    ]


def _words(sentence: str) -> tuple[str, ...]:
    return tuple(sentence[a:b] for a, b in words_of(sentence))


def lines_of(path: Path) -> list[str]:
    """The lines of a file of sentences, without comments and empty ones.

    Raises:
        TrainingDataError: the file cannot be read.
    """
    try:
        lines = path.read_text("utf-8").splitlines()
    except OSError as error:
        raise TrainingDataError(path, "", f"cannot be read ({error})", "marked sentences, one a line") from error
    return [line.strip() for line in lines if line.strip() and not line.startswith("#")]


def _relation(label: str, seen: list[str]) -> str:
    """The tag of a command's first word, after the labels of the commands before it in the sentence."""
    if not seen:
        return THEN
    if label in seen:
        return AGAIN
    if label[0] == seen[-1][0]:
        return WITH
    return THEN if label[0] > seen[-1][0] else BEFORE
