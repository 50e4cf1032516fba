"""Plans one block of a long motion as a path inside every limit, without self-contact, with free braking at its end.

Poses in contact are pushed out of contact, the limiter turns them into a path, and near contacts `refining` improves the path with
the distances among its bounds. A path that still touches is pushed. If that does not free it soon, the program begins once more,
from arms that stand still; where it finds no path from there, the path is drawn towards the rest pose, then stopped. A path that
becomes free is improved too.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from retarget.path.avoidance import STRENGTHS, Avoidance, stretches
from retarget.path.collision import Allowed, SelfContact
from retarget.path.control_points import braking, controls_near, held, hits_of_frames, joined
from retarget.path.least_distances import LeastDistances
from retarget.path.limit_path import SETTLED_RAD, Objective, kept
from retarget.path.limits import JointLimits
from retarget.path.paths import JointState
from retarget.path.refining import Refiner, Shown, best_of
from retarget.path.spline_distances import Seen

Array = NDArray[np.float64]
_SETTLE_FRAMES = 16
"""Frames in which joints may reach the last pose; joints that then still move brake."""
_AWAY_FRAMES = 8
"""Frames for leaving a pose within the margin from which the path to the motion touches."""
_STILL_RAD = 5e-4
"""Radians of movement in a frame below which settling ends: a third of a tick of 4,096 a turn."""
_PUSHED_SETTLED_RAD = 0.02
"""The limiter's `settled_rad` where poses were pushed out of contact: 0.1 rad moves a hand by more than such poses keep apart."""
_MOST_WORSE = 0.01
"""Mean increase of a frame's cost, half its squared errors, by leaving a contact; from this on another way out is tried as well,
which begins from poses pushed all the way out. With 0.02 two of 80 claps of Reachy stay more than 25 mm apart, with 0.01 none."""
_ENOUGH = 0.005
"""Such an increase below which the first path without contact is taken; after a larger one the program goes on."""
_ANOTHER_RAD = 0.03
"""Radians by which an angle must be pushed further for the program to begin with these poses as well."""
_PUSHED_FIRST = 2
"""Attempts to push a path out of contact before the program begins from arms that stand still, which are free of contact: it moves
them towards the poses as far as distances allow. Arms deep in the body are pushed for long without becoming free."""
_AROUND_CUT = 3
"""Frames on both sides of the end of a block that change where braking from this end touches."""


@dataclass(frozen=True)
class _Task:
    """One block to be planned.

    Attributes:
        posed: (T, J) poses that the path is to show.
        before: (1, J) the pose before them.
        shown: the cost of these frames; None where the path must be ready sooner and is not refined.
        begin: state in which the path begins.
        period: seconds between frames.
        keep: frames after which the path may end by braking.
        settle: whether the path ends at rest.
        allowed: distances that a path from within a margin keeps.
    """

    posed: Array
    before: Array
    shown: Shown | None
    begin: JointState
    period: float
    keep: int
    settle: bool
    allowed: Allowed | None


