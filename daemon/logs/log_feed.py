"""Log lines of all the daemon's processes on `v1/log`: from each by a Unix datagram, which never waits for a reader."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import socket
import time
from collections.abc import Callable
from pathlib import Path

import msgspec

from daemon.wire.status import LogEvent

SOCKET_VARIABLE = "MMMD_LOG_SOCKET"
"""Environment variable with the path of the socket to which the daemon's children send their lines."""
EVENT_LOGGER = "daemon.front.events"
"""Name of the logger whose lines only repeat `v1/event`."""
MOST_BYTES = 8192
LINES_AT_ONCE = 100
"""Number of lines received before the event loop continues with other tasks."""


class LogSender(logging.Handler):
    """Sends each log line of a process to the front; a line for which there is no room or no receiver is lost to `v1/log` alone."""

    def __init__(self, process: str, path: str) -> None:
        super().__init__()
        self._process = process
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        self._path = path
        self.addFilter(lambda record: record.name != EVENT_LOGGER)

    def emit(self, record: logging.LogRecord) -> None:
        """Send one line; a line that cannot be written is reported on stderr, as by logging, and stops no work."""
        try:
            line = msgspec.json.encode(self._event(record))
        except Exception:  # the text of an argument may raise any error
            self.handleError(record)
            return
        with contextlib.suppress(OSError):
            self._socket.sendto(line, self._path)

    def _event(self, record: logging.LogRecord) -> LogEvent:
        text = record.getMessage()
        if record.exc_info and record.exc_info[1] is not None:
            text += f" ({type(record.exc_info[1]).__name__}: {record.exc_info[1]})"
        age_s = max(0.0, time.time() - record.created)
        return LogEvent(
            level=record.levelname.lower(), process=self._process, module=record.name, text=text[: MOST_BYTES // 4],
            t_mono=time.monotonic() - age_s,
        )  # fmt: skip

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()
        super().close()


class LogFeed:
    """Receives the lines of this process and its children, and hands them on in the event loop.

    Args:
        path: path of the socket, in a folder that only this user can write to.
        publish: called with each line.
    """

    def __init__(self, path: Path, publish: Callable[[LogEvent], None]) -> None:
        self._publish = publish
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        self._socket.bind(str(path))
        self._sender = LogSender("front", str(path))

    def start(self) -> None:
        """Begin to receive, in the running event loop."""
        asyncio.get_running_loop().add_reader(self._socket, self._read)
        logging.getLogger().addHandler(self._sender)

    def close(self) -> None:
        """Stop receiving; lines are still written to stderr."""
        logging.getLogger().removeHandler(self._sender)
        with contextlib.suppress(RuntimeError):  # the loop has ended already
            asyncio.get_running_loop().remove_reader(self._socket)
        self._sender.close()
        self._socket.close()

    def _read(self) -> None:
        for _ in range(LINES_AT_ONCE):
            try:
                line = self._socket.recv(MOST_BYTES)
            except BlockingIOError:
                return
            with contextlib.suppress(Exception):  # another program of this user may have sent any bytes
                self._publish(msgspec.json.decode(line, type=LogEvent))


def send_logs(process: str) -> None:
    """Send this process's lines to the front that started it, if one did."""
    path = os.environ.get(SOCKET_VARIABLE)
    if path:
        logging.getLogger().addHandler(LogSender(process, path))
