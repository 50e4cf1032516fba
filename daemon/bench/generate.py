"""Speed of generation: a whole 196-frame motion on one thread, beside one forward pass of the official size."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from typing import Any

from daemon.bench.report import context
from daemon.wire.requests import LONGEST_S

TEXT = "wave with your right hand five times"
COUNTED = "wave with your right hand twelve times"
IN_TURN = "wave with your right hand five times, then clap twice"
REPEATS = 11


def bench_generate(seed: int = 0) -> dict[str, Any]:
    """`motion_ms`, `in_turn_ms` (a text of two commands), `reference_forward_ms`, the `ratio`, `precision` and `steps`.

    `counted_ms` is for a text that names a number of strokes and no length, whose strokes are repeated. All are timed
    alternately, so that a busy machine slows each of them. The reference is the official MMM's shape (width 1024, 16 + 2 blocks,
    8192 codes, 51 rows, 77 words) in this code with random weights: speed does not depend on them.
    """
    import torch

    from mmm_core.generate.engine import Engine
    from mmm_core.model.text import TextStates
    from mmm_core.model.transformer import OFFICIAL, MotionTransformer

    torch.set_num_threads(1)
    engine = Engine.load(threads=1)
    reference = MotionTransformer(OFFICIAL).eval()
    words = torch.randn(1, 77, 512)
    text = TextStates(words, torch.ones(1, 77, dtype=torch.bool), words.mean(1))
    ids = torch.full((1, 50, 1), reference.ids.mask)

    def forward() -> None:
        with torch.inference_mode():
            reference(ids, reference.read_text(text))

    def motion() -> None:
        engine.generate(TEXT, seed=seed, seconds=LONGEST_S)

    def in_turn() -> None:
        engine.generate(IN_TURN, seed=seed, seconds=LONGEST_S)

    def counted() -> None:
        engine.generate(COUNTED, seed=seed)

    timed = (forward, motion, in_turn, counted)
    for _ in range(3):
        for function in timed:
            function()
    forward_s, motion_s, in_turn_s, counted_s = alternate(*timed)
    return {
        "motion_ms": round(1e3 * motion_s, 1),
        "in_turn_ms": round(1e3 * in_turn_s, 1),
        "counted_ms": round(1e3 * counted_s, 1),
        "reference_forward_ms": round(1e3 * forward_s, 1),
        "ratio": round(motion_s / forward_s, 3),
        "precision": engine.precision,
        "steps": engine.settings.steps,
        "guidance": engine.settings.guidance,
        "n": REPEATS,
        **context(seed, f"median of {REPEATS} alternating runs, one thread, text encoding and decoding included"),
    }


def alternate(*functions: Callable[[], None]) -> list[float]:
    """Median seconds of functions that are run alternately."""
    times: list[list[float]] = [[] for _ in functions]
    for _ in range(REPEATS):
        for function, kept in zip(functions, times, strict=True):
            start = time.perf_counter()
            function()
            kept.append(time.perf_counter() - start)
    return [statistics.median(kept) for kept in times]
