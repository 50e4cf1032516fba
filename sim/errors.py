"""Errors of the simulator.

SimError                                 (DaemonError: the commands print it and end with status 1 or 2)
├── FaultFileError(path, where)          a fault schedule that cannot be used          (ConfigError)
└── SimSettingError(setting)             a setting outside what is allowed             (CommandError)
"""

from __future__ import annotations

from pathlib import Path

from daemon.errors import CommandError, ConfigError, DaemonError


class SimError(DaemonError):
    """Anything the simulator cannot do."""


class FaultFileError(SimError, ConfigError):
    """A fault schedule that cannot be used: where, what was found, what is allowed."""

    def __init__(self, path: Path | str, where: str, found: str, allowed: str) -> None:
        self.path, self.where, self.found, self.allowed = path, where, found, allowed
        super().__init__(f"{path}: {where}: {found}; allowed: {allowed}")


class SimSettingError(SimError, CommandError):
    """A setting outside what is allowed."""

    def __init__(self, setting: str, found: str, allowed: str) -> None:
        self.setting, self.found, self.allowed = setting, found, allowed
        super().__init__(f"{setting} = {found}; allowed: {allowed}")
