"""The watch on a silent front: the robot holds, then parks; in a fault or e-stop it goes limp. Part of the bus process."""

from __future__ import annotations

import logging
from enum import Enum

from daemon.shared_memory.bus_link import BusLink, BusState

log = logging.getLogger(__name__)

HEARTBEAT_LOST_S = 0.5
"""Seconds without a heartbeat of the front after which the robot decelerates and holds."""
PARK_AFTER_S = 5.0
"""Seconds without a heartbeat of the front, and since the last stop, after which the robot parks and goes limp."""
FAULT_LIMP_S = 10.0
"""Seconds without a heartbeat of the front after which servos with torque in a fault or e-stop go limp: no operator can reset them.
"""


class FrontLoss(Enum):
    """Reaction of the bus process to a silent front."""

    HOLD = "hold"
    PARK = "park"
    LIMP = "limp"


class FrontWatch:
    """Follows the front's heartbeat, one step a bus cycle.

    Args:
        link: shared memory with the heartbeat.
    """

    def __init__(self, link: BusLink) -> None:
        self._link = link
        self._is_lost = False
        self._stopped_s = float("-inf")

    def stopped(self, now_s: float) -> None:
        """Take note of a stop that was asked for: the robot holds for a while before it parks."""
        self._stopped_s = now_s

    def step(self, state: BusState, now_s: float, *, watched: bool) -> FrontLoss | None:
        """The reaction due in this cycle; None for no reaction, where `watched` is false, and while the robot parks."""
        if not watched or state is BusState.PARKING:
            self._is_lost = False
            return None
        age_s = self._link.heartbeat_age_s
        if state in (BusState.FAULT, BusState.ESTOP):
            if age_s <= FAULT_LIMP_S:
                return None
            log.warning("in %s and the front silent for %.1f s: torque off", state.name.lower(), age_s)
            return FrontLoss.LIMP
        if age_s < HEARTBEAT_LOST_S:
            self._is_lost = False
            return None
        if age_s > PARK_AFTER_S:
            if now_s - self._stopped_s <= PARK_AFTER_S:
                return None
            log.warning("front silent for %.1f s: parking", age_s)
            return FrontLoss.PARK
        if self._is_lost:
            return None
        self._is_lost = True
        log.warning("front silent for %.1f s: holding", age_s)
        return FrontLoss.HOLD
