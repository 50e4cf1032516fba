"""Compares generated motion with people: `python -m mmm_core.evaluation.naturalness ../shared/data ../shared/data/more`.

Measured of the wrists relative to their shoulders, at 20 fps and on clips in which a hand moves: jerk, speed, the share of the
speed's spectrum above 2 Hz and the spectrum's centroid. Measured of trunk and head: their angular speed, and its correlation with
the hands' speed; for these, joints are averaged over a quarter of a second, since the joints of recordings shake. Recordings of
joints do not show the head's rotation about its own axis, so the direction from neck to head stands for the head.

Real motions are the validation and test clips of the folders; `standing` are those in which the pelvis stays within 0.3 m, as
with a robot without legs. Errors of the recordings (marker noise, solved joints) are part of the real figures.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from mmm_core.corpus.cmu import read_clips
from mmm_core.corpus.families import FAMILIES
from mmm_core.corpus.synthesis import synthesise
from mmm_core.evaluation.fidelity import cases_of, fidelity
from mmm_core.generate.engine import Engine
from mmm_core.language.mirroring import canonical
from mmm_core.motion.features import recover
from mmm_core.motion.life import alive
from mmm_core.motion.motion import FPS, Motion
from mmm_core.motion.skeleton import normalise

Array = NDArray[np.floating]
WRISTS = (
    "peak_jerk_m_s3", "mean_jerk_m_s3", "peak_speed_m_s", "mean_speed_m_s", "share_above_2_hz", "centroid_hz",
    "jerk_by_speed_1_s2",
)  # fmt: skip
TRUNK_HEAD = (
    "trunk_deg_s", "chest_deg_s", "head_on_chest_deg_s", "head_deg_s", "chest_with_hands", "head_with_hands",
)  # fmt: skip
MEASURES = (*WRISTS, *TRUNK_HEAD)
"""Names of all measures. The trunk's speed is that of the chest against the pelvis; the last two are correlations of an angular
speed with the speed of the faster wrist, both averaged over 0.4 s."""
MOVES_M_S = 0.3
"""Peak speed of a wrist, metres a second, from which on a clip is measured."""
SHORTEST_FRAMES = 40
"""Frames of the shortest clip that is measured."""
STANDING_M = 0.3
"""Metres within which the pelvis of a standing person stays."""
_SMOOTH_FRAMES, _TOGETHER_FRAMES = 5, 8
"""Frames over which joints, and over which correlated speeds, are averaged."""
_PEAK_SPEED = MEASURES.index("peak_speed_m_s")


def measure(joints_m: Array) -> Array:
    """(13,) the `MEASURES` of a motion (T, 22, 3)."""
    joints_m = np.asarray(joints_m, np.float64)
    wrists = joints_m[:, [20, 21]] - joints_m[:, [16, 17]]
    velocity = np.diff(wrists, axis=0) * FPS
    jerk = np.linalg.norm(np.diff(velocity, n=2, axis=0) * FPS**2, axis=-1)
    speed = np.linalg.norm(velocity, axis=-1)
    fastest = speed.max(1) - speed.max(1).mean()
    power = np.square(np.abs(np.fft.rfft(fastest * np.hanning(len(fastest)))))
    hz = np.fft.rfftfreq(len(fastest), 1 / FPS)
    total = max(float(power[1:].sum()), 1e-12)
    share, centroid = power[hz > 2].sum() / total, (power * hz)[1:].sum() / total
    mean = max(float(speed.mean()), 0.02)
    hands = np.array([jerk.max(), jerk.mean(), speed.max(), speed.mean(), share, centroid, jerk.mean() / mean])
    return np.concatenate([hands, _trunk_head(joints_m)])


def stands(joints_m: Array) -> bool:
    """Whether the pelvis stays within `STANDING_M`."""
    return float(np.linalg.norm(np.ptp(joints_m[:, 0][:, [0, 2]], axis=0))) < STANDING_M


def real_clips(folders: Sequence[Path]) -> list[Array]:
    """Joints (T, 22, 3) of the validation and test clips of folders, without their mirror images."""
    return [
        recover(f).joints_m
        for folder in folders
        for split in ("val", "test")
        for f, _ in list(read_clips(folder, split))[::2]
    ]


def compare(real: Sequence[Array], made: Sequence[Array]) -> dict[str, Any]:
    """10th, 50th and 90th percentile of each measure, and the share of `made` between the 10th and 90th percentile of `real`.

    Args:
        real: joints (T, 22, 3) of recordings.
        made: joints (T, 22, 3) of motions that are compared with the recordings.
    """
    r, m = _measured(real), _measured(made)
    low, high = np.percentile(r, [10, 90], axis=0)
    within = (m >= low) & (m <= high)
    table = {
        name: {
            "real": np.percentile(r[:, k], [10, 50, 90]).round(2).tolist(),
            "made": np.percentile(m[:, k], [10, 50, 90]).round(2).tolist(),
            "within": round(float(within[:, k].mean()), 2),
        }
        for k, name in enumerate(MEASURES)
    }
    n = len(WRISTS)
    together = {"wrists": within[:, :n], "trunk_head": within[:, n:], "all": within}
    real_within = (r >= low) & (r <= high)
    return {
        "n_real": len(r), "n_made": len(m), **table,
        "within_together": {name: round(float(w.all(1).mean()), 2) for name, w in together.items()},
        "real_within_together": round(float(real_within.all(1).mean()), 2),
    }  # fmt: skip


def generated(engine: Engine, families: Iterable[str], n_each: int) -> list[Motion]:
    """Motions for the corpus's own sentences of held-out seeds (`fidelity.cases_of`)."""
    return [
        engine.generate(case.text, seed=i).motion for name in families for i, case in enumerate(cases_of(name)[:n_each])
    ]


