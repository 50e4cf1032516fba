"""Says which gesture of the corpus a text asks for, in which tempo and size, and whether it asks for any motion, in whatever words.

The lower layers are the text encoder's own; the classifier adds copies of its next layers, trained further, and three linear
layers on the mean of their states. The motion model reads words by the text encoder as it is, which knows the sentences of the
corpus well and other words for the same gestures less well.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import torch
import torch.nn.functional as F
from torch import Tensor, nn

from mmm_core.model.text import MiniLm, MiniLmConfig, WordLayer


@dataclass(frozen=True)
class ClassifierConfig:
    """Classes and sizes of a classifier.

    Attributes:
        classes: names of the classes: gestures, and texts that are none.
        manners: tempos and sizes.
        n_shared: layers of the text encoder that the classifier uses as they are.
        n_own: layers of its own above them.
    """

    classes: tuple[str, ...]
    manners: tuple[str, ...]
    n_shared: int = 3
    n_own: int = 3


class GestureClassifier(nn.Module):
    """Classifier of texts above the lower layers of a text encoder, which is no part of its weights."""

    def __init__(self, config: ClassifierConfig, text: MiniLmConfig) -> None:
        super().__init__()
        self.config = config
        self.layers = nn.ModuleList(WordLayer(text) for _ in range(config.n_own))
        self.gesture = nn.Linear(text.width, len(config.classes))
        self.manner = nn.Linear(text.width, len(config.manners))
        self.denial = nn.Linear(text.width, 1)

    def forward(self, states: Tensor, mask: Tensor, dropout: float = 0.0) -> tuple[Tensor, Tensor, Tensor]:
        """Scores (B, classes) of the classes of texts, (B, manners) of each manner by itself, and (B,) that nothing may move.

        Args:
            states: (B, W, D) states of word pieces after the encoder's shared layers.
            mask: (B, W) bool, true where there is a word piece.
            dropout: share of the values that training drops after each layer.
        """
        x = F.dropout(states, dropout, self.training)
        for layer in self.layers:
            x = F.dropout(layer(x, mask[:, None, None, :]), dropout, self.training)
        weights = mask[..., None].to(x.dtype)
        mean = (x * weights).sum(1) / weights.sum(1)
        return self.gesture(mean), self.manner(mean), self.denial(mean).squeeze(-1)


MeantByText = tuple[str, float, dict[str, float], float]
"""The likeliest class of a text, its probability, the probability of each manner, and that of nothing being asked for."""


@torch.inference_mode()
def meant_by(classifier: GestureClassifier, encoder: MiniLm, texts: Sequence[str]) -> list[MeantByText]:
    """The class, the manners and the denial of each text."""
    ids, mask = encoder.piece_ids(list(texts))
    return meant_by_states(classifier, encoder.lower_states(ids, mask, classifier.config.n_shared), mask)


@torch.inference_mode()
def meant_by_states(classifier: GestureClassifier, states: Tensor, mask: Tensor) -> list[MeantByText]:
    """The class, the manners and the denial of each of B texts, from states (B, W, D) and mask (B, W) of `forward`."""
    classes, manners, denials = classifier(states, mask)
    probability, index = F.softmax(classes.float(), -1).max(-1)
    of_manners, of_denial = torch.sigmoid(manners.float()).tolist(), torch.sigmoid(denials.float()).tolist()
    return [
        (classifier.config.classes[i], p, dict(zip(classifier.config.manners, some, strict=True)), denied)
        for i, p, some, denied in zip(index.tolist(), probability.tolist(), of_manners, of_denial, strict=True)
    ]
