"""Counts self-contact of the commanded poses and of the measured ones, apart from each other.

A commanded pose consists of the last goal sent to each servo, also where the goal was lost on the wire or refused: a servo that is
stuck, limp or deaf leads to a pose that no goals commanded. Such a pose may be in contact when torque comes on in it; that contact
is inherited as long as it only grows shallower, and is counted by itself.
"""

from __future__ import annotations

import threading
from array import array
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from retarget.path.collision import SelfContact
from retarget.robot.robot import RobotModel
from retarget.robot.ticks import JointServoMap

Array = NDArray[np.float64]
EVERY = 5
"""Number of sets of goals of which one is checked; the first set after torque came on always is."""
ROUNDED_M = 0.002
"""Metres by which a contact may seem to grow deeper: goals are whole ticks."""
_MAX_POSES = 500_000
_POSES_AT_ONCE = 1000
_MAX_DETAILS = 20


class ContactAudit:
    """Collects poses of one robot and checks them later, all at once; one thread may collect while another checks.

    Args:
        robot: the robot.
        measure: returns the servos' true ticks, in the order of the robot file; None to check goals alone.

    Attributes:
        checked: number of poses that were checked.
        commanded: commanded poses with a contact that is not inherited.
        inherited: commanded poses whose contacts were all there when torque came on, none deeper since.
        measured: measured poses in contact, from any cause.
        details: the first of `commanded` in words.
    """

    def __init__(self, robot: RobotModel, measure: Callable[[], list[int]] | None = None) -> None:
        self._robot, self._measure = robot, measure
        self._ticks = JointServoMap(robot)
        self._told: dict[int, int] = {}
        self._pinned: dict[int, int] = {}
        self._goals, self._true = array("i"), array("i")  # ticks of poses, one after another
        self._times, self._starts = array("d"), array("i")
        self._sets = 0
        self._collecting = threading.Lock()
        self._contact: SelfContact | None = None
        self._heir: NDArray[np.bool_] = np.zeros(0, bool)
        self._shallowest: Array = np.zeros(0)
        self.checked = self.commanded = self.inherited = self.measured = 0
        self.details: list[str] = []

    def begin(self, servo_id: int, goal_tick: int) -> None:
        """Record that torque came on over a goal."""
        with self._collecting:
            self._told[servo_id] = self._pinned[servo_id] = goal_tick

    def told(self, t_s: float, servo_id: int, tick: int, torque: bool) -> None:
        """Record a goal that was sent; with torque on, the last servo's goal completes a pose."""
        with self._collecting:
            self._told[servo_id] = tick
            if torque and servo_id == self._robot.servo_ids[-1] and len(self._told) == len(self._robot.servo_ids):
                self._complete(t_s)

    def _complete(self, t_s: float) -> None:
        """Keep the pose that was told, if it is one of those to be checked."""
        self._sets += 1
        if len(self._times) >= _MAX_POSES:
            return
        if self._pinned:
            self._starts.append(len(self._times))
            self._keep(t_s, self._told | self._pinned)
            self._pinned = {}
        if not self._sets % EVERY:
            self._keep(t_s, self._told)

    def _keep(self, t_s: float, pose: dict[int, int]) -> None:
        self._times.append(t_s)
        self._goals.extend(pose[i] for i in self._robot.servo_ids)
        if self._measure is not None:
            self._true.extend(self._measure())

    def check(self) -> None:
        """Check the poses collected so far, and forget them: for runs of hours."""
        with self._collecting:
            goals, self._goals = self._goals, array("i")
            true_ticks, self._true = self._true, array("i")
            times, self._times = self._times, array("d")
            starts, self._starts = self._starts, array("i")
        if not times:
            return
        if self._contact is None:
            self._contact = SelfContact(self._robot, margin_m=0.0)
        n = len(self._robot.servo_ids)
        told, true = (np.array(a, np.int32).reshape(-1, n) for a in (goals, true_ticks))
        cuts = sorted({0, len(told), *starts, *range(0, len(told), _POSES_AT_ONCE)})
        begins = set(starts)
        for a, b in pairwise(cuts):
            self._judge(told[a:b], times[a:b], begins=a in begins)
            if len(true):
                self.measured += int((self._distances_m(true[a:b]) < 0).any(1).sum())
        self.checked += len(told)

    def report(self) -> dict[str, Any]:
        """All figures as plain values."""
        self.check()
        return {
            "self_contacts": self.commanded,
            "inherited_contacts": self.inherited,
            "measured_contacts": self.measured,
            "poses_checked": self.checked,
            "contact_details": self.details,
        }

    def _distances_m(self, ticks: NDArray[np.int32]) -> Array:
        assert self._contact is not None
        return self._contact.distances_m(self._ticks.tick_to_rad(ticks))

    def _judge(self, ticks: NDArray[np.int32], times_s: array[float], *, begins: bool) -> None:
        """Count the contacts of poses (T, S) that follow each other, the first of them pinned if `begins`."""
        distance = self._distances_m(ticks)
        touching = distance < 0
        if begins or not len(self._heir):
            self._heir = touching[0] if begins else np.zeros_like(touching[0])
            self._shallowest = distance[0]
        # (T, P) whether each pair has touched all the time since torque came on, no deeper than before.
        best = np.maximum.accumulate(np.vstack([self._shallowest, distance]), 0)
        heir = np.logical_and.accumulate(
            np.vstack([self._heir, touching & (distance >= best[:-1] - ROUNDED_M)]), 0
        )[1:]  # fmt: skip
        self._heir, self._shallowest = heir[-1], best[-1]
        own = (touching & ~heir).any(1)
        self.commanded += int(own.sum())
        self.inherited += int((touching.any(1) & ~own).sum())
        for k in np.flatnonzero(own)[: _MAX_DETAILS - len(self.details)]:
            self.details.append(f"{times_s[k]:.3f} s: {self._named(ticks[k])}")

    def _named(self, ticks: NDArray[np.int32]) -> str:
        assert self._contact is not None
        depth_m = -self._distances_m(ticks[None]).min()
        pairs = self._contact.pairs(self._ticks.tick_to_rad(ticks[None])[0])
        return f"{', '.join(f'{a} and {b}' for a, b in pairs)}, {1e3 * depth_m:.1f} mm deep"
