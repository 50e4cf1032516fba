"""Parallel decoding (hot path): fills masked tokens, all positions at once, keeping the surest first.

MMM (arXiv 2312.03596) sec. 3.3. Each step predicts every masked position, keeps the most confident ones and masks the
rest again; a token once kept is never changed, so known tokens (context of an edit) survive by construction.
`decode_plain` is the oracle: the same rule, one sequence at a time, written for reading.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import torch
from torch import Tensor

from mmm_core.model.schedule import Schedule, masked_counts

KEPT = -0.5
"""Uncertainty of a position below which its id is known already. A chosen id's uncertainty is at least 0, but for
rounding."""
LogitsFn = Callable[[Tensor, Tensor], Tensor]
"""The model: (B, L, C) ids with [MASK] where to fill, and a (B, L) bool mask of N positions -> (N, P, K) logits at these
positions, row by row, of the first P codebooks."""
NoiseFn = Callable[[int, Tensor, tuple[int, int]], Tensor]
"""(step, (B, L) bool mask of N positions, (P, K)) -> (N, P, K) Gumbel noise, which is drawn anew and may be overwritten."""


@dataclass(frozen=True)
class DecodeSettings:
    """Settings of parallel decoding.

    Attributes:
        n_steps: steps for the longest motion.
        schedule: course of the masked share over the steps.
        temperature: randomness; 0 = arg-max.
        opening: positions at a row's beginning that take their likeliest ids in the first step and are never masked
            again, so that they can be played after that step.
    """

    n_steps: int = 10
    schedule: Schedule = "cosine"
    temperature: float = 1.0
    opening: int = 0


def seeded_noise(seeds: list[int]) -> NoiseFn:
    """Gumbel noise whose row b depends on nothing but seeds[b], the step and the number of masked positions in that row.

    A batch of one and a batch of many therefore give the same tokens for the same seed.
    """

    def noise(step: int, asked: Tensor, shape: tuple[int, int]) -> Tensor:
        counts: list[int] = asked.sum(1).tolist()
        drawn = torch.empty(sum(counts), *shape)
        for seed, row in zip(seeds, drawn.split(counts), strict=True):
            row.uniform_(generator=torch.Generator().manual_seed((seed * 1_000_003 + step) % (2**63 - 1)))
        return drawn.clamp_(1e-20, 1 - 1e-7).log_().neg_().log_().neg_()  # -log(-log u) is Gumbel

    return noise


@torch.inference_mode()
def decode(
    tokens: Tensor,
    logits_fn: LogitsFn,
    mask_id: int,
    settings: DecodeSettings,
    seeds: list[int],
    *,
    n_predicted: int | None = None,
    counts: list[list[int]] | None = None,
    noise: NoiseFn | None = None,
) -> Tensor:
    """Fill every [MASK] in the predicted codebooks of `tokens`; all other ids stay.

    Args:
        tokens: (B, L, C) int64 ids, `mask_id` where to fill: whole positions, or single codebooks of them (one body
            part while the others are kept).
        logits_fn: the model, see `LogitsFn`.
        mask_id: id of [MASK].
        settings: steps, schedule, temperature.
        seeds: one per row.
        n_predicted: codebooks to fill, the first P; None fills all C.
        counts: masked positions before each step, for each row; None takes them from `settings`.
        noise: source of randomness; None draws it from `seeds`.

    Returns:
        (B, L, C) ids without [MASK] in the first P codebooks; rows may have different numbers of open positions.
    """
    P = tokens.shape[2] if n_predicted is None else n_predicted
    tokens, seen_only = tokens[..., :P].clone(), tokens[..., P:]
    noise = noise or seeded_noise(seeds)
    open_ids = tokens == mask_id  # (B, L, P)
    open_positions = open_ids.any(-1)  # (B, L)
    if counts is None:
        counts = [masked_counts(n, settings.n_steps, settings.schedule) for n in open_positions.sum(1).tolist()]
    uncertainty = torch.where(open_positions, 1.0, -1.0)  # (B, L); positions below `KEPT` are never masked again
    n_steps = max((len(c) for c in counts), default=0)
    for step in range(n_steps):
        wanted = torch.tensor([c[step] if step < len(c) else 0 for c in counts])
        rank = uncertainty.argsort(dim=1, descending=True, stable=True).argsort(dim=1)
        masked = (rank < wanted[:, None]) & (uncertainty > KEPT)  # (B, L): the `wanted` most uncertain of each row
        if not masked.any():
            break
        tokens[open_ids & masked[..., None]] = mask_id
        logits = logits_fn(torch.cat([tokens, seen_only], -1), masked).float()  # (N, P, K)
        chosen = _choose(logits, settings.temperature, noise, step, masked)  # (N, P)
        opening = masked.nonzero()[:, 1] < settings.opening
        chosen[opening] = _likeliest(logits[opening])
        filled = open_ids[masked]  # (N, P): ids that are really chosen; the others are known
        tokens[masked] = torch.where(filled, chosen, tokens[masked])
        if step + 1 == n_steps:
            break  # nothing is masked again
        likelihood = logits.softmax(-1).gather(-1, chosen[..., None])[..., 0]
        uncertainty.fill_(-1.0)
        uncertainty[masked] = 1.0 - (likelihood * filled).sum(-1) / filled.sum(-1)
        uncertainty[:, : settings.opening] = -1.0
    return torch.cat([tokens, seen_only], -1)


def decode_plain(
    tokens: Tensor, logits_fn: LogitsFn, mask_id: int, settings: DecodeSettings, seeds: list[int]
) -> Tensor:
    """The result of `decode`, computed one sequence and one position at a time; it is the test oracle."""
    results: list[Tensor] = []
    for row, seed in zip(tokens, seeds, strict=True):
        ids = row.clone()
        open_books = {i: [c for c in range(ids.shape[1]) if int(ids[i, c]) == mask_id] for i in range(len(ids))}
        score = {i: 1.0 for i, books in open_books.items() if books}
        for step, count in enumerate(masked_counts(len(score), settings.n_steps, settings.schedule)):
            chosen_positions = sorted(sorted(score, key=lambda i: (-score[i], i))[:count])
            if not chosen_positions:
                break
            asked = torch.zeros(1, len(ids), dtype=torch.bool)
            for i in chosen_positions:
                ids[i, open_books[i]] = mask_id
                asked[0, i] = True
            logits = logits_fn(ids[None], asked).float()
            choice = _choose(logits, settings.temperature, seeded_noise([seed]), step, asked)
            opening = [n for n, i in enumerate(chosen_positions) if i < settings.opening]
            choice[opening] = logits[opening].argmax(-1)
            score = {}
            for n, i in enumerate(chosen_positions):
                books = open_books[i]
                ids[i, books] = choice[n, books]
                score[i] = 1.0 - sum(float(logits[n, c].softmax(-1)[choice[n, c]]) for c in books) / len(books)
            score = {i: uncertain for i, uncertain in score.items() if i >= settings.opening}
        results.append(ids)
    return torch.stack(results)


def _choose(logits: Tensor, temperature: float, noise: NoiseFn, step: int, asked: Tensor) -> Tensor:
    """Arg-max, or Gumbel-max sampling at `temperature`: (N, P, K) -> (N, P)."""
    if temperature > 0:
        logits = noise(step, asked, (logits.shape[1], logits.shape[2])).mul_(temperature).add_(logits)
    return _likeliest(logits)


def _likeliest(logits: Tensor) -> Tensor:
    """Arg-max over the last axis, by NumPy, which takes a tenth of PyTorch's time: (N, P, K) -> (N, P)."""
    return torch.from_numpy(logits.numpy().argmax(-1))
