"""Refines a path near contacts: optimises all arms at once, with the distances among the constraints.

The errors of bone directions and the distances are linearised at the path, the program of `arm_program` is solved, and both are
linearised again at its solution, until the path is free of contact (sequential quadratic programming within a trust region;
Nocedal, Wright 2006, section 18.5).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from retarget.path.arm_program import ArmProgram, Frames, Rooms, Steady
from retarget.path.bounded_poses import BoundedPoses
from retarget.path.collision import KEPT, SelfContact
from retarget.path.least_distances import LeastDistances
from retarget.path.limits import JointLimits
from retarget.path.slopes import NearPairs
from retarget.path.spline_distances import Seen

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Touching = Callable[[Array, LeastDistances, Seen], NDArray[np.bool_]]
Shown = Callable[[Array], tuple[Array, Array]]
"""Linearises half the squared error of frames (T, J): Hessian (T, J, J) and negative gradient (T, J)."""
_TRUST_RAD = (0.4, 0.2, 0.2, 0.2, *[0.1] * 8)
"""Radians by which a control point may move, by round."""
_NEAR_M = 0.03
"""Metres beyond its margin within which a pair is part of the program, in a frame; between frames a third of it."""
_AIM_M = 0.001
"""Metres beyond the margin that poses keep, a reserve for the error of the linearisation."""
_LEAST_GAIN = 5e-3
"""Decrease of a frame's mean cost by a round below which a free path is not improved further."""
_MORE_M = 0.0015
"""Additional metres that poses keep where the path of the previous round touched."""
_BETWEEN_M = (1 - KEPT) * 0.010
"""Metres of the margin that poses between frames may lack."""
_DEEP_M, _DEEP_WORSE = 0.5, 0.05
_STUCK_M, _STUCK_SHARE = 0.25, 0.8
"""Metres of room that all poses lack together and increase of a frame's cost above which the program ends; less metres, and the
share of them that each of two rounds in a row left, above which it ends as well. Arms are then deep in the body, and the program
leads them out only from poses pushed out. A program whose path has not become worse may still free hands that meet in a clap."""
_PATIENCE, _LESS = 5, 0.9
"""Rounds after which a program without a free path ends when none of them lacked less than this share of the least before them."""
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
        brakes_after: Sequence[int],
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
            brakes_after: numbers of segments after which the path must be able to brake, see `BoundedPoses.of`.
        """
        control, joints, N = control_rad.copy(), self._joints, len(control_rad) - 2
        program = self._program(control, period_s)
        loss_rad = self._limits.acceleration_rad_s2 * period_s**2
        more_m, worse, lacked_m, within = np.full(N, _AIM_M), 0.0, [np.inf], np.zeros(0, np.int64)
        is_found = False
        hit: NDArray[np.bool_] = np.zeros(N, bool)
        poses = BoundedPoses.of(control, within, brakes_after, loss_rad)
        near, least = self._near(poses, least)
        for trust_rad in _TRUST_RAD:
            costs = self._costs(shown, least.q_rad[:n_frames], N)
            change = program.change(control[2:, joints], costs, self._rooms(near, more_m, poses), _STEADY, trust_rad)
            if change is None:
                return
            control[2:, joints] += change
            worse += costs.of(change)
            poses = BoundedPoses.of(control, within, brakes_after, loss_rad)
            control[2 + n_frames :] = _held(poses.control_rad, N + 2)[2 + n_frames :]
            near, least = self._near(poses, least)
            lack_m = np.maximum(np.where(near.pose < len(poses.control_rad) - 2, 0.0, -_BETWEEN_M) - near.room_m, 0.0)
            hit = np.zeros(N, bool)
            hit[poses.segment[near.pose[lack_m > 0]]] = True
            lacked_m.append(float(lack_m.sum()))
            if _is_hopeless(lacked_m, worse / n_frames):
                return
            if not is_found and min(lacked_m[-_PATIENCE:]) > _LESS * min(lacked_m[:-_PATIENCE], default=np.inf):
                break
            if not hit.any():
                hit = touching(control, least, Seen(poses.control_rad, near))
                within = np.union1d(within, np.flatnonzero(hit))
                if not hit.any():
                    is_found = True
                    yield control.copy(), worse / n_frames
            more_m[hit] += _MORE_M
            more_m[:-1][hit[1:] & ~hit[:-1]] += _MORE_M
            more_m[1:][hit[:-1] & ~hit[1:]] += _MORE_M
        if hit.any() and not hit[:n_needed].any():
            hit = touching(control, least, Seen(poses.control_rad, near))
            if not hit[:n_needed].any():
                yield control, worse / n_frames

    def _near(self, poses: BoundedPoses, least: LeastDistances) -> tuple[NearPairs, LeastDistances]:
        """Near pairs in the poses, and bounds of distances in those at the ends of segments."""
        N, q_rad = len(poses.control_rad) - 2, poses.q_rad
        frames = q_rad[:N]
        within_m = np.repeat((_NEAR_M, _NEAR_M / 3), (N, len(q_rad) - N))
        least_m = least.at(frames)
        of_between = LeastDistances(frames, least_m, least.sweep_m).part(poses.segment[N:]).at(q_rad[N:])
        near = self._contact.near(q_rad, within_m, np.concatenate([least_m, of_between]))
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

    def _costs(self, shown: Shown, frames: Array, N: int) -> Frames:
        """The costs of N frames, the first of which are given; later ones have a small weight on their present angles."""
        n_frames, joints = len(frames), self._joints
        n = len(joints)
        hessian, fall = np.zeros((N, n, n)), np.zeros((N, n))
        every, falls = shown(frames)
        hessian[:n_frames], fall[:n_frames] = every[:, joints[:, None], joints], falls[:, joints]
        hessian[n_frames:] = _TAIL_WEIGHT * hessian[n_frames - 1]
        hessian[:, range(n), range(n)] += _LEAST
        return Frames(hessian, fall)

    def _rooms(self, near: NearPairs, more_m: Array, poses: BoundedPoses) -> Rooms:
        """Constraint rows of the poses."""
        point = poses.point[near.pose]
        some = np.flatnonzero((_rank(poses.group[near.pose], near.room_m) < poses.most[near.pose]) & (point >= 0))
        some = some[np.argsort(point[some], kind="stable")]
        point, pose = point[some], near.pose[some]
        share = poses.share[pose][:, :, self._joints]
        share[point == 0, 0] = 0.0  # the point before it is fixed
        grows = share * near.grows(some)[:, None, self._joints]
        return Rooms(point, grows, near.room_m[some] - more_m[poses.segment[pose]], _STIFFNESS)


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


def _is_hopeless(lacked_m: list[float], worse: float) -> bool:
    """Whether arms stay deep in the body, by the metres of room that all poses lacked before and after each round.

    The path must have become worse, and either much be lacking or two rounds in a row have left most of what was lacking.
    """
    *_, before_m, between_m, now_m = np.inf, *lacked_m
    is_stuck = between_m > _STUCK_SHARE * before_m and now_m > _STUCK_SHARE * between_m
    return worse > _DEEP_WORSE and (now_m > _DEEP_M or (is_stuck and now_m > _STUCK_M))


def _held(control_rad: Array, n: int) -> Array:
    """(n, J) control points, the last of which is repeated."""
    return np.concatenate([control_rad, np.repeat(control_rad[-1:], n - len(control_rad), 0)])


def _rank(group: Indices, room_m: Array) -> Indices:
    """(R,) how many rows of the same group have less room."""
    order = np.lexsort((room_m, group))
    rank, group = np.empty(len(group), np.int64), group[order]
    rank[order] = np.arange(len(group)) - np.searchsorted(group, group)
    return rank