class BlockPlanner:
    """Plans the blocks of one robot.

    Args:
        contact: distances between the robot's shapes.
        limits: joint limits.
        avoidance: pushes poses out of self-contact.
        objective: gives the limiter's objective for poses (T, J) and the displacements (T, J) of their pushes.
        arms: indices of the joints of all arms.
    """

    def __init__(
        self, contact: SelfContact, limits: JointLimits, avoidance: Avoidance,
        objective: Callable[[Array, Array], Objective], arms: Sequence[int],
    ) -> None:  # fmt: skip
        self._contact, self._limits, self._avoidance, self._objective = contact, limits, avoidance, objective
        self._arms = np.array(sorted(arms), np.int64)
        self._refiner = Refiner(contact, limits, self._arms) if len(arms) else None

    def plan(
        self,
        posed: Array,
        shown: Shown | None,
        begin: JointState,
        period: float,
        keep: int,
        settle: bool,
        continued: bool,
    ) -> tuple[Array, int]:
        """Control points for poses (T, J), with free braking after `keep` frames, and the number of interventions.

        When `continued`, the first pose is the one before the block. `shown` is the cost of the block's frames; with None the
        path is ready sooner but is not refined near contacts. What comes after `keep` frames may touch: it is only a view ahead.
        """
        before, posed = (posed[:1], posed[1:]) if continued else (posed[:1], posed)
        least = self._contact.least(np.concatenate([begin.position_rad[None], posed]))
        allowed = self._contact.allowed_from(least.least_m[0])
        task = _Task(posed, before, shown if self._refiner else None, begin, period, keep, settle, allowed)
        least = least.part(slice(1, None))
        touching = self._contact.touching(least)
        found: list[Array] = []
        pushed = None
        if touching.any() and task.shown:
            # The refined path replaces the limiter's, so contacts on the limiter's are not searched.
            pushed = self._avoidance.push_a_little(posed, touching, least)
            path = self._path(task, pushed)
            better = self._refined(task, path, least)
            if better is not None:
                found.append(better[0])
                if better[1] < _MOST_WORSE:
                    return better[0], stretches(touching)
        eased, interventions = self._avoidance.push_out(posed, begin.position_rad, least)
        path, hit, least = self._limited(task, eased, least)
        # From nearly the same poses the program finds the same path once more, unless the limiter found a free one to begin with.
        moved_rad = np.inf if pushed is None else float(np.abs(eased - pushed).max())
        is_another = moved_rad > (_ANOTHER_RAD if found and hit.any() else 0.0)
        if (interventions or hit.any()) and is_another:
            better = self._refined(task, path, least, is_free=not hit.any())
            if better is not None:
                found.append(better[0])
                if better[1] < _MOST_WORSE:
                    return self._nearest(task, found), interventions or stretches(hit)
        if hit.any():
            path, more = self._pushed(task, eased, path, hit, least)
            interventions += more
        return self._nearest(task, [path, *found]), interventions

    def _pushed(
        self, task: _Task, eased: Array, path: Array, hit: NDArray[np.bool_], least: LeastDistances
    ) -> tuple[Array, int]:
        """A path without contact, from a path that touches in `hit`, and the number of interventions."""
        interventions = 0
        for attempt, strength in enumerate(STRENGTHS):
            if attempt == _PUSHED_FIRST:
                better = self._refined(task, self._still(task, path), least, is_free=True)
                if better is not None:
                    return better[0], interventions
            interventions += stretches(hit)
            eased = self._avoidance.push(eased, path, hits_of_frames(hit, len(path)), strength)
            path, hit, least = self._limited(task, eased, least)
            if not hit.any():
                break
        begin_rad = task.begin.position_rad
        if hit.any() and task.allowed is not None:
            # The start is within the margin and blocks the motion: first leave it.
            eased = eased.copy()
            eased[:_AWAY_FRAMES] = self._avoidance.push_out(begin_rad[None], begin_rad)[0]
            path, hit, least = self._limited(task, eased, least)
        if hit.any():
            return self._stop_before_contact(path, hit, task.period, task.allowed), interventions
        better = self._refined(task, path, least, is_free=True)
        return (better[0] if better is not None and better[1] < 0 else path), interventions

    def _still(self, task: _Task, path: Array) -> Array:
        """The path, but with arms that brake at once and then hold; head and waist go on, and may bring a contact."""
        still = path.copy()
        still[:, self._arms] = held(path[:2], task.period, len(path), self._limits)[: len(path), self._arms]
        return still

    def _nearest(self, task: _Task, found: list[Array]) -> Array:
        """The path whose arms are nearest to the poses."""

        def distance(control: Array) -> float:
            frames = (control[1:-1] + control[2:])[: len(task.posed)] / 2
            return float(((frames - task.posed[: len(frames)])[:, self._arms] ** 2).sum())

        return min(found, key=distance)

    def _refined(
        self, task: _Task, path: Array, least: LeastDistances, *, is_free: bool = False
    ) -> tuple[Array, float] | None:
        """A path without contact near the limiter's `path`, and the increase of a frame's cost; None if none was found.

        With `is_free` that path is without contact itself, or nearly so, and of the free paths near it the best is found.
        """
        if not (task.shown and self._refiner):
            return None
        n_frames, period, keep = len(task.posed), task.period, task.keep
        stop = braking(path, period, self._limits)
        tail = max(len(stop), _SETTLE_FRAMES if task.settle else self._braking_frames(period))
        end = stop[-1:] if len(stop) else path[-1:]
        start = np.concatenate([path, stop, np.repeat(end, tail - len(stop), 0)])

        def cut(control: Array) -> Array:
            return self._settled(control, n_frames + 2, period) if task.settle else control[: n_frames + 2]

        def touching(control: Array, least: LeastDistances, seen: Seen) -> NDArray[np.bool_]:
            found, hit = cut(control), np.zeros(len(control) - 2, bool)
            if task.settle:
                of_path, _ = self._contact.along_near(found, task.allowed, least, seen)
            else:
                of_path, _ = self._cut_hits(task, found, least, seen)
                if keep < n_frames and of_path[keep - 1]:
                    hit[max(keep - _AROUND_CUT, 0) : keep + _AROUND_CUT] = True
            n = min(len(hit), len(of_path))
            hit[:n] |= of_path[:n]
            hit[n - 1] |= of_path[n:].any()
            return hit

        n_needed = keep if keep < n_frames else len(start) - 2
        brakes_after = () if task.settle else (n_frames,) if keep == n_frames else (keep, n_frames)
        paths = self._refiner.free_paths(start, task.shown, n_frames, period, touching, least, n_needed, brakes_after)
        found = best_of(paths, -np.inf if is_free else _ENOUGH)
        if found is None:
            return None
        control, worse = found
        of_path = control if task.settle else control[: n_frames + 2]  # what follows brakes as hard as the limits allow
        inside = kept(of_path[2:], control[1], (control[1] - control[0]) / period, self._limits, period)
        return (cut(control), worse) if inside[self._arms].all() else None

    def _braking_frames(self, period: float) -> int:
        """Frames in which every joint comes to rest from any speed, and one more."""
        limits = self._limits
        return int(np.ceil((limits.velocity_rad_s / (limits.acceleration_rad_s2 * period)).max())) + 1

    def _cut_hits(
        self, task: _Task, points: Array, least: LeastDistances, seen: Seen | None = None
    ) -> tuple[NDArray[np.bool_], LeastDistances]:
        """Segments that touch when the path brakes at its end or after `keep` frames, and bounds of the distances on the path."""
        keep, period = task.keep, task.period
        whole = np.concatenate([points, braking(points, period, self._limits)])
        hit, least = self._contact.along_near(whole, task.allowed, least, seen)
        if keep < len(task.posed):
            cut = points[: keep + 2]
            stop = np.concatenate([cut[-2:], braking(cut, period, self._limits)])
            hit[keep - 1] |= self._contact.along_near(stop, task.allowed, least.part(slice(keep, None)))[0].any()
        return hit, least

    def _settled(self, points: Array, least: int, period: float) -> Array:
        """Control points (N, J) up to the first standstill after `least` of them, at rest at the end."""
        moves = np.abs(np.diff(points[least - 1 :], axis=0)).max(1) > _STILL_RAD
        still = np.flatnonzero(~moves)
        last = least + (int(still[0]) if len(still) else len(moves))
        return held(points[:last], period, last + 1, self._limits)

    def _stop_before_contact(
        self, path: Array, hit: NDArray[np.bool_], period: float, allowed: Allowed | None
    ) -> Array:
        """The path, braked before its first contact and then held; the last resort."""
        first = int(hit.argmax())
        back = 1
        while True:
            n_kept = max(2, min(first + 2 - back, len(path)))
            stopped = held(path[:n_kept], period, len(path), self._limits)
            if n_kept == 2 or not self._contact.along(stopped, allowed).any():
                return stopped
            back *= 2

    def _limited(
        self, task: _Task, eased: Array, least: LeastDistances
    ) -> tuple[Array, NDArray[np.bool_], LeastDistances]:
        """`_path`, its touching segments, and bounds of distances.

        Contacts while braking after `keep` frames or at the end count too, but for a path that settles.
        """
        settled_rad = _PUSHED_SETTLED_RAD if np.any(eased != task.posed) else SETTLED_RAD
        points = self._path(task, eased, settled_rad)
        if task.settle:
            return points, *self._contact.along_near(points, task.allowed, least)
        return points, *self._cut_hits(task, points, least)

    def _path(self, task: _Task, eased: Array, settled_rad: float = SETTLED_RAD) -> Array:
        """Control points of a path near `eased` (T, J) that keeps every limit.

        The differences of `eased` from the poses have the largest weight. When settling, the last pose is held until reached.
        """
        wanted, shown, led = controls_near(eased, task.before), eased, eased - task.posed
        half = task.begin.velocity_rad_s * (task.period / 2)
        before, position = task.begin.position_rad - half, task.begin.position_rad + half
        if task.settle:
            every = (wanted, shown, led)
            wanted, shown, led = (np.concatenate([x, np.repeat(x[-1:], _SETTLE_FRAMES, 0)]) for x in every)

        def objective_from(k: int) -> Objective:
            return self._objective(shown[k:], led[k:])

        rest = joined(wanted, before, position, task.period, self._limits, objective_from, settled_rad)
        points = np.concatenate([[before], rest])
        return self._settled(points, len(points) - _SETTLE_FRAMES, task.period) if task.settle else points
