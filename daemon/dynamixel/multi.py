"""Several ports as one bus: which servo is where is found out, and their wires are busy at the same time."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from daemon.dynamixel.events import BusEvent
from daemon.dynamixel.ports.opening import PortContext, open_port
from daemon.dynamixel.ports.port import Port
from daemon.dynamixel.rate_plan import RatePlan
from daemon.dynamixel.reading import BusReading
from daemon.dynamixel.scan import Found
from daemon.dynamixel.servo_bus import ServoBus
from daemon.dynamixel.timing import MARGIN_S
from daemon.errors import BusMismatchError, CommandError, DaemonError, LinkTimeoutError, MismatchRow
from daemon.host.clock import Clock
from retarget.robot.robot import RobotModel, ServoSpec

_FIELDS = tuple(field.name for field in dataclasses.fields(BusReading))


class MultiBus:
    """The servos of a robot on several ports, with the calls of `ServoBus`.

    Args:
        parts: one bus for each port.
        servos: of the robot, in the order of all arrays; each on exactly one of the parts.
    """

    def __init__(self, parts: Sequence[ServoBus], servos: Sequence[ServoSpec]) -> None:
        self.parts, self.servos = tuple(parts), tuple(servos)
        self.ids = tuple(s.servo_id for s in servos)
        self._part = {servo_id: part for part in parts for servo_id in part.ids}
        row = {servo_id: i for i, servo_id in enumerate(self.ids)}
        self._rows = [np.array([row[i] for i in part.ids], np.intp) for part in parts]
        self.models = tuple(self._part[i].models[self._part[i].ids.index(i)] for i in self.ids)
        self.reading = BusReading.of(len(self.ids))

    @property
    def ports(self) -> tuple[Port, ...]:
        """Where its servos are."""
        return tuple(part.port for part in self.parts)

    @property
    def firmware(self) -> list[int]:
        """Of each servo, known after `verify`."""
        return [self._part[i].firmware[self._part[i].ids.index(i)] for i in self.ids]

    @property
    def timeouts(self) -> NDArray[np.int64]:
        """(S,) cycles in which each servo did not answer."""
        return self._merged([part.timeouts for part in self.parts])

    def show_health(self, table: NDArray[np.void]) -> None:
        """Copy state and counters of each servo into (S,) `daemon.dynamixel.health.HEALTH`."""
        for part, rows in zip(self.parts, self._rows, strict=True):
            part.health.show(table, rows)

    @property
    def withheld(self) -> NDArray[np.bool_]:
        """(S,) servos that get no goals until `verify`; see `ServoBus`."""
        out = np.zeros(len(self.ids), bool)
        for part, rows in zip(self.parts, self._rows, strict=True):
            out[rows] = part.withheld
        return out

    def exchange(self, goal_ticks: NDArray[np.int32] | None) -> BusReading:
        """Goals out and measurements in on every port; all are sent before any answer is waited for.

        Raises:
            LinkLostError: one of the devices is gone; the others have been served.
        """
        lost: list[DaemonError] = []
        begun: list[bool] = []
        for part, rows in zip(self.parts, self._rows, strict=True):
            begun.append(_done(lambda p=part, r=rows: p.begin(None if goal_ticks is None else goal_ticks[r]), lost))
        for part, rows, sent in zip(self.parts, self._rows, begun, strict=True):
            if sent:
                _done(part.finish, lost)
            for name in _FIELDS:
                getattr(self.reading, name)[rows] = getattr(part.reading, name)
        if lost:
            raise lost[0]
        return self.reading

    def verify(self) -> None:
        """Compare every port with the robot file.

        Raises:
            BusMismatchError: with a table of what was expected and what was found on all ports.
        """
        rows: list[MismatchRow] = []
        hint = ""
        for part in self.parts:
            try:
                part.verify()
            except BusMismatchError as error:
                rows += error.rows
                hint = str(error).splitlines()[-1]
        if rows:
            raise BusMismatchError(rows, hint)

    def let_answer(self) -> None:
        """Set status return level 2 on servos that answer pings only."""
        for part in self.parts:
            part.let_answer()

    def strangers(self) -> list[Found]:
        """Servos of Protocol 2.0 on any port that are none of this robot's."""
        return [f for part in self.parts for f in part.strangers() if f.servo_id not in self.ids]

    def plan(self) -> RatePlan:
        """The budget of the slowest port."""
        return max((part.plan() for part in self.parts), key=lambda plan: plan.cycle_s)

    def take_events(self) -> list[BusEvent]:
        """Events of all ports since the last call."""
        return sorted((e for part in self.parts for e in part.take_events()), key=lambda e: e.t_s)

    def look_again(self) -> None:
        """Somebody says that lost ports are back."""
        for part in self.parts:
            part.look_again()

    def close(self) -> None:
        """Release the ports."""
        for part in self.parts:
            part.close()

    def read_item(self, servo_id: int, name: str) -> int:
        """Value of one item of one servo."""
        return self._of(servo_id).read_item(servo_id, name)

    def read_items(self, servo_id: int, names: Sequence[str]) -> dict[str, int]:
        """Values of those of the named items that a servo has."""
        return self._of(servo_id).read_items(servo_id, names)

    def poll_item(self, servo_id: int, name: str) -> int | None:
        """Value of one item, asked once and within the cycle."""
        return self._of(servo_id).poll_item(servo_id, name)

    def write_item(self, servo_id: int, name: str, value: int) -> None:
        """Set one item of one servo and wait for its answer."""
        self._of(servo_id).write_item(servo_id, name, value)

    def write_all(self, name: str, value: int) -> None:
        """Set one item of every servo, each confirmed."""
        for part in self.parts:
            part.write_all(name, value)

    def send_torque_off(self) -> None:
        """Cut the torque of every servo; a port that is lost keeps no other from it."""
        lost: list[DaemonError] = []
        for part in self.parts:
            _done(part.send_torque_off, lost)
        if lost:
            raise lost[0]

    def set_effort(self, share: float, *, confirmed: bool = False) -> None:
        """Limit what every servo may exert, as a share of all."""
        for part in self.parts:
            part.set_effort(share, confirmed=confirmed)

    def arm_watchdog(self, units: int) -> tuple[int, ...]:
        """Arm the bus watchdogs; the ids of those without, or of no use."""
        return tuple(i for part in self.parts for i in part.arm_watchdog(units))

    def clear_watchdog(self) -> None:
        """Clear every bus watchdog; a servo that has tripped loses its torque first."""
        for part in self.parts:
            part.clear_watchdog()

    def tripped_watchdogs(self) -> list[int]:
        """Ids of the servos that have stopped by their bus watchdog."""
        return [i for part in self.parts for i in part.tripped_watchdogs()]

    def withhold(self, servo_ids: Sequence[int]) -> None:
        """No goals for these servos until `verify`."""
        for servo_id in servo_ids:
            self._of(servo_id).withhold([servo_id])

    def hardware_error_text(self, servo_id: int) -> str:
        """What a servo with the alert bit set complains of."""
        return self._of(servo_id).hardware_error_text(servo_id)

    def _of(self, servo_id: int) -> ServoBus:
        if servo_id not in self._part:
            raise CommandError(f"no servo {servo_id} on these ports; there are {', '.join(map(str, self.ids))}")
        return self._part[servo_id]

    def _merged(self, values: Sequence[NDArray[np.int64]]) -> NDArray[np.int64]:
        out = np.zeros(len(self.ids), np.int64)
        for rows, value in zip(self._rows, values, strict=True):
            out[rows] = value
        return out


