"""What an answer of the engine is: the motion, or none, how the text was taken and how long it took."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from mmm_core.language.scope import ScopeVerdict
from mmm_core.motion.motion import FPS, N_FEATURES, N_JOINTS, Motion


@dataclass(frozen=True)
class Generation:
    """A motion and how the text was taken.

    Attributes:
        motion: the motion; of length zero when rejected.
        understood: the nearest known command and its score.
        reason: why the text was degraded or rejected, else empty.
        timings_ms: milliseconds spent in each stage.
    """

    motion: Motion
    understood: str
    reason: str
    timings_ms: dict[str, float]

    @property
    def status(self) -> str:
        """accepted, degraded or rejected."""
        return self.motion.status

    @property
    def scope_score(self) -> float:
        """How near the text lies to what the model can do."""
        return self.motion.scope_score


class Clock:
    """Milliseconds between laps."""

    def __init__(self) -> None:
        """Starts with the first lap."""
        self.laps_ms: dict[str, float] = {}
        self._last = time.perf_counter()

    def lap(self, name: str) -> None:
        """Time since the last lap, under a name."""
        now = time.perf_counter()
        self.laps_ms[name] = 1e3 * (now - self._last)
        self._last = now


def no_motion(text: str, seed: int, verdict: ScopeVerdict) -> Motion:
    """The record of a rejected text: no frames."""
    return Motion(
        joints_m=np.zeros((0, N_JOINTS, 3), np.float32),
        fps=FPS,
        head_quat_wxyz=np.zeros((0, 4), np.float32),
        forearm_twist_rad=np.zeros((0, 2), np.float32),
        features=np.zeros((0, N_FEATURES), np.float32),
        tokens=np.zeros(0, np.int32),
        text=text,
        seed=seed,
        status="rejected",
        scope_score=verdict.score,
    )


def understood(verdict: ScopeVerdict) -> str:
    """The nearest known command and its score; empty where none is near."""
    return f"{verdict.nearest} ({verdict.score:.2f})" if verdict.nearest else ""
