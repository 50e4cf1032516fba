"""Decodes ids that arrive in chunks to features as soon as these are final; they equal those of one pass over the motion.

A decoded frame depends on `halo_tokens` tokens on each side. A token's frames are therefore final once the `halo_tokens` tokens
after it are known, and decoding them needs as many tokens before it; both ends of the whole motion are padded as in one pass.
Memory is bounded by the halo and the chunk (MMM decodes a long motion in a single call at its end).
"""

from __future__ import annotations

import torch
from torch import Tensor

from mmm_core.model.tokenizer import Tokenizer
from mmm_core.model.tokens import FRAMES_PER_TOKEN
from mmm_core.model.vqvae import VqVae


class StreamingDecoder:
    """Feed ids with `push`, end with `finish`; both return (n, F) features, every frame once and in order.

    Args:
        tokenizer: decodes ids.
        kept: `window` of a decoder that this one continues; None begins a motion.
        n_context: `n_context` of that decoder.
    """

    def __init__(self, tokenizer: Tokenizer | VqVae, kept: Tensor | None = None, n_context: int = 0) -> None:
        self._tokenizer = tokenizer
        self._halo = tokenizer.halo_tokens()
        none = torch.zeros(0, tokenizer.n_codebooks, dtype=torch.int64)
        self._kept = none if kept is None else kept  # ids from the first still needed on
        self._n_context = n_context  # number of kept ids whose frames were returned already

    @property
    def window(self) -> Tensor:
        """(n, C) ids that later frames still need."""
        return self._kept

    @property
    def n_context(self) -> int:
        """Number of ids in the window whose frames were returned already."""
        return self._n_context

    def push(self, ids: Tensor) -> Tensor:
        """Features that (n, C) new ids make final."""
        self._kept = torch.cat([self._kept, ids])
        return self._decode(len(self._kept) - self._n_context - self._halo)

    def finish(self) -> Tensor:
        """Features of the last tokens."""
        return self._decode(len(self._kept) - self._n_context)

    @torch.inference_mode()
    def _decode(self, n_tokens: int) -> Tensor:
        """Features of the next `n_tokens`; ids that no later token needs are dropped."""
        if n_tokens <= 0:
            return self._tokenizer.mean.new_zeros(0, len(self._tokenizer.mean))
        start, end = self._n_context, self._n_context + n_tokens
        window = self._kept[: end + self._halo]
        features = self._tokenizer.decode(window[None])[0]
        drop = max(0, end - self._halo)
        self._kept, self._n_context = self._kept[drop:], end - drop
        return features[start * FRAMES_PER_TOKEN : end * FRAMES_PER_TOKEN]
