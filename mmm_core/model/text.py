"""Text encoder: turns a text into word states and one sentence vector.

The compact encoder is a BERT-style transformer (6 layers, width 384) whose weights come from all-MiniLM-L6-v2
(Apache-2.0, see docs/DATA.md) and travel with the checkpoint: nothing is downloaded at run time. Architecture: BERT
(arXiv 1810.04805) sec. 3, post-norm; sentence vector: mean of the word states, normalised (sentence-transformers).
"""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass
from itertools import islice
from typing import Protocol

import torch
import torch.nn.functional as F
from tokenizers import Tokenizer as WordPieces
from torch import Tensor, nn

MAX_WORD_PIECES = 64
"""Word pieces that a text is cut to: a command is a sentence or two, and the model was trained on at most this."""

_EMOJI_CATEGORIES = ("So", "Sk", "Cs", "Co", "Cn")
"""Unicode categories of emoji, their skin tones, and signs that no word piece stands for."""
_JOINERS = "\u200d\ufe0e\ufe0f"


def strip_emoji(text: str) -> str:
    """The text without emoji and other signs that are no words, which would change how the encoder reads the words beside them."""
    kept = (c for c in text if c not in _JOINERS and unicodedata.category(c) not in _EMOJI_CATEGORIES)
    return " ".join("".join(kept).split())


@dataclass(frozen=True)
class TextStates:
    """Encoder states of B texts, the transformer's input.

    Attributes:
        words: (B, W, D) state of each word piece. For a model with its own copies of the encoder's last layers
            (`TransformerConfig.n_words`) the states come from below these layers.
        word_mask: (B, W) bool, true where there is a word piece.
        sentence: (B, D) unit vectors.
    """

    words: Tensor
    word_mask: Tensor
    sentence: Tensor

    def repeated(self, times: int) -> TextStates:
        """The states of the whole batch, `times` times."""
        return TextStates(
            self.words.repeat(times, 1, 1), self.word_mask.repeat(times, 1), self.sentence.repeat(times, 1)
        )

    def part(self, rows: slice) -> TextStates:
        """The states of some of the texts."""
        return TextStates(self.words[rows], self.word_mask[rows], self.sentence[rows])

    def to(self, device: torch.device) -> TextStates:
        return TextStates(self.words.to(device), self.word_mask.to(device), self.sentence.to(device))

    @staticmethod
    def stacked(several: list[TextStates]) -> TextStates:
        """The states of several batches as one batch, padded to the longest text."""
        width = max(s.words.shape[1] for s in several)
        return TextStates(
            torch.cat([F.pad(s.words, (0, 0, 0, width - s.words.shape[1])) for s in several]),
            torch.cat([F.pad(s.word_mask, (0, width - s.word_mask.shape[1])) for s in several]),
            torch.cat([s.sentence for s in several]),
        )

    def row(self, i: int) -> TextStates:
        """The states of text `i` alone."""
        return TextStates(self.words[i : i + 1], self.word_mask[i : i + 1], self.sentence[i : i + 1])


class TextEncoder(Protocol):
    """Encoder of texts: the compact one or CLIP's text tower."""

    def encode(self, texts: list[str]) -> TextStates: ...


@dataclass(frozen=True)
class MiniLmConfig:
    """Sizes of the compact encoder."""

    vocabulary: int = 30522
    width: int = 384
    n_layers: int = 6
    n_heads: int = 12
    mlp_width: int = 1536
    max_positions: int = 512


class WordLayer(nn.Module):
    """Post-norm transformer layer of BERT."""

    def __init__(self, config: MiniLmConfig) -> None:
        super().__init__()
        self.n_heads = config.n_heads
        self.qkv = nn.Linear(config.width, 3 * config.width)
        self.attention_out = nn.Linear(config.width, config.width)
        self.attention_norm = nn.LayerNorm(config.width, eps=1e-12)
        self.mlp_in = nn.Linear(config.width, config.mlp_width)
        self.mlp_out = nn.Linear(config.mlp_width, config.width)
        self.mlp_norm = nn.LayerNorm(config.width, eps=1e-12)

    def forward(self, x: Tensor, key_mask: Tensor) -> Tensor:
        """(B, W, D) with (B, 1, 1, W) bool mask -> (B, W, D)."""
        B, W, D = x.shape
        q, k, v = self.qkv(x).reshape(B, W, 3, self.n_heads, -1).permute(2, 0, 3, 1, 4)
        attended = F.scaled_dot_product_attention(q, k, v, attn_mask=key_mask)
        x = self.attention_norm(x + self.attention_out(attended.transpose(1, 2).reshape(B, W, D)))
        return self.mlp_norm(x + self.mlp_out(F.gelu(self.mlp_in(x))))


class MiniLm(nn.Module):
    """The compact encoder. Call `encode`; weights are set by `mmm_core.inference.checkpoint`.

    Attributes:
        n_left_out: number of last layers that word states skip: a model with its own copies of these layers applies them
            itself. Sentence vectors pass all layers.
    """

    def __init__(self, config: MiniLmConfig, word_pieces: WordPieces, n_left_out: int = 0) -> None:
        super().__init__()
        self.config, self.n_left_out = config, n_left_out
        self.word_pieces = word_pieces
        self.word_pieces.no_padding()
        self.word_pieces.enable_truncation(MAX_WORD_PIECES)
        self.word_embedding = nn.Embedding(config.vocabulary, config.width)
        self.position_embedding = nn.Embedding(config.max_positions, config.width)
        self.type_embedding = nn.Parameter(torch.zeros(config.width))
        self.embedding_norm = nn.LayerNorm(config.width, eps=1e-12)
        self.layers = nn.ModuleList(WordLayer(config) for _ in range(config.n_layers))

    def piece_ids(self, texts: list[str]) -> tuple[Tensor, Tensor]:
        """Word piece ids (B, W), padded with 0, and their mask (B, W)."""
        encoded = [e.ids for e in self.word_pieces.encode_batch(texts)]
        width = max(len(ids) for ids in encoded)
        ids = torch.tensor([row + [0] * (width - len(row)) for row in encoded])
        mask = torch.tensor([[True] * len(row) + [False] * (width - len(row)) for row in encoded])
        return ids, mask

    def lower_states(self, ids: Tensor, mask: Tensor, n_layers: int) -> Tensor:
        """States (B, W, D) of word pieces (B, W) after the first `n_layers` layers; after none, the embeddings."""
        x = self.word_embedding(ids) + self.position_embedding.weight[: ids.shape[1]] + self.type_embedding
        x = self.embedding_norm(x)
        for layer in islice(self.layers, n_layers):
            x = layer(x, mask[:, None, None, :])
        return x

    @torch.inference_mode()
    def encode(self, texts: list[str]) -> TextStates:
        """Word states and unit sentence vectors of `texts`; each text is cut at 64 word pieces."""
        ids, mask = self.piece_ids(texts)
        x = self.lower_states(ids, mask, 0)
        words = x
        for depth, layer in enumerate(self.layers, 1):
            x = layer(x, mask[:, None, None, :])
            if depth <= len(self.layers) - self.n_left_out:
                words = x
        weights = mask[..., None].to(x.dtype)
        sentence = F.normalize((x * weights).sum(1) / weights.sum(1), dim=-1)
        return TextStates(words, mask, sentence)
