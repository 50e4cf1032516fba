"""CLIP's text tower, the text encoder of the released model: 77 word states and one projected sentence vector.

Radford et al. 2021 (arXiv 2103.00020) sec. 2.4: a causal pre-norm transformer over byte pairs, activation
x * sigmoid(1.702 x). The motion model attends to all 77 positions, also those after the end of the text, and takes the
sentence vector as it comes out of the projection, not normalised. No weights ship: a user names the files.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import torch
import torch.nn.functional as F
from tokenizers import Tokenizer
from torch import Tensor, nn

from mmm_core.errors import CheckpointError
from mmm_core.model.clip_byte_pairs import clean_text
from mmm_core.model.text import TextStates


@dataclass(frozen=True)
class ClipConfig:
    """Sizes of the text tower; the defaults are ViT-B/32's."""

    vocabulary: int = 49408
    context: int = 77
    width: int = 512
    n_layers: int = 12
    n_heads: int = 8
    embedding: int = 512


class _Block(nn.Module):
    """Pre-norm transformer block with causal attention."""

    def __init__(self, config: ClipConfig) -> None:
        super().__init__()
        W = config.width
        self.n_heads = config.n_heads
        self.norm_attention, self.norm_mlp = nn.LayerNorm(W), nn.LayerNorm(W)
        self.qkv, self.out = nn.Linear(W, 3 * W), nn.Linear(W, W)
        self.mlp_in, self.mlp_out = nn.Linear(W, 4 * W), nn.Linear(4 * W, W)

    def forward(self, x: Tensor) -> Tensor:
        """(B, N, W) -> (B, N, W)."""
        B, N, W = x.shape
        q, k, v = self.qkv(self.norm_attention(x)).reshape(B, N, 3, self.n_heads, -1).permute(2, 0, 3, 1, 4)
        attended = F.scaled_dot_product_attention(q, k, v, is_causal=True)
        x = x + self.out(attended.transpose(1, 2).reshape(B, N, W))
        hidden = self.mlp_in(self.norm_mlp(x))
        return x + self.mlp_out(hidden * torch.sigmoid(1.702 * hidden))


class ClipText(nn.Module):
    """The text tower. `encode` needs `word_pieces`; `states` works on ids."""

    def __init__(self, config: ClipConfig, word_pieces: Tokenizer | None = None) -> None:
        super().__init__()
        self.config = config
        self.word_pieces = word_pieces
        self.token_embedding = nn.Embedding(config.vocabulary, config.width)
        self.position_embedding = nn.Parameter(torch.zeros(config.context, config.width))
        self.blocks = nn.ModuleList(_Block(config) for _ in range(config.n_layers))
        self.norm_out = nn.LayerNorm(config.width)
        self.projection = nn.Parameter(torch.zeros(config.width, config.embedding))

    def piece_ids(self, texts: list[str]) -> Tensor:
        """(B, 77) ids: start, pieces, end (the highest id), zeros; a longer text is cut before its end mark."""
        if self.word_pieces is None:
            raise CheckpointError(Path("vocabulary"), "", "not in the checkpoint", "one imported with --vocabulary")
        start, end = self.config.vocabulary - 2, self.config.vocabulary - 1
        ids = torch.zeros(len(texts), self.config.context, dtype=torch.int64)
        cleaned = [clean_text(text) for text in texts]
        for row, encoded in enumerate(self.word_pieces.encode_batch(cleaned, add_special_tokens=False)):
            pieces = [start, *encoded.ids[: self.config.context - 2], end]
            ids[row, : len(pieces)] = torch.tensor(pieces)
        return ids

    @torch.inference_mode()
    def encode(self, texts: list[str]) -> TextStates:
        """States of `texts`; every one of the 77 positions counts as a word, as in the released model."""
        return self.states(self.piece_ids(texts))

    def states(self, ids: Tensor) -> TextStates:
        """States of (B, 77) ids: words after the last norm, sentence at the highest id, projected, not normalised."""
        x = self.token_embedding(ids) + self.position_embedding
        for block in self.blocks:
            x = block(x)
        x = self.norm_out(x)
        sentence = x[torch.arange(len(ids)), ids.argmax(1)] @ self.projection
        return TextStates(x, torch.ones(ids.shape, dtype=torch.bool), sentence)
