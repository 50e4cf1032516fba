"""Masked motion transformer: ids with [MASK] and a text -> logits for every position.

MMM (arXiv 2312.03596) sec. 3.2: cross-attention to the words first, then self-attention over the motion with the
sentence as an extra token. Attention is written out (matmul, softmax, matmul): on a CPU its backward pass is several
times faster than the fused operator's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import torch
import torch.nn.functional as F
from torch import Tensor, nn

from mmm_core.model.text import MiniLmConfig, TextStates, WordLayer
from mmm_core.model.tokens import MAX_TOKENS, SpecialIds

MASKED_KEY = -1e9
"""Attention score added to padding, so that its weight is 0 after the softmax."""


@dataclass(frozen=True)
class TransformerConfig:
    """Sizes; `n_codebooks` ids stand at each position and are embedded by the tokenizer's frozen code vectors.

    The ids of the first `n_predicted` codebooks are predicted (None: all), the others are only seen: the paper's upper-body
    editing predicts the upper half given the lower (MMM eq. 3). Copies of the text encoder's last `n_words` layers belong to
    the model and are trained with it; its word states come from below these layers. With 0 the encoder keeps all its layers.
    """

    n_codes: int = 512
    n_codebooks: int = 3
    code_dim: int = 16
    width: int = 256
    n_heads: int = 8
    n_cross: int = 2
    n_self: int = 6
    text_dim: int = 384
    dropout: float = 0.1
    n_predicted: int | None = None
    n_words: int = 0

    @property
    def n_out(self) -> int:
        """Codebooks that the head predicts."""
        return self.n_codebooks if self.n_predicted is None else self.n_predicted


OFFICIAL = TransformerConfig(
    n_codes=8192, n_codebooks=1, code_dim=32, width=1024, n_heads=16, n_cross=2, n_self=16, text_dim=512
)
"""Sizes of the released model: nine layers counted as two cross, seven base and nine head blocks, 236 M parameters."""


@dataclass(frozen=True)
class TextContext:
    """Text inputs that are equal in every decoding step: the sentence token and each cross block's keys and values."""

    sentence: Tensor  # (B, W)
    keys_values: list[tuple[Tensor, Tensor]]  # (B, heads, words, head_dim) each
    word_bias: Tensor  # (B, 1, 1, words)

    def row(self, i: int) -> TextContext:
        """The context of text `i` alone."""
        keys_values = [(k[i : i + 1], v[i : i + 1]) for k, v in self.keys_values]
        return TextContext(self.sentence[i : i + 1], keys_values, self.word_bias[i : i + 1])


def sinusoids(length: int, width: int) -> Tensor:
    """(length, width) position encoding, sine in even columns (arXiv 1706.03762 sec. 3.5)."""
    angle = torch.arange(length)[:, None] * torch.exp(torch.arange(0, width, 2) * (-math.log(10000.0) / width))
    return torch.stack([angle.sin(), angle.cos()], -1).reshape(length, width)


class Attention(nn.Module):
    """Multi-head attention with queries from `x` and given keys and values."""

    def __init__(self, config: TransformerConfig) -> None:
        super().__init__()
        self.n_heads = config.n_heads
        self.query = nn.Linear(config.width, config.width)
        self.key_value = nn.Linear(config.width, 2 * config.width)
        self.out = nn.Linear(config.width, config.width)
        self.dropout = nn.Dropout(config.dropout)

    def keys_values(self, source: Tensor) -> tuple[Tensor, Tensor]:
        """Keys and values of `source` (B, N, W), each (B, heads, N, head_dim)."""
        B, N = source.shape[:2]
        k, v = self.key_value(source).reshape(B, N, 2, self.n_heads, -1).permute(2, 0, 3, 1, 4)
        return k, v

    def forward(self, x: Tensor, keys_values: tuple[Tensor, Tensor], bias: Tensor) -> Tensor:
        """(B, L, W) -> (B, L, W); `bias` (B, 1, 1, N) is added to the scores."""
        B, L, W = x.shape
        k, v = keys_values
        q = self.query(x).reshape(B, L, self.n_heads, -1).transpose(1, 2)
        scores = q @ k.transpose(-2, -1) * q.shape[-1] ** -0.5 + bias
        attended = self.dropout(scores.softmax(-1)).to(v.dtype) @ v
        return self.dropout(self.out(attended.transpose(1, 2).reshape(B, L, W)))


