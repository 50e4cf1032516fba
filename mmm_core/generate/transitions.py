"""Makes the tokens between two consecutive motions: a body part that ends one where it begins the next keeps still.

The other body parts are generated. MMM (arXiv 2312.03596) sec. 3.3 generates two tokens with the end of one motion and the
beginning of the next as context. The shipped model would move arms there that should rest, since these tokens are conditioned
on the text of the first motion: in 20 of 80 pairs of commands a wrist left the straight path by more than 10 cm.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from mmm_core.generate.motion_model import MotionModel
from mmm_core.model.sampling import fill
from mmm_core.model.text import TextStates
from mmm_core.model.tokens import MAX_TOKENS
from mmm_core.motion.performing import motion_of
from mmm_core.motion.repetitions import body_path

TRANSITION_TOKENS = 2
"""Tokens between two commands: 0.4 s, as in the released model."""
STILL_M = 0.1
"""Metres between a body part at the end of one motion and at the beginning of the next up to which it keeps still."""
_SEEN_TOKENS = 4
"""Tokens at the end and at the beginning of the two motions that are decoded to locate the body parts."""
_PART_COLUMNS = {"left_arm": slice(0, 3), "right_arm": slice(3, 6), "rest": slice(6, 12)}
"""Columns of `body_path` that say where a body part is: wrists, head and trunk."""
_WHOLE_BODY = slice(0, 12)
"""Columns that say where the only part of a tokenizer is, or a part that is half of the body."""


def transitions(engine: MotionModel, rows: Sequence[Tensor], texts: Sequence[TextStates], seed: int) -> list[Tensor]:
    """(2, C) ids between neighbouring rows; the ids of parts that have to move are filled in one step and one batch.

    Args:
        engine: the model; an imported one generates the ids of all parts, as in its paper.
        rows: ids (L, C) of each motion; half of each row is the context.
        texts: states of the rows' texts; the condition of a transition is that of its left row.
        seed: of the transitions.
    """
    if len(rows) < 2:
        return []
    transformer = engine.model.transformer
    mask = transformer.ids.mask
    holes = [transition_row(a, b, mask) for a, b in pairwise(rows)]
    starts = [_half(left) for left in rows[:-1]]
    if engine.model.is_ours:
        for hole, start, (left, right), still in zip(holes, starts, pairwise(rows), _still(engine, rows), strict=True):
            hole[start, still], hole[start + 1, still] = left[-1, still], right[0, still]
    open_ = [i for i, hole in enumerate(holes) if bool((hole == mask).any())]
    if open_:
        texts_of = TextStates.stacked([texts[i] for i in open_])
        settings = replace(engine.settings, steps=1)
        filled = fill(transformer, texts_of, [holes[i] for i in open_], [seed] * len(open_), settings)
        for i, new in zip(open_, filled, strict=True):
            holes[i] = new
    return [hole[start : start + TRANSITION_TOKENS] for hole, start in zip(holes, starts, strict=True)]


def transition_row(left: Tensor, right: Tensor, mask_id: int) -> Tensor:
    """The end of `left`, [MASK]s, the beginning of `right`."""
    hole = left.new_full((TRANSITION_TOKENS, left.shape[1]), mask_id)
    return torch.cat([left[len(left) - _half(left) :], hole, right[: _half(right)]])


def _half(ids: Tensor) -> int:
    """Tokens of a row that serve as context: half of them, or one less in the longest rows, so that the transition fits too."""
    half = len(ids) // 2
    return half - 1 if 2 * half >= MAX_TOKENS - 1 else half


def _still(engine: MotionModel, rows: Sequence[Tensor]) -> list[Tensor]:
    """(C,) for each pair of neighbouring rows: whether the body part of a codebook ends where it begins again."""
    ends = [left[-_SEEN_TOKENS:] for left in rows[:-1]]
    begins = [right[:_SEEN_TOKENS] for right in rows[1:]]
    frames = [-1] * len(ends) + [0] * len(begins)
    features = [piece[frame] for piece, frame in zip(_decoded(engine, ends + begins), frames, strict=True)]
    ended, begun = np.split(body_path(motion_of(np.stack(features))), 2)
    of_parts = [_PART_COLUMNS.get(name, _WHOLE_BODY) for name in engine.model.tokenizer.part_names]
    apart_m = np.stack([np.linalg.norm(ended[:, part] - begun[:, part], axis=1) for part in of_parts], 1)
    return list(torch.from_numpy(apart_m < STILL_M))


def _decoded(engine: MotionModel, pieces: Sequence[Tensor]) -> list[NDArray[np.float32]]:
    """(4 L, 263) features of each piece (L, C), decoded by itself; pieces of one length are decoded in one batch."""
    of_length = {n: torch.stack([piece for piece in pieces if len(piece) == n]) for n in set(map(len, pieces))}
    decoded = {n: iter(engine.model.tokenizer.decode(batch).numpy()) for n, batch in of_length.items()}
    return [next(decoded[len(piece)]) for piece in pieces]
