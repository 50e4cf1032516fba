"""Refines a path near contacts: optimises all arms at once, with the distances among the constraints.

The errors of bone directions and the distances are linearised at the path, the program of `arm_program` is solved, and both are
linearised again at its solution, until the path is free of contact (sequential quadratic programming within a trust region;
Nocedal, Wright 2006, section 18.5).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from retarget.path.arm_program import ArmProgram, Frames, Rooms, Steady
from retarget.path.collision import KEPT, SelfContact
from retarget.path.least_distances import LeastDistances
from retarget.path.limits import JointLimits
from retarget.path.slopes import NearPairs
from retarget.path.spline_distances import Seen
from retarget.path.spline_places import SplinePlaces, on_spline

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Touching = Callable[[Array, LeastDistances, Seen], NDArray[np.bool_]]
Shown = Callable[[Array], tuple[Array, Array]]
"""Linearises half the squared error of frames (T, J): Hessian (T, J, J) and negative gradient (T, J)."""
_TRUST_RAD = (0.4, 0.2, 0.2, 0.2, *[0.1] * 8)
"""Radians by which a control point may move, by round."""
_NEAR_M = 0.03
"""Metres beyond its margin within which a pair is part of the program, in a frame; between frames a third of it."""
_MOST_PAIRS = 8
"""Number of nearest pairs of each pose that are part of the program."""
_AIM_M = 0.001
"""Metres beyond the margin that poses keep, a reserve for the error of the linearisation."""
_LEAST_GAIN = 5e-3
"""Decrease of a frame's mean cost by a round below which a free path is not improved further."""
_MORE_M = 0.0015
"""Additional metres that poses keep where the path of the previous round touched."""
_BETWEEN_M = (1 - KEPT) * 0.010
"""Metres of the margin that poses between frames may lack."""
_STIFFNESS = 4e4
"""Weight of the squared metres by which a pair is too near: a millimetre costs as much as 11 degrees in one frame."""
_STEADY = Steady(1e-3, 1e-2)
"""Weights of squared steps and of their changes: between frames a path must not zigzag unseen."""
_LEAST = 1e-4
"""Weight of squared angles against squared direction errors, so that joints whose turning cannot be seen stay."""
_TAIL_WEIGHT = 1e-3
"""Weight of the frames in which the joints come to rest."""
_TIGHTENED, _INWARD_RAD, _LAST_STEP = 1e-4, 4e-6, 0.02
"""As in `lookahead_qp`: shares of the bounds and radians kept free, and the last step as a share of a step of braking."""


