"""Torque of the servos: on after arming, off by one packet that is repeated until every servo has received it.

No servo answers the packet that cuts torque. So the packet is sent several times, and once more to any servo that still has torque
in a later reading: a corrupted packet, a lost port or a loose cable then does no harm. Part of the bus process.
"""

from __future__ import annotations

import logging
from contextlib import suppress

import numpy as np
from numpy.typing import NDArray

from daemon.dynamixel.servo_bus import ServoBus
from daemon.errors import LinkError, LinkLostError, ServoFaultError

log = logging.getLogger(__name__)

TORQUE_OFF_REPEATS = 5
"""Number of times that the packet of torque off is sent, once a bus cycle."""
ASKED_AT_END = 3
"""Number of times at most that a servo is asked at the end of the process whether it has torque."""


class TorqueSwitch:
    """Knows whether the servos have torque, and cuts it.

    Attributes:
        on: whether this process has given them torque.
        goal_tick: (S,) goals that the servos hold; None without torque, and where servos must get no goals.
        made_limp: whether this process has cut torque since it was last given.
        may_hold: whether servos may have torque that this process did not give them.

    Args:
        bus: the servos.
    """

    def __init__(self, bus: ServoBus) -> None:
        self._bus = bus
        self.on = self.made_limp = self.may_hold = False
        self.goal_tick: NDArray[np.int32] | None = None
        self._off_left = 0
        self._cut_at_s: float | None = None

    @property
    def has_cut(self) -> bool:
        """Whether torque was cut and all of the packets that cut it went out."""
        return self.made_limp and not self.on and not self._off_left

    @property
    def cut_waits(self) -> bool:
        """Whether torque is to be cut and no such packet has gone out on every port yet."""
        return not self.on and self._off_left == TORQUE_OFF_REPEATS

    def switched_on(self, goal_tick: NDArray[np.int32]) -> None:
        """Arming has given all servos torque, with goals (S,) where they stand."""
        self.on, self.made_limp, self.goal_tick = True, False, goal_tick

    def cut(self) -> None:
        """Send torque off now, and again in the next cycles."""
        try:
            self._bus.send_torque_off()
        except LinkError as error:
            log.error("torque off not sent: %s", error)
        self.cut_by_repeat()

    def cut_by_repeat(self) -> None:
        """Cut torque with the next call of `repeat_off`."""
        self.on, self.made_limp, self.may_hold, self.goal_tick = False, True, False, None
        self._off_left = TORQUE_OFF_REPEATS

    def repeat_off(self) -> None:
        """Send a pending torque off, or repeat it for a servo that has missed it; called once a cycle.

        Raises:
            LinkError: the port does not take the packet that a servo has missed.
        """
        if self.on:
            return
        if self._off_left:
            with suppress(LinkLostError):  # the exchange reports the loss, and reads the other ports
                self._bus.send_torque_off()
                self._off_left -= 1
            return
        holding = np.flatnonzero(self._bus.reading.torque == 1) if self.made_limp else ()
        if len(holding):  # a servo read since then received none of them, a cable may have been loose
            ids = ", ".join(str(self._bus.ids[row]) for row in holding)
            log.warning("servo %s still has torque: torque off is sent again", ids)
            self._bus.send_torque_off()

    def confirm_off(self) -> None:
        """Ask each servo whether it has torque, cut again where one does not deny it, and log those that never do."""
        left = list(self._bus.ids)
        for _ in range(ASKED_AT_END):
            left = [servo_id for servo_id in left if not self._says_it_is_limp(servo_id)]
            if not left:
                return
            with suppress(LinkError):
                self._bus.send_torque_off()
        log.error("servo %s may still have torque: it did not say that it has none", ", ".join(map(str, left)))

    def _says_it_is_limp(self, servo_id: int) -> bool:
        try:
            return self._bus.poll_item(servo_id, "torque_enable") == 0
        except (LinkError, ServoFaultError):  # a lost port keeps nobody from asking the servos of another
            return False

    def cut_at(self, at_s: float) -> None:
        """Schedule a cut for a time, which `cut_is_due` reports unless the fault is over by then."""
        self._cut_at_s = at_s

    def cut_is_due(self, now_s: float, *, in_fault: bool) -> bool:
        """Whether the time of `cut_at` has come; outside a fault, or without torque, the time is forgotten. Called once a cycle."""
        if self._cut_at_s is None:
            return False
        if not self.on or not in_fault:
            self._cut_at_s = None
            return False
        return now_s >= self._cut_at_s
