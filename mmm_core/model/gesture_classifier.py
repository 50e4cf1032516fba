"""Says which gesture of the corpus a command asks for, in whatever words.

The lower layers are the text encoder's own; the classifier adds copies of its next layers, trained further, and one linear
layer on the mean of their states. The motion model reads words by the text encoder as it is, which knows the sentences of the
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
        n_shared: layers of the text encoder that the classifier uses as they are.
        n_own: layers of its own above them.
    """

    classes: tuple[str, ...]
    n_shared: int = 3
    n_own: int = 3


class GestureClassifier(nn.Module):
    """Classifier of texts above the lower layers of a text encoder, which is no part of its weights."""

    def __init__(self, config: ClassifierConfig, text: MiniLmConfig) -> None:
        super().__init__()
        self.config = config
        self.layers = nn.ModuleList(WordLayer(text) for _ in range(config.n_own))
        self.gesture = nn.Linear(text.width, len(config.classes))

    def forward(self, states: Tensor, mask: Tensor, dropout: float = 0.0) -> Tensor:
        """Scores (B, classes) of texts.

        Args:
            states: (B, W, D) states of word pieces after the encoder's shared layers.
            mask: (B, W) bool, true where there is a word piece.
            dropout: share of the values that training drops after each layer.
        """
        x = F.dropout(states, dropout, self.training)
        for layer in self.layers:
            x = F.dropout(layer(x, mask[:, None, None, :]), dropout, self.training)
        weights = mask[..., None].to(x.dtype)
        return self.gesture((x * weights).sum(1) / weights.sum(1))


@torch.inference_mode()
def likeliest(classifier: GestureClassifier, encoder: MiniLm, texts: Sequence[str]) -> list[tuple[str, float]]:
    """The likeliest class of each text, with its probability."""
    ids, mask = encoder.piece_ids(list(texts))
    return likeliest_of_states(classifier, encoder.lower_states(ids, mask, classifier.config.n_shared), mask)


@torch.inference_mode()
def likeliest_of_states(classifier: GestureClassifier, states: Tensor, mask: Tensor) -> list[tuple[str, float]]:
    """The likeliest class of each of B texts, with its probability, from states (B, W, D) and mask (B, W) of `forward`."""
    probability, index = F.softmax(classifier(states, mask).float(), -1).max(-1)
    return [
        (classifier.config.classes[int(i)], float(p)) for i, p in zip(index.tolist(), probability.tolist(), strict=True)
    ]
