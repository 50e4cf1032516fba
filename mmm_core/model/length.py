"""Length from text: the seconds that a command takes, with their spread.

A log-normal: the median and the spread of log seconds are read from the word states by attention pooling, so that
counts ("five times") reach it. The caller's `seconds` always wins over this.
"""

from __future__ import annotations

import torch
from torch import Tensor, nn

from mmm_core.model.text import TextStates


class LengthPredictor(nn.Module):
    """Text states -> mean and log standard deviation of log seconds."""

    def __init__(self, text_dim: int = 384, width: int = 192, n_heads: int = 4) -> None:
        super().__init__()
        self.n_heads = n_heads
        self.score = nn.Linear(text_dim, n_heads)
        self.value = nn.Linear(text_dim, n_heads * width // n_heads)
        self.body = nn.Sequential(nn.Linear(width + text_dim, width), nn.GELU(), nn.Linear(width, width), nn.GELU())
        self.out = nn.Linear(width, 2)

    def forward(self, text: TextStates) -> tuple[Tensor, Tensor]:
        """(B,) mean and (B,) log standard deviation of log seconds."""
        B, W, _ = text.words.shape
        scores = self.score(text.words).masked_fill(~text.word_mask[..., None], -1e9).softmax(1)  # (B, W, H)
        values = self.value(text.words).reshape(B, W, self.n_heads, -1)
        pooled = (scores[..., None] * values).sum(1).reshape(B, -1)
        mean, log_std = self.out(self.body(torch.cat([pooled, text.sentence], -1))).unbind(-1)
        return mean + 1.0, log_std.clamp(-4.0, 1.0)  # +1: e seconds is a usual length

    @torch.inference_mode()
    def seconds(self, text: TextStates, quantile: float = 0.5) -> list[float]:
        """The `quantile` of the predicted length, seconds, for each text."""
        mean, log_std = self(text)
        z = torch.special.ndtri(torch.tensor(quantile, dtype=torch.float64)).float()
        return (mean + z * log_std.exp()).exp().tolist()
