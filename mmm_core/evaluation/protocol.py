"""The evaluation protocol: real, reconstructed and generated motions against their texts, repeated.

MMM (arXiv 2312.03596) sec. 5 after Guo et al. 2022: generated motions have the real ones' lengths, pools of 32 are drawn
from all pairs, and everything is repeated with other seeds for a 95 % interval. Where there are fewer than 32 pairs there
is no R-precision; with fewer vectors than dimensions the covariances are singular and FID says little: `n` stands beside
every figure.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray

from mmm_core.corpus.cmu import read_clips
from mmm_core.datasets import Split, open_folder
from mmm_core.engine import Engine
from mmm_core.errors import TrainingDataError
from mmm_core.evaluation import metrics
from mmm_core.evaluation.extractors import Evaluator
from mmm_core.evaluation.metrics import Interval
from mmm_core.evaluation.words import WordVectors
from mmm_core.sampling import empty_row, fill
from mmm_core.text import TextEncoder, TextStates
from mmm_core.tokens import FRAMES_PER_TOKEN, MAX_TOKENS

GENERATE_BATCH = 16
N_MODALITY_TEXTS, N_MODALITY = 100, 30
"""MModality: 30 motions for each of 100 texts."""
Motions = list[NDArray[np.float32]]
Progress = Callable[[str], None]


@dataclass(frozen=True)
class Pair:
    """A motion of a person, whole tokens long, and one of its captions."""

    features: NDArray[np.float32]
    text: str
    words: tuple[str, ...]


def read_pairs(folder: Path, splits: Sequence[Split]) -> list[Pair]:
    """Pairs of a data folder of either kind, one for each caption.

    Raises:
        TrainingDataError: no pair, or the folder cannot be read.
    """
    found: list[tuple[NDArray[np.float32], str, tuple[str, ...]]] = []
    if (folder / "clips.jsonl").is_file():
        for split in splits:
            found += [(f, caption, ()) for f, captions in read_clips(folder, split) for caption in captions]
    else:
        opened = open_folder(folder)
        for split in splits:
            found += [(e.features, c.text, c.tokens) for e in opened.examples(split) for c in e.captions]
    pairs = [Pair(f[: min(len(f) // FRAMES_PER_TOKEN, MAX_TOKENS) * FRAMES_PER_TOKEN], t, w) for f, t, w in found]
    if not pairs:
        raise TrainingDataError(folder, ", ".join(splits), "no pair of motion and caption", "a folder with this split")
    return pairs


class Reader:
    """An evaluator with the words it reads: MiniLM's states (ours) or GloVe vectors (the published one)."""

    def __init__(self, evaluator: Evaluator, words: TextEncoder | WordVectors) -> None:
        self.evaluator, self.words = evaluator, words

    @torch.inference_mode()
    def motions(self, motions: Sequence[NDArray[np.float32]]) -> NDArray[np.float32]:
        """(N, D) vectors of motions."""
        parts = [
            self.evaluator.motions([torch.from_numpy(m) for m in motions[i : i + 64]])
            for i in range(0, len(motions), 64)
        ]
        return torch.cat(parts).numpy()

    @torch.inference_mode()
    def texts(self, pairs: Sequence[Pair]) -> NDArray[np.float32]:
        """(N, D) vectors of the pairs' captions."""
        parts = []
        for i in range(0, len(pairs), 64):
            some = pairs[i : i + 64]
            if isinstance(self.words, WordVectors):
                vectors, kinds, lengths = self.words.read([p.words for p in some])
                parts.append(self.evaluator.texts(vectors, kinds, lengths))
            else:
                states = self.words.encode([p.text for p in some])
                parts.append(self.evaluator.texts(states.words, None, states.word_mask.sum(1)))
        return torch.cat(parts).numpy()


def generate(engine: Engine, pairs: Sequence[Pair], seed: int) -> Motions:
    """A motion for each caption, as long as the real one."""
    made: Motions = []
    model = engine.model
    for i in range(0, len(pairs), GENERATE_BATCH):
        some = pairs[i : i + GENERATE_BATCH]
        states = TextStates.stacked([s for s, _ in engine.understand_all([p.text for p in some])])
        rows = [empty_row(model.transformer, len(p.features) // FRAMES_PER_TOKEN) for p in some]
        seeds = [(seed * 1_000_003 + i + k) % 2**31 for k in range(len(some))]
        made += decode(engine, fill(model.transformer, states, rows, seeds, engine.settings))
    return made


@torch.inference_mode()
def decode(engine: Engine, rows: Sequence[torch.Tensor]) -> Motions:
    """Features of rows of ids, each decoded by itself."""
    return [engine.model.tokenizer.decode(ids[None])[0].numpy() for ids in rows]


@torch.inference_mode()
def reconstruct(engine: Engine, pairs: Sequence[Pair]) -> Motions:
    """The real motions through the tokenizer."""
    tokenizer = engine.model.tokenizer
    return decode(engine, [tokenizer.encode(torch.from_numpy(p.features)[None])[0] for p in pairs])


Row = dict[str, Interval]
"""A line of a table: R-precision top 1, 2, 3, FID, MM-Dist, Diversity, and MModality where it was measured."""


def measure(
    reader: Reader,
    pairs: Sequence[Pair],
    make: Callable[[int], Motions],
    repeats: int,
    progress: Progress = lambda _: None,
) -> Row:
    """Metrics of what `make(seed)` gives for each repeat, against the real motions."""
    texts, real = reader.texts(pairs), reader.motions([p.features for p in pairs])
    values: dict[str, list[float]] = {}
    for repeat in range(repeats):
        generator = np.random.default_rng(repeat)
        motions = reader.motions(make(repeat))
        found = {
            "FID": metrics.frechet_distance(motions, real),
            "MM-Dist": metrics.mm_dist(texts, motions),
            "Diversity": metrics.diversity(motions, generator),
        }
        if len(pairs) >= metrics.POOL:
            shares = metrics.r_precision(texts, motions, generator)
            found |= {f"R{top}": share for top, share in shares.items()}
        for key, value in found.items():
            values.setdefault(key, []).append(value)
        progress(f"{repeat + 1}/{repeats}")
    return {key: Interval.of(v) for key, v in sorted(values.items())}


def measure_modality(
    reader: Reader, engine: Engine, pairs: Sequence[Pair], repeats: int, each: int = N_MODALITY
) -> Interval:
    """MModality: how far motions for the same text lie from each other."""
    chosen = list({p.text: p for p in pairs}.values())[:N_MODALITY_TEXTS]
    vectors = np.stack([reader.motions(generate(engine, chosen, 10_000 + k)) for k in range(each)], 1)
    return Interval.of([metrics.multimodality(vectors, np.random.default_rng(r)) for r in range(repeats)])


def seconds_per_sentence(engine: Engine, pairs: Sequence[Pair], n: int = 20) -> float:
    """AITS: mean seconds from a text to its motion's features, one at a time, warm."""
    several = [pairs[i % len(pairs)] for i in range(n)]
    generate(engine, several[:1], 0)
    start = time.perf_counter()
    for k, pair in enumerate(several):
        generate(engine, [pair], k)
    return (time.perf_counter() - start) / n
