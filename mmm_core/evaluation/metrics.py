"""The metrics of text-to-motion, on features of an evaluator. NumPy and SciPy's matrix square root.

Guo et al. 2022 (CVPR) sec. 6 and MMM (arXiv 2312.03596) sec. 5: all of them compare vectors (N, D) that the evaluator's
extractors give for texts and motions.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating]
POOL = 32
TOP = (1, 2, 3)
N_PAIRS = 300
REPEATS = 20


@dataclass(frozen=True)
class Interval:
    """Mean of repeated measurements and half the width of its 95 % interval."""

    mean: float
    half_width: float

    @classmethod
    def of(cls, values: Sequence[float]) -> Interval:
        """1.96 sigma / sqrt(n), as in the literature; sigma is the deviation of the values themselves."""
        array = np.asarray(values, np.float64)
        return cls(float(array.mean()), float(1.96 * array.std() / np.sqrt(len(array))))

    def __str__(self) -> str:
        """0.512±.003."""
        return f"{self.mean:.3f}±{self.half_width:.3f}"


def distances(a: Array, b: Array) -> Array:
    """(N, M) Euclidean distances of (N, D) and (M, D)."""
    a, b = np.asarray(a, np.float64), np.asarray(b, np.float64)
    square = np.square(a).sum(1)[:, None] + np.square(b).sum(1)[None] - 2 * a @ b.T
    return np.sqrt(np.maximum(square, 0.0))


def r_precision(texts: Array, motions: Array, generator: np.random.Generator, pool: int = POOL) -> dict[int, float]:
    """Share of texts whose own motion is among the 1, 2, 3 nearest of a pool; pools are drawn without rest.

    Raises:
        ValueError: fewer pairs than a pool.
    """
    n = len(texts)
    if n < pool:
        raise ValueError(f"{n} pairs are fewer than one pool of {pool}")
    order = generator.permutation(n)[: n // pool * pool].reshape(-1, pool)
    hits = dict.fromkeys(TOP, 0)
    for rows in order:
        gap = distances(texts[rows], motions[rows])
        own = np.diag(gap)[:, None]
        rank = (gap < own).sum(1)  # how many are nearer than one's own
        for top in TOP:
            hits[top] += int((rank < top).sum())
    return {top: hits[top] / order.size for top in TOP}


def mm_dist(texts: Array, motions: Array) -> float:
    """Mean distance of each text to its own motion."""
    return float(np.linalg.norm(np.asarray(texts, np.float64) - np.asarray(motions, np.float64), axis=1).mean())


def frechet_distance(a: Array, b: Array) -> float:
    """Distance of two Gaussians fitted to (N, D) and (M, D): |mu - mu'|^2 + tr(S + S' - 2 sqrt(S S')).

    Heusel et al. 2017 (arXiv 1706.08500) eq. 6. The root's trace is the sum of the roots of the eigenvalues of S S',
    which are real and not negative.
    """
    a, b = np.asarray(a, np.float64), np.asarray(b, np.float64)
    mean = np.square(a.mean(0) - b.mean(0)).sum()
    cov_a, cov_b = np.cov(a, rowvar=False), np.cov(b, rowvar=False)
    values, vectors = np.linalg.eigh(np.atleast_2d(cov_a))
    root = vectors * np.sqrt(np.maximum(values, 0)) @ vectors.T
    inner = np.linalg.eigvalsh(root @ np.atleast_2d(cov_b) @ root)
    trace = np.trace(np.atleast_2d(cov_a)) + np.trace(np.atleast_2d(cov_b)) - 2 * np.sqrt(np.maximum(inner, 0)).sum()
    return float(max(0.0, mean + trace))


def diversity(motions: Array, generator: np.random.Generator, n_pairs: int = N_PAIRS) -> float:
    """Mean distance of random pairs: 300 of them, 100 where there are not more motions than 300; fewer if need be."""
    n = len(motions)
    pairs = n_pairs if n > n_pairs else min(100, n)
    first, second = (generator.choice(n, pairs, replace=False) for _ in range(2))
    return float(np.linalg.norm(np.asarray(motions)[first] - np.asarray(motions)[second], axis=1).mean())


def multimodality(motions: Array, generator: np.random.Generator, n_pairs: int = 10) -> float:
    """Mean distance of random pairs of motions for the same text: (texts, generations, D)."""
    n = motions.shape[1]
    pairs = min(n_pairs, n)
    first, second = (generator.choice(n, pairs, replace=False) for _ in range(2))
    return float(np.linalg.norm(motions[:, first] - motions[:, second], axis=2).mean())
