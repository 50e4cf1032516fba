"""HumanML3D's own features of joints: the numbers of its notebook, and who is handed them.

The recorded numbers are those of `process_file` in single precision, without the change of skeleton, for made-up joints of a
person who walks, moves every joint, and turns round by 4.5 radians. Before, folders of `new_joints` alone were read with
this repository's facing and rest directions: 16 degrees of facing and 41 standard deviations of yaw velocity apart.
"""

from __future__ import annotations

from pathlib import Path
from typing import get_args

import numpy as np
import pytest

from mmm_core.generate.keyframes import features_of
from mmm_core.imports.datasets import open_folder
from mmm_core.motion.features import RestPose, features_from_joints, joints_from_positions
from mmm_core.motion.humanml3d_features import humanml3d_features_from_joints
from mmm_core.motion.motion import FPS, N_FEATURES, Motion
from mmm_core.motion.skeleton import rotation_y
from tests.support.motion_folders import make_folder

RECORDED = np.load(Path(__file__).parent / "humanml3d_notebook.npz")
CHANNELS = {
    "yaw velocity": slice(0, 1), "root velocity": slice(1, 3), "root height": slice(3, 4), "positions": slice(4, 67),
    "rotations": slice(67, 193), "velocities": slice(193, 259), "contacts": slice(259, 263),
}  # fmt: skip


@pytest.mark.parametrize("name", list(CHANNELS))
def test_the_notebooks_numbers(name: str) -> None:
    ours = humanml3d_features_from_joints(RECORDED["joints"])[:-1, CHANNELS[name]]
    theirs = RECORDED["features"][:, CHANNELS[name]]
    np.testing.assert_allclose(ours, theirs, atol=0 if name == "contacts" else 1e-5)


def test_the_recording_tells_the_two_definitions_apart() -> None:
    ours, theirs = features_from_joints(RECORDED["joints"].astype(np.float64)), RECORDED["features"]
    for name, channels in CHANNELS.items():
        if name != "contacts":
            assert np.abs(ours[:-1, channels] - theirs[:, channels]).max() > 0.01, name


def test_a_start_anywhere_gives_the_same() -> None:
    joints = RECORDED["joints"].astype(np.float64)
    c, s = np.cos(1.1), np.sin(1.1)
    moved = joints @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T + np.array([3.0, 0.4, -2.0])
    np.testing.assert_allclose(humanml3d_features_from_joints(moved), humanml3d_features_from_joints(joints), atol=2e-6)


def test_joints_come_back_from_the_positions() -> None:
    """Up to where the person passes half a turn: there the notebook's own yaw velocity has the wrong sign."""
    joints = RECORDED["joints"].astype(np.float64)[:40]
    across = joints[0, 16] - joints[0, 17] + joints[0, 1] - joints[0, 2]
    back = rotation_y(np.array(-np.arctan2(-across[2], across[0])))
    wanted = (joints - joints[0, 0] * [1, 0, 1]) @ back.T
    wanted[..., 1] -= wanted[..., 1].min()
    found = joints_from_positions(humanml3d_features_from_joints(joints))
    np.testing.assert_allclose(found, wanted, atol=1e-5)


def test_a_folder_of_joints_alone_is_read_with_them(tmp_path: Path) -> None:
    path = make_folder(tmp_path / "data", joints_only=True)
    joints = RECORDED["joints"]
    np.save(path / "new_joints" / "000001.npy", joints)
    read = open_folder(path).features("000001")
    np.testing.assert_array_equal(read, humanml3d_features_from_joints(joints))


@pytest.mark.parametrize("rest_pose", get_args(RestPose))
def test_a_pose_is_read_as_the_model_knows_it(rest_pose: RestPose) -> None:
    joints = RECORDED["joints"]
    T = len(joints)
    pose = Motion(
        joints, FPS, np.tile(np.array([1, 0, 0, 0], np.float32), (T, 1)), np.zeros((T, 2), np.float32),
        np.zeros((T, N_FEATURES), np.float32), np.zeros(0, np.int32), "", 0, "accepted", 1.0,
    )  # fmt: skip
    read = features_of(pose, rest_pose).numpy()
    official = humanml3d_features_from_joints(joints)
    assert np.array_equal(read, official) == (rest_pose == "humanml3d")