class Mlp(nn.Sequential):
    """Linear, GELU, linear, dropout."""

    def __init__(self, config: TransformerConfig) -> None:
        W = config.width
        super().__init__(nn.Linear(W, 4 * W), nn.GELU(), nn.Linear(4 * W, W), nn.Dropout(config.dropout))


class CrossBlock(nn.Module):
    """Pre-norm block in which motion positions attend to words (no self-attention)."""

    def __init__(self, config: TransformerConfig) -> None:
        super().__init__()
        self.norm_x, self.norm_words, self.norm_mlp = (nn.LayerNorm(config.width) for _ in range(3))
        self.attention = Attention(config)
        self.mlp = Mlp(config)

    def forward(self, x: Tensor, keys_values: tuple[Tensor, Tensor], bias: Tensor) -> Tensor:
        """(B, L, W) -> (B, L, W)."""
        x = x + self.attention(self.norm_x(x), keys_values, bias)
        return x + self.mlp(self.norm_mlp(x))


class SelfBlock(nn.Module):
    """Pre-norm self-attention block."""

    def __init__(self, config: TransformerConfig) -> None:
        super().__init__()
        self.norm_x, self.norm_mlp = (nn.LayerNorm(config.width) for _ in range(2))
        self.attention = Attention(config)
        self.mlp = Mlp(config)

    def forward(self, x: Tensor, bias: Tensor, rows: Tensor | None = None) -> Tensor:
        """(B, L, W) -> (B, L, W), or (B, n, W) at the n positions of `rows` (L,) bool; keys and values come from all rows."""
        normed = self.norm_x(x)
        keys_values = self.attention.keys_values(normed)
        if rows is not None:
            x, normed = x[:, rows], normed[:, rows]
        x = x + self.attention(normed, keys_values, bias)
        return x + self.mlp(self.norm_mlp(x))


