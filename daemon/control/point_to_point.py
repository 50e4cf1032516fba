"""The slow move of arming and parking: from wherever the robot stands, by a way that keeps off its own body."""

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
"""Pieces of the search for a way in a second: one or a few in a cycle."""
HELD_S, SEARCHES = 0.5, 3
"""Seconds that the gate holds the move before a way is searched for anew, and the number of searches."""
NO_WAY_LIMP_S = 10.0
"""Seconds that a robot for which no free way was found holds in a fault before it goes limp."""


class PointToPointMove:
    """Comes to rest, looks for a way that is free, and goes it; a step in each bus cycle.

    Args:
        robot: whose.
        contact: its body.
        gate: every goal passes it.

    Attributes:
        setpoint_rad: (J,) where it should be now; None before there is a way.
        arrived: whether it is there, and has stayed as long as it should.
        blocked: the search that found no way, or the last of too many; None while there is hope.
    """

    def __init__(self, robot: RobotModel, contact: SelfContact, gate: SafetyLimiter) -> None:
        self._robot, self._contact, self._gate = robot, contact, gate
        self._period_s = robot.bus.period_s
        self._pieces = max(1, round(SEARCH_PIECES_PER_S * robot.bus.period_s))
        self.begin()

    def begin(self) -> None:
        """Forget the way: the next step begins anew from where the robot stands then."""
        self._approach: PtpTrajectory | None = None
        self._search: RrtConnect | None = None
        self._searches = 0
        self._gone_s = self._held_s = 0.0
        self.setpoint_rad: Array | None = None
        self.arrived = False
        self.blocked: RrtConnect | None = None

    def step(self, to_rad: Array, stay_s: float) -> Array:
        """(J,) the next goal on the way to a pose (J,) in which it stays for a while."""
        if self._approach is None:
            goal = self._gate.brake()
            if self._gate.at_rest:
                self._look_for_a_way(to_rad)
            return goal
        self.setpoint_rad = self._approach.at(self._gone_s + self._period_s)
        goal = self._gate.step(self.setpoint_rad)
        if self._gate.held:  # its time stands still with it
            self._held_s += self._period_s
            if self._held_s > HELD_S:
                self._approach = None
            return goal
        self._gone_s += self._period_s
        if self._gone_s > self._approach.duration_s + stay_s and self._gate.at_rest:
            self.arrived, self._approach = True, None
        return goal

    def no_way(self, where: str) -> str:
        """Text of the fault that no way was found to a pose, "rest" or "park"."""
        touching = self.blocked.touching() if self.blocked is not None else ()
        near = ", ".join(f"{a} and {b}" for a, b in touching[:3])
        return (
            f"no free way to the {where} pose: the robot is in its own way{f' ({near})' if near else ''}; it holds, and goes"
            f" limp in {NO_WAY_LIMP_S:g} s; lead its arms clear by hand, then reset and arm"
        )

    def _look_for_a_way(self, to_rad: Array) -> None:
        """Some pieces of the search from where it stands; then the way, or the end of hope."""
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
