"""Training corpus in memory: features or ids of each clip, its captions, and the captions' text states."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray
from rich.progress import track
from torch import Tensor

from mmm_core.model.text import TextEncoder, TextStates
from mmm_core.model.tokenizer import Tokenizer
from mmm_core.model.tokens import FRAMES_PER_TOKEN, MAX_TOKENS
from mmm_core.model.vqvae import VqVae
from mmm_core.training.run import written_whole

ENCODE_BATCH = 64
"""Captions that are encoded at once."""
CORPUS = "corpus.npz"
"""File of the training motions in a run's folder."""


@dataclass(frozen=True)
class Clip:
    """One training motion.

    Attributes:
        features: (T, F).
        captions: sentences for the part of the motion after its seen tokens.
        is_real: whether a person made it.
        n_seen: tokens at the beginning that show another motion, which this one continues; they are given to the model and
            not learnt.
        n_rest: tokens of rest added after the gesture's end; if negative, the gesture's last -`n_rest` tokens are cut off.
    """

    features: NDArray[np.float32]
    captions: list[str]
    is_real: bool
    n_seen: int = 0
    n_rest: int = 0


def captions_of_people(clips: Iterable[Clip]) -> list[str]:
    """The captions of people's clips, each once."""
    return sorted({caption for clip in clips if clip.is_real for caption in clip.captions})


def cut_to_tokens(clip: Clip, generator: np.random.Generator) -> Clip:
    """A clip of whole tokens, at most the longest length, cut at a random place."""
    T = min(len(clip.features) // FRAMES_PER_TOKEN, MAX_TOKENS) * FRAMES_PER_TOKEN
    start = int(generator.integers(0, len(clip.features) - T + 1))
    return Clip(clip.features[start : start + T], clip.captions, clip.is_real)


class CaptionStates:
    """Text states of many captions, encoded once and kept in half precision."""

    def __init__(self, words: Tensor, n_words: NDArray[np.int64], sentences: Tensor) -> None:
        """Keep word states (N, D) of all captions in a row, the number of word pieces of each, and sentence vectors (n, D)."""
        self.words, self.n_words, self.sentences = words, n_words, sentences
        self.offsets = np.concatenate([[0], np.cumsum(n_words)])

    @classmethod
    def encode(cls, captions: Sequence[str], encoder: TextEncoder) -> CaptionStates:
        """Encode `captions`, in batches of similar length."""
        order = sorted(range(len(captions)), key=lambda i: len(captions[i]))
        n_words = np.zeros(len(captions), np.int64)
        words: list[Tensor] = [torch.empty(0)] * len(captions)
        sentences: list[Tensor] = [torch.empty(0)] * len(captions)
        for start in track(range(0, len(order), ENCODE_BATCH), description="captions"):
            rows = order[start : start + ENCODE_BATCH]
            states = encoder.encode([captions[i] for i in rows])
            for row, i in enumerate(rows):
                n_words[i] = int(states.word_mask[row].sum())
                words[i] = states.words[row, : n_words[i]].half()
                sentences[i] = states.sentence[row].half()
        return cls(torch.cat(words), n_words, torch.stack(sentences))

    def save(self, path: Path) -> None:
        """Write the states to a file."""
        state = {"words": self.words, "n_words": torch.from_numpy(self.n_words), "sentences": self.sentences}
        with written_whole(path) as partial:
            torch.save(state, partial)

    @classmethod
    def load(cls, path: Path) -> CaptionStates:
        """Read what `save` wrote."""
        state = torch.load(path, weights_only=True)
        return cls(state["words"], state["n_words"].numpy(), state["sentences"])

    def gather(self, indices: Sequence[int]) -> TextStates:
        """States of the captions at `indices`, padded to a multiple of eight word pieces."""
        width = int(-(-self.n_words[list(indices)].max() // 8) * 8)
        words = torch.zeros(len(indices), width, self.words.shape[1])
        mask = torch.zeros(len(indices), width, dtype=torch.bool)
        for row, i in enumerate(indices):
            n = int(self.n_words[i])
            words[row, :n] = self.words[self.offsets[i] : self.offsets[i] + n].float()
            mask[row, :n] = True
        return TextStates(words, mask, self.sentences[list(indices)].float())


@dataclass(frozen=True, eq=False)
class TokenCorpus:
    """The transformer's training data.

    Attributes:
        ids: for each clip (L, C) int64.
        caption_rows: for each clip the rows of its captions in `captions`.
        captions: the encoded captions.
        is_real: for each clip whether a person made it.
        n_seen: `Clip.n_seen` of each clip; None where it is 0 for all.
        n_rest: `Clip.n_rest` of each clip; None where it is 0 for all.
    """

    ids: list[Tensor]
    caption_rows: list[list[int]]
    captions: CaptionStates
    is_real: NDArray[np.bool_]
    n_seen: NDArray[np.int64] | None = None
    n_rest: NDArray[np.int64] | None = None

    def seen(self, rows: Sequence[int] | NDArray[np.int64]) -> NDArray[np.int64]:
        """Seen tokens of the clips at `rows`."""
        return np.zeros(len(rows), np.int64) if self.n_seen is None else self.n_seen[np.asarray(rows)]

    def own_lengths(self) -> NDArray[np.int64]:
        """Tokens of each clip's own motion, without its seen tokens and the rest added after it."""
        n_tokens = np.array([len(ids) for ids in self.ids], np.int64)
        n_rest = 0 if self.n_rest is None else self.n_rest
        return n_tokens - self.seen(range(len(self.ids))) - n_rest


def encode_clips(clips: Sequence[Clip], tokenizer: Tokenizer | VqVae) -> list[Tensor]:
    """Ids (L, C) of each clip."""
    with torch.inference_mode():
        return [
            tokenizer.encode(torch.from_numpy(clip.features)[None])[0].clone()
            for clip in track(clips, description="tokens")
        ]


def length_buckets(ids: Sequence[Tensor], width: int = 6) -> dict[int, NDArray[np.int64]]:
    """Clip indices by length, rounded up to a multiple of `width` tokens, so that there are few shapes and little padding."""
    buckets: dict[int, list[int]] = {}
    for i, row in enumerate(ids):
        buckets.setdefault(min(-(-len(row) // width) * width, MAX_TOKENS), []).append(i)
    return {length: np.array(rows) for length, rows in sorted(buckets.items())}


def save_clips(path: Path, clips: Sequence[Clip]) -> None:
    """Write clips to a file, so that a resumed run trains on the same ones."""
    lengths = np.array([len(c.features) for c in clips])
    captions = np.array(["\n".join(c.captions) for c in clips])
    features = np.concatenate([c.features for c in clips])
    is_real = np.array([c.is_real for c in clips])
    with written_whole(path) as partial:
        np.savez(partial, features=features, lengths=lengths, captions=captions, is_real=is_real)


def load_clips(path: Path) -> list[Clip]:
    """Read what `save_clips` wrote."""
    with np.load(path, allow_pickle=False) as data:
        features, captions, is_real = data["features"], data["captions"], data["is_real"]
        ends = np.cumsum(data["lengths"])
    starts = np.concatenate([[0], ends[:-1]])
    return [
        Clip(features[a:b], str(text).split("\n"), bool(real))
        for a, b, text, real in zip(starts, ends, captions, is_real, strict=True)
    ]
