"""The slow move of arming and parking: from the present pose, along a path without self-contact."""

from __future__ import annotations

import logging

import numpy as np
from numpy.typing import NDArray

from daemon.control.ptp_trajectory import PtpTrajectory
from daemon.control.safety_limiter import SafetyLimiter
from retarget.path.collision import SelfContact
from retarget.path.rrt_connect import RrtConnect
from retarget.robot.robot import RobotModel

log = logging.getLogger(__name__)

Array = NDArray[np.float64]
SEARCH_PIECES_PER_S = 200
"""Steps of the path search per second; a bus cycle makes one or a few of them."""
HELD_S, SEARCHES = 0.5, 3
"""Seconds that the gate holds the move before a new path is searched, and the number of searches."""
NO_WAY_LIMP_S = 10.0
"""Seconds that a robot without a free path holds in a fault before it goes limp."""


class PointToPointMove:
    """Comes to rest, searches a free path and follows it; one step in each bus cycle.

    Args:
        robot: the robot to move.
        contact: model of the robot's body.
        gate: every goal passes it.

    Attributes:
        setpoint_rad: (J,) setpoint of this cycle; None before a path is found.
        arrived: whether the robot has reached the pose and stayed there for the requested time.
        blocked: the search that found no path, or the last one allowed; None before that.
    """

    def __init__(self, robot: RobotModel, contact: SelfContact, gate: SafetyLimiter) -> None:
        self._robot, self._contact, self._gate = robot, contact, gate
        self._period_s = robot.bus.period_s
        self._pieces = max(1, round(SEARCH_PIECES_PER_S * robot.bus.period_s))
        self.begin()

    def begin(self) -> None:
        """Forget the path: the next step begins anew from the robot's position at that time."""
        self._approach: PtpTrajectory | None = None
        self._search: RrtConnect | None = None
        self._searches = 0
        self._gone_s = self._held_s = 0.0
        self.setpoint_rad: Array | None = None
        self.arrived = False
        self.blocked: RrtConnect | None = None

    def step(self, to_rad: Array, stay_s: float) -> Array:
        """(J,) next goal on the path to a pose (J,) in which the robot stays for `stay_s` seconds."""
        if self._approach is None:
            goal = self._gate.brake()
            if self._gate.at_rest:
                self._look_for_a_way(to_rad)
            return goal
        self.setpoint_rad = self._approach.at(self._gone_s + self._period_s)
        goal = self._gate.step(self.setpoint_rad)
        if self._gate.held:  # the move's time stops while the gate holds it
            self._held_s += self._period_s
            if self._held_s > HELD_S:
                self._approach = None
            return goal
        self._gone_s += self._period_s
        if self._gone_s > self._approach.duration_s + stay_s and self._gate.at_rest:
            self.arrived, self._approach = True, None
        return goal

    def no_way(self, where: str) -> str:
        """Text of the fault that no path was found to a pose, `where` being "rest" or "park"."""
        touching = self.blocked.touching() if self.blocked is not None else ()
        near = ", ".join(f"{a} and {b}" for a, b in touching[:3])
        return (
            f"no free way to the {where} pose: the robot is in its own way{f' ({near})' if near else ''}; it holds, and goes"
            f" limp in {NO_WAY_LIMP_S:g} s; lead its arms clear by hand, then reset and arm"
        )

    def _look_for_a_way(self, to_rad: Array) -> None:
        """Make some steps of the search from the present pose; then set the path, or `blocked`."""
        if self._search is None:
            self._search = RrtConnect(self._robot, self._contact, self._gate.position_rad, to_rad)
            self._searches += 1
        for _ in range(self._pieces):
            if self._search.work():
                break
        else:
            return
        search, self._search = self._search, None
        if search.way is None or self._searches > SEARCHES:
            self.blocked = search
            return
        log.info("way of %d lines, %d pieces", len(search.way) - 1, search.pieces)
        self._approach, self._gone_s, self._held_s = PtpTrajectory(search.way, self._gate.limits), 0.0, 0.0
