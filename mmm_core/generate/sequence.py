"""Commands done one after another in one motion: a row of ids for each, and generated transitions between them.

A text of several commands (`mmm_core.language.clauses`) and a story (`mmm_core.generate.story`) both use it. Transitions:
MMM (arXiv 2312.03596) sec. 3.3, a few masked tokens filled with the end of one motion and the beginning of the next as
context.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import torch
from torch import Tensor

from mmm_core.generate.motion_model import MotionModel
from mmm_core.generate.result import understood_as
from mmm_core.language.clauses import commands_in_turn
from mmm_core.model.sampling import fill
from mmm_core.model.text import TextStates
from mmm_core.model.tokens import MAX_TOKENS, tokens_for_frames

TRANSITION_TOKENS = 2
"""Tokens generated between two commands: 0.4 s, as in the released model."""
FEWEST_TOKENS = 4
"""Tokens that a command among several keeps at least, however short the whole motion is to be."""
COMMAND_STRIDE = 15_485_863
"""Distance between the seeds of a text's commands."""


@dataclass(frozen=True)
class Command:
    """One of the commands of a text.

    Attributes:
        text: the command's words.
        states: the text encoder's states of these words.
        n_tokens: length of the command's motion.
        understood: the nearest known command and its score; empty for a text of one command.
    """

    text: str
    states: TextStates
    n_tokens: int
    understood: str = ""


def commands_of(engine: MotionModel, text: str, states: TextStates, n_frames: int | None) -> list[Command]:
    """Commands of a text, in order. A text stays one command where a part of it, read alone, would be rejected.

    Args:
        engine: reads the parts and predicts their lengths.
        text: the part of a user's text that is carried out, as the model reads it.
        states: states of the whole `text`.
        n_frames: length of the whole motion, shared in proportion to the commands' own lengths; None lets the model
            choose.

    Raises:
        GenerationError: `n_frames` is None and the model has no length predictor.
    """
    parts = commands_in_turn(text) if engine.model.scope is not None else []
    if len(parts) > 1:
        read = engine.understand_all(parts)
        between = TRANSITION_TOKENS * (len(parts) - 1)
        room = (MAX_TOKENS if n_frames is None else tokens_for_frames(n_frames)) - between
        if room >= FEWEST_TOKENS * len(parts) and all(v.status != "rejected" for _, v in read):
            own = [tokens_for_frames(engine.predicted_frames(s)) for s, _ in read]
            if n_frames is not None or sum(own) > room:
                own = shared_out(room, own)
            return [Command(t, s, n, understood_as(v)) for t, (s, v), n in zip(parts, read, own, strict=True)]
    n_frames = engine.predicted_frames(states) if n_frames is None else n_frames
    return [Command(text, states, tokens_for_frames(n_frames))]


def shared_out(room: int, wanted: Sequence[int]) -> list[int]:
    """Shares of `room` tokens in proportion to `wanted`, each at least `FEWEST_TOKENS`; their sum is `room`."""
    spare = room - FEWEST_TOKENS * len(wanted)
    ends = [round(spare * sum(wanted[: i + 1]) / sum(wanted)) for i in range(len(wanted))]
    return [FEWEST_TOKENS + end - start for start, end in pairwise([0, *ends])]


def joined(engine: MotionModel, commands: Sequence[Command], rows: Sequence[Tensor], seed: int) -> Tensor:
    """(L, C) ids of the commands' rows and the transitions between them."""
    between = transitions(engine, rows, [c.states for c in commands], seed)
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
