"""Speed of a long story: ten minutes of motion from 59 texts, streamed, with generated transitions."""

from __future__ import annotations

import statistics
import time
from typing import TYPE_CHECKING, Any

from daemon.bench.report import context
from daemon.wire.requests import LONGEST_S

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mmm_core.generate.engine import Engine
    from mmm_core.generate.story import Scene

N_SCENES = 59
THREADS = 2
N_RUNS = 5
"""Runs whose medians are reported: single ones of two threads differ by a third."""


def bench_story(n_scenes: int = N_SCENES, seed: int = 0) -> dict[str, Any]:
    """Medians of the shipped model on two threads, text encoding included, and `total_each_s` of all runs."""
    from daemon.bench.texts import draw_texts
    from mmm_core.generate.engine import Engine
    from mmm_core.generate.story import Scene, generate_story

    engine = Engine.load(threads=THREADS)
    scenes = [Scene(text, LONGEST_S) for text in draw_texts(n_scenes, seed)]
    for _ in generate_story(engine, scenes[:3], seed=seed):
        pass  # warm
    runs = [_timed(engine, scenes, seed) for _ in range(N_RUNS)]
    totals_s, firsts_s, motions_s = zip(*runs, strict=True)
    return {
        "total_s": round(statistics.median(totals_s), 2),
        "total_each_s": [round(s, 2) for s in totals_s],
        "motion_s": round(motions_s[0], 1),
        "first_frame_ms": round(1e3 * statistics.median(firsts_s), 1),
        "scenes": n_scenes,
        "threads": THREADS,
        **context(
            seed,
            f"median of {N_RUNS} runs after a warm one, {n_scenes} texts of {LONGEST_S} s, streamed, joints recovered",
        ),
    }


def _timed(engine: Engine, scenes: Sequence[Scene], seed: int) -> tuple[float, float, float]:
    """Seconds that a story took, seconds until its first frame, and seconds of its motion."""
    from mmm_core.generate.story import generate_story

    start = time.perf_counter()
    first_s, n_frames = 0.0, 0
    for piece in generate_story(engine, scenes, seed=seed):
        first_s = first_s or time.perf_counter() - start
        n_frames += len(piece.joints_m)
    return time.perf_counter() - start, first_s, n_frames / 20
