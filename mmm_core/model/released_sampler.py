"""The released sampler written for reading, one motion at a time: the oracle that `sampling.fill` is compared with.

From the paper (MMM, arXiv 2312.03596, sec. 3.3) and the recorded inputs of the released code. Every step predicts all
positions with a plain forward pass, and the numbers of masked positions come from PyTorch's single precision.
"""

from __future__ import annotations

import math

import torch
from torch import Tensor

from mmm_core.model.decode import NoiseFn
from mmm_core.model.text import TextStates
from mmm_core.model.transformer import MotionTransformer


def masked_counts_by_torch(
    n_open: int, n_tokens: int, *, max_steps: int = 10, longest: int = 49, early_exit: bool = False
) -> list[int]:
    """Masked positions before each step; `schedule.official_counts` computes the same numbers without PyTorch."""
    steps = torch.round(torch.tensor(max_steps * n_tokens / longest)) + 1e-8  # float32
    counts: list[int] = []
    for k in range(max_steps):
        progress = torch.clamp(k / steps, max=1.0)
        if early_exit and torch.isclose(torch.clamp(k - 1 / steps, max=1.0), progress):
            break
        counts.append(max(1, int(torch.floor(torch.cos(progress * (math.pi / 2)) * n_open))))
    return counts


@torch.inference_mode()
def sample_plainly(
    transformer: MotionTransformer,
    text: TextStates,
    row: Tensor,
    *,
    max_steps: int = 10,
    temperature: float = 0.0,
    noise: NoiseFn | None = None,
    early_exit: bool = True,
) -> Tensor:
    """(L, C) ids of `row` with its [MASK]s of the predicted codebooks filled as the released sampler fills them.

    Args:
        transformer: the model; a packed one shows whether packing changes ids.
        text: states of one text.
        row: (L, C) ids, [MASK] where to fill.
        max_steps: steps for the longest motion: 10, or 20 for the upper-body editor.
        temperature: 0 is arg-max.
        noise: Gumbel noise; needed above temperature 0.
        early_exit: whether passes end early, as in the released whole-body sampler for a batch of one.
    """
    n_books, mask_id = transformer.config.n_out, transformer.ids.mask
    ids = torch.cat([row, row.new_full((1, row.shape[1]), transformer.ids.end)])
    is_open = (ids[:, :n_books] == mask_id).any(-1)
    n_open = int(is_open.sum())
    if not n_open:
        return row
    score = is_open.float()  # 1 - probability of the chosen id; 0 is never masked again unless positions run short
    context = transformer.read_text(text)
    for step, count in enumerate(masked_counts_by_torch(n_open, len(row), max_steps=max_steps, early_exit=early_exit)):
        masked = torch.zeros_like(is_open)
        masked[score.argsort(descending=True, stable=True)[:count]] = True
        ids[masked, :n_books] = mask_id
        logits = transformer(ids[None], context)[0].float()  # (L + 1, P, K)
        choice = logits[masked]
        if temperature > 0 and noise is not None:
            choice = choice + temperature * noise(step, masked[None], (logits.shape[1], logits.shape[2]))
        ids[masked, :n_books] = choice.argmax(-1)
        likelihood = logits.softmax(-1).gather(-1, ids[:, :n_books, None].clamp(max=logits.shape[2] - 1))[..., 0]
        score = torch.where(masked, 1 - likelihood.mean(-1), torch.zeros(()))
    return ids[:-1]
