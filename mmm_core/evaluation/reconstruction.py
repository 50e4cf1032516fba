"""Measures the reconstruction quality of a tokenizer on the corpus's motions, before a model is trained on its tokens.

The mean joint error hides the losses of a tokenizer: a head's turn or a trunk's roll moves joints by a few millimetres, and
whole codebooks have been trained that lost these movements. So motions are judged as probes before and after reconstruction.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray

from mmm_core.corpus.families import FAMILIES, Gesture
from mmm_core.corpus.heldout import PROBES, Probe
from mmm_core.corpus.synthesis import ClipSpec, draw_gesture, synthesise_spec
from mmm_core.evaluation.probes import judge
from mmm_core.model.tokenizer import Tokenizer
from mmm_core.model.tokens import FRAMES_PER_TOKEN
from mmm_core.motion.features import recover
from mmm_core.motion.posture_features import PostureFeatures, posture_features

Features = NDArray[np.float32]
ANGLES = ("trunk_yaw_deg", "trunk_pitch_deg", "trunk_roll_deg", "head_yaw_deg", "head_pitch_deg", "head_roll_deg")
MOVED_DEG = 8.0
"""Degrees that an angle must range over for a motion to count for it."""
LEAST_AMPLITUDE = 0.85
"""Share of an angle's amplitude that must be kept."""
LEAST_HEAD_YAW = 0.9
"""Share of the head's yaw amplitude that must be kept."""
LEAST_COUNTS = 0.97
"""Share of probes with a number whose strokes must be right within one."""
N_EACH = 8
"""Motions of each family."""
_MOST_DRAWS = 100
"""Draws of a performance at most, until one is short enough."""


def shown(features: Features) -> PostureFeatures:
    """Posture features of a motion given by its features (T, 263)."""
    motion = recover(features)
    return posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad)


class TooLongError(ValueError):
    """The gestures of a probe are together longer than a clip of the corpus may be."""


def performed(probe: Probe, seed: int) -> Features:
    """Features (T, 263) of the corpus's own performance of a probe, with as many of its strokes as there is room for in a clip.

    Raises:
        TooLongError: there is no room for one stroke.
    """

    def gesture(p: Probe) -> Gesture:
        family = FAMILIES[p.family]
        side = p.side or ("right" if "right" in family.sides else "".join(family.sides[:1]))
        in_turns = p.side in ("both", "alternating") and "alternating" in family.sides and bool(family.counts)
        count = p.count or (3 if p.tempo else 2 if in_turns else family.counts[0] if family.counts else 1)
        where = p.direction or ("" if "" in family.directions else (family.directions or ("",))[0])
        tempo = {"slow": 0.65, "fast": 1.4}.get(p.tempo, 1.0)
        return Gesture(p.family, side, count, where, tempo=tempo, hold_s=p.hold_s)

    gestures = [gesture(p) for p in ((probe, probe.then) if probe.then else (probe,))]
    rng = np.random.default_rng(seed)
    for fewer in range(max(g.count for g in gestures)):
        spec = ClipSpec(tuple(replace(g, count=max(g.count - fewer, 1)) for g in gestures))
        drawn = (
            synthesise_spec(spec, rng) for _ in range(_MOST_DRAWS)
        )  # a slow performance may exceed a clip's length
        if (clip := next((clip for clip in drawn if clip is not None), None)) is not None:
            return clip.features
    raise TooLongError(f"{probe.text}: longer than a clip may be in each of {_MOST_DRAWS} draws of one stroke")


def tokenizer_figures(tokenizer: Tokenizer) -> dict[str, Any]:
    """Amplitudes that a tokenizer keeps, expectations of probes that are met before and after reconstruction, and faults.

    Returns:
        "kept": for each angle the mean share of its amplitude, and the worst family's share; "met" and "met_before": share of
        each expectation that is met after and before reconstruction; "faults": descriptions of figures below the gate; "n":
        number of motions.
    """

    def through(features: Features) -> Features:
        T = len(features) // FRAMES_PER_TOKEN * FRAMES_PER_TOKEN
        with torch.inference_mode():
            ids = tokenizer.encode(torch.from_numpy(features[None, :T]))
            return np.asarray(tokenizer.decode(ids)[0].numpy(), np.float32)

    kept, n_amplitudes = _kept(through)
    before, after = defaultdict[str, list[bool]](list), defaultdict[str, list[bool]](list)
    for i, probe in enumerate(PROBES):
        features = performed(probe, i)
        for met, made in ((before, features), (after, through(features))):
            for key, ok in judge(probe, shown(made), with_pose=True).items():
                met[key].append(ok)
    counts = float(np.mean(after["count"]))
    faults = [
        f"{angle} keeps {kept[angle]['mean']:.2f} of its amplitude, {least} is needed"
        for angle in ANGLES
        if kept[angle]["mean"] < (least := LEAST_HEAD_YAW if angle == "head_yaw_deg" else LEAST_AMPLITUDE)
    ]
    faults += [f"{counts:.3f} of the counts within one, {LEAST_COUNTS} is needed"] if counts < LEAST_COUNTS else []
    return {
        "kept": kept, "met_before": _shares(before), "met": _shares(after), "faults": faults, "n": n_amplitudes + len(PROBES)
    }  # fmt: skip


def _kept(through: Callable[[Features], Features]) -> tuple[dict[str, dict[str, Any]], int]:
    """For each angle the share of its amplitude that is kept, over all families of head and trunk, and the number of motions."""
    found: dict[str, dict[str, list[float]]] = {angle: defaultdict(list) for angle in ANGLES}
    n = 0
    for name in (name for name, family in FAMILIES.items() if family.limb in ("head", "trunk")):
        for i in range(N_EACH):
            rng = np.random.default_rng((3, len(name), ord(name[0]), i))
            clip = synthesise_spec(ClipSpec((draw_gesture(rng, (name,)),)), rng)
            if clip is None:
                continue
            n += 1
            a, b = shown(clip.features), shown(through(clip.features))
            for angle in ANGLES:
                before, after = getattr(a, angle), getattr(b, angle)
                if np.ptp(before) > MOVED_DEG:
                    found[angle][name].append(float(np.ptp(after) / np.ptp(before[: len(after)])))
    kept = {}
    for angle, families in found.items():
        worst = min(families, key=lambda name: float(np.mean(families[name])))
        mean = float(np.mean([share for shares in families.values() for share in shares]))
        kept[angle] = {
            "mean": round(mean, 3),
            "worst": round(float(np.mean(families[worst])), 3),
            "worst_family": worst,
        }
    return kept, n


def _shares(met: dict[str, list[bool]]) -> dict[str, float]:
    return {key: round(float(np.mean(values)), 4) for key, values in sorted(met.items())}
