"""Distances between capsules, many at once.

A capsule is a segment (centre, unit axis, half length) with a radius; a sphere has half length 0.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_PARALLEL = 1e-12


def nearest_along(offset: Array, axis1: Array, axis2: Array, half1: Array, half2: Array) -> tuple[Array, Array, Array]:
    """Squared distance of segments and where on each it is, from the centre along the axis (Ericson 2005, sec. 5.1.9).

    Args:
        offset: (..., 3) centre of the first less centre of the second.
        axis1: (..., 3) unit axes.
        axis2: (..., 3) unit axes.
        half1: (...) half lengths.
        half2: (...) half lengths.
    """
    b = np.einsum("...i,...i", axis1, axis2)
    d1, d2 = np.einsum("...i,...i", axis1, offset), np.einsum("...i,...i", axis2, offset)
    s = (b * d2 - d1) / np.maximum(1 - b * b, _PARALLEL)
    s = np.minimum(np.maximum(s, -half1), half1)
    t = np.minimum(np.maximum(d2 + s * b, -half2), half2)
    s = np.minimum(np.maximum(t * b - d1, -half1), half1)
    squared = np.einsum("...i,...i", offset, offset) + s * (s + 2 * (d1 - t * b)) + t * (t - 2 * d2)
    return np.maximum(squared, 0.0), s, t
