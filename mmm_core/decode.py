"""Parallel decoding (hot path): masked tokens -> tokens, all positions at once, the surest first.

MMM (arXiv 2312.03596) sec. 3.3. Each step predicts every masked position, keeps the most confident ones and masks the
rest again; a token once kept is never changed, so known tokens (context of an edit) survive by construction.
`decode_plain` is the oracle: the same rule, one sequence at a time, written for reading.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import torch
from torch import Tensor

from mmm_core.schedule import Schedule, masked_counts

LogitsFn = Callable[[Tensor], Tensor]
"""(B, L, C) ids with [MASK] where to fill -> (B, L, C, K) logits."""


@dataclass(frozen=True)
class DecodeSettings:
    """How to decode: steps for the longest motion, schedule, and randomness (0 = arg-max)."""

    n_steps: int = 10
    schedule: Schedule = "cosine"
    temperature: float = 1.0


def gumbel_noise(shape: tuple[int, ...], seeds: list[int], step: int) -> Tensor:
    """(B, ...) Gumbel noise in which row b depends on seeds[b] and `step` alone.

    So a batch of one and a batch of many give the same tokens for the same seed.
    """
    rows: list[Tensor] = []
    for seed in seeds:
        generator = torch.Generator().manual_seed((seed * 1_000_003 + step) % (2**63 - 1))
        uniform = torch.rand(shape[1:], generator=generator).clamp_(1e-20, 1 - 1e-7)
        rows.append(-torch.log(-torch.log(uniform)))
    return torch.stack(rows)


@torch.inference_mode()
def decode(tokens: Tensor, logits_fn: LogitsFn, mask_id: int, settings: DecodeSettings, seeds: list[int]) -> Tensor:
    """Fill every [MASK] in `tokens`.

    Args:
        tokens: (B, L, C) int64 ids; a position is open when its first codebook holds `mask_id`.
        logits_fn: the model, see `LogitsFn`.
        mask_id: id of [MASK].
        settings: steps, schedule, temperature.
        seeds: one per row.

    Returns:
        (B, L, C) ids without [MASK]; rows may have different numbers of open positions.
    """
    tokens = tokens.clone()
    open_positions = tokens[..., 0] == mask_id  # (B, L)
    n_open = open_positions.sum(1).tolist()
    counts = [masked_counts(n, settings.n_steps, settings.schedule) for n in n_open]
    uncertainty = torch.where(open_positions, 1.0, -1.0)  # (B, L); only open positions can be masked again
    rows = torch.arange(len(tokens))[:, None]
    for step in range(max((len(c) for c in counts), default=0)):
        wanted = torch.tensor([c[step] if step < len(c) else 0 for c in counts])
        rank = uncertainty.argsort(dim=1, descending=True, stable=True).argsort(dim=1)
        masked = rank < wanted[:, None]  # (B, L): the `wanted` most uncertain of each row
        tokens[masked] = mask_id
        logits = logits_fn(tokens).float()  # (B, L, C, K)
        chosen = _choose(logits, settings.temperature, seeds, step)
        tokens = torch.where(masked[..., None], chosen, tokens)
        confidence = logits.softmax(-1)[rows[..., None], torch.arange(tokens.shape[1])[None, :, None],
                                        torch.arange(tokens.shape[2]), chosen].mean(-1)  # fmt: skip
        uncertainty = torch.where(masked, 1.0 - confidence, torch.full_like(uncertainty, -1.0))
    return tokens


def decode_plain(
    tokens: Tensor, logits_fn: LogitsFn, mask_id: int, settings: DecodeSettings, seeds: list[int]
) -> Tensor:
    """The same result as `decode`, one sequence at a time and one position at a time: the test oracle."""
    results: list[Tensor] = []
    for row, seed in zip(tokens, seeds, strict=True):
        ids = row.clone()
        score = {i: 1.0 for i in range(len(ids)) if int(ids[i, 0]) == mask_id}
        for step, count in enumerate(masked_counts(len(score), settings.n_steps, settings.schedule)):
            chosen_positions = sorted(score, key=lambda i: (-score[i], i))[:count]
            ids[chosen_positions] = mask_id
            logits = logits_fn(ids[None])[0].float()
            choice = _choose(logits[None], settings.temperature, [seed], step)[0]
            score = {}
            for i in chosen_positions:
                ids[i] = choice[i]
                probability = logits[i].softmax(-1).gather(-1, choice[i][:, None]).mean()
                score[i] = 1.0 - float(probability)
        results.append(ids)
    return torch.stack(results)


def _choose(logits: Tensor, temperature: float, seeds: list[int], step: int) -> Tensor:
    """Arg-max, or Gumbel-max sampling at `temperature`: (B, L, C, K) -> (B, L, C)."""
    if temperature > 0:
        logits = logits + temperature * gumbel_noise(tuple(logits.shape), seeds, step)
    return logits.argmax(-1)
