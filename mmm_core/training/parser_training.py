"""Trains the sentence parser on sentences with known gestures, in their order, with their arms and numbers."""

from __future__ import annotations

import hashlib
import random
from collections.abc import Callable, Sequence
from functools import lru_cache, partial
from itertools import islice
from pathlib import Path

import torch
import torch.nn.functional as F
from torch import Tensor

from mmm_core.corpus.labelled_sentences import LabelledSentence, load_labelled_sentences
from mmm_core.inference.checkpoint import file_hash, load_text_encoder
from mmm_core.inference.onednn_linear import can_pack_bf16
from mmm_core.inference.own_layers_file import load_parser, save_parser
from mmm_core.language.gesture_steps import mirrored, token_ids, tokens
from mmm_core.language.mirroring import canonical
from mmm_core.model.sentence_parser import END_ID, ParserConfig, SentenceParser
from mmm_core.model.text import MiniLm
from mmm_core.training.drawn_text import TOGETHER, batches_of
from mmm_core.training.number_pairs import number_pairs
from mmm_core.training.own_layers import copy_layers
from mmm_core.training.parser_texts import ParserTexts, Shares
from mmm_core.training.run import Run, Schedule, train

STEPS, BATCH = 7000, 64
"""Optimisation steps, and sentences of a batch."""
FURTHER_STEPS, FURTHER_RATE = 2800, 0.4
"""Steps of a parser that learns further, and the factor of its learning rates."""
FURTHER_SHARES = Shares(labelled=0.35, newest=0.29, refilled=0.04, denial=0.03, joined=0.14, outside=0.04)
RATE, RATE_OF_COPIED = 8e-4, 2e-4
"""Highest learning rates: of new layers, and of the copies of the encoder's layers."""
DROPOUT, SMOOTHING = 0.1, 0.03
SEED, SAVE_EVERY = 0, 200
_NOT_GIVEN = -100

Draw = Callable[[], LabelledSentence]


def train_parser(
    out: Path,
    folder: Path,
    draw_with: Callable[[random.Random], Draw] | None = None,
    *,
    start: Path | None = None,
    steps: int | None = None,
) -> SentenceParser:
    """Train a parser and write it; equal arguments give equal weights on one machine, however often the run was interrupted.

    Args:
        out: file of the parser.
        folder: where the run keeps its state, from which it goes on; other sentences or steps are another run.
        draw_with: what draws sentences with what they ask for from random numbers; all kinds of `ParserTexts` when None.
        start: a parser that learns further, at lower rates, with more sentences of writers and lists; a new one when None.
        steps: optimisation steps; `STEPS`, or `FURTHER_STEPS` from a parser, when None.
    """
    encoder = load_text_encoder()
    rng = random.Random()
    steps = steps or (FURTHER_STEPS if start else STEPS)
    shares = FURTHER_SHARES if start else Shares()
    draw = draw_with(rng) if draw_with is not None else ParserTexts(rng, shares).draw
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(SEED)
        parser = SentenceParser(ParserConfig(tokens()), encoder.config)
        copy_layers(parser.layers, encoder, 0)
        if start:
            parser.load_state_dict(load_parser(start).state_dict())
        batches = lru_cache(maxsize=1)(partial(_batches, draw, rng))

        def losses(step: int, _generator: torch.Generator) -> dict[str, Tensor]:
            at = step % TOGETHER
            return {"loss": _loss(parser, encoder, [_canonical(one) for one in batches(step - at)[at]])}

        rate = RATE * FURTHER_RATE if start else RATE
        schedule = Schedule(steps, rate, final_share=0.02, weight_decay=0.02, save_every=SAVE_EVERY, seed=SEED)
        run = Run(folder, precision="bf16" if can_pack_bf16() else "fp32")
        train(
            parser,
            losses,
            schedule,
            run,
            f"parser_{_data_key(steps, shares, start)}",
            slower={"layers.": RATE_OF_COPIED / RATE},
        )
    save_parser(out, parser.requires_grad_(False))
    return parser


def _data_key(steps: int, shares: Shares, start: Path | None) -> str:
    """Tells apart runs of other sentences, shares, sizes, steps or parsers to start from; the same in every process."""
    sentences = [
        (one.text, one.steps, one.counts) for one in load_labelled_sentences()
    ]  # sets of manners have no fixed order
    return hashlib.sha256(
        repr((steps, BATCH, shares, ParserConfig(tokens()), sentences, start and file_hash(start))).encode()
    ).hexdigest()[:8]


def _batches(draw: Draw, rng: random.Random, first: int) -> list[list[LabelledSentence]]:
    """The batches of `TOGETHER` steps, which depend on the number of the first of them alone."""
    rng.seed(SEED * 1_000_003 + first)
    return list(islice(batches_of(draw, BATCH, first), TOGETHER))


def _loss(parser: SentenceParser, encoder: MiniLm, batch: Sequence[LabelledSentence]) -> Tensor:
    """Cross entropy of the tokens of a batch and of its numbers, the sum of each sentence's."""
    ids, mask = encoder.piece_ids([one.text for one in batch])
    with torch.no_grad():
        embedded = encoder.lower_states(ids, mask, 0)
    sequences = [token_ids(one.steps)[: parser.config.longest] for one in batch]
    width = max(map(len, sequences))
    given = torch.tensor([[*s, *[END_ID] * (width - len(s))] for s in sequences])
    wanted = torch.tensor([[*s[1:], *[_NOT_GIVEN] * (width - len(s))] for s in sequences])
    memory = parser.remember(embedded, mask, DROPOUT)
    decoded = parser.decoded(memory, mask, given[:, :-1], DROPOUT)
    scores = parser.out(decoded).float()
    of_tokens = F.cross_entropy(
        scores.transpose(1, 2), wanted, ignore_index=_NOT_GIVEN, label_smoothing=SMOOTHING, reduction="sum"
    )
    pairs = [pair for pair in number_pairs(encoder, batch) if pair.token < decoded.shape[1]]
    if not pairs:
        return of_tokens / len(batch)
    sentence, piece, token, is_meant = torch.tensor(pairs).unbind(1)
    scores = parser.numbers(memory.words[sentence, piece], decoded[sentence, token], DROPOUT).float()
    of_numbers = F.binary_cross_entropy_with_logits(scores, is_meant.float(), reduction="sum")
    return (of_tokens + of_numbers) / len(batch)


def _canonical(one: LabelledSentence) -> LabelledSentence:
    """A sentence or its mirror image, as it is read."""
    image, is_image = canonical(one.text)
    return one._replace(text=image, steps=mirrored(one.steps)) if is_image else one
