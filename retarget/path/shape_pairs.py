"""Pairs of a robot's shapes that can meet."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from retarget.robot.description import mujoco

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def pairs_that_can_meet(model: Any, above: Array) -> Indices:
    """(P, 2) shapes that MuJoCo would check for contact, on bodies at least three steps of the tree and two joints apart.

    `above` is `joints_above`.
    """
    parent, body = model.body_parentid, model.geom_bodyid
    excluded = {int(s) for s in model.exclude_signature}
    plane = model.geom_type == int(mujoco.mjtGeom.mjGEOM_PLANE)
    found: list[tuple[int, int]] = []
    for g in range(model.ngeom):
        for h in range(g):
            a, b = sorted((int(body[g]), int(body[h])))
            touches = (
                model.geom_contype[g] & model.geom_conaffinity[h] or model.geom_contype[h] & model.geom_conaffinity[g]
            )
            beside = (
                a == b
                or parent[a] == parent[b]
                or a in (parent[b], parent[parent[b]])
                or b in (parent[a], parent[parent[a]])
            )
            fixed = np.abs(above[a] - above[b]).sum() <= 1
            if touches and not (beside or fixed or plane[g] or plane[h] or (a << 16) + b in excluded):
                found.append((h, g))
    return np.array(found, np.int64).reshape(-1, 2)


def joints_above(model: Any, joint_ids: Indices) -> Array:
    """(bodies, J) 1 where a joint moves a body."""
    above = np.zeros((model.nbody, len(joint_ids)))
    for b in range(1, model.nbody):
        above[b] = above[model.body_parentid[b]]
        above[b, model.jnt_bodyid[joint_ids] == b] = 1
    return above
