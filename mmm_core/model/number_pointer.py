"""Tells whether a number in a sentence says how often a gesture is to be done, as a pointer network does (arXiv 1506.03134).

A number is pointed at and then read by its word, so that no number has to be learnt.
"""

from __future__ import annotations

import torch
import torch.nn.functional as F
from torch import Tensor, nn

_WIDTH = 64


class NumberPointer(nn.Module):
    """Scores pairs of a number word and a gesture, by a sum and by a product of both.

    Args:
        n_word: width of the state of a word.
        n_gesture: width of the state of a gesture.
    """

    def __init__(self, n_word: int, n_gesture: int) -> None:
        super().__init__()
        self.of_word, self.of_gesture = nn.Linear(n_word, 2 * _WIDTH), nn.Linear(n_gesture, 2 * _WIDTH)
        self.out = nn.Linear(2 * _WIDTH, 1)

    def forward(self, words: Tensor, gestures: Tensor, dropout: float = 0.0) -> Tensor:
        """Log-odds (...) of pairs, given states (..., D) of words and (..., width) of gestures, which broadcast."""
        (added, factor), (other, of_other) = (
            of(x).chunk(2, -1) for of, x in ((self.of_word, words), (self.of_gesture, gestures))
        )
        both = torch.cat((F.gelu(added + other), factor * of_other), -1)
        return self.out(F.dropout(both, dropout, self.training)).squeeze(-1)
