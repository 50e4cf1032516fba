"""Errors of the motion model.

MmmError
├── MotionFileError(path, key, found, allowed)   a motion or caption file that cannot be used   (ValueError)
├── CheckpointError(path, key, found, expected)  weights that do not fit this code              (ValueError)
├── GenerationError(asked, allowed)              a request outside the model's range            (ValueError)
├── TrainingDataError(path, key, found, allowed) a training corpus that cannot be read           (ValueError)
└── EvaluationError(found, allowed)              things that cannot be measured together         (ValueError)
"""

from __future__ import annotations

from pathlib import Path


class MmmError(Exception):
    """Base class of every error that the motion model raises."""


class _FileError(MmmError, ValueError):
    """A file with a wrong value: keeps path, key, found and allowed, and says all four."""

    def __init__(self, path: Path | str, key: str, found: str, allowed: str) -> None:
        self.path, self.key, self.found, self.allowed = Path(path), key, found, allowed
        where = f"{path}: key '{key}'" if key else f"{path}"
        super().__init__(f"{where}: {found}; expected {allowed}")


class MotionFileError(_FileError):
    """A file that cannot be read as a motion."""


class CheckpointError(_FileError):
    """A checkpoint that is missing, corrupt or made for another model."""


class TrainingDataError(_FileError):
    """A training folder that is missing, empty or inconsistent."""


class GenerationError(MmmError, ValueError):
    """A request outside the model's range, such as a seed, a length or a text."""

    def __init__(self, asked: str, allowed: str) -> None:
        self.asked, self.allowed = asked, allowed
        super().__init__(f"{asked}; allowed: {allowed}")


class EvaluationError(MmmError, ValueError):
    """Motions, texts, model and evaluator that cannot be measured together."""

    def __init__(self, found: str, allowed: str) -> None:
        self.found, self.allowed = found, allowed
        super().__init__(f"{found}; expected {allowed}")
