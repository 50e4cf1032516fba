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
from retarget.robot.kinematics import cross, skew

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
        self._zero = np.concatenate([bones, self.axes[:, ::-1]], 1).swapaxes(1, 2)  # (G, 3, n + 2)

    def directions(self, q: Array) -> tuple[Array, Array]:
        """Unit directions of upper arm and forearm, each (G, M, 3), for angles (G, M, n)."""
        R = self._rotations(q)
        shoulder = R[:, :, 0]
        for j in range(1, self._n_shoulder):
            shoulder = shoulder @ R[:, :, j]
        if self._has_offsets:
            upper = unit(self._levers(R)[0])
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
        # Coordinates x, y, z, x, y of forearm, upper arm, and axes from the last to the first.
        every = np.empty((G, 5, n + 2, M))
        every[:, :3] = self._zero[..., None]
        for j in range(n - 1, -1, -1):
            turned = every[:, :3, : 1 if j >= self._n_shoulder else n + 1 - j]  # what joint j turns
            steps = (self._turns[:, j] @ turned.reshape(G, 3, -1)).reshape(G, 6, -1, M)
            turned += sine[j] * steps[:, :3] + versine[j] * steps[:, 3:]
        every[:, 3:] = every[:, :2]
        axes = every[:, :, :1:-1].transpose(0, 2, 1, 3)[:, :, None]
        both = every[:, :, 1::-1].transpose(0, 2, 1, 3)[:, None]
        slope = axes[:, :, :, 1:4] * both[:, :, :, 2:]
        slope -= axes[:, :, :, 2:] * both[:, :, :, 1:4]  # (G, n, 2, 3, M): cross products of axes and bones
        if self._has_elbow:
            slope[:, -1, 0] = 0.0
        slopes = slope.reshape(G, n, 6, M).transpose(0, 3, 1, 2)
        upper, fore = every[:, :3, 1].swapaxes(1, 2), every[:, :3, 0].swapaxes(1, 2)
        if self._has_offsets:
            upper, slopes[:, :, : self._n_shoulder, :3] = self._upper_with_offsets(
                self._rotations(q), every[:, :3, :1:-1].transpose(0, 3, 2, 1)
            )
        return Bones(upper, fore, slopes)

    def _rotations(self, q: Array) -> Array:
        """(G, M, n, 3, 3) rotations of the joints."""
        sine, versine = np.sin(q)[..., None, None], (1 - np.cos(q))[..., None, None]
        return _EYE + sine * self._skews[:, None] + versine * self._skews_squared[:, None]

    def _levers(self, R: Array) -> tuple[Array, list[Array]]:
        """(G, M, 3) vectors from shoulder to elbow, and for each shoulder joint the lever at which it moves the elbow."""
        levers: list[Array] = []
        v: Array = np.broadcast_to(self._upper_m[:, None], (*R.shape[:2], 3))
        for j in range(self._n_shoulder - 1, -1, -1):
            beside = self._beside_m[:, None, j]
            lever = (R[:, :, j] @ (v - beside)[..., None])[..., 0]
            levers = [lever, *((R[:, :, j] @ w[..., None])[..., 0] for w in levers)]
            v = lever + beside
        return v, levers

    def _upper_with_offsets(self, R: Array, axes: Array) -> tuple[Array, Array]:
        """Directions of upper arms (G, M, 3), and their derivatives by each shoulder joint (G, M, n, 3)."""
        v, levers = self._levers(R)
        length = np.linalg.norm(v, axis=-1, keepdims=True)
        upper = v / length
        moved = cross(axes[:, :, : len(levers)], np.stack(levers, 2))
        along = (moved * upper[:, :, None]).sum(-1, keepdims=True)
        return upper, (moved - along * upper[:, :, None]) / length[:, :, None]
