"""The simulated servos behind a real tty: any program that opens a serial port can talk to them, in real time.

A pty neither delays bytes nor has a baud; the simulator keeps the wire's time itself and reads from the tty the speed that the
client has set: at another baud the servos stay silent. When unplugged, the tty is gone (its client reads EIO) and comes back as
another one, under the same link or another.
"""

from __future__ import annotations

import contextlib
import logging
import os
import pty
import select
import tty
from pathlib import Path

from daemon.dynamixel.ports.tty_speed import tty_speed
from daemon.errors import CommandError
from sim.audit.audit import TTY_GOALS
from sim.bus import SimBus
from sim.errors import FaultFileError
from sim.steal_time import machine_time

log = logging.getLogger(__name__)

_IDLE_S = 0.05
"""Seconds of the longest step of the servos' time, so that watchdogs run out when no client sends."""


class PtyServer:
    """Serves a `SimBus` on a pseudo terminal, with a link at a chosen path. Clients may come and go."""

    def __init__(self, bus: SimBus, link: Path | None = None, baud: int | None = None) -> None:
        self.bus, self.link = bus, link
        bus.audit.waiting_goals = TTY_GOALS
        if any(f.kind == "clock_jump" for f in bus.faults.faults):
            raise FaultFileError("fault schedule", "kind", "clock_jump behind a tty", "virtual time: sim:// in process")
        if baud is not None:
            bus.set_baud(baud)
        self.baud = baud or bus.robot.bus.baud
        """Bits per second assumed where the system cannot name the tty's speed."""
        self.overruns = 0
        """Bytes lost because the client did not read."""
        self._master, self._slave, self.device = -1, -1, ""
        self._linked: Path | None = None
        self._wake_r, self._wake_w = os.pipe()
        self._start_s = machine_time().now_s()
        try:
            self._plug(link)
        except CommandError:
            self.close()
            raise

    def serve(self) -> None:
        """Answer until `stop` is called."""
        while True:
            now_s = self._now_s()
            with self.bus.world.lock:
                self.bus.world.advance(now_s)
                self._follow_plug(now_s)
            waiting = [self._wake_r] if self._master < 0 else [self._wake_r, self._master]
            ready, _, _ = select.select(waiting, [], [], self._pause_s(now_s))
            if self._wake_r in ready:
                return
            if self._master >= 0 and self._master in ready:
                try:
                    data = os.read(self._master, 4096)
                except (BlockingIOError, OSError):
                    data = b""
                if data:
                    self.bus.receive(data, self._now_s(), self._client_baud(), patient=True)
            self._deliver()

    def stop(self) -> None:
        """Make `serve` return; may be called from a signal handler."""
        os.write(self._wake_w, b"x")

    def close(self) -> None:
        """Close the tty and remove the link."""
        self._unplug()
        for fd in (self._wake_r, self._wake_w):
            with contextlib.suppress(OSError):
                os.close(fd)

    def _now_s(self) -> float:
        return machine_time().now_s() - self._start_s

    def _pause_s(self, now_s: float) -> float:
        """Seconds until the next bytes are due."""
        ready_s = self.bus.wire.ready_s() if self._master >= 0 else None
        return _IDLE_S if ready_s is None else min(_IDLE_S, max(0.0, ready_s - now_s))

    def _deliver(self) -> None:
        """Write the bytes that are due to the client."""
        with self.bus.world.lock:
            now_s = self._now_s()
            ready_s = self.bus.wire.ready_s()
            if self._master < 0 or ready_s is None or ready_s > now_s:
                return
            data = self.bus.wire.take(now_s)
        try:
            written = os.write(self._master, data)
        except (BlockingIOError, OSError):
            written = 0
        self.overruns += len(data) - written

    def _follow_plug(self, now_s: float) -> None:
        """Remove the tty, or open another, as the fault schedule says."""
        fault = self.bus.faults.active("unplug", now_s)
        if fault is not None and self._master >= 0:
            log.info("%.3f s: unplugged: %s is gone", now_s, self.device)
            self._replug_at = Path(fault.path) if fault.path is not None else self.link
            self._unplug()
        elif fault is None and self._master < 0:
            self._plug(self._replug_at)
            log.info("%.3f s: plugged in: %s", now_s, self._linked or self.device)

    def _plug(self, link: Path | None) -> None:
        """Open a tty and let the link point to it.

        Raises:
            CommandError: a file that is no link is at the link's path.
        """
        if link is not None and link.exists() and not link.is_symlink():
            raise CommandError(f"--link {link}: exists and is no link; choose another path")
        self._master, self._slave = pty.openpty()  # our own slave end stays open, so that a client may leave
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        self.device = os.ttyname(self._slave)
        if link is not None:
            link.unlink(missing_ok=True)
            link.symlink_to(self.device)
        self._linked = link

    def _unplug(self) -> None:
        self.bus.wire.clear()
        if self._linked is not None and self._linked.is_symlink() and os.readlink(self._linked) == self.device:
            self._linked.unlink()
        for fd in (self._master, self._slave):
            with contextlib.suppress(OSError):
                os.close(fd)
        self._master = self._slave = -1

    def _client_baud(self) -> int:
        """Baud that the client has set; the servos' own where the system cannot tell."""
        speed = tty_speed(self._slave)
        return self.baud if speed is None else speed
