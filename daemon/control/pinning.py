"""Pinning before torque comes on: wait until the joints stand still, then set every servo's goal to its position.

The functions are generators: the bus process runs its cycles between their steps.
"""

from __future__ import annotations

from collections.abc import Generator

import numpy as np
from numpy.typing import NDArray

from daemon.dynamixel.codec.packet import ALERT_BIT
from daemon.dynamixel.reading import BusReading
from daemon.dynamixel.servo_bus import ServoBus
from daemon.errors import ServoFaultError
from daemon.host.clock import Clock

PIN_ATTEMPTS = 3
SWING_OUT_S = 1.0
_STILL_S, _STILL_TICK = 0.02, 2
"""Seconds and ticks: before arming the joints must move less than two ticks in 20 ms, within at most a second."""
_PIN_TICK = 8
"""Ticks between a joint and its pinned goal that are allowed when torque comes on: 0.7 degrees at 4096 ticks a turn."""
_TICKS_PER_TURN = 4096
"""Ticks a turn for which the tick bounds here are given; finer servos (Y, P) may move the same angle, coarser ones the same ticks.
"""


def reading_at_rest(bus: ServoBus, clock: Clock) -> Generator[None, None, BusReading]:
    """Return a complete reading of joints at rest: limp joints swing, and a goal pinned during a swing would jerk.

    If a servo is still silent after a second, the last reading is returned with that servo marked not valid.

    Raises:
        ServoFaultError: a servo still moves after a second.
    """
    still_tick = _ticks(bus, _STILL_TICK)
    reading, began_s = bus.exchange(None), clock.now_s()
    moved = np.zeros(len(bus.ids), np.int32)
    while clock.now_s() - began_s < SWING_OUT_S:
        before, since_s = reading.position_tick.copy(), clock.now_s()
        while clock.now_s() - since_s < _STILL_S:
            yield
        reading = bus.exchange(None)
        moved = np.abs(reading.position_tick - before)
        if reading.valid.all() and (moved <= still_tick).all():
            return reading
    if not reading.valid.all():
        return reading
    row = int((moved / still_tick).argmax())
    raise ServoFaultError(bus.ids[row], f"to stand still for {SWING_OUT_S:g} s", f"moves by {moved[row]} ticks")


def refuse_hardware_errors(bus: ServoBus, reading: BusReading) -> None:
    """Raise ServoFaultError if a servo reports a hardware error."""
    for row in np.flatnonzero(reading.error & ALERT_BIT):
        servo_id = bus.ids[int(row)]
        text = bus.hardware_error_text(servo_id)
        raise ServoFaultError(servo_id, "hardware error status", f"{text}; reboot the servo")


def pin_where_they_stand(
    bus: ServoBus, clock: Clock, reading: BusReading, effort: float
) -> Generator[None, None, NDArray[np.int32]]:
    """(S,) goals pinned to the joints' positions, checked at the end: on a bad wire an arm has time to move meanwhile.

    No bus cycle runs between the last check and the return, so that torque may come on at once.

    Raises:
        ServoFaultError: a servo refuses its goal or reports a hardware error, or a joint moves during every attempt.
    """
    row, pin_tick = 0, _ticks(bus, _PIN_TICK)
    for _ in range(PIN_ATTEMPTS):
        present = reading.position_tick.copy()
        for servo_id, tick in zip(bus.ids, present, strict=True):
            _pin(bus, servo_id, int(tick))
            pinned = bus.read_item(servo_id, "goal_position")
            if pinned != tick:
                raise ServoFaultError(servo_id, f"goal pinned to {tick}", f"goal {pinned}")
        refuse_hardware_errors(
            bus, bus.exchange(None)
        )  # a servo of protocol 1.0 clears its alarm when an effort limit is written
        bus.set_effort(effort, confirmed=True)
        now = bus.exchange(None)
        refuse_hardware_errors(bus, now)
        moved = np.where(now.valid, np.abs(now.position_tick - present), np.iinfo(np.int32).max)
        if (moved <= pin_tick).all():
            return present
        row = int((moved / pin_tick).argmax())
        reading = yield from reading_at_rest(bus, clock)
        if not reading.valid.all():
            break
    raise ServoFaultError(bus.ids[row], "to stand still while its goal is pinned", "it moved, or was silent")


def _ticks(bus: ServoBus, ticks: int) -> NDArray[np.float64]:
    """(S,) `ticks`, given for 4096 a turn, converted to each servo's own resolution; never fewer."""
    return np.array([ticks * max(1.0, s.model.ticks_per_turn / _TICKS_PER_TURN) for s in bus.servos])


def _pin(bus: ServoBus, servo_id: int, tick: int) -> None:
    """Set the goal of a limp servo to its measured position.

    Raises:
        ServoFaultError: the servo stands outside its own position limits, and refuses the goal.
    """
    try:
        bus.write_item(servo_id, "goal_position", tick)
    except ServoFaultError as error:
        low, high = (bus.read_item(servo_id, f"{end}_position_limit") for end in ("min", "max"))
        if low <= tick <= high:
            raise
        found = f"it takes {low} to {high} only: move the joint back by hand, then reset and arm"
        raise ServoFaultError(servo_id, f"goal where it stands, {tick}", found) from error
