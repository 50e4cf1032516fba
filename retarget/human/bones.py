"""Directions of the bones of arms, and their derivatives by the joints."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Bones:
    """Directions of both bones in poses (G, M), and their derivatives.

    Attributes:
        upper: (G, M, 3) unit directions of upper arms.
        fore: (G, M, 3) unit directions of forearms.
        slope: (G, M, n, 6) derivatives of both directions by each joint, per radian; in memory as of `poses_last`.
    """

    upper: Array
    fore: Array
    slope: Array

    def hessian(self, weights: Array | None = None) -> Array:
        """(G, M, n, n) Gauss-Newton Hessian of half the squared error of both directions, with `weights` (G, M, 2, 2)."""
        slope = self.slope if weights is None else weighted(self.slope, poses_last(weights)[:, :, None])
        return np.einsum("gmia,gmja->gmij", slope, self.slope)

    def towards(self, upper: Array, fore: Array, weights: Array | None = None) -> Array:
        """(G, M, n) negative gradient, by the joints, of half the squared error against directions (G, M, 3)."""
        error = np.concatenate([upper - self.upper, fore - self.fore], -1)
        if weights is not None:
            error = weighted(error, weights)
        return np.einsum("gmia,gma->gmi", self.slope, error)


def weighted(errors: Array, weights: Array) -> Array:
    """(..., 6) errors of both directions, multiplied by symmetric weights (..., 2, 2) of the bones."""
    apart = errors.reshape(*errors.shape[:-1], 2, 3)
    own, across = np.diagonal(weights, axis1=-2, axis2=-1)[..., None], weights[..., :1, 1:]
    return (own * apart + across * apart[..., ::-1, :]).reshape(errors.shape)


def poses_last(values: Array) -> Array:
    """(G, M, ...) values with the M poses along the last axis in memory: NumPy is slow on many rows of three numbers."""
    n = values.ndim
    return np.ascontiguousarray(values.transpose(0, *range(2, n), 1)).transpose(0, n - 1, *range(1, n - 1))
