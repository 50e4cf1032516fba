"""Ctrl-C in a command that moves the robot: the robot brakes, and a second Ctrl-C leaves at once."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
from collections.abc import Generator

from daemon.cli.program import INTERRUPTED


@contextlib.contextmanager
def leaving_at_once(what: str) -> Generator[None]:
    """Let Ctrl-C say that something may go on, and end the process without unwinding it.

    Unwinding closes the sockets, and an exception that comes while one is made may leave it open, for which closing then waits.

    Args:
        what: what may go on: "'wave'", "parking".
    """
    message = f"\nmmmd: left; {what} may go on: `mmmd stop` brakes and holds, `mmmd estop` cuts torque\n"

    def leave(_number: int, _frame: object) -> None:
        try:
            os.write(sys.stderr.fileno(), message.encode())
        finally:
            os._exit(INTERRUPTED)

    before = signal.signal(signal.SIGINT, leave)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
