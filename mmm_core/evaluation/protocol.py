"""The evaluation protocol: measures real, reconstructed and generated motions against their texts, several times.

MMM (arXiv 2312.03596) sec. 5 after Guo et al. 2022: in each repeat every motion of the split takes part once, with one of its
captions at random; generated motions have the lengths of the real ones; pools of 32 are drawn from all motions; the repeats, with
different seeds, give a 95 % interval. Fewer than 32 motions give no R-precision; with fewer vectors than dimensions the
covariances are singular and FID says little. Therefore `n` stands beside every figure.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

import numpy as np
import torch
from numpy.typing import NDArray

from mmm_core.evaluation import metrics
from mmm_core.evaluation.metrics import Interval
from mmm_core.evaluation.pairs import Pair
from mmm_core.evaluation.reader import Motions, Reader
from mmm_core.generate.engine import Engine
from mmm_core.model.sampling import empty_row
from mmm_core.model.text import TextStates
from mmm_core.model.tokenizer import Tokenizer
from mmm_core.model.tokens import FRAMES_PER_TOKEN
from mmm_core.model.vqvae import VqVae

GENERATE_BATCH = 16
N_MODALITY_TEXTS, N_MODALITY = 100, 30
"""Texts, and motions of each, for MModality (Guo et al.; the released MMM code makes 11 motions for every text)."""
Progress = Callable[[str], None]
Make = Callable[[Sequence[Pair], int], Motions]
"""(pairs, seed) -> a motion for each pair."""
Row = dict[str, Interval]
"""A line of a table: R1, R2, R3, FID, MM-Dist, Diversity, and MModality where it was measured."""


def text_states(engine: Engine, pairs: Sequence[Pair]) -> TextStates:
    """Encoder states of the pairs' captions, of which none is refused or shortened."""
    return engine.read([p.text for p in pairs])


def seeds_of(pairs: Sequence[Pair], first: int, seed: int) -> list[int]:
    """A seed for each of `pairs`; the first pair is number `first` of its split."""
    return [(seed * 1_000_003 + first + k) % 2**31 for k in range(len(pairs))]


@torch.inference_mode()
def generate(engine: Engine, pairs: Sequence[Pair], seed: int) -> Motions:
    """A motion for each caption, as long as the real motion, by the weights for its words."""
    made: Motions = []
    for i in range(0, len(pairs), GENERATE_BATCH):
        some = pairs[i : i + GENERATE_BATCH]
        rows = [empty_row(engine.model.transformer, len(p.features) // FRAMES_PER_TOKEN) for p in some]
        states, seeds = text_states(engine, some), seeds_of(some, i, seed)
        made += engine.filled_features([p.text for p in some], states, rows, seeds)
    return made


@torch.inference_mode()
def decode(engine: Engine, rows: Sequence[torch.Tensor]) -> Motions:
    """Features of rows of ids, each decoded by itself, because padding would change a motion's end."""
    return [engine.model.tokenizer.decode(ids[None])[0].numpy() for ids in rows]


@torch.inference_mode()
def reconstruct(tokenizer: Tokenizer | VqVae, pairs: Sequence[Pair]) -> Motions:
    """The real motions, encoded and decoded."""
    motions = (torch.from_numpy(p.features)[None] for p in pairs)
    return [tokenizer.decode(tokenizer.encode(motion))[0].numpy() for motion in motions]


def one_caption_each(pairs: Sequence[Pair], generator: np.random.Generator) -> list[int]:
    """Rows of `pairs`: for each motion, the row of one of its captions at random."""
    rows_of: dict[int, list[int]] = {}
    for row, pair in enumerate(pairs):
        rows_of.setdefault(pair.motion, []).append(row)
    return [int(generator.choice(rows)) for rows in rows_of.values()]


def measure(
    reader: Reader, pairs: Sequence[Pair], make: Make, repeats: int, progress: Progress = lambda _: None
) -> Row:
    """Metrics of the motions that `make` returns in each repeat, against the real motions."""

    def vectors(rows: list[int], seed: int) -> NDArray[np.float32]:
        return reader.motions(make([pairs[row] for row in rows], seed))

    return _measure(reader, pairs, vectors, repeats, progress)


def measure_same(reader: Reader, pairs: Sequence[Pair], make: Make, repeats: int) -> Row:
    """Metrics of motions that depend on no seed and no caption (real or reconstructed), which `make` computes once."""
    firsts = {pair.motion: pair for pair in reversed(pairs)}
    made = dict(zip(firsts, reader.motions(make(list(firsts.values()), 0)), strict=True))
    return _measure(
        reader, pairs, lambda rows, _seed: np.stack([made[pairs[r].motion] for r in rows]), repeats, lambda _: None
    )


def _measure(
    reader: Reader,
    pairs: Sequence[Pair],
    vectors: Callable[[list[int], int], NDArray[np.float32]],
    repeats: int,
    progress: Progress,
) -> Row:
    all_texts = reader.texts(pairs)
    real = reader.motions([p.features for p in {p.motion: p for p in pairs}.values()])
    values: dict[str, list[float]] = {}
    for repeat in range(repeats):
        generator = np.random.default_rng(repeat)
        rows = one_caption_each(pairs, generator)
        texts, motions = all_texts[rows], vectors(rows, repeat)
        found = {
            "FID": metrics.frechet_distance(motions, real),
            "MM-Dist": metrics.mm_dist(texts, motions),
            "Diversity": metrics.diversity(motions, generator),
        }
        if len(rows) >= metrics.POOL:
            shares = metrics.r_precision(texts, motions, generator)
            found |= {f"R{top}": share for top, share in shares.items()}
        for key, value in found.items():
            values.setdefault(key, []).append(value)
        progress(f"{repeat + 1}/{repeats}")
    return {key: Interval.of(v) for key, v in sorted(values.items())}


def fid_between_halves(reader: Reader, pairs: Sequence[Pair], repeats: int) -> Interval:
    """FID of one half of the real motions against the other: the value that a sample of this size has by chance."""
    real = reader.motions([p.features for p in {p.motion: p for p in pairs}.values()])
    values: list[float] = []
    for repeat in range(repeats):
        order = np.random.default_rng(repeat).permutation(len(real))
        values.append(metrics.frechet_distance(real[order[: len(real) // 2]], real[order[len(real) // 2 :]]))
    return Interval.of(values)


def measure_modality(
    reader: Reader, engine: Engine, pairs: Sequence[Pair], repeats: int, each: int = N_MODALITY
) -> Interval:
    """MModality: mean distance between `each` motions for the same text, for at most a hundred texts."""
    chosen = list({p.text: p for p in pairs}.values())[:N_MODALITY_TEXTS]
    vectors = np.stack([reader.motions(generate(engine, chosen, 10_000 + k)) for k in range(each)], 1)
    return Interval.of([metrics.multimodality(vectors, np.random.default_rng(r)) for r in range(repeats)])


def seconds_per_sentence(engine: Engine, pairs: Sequence[Pair], n: int = 20) -> float:
    """AITS: mean seconds from a text to its motion's features, one at a time, warm; text encoding included."""
    several = [pairs[i % len(pairs)] for i in range(n)]
    generate(engine, several[:1], 0)
    start = time.perf_counter()
    for k, pair in enumerate(several):
        generate(engine, [pair], k)
    return (time.perf_counter() - start) / n
