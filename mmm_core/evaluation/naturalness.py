"""How synthesised gestures move beside people: `python -m mmm_core.evaluation.naturalness ../shared/data`.

Measured on both wrists against their shoulders, at 20 fps, on clips in which a hand moves: jerk, speed, how much of the speed's
spectrum lies above 2 Hz and where its middle is. Real ones are the validation and test clips of the folder. What a recording
adds of its own (marker noise, solved joints) is in the real figures.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mmm_core.corpus.cmu import read_clips
from mmm_core.corpus.synthesis import synthesise
from mmm_core.motion.features import recover
from mmm_core.motion.motion import FPS

Array = NDArray[np.floating]
MEASURES = (
    "peak_jerk_m_s3", "mean_jerk_m_s3", "peak_speed_m_s", "mean_speed_m_s", "share_above_2_hz", "centroid_hz",
    "jerk_by_speed_1_s2",
)  # fmt: skip
MOVES_M_S = 0.3
SHORTEST_FRAMES = 40


def measure(joints_m: Array) -> Array:
    """(7,) the `MEASURES` of a motion (T, 22, 3)."""
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
    return np.array([jerk.max(), jerk.mean(), speed.max(), speed.mean(), share, centroid, jerk.mean() / mean])


def compare(folder: Path, n_synthesised: int = 250, seed: int = 21) -> dict[str, object]:
    """10th, 50th and 90th percentile of each measure, real and synthesised, and how many synthesised lie within the real."""
    real = [recover(f).joints_m for split in ("val", "test") for f, _ in read_clips(folder, split)][::2]
    made = [synthesise(np.random.default_rng((seed, i))).body.joints_m for i in range(n_synthesised)]
    r, s = _measured(real), _measured(made)
    low, high = np.percentile(r, [2, 98], axis=0)
    table = {
        name: {
            "real": np.percentile(r[:, k], [10, 50, 90]).round(2).tolist(),
            "synthesised": np.percentile(s[:, k], [10, 50, 90]).round(2).tolist(),
            "within_real_share": round(float(np.mean((s[:, k] >= low[k]) & (s[:, k] <= high[k]))), 2),
        }
        for k, name in enumerate(MEASURES)
    }
    return {"n_real": len(r), "n_synthesised": len(s), "seed": seed, **table}


def _measured(motions: Sequence[Array]) -> Array:
    rows = [measure(m) for m in motions if len(m) >= SHORTEST_FRAMES]
    return np.array([row for row in rows if row[2] > MOVES_M_S])


if __name__ == "__main__":
    sys.stdout.write(json.dumps(compare(Path(sys.argv[1])), indent=1) + "\n")
