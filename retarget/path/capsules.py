"""Distances between capsules, many at once.

A capsule is a segment (centre, unit axis, half length) with a radius; a sphere has half length 0.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_PARALLEL = 1e-12


def nearest_along(
    squared: Array, cosine: Array, along1: Array, along2: Array, half1: Array, half2: Array
) -> tuple[Array, Array, Array]:
    """Squared distance of segments and the nearest points' offsets from the centres along the axes (Ericson 2005, sec. 5.1.9).

    Args:
        squared: (...) squared distance of the centres.
        cosine: (...) product of the unit axes.
        along1: (...) product of the first axis and the centre of the first less the centre of the second.
        along2: (...) product of the second axis and the same vector.
        half1: (...) half lengths of the first segments.
        half2: (...) half lengths of the second segments.
    """
    s = (cosine * along2 - along1) / np.maximum(1 - cosine * cosine, _PARALLEL)
    s = np.minimum(np.maximum(s, -half1), half1)
    t = np.minimum(np.maximum(along2 + s * cosine, -half2), half2)
    s = np.minimum(np.maximum(t * cosine - along1, -half1), half1)
    found = squared + s * (s + 2 * (along1 - t * cosine)) + t * (t - 2 * along2)
    return np.maximum(found, 0.0), s, t
