"""The metrics of text-to-motion, on vectors of an evaluator. NumPy only.

Guo et al. 2022 (CVPR) sec. 6 and MMM (arXiv 2312.03596) sec. 5: all metrics compare vectors (N, D) that the evaluator's
extractors give for texts and motions.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mmm_core.errors import EvaluationError

Array = NDArray[np.floating]
POOL = 32
"""Texts and motions in a pool of R-precision."""
TOP = (1, 2, 3)
"""Ranks up to which R-precision counts a hit."""
N_PAIRS = 300
"""Pairs over which diversity is averaged."""
REPEATS = 20
"""Repeats of a measurement."""


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
        return f"{self.mean:.3f}±{self.half_width:.3f}"


def distances(a: Array, b: Array) -> Array:
    """(N, M) Euclidean distances of (N, D) and (M, D)."""
    a, b = _finite(a), _finite(b)
    square = np.square(a).sum(1)[:, None] + np.square(b).sum(1)[None] - 2 * a @ b.T
    return np.sqrt(np.maximum(square, 0.0))


def r_precision(texts: Array, motions: Array, generator: np.random.Generator, pool: int = POOL) -> dict[int, float]:
    """Share of texts whose own motion is among the 1, 2, 3 nearest of a pool; an incomplete last pool is left out.

    Motions at equal distance share the ranks that they take together: a model with one motion for every text gets 1/32, 2/32
    and 3/32. By the order of a sort it could get any value from 0 to 1.

    Raises:
        EvaluationError: there are fewer pairs than in a pool, or vectors are not finite.
    """
    n = len(texts)
    if n < pool:
        raise EvaluationError(f"{n} pairs", f"at least one pool of {pool}")
    order = generator.permutation(n)[: n // pool * pool].reshape(-1, pool)
    hits = dict.fromkeys(TOP, 0.0)
    for rows in order:
        gap = distances(texts[rows], motions[rows])
        own = np.diag(gap)[:, None]
        tied = np.isclose(gap, own, rtol=1e-9, atol=1e-9)  # includes the text's own motion
        nearer = ((gap < own) & ~tied).sum(1)
        for top in TOP:
            hits[top] += float(np.clip((top - nearer) / tied.sum(1), 0.0, 1.0).sum())
    return {top: hits[top] / order.size for top in TOP}


def mm_dist(texts: Array, motions: Array) -> float:
    """Mean distance of each text to its own motion."""
    return float(np.linalg.norm(_finite(texts) - _finite(motions), axis=1).mean())


def frechet_distance(a: Array, b: Array) -> float:
    """Distance of two Gaussians fitted to (N, D) and (M, D): |mu - mu'|^2 + tr(S + S' - 2 sqrt(S S')).

    Heusel et al. 2017 (arXiv 1706.08500) eq. 6. sqrt(S S') has the eigenvalues of sqrt(sqrt(S) S' sqrt(S)), which is
    symmetric: no complex root, and no small number added to singular covariances.

    Raises:
        EvaluationError: there are fewer than two vectors on a side, or vectors are not finite.
    """
    a, b = _finite(a), _finite(b)
    if min(len(a), len(b)) < 2:
        raise EvaluationError(f"{len(a)} and {len(b)} vectors", "at least two on each side of FID")
    cov_a, cov_b = (np.atleast_2d(np.cov(x, rowvar=False)) for x in (a, b))
    values, vectors = np.linalg.eigh(cov_a)
    root = vectors * np.sqrt(np.maximum(values, 0)) @ vectors.T
    inner = np.linalg.eigvalsh(root @ cov_b @ root)
    trace = np.trace(cov_a) + np.trace(cov_b) - 2 * np.sqrt(np.maximum(inner, 0)).sum()
    return float(max(0.0, np.square(a.mean(0) - b.mean(0)).sum() + trace))


def diversity(motions: Array, generator: np.random.Generator, n_pairs: int = N_PAIRS) -> float:
    """Mean distance of `n_pairs` random pairs of motions; with at most `n_pairs` motions, of 100 pairs or one for each motion."""
    n = len(motions)
    pairs = n_pairs if n > n_pairs else min(100, n)
    first, second = (generator.choice(n, pairs, replace=False) for _ in range(2))
    return float(np.linalg.norm(_finite(motions)[first] - _finite(motions)[second], axis=1).mean())


def multimodality(motions: Array, generator: np.random.Generator, n_pairs: int = 10) -> float:
    """Mean distance of random pairs of motions for one text, from vectors (texts, generations, D)."""
    n = motions.shape[1]
    pairs = min(n_pairs, n)
    first, second = (generator.choice(n, pairs, replace=False) for _ in range(2))
    return float(np.linalg.norm(_finite(motions)[:, first] - _finite(motions)[:, second], axis=2).mean())


def _finite(vectors: Array) -> Array:
    """The vectors in double precision; raises EvaluationError for NaN, which comparisons would count as a hit."""
    array = np.asarray(vectors, np.float64)
    if not np.isfinite(array).all():
        bad = int((~np.isfinite(array)).reshape(len(array), -1).any(1).sum())
        raise EvaluationError(f"{bad} of {len(array)} vectors with NaN or infinite values", "finite motions and texts")
    return array
