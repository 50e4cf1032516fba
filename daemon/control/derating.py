"""Slows motion down before a servo trips: by temperature, by supply voltage, by lasting current. Part of the bus process; no I/O.

The running motion slows down along its own path, for all joints alike, so that it stays free of self-contact and ends later; stops
and the gate keep their full speed. The share of full speed changes slowly, and `status` reports it with its cause.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from daemon.dynamixel.reading import UNKNOWN, BusReading
from daemon.dynamixel.registers.models import BusModel
from daemon.errors import CommandError
from retarget.robot.robot import RobotModel

Array = NDArray[np.float64]

LEAST_SHARE = 0.3
"""Share of full speed at least. A slower motion helps little: gravity heats a raised arm that stands still as well."""
HOT_C, HOTTEST_C = 10.0, 3.0
"""Degrees below the servo's temperature limit at which slowing begins, and at which it is greatest."""
LOW_V, LOWEST_V = 0.5, 0.1
"""Volts above the servo's lower voltage limit at which slowing begins, and at which it is greatest."""
HIGH_CURRENT, HIGHEST_CURRENT = 0.7, 0.95
"""Shares of the current limit (of full load where a servo measures no current) at which slowing begins, and is greatest."""
CURRENT_S, VOLTAGE_S = 2.0, 0.5
"""Seconds, time constants of the means that are judged: a start or a stop may take more current for a moment."""
CHANGE_PER_S = 0.5
FULL_LOAD = 1000
_SLOWING = (
    np.array([[HOTTEST_C], [LOWEST_V], [-HIGHEST_CURRENT]]),
    np.array([[HOT_C], [LOW_V], [-HIGH_CURRENT]]),
)
"""Margins of temperature, voltage and current at which slowing is greatest, and at which it begins."""


class DeratedBy(IntEnum):
    """Causes of derating."""

    NOTHING = 0
    TEMPERATURE = 1
    VOLTAGE = 2
    CURRENT = 3


@dataclass(frozen=True)
class ServoLimits:
    """Limits of S servos as their own registers say; infinite or zero where a servo has none.

    Attributes:
        temperature_c: (S,) temperature at which the servo trips.
        voltage_raw: (S,) voltage below which the servo trips, 0.1 V.
        current_raw: (S,) current limit in the unit of the servo's reading.
    """

    temperature_c: Array
    voltage_raw: Array
    current_raw: Array

    @classmethod
    def none(cls, n: int) -> ServoLimits:
        """Limits of `n` servos about which nothing is known; they cause no derating."""
        return cls(np.full(n, np.inf), np.zeros(n), np.full(n, np.inf))


class Registers(Protocol):
    """The part of a bus that `read_limits` needs."""

    @property
    def ids(self) -> Sequence[int]:
        """Ids of the servos, in the order of the reading."""
        ...

    @property
    def models(self) -> Sequence[BusModel]:
        """Models of the servos, in the same order."""
        ...

    def read_item(self, servo_id: int, name: str) -> int:
        """The value of a register."""
        ...


def read_limits(bus: Registers) -> ServoLimits:
    """Read the limits in the servos' registers; a servo without such a register has no limit there, or full load.

    Raises:
        LinkError, ServoFaultError: a servo does not answer, or with an error.
    """

    def value(servo_id: int, name: str, without: float) -> float:
        try:
            return float(bus.read_item(servo_id, name)) or without
        except CommandError:
            return without

    def values(name: str, without: float) -> Array:
        return np.array([value(servo_id, name, without) for servo_id in bus.ids])

    temperature_c = [
        min(value(servo_id, t.limit, np.inf) - t.above_c for t in model.thermometers)
        for servo_id, model in zip(bus.ids, bus.models, strict=True)
    ]
    return ServoLimits(np.array(temperature_c), values("min_voltage_limit", 0.0), values("current_limit", FULL_LOAD))


class Derating:
    """The share of full speed, updated once a cycle.

    Attributes:
        share: 1 is full speed.
        by: cause of the derating.
        row: row of the servo that needs the lowest share.
    """

    def __init__(self, n_servos: int, period_s: float) -> None:
        self._period_s = period_s
        self.limits = ServoLimits.none(n_servos)
        self._current = np.zeros(n_servos)
        self._voltage = np.full(n_servos, np.nan)
        self.share, self.by, self.row = 1.0, DeratedBy.NOTHING, 0

    def update(self, reading: BusReading) -> bool:
        """Judge a reading; return whether the cause has changed."""
        known_v = reading.voltage_raw != UNKNOWN
        fresh = np.isnan(self._voltage) & known_v
        self._voltage[fresh] = reading.voltage_raw[fresh]
        self._voltage += (self._period_s / VOLTAGE_S) * np.where(known_v, reading.voltage_raw - self._voltage, 0.0)
        load = np.where(reading.valid, np.abs(reading.current_raw), self._current)
        self._current += (self._period_s / CURRENT_S) * (load - self._current)
        hot = reading.temperature_c != UNKNOWN
        below_c = np.where(hot, self.limits.temperature_c - reading.temperature_c, np.inf)
        above_v = np.where(np.isnan(self._voltage), np.inf, 0.1 * (self._voltage - self.limits.voltage_raw))
        shares = _between(np.array([below_c, above_v, -self._current / self.limits.current_raw]), *_SLOWING)
        worst, row = divmod(int(shares.argmin()), shares.shape[1])
        wanted = float(shares[worst, row])
        before = self.by
        self.by, self.row = (DeratedBy(worst + 1), row) if wanted < 1.0 else (DeratedBy.NOTHING, 0)
        step = CHANGE_PER_S * self._period_s
        self.share += min(step, max(-step, wanted - self.share))
        return self.by is not before

    def cause(self, robot: RobotModel) -> str:
        """The cause for the log, with the name of the servo concerned."""
        if not self.by:
            return "full speed again"
        servo = robot.servos[self.row]
        return f"slower: {self.by.name.lower()} of servo {servo.servo_id} ({servo.joint_name})"


def _between(x: Array, low: Array, high: Array) -> Array:
    """Shares that fall from 1 at `high` to `LEAST_SHARE` at `low`."""
    return LEAST_SHARE + (1 - LEAST_SHARE) * np.minimum(np.maximum((x - low) / (high - low), 0.0), 1.0)
