"""Edits a motion: masks the ids to generate anew and keeps the rest as context (`shown_edits` fills the masked ones).

MMM (arXiv 2312.03596) sec. 3.3 and 3.4: in-betweening, a new beginning or end, any other segment, and single body parts
(the paper's upper body given the lower; here any of the tokenizer's parts).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import torch

from mmm_core.errors import GenerationError
from mmm_core.generate.engine import Engine
from mmm_core.generate.motion_model import check_seed
from mmm_core.generate.shown_edits import Edited, filled
from mmm_core.model.tokens import FRAMES_PER_TOKEN, MAX_TOKENS, tokens_for_frames
from mmm_core.motion.motion import FPS, Motion

TOKEN_S = FRAMES_PER_TOKEN / FPS
"""Seconds of a token."""


@dataclass(frozen=True)
class Edit:
    """A segment of a motion, and the body parts in it, that are generated anew.

    Attributes:
        start_s: beginning of the segment, seconds.
        end_s: end of the segment, seconds; None is the motion's end.
        parts: body parts by their name in the tokenizer; None is the whole body.
    """

    start_s: float = 0.0
    end_s: float | None = None
    parts: tuple[str, ...] | None = None


def part_names(engine: Engine) -> tuple[str, ...]:
    """Body parts that this model can edit on their own, in the order of its codebooks."""
    return engine.model.tokenizer.part_names


def edit(engine: Engine, motion: Motion, what: Edit | Sequence[Edit], text: str, *, seed: int = 0) -> Edited:
    """`motion` with the segments in `what` generated anew for `text`; all other ids stay as they are.

    In-betweening is a segment in the middle, out-painting two at the ends. Segments widen to whole tokens (0.2 s).

    Args:
        engine: the model.
        motion: at most 9.8 s; its ids are used if they fit it, else its features are encoded.
        what: one segment or several.
        text: a command for the new segments.
        seed: any integer from 0 to 2^31 - 1.

    Raises:
        GenerationError: a segment lies outside the motion or is empty, a part is unknown or cannot be predicted, the text
            is rejected, or the motion is too long.
    """
    check_seed(seed)
    ids = engine.ids_of(motion)
    if len(ids) > MAX_TOKENS:
        raise GenerationError(
            f"an edit of {len(ids) * TOKEN_S:.1f} s", f"a motion of at most {MAX_TOKENS * TOKEN_S:.1f} s"
        )
    row, mask = ids.clone(), engine.model.transformer.ids.mask
    for one in [what] if isinstance(what, Edit) else what:
        row[_span(one, len(row)), _books(engine, one)] = mask
    return filled(engine, row, text, seed, len(motion.features))


def extend(
    engine: Engine, motion: Motion, text: str, *, before_s: float = 0.0, after_s: float = 0.0, seed: int = 0
) -> Edited:
    """`motion` with a new beginning of `before_s` and a new end of `after_s` seconds for `text`.

    Raises:
        GenerationError: nothing is added, or the result would be longer than 9.8 s, or as `edit`.
    """
    check_seed(seed)
    ids = engine.ids_of(motion)
    n_before, n_after = (round(max(0.0, s) / TOKEN_S) for s in (before_s, after_s))
    total = n_before + len(ids) + n_after
    if not n_before + n_after or total > MAX_TOKENS:
        asked = f"{before_s} s before and {after_s} s after a motion of {len(ids) * TOKEN_S:.1f} s"
        raise GenerationError(asked, f"at least {TOKEN_S} s more, and at most {MAX_TOKENS * TOKEN_S:.1f} s together")
    mask = engine.model.transformer.ids.mask
    row = torch.cat([ids.new_full((n_before, ids.shape[1]), mask), ids, ids.new_full((n_after, ids.shape[1]), mask)])
    return filled(engine, row, text, seed, None)


def in_between(engine: Engine, first: Motion, second: Motion, seconds: float, text: str, *, seed: int = 0) -> Edited:
    """`first`, then `seconds` of new motion for `text`, then `second`.

    Raises:
        GenerationError: as `extend`.
    """
    check_seed(seed)
    left, right = engine.ids_of(first), engine.ids_of(second)
    n_new = round(seconds / TOKEN_S)
    total = len(left) + n_new + len(right)
    if n_new < 1 or total > MAX_TOKENS:
        raise GenerationError(f"{seconds} s between motions of {len(left) * TOKEN_S:.1f} and {len(right) * TOKEN_S:.1f} s",
                              f"at least {TOKEN_S} s, and at most {MAX_TOKENS * TOKEN_S:.1f} s together")  # fmt: skip
    mask = engine.model.transformer.ids.mask
    row = torch.cat([left, left.new_full((n_new, left.shape[1]), mask), right])
    return filled(engine, row, text, seed, None)


def _span(one: Edit, n_tokens: int) -> slice:
    """Tokens that a segment touches."""
    end_s = n_tokens * TOKEN_S if one.end_s is None else one.end_s
    if not 0 <= one.start_s < end_s <= n_tokens * TOKEN_S + 1e-6:
        asked = f"the stretch from {one.start_s} to {end_s} s"
        raise GenerationError(asked, f"0 <= start < end <= {n_tokens * TOKEN_S:.1f} s, the motion's length")
    return slice(int(one.start_s / TOKEN_S + 1e-6), tokens_for_frames(round(end_s * FPS)))


def _books(engine: Engine, one: Edit) -> list[int]:
    """Codebooks of a segment's body parts."""
    names = part_names(engine)[: engine.model.transformer.config.n_out]
    if one.parts is None:
        return list(range(len(names)))
    for part in one.parts:
        if part not in names:
            raise GenerationError(f"the part '{part}' was asked for", ", ".join(names))
    return [names.index(part) for part in one.parts]
