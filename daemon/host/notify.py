"""systemd's readiness and watchdog protocol (sd_notify): one datagram to $NOTIFY_SOCKET. Nothing without systemd."""

from __future__ import annotations

import contextlib
import os
import socket


class Notifier:
    """Tells systemd how the service is.

    Attributes:
        watchdog_s: how often systemd wants a sign of life at least; None when it does not.
    """

    def __init__(self) -> None:
        self._address = os.environ.get("NOTIFY_SOCKET", "")
        micro = os.environ.get("WATCHDOG_USEC", "")
        mine = os.environ.get("WATCHDOG_PID", str(os.getpid())) == str(os.getpid())
        self.watchdog_s = int(micro) * 1e-6 if micro.isdigit() and mine and self._address else None

    def ready(self, status: str) -> None:
        """The service is up."""
        self._send(f"READY=1\nSTATUS={status}")

    def alive(self) -> None:
        """The service works."""
        self._send("WATCHDOG=1")

    def stopping(self) -> None:
        """The service parks and ends."""
        self._send("STOPPING=1")

    def _send(self, text: str) -> None:
        if not self._address:
            return
        address = "\0" + self._address[1:] if self._address.startswith("@") else self._address
        with contextlib.suppress(OSError), socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as s:
            s.setblocking(False)
            s.sendto(text.encode(), address)
