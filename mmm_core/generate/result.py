"""The result of a generation: the motion, or an empty one, how the text was understood, and the time each stage took."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from mmm_core.language.commands import Reading
from mmm_core.language.scope import ScopeVerdict
from mmm_core.motion.motion import FPS, N_FEATURES, N_JOINTS, Motion
from mmm_core.recognition.seen import Scene


@dataclass(frozen=True)
class GenerationResult:
    """A motion and how its text was understood.

    Attributes:
        motion: the motion; of length zero when rejected.
        understood: the nearest known command and its score.
        reason: why the text was degraded or rejected, else empty.
        timings_ms: milliseconds spent in each stage.
        scenes: the parts of the motion with the words of each; empty for a motion of one part.
        read: the commands that were read in the text; None where no text was read.
    """

    motion: Motion
    understood: str
    reason: str
    timings_ms: dict[str, float]
    scenes: tuple[Scene, ...] = ()
    read: Reading | None = None

    @property
    def status(self) -> str:
        """Scope verdict: accepted, degraded or rejected."""
        return self.motion.status

    @property
    def scope_score(self) -> float:
        """Score of the text from 0 (the model can do nothing of it) to 1."""
        return self.motion.scope_score


class StageTimer:
    """Measures the duration of each stage of one generation."""

    def __init__(self) -> None:
        self.laps_ms: dict[str, float] = {}
        self._last = time.perf_counter()

    def lap(self, name: str) -> None:
        """Record under `name` the milliseconds since the lap before, or since the start."""
        now = time.perf_counter()
        self.laps_ms[name] = 1e3 * (now - self._last)
        self._last = now


def no_motion(text: str, seed: int, verdict: ScopeVerdict) -> Motion:
    """The motion of a rejected text, which has no frames."""
    return Motion(
        joints_m=np.zeros((0, N_JOINTS, 3), np.float32),
        fps=FPS,
        head_quat_wxyz=np.zeros((0, 4), np.float32),
        forearm_twist_rad=np.zeros((0, 2), np.float32),
        features=np.zeros((0, N_FEATURES), np.float32),
        tokens=np.zeros(0, np.int64),
        text=text,
        seed=seed,
        status="rejected",
        scope_score=verdict.score,
    )


def understood_as(verdict: ScopeVerdict) -> str:
    """Nearest known command and its score, as users see them: "wave (0.93)"; empty where none is near."""
    return f"{verdict.nearest} ({verdict.score:.2f})" if verdict.nearest else ""
