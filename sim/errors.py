"""Errors of the simulator.

SimError                                 (DaemonError: the commands print it and end with status 1 or 2)
├── FaultFileError(path, where)          a fault schedule that cannot be used          (ConfigError)
└── SimSettingError(setting)             a setting outside what is allowed             (CommandError)
"""

from __future__ import annotations

from pathlib import Path

from daemon.errors import CommandError, ConfigError, DaemonError


class SimError(DaemonError):
    """Base of the simulator's errors."""


class FaultFileError(SimError, ConfigError):
    """A fault schedule that cannot be used; the text has the place, the value found and the allowed ones."""

    def __init__(self, path: Path | str, where: str, found: str, allowed: str) -> None:
        self.path, self.where, self.found, self.allowed = path, where, found, allowed
        super().__init__(f"{path}: {where}: {found}; allowed: {allowed}")


class SimSettingError(SimError, CommandError):
    """A simulator setting outside its allowed values."""

    def __init__(self, setting: str, found: str, allowed: str) -> None:
        self.setting, self.found, self.allowed = setting, found, allowed
        super().__init__(f"{setting} = {found}; allowed: {allowed}")
