"""Predicts the length of a motion from its text, as a number of tokens.

`LengthClassifier` gives a probability to each number of tokens, as the length estimator of T2M does (Guo et al., CVPR 2022),
and the likeliest number is taken. Where a text always means the same motion, every other length is wrong: with one token less
the last stroke is cut in half. `LogNormalLength` is the predictor of checkpoints that were trained before the classifier. The
caller's `seconds` always wins over both.
"""

from __future__ import annotations

import torch
from torch import Tensor, nn

from mmm_core.model.text import TextStates
from mmm_core.model.tokens import MAX_TOKENS, tokens_for_frames
from mmm_core.motion.motion import FPS


class LengthClassifier(nn.Module):
    """Text states -> logits of each number of tokens; attention pooling over the words lets numbers in the text count."""

    def __init__(self, text_dim: int = 384, width: int = 384, n_heads: int = 8) -> None:
        super().__init__()
        self.score = nn.Linear(text_dim, n_heads)
        self.value = nn.Linear(text_dim, width)
        self.body = nn.Sequential(
            nn.Dropout(0.2), nn.Linear(width + text_dim, width), nn.GELU(), nn.Dropout(0.2), nn.Linear(width, width), nn.GELU()
        )  # fmt: skip
        self.out = nn.Linear(width, MAX_TOKENS + 1)

    def forward(self, text: TextStates) -> Tensor:
        """(B, MAX_TOKENS + 1) logits of 0 to MAX_TOKENS tokens."""
        return self.out(self.body(torch.cat([_pooled(text, self.score, self.value), text.sentence], -1)))

    @torch.inference_mode()
    def n_tokens(self, text: TextStates) -> list[int]:
        """The likeliest number of tokens for each text, at least one."""
        return (self(text)[:, 1:].argmax(-1) + 1).tolist()


class LogNormalLength(nn.Module):
    """Text states -> mean of log seconds, by attention pooling over the words. The second output was its spread in training."""

    def __init__(self, text_dim: int = 384, width: int = 192, n_heads: int = 4) -> None:
        super().__init__()
        self.score = nn.Linear(text_dim, n_heads)
        self.value = nn.Linear(text_dim, width)
        self.body = nn.Sequential(nn.Linear(width + text_dim, width), nn.GELU(), nn.Linear(width, width), nn.GELU())
        self.out = nn.Linear(width, 2)

    def forward(self, text: TextStates) -> Tensor:
        """(B,) mean of log seconds."""
        out = self.out(self.body(torch.cat([_pooled(text, self.score, self.value), text.sentence], -1)))
        return out[:, 0] + 1.0  # an output of 0 means e seconds, a usual length

    @torch.inference_mode()
    def n_tokens(self, text: TextStates) -> list[int]:
        """The number of tokens of the median length for each text, at most MAX_TOKENS."""
        return [min(MAX_TOKENS, tokens_for_frames(max(1, round(s * FPS)))) for s in self(text).exp().tolist()]


def _pooled(text: TextStates, score: nn.Linear, value: nn.Linear) -> Tensor:
    """(B, D) word values, each head's share of D averaged over the words by its own scores."""
    scores = score(text.words).masked_fill(~text.word_mask[..., None], -1e9).softmax(1)  # (B, W, H)
    values = value(text.words).reshape(*scores.shape, -1)
    return (scores[..., None] * values).sum(1).flatten(1)


LengthPredictor = LengthClassifier | LogNormalLength
LENGTH_PREDICTORS: dict[str, type[LengthPredictor]] = {c.__name__: c for c in (LengthClassifier, LogNormalLength)}
"""The predictors by the name that a checkpoint's configuration gives."""
