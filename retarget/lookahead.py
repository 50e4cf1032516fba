"""Following a reference within position, velocity and acceleration bounds, knowing all of it beforehand.

The least squares path under box bounds on positions, first and second differences, by the alternating direction method
of multipliers (Boyd et al. 2011, sec. 5.2): bounds are the same for all frames, so one small matrix serves all joints
and iterations. The result is near the optimum but may break a bound by a little: `limits.limit_path` makes it exact.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_RHO = 1.0
"""Weight of the bounds' splitting, chosen by the error left after `_ITERATIONS` on recorded motions."""
_RELAXATION = 1.7
_ITERATIONS = 30
_TIGHTENED = 0.99
"""Share of the bounds used, so that what the iterations leave undone stays inside the true ones."""
_FRAMES_STEP = 8
"""Lengths are padded to a multiple of this, so that few matrices are ever made."""


def track(
    reference_rad: Array,
    position_rad: Array,
    velocity_rad_s: Array,
    low_rad: Array,
    high_rad: Array,
    speed_rad_s: Array,
    acceleration_rad_s2: Array,
    period_s: float,
) -> Array:
    """(T, J) path nearest to `reference_rad` (T, J) under the bounds, nearly; the start state (J,) is fixed.

    Joints whose reference keeps every bound already are returned unchanged.
    """
    T = len(reference_rad)
    n = -(-T // _FRAMES_STEP) * _FRAMES_STEP
    step, bend = speed_rad_s * period_s, acceleration_rad_s2 * period_s**2
    before = position_rad - velocity_rad_s * period_s
    whole = np.concatenate([before[None], position_rad[None], reference_rad])
    first, second = np.diff(whole[1:], axis=0), np.diff(whole, n=2, axis=0)
    slack = 1e-9
    outside = (np.abs(first) > step + slack).any(0) | (np.abs(second) > bend + slack).any(0)
    outside |= ((reference_rad < low_rad - slack) | (reference_rad > high_rad + slack)).any(0)
    if not outside.any():
        return reference_rad
    j = np.flatnonzero(outside)
    reference = np.concatenate([reference_rad[:, j], np.repeat(reference_rad[-1:, j], n - T, 0)])
    start, last = position_rad[j], before[j]
    inverse = _inverse(n)
    step, bend, low, high = _TIGHTENED * step[j], _TIGHTENED * bend[j], low_rad[j], high_rad[j]
    # Differences as they are for x = 0: what the start state adds to their first rows.
    offset1, offset2 = np.zeros_like(reference), np.zeros_like(reference)
    offset1[0], offset2[0], offset2[1] = -start, -2 * start + last, start
    x = reference
    z0, z1, z2 = (
        np.clip(x, low, high),
        np.clip(_difference(x) + offset1, -step, step),
        np.clip(_bend(x) + offset2, -bend, bend),
    )
    u0, u1, u2 = np.zeros_like(x), np.zeros_like(x), np.zeros_like(x)
    for _ in range(_ITERATIONS):
        pull = (z0 - u0) + _difference_t(z1 - u1 - offset1) + _bend_t(z2 - u2 - offset2)
        x = inverse @ (reference + _RHO * pull)
        _split(x, z0, u0, low, high)
        _split(_difference(x) + offset1, z1, u1, -step, step)
        _split(_bend(x) + offset2, z2, u2, -bend, bend)
    result = reference_rad.copy()
    result[:, j] = x[:T]
    return result


@lru_cache(maxsize=64)
def _inverse(n: int) -> Array:
    """(n, n) inverse of I + rho (I + D1' D1 + D2' D2)."""
    eye = np.eye(n)
    first, second = _difference(eye), _bend(eye)
    return np.asarray(np.linalg.inv(eye + _RHO * (eye + first.T @ first + second.T @ second)), np.float64)


def _split(y: Array, z: Array, u: Array, low: Array, high: Array) -> None:
    """Update the bounded copy `z` of `y` and its multiplier `u` in place."""
    u += _RELAXATION * y + (1 - _RELAXATION) * z
    np.clip(u, low, high, out=z)
    u -= z


def _difference(x: Array) -> Array:
    """First differences with x[-1] = 0."""
    y = x.copy()
    y[1:] -= x[:-1]
    return y


def _difference_t(y: Array) -> Array:
    x = y.copy()
    x[:-1] -= y[1:]
    return x


def _bend(x: Array) -> Array:
    """Second differences with x[-1] = x[-2] = 0."""
    return _difference(_difference(x))


def _bend_t(y: Array) -> Array:
    return _difference_t(_difference_t(y))
