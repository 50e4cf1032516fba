"""The port to real servos, or to simulated ones behind a tty: pyserial, opened exclusively."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import getpass
import os
import select
import termios
from urllib.parse import SplitResult, parse_qs

import serial

from daemon.dynamixel.ports.adapter import adapter_at, device_of
from daemon.dynamixel.ports.lock import LockFileError, PortLock, process_holding
from daemon.dynamixel.ports.opening import PortContext
from daemon.dynamixel.ports.tty_speed import tty_speed
from daemon.errors import (
    CommandError,
    LinkLostError,
    PortBaudError,
    PortBusyError,
    PortError,
    PortMissingError,
    PortPermissionError,
)


class SerialPort:
    """A `Port` on a serial device. One process at a time, also against root.

    Args:
        device: path of the device, or of a link to it.
        baud: bits per second.
        url: name of the port in messages; the device's path when None.
    """

    def __init__(self, device: str, baud: int, url: str | None = None) -> None:
        self.name, self.baud, self._given = url or device, baud, device
        self._closed = False
        self._open(device)
        self._adapter = adapter_at(device)

    def _open(self, device: str) -> None:
        if not os.path.exists(device):
            raise PortMissingError(
                self.name, f"no device '{device}'", "plug the adapter in, or list them: ls /dev/serial/by-id/"
            )
        try:
            lock = PortLock(device)
        except BlockingIOError as error:
            raise PortBusyError(self.name, f"in use by {error}", "stop it, or ask it: mmmd status") from None
        except LockFileError as error:
            raise PortError(self.name, str(error), f"look at it, then remove it: ls -l {error.path}") from error
        try:
            self._serial = _open(device, self.baud, self.name)
        except BaseException:
            lock.release()
            raise
        self._lock, self.device = lock, device
        self._fd = self._serial.fileno()
        keep_others_out(self._fd)
        self._poll = select.poll()
        self._poll.register(self._fd, select.POLLIN)

    def reopen(self) -> None:
        """Open the device again: at its old path, or at the adapter's new one (another number after a replug).

        Raises:
            LinkLostError: the device is not back, or another process has opened it.
        """
        if self._closed:
            raise LinkLostError(f"{self.name}: closed")
        self._release()
        found = device_of(self._adapter) if self._adapter is not None else None
        why = "not plugged in"
        for device in dict.fromkeys(d for d in (found, self._given) if d is not None):
            try:
                self._open(device)
            except PortError as error:
                why = error.problem
            else:
                return
        raise LinkLostError(f"{self.name}: still lost ({why}); plug it in again")

    def write(self, data: bytes) -> None:
        """Send all of `data`; raises LinkLostError when the device is gone."""
        try:
            while data:
                data = data[os.write(self._fd, data) :]
        except BlockingIOError as error:
            raise LinkLostError(f"{self.name}: takes no more bytes; its other end is stuck") from error
        except OSError as error:
            raise LinkLostError(f"{self.name}: lost ({error.strerror}); plug it in again") from error

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Bytes that arrive within `timeout_s`, sleeping in poll meanwhile."""
        if not self._poll.poll(max(0.0, timeout_s) * 1e3):
            return b""
        try:
            data = os.read(self._fd, max_bytes)
        except BlockingIOError:
            return b""
        except OSError as error:
            raise LinkLostError(f"{self.name}: lost ({error.strerror}); plug it in again") from error
        if not data:
            raise LinkLostError(f"{self.name}: lost (end of file); plug it in again")
        return data

    def close(self) -> None:
        """Release device and lock."""
        self._closed = True
        self._release()

    def _release(self) -> None:
        try:
            if self._serial.is_open:
                fcntl.ioctl(self._fd, termios.TIOCNXCL)
            self._serial.close()
        except OSError:
            pass  # a lost device cannot be released
        self._lock.release()


def keep_others_out(fd: int) -> None:
    """Make the system refuse to open the tty for anybody but root, also by programs that use no lock (TIOCEXCL).

    Not of a pseudo terminal: the simulator at its other end keeps it open, so this would outlive a killed owner.
    """
    if not is_pseudo(fd):
        with contextlib.suppress(OSError):  # a device without this call is protected by the locks alone
            fcntl.ioctl(fd, termios.TIOCEXCL)


def is_pseudo(fd: int) -> bool:
    """Whether an open tty is a pseudo terminal (Linux, Documentation/admin-guide/devices.txt)."""
    return os.major(os.fstat(fd).st_rdev) in _PSEUDO_MAJORS


_PSEUDO_MAJORS = range(136, 144)
_MOST_OFF_SHARE = 0.03
"""Share by which a port's speed may differ from the requested one with servos and adapters still understanding each other."""
_LOOK = "check cable and path: ls -l /dev/serial/by-id/"
_USUAL = "57600, 115200, 1000000, 2000000, 3000000 or 4000000"


def _open(device: str, baud: int, url: str) -> serial.Serial:
    try:
        port = serial.Serial(device, baud, timeout=0, write_timeout=1.0, exclusive=True)
    except serial.SerialException as error:
        if error.errno == errno.EACCES:
            user = getpass.getuser()
            remedy = f"run: sudo usermod -a -G dialout {user}   and log in again"
            raise PortPermissionError(url, f"user '{user}' may not open '{device}'", remedy) from error
        if error.errno in (errno.EBUSY, errno.EAGAIN) or "exclusively lock" in str(error):
            raise PortBusyError(url, f"in use by {process_holding(device)}", "stop that process") from error
        raise PortError(url, str(error), _LOOK) from error
    except (ValueError, OverflowError) as error:
        raise PortBaudError(url, f"baud {baud} is not possible ({error})", f"allowed: {_USUAL}") from error
    except (OSError, termios.error) as error:  # an adapter that is lost again while it is set up
        raise PortError(url, str(error), _LOOK) from error
    try:
        speed = tty_speed(port.fileno())
    except (OSError, termios.error) as error:
        port.close()
        raise PortError(url, str(error), _LOOK) from error
    if speed is not None and abs(speed - baud) > _MOST_OFF_SHARE * baud:
        port.close()
        raise PortBaudError(url, f"baud {baud} is not possible (the port went to {speed})", f"allowed: {_USUAL}")
    return port


def open_dxl(url: SplitResult, context: PortContext) -> SerialPort:
    """Open `dxl:///dev/ttyUSB0?baud=1000000` or `dxl://./servos`; without a baud the robot file's is used."""
    device = url.netloc + url.path
    name = f"dxl://{device}" + (f"?{url.query}" if url.query else "")  # `geturl` would take two slashes out
    query = parse_qs(url.query, strict_parsing=bool(url.query))
    unknown = query.keys() - {"baud"}
    if unknown or not device:
        raise CommandError(f"bus '{name}': {', '.join(unknown) or 'no device'}; allowed: dxl://PATH?baud=NUMBER")
    text = query.get("baud", [str(context.robot.bus.baud)])[0]
    if not text.isdigit():
        raise CommandError(f"bus '{name}': baud '{text}' is not a number; example: baud=1000000")
    return SerialPort(device, int(text), name)
