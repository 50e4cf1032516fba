"""Quadratic programs on a banded matrix, by a primal-dual interior-point method.

Mehrotra's predictor and corrector (Nocedal, Wright 2006, algorithm 16.4). Every step solves one system with the matrix
M + A' D A, which is banded as long as the rows of A couple near unknowns only.
"""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

_lapack: Any = importlib.import_module("scipy.linalg.lapack")  # has no types
_sparse: Any = importlib.import_module("scipy.sparse")
Array = NDArray[np.float64]
_MOST_STEPS = 40
_GAP, _RESIDUAL = 1e-7, 1e-7
"""Mean complementarity, and residuals, below which a solution counts as found."""
_START = 1e-2
"""Initial value of slacks and multipliers at least."""
_TO_BORDER = 0.995
"""Share of the distance to the nearest bound that a step covers."""


@dataclass(frozen=True)
class Program:
    """The minimum of x' M x / 2 + g' x over x (N,) with A x <= b + soft z, where z is the multiplier of a row.

    Attributes:
        matrix: (N, N) sparse M, positive semidefinite.
        gradient: (N,) g.
        rows: (R, N) sparse A.
        upper: (R,) b.
        soft: (R,) 0 makes a row hard; else 1 / soft is the weight of half its squared violation.
    """

    matrix: Any
    gradient: Array
    rows: Any
    upper: Array
    soft: Array


@dataclass(frozen=True)
class _Step:
    """The point at which a step begins: slacks, multipliers, residuals, weights of the rows, and the factorised matrix."""

    s: Array
    z: Array
    dual: Array
    primal: Array
    weight: Array
    factor: Array


def least(program: Program, width: int) -> Array:
    """(N,) solution of a program whose matrix has no element further than `width` - 1 below the diagonal.

    Raises:
        FloatingPointError: the matrix is not positive definite.
    """
    matrix, gradient, A, b, soft = program.matrix, program.gradient, program.rows, program.upper, program.soft
    At = A.T.tocsr()
    x: Array = np.zeros(len(gradient))
    s: Array = np.maximum(b, _START)
    z: Array = np.full(len(b), _START)
    scale = 1 + np.abs(gradient).max()

    def change(aim: Array, of: _Step) -> tuple[Array, Array, Array]:
        """Changes of x, s, z that bring s z to `aim` and the residuals to 0, to first order."""
        left: Array = of.primal - of.s + aim / of.z
        dx: Array = _lapack.dpbtrs(of.factor, -(of.dual + At @ (of.weight * left)), lower=1)[0]
        dz: Array = of.weight * (A @ dx + left)
        return dx, (aim - of.s * dz) / of.z - of.s, dz

    for _ in range(_MOST_STEPS):
        dual: Array = matrix @ x + gradient + At @ z
        primal: Array = A @ x + s - b - soft * z
        gap = float(s @ z) / len(b)
        if gap < _GAP and np.abs(primal).max() < _RESIDUAL and np.abs(dual).max() < _RESIDUAL * scale:
            break
        D: Array = 1 / (s / z + soft)
        now = _Step(s, z, dual, primal, D, _factorised(matrix + At @ _sparse.diags(D) @ A, width))
        _, ds, dz = change(np.zeros(len(b)), now)
        length = min(_longest(s, ds), _longest(z, dz))
        centring = (float((s + length * ds) @ (z + length * dz)) / len(b) / gap) ** 3
        dx, ds, dz = change(centring * gap - ds * dz, now)
        length = _TO_BORDER * min(_longest(s, ds), _longest(z, dz))
        x, s, z = x + length * dx, s + length * ds, z + length * dz
    return x


def _factorised(matrix: Any, width: int) -> Array:
    entries = matrix.tocoo()
    band = np.zeros((width, matrix.shape[0]))
    lower = entries.row >= entries.col
    np.add.at(band, (entries.row[lower] - entries.col[lower], entries.col[lower]), entries.data[lower])
    factor, info = _lapack.dpbtrf(band, lower=1)
    if info:
        raise FloatingPointError(f"banded Cholesky: not positive definite at row {info}")
    return np.asarray(factor, np.float64)


def _longest(v: Array, change: Array) -> float:
    """The largest share, 1 at most, of a change that leaves every element of `v` positive."""
    falls = change < 0
    return float(min(1.0, (v[falls] / -change[falls]).min(initial=np.inf)))
