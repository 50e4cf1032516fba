"""The servos' last measurements, with age and validity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

NEVER_CYCLES = 1 << 20
UNKNOWN = -1
"""Value of a slow register that was not read yet."""


@dataclass
class BusReading:
    """The servos' last measurements; rows follow the servos of the bus.

    Attributes:
        position_tick, velocity_raw, current_raw: (S,) int32 in register units; the last known values. `current_raw`
            is the load in 0.1 % where a servo measures no current.
        valid: (S,) whether these values are from this cycle.
        age_cycles: (S,) cycles since the values were measured.
        read_s: (S,) clock time at which the values were requested, seconds; -inf before the first.
        error: (S,) error byte of the last answer; bit 7 is the hardware alert, in both protocols.
        torque, hardware_error, voltage_raw, temperature_c: (S,) slow registers, read in turn; UNKNOWN before the first.
            `voltage_raw` in 0.1 V; `hardware_error` holds bits, of DYNAMIXEL-Y a code; `temperature_c` of the motor, and
            of Y's inverter less what it may be hotter, whichever is more.
        slow_read_s: (S,) clock time at which the slow registers were requested, seconds.
    """

    position_tick: NDArray[np.int32]
    velocity_raw: NDArray[np.int32]
    current_raw: NDArray[np.int32]
    valid: NDArray[np.bool_]
    age_cycles: NDArray[np.int32]
    read_s: NDArray[np.float64]
    error: NDArray[np.uint8]
    torque: NDArray[np.int32]
    hardware_error: NDArray[np.int32]
    voltage_raw: NDArray[np.int32]
    temperature_c: NDArray[np.int32]
    slow_read_s: NDArray[np.float64]

    @classmethod
    def of(cls, n: int) -> BusReading:
        """A reading of `n` servos without any values yet."""

        def numbers(value: int) -> NDArray[np.int32]:
            return np.full(n, value, np.int32)

        def never() -> NDArray[np.float64]:
            return np.full(n, -np.inf)

        return cls(
            numbers(0), numbers(0), numbers(0), np.zeros(n, bool), numbers(NEVER_CYCLES), never(), np.zeros(n, np.uint8),
            numbers(UNKNOWN), numbers(UNKNOWN), numbers(UNKNOWN), numbers(UNKNOWN), never(),
        )  # fmt: skip

    def age_s(self, now_s: float) -> NDArray[np.float64]:
        """(S,) seconds since each servo's values were requested."""
        return now_s - self.read_s
