"""Motions for measuring retargeting: recordings where a folder has them, else synthesised gestures."""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion.motion import FPS, N_FEATURES, Motion
from mmm_core.motion.skeleton import facing_yaw_rad, forward_kinematics, local_rotations, quat_wxyz

_BESIDE_CHECKOUT = Path(__file__).parents[3] / "shared" / "data"
_SHORTEST_FRAMES = 40


def bench_motions(n: int | None, seed: int) -> tuple[str, list[Motion]]:
    """Description of the motions, and at most `n` of them.

    Recordings are the held-out CMU clips of docs/DATA.md in `$MMMD_SHARED/data` or in `shared/data` beside the checkout, with fast
    runs, dances and karate among them. Recordings do not contain head turning: the head follows the body.
    """
    folder = recordings_folder()
    if folder is not None:
        motions = _recorded(folder)
        return "held-out CMU recordings", motions[:: -(-len(motions) // n)] if n else motions
    return "synthesised gestures", _synthesised(n or 40, seed)


def recordings_folder() -> Path | None:
    """`$MMMD_SHARED/data`, else `shared/data` beside the checkout; None where it holds no recordings."""
    folder = Path(os.environ["MMMD_SHARED"]) / "data" if "MMMD_SHARED" in os.environ else _BESIDE_CHECKOUT
    return folder if (folder / "clips.jsonl").is_file() else None


def _recorded(folder: Path) -> list[Motion]:
    clips = [json.loads(line) for line in (folder / "clips.jsonl").read_text().splitlines()]
    with np.load(folder / "motions_common_skeleton.npz") as data:
        cuts = [data[c["trial"]][c["start"] : c["end"]] for c in clips if c["split"] != "train"]
    return [_motion(cut, _head_with_body(cut), None) for cut in cuts if len(cut) >= _SHORTEST_FRAMES]


def _head_with_body(joints_m: NDArray[np.floating]) -> NDArray[np.floating]:
    """(T, 4) orientation of a head that turns with the neck, for joints (T, 22, 3)."""
    joints = np.asarray(joints_m, np.float64)
    local = local_rotations(joints, facing_yaw_rad(joints), None, None)
    return quat_wxyz(forward_kinematics(local, joints[:, 0])[1][:, 15])


def _synthesised(n: int, seed: int) -> list[Motion]:
    from mmm_core.corpus.synthesis import synthesise

    rng = np.random.default_rng(seed)
    bodies = [synthesise(rng).body for _ in range(n)]
    return [_motion(b.joints_m, quat_wxyz(b.head_R_world), b.forearm_twist_rad) for b in bodies]


def _motion(joints_m: NDArray[np.floating], head: NDArray[np.floating], twist: NDArray[np.floating] | None) -> Motion:
    T = len(joints_m)
    return Motion(
        joints_m.astype(np.float32), FPS, head.astype(np.float32),
        np.zeros((T, 2), np.float32) if twist is None else twist.astype(np.float32),
        np.zeros((T, N_FEATURES), np.float32), np.zeros(0, np.int64), "", 0, "accepted", 1.0,
    )  # fmt: skip


def cut(motion: Motion, start: int, end: int) -> Motion:
    """Frames `start` to `end` of a motion."""
    return Motion(
        motion.joints_m[start:end], motion.fps, motion.head_quat_wxyz[start:end], motion.forearm_twist_rad[start:end],
        motion.features[start:end], motion.tokens[:0], motion.text, motion.seed, motion.status, motion.scope_score,
    )  # fmt: skip


def glued(motions: list[Motion], n_frames: int) -> Motion:
    """The first `n_frames` of the motions repeated one after another; between two of them the person jumps."""
    frames = np.arange(n_frames) % sum(len(m.joints_m) for m in motions)
    first = motions[0]
    return Motion(
        np.concatenate([m.joints_m for m in motions])[frames], first.fps,
        np.concatenate([m.head_quat_wxyz for m in motions])[frames],
        np.concatenate([m.forearm_twist_rad for m in motions])[frames],
        np.zeros((n_frames, N_FEATURES), np.float32), first.tokens[:0], "", 0, "accepted", 1.0,
    )  # fmt: skip
