"""Plans a path of straight lines in joint space from one pose to another without self-contact, in small increments of work.

The planner first tries the straight line. If the robot itself is in the way, two trees of free poses grow towards each other from
both ends (RRT-Connect: Kuffner, LaValle 2000), and the path found is shortened. `work` does one small increment, so that a loop
with a deadline plans between its cycles. From a start within the margin the path first leads out: pairs that are too near only move
apart, and no contact deeper than the start's is passed.
"""

from __future__ import annotations

from collections.abc import Generator

import numpy as np
from numpy.typing import NDArray

from retarget.path.collision import SelfContact
from retarget.path.limits import JointLimits
from retarget.robot.robot import RobotModel

Array = NDArray[np.float64]
Pieces = Generator[None, None, list[Array] | None]
SHARES = (0.8, 0.5)
"""Shares of the margin that a path keeps: the share of all paths, then a smaller one if no path was found."""
TRIES = 800
"""Branches that are tried at each share before the search fails."""
PIECE_RAD = 0.25
"""Radians of the fastest joint in one piece of a line, which is proved free in one increment of work."""
_BRANCH_RAD = 0.5
_SHORTCUTS = 20
_OUT_STEPS, _OUT_RAD, _OUT_M = 60, 0.06, 0.001
"""Steps out of the margin: their largest number, radians of each joint in one step, and metres of room after the last."""
_OUT_SHRINKS = (1.0, 0.4, 0.1)
_OUT_TURNS = 12
_NEARER_M = 1e-6
_DAMPING = 1e-4