def figures(folders: Sequence[Path], n_synthesised: int = 250, seed: int = 21, n_each: int = 2) -> dict[str, Any]:
    """Comparisons of the corpus, the model, and the model with `mmm_core.motion.life` with recordings, and the model's fidelity.

    Motions of the model are of every second family; the sizes of `life` were chosen by the other half of the families.
    """
    real = real_clips(folders)
    standing = [joints for joints in real if stands(joints)]
    engine, families = Engine.load(), tuple(FAMILIES)[1::2]
    synthesised = [synthesise(np.random.default_rng((seed, i))).body.joints_m for i in range(n_synthesised)]
    plain = generated(engine, families, n_each)
    lively = [alive(m, is_mirrored=canonical(m.text)[1]) for m in plain]
    sets = {"corpus": synthesised, "model": [m.joints_m for m in plain], "model alive": [m.joints_m for m in lively]}
    known: dict[tuple[str, int], Motion] = {}

    def again(text: str, k: int) -> Motion:
        if (text, k) not in known:
            known[text, k] = engine.generate(text, seed=k).motion
        return known[text, k]

    share = fidelity(again, families, n_each)
    share_alive = fidelity(lambda text, k: alive(again(text, k), is_mirrored=canonical(text)[1]), families, n_each)
    return {
        "beside": {
            kind: {name: compare(clips, made) for name, made in sets.items()}
            for kind, clips in (("standing", standing), ("all", real))
        },
        "fidelity": {"n": share["n"], "model": share["share"], "model alive": share_alive["share"]},
    }


def _trunk_head(joints: Array) -> Array:
    """(6,) the `TRUNK_HEAD` measures."""
    j = uniform_filter1d(joints, _SMOOTH_FRAMES, axis=0, mode="nearest")
    pelvis = _frame(j[:, 1] - j[:, 2], np.broadcast_to([0.0, 1, 0], j[:, 0].shape))
    chest = _frame(j[:, 13] - j[:, 14], j[:, 12] - j[:, 3])
    head = normalise(j[:, 15] - j[:, 12])
    on_chest = np.einsum("tji,tj->ti", chest, head)
    chest_deg_s, head_deg_s = _rotation_deg_s(chest), _direction_deg_s(head)
    hands = np.linalg.norm(np.diff(j[:, [20, 21]] - j[:, [16, 17]], axis=0), axis=-1).max(1)
    return np.array([
        _rotation_deg_s(np.swapaxes(pelvis, 1, 2) @ chest).mean(), chest_deg_s.mean(), _direction_deg_s(on_chest).mean(),
        head_deg_s.mean(), _together(chest_deg_s, hands), _together(head_deg_s, hands),
    ])  # fmt: skip


def _frame(left: Array, up: Array) -> Array:
    x = normalise(left)
    z = normalise(np.cross(x, up))
    return np.stack([x, np.cross(z, x), z], -1)


def _rotation_deg_s(R: Array) -> Array:
    cosine = (np.trace(np.swapaxes(R[:-1], 1, 2) @ R[1:], axis1=1, axis2=2) - 1) / 2
    return np.rad2deg(np.arccos(np.clip(cosine, -1, 1))) * FPS


def _direction_deg_s(v: Array) -> Array:
    return np.rad2deg(np.arccos(np.clip((v[1:] * v[:-1]).sum(-1), -1, 1))) * FPS


def _together(a: Array, b: Array) -> float:
    """Correlation of two speeds over time; 0 if one of them is constant."""
    a, b = (uniform_filter1d(x, _TOGETHER_FRAMES) for x in (a, b))
    return float(np.corrcoef(a, b)[0, 1]) if a.std() > 1e-9 and b.std() > 1e-9 else 0.0


def _measured(motions: Sequence[Array]) -> Array:
    rows = [measure(m) for m in motions if len(m) >= SHORTEST_FRAMES]
    return np.array([row for row in rows if row[_PEAK_SPEED] > MOVES_M_S])


if __name__ == "__main__":
    sys.stdout.write(json.dumps(figures([Path(folder) for folder in sys.argv[1:]]), indent=1) + "\n")