class Refiner:
    """Refines paths of one robot's arms.

    Args:
        contact: distances between the robot's shapes.
        limits: joint limits.
        joints: (n,) indices of the joints of all arms.
    """

    def __init__(self, contact: SelfContact, limits: JointLimits, joints: Indices) -> None:
        self._contact, self._limits, self._joints = contact, limits, joints

    def free_paths(
        self,
        control_rad: Array,
        shown: Shown,
        n_frames: int,
        period_s: float,
        touching: Touching,
        least: LeastDistances,
        n_needed: int,
    ) -> Iterator[tuple[Array, float]]:
        """Yields control points without contact, and the mean increase of a frame's cost by them, after each round that has them.

        Args:
            control_rad: (N, J) initial control points; the first two, and joints outside the arms, do not change. At the end
                the arms come to rest.
            shown: the cost of frames (T, J).
            n_frames: T; later frames have hardly any weight.
            period_s: seconds between control points.
            touching: gives the touching ones of N - 2 segments, for control points and bounds of distances in their frames.
            least: bounds of distances in frames near those of `control_rad`.
            n_needed: first segments that have to be free; after the last round contacts in later ones count no more.
        """
        control, joints, N = control_rad.copy(), self._joints, len(control_rad) - 2
        program = self._program(control, period_s)
        more_m, worse, places = np.full(N, _AIM_M), 0.0, SplinePlaces.of(N)
        hit: NDArray[np.bool_] = np.zeros(N, bool)
        near, least = self._near(control, least, places)
        for trust_rad in _TRUST_RAD:
            costs = self._costs(shown, least.q_rad, n_frames)
            change = program.change(control[2:, joints], costs, self._rooms(near, more_m, places), _STEADY, trust_rad)
            if change is None:
                return
            control[2:, joints] += change
            worse += costs.of(change)
            near, least = self._near(control, least, places)
            lacks = near.pose[near.room_m < np.where(near.pose < N, 0.0, -_BETWEEN_M)]
            hit = np.asarray(np.isin(np.arange(N), places.segment[lacks]), bool)
            if not hit.any():
                hit = touching(control, least, Seen(control, near))
                places = places.and_within(np.flatnonzero(hit))
                if not hit.any():
                    yield control.copy(), worse / n_frames
            more_m[hit] += _MORE_M
            more_m[:-1][hit[1:] & ~hit[:-1]] += _MORE_M
            more_m[1:][hit[:-1] & ~hit[1:]] += _MORE_M
        if hit.any() and not hit[:n_needed].any():
            hit = touching(control, least, Seen(control, near))
            if not hit[:n_needed].any():
                yield control, worse / n_frames

    def _near(self, control: Array, least: LeastDistances, places: SplinePlaces) -> tuple[NearPairs, LeastDistances]:
        """Near pairs in N frames and in poses between them, and bounds of distances in the frames."""
        frames = (control[1:-1] + control[2:]) / 2
        N = len(frames)
        between = on_spline(control, places.segment[N:], places.u[N:])
        within_m = np.repeat((_NEAR_M, _NEAR_M / 3), (N, len(between)))
        least_m = least.at(frames)
        of_between = LeastDistances(frames, least_m, least.sweep_m).part(places.segment[N:]).at(between)
        near = self._contact.near(np.concatenate([frames, between]), within_m, np.concatenate([least_m, of_between]))
        return near, LeastDistances(frames, near.least_m[:N], least.sweep_m)

    def _program(self, control: Array, period_s: float) -> ArmProgram:
        limits, joints = self._limits, self._joints
        step, bend = limits.velocity_rad_s[joints] * period_s, limits.acceleration_rad_s2[joints] * period_s**2
        upper = np.empty((3, len(control) - 2, len(joints)))
        upper[1], upper[2] = (1 - _TIGHTENED) * step, (1 - _TIGHTENED) * bend
        upper[1, -1] = np.minimum(upper[1, -1], _LAST_STEP * bend)
        lower = -upper
        upper[0], lower[0] = (
            limits.position_max_rad[joints] - _INWARD_RAD,
            limits.position_min_rad[joints] + _INWARD_RAD,
        )
        return ArmProgram(upper, lower, control[:2, joints])

    def _costs(self, shown: Shown, frames: Array, n_frames: int) -> Frames:
        """The costs of N frames; frames after the motion have a small weight on their present angles."""
        N, joints = len(frames), self._joints
        n = len(joints)
        hessian, fall = np.zeros((N, n, n)), np.zeros((N, n))
        every, falls = shown(frames[:n_frames])
        hessian[:n_frames], fall[:n_frames] = every[:, joints[:, None], joints], falls[:, joints]
        hessian[n_frames:] = _TAIL_WEIGHT * hessian[n_frames - 1]
        hessian[:, range(n), range(n)] += _LEAST
        return Frames(hessian, fall)

    def _rooms(self, near: NearPairs, more_m: Array, places: SplinePlaces) -> Rooms:
        """Constraint rows of N frames and of poses between them."""
        every = places.point[near.pose]
        some = np.flatnonzero((_rank(near.pose, near.room_m) < _MOST_PAIRS) & (every >= 0))
        some = some[np.argsort(every[some], kind="stable")]
        point, share = every[some], places.share[near.pose[some]]
        share[point == 0, 0] = 0.0  # the point before it is fixed
        room_m = near.room_m[some] - more_m[places.segment[near.pose[some]]]
        return Rooms(point, share, near.grows(some)[:, self._joints], room_m, _STIFFNESS)


def best_of(paths: Iterator[tuple[Array, float]], enough: float) -> tuple[Array, float] | None:
    """The cheapest of `Refiner.free_paths`; None if there are none.

    No more are made once one increases a frame's cost by less than `enough`, or is hardly cheaper than the one before.
    """
    best: tuple[Array, float] | None = None
    for control, worse in paths:
        if best is not None and worse > best[1] - _LEAST_GAIN:
            break
        best = control, worse
        if worse < enough:
            break
    return best


def _rank(pose: Indices, room_m: Array) -> Indices:
    """(R,) how many rows of the same pose have less room."""
    order = np.lexsort((room_m, pose))
    rank = np.empty(len(pose), np.int64)
    rank[order] = np.arange(len(pose)) - np.searchsorted(pose[order], pose[order])
    return rank
