"""HumanML3D and KIT-ML folders made here, in the published form."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from mmm_core.imports.kit import KIT, kit_facing_yaw_rad
from mmm_core.motion.features import features_from_joints, features_from_rotations
from mmm_core.motion.skeleton import forward_kinematics


def standing(T: int) -> np.ndarray:
    """(T, 22, 3) joints in the rest directions, the right wrist swaying."""
    local = np.broadcast_to(np.eye(3), (T, 22, 3, 3)).copy()
    joints, _ = forward_kinematics(local, np.tile([0.0, 0.9, 0.0], (T, 1)))
    joints[:, 21, 0] += 0.1 * np.sin(np.arange(T) / 5)
    return joints


def kit_walk(T: int) -> np.ndarray:
    """(T, 21, 3) joints in millimetres: a stick figure that walks forward and turns."""
    body = np.zeros((21, 3))
    body[:5] = [[0, 900, 0], [0, 1000, 0], [0, 1250, 0], [0, 1450, 0], [0, 1600, 0]]
    for arm, side in ((5, -1), (8, 1)):
        body[arm : arm + 3] = [[180 * side, 1400, 0], [200 * side, 1150, 0], [210 * side, 900, 30]]
    for leg, side in ((11, -1), (16, 1)):
        body[leg : leg + 5] = [[90 * side, y, z] for y, z in ((880, 0), (480, 0), (80, 0), (20, -30), (0, 120))]
    turn = np.linspace(0, 1, T)
    c, s = np.cos(turn), np.sin(turn)
    R = np.stack(
        [np.stack([c, 0 * c, s], -1), np.stack([0 * c, 0 * c + 1, 0 * c], -1), np.stack([-s, 0 * c, c], -1)], -2
    )
    return np.einsum("tij,kj->tki", R, body) + np.linspace(0, 500, T)[:, None, None] * np.array([0.3, 0, 1])


def make_folder(path: Path, kind: str = "humanml3d", joints_only: bool = False) -> Path:
    motions = {name: (standing(60) if kind == "humanml3d" else kit_walk(60)) for name in ("000001", "000002")}
    motions["000003"] = motions["000001"][:20]  # too short to be used
    for folder in ("new_joint_vecs", "new_joints", "texts"):
        (path / folder).mkdir(parents=True)
    for name, joints in motions.items():
        np.save(path / "new_joints" / f"{name}.npy", joints.astype(np.float32))
        if not joints_only:
            np.save(path / "new_joint_vecs" / f"{name}.npy", features(joints, kind))
        (path / "texts" / f"{name}.txt").write_text(
            "a person waves.#a/DET person/NOUN wave/VERB#0.0#0.0\nhe sways#he/PRON sway/VERB#0.5#2.9\n"
        )
    for split in ("train", "val", "test"):
        (path / f"{split}.txt").write_text("000001\n000002\n000003\n")
    n = 263 if kind == "humanml3d" else 251
    np.save(path / "Mean.npy", np.zeros(n))
    np.save(path / "Std.npy", np.ones(n))
    return path


def features(joints: np.ndarray, kind: str) -> np.ndarray:
    if kind == "humanml3d":
        return features_from_joints(joints)
    identity = np.broadcast_to(np.eye(3), (len(joints), 20, 3, 3))
    return features_from_rotations(joints, kit_facing_yaw_rad(joints), identity, KIT)
