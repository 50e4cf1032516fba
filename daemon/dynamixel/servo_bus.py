"""The servos of a robot, on one port or on several ports that transfer at the same time."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from daemon.dynamixel.events import BusEvent
from daemon.dynamixel.identity import Identity
from daemon.dynamixel.ports.port import Port
from daemon.dynamixel.rate_plan import RatePlan
from daemon.dynamixel.reading import BusReading
from daemon.dynamixel.register_access import RegisterAccess
from daemon.dynamixel.scan import Found
from daemon.dynamixel.servo_chain import ServoChain
from daemon.dynamixel.timing import MARGIN_S
from daemon.errors import BusMismatchError, CommandError, DaemonError
from daemon.host.clock import Clock
from retarget.robot.robot import ServoSpec

S = TypeVar("S", bound=np.generic)
_FIELDS = tuple(field.name for field in dataclasses.fields(BusReading))


class ServoBus:
    """Drives the servos of a robot. Works in raw register units and knows no joints.

    Args:
        chains: one for each port.
        servos: the robot's servos, in the order of all arrays; each belongs to exactly one chain.

    Attributes:
        chains: see above.
        servos, ids, models: the servos of all chains.
        reading: their last values.
    """

    def __init__(self, chains: Sequence[ServoChain], servos: Sequence[ServoSpec]) -> None:
        self.chains, self.servos = tuple(chains), tuple(servos)
        self.ids = tuple(s.servo_id for s in servos)
        self._chain = {servo_id: chain for chain in chains for servo_id in chain.link.ids}
        self.models = tuple(chain.link.models[chain.link.row_by_id[i]] for i, chain in self._each())
        self._alone = len(self.chains) == 1 and self.chains[0].link.ids == self.ids
        row = {servo_id: i for i, servo_id in enumerate(self.ids)}
        rows = [np.array([row[i] for i in chain.link.ids], np.intp) for chain in self.chains]
        self._rows: Sequence[NDArray[np.intp] | slice] = [slice(None)] if self._alone else rows
        self.reading = self.chains[0].link.reading if self._alone else BusReading.of(len(self.ids))

    @classmethod
    def on_port(
        cls, port: Port, servos: Sequence[ServoSpec], clock: Clock, *, margin_s: float = MARGIN_S, slow_every: int = 0
    ) -> ServoBus:
        """The bus of servos that are all on one port; see `ServoChain`."""
        return cls([ServoChain(port, servos, clock, margin_s=margin_s, slow_every=slow_every)], servos)

    @property
    def ports(self) -> tuple[Port, ...]:
        """The port of each chain."""
        return tuple(chain.link.port for chain in self.chains)

    @property
    def firmware(self) -> list[int]:
        """Firmware version of each servo, 0 before `verify`."""
        return [chain.link.firmware[chain.link.row_by_id[i]] for i, chain in self._each()]

    @property
    def timeouts(self) -> NDArray[np.int64]:
        """(S,) number of cycles in which each servo did not answer."""
        return self._gathered(np.int64, lambda chain: chain.link.health.counters.timeouts)

    @property
    def withheld(self) -> NDArray[np.bool_]:
        """(S,) servos that get no goals until `verify`: they were silent for long, and a goal would switch their torque on."""
        return self._gathered(np.bool_, lambda chain: chain.link.health.withheld)

    def show_health(self, table: NDArray[np.void]) -> None:
        """Copy state and counters of each servo into (S,) `daemon.dynamixel.health.HEALTH`."""
        for chain, rows in zip(self.chains, self._rows, strict=True):
            chain.link.health.show(table, rows)

    def exchange(self, goal_ticks: NDArray[np.int32] | None) -> BusReading:
        """Write goals (S,), none when None, and read effort, velocity and position of every servo.

        Each port gets goals and request in one `write()`, and all ports get theirs before any answer is awaited. A servo that does
        not answer keeps its old values, marked not valid.

        Raises:
            LinkLostError: one of the devices is gone; the others have been served.
        """
        lost: list[DaemonError] = []
        begun: list[ServoChain] = []
        for chain, rows in zip(self.chains, self._rows, strict=True):
            try:
                chain.cycle.begin(None if goal_ticks is None else goal_ticks[rows])
                begun.append(chain)
            except DaemonError as error:
                lost.append(error)
        for chain in begun:
            try:
                chain.cycle.finish()
            except DaemonError as error:
                lost.append(error)
        if not self._alone:
            for chain, rows in zip(self.chains, self._rows, strict=True):
                for name in _FIELDS:
                    getattr(self.reading, name)[rows] = getattr(chain.link.reading, name)
        if lost:
            raise lost[0]
        return self.reading

    def ping_all(self, *, patient: bool = False) -> dict[int, Identity]:
        """Model number and firmware of each servo that answers; see `ServoChain.ping_all`."""
        return {i: who for chain in self.chains for i, who in chain.ping_all(patient=patient).items()}

    def verify(self) -> None:
        """Compare every port with the robot file.

        Raises:
            BusMismatchError: servos differ from the robot file; the error has a table of those expected and found on all ports.
        """
        found: list[BusMismatchError] = []
        for chain in self.chains:
            try:
                chain.verify()
            except BusMismatchError as error:
                found.append(error)
        if len(found) == 1:
            raise found[0]
        if found:
            raise BusMismatchError([row for error in found for row in error.rows], str(found[-1]).splitlines()[-1])

    def let_answer(self) -> None:
        """Set status return level 2 on servos that answer pings only; they answer no other request before."""
        for chain in self.chains:
            chain.let_answer()

    def strangers(self) -> list[Found]:
        """Servos of Protocol 2.0 on any port that do not belong to this robot; takes about 0.2 s a port."""
        return [f for chain in self.chains for f in chain.strangers() if f.servo_id not in self.ids]

    def plan(self) -> RatePlan:
        """The budget of the slowest port."""
        return max((chain.plan() for chain in self.chains), key=lambda plan: plan.cycle_s)

    def take_events(self) -> list[BusEvent]:
        """Events of all ports since the last call."""
        return sorted((e for chain in self.chains for e in chain.link.events.take()), key=lambda e: e.t_s)

    def look_again(self) -> None:
        """Reopen lost ports at the next write, however recently this was tried: a caller says that they are back."""
        for chain in self.chains:
            chain.link.look_again()

    def close(self) -> None:
        """Release the ports."""
        for chain in self.chains:
            chain.link.close()

    def read_item(self, servo_id: int, name: str) -> int:
        """Value of one item of one servo."""
        return self.registers(servo_id).read_item(servo_id, name)

    def read_items(self, servo_id: int, names: Sequence[str]) -> dict[str, int]:
        """Values of those of the named items that a servo has."""
        return self.registers(servo_id).read_items(servo_id, names)

    def poll_item(self, servo_id: int, name: str) -> int | None:
        """Value of one item, asked once and within the cycle; None when the servo did not answer in time."""
        return self.registers(servo_id).poll_item(servo_id, name)

    def hardware_error_text(self, servo_id: int) -> str:
        """The hardware error of a servo with the alert bit set, in words."""
        return self.registers(servo_id).hardware_error_text(servo_id)

    def write_item(self, servo_id: int, name: str, value: int) -> None:
        """Set one item of one servo and wait for its answer; see `RegisterAccess.write_item`."""
        self.registers(servo_id).write_item(servo_id, name, value)

    def write_all(self, name: str, value: int, unless: Callable[[], bool] = lambda: False) -> bool:
        """Set one item of every servo; see `RegisterAccess.write_all`."""
        return all(chain.registers.write_all(name, value, unless) for chain in self.chains)

    def send_torque_off(self) -> None:
        """Cut the torque of every servo with packets that no servo answers; a lost port does not keep the others from it.

        Raises:
            LinkLostError: a port is lost; the others got the packets.
        """
        lost: list[DaemonError] = []
        for chain in self.chains:
            try:
                chain.registers.send_torque_off()
            except DaemonError as error:
                lost.append(error)
        if lost:
            raise lost[0]

    def set_effort(self, share: float, *, confirmed: bool = False) -> None:
        """Limit the effort of every servo to a share of its own limit; see `RegisterAccess.set_effort`."""
        for chain in self.chains:
            chain.registers.set_effort(share, confirmed=confirmed)

    def arm_watchdog(self, units: int) -> tuple[int, ...]:
        """Arm the bus watchdogs (20 ms units); return the ids of servos without a useful one."""
        return tuple(i for chain in self.chains for i in chain.registers.arm_watchdog(units))

    def clear_watchdog(self) -> None:
        """Clear every bus watchdog; a servo that has tripped loses its torque first."""
        for chain in self.chains:
            chain.registers.clear_watchdog()

    def tripped_watchdogs(self) -> list[int]:
        """Ids of the servos that their bus watchdog has stopped."""
        return [i for chain in self.chains for i in chain.registers.tripped_watchdogs()]

    def withhold(self, servo_ids: Sequence[int]) -> None:
        """Send these servos no goals until `verify`."""
        for servo_id in servo_ids:
            self.registers(servo_id).withhold([servo_id])

    def registers(self, servo_id: int) -> RegisterAccess:
        """Access to the items of a servo.

        Raises:
            CommandError: the robot has no such servo.
        """
        if servo_id not in self._chain:
            raise CommandError(f"no servo {servo_id} on this bus; there are {', '.join(map(str, self.ids))}")
        return self._chain[servo_id].registers

    def _each(self) -> list[tuple[int, ServoChain]]:
        return [(servo_id, self._chain[servo_id]) for servo_id in self.ids]

    def _gathered(self, dtype: type[S], of: Callable[[ServoChain], NDArray[S]]) -> NDArray[S]:
        out = np.zeros(len(self.ids), dtype)
        for chain, rows in zip(self.chains, self._rows, strict=True):
            out[rows] = of(chain)
        return out
