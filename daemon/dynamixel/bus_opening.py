"""Opens the ports of a robot's bus and finds the port of each servo."""

from __future__ import annotations

from collections.abc import Sequence

from daemon.dynamixel.ports.opening import PortContext, open_port
from daemon.dynamixel.ports.port import Port
from daemon.dynamixel.servo_bus import ServoBus
from daemon.dynamixel.servo_chain import ServoChain
from daemon.dynamixel.timing import MARGIN_S
from daemon.errors import BusMismatchError, LinkTimeoutError, MismatchRow
from daemon.host.clock import Clock
from retarget.robot.robot import RobotModel


def open_bus(url: str, robot: RobotModel, clock: Clock, *, slow_every: int = 0, margin_s: float = MARGIN_S) -> ServoBus:
    """The bus at one URL, or at several separated by commas: `dxl:///dev/ttyUSB0,dxl:///dev/ttyUSB1`.

    With several ports every servo is searched on each of them.

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
    """Open the ports of such a URL; all or none.

    Raises:
        PortError: a port cannot be opened.
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
) -> ServoBus:
    """The bus on open ports; a servo that answers on none of them is expected on the first.

    Args:
        ports: the open ports.
        robot: the robot.
        clock: clock of the deadlines.
        slow_every: see `ServoChain`.
        margin_s: seconds by which an answer may be late before the servo counts as silent.

    Raises:
        BusMismatchError: a servo answers on two ports.
    """
    if len(ports) == 1:
        return ServoBus.on_port(ports[0], robot.servos, clock, slow_every=slow_every, margin_s=margin_s)
    answers = [ServoChain(port, robot.servos, clock).ping_all(patient=True) for port in ports]
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
    chains = [
        ServoChain(p, s, clock, slow_every=slow_every, margin_s=margin_s) for p, s in zip(ports, parts, strict=True)
    ]
    return ServoBus(chains, robot.servos)
