"""Directions of the bones of arms, and how they change with the joints."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Bones:
    """Directions of both bones in poses (G, M), and how they change.

    Attributes:
        upper: (G, M, 3) unit directions.
        fore: (G, M, 3) unit directions.
        slope: (G, M, n, 6) change of both per radian of each joint.
    """

    upper: Array
    fore: Array
    slope: Array

    def hessian(self, weights: Array | None = None) -> Array:
        """(G, M, n, n) of half the squared error of both directions, weighted by `weights` (G, M, 2, 2)."""
        slope = self.slope if weights is None else weighted(self.slope, weights[:, :, None])
        return slope @ np.swapaxes(self.slope, -1, -2)

    def towards(self, upper: Array, fore: Array, weights: Array | None = None) -> Array:
        """(G, M, n) how fast half the squared error against directions (G, M, 3) falls with each joint."""
        error = np.concatenate([upper - self.upper, fore - self.fore], -1)
        if weights is not None:
            error = weighted(error, weights)
        return (self.slope @ error[..., None])[..., 0]


def weighted(errors: Array, weights: Array) -> Array:
    """(..., 6) errors of both directions times symmetric weights (..., 2, 2) of the bones."""
    apart = errors.reshape(*errors.shape[:-1], 2, 3)
    return (weights @ apart).reshape(errors.shape)
