"""The simulated servos behind a real tty: anything that opens a serial port can talk to them.

A pty paces nothing and knows no baud; the simulator keeps the wire's time itself and reads the speed the client has set
from the tty: at another baud the servos stay silent.
"""

from __future__ import annotations

import os
import pty
import select
import termios
import time
import tty
from pathlib import Path

from daemon.errors import CommandError
from sim.bus import SimBus

_SPEEDS = {getattr(termios, name): int(name[1:]) for name in dir(termios) if name[0] == "B" and name[1:].isdigit()}
_OTHER_SPEED = getattr(termios, "BOTHER", 0o010000)


class PtyServer:
    """Serves a `SimBus` on a pseudo terminal, with a link at a path of choice. Clients may come and go."""

    def __init__(self, bus: SimBus, link: Path | None = None, baud: int | None = None) -> None:
        self.bus = bus
        self.baud = baud or bus.robot.bus.baud
        """What the servos are set to."""
        self._master, self._slave = pty.openpty()  # our own slave end stays open, so that a client may leave
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        self.device = os.ttyname(self._slave)
        self.link = link
        self._start_s = time.monotonic()
        self._wake_r, self._wake_w = os.pipe()
        if link is not None:
            if link.is_symlink():
                link.unlink()
            elif link.exists():
                self.close()
                raise CommandError(f"--link {link}: exists and is no link; choose another path")
            link.symlink_to(self.device)

    def serve(self) -> None:
        """Answer until `stop` is called."""
        while True:
            ready, _, _ = select.select([self._master, self._wake_r], [], [])
            if self._wake_r in ready:
                return
            try:
                data = os.read(self._master, 4096)
            except (BlockingIOError, OSError):
                continue
            now = time.monotonic() - self._start_s
            if self.bus.faults.active("unplug", now) or self._client_baud() != self.baud:
                continue
            for at_s, reply in self._grouped(self.bus.receive(data, now, self.baud)):
                left = at_s + self._start_s - time.monotonic()
                if left > 0:
                    time.sleep(left)
                os.write(self._master, reply)

    @staticmethod
    def _grouped(replies: list[tuple[float, bytes]]) -> list[tuple[float, bytes]]:
        """Replies that follow each other at once arrive as one piece, as through a buffered adapter."""
        return [(replies[-1][0], b"".join(raw for _, raw in replies))] if replies else []

    def stop(self) -> None:
        """Make `serve` return; may be called from a signal handler."""
        os.write(self._wake_w, b"x")

    def close(self) -> None:
        """Remove the link and the tty."""
        if self.link is not None and self.link.is_symlink():
            self.link.unlink()
        for fd in (self._master, self._slave, self._wake_r, self._wake_w):
            try:
                os.close(fd)
            except OSError:
                pass

    def _client_baud(self) -> int:
        """Speed that the client has set; the servos' own where the system cannot tell."""
        speed = termios.tcgetattr(self._slave)[5]
        return _SPEEDS.get(speed, self.baud) if speed != _OTHER_SPEED else self.baud
