"""Trains the sentence parser on sentences with known gestures, in their order and with their arms."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

import torch
import torch.nn.functional as F
from torch import Tensor

from mmm_core.corpus.labelled_sentences import LabelledSentence
from mmm_core.inference.checkpoint import load_text_encoder
from mmm_core.inference.onednn_linear import can_pack_bf16
from mmm_core.inference.own_layers_file import save_parser
from mmm_core.language.gesture_steps import mirrored, token_ids, tokens
from mmm_core.language.mirroring import canonical
from mmm_core.model.sentence_parser import END_ID, ParserConfig, SentenceParser
from mmm_core.model.text import MiniLm
from mmm_core.training.drawn_text import batches_of
from mmm_core.training.own_layers import Rates, copy_layers, fit
from mmm_core.training.parser_texts import ParserTexts

STEPS, BATCH = 3000, 64
"""Optimisation steps, and sentences of a batch."""
RATES = Rates(layers=2e-4, linear=8e-4, warm_up=100)
DROPOUT, SMOOTHING = 0.1, 0.03
SEED = 0
_NOT_GIVEN = -100

Draw = Callable[[], LabelledSentence]


def train_parser(out: Path, draw: Draw | None = None, *, steps: int = STEPS) -> SentenceParser:
    """Train a parser and write it; equal arguments give equal weights on one machine.

    Args:
        out: file of the parser.
        draw: draws a sentence with what it asks for; all kinds of `ParserTexts` when None.
        steps: optimisation steps.
    """
    encoder = load_text_encoder()
    batches = batches_of(draw or ParserTexts(random.Random(SEED)).draw, BATCH, SEED)
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(SEED)
        parser = SentenceParser(ParserConfig(tokens()), encoder.config)
        copy_layers(parser.layers, encoder, parser.config.n_shared)
        fit(parser, parser.layers, partial(_next_loss, parser, encoder, batches), RATES, steps)
    save_parser(out, parser)
    return parser


def _next_loss(
    parser: SentenceParser, encoder: MiniLm, batches: Iterator[list[LabelledSentence]], _step: int
) -> Tensor:
    with torch.autocast("cpu", torch.bfloat16, enabled=can_pack_bf16()):
        return _loss(parser, encoder, [_canonical(one) for one in next(batches)])


def _loss(parser: SentenceParser, encoder: MiniLm, batch: Sequence[LabelledSentence]) -> Tensor:
    """Cross entropy of the tokens of a batch, the sum of each sentence's."""
    ids, mask = encoder.piece_ids([one.text for one in batch])
    with torch.no_grad():
        states = encoder.lower_states(ids, mask, parser.config.n_shared)
    sequences = [token_ids(one.steps)[: parser.config.longest] for one in batch]
    width = max(map(len, sequences))
    given = torch.tensor([[*s, *[END_ID] * (width - len(s))] for s in sequences])
    wanted = torch.tensor([[*s[1:], *[_NOT_GIVEN] * (width - len(s))] for s in sequences])
    scores = parser(parser.remember(states, mask, DROPOUT), mask, given[:, :-1], DROPOUT)
    of_tokens = F.cross_entropy(
        scores.float().transpose(1, 2), wanted, ignore_index=_NOT_GIVEN, label_smoothing=SMOOTHING, reduction="sum"
    )
    return of_tokens / len(batch)


def _canonical(one: LabelledSentence) -> LabelledSentence:
    """A sentence or its mirror image, as it is read."""
    image, is_image = canonical(one.text)
    return LabelledSentence(image, mirrored(one.steps)) if is_image else one
