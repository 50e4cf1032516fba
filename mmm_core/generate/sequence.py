"""Commands done one after another in one motion: a row of ids for each, and generated transitions between them.

A text of several commands (`mmm_core.language.clauses`) and a story (`mmm_core.generate.story`) both use it. Transitions:
MMM (arXiv 2312.03596) sec. 3.3, a few masked tokens filled with the end of one motion and the beginning of the next as
context.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import torch
from torch import Tensor

from mmm_core.generate.result import understood
from mmm_core.language.clauses import commands_in_turn
from mmm_core.model.sampling import SamplingSettings, fill
from mmm_core.model.text import TextStates
from mmm_core.model.tokens import MAX_TOKENS, tokens_for_frames

if TYPE_CHECKING:
    from mmm_core.generate.engine import Engine

TRANSITION_TOKENS = 2
"""Generated between two commands: 0.4 s, as in the released model."""
FEWEST_TOKENS = 4
"""Of a command among several, however short the whole is asked to be."""
COMMAND_STRIDE = 15_485_863
"""Between the seeds of a text's commands."""


@dataclass(frozen=True)
class Command:
    """One of the commands of a text.

    Attributes:
        text: its words.
        states: of its words.
        n_tokens: how many it takes.
        understood: the nearest known command and its score, where it is one of several.
    """

    text: str
    states: TextStates
    n_tokens: int
    understood: str = ""


def commands_of(engine: Engine, text: str, states: TextStates, n_frames: int | None) -> list[Command]:
    """The commands of a text, in order; one if it asks for one, or if a part of it alone is nothing that can be done.

    Args:
        engine: reads the parts and predicts their lengths.
        text: what is done of a text, as the model reads it.
        states: its states, as a whole.
        n_frames: of the whole; None lets the model choose. The commands share it as their own lengths are to each other.

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
            return [Command(t, s, n, understood(v)) for t, (s, v), n in zip(parts, read, own, strict=True)]
    n_frames = engine.predicted_frames(states) if n_frames is None else n_frames
    return [Command(text, states, tokens_for_frames(n_frames))]


def shared_out(room: int, wanted: Sequence[int]) -> list[int]:
    """`room` tokens shared in proportion to what is wanted, at least `FEWEST_TOKENS` each; they add up to `room`."""
    spare = room - FEWEST_TOKENS * len(wanted)
    ends = [round(spare * sum(wanted[: i + 1]) / sum(wanted)) for i in range(len(wanted))]
    return [FEWEST_TOKENS + end - start for start, end in pairwise([0, *ends])]


def joined(engine: Engine, commands: Sequence[Command], rows: Sequence[Tensor], seed: int) -> Tensor:
    """(L, C) ids of the commands' rows and the transitions between them."""
    between = transitions(engine, rows, [c.states for c in commands], seed)
    ids = rows[0]
    for hole, row in zip(between, rows[1:], strict=True):
        ids = torch.cat([ids, hole, row])
    return ids


def transitions(engine: Engine, rows: Sequence[Tensor], texts: Sequence[TextStates], seed: int) -> list[Tensor]:
    """(2, C) ids between neighbours, for the left one's text: half of each row is the context. One step, one batch."""
    if len(rows) < 2:
        return []
    transformer = engine.model.transformer
    holes = [transition_row(a, b, transformer.ids.mask) for a, b in pairwise(rows)]
    settings = replace(engine.settings, steps=1)
    filled = fill(transformer, TextStates.stacked(list(texts[:-1])), holes, [seed] * len(holes), settings)
    return [new[(row == transformer.ids.mask).any(-1)] for new, row in zip(filled, holes, strict=True)]


def transition_row(left: Tensor, right: Tensor, mask_id: int) -> Tensor:
    """End of `left`, [MASK]s, beginning of `right`."""
    hole = left.new_full((TRANSITION_TOKENS, left.shape[1]), mask_id)
    return torch.cat([left[len(left) - _half(left) :], hole, right[: _half(right)]])


def official_transition_settings(settings: SamplingSettings) -> SamplingSettings:
    """As the released code fills transitions: one step at temperature 1."""
    return replace(settings, official=True, steps=1, temperature=1.0)


def _half(ids: Tensor) -> int:
    """Half of a row, as context; the longest rows give one token less, so that both halves and the hole fit."""
    half = len(ids) // 2
    return half - 1 if 2 * half >= MAX_TOKENS - 1 else half
