"""A loss on the motion that predicted ids decode to, beside the cross-entropy of the ids.

Cross-entropy counts every wrong id alike, whether it decodes to nearly the same pose or to quite another. Here the mean code
vector under the predicted distribution is decoded, and its difference from the decoded true ids is measured as in the training
of the tokenizer: features, and their changes from frame to frame.
"""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass

import torch
from torch import Tensor

from mmm_core.errors import TrainingDataError
from mmm_core.model.tokenizer import Tokenizer
from mmm_core.model.tokens import FRAMES_PER_TOKEN
from mmm_core.model.vqvae import VqVae
from mmm_core.training.run import Run
from mmm_core.training.tokenizer_training import DIFFERENCE_WEIGHT, channel_weights, motion_errors


@dataclass(frozen=True)
class MotionLoss:
    """How much the loss on decoded motion counts.

    Attributes:
        weight: weight beside the cross-entropy; 0 leaves this loss out.
        from_share: share of the training steps before it begins.
    """

    weight: float = 0.0
    from_share: float = 0.67

    def counts_at(self, step: int, steps: int) -> bool:
        """Whether the loss is computed at `step` of `steps`."""
        return self.weight > 0 and step >= self.from_share * steps


class DecodedError:
    """Measures the difference of decoded motions with a frozen copy of a tokenizer's decoder."""

    def __init__(self, tokenizer: Tokenizer, device: torch.device) -> None:
        self._tokenizer = deepcopy(tokenizer).requires_grad_(False).eval().to(device)
        self._books = torch.stack([q.codebook for q in self._tokenizer.books])  # (C, K, D)
        self._weights = channel_weights().to(device)

    def __call__(self, logits: Tensor, ids: Tensor, learnt: Tensor) -> Tensor:
        """Difference of normalised features, and of their changes, weighted as in the tokenizer's loss.

        Args:
            logits: (B, L, C, K) predictions.
            ids: (B, L, C) true ids; [END] and [PAD] are taken as code 0 in both motions.
            learnt: (B, L) bool, positions that are predicted. The others have their true ids, and their frames do not count.
        """
        true = self._tokenizer.embed(ids.where(ids < self._books.shape[1], 0))  # (B, L, C * D)
        predicted = torch.einsum("blck,ckd->blcd", logits.softmax(-1), self._books).flatten(2)
        wanted = self._tokenizer.decoder(true)
        decoded = self._tokenizer.decoder(torch.where(learnt[..., None], predicted, true))
        counts = learnt.repeat_interleave(FRAMES_PER_TOKEN, 1)[..., None]
        frames, differences = motion_errors(torch.where(counts, decoded, wanted), wanted, self._weights)
        return (frames + DIFFERENCE_WEIGHT * differences) / counts.float().mean().clamp_min(1e-6)


def error_measure(how: MotionLoss, tokenizer: Tokenizer | VqVae, run: Run) -> DecodedError | None:
    """The measure of decoded motions for a run, or None if its recipe leaves this loss out.

    Raises:
        TrainingDataError: the tokenizer's layout has no such measure.
    """
    if how.weight <= 0:
        return None
    if not isinstance(tokenizer, Tokenizer):
        found = f"{how.weight:g}, with layout '{tokenizer.config.layout}'"
        raise TrainingDataError(run.folder, "transformer.motion_loss.weight", found, "0, or layout 'parts'")
    return DecodedError(tokenizer, run.torch_device)
