"""systemd's readiness and watchdog protocol (sd_notify): one datagram to $NOTIFY_SOCKET. Does nothing without systemd."""

from __future__ import annotations

import contextlib
import os
import socket


class Notifier:
    """Reports the service's state to systemd.

    Attributes:
        watchdog_s: longest seconds between two signs of life that systemd expects; None for no watchdog.
    """

    def __init__(self) -> None:
        self._address = os.environ.get("NOTIFY_SOCKET", "")
        micro = os.environ.get("WATCHDOG_USEC", "")
        mine = os.environ.get("WATCHDOG_PID", str(os.getpid())) == str(os.getpid())
        self.watchdog_s = int(micro) * 1e-6 if micro.isdigit() and mine and self._address else None

    def ready(self, status: str) -> None:
        """Report that the service is ready."""
        self._send(f"READY=1\nSTATUS={status}")

    def alive(self) -> None:
        """Report that the service works."""
        self._send("WATCHDOG=1")

    def stopping(self) -> None:
        """Report that the service parks the robot and ends."""
        self._send("STOPPING=1")

    def _send(self, text: str) -> None:
        if not self._address:
            return
        address = "\0" + self._address[1:] if self._address.startswith("@") else self._address
        with contextlib.suppress(OSError), socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as s:
            s.setblocking(False)
            s.sendto(text.encode(), address)
