"""One servo alone, without a robot file: search, reads, and guarded writes. For set-up tools."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass

from daemon.dynamixel.identity import MUTE_TEXT, PINGS_ONLY
from daemon.dynamixel.ports.port import Port
from daemon.dynamixel.registers.models import MODELS, BusModel
from daemon.dynamixel.registers.registers import Item
from daemon.dynamixel.servo_chain import ServoChain
from daemon.errors import CommandError, LinkTimeoutError
from daemon.host.clock import Clock
from retarget.robot.robot import ServoSpec
from retarget.robot.servos import servo_models

MOVES = (
    "goal_position", "goal_velocity", "goal_pwm", "goal_current", "moving_speed", "goal_torque", "torque_enable",
    "bus_watchdog", "pwm_offset", "current_offset", "velocity_offset",
)  # fmt: skip
"""Items that can set a joint in motion and that only the daemon writes, behind its gate. A bus watchdog that trips or is cleared
can move a joint as well."""
_HOLDS = ("torque_enable", "torque_limit")
"""Items whose lower value lets a joint fall."""
_BOOT_S, _ASK_EVERY_S = 2.0, 0.1
"""Seconds that a servo has to come back after a reboot, and seconds between two attempts to reach it."""


@dataclass(frozen=True)
class SingleServo:
    """A servo that answered, and a chain that contains only this servo."""

    chain: ServoChain
    model: BusModel
    servo_id: int
    firmware: int

    def get(self, name: str) -> int:
        """Value of an item."""
        return self.chain.registers.read_item(self.servo_id, name)

    def item(self, name: str) -> Item:
        """An item of the servo's table.

        Raises:
            CommandError: the table has no such item.
        """
        if name not in self.model.table:
            raise CommandError(f"{self.model.name} has no item '{name}'; it has: {', '.join(self.model.table)}")
        return self.model.table[name]

    def set(self, name: str, value: int, *, drop: bool = False) -> None:
        """Write an item and read it back.

        Raises:
            CommandError: the write would move the joint, is out of range, or needs torque off; or it would release a joint that
                is held, and `drop` was not said.
        """
        item = self.item(name)
        if name in MOVES and not (name == "torque_enable" and value == 0):
            raise CommandError(f"'{name}' can move the joint; that is the daemon's alone (mmmd run, mmmd arm)")
        if name in ("id", "baud_rate"):
            raise CommandError(
                f"'{name}': use `mmmd servo {'id' if name == 'id' else 'baud'}`, which checks the result"
            )
        if not item.takes(value):
            raise CommandError(f"'{name}' = {value} is outside [{item.low}, {item.high}] of {self.model.name}")
        self._require_free(item)
        if name in _HOLDS and not drop and self.get("torque_enable") and value < self.get(name):
            raise CommandError(
                f"servo {self.servo_id} holds torque: '{name}' = {value} lets its joint fall; --drop to do it"
            )
        self.chain.registers.write_item(self.servo_id, name, value)
        found = self.get(name)
        if found != value:
            raise CommandError(f"'{name}': wrote {value}, the servo has {found}")

    def set_id(self, new_id: int) -> None:
        """Set another id, which no other servo may have.

        Raises:
            CommandError: the id is taken, out of range, or torque is on.
        """
        if not 0 <= new_id <= 252:
            raise CommandError(f"id {new_id}: allowed are 0 to 252")
        self._require_free(self.item("id"))
        try:
            find(self.chain.link.port, self.chain.link.clock, new_id, self.model.protocol)
        except LinkTimeoutError:
            pass
        else:
            raise CommandError(f"id {new_id} is taken by another servo on this bus")
        with contextlib.suppress(
            LinkTimeoutError
        ):  # some servos answer with their new id: a ping of it shows the result
            self.chain.registers.write_item(self.servo_id, "id", new_id)
        find(self.chain.link.port, self.chain.link.clock, new_id, self.model.protocol)

    def set_baud(self, baud: int) -> None:
        """Set another baud; the servo then answers at this baud only: use `find` on a port of that baud.

        Raises:
            CommandError: the servo has no such baud, or torque is on.
        """
        code = self.model.baud_code(baud)
        if code is None:
            known = "57600, 115200, 1000000, 2000000, 3000000, 4000000" if self.model.protocol == 2.0 else "2000000 / n"
            raise CommandError(f"{self.model.name} has no {baud} baud; allowed: {known}, at most {self.model.max_baud}")
        self._require_free(self.item("baud_rate"))
        with contextlib.suppress(LinkTimeoutError):  # some servos answer at the new baud: a ping at it shows the result
            self.chain.registers.write_item(self.servo_id, "baud_rate", code)

    def reboot(self, *, drop: bool) -> None:
        """Restart the servo, and wait until it is back.

        Raises:
            CommandError: the servo has torque, which would drop, and `drop` is false; or its protocol has no reboot.
            LinkTimeoutError: the servo has not come back.
        """
        if self.model.protocol == 1.0:
            raise CommandError(
                f"{self.model.name} (protocol 1.0) knows no reboot; take its power away for a moment, or clear an alarm with"
                f" mmmd servo set {self.servo_id} torque_limit {self.get('max_torque')}"
            )
        if self.get("torque_enable") and not drop:
            raise CommandError(f"servo {self.servo_id} holds torque: a reboot lets its joint fall; --drop to do it")
        self.chain.registers.reboot(self.servo_id)
        clock = self.chain.link.clock
        until_s = clock.now_s() + _BOOT_S
        while not self.chain.ping_all() and clock.now_s() < until_s:
            clock.sleep_until(clock.now_s() + _ASK_EVERY_S)
        find(self.chain.link.port, clock, self.servo_id, self.model.protocol)

    def _require_free(self, item: Item) -> None:
        if item.eeprom and self.get("torque_enable"):
            raise CommandError(f"'{item.name}' can be written only with torque off; park the robot first (mmmd park)")


def find(port: Port, clock: Clock, servo_id: int, protocol: float | None = None) -> SingleServo:
    """The servo with this id, in either protocol.

    Raises:
        LinkTimeoutError: no servo answers.
    """
    for version in (2.0, 1.0) if protocol is None else (protocol,):
        guess = next(m for m in MODELS.values() if m.protocol == version)
        chain = _chain(port, clock, servo_id, guess)
        found = chain.ping_all().get(servo_id)
        if found is not None:
            if found == PINGS_ONLY:
                raise CommandError(
                    f"servo {servo_id} {MUTE_TEXT}; mmmd doctor --fix with its robot file lets it answer everything"
                )
            number, firmware = found
            if number not in MODELS:
                raise CommandError(f"servo {servo_id} is of model {number}, which is not known here")
            return SingleServo(_chain(port, clock, servo_id, MODELS[number]), MODELS[number], servo_id, firmware)
    raise LinkTimeoutError(
        f"servo {servo_id} does not answer at {port.baud} baud on {port.name}; mmmd scan finds who does"
    )


def _chain(port: Port, clock: Clock, servo_id: int, model: BusModel) -> ServoChain:
    facts = servo_models()[model.name]
    ends = facts.min_tick, facts.max_tick
    return ServoChain(port, [ServoSpec(servo_id, "servo", facts, 1, 1.0, facts.zero_tick, ((0, 1.0),), *ends)], clock)
