"""The line that a command writes while the daemon still loads the motion model and the first answer is outstanding."""

from __future__ import annotations

import sys
import threading
from typing import TYPE_CHECKING, Self

from daemon.errors import DaemonError

if TYPE_CHECKING:
    from daemon.cli.connection import Connection

NOTE_AFTER_S = 0.5
"""Seconds without an answer before the daemon is asked why: a loaded model answers within 0.1 s."""


class LoadingNote:
    """Writes one line to stderr when a text has no answer yet and the daemon says that its generator is starting.

    The daemon is asked by a client of its own in a thread of its own: clients are not for several threads.

    Args:
        at: where the daemon is.
    """

    def __init__(self, at: Connection) -> None:
        self._at = at
        self._timer = threading.Timer(NOTE_AFTER_S, self._ask)
        self._timer.daemon = True  # Ctrl-C is not to wait for it
        self._answered = False

    def __enter__(self) -> Self:
        self._timer.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.answered()

    def answered(self) -> None:
        """The command has its first answer: nothing is written any more."""
        self._answered = True
        self._timer.cancel()

    def _ask(self) -> None:
        from daemon.generator.client import START_TIMEOUT_S

        try:
            with self._at.client() as robot:
                generator = robot.status().generator
        except DaemonError:  # the command itself says what is wrong with the daemon
            return
        if generator == "starting" and not self._answered:
            sys.stderr.write(
                f"mmmd: the motion model is being loaded; the text waits for it, {START_TIMEOUT_S:.0f} s at most\n"
            )
            sys.stderr.flush()
