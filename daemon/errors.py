"""Errors of the daemon and its bus.

DaemonError
├── PortError(url)                 the port cannot be opened                         (OSError)
│   ├── PortMissingError           no such device
│   ├── PortBusyError(owner)       somebody else holds it
│   ├── PortPermissionError        the user may not open it
│   └── PortBaudError              it does not take this speed
├── CommandError                   ours: refused before any byte was sent            (ValueError)
├── ServoFaultError(servo_id)      it answered, and said no
├── BusMismatchError(rows)         other servos than the robot file says
├── LinkError                      bytes lost or bad
│   ├── LinkTimeoutError           no answer in time                                 (TimeoutError)
│   │   └── LinkGarbledError       bytes each time, and no answer
│   ├── LinkLostError              the device is gone
│   └── PacketError                bytes that are no whole packet                    (ValueError)
├── LogError(path)                 a log that cannot be read                         (ValueError)
├── ConfigError(key)               a setting outside what is allowed                 (ValueError)
├── NoCpuBuildError                no PyTorch without GPU libraries to install
├── ClipError                      a gesture that cannot be read or kept             (ValueError)
│   ├── UnknownGestureError(name)  no gesture of that name
│   ├── GestureNameError(name)     no gesture can have that name
│   └── GestureExistsError(name)   there is one of that name already
└── RequestError(code)             a message that cannot be carried out              (ValueError)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


class DaemonError(Exception):
    """Anything that goes wrong between a command and the servos."""


class PortError(DaemonError, OSError):
    """The port cannot be opened."""

    def __init__(self, url: str, problem: str, remedy: str) -> None:
        self.url, self.problem, self.remedy = url, problem, remedy
        super().__init__(f"{url}: {problem}; {remedy}")


class PortMissingError(PortError):
    """No such device."""


class PortBusyError(PortError):
    """Another process holds the port."""


class PortPermissionError(PortError):
    """The user may not open the port."""


class PortBaudError(PortError):
    """The port does not take this speed."""


class CommandError(DaemonError, ValueError):
    """A command refused before any byte was sent."""


class ServoFaultError(DaemonError):
    """A servo answered with an error."""

    def __init__(self, servo_id: int, asked: str, found: str) -> None:
        self.servo_id = servo_id
        super().__init__(f"servo {servo_id}: {asked}: answered '{found}'")


@dataclass(frozen=True)
class MismatchRow:
    """A servo whose answer differs from the robot file: the expected one and the one found."""

    servo_id: int
    joint_name: str
    expected: str
    found: str


class BusMismatchError(DaemonError):
    """The servos on the bus differ from the robot file."""

    def __init__(self, rows: Sequence[MismatchRow], hint: str) -> None:
        self.rows = tuple(rows)
        lines = [f"  {r.servo_id:>3}  {r.joint_name:<24} {r.expected:<14} {r.found}" for r in rows]
        head = f"  {'id':>3}  {'joint':<24} {'expected':<14} found"
        super().__init__("\n".join(["the servos on the bus are not those of the robot file:", head, *lines, hint]))


class LinkError(DaemonError):
    """Bytes on the bus were lost or bad."""


class LinkTimeoutError(LinkError, TimeoutError):
    """No answer in time."""


class LinkGarbledError(LinkTimeoutError):
    """A servo's answers were garbled each time: two servos have its id, or there is noise."""

    def __init__(self, servo_id: int, port: str, tries: int) -> None:
        self.servo_id = servo_id
        super().__init__(f"servo {servo_id}: {tries} answers came garbled on {port}: {two_of(servo_id)}")


class LinkLostError(LinkError):
    """The device is gone: unplugged, or its other end closed."""


class PacketError(LinkError, ValueError):
    """The content of a packet does not fit its instruction."""


class LogError(DaemonError, ValueError):
    """A log that cannot be read."""


class ConfigError(DaemonError, ValueError):
    """A setting outside what is allowed."""


class RequestError(DaemonError, ValueError):
    """A message that cannot be carried out; `code` is for programs, the text for people."""

    def __init__(self, code: str, message: str) -> None:
        self.code = code
        super().__init__(message)


class NoCpuBuildError(DaemonError):
    """No package index has a PyTorch without GPU libraries for this machine."""


class ClipError(DaemonError, ValueError):
    """A gesture that cannot be read or kept."""


class UnknownGestureError(ClipError):
    """No gesture of that name."""

    def __init__(self, name: str, near: Sequence[str], known: int) -> None:
        self.name, self.near = name, tuple(near)
        like = f"; near to it: {', '.join(near)}" if near else ""
        super().__init__(f"gesture {name!r}: not among the {known} known ones{like}; `mmmd gesture list` shows all")


class GestureNameError(ClipError):
    """A name that no gesture can have."""

    def __init__(self, name: str) -> None:
        self.name = name
        super().__init__(f"gesture name {name!r}; allowed: 1 to 64 of a-z, 0-9 and _, for example 'my_wave'")


class GestureExistsError(ClipError):
    """A gesture has that name already."""

    def __init__(self, name: str, *, own: bool) -> None:
        self.name, self.own = name, own
        found = "one of your own" if own else "one that ships, whose place yours would take"
        super().__init__(f"gesture '{name}': there is {found}; choose another name, or add --replace")


def two_of(servo_id: int) -> str:
    """Text for people about the garbled answers of a servo: their cause, and what to do."""
    return f"two servos with id {servo_id}, or noise; unplug one of them and give the other a new id (mmmd servo id)"
