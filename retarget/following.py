"""Paths near a wish that keep every limit, with all that is known of the future in view.

What already keeps the limits is left alone, bit for bit. For the rest `lookahead` finds the best path inside them; where
a start breaks a limit, so that there is none, exact causal steps (`limits.limit_step`) lead back first.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from retarget.limits import JointLimits, limit_step
from retarget.lookahead import Bounds, Wish, nearest_path

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
_WINDOW_FRAMES, _AHEAD_FRAMES = 36, 10
"""A long reference is solved in windows, each with so many frames after it in view."""
_TAIL_WEIGHT = 1e-3
"""Weight of the frames after the last known one, in which the joints come to rest."""
_PULL = 1e-3


@dataclass(frozen=True)
class Importance:
    """What matters of a group of joints along a reference: its error e counts e' H e / 2 - b' e in each frame.

    Attributes:
        joints: (G, w) indices of the joints of G groups.
        hessian: (G, T, w, w).
        linear: (G, T, w), b.
    """

    joints: Indices
    hessian: Array
    linear: Array


def each_by_itself(T: int, joints: Sequence[int]) -> Importance:
    """Joints that all matter alike."""
    rows = np.array(joints, np.int64)[:, None]
    return Importance(rows, np.ones((len(rows), T, 1, 1)), np.zeros((len(rows), T, 1)))


def limit_path(
    reference_rad: Array,
    position_rad: Array,
    velocity_rad_s: Array,
    limits: JointLimits,
    period_s: float,
    importance: Callable[[], Sequence[Importance]] | None = None,
) -> Array:
    """(T, J) path near `reference_rad` (T, J) that keeps every limit, from the given position and velocity.

    `importance` is asked, only when a limit is passed, what matters for groups that hold every joint once; None: all alike.
    """
    T, J = reference_rad.shape
    path = np.clip(reference_rad, limits.position_min_rad, limits.position_max_rad)
    kept = _kept(path, position_rad, velocity_rad_s, limits, period_s)
    if kept.all():
        return path
    groups = (each_by_itself(T, range(J)),) if importance is None else importance()
    position, velocity = position_rad, velocity_rad_s
    for k in range(0, T, _WINDOW_FRAMES):
        n = min(_WINDOW_FRAMES, T - k)
        frames = slice(k, min(T, k + n + _AHEAD_FRAMES))
        if k or frames.stop < T:
            kept = _kept(path[frames], position, velocity, limits, period_s)
        if not kept.all():
            for group in groups:
                _solve(group, frames, reference_rad, ~kept, path, position, velocity, limits, period_s)
            part = path[k : k + n]
            np.clip(part, limits.position_min_rad, limits.position_max_rad, out=part)
            part[:] = _follow(part, position, velocity, limits, period_s)
        before = path[k + n - 2] if n > 1 else position
        position, velocity = path[k + n - 1].copy(), (path[k + n - 1] - before) / period_s
        if k + n < T:  # what was planned beyond this window is planned anew from where it ends
            path[k + n : frames.stop] = np.clip(
                reference_rad[k + n : frames.stop], limits.position_min_rad, limits.position_max_rad
            )
    return path


def _solve(
    group: Importance,
    frames: slice,
    reference: Array,
    changes: NDArray[np.bool_],
    path: Array,
    position: Array,
    velocity: Array,
    limits: JointLimits,
    period_s: float,
) -> None:
    """Write the best path of the groups of which a joint `changes` into `path`, over `frames`."""
    some = np.flatnonzero(changes[group.joints].any(1))
    if not len(some):
        return
    joints = group.joints[some]
    bounds = Bounds(
        limits.position_min_rad[joints], limits.position_max_rad[joints],
        (limits.velocity_rad_s * period_s)[joints], (limits.acceleration_rad_s2 * period_s**2)[joints],
    )  # fmt: skip
    tail = int(np.ceil((bounds.step / bounds.bend).max())) + 1
    first = reference[frames][:, joints].transpose(1, 0, 2)
    hessian, linear = group.hessian[some, frames], group.linear[some, frames]
    linear = linear + (hessian @ first[..., None])[..., 0]
    first, hessian, linear = (np.concatenate([a, np.repeat(a[:, -1:], tail, 1)], 1) for a in (first, hessian, linear))
    hessian[:, -tail:] *= _TAIL_WEIGHT
    linear[:, -tail:] *= _TAIL_WEIGHT
    found = nearest_path(
        Wish(hessian, linear, _PULL), first, position[joints], (velocity * period_s)[joints], bounds, ~changes[joints]
    )
    if found is not None:
        length = frames.stop - frames.start
        path[frames, joints.ravel()] = found[:, :length].transpose(1, 0, 2).reshape(length, -1)


def _kept(path: Array, position: Array, velocity: Array, limits: JointLimits, period_s: float) -> NDArray[np.bool_]:
    """(J,) whether each joint may follow `path` (T, J) from a state as it is."""
    before = np.concatenate([position[None], path])
    speed = (path - before[:-1]) / period_s
    came, ahead = np.concatenate([velocity[None], speed[:-1]]), np.concatenate([speed[1:], speed[-1:]])
    steps = limit_step(path, before[:-1], came, limits, period_s, ahead)
    return np.asarray((steps == path).all(0), bool)


def _follow(reference: Array, position: Array, velocity: Array, limits: JointLimits, period_s: float) -> Array:
    """Causal following of `reference`, each step knowing the velocity of the reference after it."""
    if _kept(reference, position, velocity, limits, period_s).all():
        return reference
    ahead = np.diff(reference, axis=0, append=2 * reference[-1:] - reference[-2:-1]) / period_s
    path = np.empty_like(reference)
    for k in range(len(reference)):
        following = limit_step(reference[k], position, velocity, limits, period_s, ahead[k])
        velocity = (following - position) / period_s
        path[k] = position = following
    return path
