"""Translates a sentence into the gestures that it asks for, step by step, each with its arm (`mmm_core.language.gesture_steps`).

The lower layers are the text encoder's own; the parser adds copies of its next layers, trained further, and a small causal
decoder that attends to their states (arXiv 1706.03762). It both proposes what a sentence asks for and says how likely a reading is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, cast

import torch
import torch.nn.functional as F
from torch import Tensor, nn

from mmm_core.model.text import MiniLmConfig, WordLayer


@dataclass(frozen=True)
class ParserConfig:
    """Sizes of a parser.

    Attributes:
        tokens: names of the tokens, START and END first.
        n_shared: layers of the text encoder that the parser uses as they are.
        n_own: layers of its own above them.
        width, n_layers, n_heads: of the decoder.
        longest: tokens of a sequence, at most, START and END included.
    """

    tokens: tuple[str, ...]
    n_shared: int = 3
    n_own: int = 3
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


class SentenceParser(nn.Module):
    """Parser of sentences above the lower layers of a text encoder, which is no part of its weights."""

    def __init__(self, config: ParserConfig, text: MiniLmConfig) -> None:
        super().__init__()
        self.config = config
        self.layers = nn.ModuleList(WordLayer(text) for _ in range(config.n_own))
        self.memory = nn.Linear(text.width, config.width)
        self.token = nn.Embedding(len(config.tokens), config.width)
        self.position = nn.Parameter(torch.randn(config.longest, config.width) * 0.02)
        self.decoder = nn.ModuleList(DecoderLayer(config) for _ in range(config.n_layers))
        self.norm, self.out = nn.LayerNorm(config.width), nn.Linear(config.width, len(config.tokens))

    def remember(self, states: Tensor, mask: Tensor, dropout: float = 0.0) -> list[Tensor]:
        """Keys and values (2, B, heads, W, D) to which each layer of the decoder attends.

        Args:
            states: (B, W, D) states of word pieces after the encoder's shared layers.
            mask: (B, W) bool, true where there is a word piece.
            dropout: share of the values that training drops after each layer.
        """
        x = F.dropout(states, dropout, self.training)
        for layer in self.layers:
            x = F.dropout(layer(x, mask[:, None, None, :]), dropout, self.training)
        memory = self.memory(x)
        return [cast("DecoderLayer", layer).remember(memory) for layer in self.decoder]

    def forward(self, remembered: Sequence[Tensor], mask: Tensor, ids: Tensor, dropout: float = 0.0) -> Tensor:
        """Scores (B, T, tokens) of the token after each of (B, T) tokens.

        Args:
            remembered: from `remember`.
            mask: (B, W) bool, true where there is a word piece.
            ids: (B, T) tokens, the first of which is START.
            dropout: share of the values that training drops in each layer.
        """
        x = self.token(ids) + self.position[: ids.shape[1]]
        for layer, pairs in zip(self.decoder, remembered, strict=True):
            x = layer(x, pairs, mask[:, None, None, :], dropout)
        return self.out(self.norm(x))

    def next_scores(
        self, remembered: Sequence[Tensor], last_ids: Tensor, n_before: int, caches: Sequence[KeyValueCache]
    ) -> Tensor:
        """Scores (B, tokens) of the token after the last of B sequences, whose earlier tokens are in the caches.

        Args:
            remembered: from `remember`, without padding.
            last_ids: (B,) the last token of each.
            n_before: number of the tokens before it.
            caches: one for each layer; the last token is added to them.
        """
        x = (self.token(last_ids) + self.position[n_before])[:, None]
        for layer, pairs, cache in zip(self.decoder, remembered, caches, strict=True):
            x = layer(x, pairs, None, cache=cache)
        return self.out(self.norm(x[:, 0]))


START_ID, END_ID = 0, 1


class Parsed(NamedTuple):
    """A sequence of tokens without START and END, and the logarithm of its probability."""

    ids: tuple[int, ...]
    log_probability: float


@torch.inference_mode()
def memory_of(parser: SentenceParser, states: Tensor) -> list[Tensor]:
    """`SentenceParser.remember` of one sentence, given its states (W, D)."""
    return parser.remember(states[None], torch.ones(1, len(states), dtype=torch.bool))


@torch.inference_mode()
def log_likelihoods(
    parser: SentenceParser, remembered: Sequence[Tensor], sequences: Sequence[Sequence[int]]
) -> list[float]:
    """The logarithms of the probabilities of sequences, each with START and END, given one sentence."""
    width = max(map(len, sequences))
    ids = torch.tensor([[*s, *[END_ID] * (width - len(s))] for s in sequences])
    log_p = _next_log_p(parser, remembered, ids[:, :-1])
    of_tokens = log_p.gather(2, ids[:, 1:, None]).squeeze(2)
    counts = torch.tensor([[i < len(s) - 1 for i in range(width - 1)] for s in sequences])
    return (of_tokens * counts).sum(1).tolist()


@torch.inference_mode()
def likeliest(parser: SentenceParser, remembered: Sequence[Tensor], n: int) -> list[Parsed]:
    """About the n likeliest sequences for one sentence, by beam search, the likeliest first."""
    beams, done = [Parsed((START_ID,), 0.0)], list[Parsed]()
    caches = [KeyValueCache() for _ in parser.decoder]
    for n_before in range(parser.config.longest - 1):
        pairs = [one.expand(-1, len(beams), -1, -1, -1) for one in remembered]
        scores = parser.next_scores(pairs, torch.tensor([one.ids[-1] for one in beams]), n_before, caches)
        log_p = F.log_softmax(scores.float(), -1) + torch.tensor([[one.log_probability] for one in beams])
        best = log_p.flatten().topk(min(2 * n, log_p.numel()))
        grown: list[tuple[int, Parsed]] = []
        for log_probability, at in zip(best.values.tolist(), best.indices.tolist(), strict=True):
            beam, token = divmod(at, log_p.shape[1])
            ids = beams[beam].ids
            if token == END_ID:
                done.append(Parsed(ids[1:], log_probability))
            else:
                grown.append((beam, Parsed((*ids, token), log_probability)))
        beams = [one for _, one in grown[:n]]
        done.sort(key=lambda one: -one.log_probability)
        if len(done) >= n and done[n - 1].log_probability >= beams[0].log_probability:
            break
        for cache in caches:
            cache.keep(torch.tensor([beam for beam, _ in grown[:n]]))
    return done[:n]


def _next_log_p(parser: SentenceParser, remembered: Sequence[Tensor], ids: Tensor) -> Tensor:
    """(N, T, tokens) log-probabilities of the token after each of (N, T) tokens, given one sentence."""
    n, n_pieces = len(ids), remembered[0].shape[3]
    mask = torch.ones(n, n_pieces, dtype=torch.bool)
    scores = parser([pairs.expand(-1, n, -1, -1, -1) for pairs in remembered], mask, ids)
    return F.log_softmax(scores.float(), -1)