class MotionTransformer(nn.Module):
    """Logits of every position given the visible ids and the text.

    `codebooks` (C, K, D) are the tokenizer's code vectors, frozen; `set_codebooks` fills them.
    """

    codebooks: Tensor
    positions: Tensor

    def __init__(self, config: TransformerConfig) -> None:
        super().__init__()
        self.config = config
        self.ids = SpecialIds(config.n_codes)
        code_width = config.n_codebooks * config.code_dim
        self.register_buffer("codebooks", torch.zeros(config.n_codebooks, config.n_codes, config.code_dim))
        self.register_buffer("positions", sinusoids(MAX_TOKENS + 2, config.width), persistent=False)
        self.specials = nn.Parameter(0.5 * torch.randn(3, code_width))  # END, PAD, MASK
        self.embed = nn.Linear(code_width, config.width)
        self.word_layers = nn.ModuleList(WordLayer(MiniLmConfig(width=config.text_dim)) for _ in range(config.n_words))
        self.word_in = nn.Linear(config.text_dim, config.width)
        self.sentence_in = nn.Linear(config.text_dim, config.width)
        self.no_words = nn.Parameter(0.02 * torch.randn(config.text_dim))
        self.cross = nn.ModuleList(CrossBlock(config) for _ in range(config.n_cross))
        self.blocks = nn.ModuleList(SelfBlock(config) for _ in range(config.n_self))
        self.norm_out = nn.LayerNorm(config.width)
        self.head = nn.Linear(config.width, config.n_out * config.n_codes, bias=False)
        self.apply(_initialise)

    def set_words(self, layers: nn.ModuleList) -> None:
        """Copy the text encoder's last layers, as a start for training."""
        for mine, theirs in zip(self.word_layers, list(layers)[len(layers) - len(self.word_layers) :], strict=True):
            mine.load_state_dict(theirs.state_dict())

    def set_codebooks(self, codebooks: list[Tensor]) -> None:
        """Copy the tokenizer's code vectors, scaled to unit variance."""
        stacked = torch.stack(codebooks)
        self.codebooks.copy_(stacked / stacked.std((1, 2), keepdim=True))

    def read_text(self, text: TextStates) -> TextContext:
        """The part of a text's computation that is equal in every decoding step."""
        words = text.words
        for layer in self.word_layers:
            words = layer(words, text.word_mask[:, None, None, :])
        words = self.word_in(words).float()
        bias = torch.zeros_like(text.word_mask, dtype=words.dtype).masked_fill(~text.word_mask, MASKED_KEY)
        keys_values = [b.attention.keys_values(b.norm_words(words)) for b in self.cross]  # type: ignore[union-attr]
        return TextContext(self.sentence_in(text.sentence).float(), keys_values, bias[:, None, None, :])

    def no_text(self, batch: int) -> TextStates:
        """The states that stand for "no text" (text dropout, guidance)."""
        empty = self.no_words.expand(batch, 1, -1)
        return TextStates(
            empty, torch.ones(batch, 1, dtype=torch.bool, device=empty.device), self.no_words.expand(batch, -1)
        )

    def forward(
        self, ids: Tensor, context: TextContext, wanted: Tensor | None = None, memory: StepMemory | None = None
    ) -> Tensor:
        """Logits of `ids` (B, L, C): (B, L, C, K), or (N, C, K) at the N positions of `wanted` (B, L), row by row.

        In `ids` an [END] closes each motion and [PAD] fills the rest of the row. With `wanted`, the head is computed at the
        wanted positions alone, and so is the last block for a batch of one. With `memory` (a batch of one) the blocks that
        attend to words are computed only where an id changed since the step before.
        """
        B, L, _ = ids.shape
        is_pad = ids[..., 0] == self.ids.pad  # (B, L)
        x = self.with_words(ids, self.positions[:L], context) if memory is None else memory.update(self, ids, context)
        x = torch.cat([context.sentence[:, None], x], 1) + self.positions[: L + 1]
        bias = F.pad(x.new_zeros(B, L).masked_fill(is_pad, MASKED_KEY), (1, 0))[:, None, None, :]
        *blocks, last = self.blocks
        for block in blocks:
            x = block(x, bias)
        if wanted is None:
            x = last(x, bias)[:, 1:]
            return self.head(self.norm_out(x)).float().reshape(B, L, self.config.n_out, -1)
        if B == 1:
            x = last(x, bias, F.pad(wanted[0], (1, 0)))[0]
        else:
            x = last(x, bias)[:, 1:][wanted]
        return self.head(self.norm_out(x)).float().reshape(len(x), self.config.n_out, -1)

    def with_words(self, ids: Tensor, positions: Tensor, context: TextContext) -> Tensor:
        """(B, L, W) states after attention to the words, before positions attend to each other."""
        x = self.embed(self._vectors(ids))
        if len(self.cross):
            x = x + positions
        for block, keys_values in zip(self.cross, context.keys_values, strict=True):
            x = block(x, keys_values, context.word_bias)
        return x

    def _vectors(self, ids: Tensor) -> Tensor:
        """(B, L, C) ids, specials included -> (B, L, C * D) vectors; each codebook has its part of the specials."""
        C, _, D = self.codebooks.shape
        specials = self.specials.reshape(3, C, D)
        tables = torch.cat([self.codebooks, specials.transpose(0, 1)], 1)  # (C, K + 3, D)
        return torch.cat([F.embedding(ids[..., c], tables[c]) for c in range(C)], -1)


class StepMemory:
    """Outputs of the blocks that attend to words, kept from the step before, for one sequence and one text.

    These blocks have no self-attention, so a position's output depends on its id alone. Most ids stay from step to step, and
    a position that is masked again has been masked before, so few outputs must be computed anew.
    """

    def __init__(self) -> None:
        self._ids: Tensor | None = None  # (1, L, C)
        self._x = self._masked = torch.empty(0)  # (1, L, W)
        self._was_masked = torch.empty(0)  # (L,) bool

    def update(self, model: MotionTransformer, ids: Tensor, context: TextContext) -> Tensor:
        """(1, L, W) outputs for `ids` (1, L, C), computed anew only where an id changed."""
        positions = model.positions[: ids.shape[1]]
        masked = (ids[0] == model.ids.mask).all(-1)
        if self._ids is None:
            self._x = self._masked = model.with_words(ids, positions, context)
            self._was_masked = masked
        else:
            changed = (ids != self._ids).any(-1)[0]
            again = changed & masked & self._was_masked
            new = changed & ~again
            self._x = self._x.clone()
            self._x[:, again] = self._masked[:, again]
            if new.any():
                self._x[:, new] = model.with_words(ids[:, new], positions[new], context)
        self._ids = ids.clone()
        return self._x


def _initialise(module: nn.Module) -> None:
    if isinstance(module, nn.Linear):
        nn.init.normal_(module.weight, std=0.02)
        if module.bias is not None:
            nn.init.zeros_(module.bias)
