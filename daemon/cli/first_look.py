"""First information for a new user: ports, a running daemon, the motion model, robots; and the next command to type."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterable, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Port:
    """A serial port of a USB adapter."""

    device: str
    description: str


@dataclass(frozen=True)
class FirstLook:
    """Findings on this machine, made without writing to any port.

    Attributes:
        ports: serial ports of USB adapters.
        robots: names of the robots that ship.
        has_model: whether PyTorch, which the motion model needs, is installed.
        daemon: whether a program listens at a daemon's default endpoint.
    """

    ports: tuple[Port, ...]
    robots: tuple[str, ...]
    has_model: bool
    daemon: bool

    def lines(self) -> list[str]:
        """The findings, and the next command to type."""
        found = [f"port {p.device} ({p.description})" for p in self.ports] or ["no USB serial adapter"]
        model = (
            "the motion model can run"
            if self.has_model
            else "no PyTorch: gestures work, texts do not until `mmmd install-torch`"
        )
        said = [f"found: {', '.join(found)}; {model}; robots: {', '.join(self.robots)}, or yours (`mmmd robot new`)"]
        if self.daemon:
            return [
                *said,
                'next: a daemon runs already: `mmmd say "wave with your right hand"`, or `mmmd view` for the page',
            ]
        if self.ports:
            device = self.ports[0].device
            said.append(f"next: `mmmd scan {device}` tells its servos and the robots that fit, then")
            said.append(f"      `mmmd doctor --robot NAME --bus dxl://{device}`; without hardware:")
        else:
            said.append("next, on simulated servos:")
        return [*said, "      `mmmd demo --view` shows it in a browser, `mmmd run --view` is the daemon with its page"]


def first_look() -> FirstLook:
    """Examine this machine."""
    from daemon.network.probe import listening
    from daemon.settings.config import Endpoints
    from retarget.robot.loading import list_robots

    torch = importlib.util.find_spec("torch") is not None
    return FirstLook(_usb_ports(), tuple(list_robots()), torch, listening(Endpoints.of_environment().ctl))


def robots_that_fit(found: Iterable[tuple[int, int]]) -> list[str]:
    """Names of shipped robots all of whose servos are among those found (servo id, model number)."""
    from retarget.robot.loading import list_robots, load_robot

    there = set(found)
    return [
        name for name in list_robots() if {(s.servo_id, s.model.model_number) for s in load_robot(name).servos} <= there
    ]


def fit_line(names: Sequence[str], device: str, baud: int) -> str:
    """The next command to type for the robots that fit."""
    if not names:
        return "no robot that ships has these servos: `mmmd robot new my.urdf` makes yours (docs/robots.md)"
    return f"fits: {', '.join(names)}; next: mmmd doctor --robot {names[0]} --bus dxl://{device}?baud={baud}"


def _usb_ports() -> tuple[Port, ...]:
    from serial.tools.list_ports import comports

    return tuple(Port(str(p.device), str(p.description)) for p in sorted(comports()) if p.vid is not None)