RobotBus = ServoBus | MultiBus
"""The servos of a robot, on one port or on several."""


def open_bus(url: str, robot: RobotModel, clock: Clock, *, slow_every: int = 0, margin_s: float = MARGIN_S) -> RobotBus:
    """The bus behind a URL, or behind several with commas between them: `dxl:///dev/ttyUSB0,dxl:///dev/ttyUSB1`.

    On several ports every servo is looked for on each.

    Raises:
        PortError: a port cannot be opened.
        BusMismatchError: a servo answers on two ports.
    """
    ports = open_ports(url, PortContext(robot, clock))
    try:
        return bus_on(ports, robot, clock, slow_every=slow_every, margin_s=margin_s)
    except BaseException:
        _close(ports)
        raise


def open_ports(url: str, context: PortContext) -> list[Port]:
    """The ports of such a URL; all or none.

    Raises:
        PortError: one cannot be opened.
    """
    ports: list[Port] = []
    try:
        for part in url.split(","):
            ports.append(open_port(part.strip(), context))
    except BaseException:
        _close(ports)
        raise
    return ports


def _close(ports: Sequence[Port]) -> None:
    for port in ports:
        port.close()


def bus_on(
    ports: Sequence[Port], robot: RobotModel, clock: Clock, *, slow_every: int = 0, margin_s: float = MARGIN_S
) -> RobotBus:
    """The bus on these open ports; a servo that answers on none is expected on the first.

    Args:
        ports: open ones.
        robot: whose servos they are.
        clock: of the deadlines.
        slow_every: see `ServoBus`.
        margin_s: how long an answer may be late before a servo counts as silent.

    Raises:
        BusMismatchError: a servo answers on two ports.
    """
    if len(ports) == 1:
        return ServoBus(ports[0], robot.servos, clock, slow_every=slow_every, margin_s=margin_s)
    answers = [ServoBus(port, robot.servos, clock).ping_all(patient=True) for port in ports]
    where: dict[int, int] = {}
    doubled: list[MismatchRow] = []
    for s in robot.servos:
        on = [i for i, found in enumerate(answers) if s.servo_id in found]
        where[s.servo_id] = on[0] if on else 0
        if len(on) > 1:
            names = " and ".join(ports[i].name for i in on)
            doubled.append(MismatchRow(s.servo_id, s.joint_name, "on one port", f"on {names}"))
    if doubled:
        raise BusMismatchError(doubled, "give one of the two another id: mmmd servo id")
    parts = [[s for s in robot.servos if where[s.servo_id] == i] for i in range(len(ports))]
    for port, servos in zip(ports, parts, strict=True):
        if not servos:
            raise LinkTimeoutError(
                f"no servo of '{robot.name}' answers on {port.name}; check power and cable, or leave it out"
            )
    buses = [ServoBus(p, s, clock, slow_every=slow_every, margin_s=margin_s) for p, s in zip(ports, parts, strict=True)]
    return MultiBus(buses, robot.servos)


def _done(action: Callable[[], object], lost: list[DaemonError]) -> bool:
    """Carry out; a lost link is kept for later."""
    try:
        action()
    except DaemonError as error:
        lost.append(error)
        return False
    return True
