"""Strokes of a motion are counted, whatever moves."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from mmm_core.motion.motion import Motion
from mmm_core.motion.repetitions import strokes_of
from tests.support.shipped import shipped_engine


@cache
def nodding() -> Motion:
    return shipped_engine().generate("nod", seed=0).motion


def swinging(n: int, period: int = 12, rest: int = 8) -> Motion:
    """A body that stands still, its head nodding so often."""
    T = 2 * rest + n * period
    pitch = np.zeros(T)
    pitch[rest : rest + n * period] = 0.2 * (1 - np.cos(2 * np.pi * np.arange(n * period) / period))
    head = np.stack([np.cos(pitch / 2), np.sin(pitch / 2), 0 * pitch, 0 * pitch], -1).astype(np.float32)
    still = np.repeat(nodding().joints_m[:1], T, axis=0)
    return replace(
        nodding(), joints_m=still, head_quat_wxyz=head, forearm_twist_rad=np.zeros((T, 2), np.float32),
        features=np.zeros((T, nodding().features.shape[1]), np.float32), tokens=np.zeros(0, np.int64),
    )  # fmt: skip


@pytest.mark.parametrize("n", [2, 3, 4, 5, 8])
@pytest.mark.parametrize("period", [8, 12, 17])
def test_strokes_are_counted_whatever_moves(n: int, period: int) -> None:
    found = strokes_of(swinging(n, period))
    assert found is not None and found.sure and len(found.frames) == n
    assert all(abs(b - a - period) <= 1 for a, b in pairwise(found.frames))
    assert found.misfit < 0.1


def test_nothing_moves_nothing_is_counted() -> None:
    assert strokes_of(swinging(0, rest=20)) is None
