"""Before torque comes on: the joints stand still, and every servo's goal is where it stands.

Generators: between their steps the bus process goes on with its cycles.
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
"""Before arming the joints must stand: within two ticks over 20 ms, and in no more than a second."""
_PIN_TICK = 8
"""Ticks by which a joint may be away from its pinned goal when torque comes on: 0.7 degrees of a servo of 4096 ticks."""
_TICKS_PER_TURN = 4096
"""What those two are for; finer servos (Y, P) may go as many degrees, coarser ones as many ticks."""


def reading_at_rest(bus: ServoBus, clock: Clock) -> Generator[None, None, BusReading]:
    """A whole reading of joints that stand still: limp they swing on, and a goal pinned meanwhile would jerk.

    After a second with a servo silent it is the last one, as it is.

    Raises:
        ServoFaultError: one still moves after a second.
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
    """Raises ServoFaultError for a servo that tells of a hardware error."""
    for row in np.flatnonzero(reading.error & ALERT_BIT):
        servo_id = bus.ids[int(row)]
        text = bus.hardware_error_text(servo_id)
        raise ServoFaultError(servo_id, "hardware error status", f"{text}; reboot the servo")


def pin_where_they_stand(
    bus: ServoBus, clock: Clock, reading: BusReading, effort: float
) -> Generator[None, None, NDArray[np.int32]]:
    """(S,) goals pinned to where the joints stand, still so when all are: on a bad wire it takes long enough to move an arm.

    No cycle comes between the last look and its end, so that torque may come on at once.

    Raises:
        ServoFaultError: a goal is not taken, a servo tells of a hardware error by now, or a joint moves each time while
            goals are pinned.
    """
    row, pin_tick = 0, _ticks(bus, _PIN_TICK)
    for _ in range(PIN_ATTEMPTS):
        present = reading.position_tick.copy()
        for servo_id, tick in zip(bus.ids, present, strict=True):
            _pin(bus, servo_id, int(tick))
            pinned = bus.read_item(servo_id, "goal_position")
            if pinned != tick:
                raise ServoFaultError(servo_id, f"goal pinned to {tick}", f"goal {pinned}")
        refuse_hardware_errors(bus, bus.exchange(None))  # protocol 1.0 forgets its alarm when it is told an effort
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
    """(S,) `ticks`, given for 4096 a turn, in the ticks of each servo; never fewer."""
    return np.array([ticks * max(1.0, s.model.ticks_per_turn / _TICKS_PER_TURN) for s in bus.servos])


def _pin(bus: ServoBus, servo_id: int, tick: int) -> None:
    """Set the goal of a limp servo to where it stands.

    Raises:
        ServoFaultError: it stands outside its own position limits, and refuses.
    """
    try:
        bus.write_item(servo_id, "goal_position", tick)
    except ServoFaultError as error:
        low, high = (bus.read_item(servo_id, f"{end}_position_limit") for end in ("min", "max"))
        if low <= tick <= high:
            raise
        found = f"it takes {low} to {high} only: move the joint back by hand, then reset and arm"
        raise ServoFaultError(servo_id, f"goal where it stands, {tick}", found) from error
