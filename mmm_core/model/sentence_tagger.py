"""Tags the words of a sentence: which belong to a command, how commands follow each other, and which say tempo or size.

The lower layers are the text encoder's own; the tagger adds copies of its next layers, trained further, and two linear layers. A
word is tagged by the state of its first word piece.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import torch
import torch.nn.functional as F
from torch import Tensor, nn

from mmm_core.model.text import MiniLm, MiniLmConfig, WordLayer


@dataclass(frozen=True)
class TaggerConfig:
    """Sizes of a tagger.

    Attributes:
        n_tags: number of tags.
        n_manners: number of manners.
        n_shared: layers of the text encoder that the tagger uses as they are.
        n_own: layers of its own above them.
    """

    n_tags: int = 8
    n_manners: int = 5
    n_shared: int = 3
    n_own: int = 3


class SentenceTagger(nn.Module):
    """Tagger of words above the lower layers of a text encoder, which is no part of its weights."""

    def __init__(self, config: TaggerConfig, text: MiniLmConfig) -> None:
        super().__init__()
        self.config = config
        self.layers = nn.ModuleList(WordLayer(text) for _ in range(config.n_own))
        self.tag = nn.Linear(text.width, config.n_tags)
        self.manner = nn.Linear(text.width, config.n_manners)

    def forward(
        self, states: Tensor, mask: Tensor, first_pieces: Tensor, dropout: float = 0.0
    ) -> tuple[Tensor, Tensor]:
        """Scores (B, N, tags) and (B, N, manners) of words.

        Args:
            states: (B, W, D) states of word pieces after the encoder's shared layers.
            mask: (B, W) bool, true where there is a word piece.
            first_pieces: (B, N) index of each word's first piece.
            dropout: share of the values that training drops after each layer.
        """
        x = F.dropout(states, dropout, self.training)
        for layer in self.layers:
            x = F.dropout(layer(x, mask[:, None, None, :]), dropout, self.training)
        words = x.gather(1, first_pieces[..., None].expand(-1, -1, x.shape[-1]))
        return self.tag(words), self.manner(words)


@dataclass(frozen=True)
class WordStates:
    """The word pieces of one sentence as the text encoder sees them.

    Attributes:
        embedded: (W, D) their embeddings.
        states: (W, D) their states after the shared layers.
        first_pieces: (N,) index of each word's first piece.
    """

    embedded: Tensor
    states: Tensor
    first_pieces: Tensor


@torch.inference_mode()
def word_states(encoder: MiniLm, n_shared: int, sentences: Sequence[Sequence[str]]) -> list[WordStates]:
    """States of sentences that are given as words, in one batch; a word beyond the encoder's longest text has the last piece's."""
    encoded = [encoder.word_pieces.encode(list(words), is_pretokenized=True) for words in sentences]
    width = max(len(e.ids) for e in encoded)
    ids = torch.tensor([e.ids + [0] * (width - len(e.ids)) for e in encoded])
    mask = torch.tensor([[True] * len(e.ids) + [False] * (width - len(e.ids)) for e in encoded])
    embedded, states = (encoder.lower_states(ids, mask, n) for n in (0, n_shared))
    found: list[WordStates] = []
    for row, (e, words) in enumerate(zip(encoded, sentences, strict=True)):
        first: dict[int, int] = {}
        for piece, word in enumerate(e.word_ids):
            if word is not None:
                first.setdefault(word, piece)
        last = len(e.ids) - 1
        index = torch.tensor([first.get(word, last) for word in range(len(words))])
        own = slice(len(e.ids))
        found.append(WordStates(embedded[row, own].clone(), states[row, own].clone(), index))
    return found


@torch.inference_mode()
def log_probability(tagger: SentenceTagger, words: WordStates) -> tuple[Tensor, Tensor]:
    """(N, tags) and (N, manners) log-probabilities for each word of one sentence."""
    mask = torch.ones(1, len(words.states), dtype=torch.bool)
    tags, manners = tagger(words.states[None], mask, words.first_pieces[None])
    return F.log_softmax(tags[0].float(), -1), F.log_softmax(manners[0].float(), -1)


def pieces_of(words: WordStates, numbers: Sequence[Sequence[int]]) -> Tensor:
    """(N, W) bool, the word pieces of N groups of words, given by the words' numbers."""
    n_pieces = len(words.states)
    ends = [*words.first_pieces[1:].tolist(), n_pieces - 1]
    found = torch.zeros(len(numbers), n_pieces, dtype=torch.bool)
    for row, group in enumerate(numbers):
        for word in group:
            first = int(words.first_pieces[word])
            found[row, first : max(first + 1, ends[word])] = True
    return found
