"""Motions for tests: a person whose arms, head and trunk do anything at all, and recordings where present."""

import os
from pathlib import Path

import numpy as np
import pytest

from mmm_core.motion.motion import Motion
from mmm_core.motion.skeleton import BONE_LENGTHS_M, MIRROR, PARENTS, quat_wxyz, rotation_about

_UP = {"spine1", "spine2", "spine3", "neck", "head"}
_STANDING = {
    1: (1, -0.2, 0), 2: (-1, -0.2, 0), 4: (0, -1, 0), 5: (0, -1, 0), 7: (0, -1, 0), 8: (0, -1, 0), 10: (0, -0.3, 1),
    11: (0, -0.3, 1), 3: (0, 1, 0), 6: (0, 1, 0), 9: (0, 1, 0), 12: (0, 1, 0), 15: (0, 1, 0.3), 13: (0.5, 0.8, 0),
    14: (-0.5, 0.8, 0), 16: (1, 0, 0), 17: (-1, 0, 0), 18: (0.1, -1, 0), 19: (-0.1, -1, 0), 20: (0.05, -1, 0.1),
    21: (-0.05, -1, 0.1),
}  # fmt: skip


def motion(directions, head_R=None, twist_rad=None, fps=20.0):
    """A motion from bone directions (T, 22, 3), any length, in the world."""
    T = len(directions)
    joints = np.zeros((T, 22, 3))
    joints[:, 0, 1] = 0.95
    for j, p in enumerate(PARENTS[1:], 1):
        bone = directions[:, j] / np.linalg.norm(directions[:, j], axis=-1, keepdims=True)
        joints[:, j] = joints[:, p] + BONE_LENGTHS_M[j] * bone
    head = np.tile(np.eye(3), (T, 1, 1)) if head_R is None else head_R
    twist = np.zeros((T, 2)) if twist_rad is None else twist_rad
    return Motion(
        joints.astype(np.float32), fps, quat_wxyz(head).astype(np.float32), twist.astype(np.float32),
        np.zeros((T, 263), np.float32), np.zeros(0, np.int32), "test", 0, "accepted", 1.0,
    )  # fmt: skip


def standing(T):
    """(T, 22, 3) bone directions of a person who stands with hanging arms."""
    d = np.zeros((22, 3))
    for j, v in _STANDING.items():
        d[j] = v
    return np.tile(d, (T, 1, 1))


def random_motion(seed, T, kind="noise"):
    """Arms, head and trunk at random: `noise` anew in each frame, `teleport` held for a while, `smooth` splines."""
    rng = np.random.default_rng(seed)
    every = {"noise": 1, "teleport": 9, "smooth": 12}[kind]
    keys = rng.normal(size=(T // every + 4, 8, 3))
    if kind == "smooth":
        at = np.arange(T) / every
        k = at.astype(int)
        u = (at - k)[:, None, None]
        a, b, c = keys[k], keys[k + 1], keys[k + 2]
        values = (a + b) / 2 + (b - a) * u + (c - 2 * b + a) * u * u / 2
    else:
        values = keys[np.arange(T) // every]
    d = standing(T)
    for i, j in enumerate((18, 19, 20, 21)):
        d[:, j] = values[:, i] + 1e-6
    trunk = rotation_about(np.array([0.0, 1, 0]), 0.6 * values[:, 4, 0]) @ rotation_about(
        np.array([1.0, 0, 0]), 0.4 * values[:, 4, 1]
    )
    for j in (6, 9, 12, 13, 14, 16, 17):
        d[:, j] = np.einsum("tij,tj->ti", trunk, d[:, j])
    head = (
        trunk
        @ rotation_about(np.array([0.0, 1, 0]), values[:, 5, 0])
        @ rotation_about(np.array([1.0, 0, 0]), values[:, 5, 1])
    )
    return motion(d, head, values[:, 6, :2])


def mirrored(m):
    """The motion in a mirror: left and right change places."""
    flip = np.array([-1, 1, 1], np.float32)
    return Motion(
        m.joints_m[:, MIRROR] * flip, m.fps, m.head_quat_wxyz * np.array([1, 1, -1, -1], np.float32),
        -m.forearm_twist_rad[:, ::-1], m.features, m.tokens, m.text, m.seed, m.status, m.scope_score,
    )  # fmt: skip


def real_motions(n_frames=200, count=6):
    """Pieces of real recordings, where the shared data are present; else the test is skipped."""
    shared = Path(os.environ.get("MMMD_SHARED", Path(__file__).parents[3] / "shared"))
    file = shared / "data" / "motions_common_skeleton.npz"
    if not file.is_file():
        pytest.skip(f"no recordings at {file}; set MMMD_SHARED to the folder that holds data/")
    with np.load(file) as data:
        names = sorted(k for k in data.files if len(data[k]) >= n_frames)
        picked = [names[i] for i in np.linspace(0, len(names) - 1, count).astype(int)]
        return {k: _still_head(data[k][:n_frames]) for k in picked}


def _still_head(joints):
    T = len(joints)
    return Motion(
        joints.astype(np.float32), 20.0, np.tile(np.array([1, 0, 0, 0], np.float32), (T, 1)),
        np.zeros((T, 2), np.float32), np.zeros((T, 263), np.float32), np.zeros(0, np.int32), "recording",
        0, "accepted", 1.0,
    )  # fmt: skip
