"""Measures the scope score on held-out prompts: how well it separates texts in scope from texts out of scope."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mmm_core.generate.engine import Engine
from mmm_core.language.scope import ScopeVerdict
from mmm_core.motion.skeleton import Array

SHOWN = 12
"""Texts at most that the figures list as wrongly refused and as wrongly accepted."""


def auroc(inside: Sequence[float] | Array, outside: Sequence[float] | Array) -> float:
    """Probability that a text inside scores above one outside, ties counted half (Mann and Whitney 1947).

    Raises:
        ValueError: one of the two has no score or a NaN.
    """
    a, b = np.asarray(inside, np.float64), np.asarray(outside, np.float64)
    if not len(a) or not len(b) or np.isnan(a).any() or np.isnan(b).any():
        raise ValueError(
            f"{len(a)} scores inside and {len(b)} scores outside; at least one of each and no NaN is needed"
        )
    below = np.searchsorted(np.sort(b), a, "left") + np.searchsorted(np.sort(b), a, "right")
    return float(below.sum() / (2 * len(a) * len(b)))


def scope_figures(
    engine: Engine, inside: Sequence[str], outside: Mapping[str, Sequence[str]], mixed: Sequence[str] = ()
) -> dict[str, Any]:
    """AUROC, refusals and acceptances by kind, and milliseconds for each decision, one text at a time.

    Times include text encoding. Wall-clock time and processor time are given; other programs hardly change the latter.
    """
    engine.understand("warm up")
    spent_ms: list[tuple[float, float]] = []

    def judged(texts: Sequence[str]) -> list[ScopeVerdict]:
        verdicts: list[ScopeVerdict] = []
        for text in texts:
            start, worked = time.perf_counter(), time.process_time()
            verdicts.append(engine.understand(text)[1])
            spent_ms.append((1e3 * (time.perf_counter() - start), 1e3 * (time.process_time() - worked)))
        return verdicts

    within = judged(inside)
    without = {kind: judged(texts) for kind, texts in outside.items()}
    others = [v for verdicts in without.values() for v in verdicts]
    halves = judged(mixed)
    refused = [t for t, v in zip(inside, within, strict=True) if v.status == "rejected"]
    taken = [
        (v.score, text[:80], v.nearest)
        for kind, texts in outside.items()
        for text, v in zip(texts, without[kind], strict=True)
        if v.status == "accepted"
    ]
    return {
        "auroc": round(auroc([v.score for v in within], [v.score for v in others]), 4),
        "false_refusals": _share(within, "rejected"),
        "false_acceptances": _share(others, "accepted"),
        "outside_degraded": _share(others, "degraded"),
        "inside": {"n": len(within), **_counts(within)},
        "outside": {"n": len(others), **_counts(others)},
        "outside_by_kind": {kind: {"n": len(v), **_counts(v)} for kind, v in without.items()},
        "mixed": {"n": len(halves), **_counts(halves), "kept_in_part": sum(bool(v.kept) for v in halves)},
        "n": len(within) + len(others),
        "decision_ms": _milliseconds(np.asarray(spent_ms)[:, 0]),
        "decision_processor_ms": _milliseconds(np.asarray(spent_ms)[:, 1]),
        "refused_although_inside": refused[:SHOWN],
        "accepted_although_outside": [
            f"{text!r} as {nearest!r} ({score:.2f})" for score, text, nearest in sorted(taken, reverse=True)[:SHOWN]
        ],
    }


def _share(verdicts: Sequence[ScopeVerdict], status: str) -> float:
    return round(sum(v.status == status for v in verdicts) / len(verdicts), 4)


def _counts(verdicts: Sequence[ScopeVerdict]) -> dict[str, int]:
    found = Counter(v.status for v in verdicts)
    return {"accepted": found["accepted"], "degraded": found["degraded"], "rejected": found["rejected"]}


def _milliseconds(spent: NDArray[np.float64]) -> dict[str, float]:
    p50, p99 = np.percentile(spent, [50, 99])
    return {"p50": round(float(p50), 2), "p99": round(float(p99), 2), "max": round(float(spent.max()), 2)}