class RrtConnect:
    """One search for a path. It uses no clock, so equal arguments give equal paths.

    Args:
        robot: the robot; the search may move its arms independently.
        contact: distances between the robot's shapes.
        start_rad: (J,) pose at the start, at rest.
        goal_rad: (J,) pose at the goal.
        seed: seed of the random poses.

    Attributes:
        done: whether the search has ended.
        way: poses (J,) from start to goal, joined by straight lines; None before the end, and if no path was found.
        pieces: increments of work so far.
    """

    def __init__(
        self, robot: RobotModel, contact: SelfContact, start_rad: Array, goal_rad: Array, seed: int = 0
    ) -> None:
        self._contact, self._limits = contact, JointLimits.of(robot)
        self._start, self._goal = start_rad.copy(), goal_rad.copy()
        self._draw = np.random.default_rng(seed)
        sides = np.array([j.role.partition("_")[0] for j in robot.joints])
        self._groups = [
            np.flatnonzero(g) for g in (sides == "left", sides == "right", ~np.isin(sides, ("left", "right")))
        ]
        self._share = SHARES[0]
        self._steps = self._search()
        self.done, self.pieces = False, 0
        self.way: list[Array] | None = None

    def work(self) -> bool:
        """Do one increment of work; returns whether the search has ended."""
        if not self.done:
            self.pieces += 1
            try:
                next(self._steps)
            except StopIteration as end:
                self.done, self.way = True, end.value
        return self.done

    def touching(self) -> list[tuple[str, str]]:
        """Names of the bodies that are too near each other at the start, else at the goal, for people."""
        return self._contact.pairs(self._start) or self._contact.pairs(self._goal)

    def _search(self) -> Pieces:
        for self._share in SHARES:
            if (self._contact.slack_m(self._goal, self._share) <= 0).any():
                continue
            out = yield from self._way_out()
            if out is None:
                continue
            if (yield from self._free(out[-1], self._goal)):
                return [*out, self._goal]
            round_it = yield from self._connect(out[-1], self._goal)
            if round_it is not None:
                return [*out[:-1], *(yield from self._shortened(round_it))]
        return None

    # Lines.

    def _free(self, a: Array, b: Array) -> Generator[None, None, bool]:
        """Whether the line from `a` to `b` keeps the share of the margin; one piece an increment."""
        n = max(1, int(np.ceil(np.abs(b - a).max() / PIECE_RAD)))
        ends = a + np.linspace(0.0, 1.0, n + 1)[:, None] * (b - a)
        for i in range(n):
            yield
            if not self._contact.clear_along(ends[i : i + 2], self._share):
                return False
        return True

    def _shortened(self, way: list[Array]) -> Generator[None, None, list[Array]]:
        """The path without corners that a straight line can replace."""
        for _ in range(_SHORTCUTS):
            if len(way) < 3:
                break
            i, k = sorted(int(x) for x in self._draw.choice(len(way), 2, replace=False))
            if k > i + 1 and (yield from self._free(way[i], way[k])):
                way = [*way[: i + 1], *way[k:]]
        at = 0
        while at + 2 < len(way):  # remaining corners
            if (yield from self._free(way[at], way[at + 2])):
                del way[at + 1]
            else:
                at += 1
        return way

    # Trees.

    def _connect(self, start: Array, goal: Array) -> Pieces:
        """A path from `start` to `goal`, both free; None when none was found."""
        here, there = _Tree(start), _Tree(goal)
        forward = True
        for _ in range(TRIES):
            grown = yield from self._grow(here, self._drawn(start, goal))
            if grown is not None:
                met = yield from self._reach(there, here.poses[grown])
                if met is not None:
                    a, b = here.back_from(grown), there.back_from(met)
                    way = [*a[::-1], *b[1:]]
                    return way if forward else way[::-1]
            here, there, forward = there, here, not forward
        return None

    def _drawn(self, start: Array, goal: Array) -> Array:
        """A random pose to grow towards: each arm and the trunk anywhere, or as at the start or at the goal."""
        q = (start if self._draw.random() < 0.5 else goal).copy()
        anywhere = self._draw.uniform(self._limits.position_min_rad, self._limits.position_max_rad)
        for group in self._groups:
            if self._draw.random() < 0.6:
                q[group] = anywhere[group]
        return q

    def _grow(self, tree: _Tree, towards: Array) -> Generator[None, None, int | None]:
        """Index of a new pose of the tree, one branch nearer to `towards`; None when the branch would touch."""
        near = tree.nearest(towards)
        gap = towards - tree.poses[near]
        far = float(np.abs(gap).max())
        if far == 0:
            return near
        pose = towards if far <= _BRANCH_RAD else tree.poses[near] + gap * (_BRANCH_RAD / far)
        return tree.add(pose, near) if (yield from self._free(tree.poses[near], pose)) else None

    def _reach(self, tree: _Tree, pose: Array) -> Generator[None, None, int | None]:
        """Index of `pose` in the tree, reached branch by branch; None when a branch would touch."""
        while (grown := (yield from self._grow(tree, pose))) is not None:
            if np.array_equal(tree.poses[grown], pose):
                return grown
        return None

    # Out of the margin.

    def _way_out(self) -> Pieces:
        """Poses from the start to one outside the margin; None when none was found."""
        low, high = self._limits.position_min_rad, self._limits.position_max_rad
        q, way = self._start, [self._start]
        for _ in range(_OUT_STEPS):
            room = self._contact.slack_m(q, self._share)
            if (room > 0).all():
                return self._straightened(way)
            yield
            lack = np.flatnonzero(room <= _OUT_M)
            slopes = np.stack([self._contact.nearest(q[None], lack[i : i + 1])[1][0] for i in range(len(lack))])
            matrix = slopes @ slopes.T + _DAMPING * np.eye(len(lack))
            push = slopes.T @ np.linalg.solve(matrix, 2 * _OUT_M - room[lack])
            for push_to in (push, *self._other_pushes(np.abs(slopes).max(0) > 0)):
                scaled = push_to * (_OUT_RAD / max(np.abs(push_to).max(), _OUT_RAD / 2))
                following = self._outward(q, scaled, np.minimum(low, q), np.maximum(high, q))
                yield
                if following is not None:
                    break
            else:
                return None
            q = following
            way.append(q)
        return None

    def _other_pushes(self, moves: NDArray[np.bool_]) -> list[Array]:
        """Alternatives to the direct push: each joint that `moves` alone, and random directions of all of them."""
        single = np.eye(len(moves))[moves]
        return [*single, *-single, *self._draw.normal(size=(_OUT_TURNS, len(moves))) * moves]

    def _outward(self, q: Array, push: Array, low: Array, high: Array) -> Array | None:
        """A pose along `push` (J,) to which no pair within the margin comes nearer; None when there is none."""
        for shrink in _OUT_SHRINKS:
            pose = np.clip(q + shrink * push, low, high)
            if (pose != q).any() and self._only_parts(q, pose):
                return pose
        return None

    def _only_parts(self, a: Array, b: Array) -> bool:
        """Whether on the line from `a` to `b` at least one pair within the margin moves apart and no pair comes nearer."""
        n = max(1, int(np.ceil(np.abs(b - a).max() / _OUT_RAD)))
        looks = np.linspace(0.0, 1.0, 4 * n + 1)[:, None]
        room = np.minimum(self._contact.slacks_m(a + looks * (b - a), self._share), 0.0)
        parted = room[-1].sum() > room[0].sum() + _NEARER_M
        return bool(parted and (np.diff(room, axis=0) >= -_NEARER_M).all())

    def _straightened(self, way: list[Array]) -> list[Array]:
        """The path out of the margin with corners removed where possible."""
        short, at = way[:1], 0
        while at < len(way) - 1:
            at = next(k for k in range(len(way) - 1, at, -1) if k == at + 1 or self._only_parts(way[at], way[k]))
            short.append(way[at])
        return short


class _Tree:
    """Tree of poses, each with the index of its parent."""

    def __init__(self, root: Array) -> None:
        self.poses, self._parents = [root], [-1]

    def add(self, pose: Array, parent: int) -> int:
        """Index of a new pose."""
        self.poses.append(pose)
        self._parents.append(parent)
        return len(self.poses) - 1

    def nearest(self, pose: Array) -> int:
        """Index of the pose nearest to `pose`."""
        return int(((np.array(self.poses) - pose) ** 2).sum(1).argmin())

    def back_from(self, index: int) -> list[Array]:
        """Poses from the one at `index` back to the root."""
        way = [self.poses[index]]
        while (index := self._parents[index]) >= 0:
            way.append(self.poses[index])
        return way
