"""Errors of the motion model.

MmmError
├── WrongFileError(path, key, found, allowed)    a file that cannot be used                      (ValueError)
│   ├── MotionFileError                          a motion or caption file
│   ├── CheckpointError                          weights that do not fit this code
│   └── TrainingDataError                        a recipe or a training corpus
├── GenerationError(asked, allowed)              a request outside the model's range             (ValueError)
│   └── TextRefusedError(text, reason)           a text that the model cannot do
└── EvaluationError(found, allowed)              things that cannot be measured together         (ValueError)
"""

from __future__ import annotations

from pathlib import Path


class MmmError(Exception):
    """Base class of every error that the motion model raises."""


class WrongFileError(MmmError, ValueError):
    """A file with a wrong value: keeps path, key, found and allowed, and says all four."""

    def __init__(self, path: Path | str, key: str, found: str, allowed: str) -> None:
        self.path, self.key, self.found, self.allowed = Path(path), key, found, allowed
        where = f"{path}: key '{key}'" if key else f"{path}"
        super().__init__(f"{where}: {found}; expected {allowed}")


class MotionFileError(WrongFileError):
    """A file that cannot be read as a motion."""


class CheckpointError(WrongFileError):
    """A checkpoint that is missing, corrupt or made for another model."""


class TrainingDataError(WrongFileError):
    """A training folder that is missing, empty or inconsistent."""


class GenerationError(MmmError, ValueError):
    """A request outside the model's range, such as a seed, a length or a text."""

    def __init__(self, asked: str, allowed: str) -> None:
        self.asked, self.allowed = asked, allowed
        super().__init__(f"{asked}; allowed: {allowed}")


class TextRefusedError(GenerationError):
    """A text that the model cannot do."""

    def __init__(self, text: str, reason: str) -> None:
        super().__init__(f"the text '{text[:80]}' was given: {reason}", "what this model can do")


class EvaluationError(MmmError, ValueError):
    """Motions, texts, model and evaluator that cannot be measured together."""

    def __init__(self, found: str, allowed: str) -> None:
        self.found, self.allowed = found, allowed
        super().__init__(f"{found}; expected {allowed}")
