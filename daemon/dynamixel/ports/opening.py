"""Opens a port by URL; schemes are found through the entry points `mmmd.ports`, so that others can add transports."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import entry_points
from urllib.parse import SplitResult, urlsplit

from daemon.dynamixel.ports.port import Port
from daemon.errors import CommandError
from daemon.host.clock import Clock
from retarget.robot.robot import RobotModel


@dataclass(frozen=True)
class PortContext:
    """Data for opening a port: the robot (its baud, its servos) and the clock."""

    robot: RobotModel
    clock: Clock


PortFactory = Callable[[SplitResult, PortContext], Port]


def open_port(url: str, context: PortContext) -> Port:
    """Open the port at `url`, e.g. `dxl:///dev/ttyUSB0?baud=1000000` or `sim://`.

    Raises:
        CommandError: an unknown scheme or option.
        PortError: the device is missing, busy or forbidden.
    """
    try:
        parts = urlsplit(url)
    except ValueError as error:
        raise CommandError(f"bus '{url}': {error}; example: dxl:///dev/ttyUSB0?baud=1000000") from error
    factories = {point.name: point for point in entry_points(group="mmmd.ports")}
    if parts.scheme not in factories:
        known = ", ".join(f"{name}://" for name in sorted(factories))
        raise CommandError(f"bus '{url}': unknown scheme '{parts.scheme}'; known: {known}")
    factory: PortFactory = factories[parts.scheme].load()
    return factory(parts, context)
