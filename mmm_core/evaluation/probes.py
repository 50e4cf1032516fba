"""The probe suite: generate every probe with several seeds and check what each motion shows."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from typing import Any

from mmm_core.corpus.heldout import PROBES, Probe
from mmm_core.evaluation import checks
from mmm_core.evaluation.checks import Shown, look_at
from mmm_core.motion import Motion

Generate = Callable[[str, int], Motion]


def judge(probe: Probe, shown: Shown) -> dict[str, bool]:
    """Which of a probe's expectations a motion meets; only those the probe has."""
    verdict = {"limb": checks.limb(shown) == probe.limb}
    if probe.side:
        verdict["side"] = shown.arms == probe.side
    if probe.count is not None:
        found = checks.count(shown, probe.family)
        verdict["count"] = found is not None and abs(found - probe.count) <= 1
        verdict["count_exact"] = found == probe.count
    if probe.direction:
        verdict["direction"] = checks.direction(shown, probe.family) == probe.direction
    return verdict


def evaluate(
    generate: Generate, seeds: Sequence[int], progress: Callable[[int], None] = lambda _n: None
) -> dict[str, Any]:
    """Shares of expectations met over all probes and seeds, refused ones counted as not met, and the worst texts."""
    met: dict[str, list[bool]] = defaultdict(list)
    misses: dict[str, int] = defaultdict(int)
    refused = done = 0
    for probe in PROBES:
        for seed in seeds:
            motion = generate(probe.text, seed)
            if len(motion.joints_m):
                verdict = judge(probe, look_at(motion.joints_m, motion.head_quat_wxyz))
            else:
                refused += 1
                verdict = dict.fromkeys(_expectations(probe), False)
            for key, ok in verdict.items():
                met[key].append(ok)
                misses[probe.text] += not ok and key != "count_exact"
            done += 1
            progress(done)
    shares = {key: round(sum(values) / len(values), 4) for key, values in sorted(met.items())}
    worst = sorted(((n, text) for text, n in misses.items() if n), reverse=True)[:12]
    sizes = {key: len(values) for key, values in sorted(met.items())}
    return {**shares, "n": len(PROBES) * len(seeds), "n_each": sizes, "refused": refused, "most_missed": worst}


def _expectations(probe: Probe) -> list[str]:
    wanted = ["limb"]
    wanted += ["side"] if probe.side else []
    wanted += ["count", "count_exact"] if probe.count is not None else []
    return wanted + (["direction"] if probe.direction else [])
