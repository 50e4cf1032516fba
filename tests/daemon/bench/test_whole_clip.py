"""The least error of a whole clip, the measure of `mmmd bench retarget`, against another solver and the path's bounds."""

import numpy as np
import pytest

from daemon.bench.motions import cut
from daemon.bench.retarget import _fidelity, with_common_limits
from daemon.bench.whole_clip import _Program, best_of_clip
from retarget.human.human import read_human
from retarget.human.poser import Poses
from retarget.pipeline import Retargeter
from retarget.robot.loading import load_robot
from tests.retarget.gestures import gesture
from tests.support.sizes import few_and_long


def _clip(robot_name, name, frames, seed=3):
    retargeter = Retargeter(with_common_limits(load_robot(robot_name)))
    motion = cut(gesture(name, seed=seed), 0, frames)
    return retargeter, retargeter.poses(read_human(motion)), retargeter.retarget(motion)


@pytest.mark.long
def test_the_figures_say_how_near_the_path_is_to_the_best():
    """Marks in degrees were missed on lively recordings whatever the method: servos of that speed cost what they cost.

    A path is now compared with the least that its whole clip allows.
    """
    figures = _fidelity(Retargeter(with_common_limits(load_robot("reference"))), [gesture("punch")], whole=True)
    assert 1.0 <= figures["share_of_optimum_rms"] < 1.15
    assert figures["share_of_optimum"] == pytest.approx(
        figures["direction_mean_deg"] / figures["whole_clip"]["direction_mean_deg"], abs=2e-3
    )


@pytest.mark.parametrize("robot_name", few_and_long(["reference"], ["toddlerbot", "op3"]))
def test_the_best_keeps_every_bound_and_margin(robot_name):
    retargeter, poses, path = _clip(robot_name, "jumping_jack", 60)
    found = best_of_clip(retargeter, poses, path)
    control, limits, period = found.control_rad, retargeter.limits, 1 / path.rate_hz
    assert np.array_equal(control[:2], path.control_rad[:2])
    assert (control >= limits.position_min_rad - 1e-6).all()
    assert (control <= limits.position_max_rad + 1e-6).all()
    assert (np.abs(np.diff(control, axis=0)) <= limits.velocity_rad_s * period + 1e-6).all()
    assert (np.abs(np.diff(control, n=2, axis=0)) <= limits.acceleration_rad_s2 * period**2 + 1e-6).all()
    frames = ((control[1:-1] + control[2:]) / 2)[:60]
    assert (retargeter.contact.slacks_m(frames, 1.0) > -1e-3).all()
    assert found.lack_m < 1e-3
    missed = _missed(retargeter, poses, frames)
    assert missed < _missed(retargeter, poses, path.q_rad[:60])
    free = best_of_clip(retargeter, poses, path, contact=False).control_rad
    assert _missed(retargeter, poses, ((free[1:-1] + free[2:]) / 2)[:60]) < missed * 1.01


@pytest.mark.long
def test_of_two_ends_the_one_that_costs_less_is_the_best():
    """On arms of few joints the end of fewer degrees can be the worse one: a hand then weighs more than both bones.

    The better of the two starts was chosen by degrees, which the program does not minimise.
    """
    retargeter, poses, path = _clip("op3", "wave", 40, seed=1)
    program = _Program(retargeter, poses, path, contact=True)
    ends = [program.solve(start) for start in program.starts()]
    by_cost = min(ends, key=lambda end: end.cost)
    by_degrees = min(ends, key=lambda end: (end.errors_deg**2).sum())
    assert by_cost.cost < 0.999 * by_degrees.cost, "both starts end alike: nothing was tested"
    assert best_of_clip(retargeter, poses, path).cost == pytest.approx(by_cost.cost, rel=1e-9)


def _missed(retargeter: Retargeter, poses: Poses, q_rad: np.ndarray) -> float:
    """The error that the program minimises: each frame weighs the bones, and on arms of few joints not all bones count alike."""
    return float((retargeter.missed(poses, q_rad) ** 2).sum())


@pytest.mark.long
def test_another_solver_finds_nothing_better():
    """Twelve frames of a punch by SciPy's SLSQP, from our solution and from the poses: it comes to the same error."""
    from scipy.optimize import (  # slow to import, and every worker of xdist collects this file
        LinearConstraint,
        minimize,
    )

    retargeter, poses, path = _clip("reference", "punch", 12)
    found = best_of_clip(retargeter, poses, path, contact=False)
    joints = sorted({j for arm in retargeter.arms for j in arm.joints if arm.side == "right"})
    limits, period, free = retargeter.limits, 1 / path.rate_hz, len(found.control_rad) - 2
    control, N = found.control_rad, free * len(joints)

    def filled(x):
        every = control.copy()
        every[2:, joints] = x.reshape(free, -1)
        return every

    def cost(x):
        every = filled(x)
        return 1e2 * float((retargeter.missed(poses, ((every[1:-1] + every[2:]) / 2)[:12]) ** 2).sum())

    step, bend = limits.velocity_rad_s[joints] * period, limits.acceleration_rad_s2[joints] * period**2
    first = np.kron(np.eye(free) - np.eye(free, k=-1), np.eye(len(joints)))
    second = first @ first
    zero = filled(np.zeros(N))[:, joints]
    offsets = np.diff(zero, axis=0)[1:].ravel(), np.diff(zero, n=2, axis=0).ravel()
    bounds = [
        LinearConstraint(first, np.tile(-step, free) - offsets[0], np.tile(step, free) - offsets[0]),
        LinearConstraint(second, np.tile(-bend, free) - offsets[1], np.tile(bend, free) - offsets[1]),
    ]
    ours = control[2:, joints].ravel()
    ends = list(
        zip(np.tile(limits.position_min_rad[joints], free), np.tile(limits.position_max_rad[joints], free), strict=True)
    )
    program = {"method": "SLSQP", "bounds": ends, "constraints": bounds, "options": {"maxiter": 60}}
    posed = np.concatenate([poses.q_rad, np.repeat(poses.q_rad[-1:], free - 12, 0)])[:, joints].ravel()
    for start in (ours, posed):
        other = minimize(cost, start, **program)
        assert 0.99 * cost(ours) < other.fun < 1.05 * cost(ours)
