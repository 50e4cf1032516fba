"""Edits the ids of a repeated gesture until it has as many strokes as the text names.

Parallel decoding keeps the sense of a repeated gesture but loses count of it (docs/model.md). Where a text names a number,
the model generates several candidates and `mmm_core.motion.repetitions` counts their strokes. In the candidate with the
nearest count, the tokens of one stroke, from peak to peak, are repeated for each missing stroke, or the tokens of surplus
strokes are removed. Each seam is a [MASK] that the model fills (MMM, arXiv 2312.03596, sec. 3.3: any part may be given).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import torch
from torch import Tensor

from mmm_core.generate.motion_model import MotionModel
from mmm_core.language.scope import ScopeVerdict
from mmm_core.model.sampling import fill
from mmm_core.model.text import TextStates
from mmm_core.model.tokens import FRAMES_PER_TOKEN, MAX_TOKENS
from mmm_core.motion.repetitions import Strokes, strokes_of

CLEAR = 0.3
"""Largest misfit of a cycle whose strokes may be removed; a motion that repeats itself less clearly keeps all strokes."""
ALIKE = 0.5
"""Largest distance between the body before and after a single stroke, as a share of the distance to the stroke's peak."""
_LONGEST_FRAMES, _SHORTEST_FRAMES, _AWAY = 28, 4, 0.6
"""Frames from the peak of a single stroke to its beginning or end, at most and at least; least distance of the body from the
peak at those frames, as a share of the greatest distance nearby."""
_UNCLEAR, _NONE, _PER_MISFIT = 0.5, 3.0, 0.8
"""Costs of an unsure count, of a motion without a stroke and of a unit of misfit; a missing or surplus stroke costs 1."""
_TAKEN = ScopeVerdict("accepted", 1.0, "", "")


def ids_of_count(engine: MotionModel, states: TextStates, made: Sequence[Tensor], count: int, seed: int) -> Tensor:
    """(L, C) ids of a command that names `count` strokes: the best of the candidates (n_tokens, C), edited towards that count."""
    transformer = engine.model.transformer
    features = engine.model.tokenizer.decode(torch.stack(list(made))).numpy()
    motions = [engine.motion_of_features(f, ids, "", seed, _TAKEN) for f, ids in zip(features, made, strict=True)]
    ids, strokes = min(zip(made, map(strokes_of, motions), strict=True), key=lambda pair: _far_from(count, pair[1]))
    row = None if strokes is None else with_count(ids, strokes, count, transformer.ids.mask)
    at_once = replace(engine.settings, steps=1)
    return ids if row is None else fill(transformer, states, [row], [seed], at_once)[0]


def with_count(ids: Tensor, strokes: Strokes, count: int, mask_id: int) -> Tensor | None:
    """(L, C) ids with `count` strokes, or as many as fit into the longest motion, and a [MASK] at each seam.

    None where the count is right already or no stroke can be repeated or removed.
    """
    missing = count - len(strokes.frames)
    if missing == 0 or not strokes.frames:
        return None
    if missing < 0:
        return _without(ids, strokes, -missing, mask_id) if strokes.sure and strokes.misfit <= CLEAR else None
    whole = _between_peaks(strokes) if len(strokes.frames) > 1 else _around_peak(strokes)
    if whole is None:
        return None
    start, n_tokens = _token(whole[0]), max(1, _token(whole[1] - whole[0]))
    again = min(missing, (MAX_TOKENS - len(ids)) // n_tokens)
    if again <= 0:
        return None
    stroke = _opened(ids[start : start + n_tokens], mask_id)
    return torch.cat([ids[: start + n_tokens], *[stroke] * again, _opened(ids[start + n_tokens :], mask_id)])


def _far_from(count: int, strokes: Strokes | None) -> float:
    """Cost of a candidate: its missing or surplus strokes, and how unclear its strokes are."""
    if strokes is None:
        return float("inf")
    found = len(strokes.frames)
    return abs(found - count) + _UNCLEAR * (not strokes.sure) + _NONE * (not found) + _PER_MISFIT * strokes.misfit


def _between_peaks(strokes: Strokes) -> tuple[int, int]:
    """First frame and end of the stroke that returns nearest to its beginning; whole tokens are preferred."""

    def cost(pair: tuple[int, int]) -> float:
        tokens = (pair[1] - pair[0]) / FRAMES_PER_TOKEN
        return strokes.apart(*pair) + 0.02 * abs(tokens - round(tokens))

    return min(pairwise(strokes.frames), key=cost)


def _around_peak(strokes: Strokes) -> tuple[int, int] | None:
    """First frame and end of the only stroke, with the body in nearly the same pose at both; None where there are none."""
    peak = strokes.frames[0]
    first, end = max(0, peak - _LONGEST_FRAMES), min(len(strokes.path), peak + _LONGEST_FRAMES + 1)
    way = max(strokes.apart(i, peak) for i in range(first, end))
    before, after = (
        [i for i in range(*span) if strokes.apart(i, peak) > _AWAY * way]
        for span in ((first, peak - _SHORTEST_FRAMES + 1), (peak + _SHORTEST_FRAMES, end))
    )
    pairs = [(i, j) for i in before for j in after]
    if not pairs:
        return None
    best = min(pairs, key=lambda pair: strokes.apart(*pair) / way + 0.012 * (pair[1] - pair[0]))
    return best if strokes.apart(*best) <= ALIKE * way else None


def _without(ids: Tensor, strokes: Strokes, n: int, mask_id: int) -> Tensor | None:
    """(L, C) ids without `n` strokes: the tokens from one peak to the n-th peak after it are cut out, at the most similar pair."""
    frames = strokes.frames
    first = min(range(len(frames) - n), key=lambda i: strokes.apart(frames[i], frames[i + n]))
    start = _token(frames[first])
    end = start + _token(frames[first + n] - frames[first])
    return torch.cat([ids[:start], _opened(ids[end:], mask_id)]) if end < len(ids) else None


def _token(frame: int) -> int:
    return round(frame / FRAMES_PER_TOKEN)


def _opened(ids: Tensor, mask_id: int) -> Tensor:
    """A copy with a [MASK] in place of the first token."""
    opened = ids.clone()
    opened[:1] = mask_id
    return opened
