"""Asks a sentence parser about one sentence: for its likeliest answers, the probability of an answer, and its numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import torch
import torch.nn.functional as F
from torch import Tensor

from mmm_core.model.sentence_parser import END_ID, START_ID, TOKENS_OF_GESTURE, KeyValueCache, Memory, SentenceParser

_UNLIKELY = math.log(1e-3)
"""Log-probability of a sequence beside that of the likeliest one below which it is not sought any further."""


class Parsed(NamedTuple):
    """A sequence of tokens without START and END, and the logarithm of its probability."""

    ids: tuple[int, ...]
    log_probability: float


@torch.inference_mode()
def memory_of(parser: SentenceParser, embedded: Tensor) -> Memory:
    """`SentenceParser.remember` of one sentence, given the embeddings (W, D) of its word pieces."""
    return parser.remember(embedded[None], torch.ones(1, len(embedded), dtype=torch.bool))


@torch.inference_mode()
def log_likelihoods(parser: SentenceParser, memory: Memory, sequences: Sequence[Sequence[int]]) -> list[float]:
    """The logarithms of the probabilities of sequences, each with START and END, given one sentence."""
    width = max(map(len, sequences))
    ids = torch.tensor([[*s, *[END_ID] * (width - len(s))] for s in sequences])
    log_p = _next_log_p(parser, memory, ids[:, :-1])
    of_tokens = log_p.gather(2, ids[:, 1:, None]).squeeze(2)
    counts = torch.tensor([[i < len(s) - 1 for i in range(width - 1)] for s in sequences])
    return (of_tokens * counts).sum(1).tolist()


@torch.inference_mode()
def likeliest(parser: SentenceParser, memory: Memory, n: int) -> list[Parsed]:
    """About the n likeliest sequences for one sentence, by beam search, the likeliest first; unlikely beginnings are given up."""
    beams, done = [Parsed((START_ID,), 0.0)], list[Parsed]()
    caches = [KeyValueCache() for _ in parser.decoder]
    for n_before in range(parser.config.longest - 1):
        pairs = [one.expand(-1, len(beams), -1, -1, -1) for one in memory.pairs]
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
        done.sort(key=lambda one: -one.log_probability)
        least = max(best.values[0].item(), done[0].log_probability if done else -math.inf) + _UNLIKELY
        if len(done) >= n:
            least = max(least, done[n - 1].log_probability)
        grown = [(beam, one) for beam, one in grown[:n] if one.log_probability > least]
        if not grown:
            break
        beams = [one for _, one in grown]
        for cache in caches:
            cache.keep(torch.tensor([beam for beam, _ in grown]))
    return done[:n]


@torch.inference_mode()
def number_probabilities(parser: SentenceParser, memory: Memory, pieces: Sequence[int], ids: Sequence[int]) -> Tensor:
    """(N, K) probabilities that a number word says how often a gesture is to be done.

    Args:
        parser: the parser.
        memory: of one sentence.
        pieces: the first word piece of each of N number words.
        ids: tokens of its K gestures, START and END included.
    """
    mask = torch.ones(1, memory.words.shape[1], dtype=torch.bool)
    states = parser.decoded(memory, mask, torch.tensor([ids]))[0, TOKENS_OF_GESTURE:-1:TOKENS_OF_GESTURE]
    return torch.sigmoid(parser.numbers(memory.words[0, list(pieces), None], states[None]).float())


def _next_log_p(parser: SentenceParser, memory: Memory, ids: Tensor) -> Tensor:
    """(N, T, tokens) log-probabilities of the token after each of (N, T) tokens, given one sentence."""
    n, n_pieces = len(ids), memory.words.shape[1]
    mask = torch.ones(n, n_pieces, dtype=torch.bool)
    pairs = tuple(of_layer.expand(-1, n, -1, -1, -1) for of_layer in memory.pairs)
    return F.log_softmax(parser(memory._replace(pairs=pairs), mask, ids).float(), -1)
