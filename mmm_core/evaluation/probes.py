"""The probe suite: generates every probe with several seeds and checks the motions against the probe's expectations."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from mmm_core.corpus.heldout import PROBES, Probe
from mmm_core.evaluation.stroke_counts import count_strokes
from mmm_core.motion.motion import Motion
from mmm_core.motion.posture_features import PostureFeatures, part, posture_features
from mmm_core.recognition import checks
from mmm_core.recognition.expected import acts_with, goes, is_seen, moves
from mmm_core.recognition.signs import shows

SLOW_CYCLE_S, FAST_CYCLE_S = 0.72, 0.64
"""Seconds from stroke to stroke above which a gesture is slow, and below which it is fast; 0.6 to 0.7 s are usual."""
MIN_PART = 12
"""Frames of each gesture of a sequence at least."""
Generate = Callable[[str, int], Motion]


def judge(probe: Probe, shown: PostureFeatures, with_pose: bool = False) -> dict[str, bool]:
    """Whether a motion meets each expectation of a probe; `with_pose` adds the sign of the probe's family."""
    if probe.then is not None:
        return {"order": _in_order(probe, probe.then, shown)}
    verdict = {"limb": moves(shown, probe.family, probe.limb)}
    if with_pose:
        verdict["pose"] = shows(shown, probe.family, probe.side, probe.direction)
    if probe.side:
        verdict["side"] = acts_with(shown, probe.family, probe.side)
    if probe.count is not None:
        found = count_strokes(shown, probe.family, probe.side, probe.direction)
        verdict["count"] = found is not None and abs(found - probe.count) <= 1
        verdict["count_exact"] = found == probe.count
    if probe.direction:
        verdict["direction"] = goes(shown, probe.family, probe.side, probe.direction)
    if probe.hold_s:
        held = checks.held_s(shown, probe.limb)
        verdict["hold"] = abs(held - probe.hold_s) <= max(1.0, 0.25 * probe.hold_s)
    if probe.tempo:
        cycle = checks.cycle_s(shown, probe.family)
        wanted = cycle is not None and (cycle > SLOW_CYCLE_S if probe.tempo == "slow" else cycle < FAST_CYCLE_S)
        verdict["tempo"] = bool(wanted)
    return verdict


def _in_order(first: Probe, second: Probe, shown: PostureFeatures) -> bool:
    """Whether the motion can be divided at some frame into first and second gesture, and at none into second and first."""
    n_frames = len(shown.head_yaw_deg)

    def parts(a: Probe, b: Probe, t: int) -> bool:
        return is_seen(part(shown, 0, t), a, [b]) and is_seen(part(shown, t, n_frames), b, [a])

    moments = range(MIN_PART, n_frames - MIN_PART, 2)
    return any(parts(first, second, t) for t in moments) and not any(parts(second, first, t) for t in moments)


def evaluate(
    generate: Generate,
    seeds: Sequence[int],
    progress: Callable[[int], None] = lambda _n: None,
    showable: Mapping[str, frozenset[str]] | None = None,
    probes: Sequence[Probe] | None = None,
) -> dict[str, Any]:
    """Shares of expectations met over all probes and seeds, and the worst texts; a refused probe meets none.

    Args:
        generate: (text, seed) -> motion.
        seeds: seeds of each probe.
        progress: called with the number of motions done.
        showable: expectations that a robot can meet, by text (`robot_capability.py`); the shares of these alone are then given
            as "of_showable".
        probes: None takes the development set.
    """
    probes = PROBES if probes is None else probes
    met: dict[str, list[bool]] = defaultdict(list)
    could: dict[str, list[bool]] = defaultdict(list)
    misses: dict[str, int] = defaultdict(int)
    refused = done = 0
    for probe in probes:
        for seed in seeds:
            motion = generate(probe.text, seed)
            if len(motion.joints_m):
                verdict = judge(
                    probe,
                    posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad),
                    with_pose=True,
                )
            else:
                refused += 1
                verdict = dict.fromkeys(_expectations(probe), False)
            for key, ok in verdict.items():
                met[key].append(ok)
                if showable is not None and key in showable[probe.text]:
                    could[key].append(ok)
                misses[probe.text] += not ok and key != "count_exact"
            done += 1
            progress(done)
    worst = sorted(((n, text) for text, n in misses.items() if n), reverse=True)[:12]
    of_showable = {"of_showable": {**_shares(could), "n_each": _sizes(could)}} if showable is not None else {}
    counts = {"n": len(probes) * len(seeds), "n_each": _sizes(met), "refused": refused}
    return {**_shares(met), **of_showable, **counts, "most_missed": worst}


def _shares(met: Mapping[str, Sequence[bool]]) -> dict[str, float]:
    return {key: round(sum(values) / len(values), 4) for key, values in sorted(met.items())}


def _sizes(met: Mapping[str, Sequence[bool]]) -> dict[str, int]:
    return {key: len(values) for key, values in sorted(met.items())}


def _expectations(probe: Probe) -> list[str]:
    if probe.then is not None:
        return ["order"]
    wanted = ["limb", "pose"] + (["side"] if probe.side else [])
    wanted += ["count", "count_exact"] if probe.count is not None else []
    wanted += ["direction"] if probe.direction else []
    return wanted + (["hold"] if probe.hold_s else []) + (["tempo"] if probe.tempo else [])
