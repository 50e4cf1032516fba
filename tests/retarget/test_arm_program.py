"""The program of all arms against SciPy's SLSQP, on problems small enough for it."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from retarget.path.arm_program import ArmProgram, Frames, Rooms, Steady

Array = NDArray[np.float64]
_N, _JOINTS, _MOST_RAD = 6, 3, 0.8
_STEADY = Steady(1e-3, 1e-2)


def _differences(points: Array) -> Array:
    """(3, N, n) control points after two that are 0, their first and second differences."""
    every = np.concatenate([np.zeros((2, _JOINTS)), points.reshape(_N, _JOINTS)])
    return np.stack([every[2:], np.diff(every, axis=0)[1:], np.diff(every, n=2, axis=0)])


def _frames(points: Array) -> Array:
    every = np.concatenate([np.zeros((1, _JOINTS)), points.reshape(_N, _JOINTS)])
    return (every[1:] + every[:-1]) / 2


@pytest.mark.parametrize("seed", range(4))
def test_it_finds_what_slsqp_finds(seed: int) -> None:
    """Costs of frames, boxes on positions and differences, and two soft distances, of a frame and of a control point."""
    from scipy.optimize import minimize  # slow to import, and every worker of xdist collects this file

    rng = np.random.default_rng(seed)
    root = rng.normal(size=(_N, _JOINTS, _JOINTS))
    costs = Frames(0.3 * root @ root.transpose(0, 2, 1), rng.normal(size=(_N, _JOINTS)))
    bounds = np.broadcast_to(np.array([1.0, 0.3, 0.2])[:, None, None], (3, _N, _JOINTS))
    share, grows = np.array([[0.5, 0.5], [0.0, 1.0]]), rng.normal(size=(2, _JOINTS))
    rooms = Rooms(np.array([2, 4]), share[..., None] * grows[:, None], np.array([0.05, -0.02]), 1e3)
    program = ArmProgram(bounds, -bounds, np.zeros((2, _JOINTS)))

    def cost(points: Array) -> float:
        frames, (_, step, bend) = _frames(points), _differences(points)
        error = np.einsum("ki,kij,kj", frames, costs.hessian, frames) / 2 - (costs.fall * frames).sum()
        poses = np.stack([frames[2], points.reshape(_N, _JOINTS)[4]])
        lack = np.minimum(rooms.room_m + (grows * poses).sum(1), 0.0)
        return float(
            error + _STEADY.step * (step**2).sum() / 2 + _STEADY.bend * (bend**2).sum() / 2 + 1e3 * (lack**2).sum() / 2
        )

    found = program.change(np.zeros((_N, _JOINTS)), costs, rooms, _STEADY, _MOST_RAD)
    assert found is not None
    best = minimize(
        cost, np.zeros(_N * _JOINTS), method="SLSQP",
        bounds=[(-_MOST_RAD, _MOST_RAD)] * (_N * _JOINTS), options={"maxiter": 500, "ftol": 1e-12},
        constraints=[
            {"type": "ineq", "fun": lambda x: (bounds - _differences(x)).ravel()},
            {"type": "ineq", "fun": lambda x: (bounds + _differences(x)).ravel()},
        ],
    )  # fmt: skip
    assert (np.abs(_differences(found)) <= bounds + 1e-6).all()
    assert cost(found.ravel()) <= best.fun + 1e-4
    np.testing.assert_allclose(found.ravel(), best.x, atol=2e-3)


def test_no_change_where_nothing_falls() -> None:
    """At the optimum of frames without distances near, the program stays."""
    costs = Frames(np.tile(np.eye(_JOINTS), (_N, 1, 1)), np.zeros((_N, _JOINTS)))
    bounds = np.ones((3, _N, _JOINTS))
    none = Rooms(np.zeros(0, np.int64), np.zeros((0, 2, _JOINTS)), np.zeros(0), 1.0)
    found = ArmProgram(bounds, -bounds, np.zeros((2, _JOINTS))).change(
        np.zeros((_N, _JOINTS)), costs, none, _STEADY, _MOST_RAD
    )
    assert found is not None
    assert np.abs(found).max() < 1e-3
