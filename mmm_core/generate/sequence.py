"""Steps done one after another in one motion: a row of ids for each, and generated transitions between them.

A text of several commands (`mmm_core.language.reading`) and a story (`mmm_core.generate.story`) both use it. Transitions:
MMM (arXiv 2312.03596) sec. 3.3, a few masked tokens filled with the end of one motion and the beginning of the next as
context.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import torch
from torch import Tensor

from mmm_core.generate.interpretation import Interpreted, ReadCommand
from mmm_core.generate.motion_model import MotionModel
from mmm_core.language.manner import Manner
from mmm_core.model.sampling import fill
from mmm_core.model.text import TextStates
from mmm_core.model.tokens import FRAMES_PER_TOKEN, MAX_TOKENS, tokens_for_frames
from mmm_core.motion.performing import Stretch

TRANSITION_TOKENS = 2
"""Tokens generated between two commands: 0.4 s, as in the released model."""
FEWEST_TOKENS = 4
"""Tokens that a command among several keeps at least, however short the whole motion is to be."""
COMMAND_STRIDE = 15_485_863
"""Distance between the seeds of a text's steps."""
TOGETHER_STRIDE = 1_299_709
"""Distance between the seeds of commands that are done at the same time."""


@dataclass(frozen=True)
class Step:
    """Commands of a text that are done at the same time.

    Attributes:
        commands: one or more.
        n_tokens: length of their motion.
        own_tokens: length of each command's own motion; empty where they are all `n_tokens`.
    """

    commands: tuple[ReadCommand, ...]
    n_tokens: int
    own_tokens: tuple[int, ...] = ()

    def tokens_of(self, k: int) -> int:
        """Length of the k-th command's own motion: a pose lasts as long as the step, a stroke no longer than it would alone."""
        is_whole = len(self.commands) == 1 or not self.own_tokens or self.commands[k].is_pose
        return self.n_tokens if is_whole else min(self.n_tokens, self.own_tokens[k])

    @property
    def manner(self) -> Manner:
        """The manner of the step: the strongest that one of its commands names."""
        manners = [c.manner for c in self.commands]
        return Manner(
            max((m.tempo for m in manners), key=lambda f: abs(f - 1)),
            max((m.size for m in manners), key=lambda f: abs(f - 1)),
            max(m.hold_s for m in manners),
        )

    @property
    def words(self) -> str:
        """The words of its commands."""
        return " and ".join(c.text for c in self.commands)

    @property
    def understood(self) -> str:
        """The nearest known commands and their scores; empty for a text of one command."""
        return " and ".join(c.understood for c in self.commands if c.understood)

    @property
    def states(self) -> TextStates:
        """States of its first command."""
        return self.commands[0].states


def steps_of(engine: MotionModel, read: Interpreted, n_frames: int | None) -> list[Step]:
    """The steps of a text with their lengths.

    Args:
        engine: predicts the lengths.
        read: the text.
        n_frames: length of the whole motion, shared in proportion to the steps' own lengths; None lets the model choose.

    Raises:
        GenerationError: `n_frames` is None and the model has no length predictor.
    """
    steps = read.steps
    if len(steps) == 1 and len(steps[0]) == 1:
        command = steps[0][0]
        own = engine.predicted_frames(command.states) if n_frames is None else _before_tempo(n_frames, command.manner)
        return [Step(steps[0], tokens_for_frames(own))]
    whole = MAX_TOKENS if n_frames is None else tokens_for_frames(n_frames)
    steps = steps[: max(1, (whole + TRANSITION_TOKENS) // (FEWEST_TOKENS + TRANSITION_TOKENS))]
    own = [tuple(tokens_for_frames(engine.predicted_frames(c.states)) for c in step) for step in steps]
    lengths = [max(several) for several in own]
    room = whole - TRANSITION_TOKENS * (len(steps) - 1)
    if len(steps) == 1 and n_frames is not None:
        lengths = [room]
    elif n_frames is not None or sum(lengths) > room:
        lengths = shared_out(room, lengths)
    return [Step(step, n, several) for step, n, several in zip(steps, lengths, own, strict=True)]


def stretches_of(steps: Sequence[Step], n_tokens: Sequence[int]) -> list[Stretch]:
    """Frames of a motion in the manner of each step, given the lengths of its rows.

    A transition goes with the step that it leads to.
    """
    found: list[Stretch] = []
    for i, (n, step) in enumerate(zip(n_tokens, steps, strict=False)):
        start = found[-1].end if found else 0
        end = start + (n + (TRANSITION_TOKENS if i else 0)) * FRAMES_PER_TOKEN
        found.append(Stretch(start, end, step.manner.tempo, step.manner.size, step.manner.hold_s))
    return found


def _before_tempo(n_frames: int, manner: Manner) -> int:
    """Frames that a motion has before its tempo brings it to `n_frames`."""
    return max(FRAMES_PER_TOKEN, min(MAX_TOKENS * FRAMES_PER_TOKEN, round(n_frames * manner.tempo)))


def shared_out(room: int, wanted: Sequence[int]) -> list[int]:
    """Shares of `room` tokens in proportion to `wanted`, each at least `FEWEST_TOKENS`; their sum is `room`."""
    spare = room - FEWEST_TOKENS * len(wanted)
    ends = [round(spare * sum(wanted[: i + 1]) / sum(wanted)) for i in range(len(wanted))]
    return [FEWEST_TOKENS + end - start for start, end in pairwise([0, *ends])]


def joined(engine: MotionModel, steps: Sequence[Step], rows: Sequence[Tensor], seed: int) -> Tensor:
    """(L, C) ids of the steps' rows and the transitions between them."""
    between = transitions(engine, rows, [s.states for s in steps], seed)
    ids = rows[0]
    for hole, row in zip(between, rows[1:], strict=True):
        ids = torch.cat([ids, hole, row])
    return ids


def transitions(engine: MotionModel, rows: Sequence[Tensor], texts: Sequence[TextStates], seed: int) -> list[Tensor]:
    """(2, C) ids between neighbouring rows, filled in one step and one batch.

    The text is that of the left row; half of each row is the context.
    """
    if len(rows) < 2:
        return []
    transformer = engine.model.transformer
    holes = [transition_row(a, b, transformer.ids.mask) for a, b in pairwise(rows)]
    settings = replace(engine.settings, steps=1)
    filled = fill(transformer, TextStates.stacked(list(texts[:-1])), holes, [seed] * len(holes), settings)
    return [new[(row == transformer.ids.mask).any(-1)] for new, row in zip(filled, holes, strict=True)]


def transition_row(left: Tensor, right: Tensor, mask_id: int) -> Tensor:
    """The end of `left`, [MASK]s, the beginning of `right`."""
    hole = left.new_full((TRANSITION_TOKENS, left.shape[1]), mask_id)
    return torch.cat([left[len(left) - _half(left) :], hole, right[: _half(right)]])


def _half(ids: Tensor) -> int:
    """Tokens of a row that serve as context: half of them, one less in the longest rows, so that both halves and the hole fit."""
    half = len(ids) // 2
    return half - 1 if 2 * half >= MAX_TOKENS - 1 else half
