"""Whether the process that started this one is still there.

Its id is handed over: asked for here it would be that of whoever inherits orphans, when the parent was killed while this
process was starting, and this process would stay for ever.
"""

from __future__ import annotations

import os

PARENT_VARIABLE = "MMMD_PARENT_PID"
"""Set for every child of the daemon (`daemon.supervisor.children`)."""


class Parent:
    """The process that started this one: the id handed over, or whoever it is now where none was."""

    def __init__(self) -> None:
        handed = os.environ.get(PARENT_VARIABLE, "")
        self._pid = int(handed) if handed.isdigit() else os.getppid()

    @property
    def gone(self) -> bool:
        """Whether it has ended."""
        return os.getppid() != self._pid
