"""Translates a sentence into the gestures that it asks for, step by step, each with its arm (`mmm_core.language.gesture_steps`).

Above the text encoder's embeddings it has layers that begin as copies of the encoder's and are trained further, and a small causal
decoder that attends to their states (arXiv 1706.03762). It both proposes what a sentence asks for and says how likely a reading is,
and tells which number of the sentence is how often a gesture is to be done.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, cast

import torch
import torch.nn.functional as F
from torch import Tensor, nn

from mmm_core.model.number_pointer import NumberPointer
from mmm_core.model.text import MiniLmConfig, WordLayer

START_ID, END_ID = 0, 1
TOKENS_OF_GESTURE = 3
"""Tokens of each gesture of a sequence; the last of them is the gesture itself (`mmm_core.language.gesture_steps`)."""


@dataclass(frozen=True)
class ParserConfig:
    """Sizes of a parser.

    Attributes:
        tokens: names of the tokens, START and END first.
        n_own: its layers above the text encoder's embeddings.
        width, n_layers, n_heads: of the decoder.
        longest: tokens of a sequence, at most, START and END included.
    """

    tokens: tuple[str, ...]
    n_own: int = 6
    width: int = 256
    n_layers: int = 2
    n_heads: int = 4
    longest: int = 26


class KeyValueCache:
    """Keys and values of the tokens before, which a layer of the decoder keeps from step to step of a search."""

    def __init__(self) -> None:
        self._pairs: Tensor | None = None

    def with_next(self, pairs: Tensor) -> Tensor:
        """(2, B, heads, T, D) with those of (2, B, heads, 1, D) added."""
        self._pairs = pairs if self._pairs is None else torch.cat((self._pairs, pairs), 3)
        return self._pairs

    def keep(self, sequences: Tensor) -> None:
        """Keep the sequences with these numbers, in this order."""
        if self._pairs is not None:
            self._pairs = self._pairs[:, sequences]


class DecoderLayer(nn.Module):
    """Pre-norm layer of a causal decoder: attention to the tokens before, to what is remembered, and a feed-forward network."""

    def __init__(self, config: ParserConfig) -> None:
        super().__init__()
        width = config.width
        self.n_heads = config.n_heads
        self.norms = nn.ModuleList(nn.LayerNorm(width) for _ in range(3))
        self.qkv, self.attention_out = nn.Linear(width, 3 * width), nn.Linear(width, width)
        self.query, self.key_value, self.memory_out = (
            nn.Linear(width, width), nn.Linear(width, 2 * width), nn.Linear(width, width),
        )  # fmt: skip
        self.mlp_in, self.mlp_out = nn.Linear(width, 4 * width), nn.Linear(4 * width, width)

    def forward(
        self,
        x: Tensor,
        remembered: Tensor,
        mask: Tensor | None,
        dropout: float = 0.0,
        cache: KeyValueCache | None = None,
    ) -> Tensor:
        """(B, T, width), with (2, B, heads, W, D) from `remember` and its (B, 1, 1, W) bool mask -> (B, T, width).

        Without a mask all words are attended to. With a cache of the earlier tokens, x is (B, 1, width) of the next one.
        """
        q, *pairs = self._heads(self.qkv(self.norms[0](x)), 3)
        k, v = pairs if cache is None else cache.with_next(torch.stack(pairs))
        attended = F.scaled_dot_product_attention(q, k, v, is_causal=cache is None)
        x = x + F.dropout(self.attention_out(_joined(attended)), dropout, self.training)
        (q,) = self._heads(self.query(self.norms[1](x)), 1)
        attended = F.scaled_dot_product_attention(q, remembered[0], remembered[1], attn_mask=mask)
        x = x + F.dropout(self.memory_out(_joined(attended)), dropout, self.training)
        return x + F.dropout(self.mlp_out(F.gelu(self.mlp_in(self.norms[2](x)))), dropout, self.training)

    def remember(self, memory: Tensor) -> Tensor:
        """Keys and values (2, B, heads, W, D) of a memory (B, W, width)."""
        return self._heads(self.key_value(memory), 2)

    def _heads(self, x: Tensor, n: int) -> Tensor:
        return x.unflatten(-1, (n, self.n_heads, -1)).permute(2, 0, 3, 1, 4)


def _joined(heads: Tensor) -> Tensor:
    return heads.transpose(1, 2).flatten(2)


class Memory(NamedTuple):
    """The states of B sentences, which the parser computes once and the decoder attends to at each token.

    Attributes:
        words: (B, W, D) states of word pieces after its own layers.
        pairs: keys and values (2, B, heads, W, D) to which each layer of the decoder attends.
    """

    words: Tensor
    pairs: tuple[Tensor, ...]


class SentenceParser(nn.Module):
    """Parser of sentences above the embeddings of a text encoder, which are no part of its weights."""

    def __init__(self, config: ParserConfig, text: MiniLmConfig) -> None:
        super().__init__()
        self.config = config
        self.layers = nn.ModuleList(WordLayer(text) for _ in range(config.n_own))
        self.memory = nn.Linear(text.width, config.width)
        self.token = nn.Embedding(len(config.tokens), config.width)
        self.position = nn.Parameter(torch.randn(config.longest, config.width) * 0.02)
        self.decoder = nn.ModuleList(DecoderLayer(config) for _ in range(config.n_layers))
        self.norm, self.out = nn.LayerNorm(config.width), nn.Linear(config.width, len(config.tokens))
        self.numbers = NumberPointer(text.width, config.width)

    def remember(self, embedded: Tensor, mask: Tensor, dropout: float = 0.0) -> Memory:
        """Compute the states of sentences to which the decoder attends.

        Args:
            embedded: (B, W, D) the encoder's embeddings of word pieces.
            mask: (B, W) bool, true where there is a word piece.
            dropout: share of the values that training drops after each layer.
        """
        x = F.dropout(embedded, dropout, self.training)
        for layer in self.layers:
            x = F.dropout(layer(x, mask[:, None, None, :]), dropout, self.training)
        memory = self.memory(x)
        return Memory(x, tuple(cast("DecoderLayer", layer).remember(memory) for layer in self.decoder))

    def forward(self, memory: Memory, mask: Tensor, ids: Tensor, dropout: float = 0.0) -> Tensor:
        """Scores (B, T, tokens) of the token after each of (B, T) tokens; arguments of `decoded`."""
        return self.out(self.decoded(memory, mask, ids, dropout))

    def decoded(self, memory: Memory, mask: Tensor, ids: Tensor, dropout: float = 0.0) -> Tensor:
        """States (B, T, width) of the decoder at each of (B, T) tokens.

        Args:
            memory: from `remember`.
            mask: (B, W) bool, true where there is a word piece.
            ids: (B, T) tokens, the first of which is START.
            dropout: share of the values that training drops in each layer.
        """
        x = self.token(ids) + self.position[: ids.shape[1]]
        for layer, pairs in zip(self.decoder, memory.pairs, strict=True):
            x = layer(x, pairs, mask[:, None, None, :], dropout)
        return self.norm(x)

    def next_scores(
        self, pairs: Sequence[Tensor], last_ids: Tensor, n_before: int, caches: Sequence[KeyValueCache]
    ) -> Tensor:
        """Scores (B, tokens) of the token after the last of B sequences, whose earlier tokens are in the caches.

        Args:
            pairs: of `Memory`, without padding.
            last_ids: (B,) the last token of each.
            n_before: number of the tokens before it.
            caches: one for each layer; the last token is added to them.
        """
        x = (self.token(last_ids) + self.position[n_before])[:, None]
        for layer, of_layer, cache in zip(self.decoder, pairs, caches, strict=True):
            x = layer(x, of_layer, None, cache=cache)
        return self.out(self.norm(x[:, 0]))
