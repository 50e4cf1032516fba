"""The program joint by joint against the same program with all joints and frames at once, by a solver of another kind."""

from __future__ import annotations

import numpy as np
import pytest

from retarget.path.limit_path import limit_path
from retarget.path.limits import JointLimits
from retarget.path.lookahead_qp import Bounds, LeastSquares, frames_between, nearer_path
from retarget.robot.loading import load_robot

T, W = 10, 3
BOUNDS = Bounds(*(np.full((1, W), x) for x in (-1.0, 1.2, 0.24, 0.1)))
START, STEP = np.array([[0.1, -0.2, 0.3]]), np.array([[0.02, 0.05, -0.04]])


def program(seed: int) -> tuple[LeastSquares, np.ndarray]:
    """A wish that runs into every bound, all joints coupled, and control points near it."""
    rng = np.random.default_rng(seed)
    slope = rng.normal(size=(1, T, W, 4))
    near = np.clip(np.cumsum(rng.normal(scale=0.5, size=(1, T, W)), 1), -1.0, 1.2)
    hessian = slope @ np.swapaxes(slope, -1, -2) + 0.05 * np.eye(W)
    shown = frames_between(near, START)
    return LeastSquares(hessian, (hessian @ shown[..., None])[..., 0], 1e-3), near


def cost(wish: LeastSquares, near: np.ndarray, path: np.ndarray) -> float:
    """What the module says is least, written out."""
    shown = frames_between(path, START)
    wished = 0.5 * (shown[..., None, :] @ wish.hessian @ shown[..., None]).sum() - (wish.linear * shown).sum()
    off = np.diff(np.concatenate([np.zeros((1, 1, W)), path - near], 1), axis=1)
    zigzag = 0.125 * (np.einsum("gtjj->gtj", wish.hessian) * off**2).sum()
    moved = np.diff(np.concatenate([START[:, None], path], 1), axis=1)
    return float(wished + zigzag + wish.pull / 2 * (moved**2).sum())


@pytest.mark.parametrize("seed", range(4))
def test_joint_by_joint_comes_to_the_optimum_of_all_at_once(seed: int) -> None:
    from scipy.optimize import (  # slow to import, and every worker of xdist collects this file
        LinearConstraint,
        minimize,
    )

    wish, near = program(seed)
    path, inside = near.copy(), np.zeros((1, W), bool)
    costs = []
    for _ in range(40):
        assert nearer_path(wish, path, near, START, STEP, BOUNDS, inside)
        costs.append(cost(wish, near, path))
    assert (np.diff(costs) < 1e-9).all(), "each round is nearer"
    before = np.concatenate([START - STEP, START])
    first = np.eye(T + 2)[1:] - np.eye(T + 2)[:-1]
    second = first[1:, 1:] @ first
    rows = np.concatenate([np.eye(T + 2)[2:], first[1:], second])
    ends = np.concatenate([np.full(T, 1.2), np.full(T - 1, 0.24), [0.02 * 0.1], np.full(T, 0.1)])
    low = np.concatenate([np.full(T, -1.0), -ends[T:]])
    every = np.kron(rows[:, 2:], np.eye(W))
    known = (rows[:, :2] @ before).ravel()
    bounds = LinearConstraint(every, np.repeat(low, W) - known, np.repeat(ends, W) - known)
    best = minimize(
        lambda x: cost(wish, near, x.reshape(1, T, W)), path.ravel(), method="SLSQP", constraints=bounds,
        options={"maxiter": 400, "ftol": 1e-12},
    )  # fmt: skip
    assert costs[-1] == pytest.approx(best.fun, abs=2e-3 * abs(best.fun)), (
        "the solver keeps a ten-thousandth of bounds free"
    )
    moved = np.diff(np.concatenate([before, path[0]]), axis=0)
    assert (np.abs(moved[1:]) <= 0.24).all() and (np.abs(np.diff(moved, axis=0)) <= 0.1).all()
    assert (path >= -1.0).all() and (path <= 1.2).all()


def test_a_joint_that_keeps_its_bounds_is_left_where_it_is() -> None:
    wish, near = program(0)
    hessian = wish.hessian * np.eye(W)
    shown = frames_between(near, START)
    path = near.copy()
    apart = LeastSquares(hessian, (hessian @ shown[..., None])[..., 0], 1e-3)
    assert nearer_path(apart, path, near, START, STEP, BOUNDS, np.array([[True, False, True]]))
    np.testing.assert_array_equal(path[..., [0, 2]], near[..., [0, 2]])
    assert (path[..., 1] != near[..., 1]).any()


def test_at_rest_no_zigzag_is_left() -> None:
    """Frames do not show control points that alternate about them; a path that is held must not either."""
    limits = JointLimits.of(load_robot("reference"))
    target = (limits.position_min_rad + limits.position_max_rad) / 2
    reference = np.repeat(target[None], 40, 0)
    path = limit_path(reference, target - 0.4, np.zeros(len(target)), limits, 0.05)
    assert np.abs(np.diff(path[25:], axis=0)).max() < 1e-6
