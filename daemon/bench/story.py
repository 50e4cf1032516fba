"""Speed of a long story: ten minutes of motion from 59 texts, streamed, with generated transitions."""

from __future__ import annotations

import time
from typing import Any

from daemon.bench.report import context
from daemon.wire.requests import LONGEST_S

N_SCENES = 59
THREADS = 2


def bench_story(n_scenes: int = N_SCENES, seed: int = 0) -> dict[str, Any]:
    """`total_s`, `motion_s` and `first_frame_ms` of the shipped model on two threads, text encoding included."""
    from daemon.bench.texts import draw_texts
    from mmm_core.generate.engine import Engine
    from mmm_core.generate.story import Scene, generate_story

    engine = Engine.load(threads=THREADS)
    scenes = [Scene(text, LONGEST_S) for text in draw_texts(n_scenes, seed)]
    for _ in generate_story(engine, scenes[:3], seed=seed):
        pass  # warm
    start = time.perf_counter()
    first_s, n_frames = 0.0, 0
    for piece in generate_story(engine, scenes, seed=seed):
        first_s = first_s or time.perf_counter() - start
        n_frames += len(piece.joints_m)
    total_s = time.perf_counter() - start
    return {
        "total_s": round(total_s, 2),
        "motion_s": round(n_frames / 20, 1),
        "first_frame_ms": round(1e3 * first_s, 1),
        "scenes": n_scenes,
        "threads": THREADS,
        **context(seed, f"one run after a warm one, {n_scenes} texts of {LONGEST_S} s, streamed, joints recovered"),
    }
