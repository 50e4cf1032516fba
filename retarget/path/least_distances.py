"""Lower bounds of the distances of all pairs of shapes, transferred from poses to nearby poses.

Between two poses no distance changes by more than what the joints sweep, so a pair that is far apart in one pose need not be
measured in the next ones.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True)
class LeastDistances:
    """Lower bounds of the distances of P pairs in T frames.

    Attributes:
        q_rad: (T, J) poses.
        least_m: (T, P) lower bound of each pair's distance.
        sweep_m: (P, J) largest relative movement of the shapes of each pair, metres per radian of each joint.
    """

    q_rad: Array
    least_m: Array
    sweep_m: Array

    def at(self, q_rad: Array, first: int = 0) -> Array:
        """(N, P) lower bounds in other poses (N, J), each near the frame of its index from `first` on, or near the last."""
        of = np.minimum(np.maximum(np.arange(first, first + len(q_rad)), 0), len(self.q_rad) - 1)
        return self.least_m[of] - np.abs(q_rad - self.q_rad[of]) @ self.sweep_m.T

    def part(self, frames: slice | Indices) -> LeastDistances:
        """The bounds of some of the frames."""
        return LeastDistances(self.q_rad[frames], self.least_m[frames], self.sweep_m)
