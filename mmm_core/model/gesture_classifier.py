"""Says which gesture of the corpus a text asks for, in which tempo and size, and whether it asks for any motion, in whatever words.

The lower layers are the text encoder's own; the classifier adds copies of its next layers, trained further, and three linear
layers on the mean of their states. Of a part of a text it says which gesture the part asks for in its text: "then to the right"
after "look left". The motion model reads words by the text encoder as it is, which knows the sentences of the
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

    def forward(
        self, states: Tensor, mask: Tensor, parts: Tensor, dropout: float = 0.0
    ) -> tuple[Tensor, Tensor, Tensor]:
        """Scores of the classes of parts, and of the manners and the denial of whole texts.

        Args:
            states: (B, W, D) states of word pieces after the encoder's shared layers.
            mask: (B, W) bool, true where there is a word piece.
            parts: (N, W) bool, the word pieces of each part: one for each of B texts, or any number for one text.
            dropout: share of the values that training drops after each layer.

        Returns:
            (N, classes) scores of classes, (B, manners) of each manner by itself, and (B,) that nothing may move.
        """
        return self.scores(self.own_states(states, mask, dropout), mask, parts)

    def own_states(self, states: Tensor, mask: Tensor, dropout: float = 0.0) -> Tensor:
        """States (B, W, D) after its own layers; arguments of `forward`."""
        x = F.dropout(states, dropout, self.training)
        for layer in self.layers:
            x = F.dropout(layer(x, mask[:, None, None, :]), dropout, self.training)
        return x

    def scores(self, own: Tensor, mask: Tensor, parts: Tensor) -> tuple[Tensor, Tensor, Tensor]:
        """Compute the scores of `forward` from the states (B, W, D) that `own_states` returns."""
        whole = _mean(own, mask)
        return self.gesture(_mean(own, parts)), self.manner(whole), self.denial(whole).squeeze(-1)


def _mean(x: Tensor, where: Tensor) -> Tensor:
    """(N, D) means of states (B, W, D) where (N, W) is true."""
    weights = where[..., None].to(x.dtype)
    return (x * weights).sum(1) / weights.sum(1)


MeantByText = tuple[str, float, dict[str, float], float]
"""The likeliest class of a text, its probability, the probability of each manner, and that of nothing being asked for."""


@torch.inference_mode()
def meant_by(classifier: GestureClassifier, encoder: MiniLm, texts: Sequence[str]) -> list[MeantByText]:
    """The class, the manners and the denial of each text."""
    ids, mask = encoder.piece_ids(list(texts))
    states = encoder.lower_states(ids, mask, classifier.config.n_shared)
    return meant_by_states(classifier, own_states(classifier, states, mask), mask)


@torch.inference_mode()
def own_states(classifier: GestureClassifier, states: Tensor, mask: Tensor) -> Tensor:
    """`GestureClassifier.own_states` without gradients."""
    return classifier.own_states(states, mask)


@torch.inference_mode()
def meant_by_states(classifier: GestureClassifier, own: Tensor, mask: Tensor) -> list[MeantByText]:
    """The class, the manners and the denial of each of B texts, from their `own_states` (B, W, D) and mask (B, W)."""
    classes, manners, denials = classifier.scores(own, mask, mask)
    of_manners, of_denial = torch.sigmoid(manners.float()).tolist(), torch.sigmoid(denials.float()).tolist()
    return [
        (name, p, dict(zip(classifier.config.manners, some, strict=True)), denied)
        for (name, p), some, denied in zip(_likeliest(classifier, classes), of_manners, of_denial, strict=True)
    ]


@torch.inference_mode()
def meant_by_parts(classifier: GestureClassifier, own: Tensor, parts: Tensor) -> list[tuple[str, float]]:
    """The likeliest class of each of N parts of one text, with its probability.

    Args:
        classifier: the classifier.
        own: (1, W, D) `own_states` of the text.
        parts: (N, W) bool, the word pieces of each part, at least one.
    """
    return _likeliest(classifier, classifier.gesture(_mean(own, parts)))


def _likeliest(classifier: GestureClassifier, scores: Tensor) -> list[tuple[str, float]]:
    probability, index = F.softmax(scores.float(), -1).max(-1)
    return [(classifier.config.classes[i], p) for i, p in zip(index.tolist(), probability.tolist(), strict=True)]
