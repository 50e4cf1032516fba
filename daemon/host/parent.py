"""Whether the process that started this one still exists.

The parent passes its id: if it was killed while this process was starting, `getppid` would return the id of the process that
inherits orphans, and this process would stay for ever.
"""

from __future__ import annotations

import os

PARENT_VARIABLE = "MMMD_PARENT_PID"
"""Name of the environment variable with the parent's id; set for every child of the daemon (`daemon.supervisor.children`)."""


class Parent:
    """The process that started this one: the id it passed, or the present parent without one."""

    def __init__(self) -> None:
        handed = os.environ.get(PARENT_VARIABLE, "")
        self._pid = int(handed) if handed.isdigit() else os.getppid()

    @property
    def gone(self) -> bool:
        """Whether the parent has ended."""
        return os.getppid() != self._pid
