"""The line that a command prints while the daemon still loads the motion model and the first event is outstanding."""

from __future__ import annotations

import sys
import threading
from typing import TYPE_CHECKING, Self

from daemon.errors import DaemonError

if TYPE_CHECKING:
    from daemon.cli.connection import Connection

NOTE_AFTER_S = 0.5
"""Seconds without an event before the daemon's status is requested: a loaded model answers within 0.1 s."""


class LoadingNote:
    """Writes one line to stderr when a text has no event yet and the daemon's generator is starting.

    The status is requested by a client of its own in a thread of its own, as clients are not for several threads.

    Args:
        at: endpoints of the daemon.
    """

    def __init__(self, at: Connection) -> None:
        self._at = at
        self._timer = threading.Timer(NOTE_AFTER_S, self._ask)
        self._timer.daemon = True  # Ctrl-C does not wait for the timer
        self._answered = False

    def __enter__(self) -> Self:
        self._timer.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.answered()

    def answered(self) -> None:
        """Write nothing from now on: the command has its first event."""
        self._answered = True
        self._timer.cancel()

    def _ask(self) -> None:
        from daemon.generator.client import START_TIMEOUT_S

        try:
            with self._at.client() as robot:
                generator = robot.status().generator
        except DaemonError:  # the command itself reports errors of the daemon
            return
        if generator == "starting" and not self._answered:
            sys.stderr.write(
                f"mmmd: the motion model is being loaded; the text waits for it, {START_TIMEOUT_S:.0f} s at most\n"
            )
            sys.stderr.flush()
