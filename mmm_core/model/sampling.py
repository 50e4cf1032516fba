"""Fills the [MASK]s in rows of ids for a text, by parallel decoding with the masked model.

Every use of the model is a mask for `fill`: generation from text alone masks all positions; in-betweening, endings,
transitions and edits of a body part keep the known ids (MMM, arXiv 2312.03596, sec. 3.3 and 3.4).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import torch
import torch.nn.functional as F
from torch import Tensor

from mmm_core.errors import GenerationError
from mmm_core.model.decode import DecodeSettings, LogitsFn, NoiseFn, decode
from mmm_core.model.schedule import Schedule, masked_counts, official_counts
from mmm_core.model.text import TextStates
from mmm_core.model.transformer import MotionTransformer, StepMemory


@dataclass(frozen=True)
class SamplingSettings:
    """Settings of a generation.

    Attributes:
        steps: decoding steps, fewer where there are fewer tokens to fill.
        temperature: randomness; 0 always takes the likeliest id.
        guidance: weight of the text; 1 is the plain model, above it a second pass without text is subtracted.
        schedule: course of the masked share over the steps.
        opening: tokens at the beginning that keep their ids from the first step, so that playing may begin after it
            (`mmm_core.generate.motion_generation`).
        official: the released sampler's steps (`schedule.official_counts`) with `steps` for the longest motion.
    """

    steps: int = 4
    temperature: float = 0.5
    guidance: float = 1.0
    schedule: Schedule = "cosine"
    opening: int = 0
    official: bool = False


OFFICIAL_SAMPLING = SamplingSettings(steps=10, temperature=0.0, official=True)
"""The released generator: ten steps, arg-max. The paper's evaluation takes temperature 1."""
OFFICIAL_UPPER_BODY = SamplingSettings(steps=20, temperature=1.0, official=True)
"""The released upper-body editor: twenty steps at temperature 1."""


@dataclass
class FirstStep:
    """The logits of a row's first decoding step, kept to decode the same row and text again in another number of steps."""

    logits: Tensor | None = None

    def reused(self, logits_fn: LogitsFn) -> LogitsFn:
        """`logits_fn` for one decoding; its first call returns the kept logits, or computes and keeps them."""
        begun = False

        def answer(tokens: Tensor, asked: Tensor) -> Tensor:
            nonlocal begun
            if begun:
                return logits_fn(tokens, asked)
            begun = True
            if self.logits is None:
                self.logits = logits_fn(tokens, asked)
            return self.logits

        return answer


def empty_row(transformer: MotionTransformer, n_tokens: int) -> Tensor:
    """(n_tokens, C) ids, all [MASK]."""
    return torch.full((n_tokens, transformer.config.n_codebooks), transformer.ids.mask)


def fill(
    transformer: MotionTransformer,
    text: TextStates,
    rows: Sequence[Tensor],
    seeds: Sequence[int],
    settings: SamplingSettings,
    noise: NoiseFn | None = None,
    first: FirstStep | None = None,
) -> list[Tensor]:
    """Fill the [MASK]s of all `rows` in one batch.

    Args:
        transformer: the model.
        text: states of B texts, one for each row.
        rows: B rows (L_i, C) of ids, [MASK] where to fill.
        seeds: one for each row; a row's result does not depend on its neighbours.
        settings: steps, temperature, guidance.
        noise: source of randomness; None draws it from `seeds`.
        first: keeps or supplies the first step's logits, for rows that are filled twice.

    Returns:
        B rows (L_i, C).

    Raises:
        GenerationError: a row is empty or longer than the model's longest motion, or guidance is asked of a model that
            was never trained without text.
    """
    ids, longest = transformer.ids, transformer.positions.shape[0] - 2
    for row in rows:
        if not 0 < len(row) <= longest:
            raise GenerationError(f"a row of {len(row)} tokens was asked for", f"1 to {longest} tokens")
    guided = settings.guidance != 1.0
    if guided and not bool(transformer.no_words.any()):
        raise GenerationError(f"guidance {settings.guidance} was asked for", "1: this model knows no text dropout")
    width = max(len(row) for row in rows) + 1
    batch = torch.full((len(rows), width, transformer.config.n_codebooks), ids.pad)
    for i, row in enumerate(rows):
        batch[i, : len(row)] = row
        batch[i, len(row)] = ids.end
    context = transformer.read_text(_and_without(text, transformer) if guided else text)

    memory = StepMemory() if len(rows) == 1 and not guided else None

    def logits_fn(tokens: Tensor, asked: Tensor) -> Tensor:
        if not guided:
            return transformer(tokens, context, asked, memory)
        both = transformer(tokens.repeat(2, 1, 1), context, asked.repeat(2, 1))
        with_text, without = both.chunk(2)
        return without + settings.guidance * (with_text - without)

    n_predicted = transformer.config.n_out
    n_open = [int((row[:, :n_predicted] == ids.mask).any(-1).sum()) for row in rows]
    counts = [_counts(n, len(row), settings, early_exit=len(rows) == 1 and n_predicted == transformer.config.n_codebooks)
              for n, row in zip(n_open, rows, strict=True)]  # fmt: skip
    how = DecodeSettings(settings.steps, settings.schedule, settings.temperature, settings.opening)
    answer = logits_fn if first is None else first.reused(logits_fn)
    filled = decode(batch, answer, ids.mask, how, list(seeds), n_predicted=n_predicted, counts=counts, noise=noise)
    return [filled[i, : len(row)] for i, row in enumerate(rows)]


def _counts(n_open: int, n_tokens: int, settings: SamplingSettings, *, early_exit: bool) -> list[int]:
    """Masked positions before each step of a row; they do not depend on the other rows of the batch."""
    if not settings.official:
        return masked_counts(n_open, settings.steps, settings.schedule)
    if not n_open:
        return []
    return official_counts(n_open, n_tokens, max_steps=settings.steps, early_exit=early_exit)


def pseudo_log_likelihood(transformer: MotionTransformer, text: TextStates, rows: Sequence[Tensor]) -> Tensor:
    """(B,) mean log-probability that the model gives to the ids of each row when it sees all of them.

    The model learnt to judge visible ids as well as masked ones (eq. 2 counts every position), so this ranks candidates.
    """
    context, scores = transformer.read_text(text), []
    for i, row in enumerate(rows):
        one = context.row(i)
        closed = torch.cat([row, torch.full((1, row.shape[1]), transformer.ids.end)])[None]
        log_p = transformer(closed, one)[0, :-1].log_softmax(-1)  # (L, P, K)
        chosen = row[:, : log_p.shape[1], None]
        scores.append(log_p.gather(-1, chosen).mean())
    return torch.stack(scores)


def _and_without(states: TextStates, transformer: MotionTransformer) -> TextStates:
    """States of 2 B texts: the B given ones, then B times "no text", padded to the same width."""
    B, width = states.words.shape[:2]
    empty = transformer.no_text(B)
    return TextStates(
        torch.cat([states.words, F.pad(empty.words, (0, 0, 0, width - 1))]),
        torch.cat([states.word_mask, F.pad(empty.word_mask, (0, width - 1))]),
        torch.cat([states.sentence, empty.sentence]),
    )
