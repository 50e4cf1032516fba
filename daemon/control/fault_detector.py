"""Finds faults of servos with torque in their answers. Part of the bus process.

A servo that was silent for as long as its bus watchdog takes may have been stopped by the watchdog while the others moved on. Such
a servo answers normally and refuses every goal, so its watchdog is read as soon as it answers again.
"""

from __future__ import annotations

import logging

import numpy as np
from numpy.typing import NDArray

from daemon.control.arming import WATCHDOG_UNITS
from daemon.control.pinning import refuse_hardware_errors
from daemon.dynamixel.reading import BusReading
from daemon.dynamixel.registers.registers import WATCHDOG_TRIPPED, WATCHDOG_UNIT_S
from daemon.dynamixel.servo_bus import ServoBus
from retarget.robot.robot import RobotModel

log = logging.getLogger(__name__)

MISSING_CYCLES = 20
"""Bus cycles in a row with half of the servos silent that count as a fault (loose plug, power)."""
TORQUE_CHECK_CYCLES = 5
MAY_HAVE_TRIPPED_S = 0.75 * WATCHDOG_UNITS * WATCHDOG_UNIT_S
"""Seconds without a packet after which a servo's watchdog may have run out."""


class FaultDetector:
    """Judges each reading of a robot with torque and describes its fault, if any."""

    def __init__(self, robot: RobotModel, bus: ServoBus) -> None:
        self._robot, self._bus = robot, bus
        self._period_s = robot.bus.period_s
        self._missing_cycles = self._cycle = 0
        self._silent_s = np.zeros(len(bus.ids))
        self._fed_s = 0.0

    def armed(self, now_s: float) -> None:
        """Forget silences from before torque came on; called at the moment when it does."""
        self._missing_cycles = 0
        self._silent_s[:] = 0.0
        self._fed_s = now_s

    def stalled(self, now_s: float, *, driven: bool) -> str:
        """Reason why a pause of the bus process is a fault, once a cycle; empty for no fault, and where servos get no goals.

        Raises:
            LinkError: a servo does not say whether its watchdog has run out.
        """
        pause_s, self._fed_s = now_s - self._fed_s, now_s
        if not driven or pause_s < MAY_HAVE_TRIPPED_S:
            return ""
        tripped = self._bus.tripped_watchdogs()
        if not tripped:
            return ""
        return f"the bus process was held up for {pause_s:.2f} s: servo {tripped[0]} stopped by its watchdog"

    def fault(self, reading: BusReading) -> str:
        """Reason why the reading of a cycle with torque is a fault; empty when it is none.

        Raises:
            ServoFaultError: a servo reports a hardware error.
            LinkError: a question that had to be asked was not answered.
        """
        self._cycle += 1
        silent = int((~reading.valid).sum())
        self._missing_cycles = self._missing_cycles + 1 if silent * 2 >= len(reading.valid) else 0
        if self._missing_cycles >= MISSING_CYCLES:
            return f"{silent} of {len(reading.valid)} servos are silent; check cable and power"
        refuse_hardware_errors(self._bus, reading)
        withheld: list[int] = np.flatnonzero(self._bus.withheld).tolist()
        if withheld:
            names = ", ".join(self._name(row) for row in withheld[:3])
            return (
                f"servo {names} silent: it may have lost power, and the next goal would switch its torque on wherever it"
                " hangs, so it gets none; check cable and power, then reset and arm"
            )
        return self._tripped(reading) or self._lost_torque(reading)

    def withhold_tripped(self, reading: BusReading) -> None:
        """Send no more goals to servos that their watchdog stopped during a fault: they refuse goals. The others hold.

        Raises:
            LinkError: a question that had to be asked was not answered.
        """
        if why := self._tripped(reading):
            log.warning("%s", why)

    def _tripped(self, reading: BusReading) -> str:
        """Description of a servo that is back after a silence and was stopped by its watchdog meanwhile; empty for none."""
        was_silent_s = self._silent_s.copy()
        self._silent_s += self._period_s
        self._silent_s[reading.valid] = 0.0
        back = np.flatnonzero(reading.valid & (was_silent_s >= MAY_HAVE_TRIPPED_S))
        tripped = [int(row) for row in back if self._has_tripped(int(row), was_silent_s)]
        if not tripped:
            return ""
        self._bus.withhold([self._bus.ids[row] for row in tripped])
        row = tripped[0]
        return (
            f"servo {self._name(row)} was silent for {was_silent_s[row]:.2f} s and has stopped by its watchdog; check its"
            " cable, then reset and arm"
        )

    def _has_tripped(self, row: int, was_silent_s: NDArray[np.float64]) -> bool:
        if "bus_watchdog" not in self._bus.models[row].table:
            return False
        found = self._bus.poll_item(self._bus.ids[row], "bus_watchdog")
        if found is None:
            self._silent_s[row] = was_silent_s[row]  # read its watchdog again
        return found == WATCHDOG_TRIPPED

    def _lost_torque(self, reading: BusReading) -> str:
        """Read `torque_enable` of one servo a call, in turn; returns a description if it has lost its torque, else empty."""
        if self._cycle % TORQUE_CHECK_CYCLES:
            return ""
        row = self._cycle // TORQUE_CHECK_CYCLES % len(self._bus.ids)
        if reading.valid[row] and self._bus.poll_item(self._bus.ids[row], "torque_enable") == 0:
            return f"servo {self._name(row)} lost its torque; it may have tripped or rebooted"
        return ""

    def _name(self, row: int) -> str:
        return f"{self._bus.ids[row]} ({self._robot.servos[row].joint_name})"
