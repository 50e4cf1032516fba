"""Items of the control tables by name, of one servo or of all on a link, and the rules for torque."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from daemon.dynamixel.codec import packet_protocol1 as packet1
from daemon.dynamixel.codec.group import GroupWrite, GroupWrite1
from daemon.dynamixel.events import BusEventKind
from daemon.dynamixel.registers.models import BusModel
from daemon.dynamixel.registers.registers import POSITION_MODE, WATCHDOG_TRIPPED, Item
from daemon.dynamixel.servo_link import ServoLink
from daemon.errors import CommandError, ServoFaultError

_GAP_BYTES = 12
"""Bytes by which two items may lie apart and still be read in one request."""
_EFFORT_LIMITS = {"goal_pwm": "pwm_limit", "torque_limit": "max_torque"}
"""Item that limits a servo's effort, kept in RAM, and the item kept without power that it may not exceed."""


class RegisterAccess:
    """Reads and writes items of servos of either protocol.

    Attributes:
        effort_limit: (S,) pwm_limit of each servo, max_torque on protocol 1.0; from the factory until it was read.
    """

    def __init__(self, link: ServoLink) -> None:
        self._link = link
        limits = [m.table[_EFFORT_LIMITS[_effort_item(m)]].initial or 0 for m in link.models]
        self.effort_limit = np.array(limits, np.int32)

    def read_item(self, servo_id: int, name: str) -> int:
        """Value of one item of one servo."""
        row = self._link.row_of(servo_id)
        item = self._item(row, name)
        answer = self._link.ask(self._link.dialect(row).read(servo_id, item.address, item.size), row, item.size)
        return item.decode(answer.parameters)

    def read_items(self, servo_id: int, names: Sequence[str]) -> dict[str, int]:
        """Values of the named items that a servo has; neighbouring items are read in one request."""
        row = self._link.row_of(servo_id)
        table, values = self._link.models[row].table, dict[str, int]()
        items = sorted((table[name] for name in names if name in table), key=lambda item: item.address)
        while items:
            span = [items.pop(0)]
            while items and items[0].address - span[-1].end <= _GAP_BYTES:
                span.append(items.pop(0))
            start, length = span[0].address, span[-1].end - span[0].address
            data = self._link.ask(self._link.dialect(row).read(servo_id, start, length), row, length).parameters
            values |= {i.name: i.decode(data[i.address - start : i.end - start]) for i in span}
        return values

    def poll_item(self, servo_id: int, name: str) -> int | None:
        """Value of one item, requested once and within the cycle; None when the servo does not answer in time."""
        row = self._link.row_of(servo_id)
        item = self._item(row, name)
        request = self._link.dialect(row).read(servo_id, item.address, item.size)
        answer = self._link.ask_once(request, row, item.size, self._link.timing.margin_s)
        return None if answer is None else item.decode(answer.parameters)

    def write_item(self, servo_id: int, name: str, value: int) -> None:
        """Set one item of one servo and wait for its answer.

        Raises:
            CommandError: the item is read only or the value does not fit.
            ServoFaultError: the servo refused.
            LinkTimeoutError: the servo did not answer.
        """
        row = self._link.row_of(servo_id)
        item = self._item(row, name)
        if not item.writable:
            raise CommandError(f"servo {servo_id}: '{name}' is read only")
        try:
            data = item.encode(value)
        except OverflowError:
            raise CommandError(f"servo {servo_id}: '{name}' = {value} does not fit {item.size} bytes") from None
        self._link.ask(self._link.dialect(row).write(servo_id, item.address, data), row, 0)

    def write_unless_alarmed(self, servo_id: int, name: str, value: int) -> None:
        """`write_item` for effort or torque, after a check for an alarm, which such a write would clear on protocol 1.0.

        Raises:
            ServoFaultError: the servo has an alarm, or refused.
        """
        row = self._link.row_of(servo_id)
        item, dialect = self._item(row, name), self._link.dialect(row)
        if dialect.version == 1.0:
            answer = self._link.ask(dialect.read(servo_id, item.address, item.size), row, item.size)
            if dialect.alert(answer.error):
                found = f"{self._link.models[row].error_text(answer.error & packet1.ALERT_BITS)}; reboot the servo"
                raise ServoFaultError(servo_id, f"no '{name}' while it has an alarm", found)
        self.write_item(servo_id, name, value)

    def write_all(self, name: str, value: int, unless: Callable[[], bool] = lambda: False) -> bool:
        """Set one item of every servo, each confirmed; the first refusal is raised.

        Args:
            name: the item.
            value: its value.
            unless: called before each servo; true ends the writes.

        Returns:
            Whether every servo was set.
        """
        write = self.write_unless_alarmed if name == "torque_enable" and value else self.write_item
        for servo_id in self._link.ids:
            if unless():
                return False
            write(servo_id, name, value)
        if name == "torque_enable":
            self._link.expect_torque(on=bool(value))
        return True

    def send_all(self, name: str, value: int) -> None:
        """Set one item of every servo that has it, with packets that no servo answers."""
        self._link.send(self._group_writes(name, np.full(len(self._link.ids), value, np.int32)))

    def send_torque_off(self) -> None:
        """Cut the torque of every servo with packets that need no answer."""
        self._link.expect_torque(on=False)
        self.send_all("torque_enable", 0)

    def read_effort_limit(self, servo_id: int) -> None:
        """Read the effort limit that a servo keeps without power; `set_effort` takes shares of it."""
        row = self._link.row_of(servo_id)
        self.effort_limit[row] = self.read_item(servo_id, _EFFORT_LIMITS[_effort_item(self._link.models[row])])

    def set_effort(self, share: float, *, confirmed: bool = False) -> None:
        """Limit what every servo may exert, as a share of its own limit: goal PWM, or torque limit on protocol 1.0.

        Args:
            share: 0 to 1.
            confirmed: whether each servo gets a packet of its own and has to answer; else one packet without answers.
        """
        values = np.rint(self.effort_limit * min(1.0, max(0.0, share))).astype(np.int32)
        items = [_effort_item(m) for m in self._link.models]
        if not confirmed:
            self._link.send(b"".join(self._group_writes(name, values) for name in dict.fromkeys(items)))
            return
        for servo_id, name, value in zip(self._link.ids, items, values.tolist(), strict=True):
            self.write_unless_alarmed(servo_id, name, value)

    def arm_watchdog(self, units: int) -> tuple[int, ...]:
        """Arm the bus watchdog (20 ms units) of every servo that has one; return the ids of servos without a useful one.

        Firmware of the 330 size that flags the trip but keeps moving is armed as well, and its id returned. Where a trip would move
        the joint the watchdog stays off.
        """
        without: list[int] = []
        for servo_id, model, firmware in zip(self._link.ids, self._link.models, self._link.firmware, strict=True):
            able = model.has_watchdog(firmware or 255) and not self._trip_moves(servo_id)
            if able:
                self.write_item(servo_id, "bus_watchdog", units)
            if not (able and model.watchdog_stops):
                without.append(servo_id)
        return tuple(without)

    def _trip_moves(self, servo_id: int) -> bool:
        """Whether a trip would move the joint by its homing offset (DynamixelSDK#584: seen in extended position mode)."""
        values = self.read_items(servo_id, ("operating_mode", "homing_offset"))
        return values["homing_offset"] != 0 and values["operating_mode"] != POSITION_MODE

    def clear_watchdog(self) -> None:
        """Clear every bus watchdog; a servo that has tripped loses its torque first.

        Cleared under torque it would go on to the goal it was stopped on the way to.
        """
        for servo_id in self.tripped_watchdogs():
            self._link.events.add(
                BusEventKind.WATCHDOG_TRIPPED, self._link.clock.now_s(), f"servo {servo_id}", servo_id
            )
            self.write_item(servo_id, "torque_enable", 0)
        for servo_id, model in zip(self._link.ids, self._link.models, strict=True):
            if "bus_watchdog" in model.table:
                self.write_item(servo_id, "bus_watchdog", 0)

    def tripped_watchdogs(self) -> list[int]:
        """Ids of the servos that their bus watchdog has stopped."""
        able = [i for i, m in zip(self._link.ids, self._link.models, strict=True) if "bus_watchdog" in m.table]
        return [i for i in able if self.read_item(i, "bus_watchdog") == WATCHDOG_TRIPPED]

    def withhold(self, servo_ids: Sequence[int]) -> None:
        """Send these servos no goals until `verify`."""
        for servo_id in servo_ids:
            self._link.health.withhold_from(self._link.row_of(servo_id))

    def hardware_error_text(self, servo_id: int) -> str:
        """Description of the hardware error of a servo with the alert bit set."""
        row = self._link.row_of(servo_id)
        model = self._link.models[row]
        if model.error_item:
            self._link.reading.hardware_error[row] = self.read_item(servo_id, model.error_item)
        return model.error_text(int(self._link.reading.hardware_error[row]))

    def reboot(self, servo_id: int) -> None:
        """Restart a servo: this clears a latched error, torque and settings."""
        row = self._link.row_of(servo_id)
        self._link.ask(self._link.dialect(row).reboot(servo_id), row, 0)
        self._link.health.faulted[row] = True

    def _group_writes(self, name: str, values: NDArray[np.int32]) -> bytes:
        """Packets that set one item of every servo that has it to its own value of (S,)."""
        return b"".join(write.frame(values[rows]) for rows, write in self.writers(name))

    def writers(
        self, name: str, of: NDArray[np.bool_] | None = None
    ) -> list[tuple[NDArray[np.intp], GroupWrite | GroupWrite1]]:
        """One group write for each address of the item, for the servos that have it; for some (S,) or for all."""
        places: dict[tuple[float, int, int], list[int]] = {}
        for row, model in enumerate(self._link.models):
            item = model.table.get(name)
            if item is not None and (of is None or of[row]):
                places.setdefault((model.protocol, item.address, item.size), []).append(row)
        if not places and of is None:
            raise CommandError(f"no servo on {self._link.port.name} has an item '{name}'")
        return [
            (
                np.array(rows, np.intp),
                (GroupWrite if protocol == 2.0 else GroupWrite1)([self._link.ids[r] for r in rows], address, size),
            )
            for (protocol, address, size), rows in places.items()
        ]

    def _item(self, row: int, name: str) -> Item:
        table = self._link.models[row].table
        if name not in table:
            raise CommandError(f"servo {self._link.ids[row]} has no item '{name}'; it has: {', '.join(table)}")
        return table[name]


def _effort_item(model: BusModel) -> str:
    """The item that limits the effort of this model."""
    return next(name for name in _EFFORT_LIMITS if name in model.table)
