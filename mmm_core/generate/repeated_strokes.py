"""Makes as many strokes as a text names: the model performs two of them, and the tokens of one period are repeated.

A gesture without strokes begins and ends at rest, so the tokens of the whole are repeated ("salute twice").

Parallel decoding keeps the sense of a repeated gesture and loses count of its strokes, the more of them the oftener, but two
strokes are nearly always right (docs/model.md). All strokes of a gesture take the same whole number of tokens, so a text with one
more stroke is longer by that number, and the length predictor tells it without seeing the motion. It errs now and then; of
the periods that it names, that one is taken after which the motion returns nearest to where it was, as a share of its movement.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

import torch
from torch import Tensor

from mmm_core.generate.interpretation import ReadCommand
from mmm_core.generate.motion_model import MotionModel
from mmm_core.language.count_words import count_asked, with_count
from mmm_core.language.mirroring import mirror_words
from mmm_core.language.whole_gestures import once
from mmm_core.model.tokenizer import Tokenizer
from mmm_core.model.tokens import FRAMES_PER_TOKEN
from mmm_core.model.vqvae import VqVae

PERFORMED = 2
"""Strokes that the model makes itself."""
FROM_COUNT = 3
"""Number of strokes from which on a period is repeated."""
_COUNTS_COMPARED = range(PERFORMED, 7)
"""Numbers of strokes whose predicted lengths tell the period; more would not fit into the longest motion that is learnt."""
_MOST_STROKES_APART = 3
_PERIODS = range(2, 15)
"""Tokens that a stroke may take."""
_IN_TURN = 1.5
"""Factor on the distance over two periods, after which arms that take turns return; other motions return after one as well."""
_SEAM_TOKENS = 2
"""Tokens up to both ends of the repeated part whose frames are compared."""
_STILL = 1e-9
_FARTHEST = 1.0
"""Largest distance between the two ends of a repeated part, as a share of its movement; the model makes such strokes itself."""


class Repetition(NamedTuple):
    """How often the generator repeats a command.

    Attributes:
        times: strokes, or performances of the whole gesture.
        of_whole: whether the gesture has no strokes.
    """

    times: int
    of_whole: bool = False


def with_few_strokes(
    engine: MotionModel, steps: Sequence[tuple[ReadCommand, ...]]
) -> tuple[list[tuple[ReadCommand, ...]], list[Repetition | None]]:
    """The steps with two strokes in place of many, or one whole gesture, as the model reads them, and what is to be repeated.

    This is None where a step stays as it is: several commands at once, no number in the words, or a number that the model
    makes itself.
    """
    found: list[tuple[ReadCommand, ...]] = []
    repetitions: list[Repetition | None] = []
    for step in steps:
        words, repetition = _few_of(step[0]) if len(step) == 1 else ("", None)
        found.append((replace(step[0], states=engine.read([words])),) if words else step)
        repetitions.append(repetition)
    return found, repetitions


def expected_tokens(n_tokens: int, repetition: Repetition | None) -> int:
    """Roughly the tokens of a motion whose two strokes or one whole gesture take `n_tokens`, before its period is known."""
    if repetition is None:
        return n_tokens
    times, of_whole = repetition
    return times * n_tokens if of_whole else n_tokens + (times - PERFORMED) * (n_tokens // 4)


def repeated(
    engine: MotionModel,
    tokenizer: Tokenizer | VqVae,
    command: ReadCommand,
    ids: Tensor,
    repetition: Repetition,
    opening: int,
) -> Tensor | None:
    """(L', C) ids of all strokes, from ids (L, C) of two; None where no part of them returns to its beginning.

    Args:
        engine: predicts lengths.
        tokenizer: decodes the motion that is compared with itself.
        command: the command, whose words name the number.
        ids: its two strokes, or the whole gesture.
        repetition: what is wanted.
        opening: tokens at the beginning that stay.
    """
    if repetition.of_whole:
        return torch.cat([ids] * repetition.times)
    count = repetition.times
    features = tokenizer.decode(ids[None])[0].reshape(len(ids), -1)
    best, found = _FARTHEST, None
    for period in periods(engine, command):
        for strokes, dearness in ((1, 1.0), (2, _IN_TURN)):
            n, times = strokes * period, (count - PERFORMED) // strokes
            if (count - PERFORMED) % strokes:
                continue
            for start in range(max(opening, _SEAM_TOKENS - 1), len(ids) - n):
                before, after = (features[k - _SEAM_TOKENS + 1 : k + 1] for k in (start, start + n))
                movement = features[start : start + n].std(0, correction=0).mean()  # where it stands still all is alike
                apart = dearness * float((before - after).abs().mean() / (movement + _STILL))
                if apart < best:
                    best = apart
                    found = torch.cat([ids[: start + n], *[ids[start : start + n]] * times, ids[start + n :]])
    return found


def periods(engine: MotionModel, command: ReadCommand) -> list[int]:
    """Tokens that one stroke of a command may take: differences of the lengths predicted for other numbers of strokes."""
    words = {n: text for n in _COUNTS_COMPARED if (text := _words_of(command, n)) is not None}
    states = engine.read(list(words.values()))
    lengths = {n: engine.predicted_frames(states.row(i)) // FRAMES_PER_TOKEN for i, n in enumerate(words)}
    several = {
        Fraction(lengths[b] - lengths[a], b - a) for a in words for b in words if 0 < b - a <= _MOST_STROKES_APART
    }
    return sorted(int(p) for p in several if p.denominator == 1 and p in _PERIODS)


def _few_of(command: ReadCommand) -> tuple[str, Repetition | None]:
    """The words of two strokes or one whole gesture, and what is to be repeated; no words where a command stays as it is."""
    count = count_asked(command.text)
    if count is None:
        return "", None
    if words := once(command.text):
        return mirror_words(words) if command.is_mirrored else words, Repetition(count, of_whole=True)
    words = _words_of(command, PERFORMED)
    return (words, Repetition(count)) if words else ("", None)


def _words_of(command: ReadCommand, count: int) -> str | None:
    """The words that the model reads for a command with `count` strokes; None where its words name none, or few."""
    asked = count_asked(command.text)
    words = None if asked is None or asked < FROM_COUNT else with_count(command.text, count)
    return mirror_words(words) if words is not None and command.is_mirrored else words
