"""Forward kinematics of arms: directions of upper arm and forearm from joint angles, and their derivatives.

Arms of one kind are computed together: G arms, M poses, n joints.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from retarget.human.arm_chain import ArmChain
from retarget.human.bones import Bones
from retarget.human.subproblems import unit
from retarget.robot.kinematics import skew

Array = NDArray[np.float64]
_EYE = np.eye(3)


class ArmKinematics:
    """G arms of one kind."""

    def __init__(self, chains: Sequence[ArmChain]) -> None:
        self.chains = tuple(chains)
        one = self.chains[0]
        self.n_joints = len(one.joints)
        self._n_shoulder = self.n_joints - one.has_elbow
        self._has_elbow, self._has_offsets = one.has_elbow, bool(one.beside_m.any())
        self.axes = np.stack([c.axes for c in chains])  # (G, n, 3)
        self._skews = np.array([[skew(a) for a in c.axes] for c in chains])  # (G, n, 3, 3)
        self._skews_squared = self._skews @ self._skews
        # Rodrigues: a turn adds to a vector sine times its cross product with the axis, and 1 - cosine times the next such product.
        self._turns = np.concatenate([self._skews, self._skews_squared], -2)  # (G, n, 6, 3)
        self._upper_m, self._beside_m = np.stack([c.upper_m for c in chains]), np.stack([c.beside_m for c in chains])
        self.upper0, self.fore0 = unit(self._upper_m), unit(np.stack([c.fore_m for c in chains]))
        bones = np.stack([self.fore0, self.upper0 if one.has_elbow else self.fore0], 1)
        # The vectors that the joints turn, in the zero pose: forearm, upper arm, and the axes from the last joint to the first.
        # Where axes miss the shoulder, each shoulder joint adds a vector in front of its axis. This vector leads to the next
        # shoulder joint; that of the last one leads to the elbow. Sums of these vectors are the joints' levers.
        columns, n = np.concatenate([bones, self.axes[:, ::-1]], 1), self._n_shoulder
        if self._has_offsets:
            places = np.concatenate([self._beside_m[:, :n], self._upper_m[:, None]], 1)
            columns = np.insert(
                columns, range(columns.shape[1] - n, columns.shape[1]), np.diff(places, axis=1)[:, ::-1], 1
            )
        self._zero = columns.swapaxes(1, 2)  # (G, 3, columns)
        step = 2 if self._has_offsets else 1
        self._axis_columns, self._lever_columns = slice(None, 1, -step), slice(2 + one.has_elbow, None, 2)
        last = columns.shape[1] - 1
        self._n_turned = [last - step * j if j < n else 1 for j in range(self.n_joints)]

    def directions(self, q: Array) -> tuple[Array, Array]:
        """Unit directions of upper arm and forearm, each (G, M, 3), for angles (G, M, n)."""
        R = self._rotations(q)
        shoulder = R[:, :, 0]
        for j in range(1, self._n_shoulder):
            shoulder = shoulder @ R[:, :, j]
        if self._has_offsets:
            upper = unit(self._to_elbow_m(R))
        else:
            upper = (shoulder @ self.upper0[:, None, :, None])[..., 0]
        if not self._has_elbow:
            return upper, upper
        return upper, (shoulder @ (R[:, :, -1] @ self.fore0[:, None, :, None]))[..., 0]

    def bones(self, q: Array) -> Bones:
        """Directions of both bones for angles (G, M, n), with their derivatives."""
        G, M, n = q.shape
        # Poses along the last axis in memory: arrays of three numbers would cost NumPy more than their arithmetic.
        by_joint = np.ascontiguousarray(q.transpose(2, 0, 1))[:, :, None, None]
        sine, versine = np.sin(by_joint), 1 - np.cos(by_joint)
        # Coordinates x, y, z, x, y of what the joints turn.
        every = np.empty((G, 5, self._zero.shape[2], M))
        every[:, :3] = self._zero[..., None]
        for j in range(n - 1, -1, -1):
            turned = every[:, :3, : self._n_turned[j]]
            steps = (self._turns[:, j] @ turned.reshape(G, 3, -1)).reshape(G, 6, -1, M)
            turned += sine[j] * steps[:, :3] + versine[j] * steps[:, 3:]
        every[:, 3:] = every[:, :2]
        axes = every[:, :, self._axis_columns].transpose(0, 2, 1, 3)
        both = every[:, :, 1::-1].transpose(0, 2, 1, 3)[:, None]
        slope = _crossed(axes[:, :, None], both)  # (G, n, 2, 3, M)
        if self._has_elbow:
            slope[:, -1, 0] = 0.0
        upper, fore = every[:, :3, 1], every[:, :3, 0]
        if self._has_offsets:
            levers_m = every[:, :, self._lever_columns].cumsum(2)[:, :, ::-1].transpose(0, 2, 1, 3)
            upper, slope[:, : self._n_shoulder, 0] = self._upper_with_offsets(levers_m, axes)
        slopes = slope.reshape(G, n, 6, M).transpose(0, 3, 1, 2)
        return Bones(upper.swapaxes(1, 2), fore.swapaxes(1, 2), slopes)

    def _rotations(self, q: Array) -> Array:
        """(G, M, n, 3, 3) rotations of the joints."""
        sine, versine = np.sin(q)[..., None, None], (1 - np.cos(q))[..., None, None]
        return _EYE + sine * self._skews[:, None] + versine * self._skews_squared[:, None]

    def _to_elbow_m(self, R: Array) -> Array:
        """(G, M, 3) vectors from shoulder to elbow."""
        v: Array = np.broadcast_to(self._upper_m[:, None], (*R.shape[:2], 3))
        for j in range(self._n_shoulder - 1, -1, -1):
            beside = self._beside_m[:, None, j]
            v = (R[:, :, j] @ (v - beside)[..., None])[..., 0] + beside
        return v

    def _upper_with_offsets(self, levers_m: Array, axes: Array) -> tuple[Array, Array]:
        """Directions of upper arms (G, 3, M), and their derivatives by the shoulder joints (G, s, 3, M).

        Args:
            levers_m: (G, s, 5, M) vectors x, y, z, x, y from each of s shoulder joints to the elbow.
            axes: (G, n, 5, M) axes of the joints, alike.
        """
        v = levers_m[:, 0, :3] + self._beside_m[:, 0, :, None]
        length = np.sqrt((v * v).sum(1, keepdims=True))
        upper = v / length
        moved = _crossed(axes[:, : self._n_shoulder], levers_m)
        along = (moved * upper[:, None]).sum(2, keepdims=True)
        return upper, (moved - along * upper[:, None]) / length[:, None]


def _crossed(a: Array, b: Array) -> Array:
    """(..., 3, M) cross products of vectors (..., 5, M), given as their coordinates x, y, z, x, y."""
    product = a[..., 1:4, :] * b[..., 2:, :]
    product -= a[..., 2:, :] * b[..., 1:4, :]
    return product
