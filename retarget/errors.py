"""Errors of retargeting.

RetargetError
├── UnknownRobotError(name, known)                 no robot of that name                    (LookupError)
├── RobotFileError(path, key, found, allowed)      a robot file or description that cannot be used  (ValueError)
└── MotionError(key, found, allowed, of)           a human motion that cannot be retargeted (ValueError)
"""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from pathlib import Path


class RetargetError(Exception):
    """Base of all errors between a human motion and servo ticks."""


class UnknownRobotError(RetargetError, LookupError):
    """A robot's name that is neither a packaged robot nor a path to a robot.toml."""

    def __init__(self, name: str, known: Sequence[str]) -> None:
        self.name, self.known = name, tuple(known)
        if "/" in name or name.endswith(".toml"):
            found = f"robot '{name}': no such file, and no folder with a robot.toml"
        else:
            like = difflib.get_close_matches(name, known, 1)
            found = f"unknown robot '{name}'{f', did you mean {like[0]}?' if like else ''}"
        super().__init__(f"{found}; known: {', '.join(known)}; or give the path of a robot.toml")


class RobotFileError(RetargetError, ValueError):
    """A robot file with a wrong key, unit or value."""

    def __init__(self, path: Path | str, key: str, found: str, allowed: str) -> None:
        self.path, self.key, self.found, self.allowed = Path(path), key, found, allowed
        super().__init__(f"{path}: {key}: {found}; allowed: {allowed}")


class MotionError(RetargetError, ValueError):
    """A human motion that cannot be retargeted; `of` names the motion, or the file that it was read from."""

    def __init__(self, key: str, found: str, allowed: str, of: str = "motion") -> None:
        self.key, self.found, self.allowed, self.of = key, found, allowed, of
        super().__init__(f"{of}: {key}: {found}; allowed: {allowed}")
