"""Refines a path near contacts: optimises all arms at once, with the distances among the constraints.

The errors of bone directions and the distances are linearised at the path, the program of `arm_program` is solved, and both are
linearised again at its solution, until the path is free of contact (sequential quadratic programming within a trust region;
Nocedal, Wright 2006, section 18.5).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from retarget.path.arm_program import ArmProgram, Frames, Rooms, Steady
from retarget.path.collision import KEPT, SelfContact, spline
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
_MOST_PAIRS = 8
"""Number of nearest pairs of each pose that are part of the program."""
_AIM_M = 0.001
"""Metres beyond the margin that poses keep, a reserve for the error of the linearisation."""
_WITHIN = (0.125, 0.25, 0.375, 0.625, 0.75, 0.875)
"""Places in a segment that are measured too once the proof has failed in it: what passes through each other between a frame
and the middle shows only there."""
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

    def refine(
        self,
        control_rad: Array,
        shown: Shown,
        n_frames: int,
        period_s: float,
        touching: Touching,
        least: LeastDistances,
        n_needed: int,
        *,
        is_free: bool = False,
    ) -> tuple[Array, float] | None:
        """Control points without contact and the mean increase of a frame's cost by them; None if none were found.

        Args:
            control_rad: (N, J) initial control points; the first two, and joints outside the arms, do not change. At the end
                the arms come to rest.
            shown: the cost of frames (T, J).
            n_frames: T; later frames have hardly any weight.
            period_s: seconds between control points.
            touching: gives the touching ones of N - 2 segments, for control points and bounds of distances in their frames.
            least: bounds of distances in frames near those of `control_rad`.
            n_needed: segments that have to be free; contacts in later ones are allowed where no round avoids them.
        """
        control, joints, N = control_rad.copy(), self._joints, len(control_rad) - 2
        program = self._program(control, period_s)
        more_m, worse, places = np.full(N, _AIM_M), 0.0, _Places.of(N)
        found: tuple[Array, float] | None = None
        for k in range(len(_TRUST_RAD) + 1):
            near, least = self._near(control, least, places)
            if k:
                lacks = places.segment[near.pose[near.room_m < np.where(near.pose < N, 0.0, -_BETWEEN_M)]]
                hit = np.isin(np.arange(N), lacks)
                if not hit[:n_needed].any() and (k == len(_TRUST_RAD) or not hit.any()):
                    hit = touching(control, least, Seen(control, near))
                    places = places.and_within(np.flatnonzero(hit))
                if not hit[: n_needed if k == len(_TRUST_RAD) else N].any():
                    if not is_free:
                        return control, worse / n_frames
                    if found is not None and worse / n_frames > found[1] - 1e-3:
                        return min(found, (control, worse / n_frames), key=lambda f: f[1])
                    found = control.copy(), worse / n_frames
                more_m[hit] += _MORE_M
                more_m[:-1][hit[1:] & ~hit[:-1]] += _MORE_M
                more_m[1:][hit[:-1] & ~hit[1:]] += _MORE_M
            if k == len(_TRUST_RAD):
                break
            rooms = self._rooms(near, more_m, places)
            costs = self._costs(shown, least.q_rad, n_frames)
            change = program.change(control[2:, joints], costs, rooms, _STEADY, _TRUST_RAD[k])
            if change is None:
                break
            control[2:, joints] += change
            worse += costs.of(change)
        return found

    def _near(self, control: Array, least: LeastDistances, places: _Places) -> tuple[NearPairs, LeastDistances]:
        """Near pairs in N frames and in poses between them, and bounds of distances in the frames."""
        frames = (control[1:-1] + control[2:]) / 2
        N = len(frames)
        between = places.on(control)[N:]
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

    def _rooms(self, near: NearPairs, more_m: Array, places: _Places) -> Rooms:
        """Constraint rows of N frames and of poses between them."""
        some = np.flatnonzero(_rank(near.pose, near.room_m) < _MOST_PAIRS)
        some = some[np.argsort(places.segment[near.pose[some]], kind="stable")]
        pose = near.pose[some]
        point, share = places.segment[pose], places.share[pose]
        share[point == 0, 0] = 0.0  # the point before it is fixed
        return Rooms(point, share, near.grows(some)[:, self._joints], near.room_m[some] - more_m[point], _STIFFNESS)


@dataclass(frozen=True)
class _Places:
    """Places on a spline of N segments: first the ends of all, which are the frames, then their middles, then others.

    Attributes:
        segment: (M,) index of the segment, which is also that of its last control point after the two fixed ones.
        u: (M,) place in the segment, 0 to 1.
    """

    segment: Indices
    u: Array

    @classmethod
    def of(cls, n_segments: int) -> _Places:
        """Frames and middles."""
        return cls(np.tile(np.arange(n_segments, dtype=np.int64), 2), np.repeat((1.0, 0.5), n_segments))

    def and_within(self, segments: Indices) -> _Places:
        """These, and more in some segments."""
        new = np.setdiff1d(segments, self.segment[np.isin(self.u, _WITHIN)])
        return _Places(
            np.concatenate([self.segment, np.repeat(new, len(_WITHIN))]),
            np.concatenate([self.u, np.tile(_WITHIN, len(new))]),
        )

    def on(self, control: Array) -> Array:
        """(M, J) the poses there, on the spline of (N + 2, J) control points."""
        return spline(control, self.segment, self.u)

    @property
    def share(self) -> Array:
        """(M, 2) weights of the last control point but one of the segment, that before it included, and of the last."""
        last = self.u**2 / 2
        return np.stack([1 - last, last], 1)


def _rank(pose: Indices, room_m: Array) -> Indices:
    """(R,) how many rows of the same pose have less room."""
    order = np.lexsort((room_m, pose))
    rank = np.empty(len(pose), np.int64)
    rank[order] = np.arange(len(pose)) - np.searchsorted(pose[order], pose[order])
    return rank
