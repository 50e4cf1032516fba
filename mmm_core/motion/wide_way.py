"""Makes a large gesture larger by its way: the arms swing out wide before they do what they did.

A hand that touches the head, or an arm that is stretched already, cannot go farther where it ends. People who are asked for a
huge gesture of that kind swing the arm out on the way to it.
"""

from __future__ import annotations

import numpy as np

from mmm_core.motion.skeleton import REST_DIRECTIONS, Array, forward_kinematics, normalise, rotation_about

_CHEST = 9
_ARMS = ((16, 18, 20, 1.0), (17, 19, 21, -1.0))
"""Bone of the shoulder, upper arm and forearm of each arm, and the sign of its outward direction."""
_WIDE = ((0.85, 0.15, 0.4), (0.8, 0.5, 0.35), (0.6, 0.8, 0.25), (0.3, 0.95, 0.1))
"""Directions (outward, up, forward) of an arm that swings out, lowest first, in the frame of the chest."""
_WIDE_TOGETHER = ((-0.33, 0.2, 0.92), (-0.33, 0.6, 0.73), (-0.33, 0.9, 0.3))
"""Directions of two arms that carry one thing, lowest first, as in `_WIDE`."""
_SHARES = (0.6, 0.8, 1.0)
"""Shares of the turn to a wide direction that are tried in turn."""
_ACTS, _MOVES_M = 0.6, 0.25
"""An arm acts if its hand goes this share of the farther hand's distance, and this many metres."""
_BEGUN, _THERE = 0.1, 0.9
"""Shares of its distance between which a hand is on its way."""
_TOGETHER_M = 0.25
"""Hands that are nearer to each other than this for most of their way carry one thing."""
_SHORTEST_FRAMES = 2
"""Frames of the shortest way that is widened."""
_LEAST_GAIN = 1.05
"""Factor by which the hands must come farther than before for the wide way to be taken."""


def way_of(local: Array) -> tuple[int, int] | None:
    """First and last frame of the hands' way to their gesture in (T, 22, 3, 3) rotations; None where they have none to widen."""
    hands = _hands(local)
    away = np.linalg.norm(hands - hands[0], axis=-1)
    far = away.max(0)
    acting = _acting(far)
    if not acting:
        return None
    there = max(int(np.argmax(away[:, i] >= _THERE * far[i])) for i in acting)
    begun = min(int(np.flatnonzero(away[: there + 1, i] <= _BEGUN * far[i])[-1]) for i in acting)
    return None if there - begun < _SHORTEST_FRAMES else (begun, there)


def reach_m(local: Array) -> float:
    """Greatest distance of a hand from its first place, metres, in (T, 22, 3, 3) rotations."""
    return float(_away(local).max())


def with_wide_way(local: Array, way: tuple[int, int], wanted_m: float) -> Array:
    """Rotations (T, 22, 3, 3) whose hands go as far as wanted on their way, or as far as they can.

    Args:
        local: (T, 22, 3, 3) rotations, each relative to its parent.
        way: first and last frame of the way.
        wanted_m: greatest distance of the hands from their first place, metres.
    """
    hands = _hands(local)
    away = np.linalg.norm(hands - hands[0], axis=-1)
    acting = _acting(away.max(0))
    if not acting or way[1] - way[0] < _SHORTEST_FRAMES:
        return local
    apart = np.linalg.norm(hands[way[0] : way[1] + 1, 0] - hands[way[0] : way[1] + 1, 1], axis=-1)
    together = len(acting) == 2 and float(np.median(apart)) < _TOGETHER_M
    best, farthest = local, _LEAST_GAIN * float(away.max())
    swing = _swing(len(local), *way)
    for direction in _WIDE_TOGETHER if together else _WIDE:
        for share in _SHARES:
            tried = _swung(local, acting, np.array(direction), share * swing)
            reached = float(_away(tried)[:, acting].max(0).min())
            if reached > farthest:
                best, farthest = tried, reached
            if reached >= wanted_m:
                return tried
    return best


def _hands(local: Array) -> Array:
    """(T, 2, 3) wrists from the chest's joint, in the frame of the chest."""
    joints, world = forward_kinematics(local, np.zeros((len(local), 3)))
    return np.asarray(np.einsum("tba,tjb->tja", world[:, _CHEST], joints[:, [20, 21]] - joints[:, [_CHEST]]))


def _away(local: Array) -> Array:
    """(T, 2) distance of each hand from its first place, metres."""
    hands = _hands(local)
    return np.asarray(np.linalg.norm(hands - hands[0], axis=-1))


def _acting(farthest_m: Array) -> list[int]:
    """The arms, 0 for the left one, that go far."""
    return [i for i in (0, 1) if farthest_m[i] > max(_MOVES_M, _ACTS * farthest_m.max())]


def _swing(n_frames: int, first: int, last: int) -> Array:
    """(T,) weights that rise from 0 to 1 and fall to 0 again while the hands are on their way."""
    share = (np.arange(n_frames) - first) / (last - first)
    return np.where((share > 0) & (share < 1), np.sin(np.pi * share) ** 2, 0.0)


def _swung(local: Array, arms: list[int], direction: Array, weights: Array) -> Array:
    """Rotations (T, 22, 3, 3) with arms turned towards a direction (outward, up, forward), by weights (T,)."""
    _, world = forward_kinematics(local, np.zeros((len(local), 3)))
    out = local.copy()
    for i in arms:
        shoulder, upper, fore, sign = _ARMS[i]
        wide = np.einsum("tij,j->ti", world[:, _CHEST], normalise(direction * [sign, 1, 1]))
        turned = world[:, shoulder]
        for joint in (upper, fore):
            bone = np.einsum("tij,j->ti", world[:, joint], REST_DIRECTIONS[joint])
            before, turned = turned, _part_way(bone, wide, weights) @ world[:, joint]
            out[:, joint] = np.swapaxes(before, -1, -2) @ turned
    return out


def _part_way(a: Array, b: Array, share: Array) -> Array:
    """(T, 3, 3) rotations that turn unit vectors a (T, 3) towards b (T, 3) by a share (T,) of the angle between them."""
    across = np.cross(a, b)
    angle = np.arctan2(np.linalg.norm(across, axis=-1), (a * b).sum(-1))
    return rotation_about(normalise(across), share * angle)
