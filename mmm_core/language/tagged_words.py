"""Words of a sentence with their tags, and the commands that the tags mark.

A tagger gives each word one of `TAGS`: outside every command; said for all commands; denied; inside the command before it; or
first word of a command, with the relation to the command before it in the sentence (done next, at the same time, before it, or
the same command, taken up again). "before you [clap], [raise your arms]" has "then" at "clap" and "before" at "raise".

It also gives each word one of `MANNERS`: the tempo or the size that the word helps to ask for.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

OUTSIDE, FOR_ALL, DENIED, INSIDE, THEN, WITH, BEFORE, AGAIN = TAGS = (
    "outside", "for_all", "denied", "inside", "then", "with", "before", "again",
)  # fmt: skip
NO_MANNER, SLOW, FAST, SMALL, LARGE = MANNERS = ("none", "slow", "fast", "small", "large")
BEGINS = frozenset({THEN, WITH, BEFORE, AGAIN})
"""Tags of the first word of a command."""
_WORD = re.compile(r"[A-Za-z0-9_'\u2019-]+|[^\sA-Za-z0-9_'\u2019-]")
_INSIDE = TAGS.index(INSIDE)
_MAY_BE_INSIDE = np.array([tag in BEGINS or tag == INSIDE for tag in TAGS])
"""For each tag, whether the word after it may be inside the same command."""


@dataclass(frozen=True)
class MarkedCommands:
    """The commands that tags mark in a sentence, in the sentence's own words.

    Attributes:
        steps: commands in order of execution; each step holds the commands done at the same time.
        denied: acts that are not to be done.
        for_all: words that belong to every command, such as a hand or a tempo.
        numbers: for each command of the steps in order, the numbers of its words in `words_of`.
    """

    steps: tuple[tuple[str, ...], ...]
    denied: tuple[str, ...]
    for_all: tuple[str, ...]
    numbers: tuple[tuple[int, ...], ...] = ()


def words_of(sentence: str) -> list[tuple[int, int]]:
    """Start and end of each word and each punctuation mark of a sentence, in characters."""
    return [(m.start(), m.end()) for m in _WORD.finditer(sentence)]


def likely_tags(log_probability: NDArray[np.float32], n: int) -> list[tuple[list[str], float]]:
    """The n likeliest sequences of tags in which a word inside a command follows another word of that command (list Viterbi).

    Args:
        log_probability: (N, 8) log-probability of each of `TAGS` for each of N words.
        n: number of sequences, at most.

    Returns:
        Each sequence with the logarithm of its probability, the likeliest first.
    """
    scores = np.full((len(TAGS), 1), -np.inf)
    scores[:, 0] = log_probability[0]
    scores[_INSIDE] = -np.inf
    came_from: list[NDArray[np.intp]] = []
    for row in log_probability[1:]:
        n_each = scores.shape[1]
        any_before = _largest(scores.ravel(), n)
        allowed = np.where(_MAY_BE_INSIDE[:, None], scores, -np.inf)
        before = np.tile(any_before, (len(TAGS), 1))
        before[_INSIDE] = _largest(allowed.ravel(), n)
        scores_before = np.where(
            np.arange(len(TAGS))[:, None] == _INSIDE, allowed.ravel()[before], scores.ravel()[before]
        )
        came_from.append(np.stack([before // n_each, before % n_each]))
        scores = scores_before + row[:, None]
    found: list[tuple[list[str], float]] = []
    for at in _largest(scores.ravel(), n):
        score = scores.ravel()[at]
        if score == -np.inf:
            break
        tag, rank = divmod(int(at), scores.shape[1])
        path = [tag]
        for tags, ranks in reversed(came_from):
            tag, rank = int(tags[tag, rank]), int(ranks[tag, rank])
            path.append(tag)
        found.append(([TAGS[i] for i in reversed(path)], float(score)))
    return found


def _largest(values: NDArray[np.float64], n: int) -> NDArray[np.intp]:
    """The indices of the n largest values, the largest first."""
    return np.argsort(-values, kind="stable")[:n]


def marked_commands(sentence: str, tags: Sequence[str]) -> MarkedCommands:
    """The commands that tags mark.

    Args:
        sentence: the sentence.
        tags: one of `TAGS` for each of its `words_of`.
    """
    spans = words_of(sentence)
    commands: list[list[int]] = []
    order: list[list[int]] = []
    beside: dict[str, list[list[int]]] = {DENIED: [], FOR_ALL: []}
    current: list[int] = []
    last = OUTSIDE
    for i, tag in enumerate(tags):
        if tag in BEGINS and not (tag == AGAIN and commands):
            commands.append([i])
            if tag == WITH and current:
                current.append(len(commands) - 1)
            else:
                at = next((k for k, step in enumerate(order) if step is current), -1)
                current = [len(commands) - 1]
                order.insert(at if tag == BEFORE and at >= 0 else at + 1, current)
        elif tag in (AGAIN, INSIDE) and commands:
            commands[-1].append(i)
        elif tag in beside:
            if tag != last:
                beside[tag].append([])
            beside[tag][-1].append(i)
        last = tag
    said = [_words(sentence, spans, command) for command in commands]
    return MarkedCommands(
        tuple(tuple(said[k] for k in step) for step in order),
        tuple(_words(sentence, spans, act) for act in beside[DENIED]),
        tuple(_words(sentence, spans, words) for words in beside[FOR_ALL]),
        tuple(tuple(commands[k]) for step in order for k in step),
    )


def _words(sentence: str, spans: Sequence[tuple[int, int]], chosen: Sequence[int]) -> str:
    """Chosen words of a sentence, with the sentence's own spaces between neighbours and one space between others."""
    said = ""
    for k, i in enumerate(chosen):
        start, end = spans[i]
        if k:
            said += sentence[spans[i - 1][1] : start] if chosen[k - 1] == i - 1 else " "
        said += sentence[start:end]
    return said
