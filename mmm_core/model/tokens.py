"""Token arithmetic: frames to tokens, special ids, several codebooks packed into one id."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mmm_core.errors import GenerationError

FRAMES_PER_TOKEN = 4
"""Frames that one token stands for: the tokenizer halves the frame rate twice (MMM, arXiv 2312.03596, sec. 3.1)."""
MAX_TOKENS = 49
"""Tokens of the longest motion: 196 frames, 9.8 s, as in HumanML3D."""


@dataclass(frozen=True)
class SpecialIds:
    """Ids after the K codes of a codebook: [END] closes a motion, [PAD] fills the batch, [MASK] marks an id to predict."""

    n_codes: int

    @property
    def end(self) -> int:
        return self.n_codes

    @property
    def pad(self) -> int:
        return self.n_codes + 1

    @property
    def mask(self) -> int:
        return self.n_codes + 2


def tokens_for_frames(n_frames: int) -> int:
    """Number of tokens that cover `n_frames` frames (the last may be partly used)."""
    return -(-n_frames // FRAMES_PER_TOKEN)


def frames_for_seconds(seconds: float, fps: float) -> int:
    """Number of frames in `seconds`, at least one token's worth.

    Raises:
        GenerationError: `seconds` is not finite, not positive, or longer than the model's longest motion.
    """
    longest_s = MAX_TOKENS * FRAMES_PER_TOKEN / fps
    if not 0 < seconds <= longest_s:
        raise GenerationError(f"a motion of {seconds} s was asked for", f"more than 0 and at most {longest_s:.1f} s")
    return max(FRAMES_PER_TOKEN, round(seconds * fps))


def pack_ids(ids: NDArray[np.integer], n_codes: int) -> NDArray[np.int64]:
    """One id per position from one id per codebook: (L, C) -> (L,), the first codebook in the lowest digit."""
    place = n_codes ** np.arange(ids.shape[1], dtype=np.int64)
    return (ids.astype(np.int64) * place).sum(1)


def unpack_ids(packed: NDArray[np.integer], n_codes: int, n_codebooks: int) -> NDArray[np.int64]:
    """Inverse of `pack_ids`: (L,) -> (L, C)."""
    place = n_codes ** np.arange(n_codebooks, dtype=np.int64)
    return (packed.astype(np.int64)[:, None] // place) % n_codes
