"""HumanML3D and KIT-ML folders, made here in their form; and KIT's features and joints."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mmm_core.datasets import open_folder, read_captions
from mmm_core.errors import TrainingDataError
from mmm_core.features import features_from_joints, features_from_rotations, joints_from_positions, joints_of
from mmm_core.kit import KIT, joints_from_kit, kit_facing_yaw_rad
from mmm_core.skeleton import forward_kinematics


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


@pytest.mark.parametrize(("kind", "width", "fps"), [("humanml3d", 263, 20.0), ("kit", 251, 12.5)])
@pytest.mark.parametrize("joints_only", [False, True])
def test_a_folder_is_read_as_it_is(tmp_path: Path, kind: str, width: int, fps: float, joints_only: bool) -> None:
    folder = open_folder(make_folder(tmp_path / "data", kind, joints_only))
    assert (folder.n_features, folder.fps) == (width, fps)
    examples = list(folder.examples("train"))
    whole = [e for e in examples if e.name == "000001"]
    assert len(whole) == 1
    assert whole[0].features.shape == (60, width)
    assert [c.text for c in whole[0].captions] == ["a person waves."]
    assert whole[0].captions[0].tokens == ("a/DET", "person/NOUN", "wave/VERB")
    assert not any(e.name.startswith("000003") for e in examples), "20 frames are too few"


def test_a_span_cuts_its_own_motion_out(tmp_path: Path) -> None:
    path = make_folder(tmp_path / "data")
    cut = {e.name: e for e in open_folder(path).examples("val")}["000001_1"]
    assert cut.captions[0].text == "he sways"
    assert len(cut.features) == int(2.9 * 20) - int(0.5 * 20)


def test_kit_features_and_back() -> None:
    joints = kit_walk(40)
    back = joints_from_positions(features(joints, "kit"))
    start = joints - joints[:1, :1] * np.array([1, 0, 1])
    turn = kit_facing_yaw_rad(joints)[0]
    assert abs(turn) < 1e-9
    np.testing.assert_allclose(back, start, atol=0.2)  # millimetres, float32 features
    assert joints_of(251) == 21
    assert joints_of(263) == 22
    with pytest.raises(ValueError, match="12 J - 1"):
        joints_of(262)


def test_kit_joints_become_ours_in_metres() -> None:
    ours = joints_from_kit(kit_walk(3))
    assert ours.shape == (3, 22, 3)
    assert ours[0, 20, 0] > 0.1, "the left wrist is on the left"
    assert ours[0, 21, 0] < -0.1
    assert 1.5 < ours[0, 15, 1] < 1.7
    upper_arm = np.linalg.norm(ours[:, 18] - ours[:, 16], axis=-1)
    np.testing.assert_allclose(upper_arm, 0.2508, atol=1e-3)


@pytest.mark.parametrize(
    ("breaking", "message"),
    [
        (lambda p: (p / "train.txt").unlink(), "train.txt"),
        (lambda p: (p / "train.txt").write_text(""), "no names"),
        (lambda p: (p / "texts" / "000001.txt").unlink(), "000001.txt.*no such file"),
        (lambda p: (p / "texts" / "000001.txt").write_text("no fields\n"), "line 1"),
        (lambda p: (p / "texts" / "000001.txt").write_text("he sways#x/X#50#60\n"), "within the motion's 3.00 s"),
        (lambda p: (p / "texts" / "000001.txt").write_text("he sways#x/X#3#2\n"), "from < to"),
        (lambda p: np.save(p / "new_joint_vecs" / "000002.npy", np.zeros((60, 7))), r"shape \(60, 7\)"),
        (lambda p: np.save(p / "new_joint_vecs" / "000002.npy", np.full((60, 263), np.nan)), "NaN"),
        (lambda p: (p / "new_joint_vecs" / "000002.npy").write_bytes(b"no array"), "not a readable"),
        (lambda p: np.save(p / "Std.npy", np.zeros(263)), "above 0"),
        (lambda p: np.save(p / "Mean.npy", np.zeros(251)), r"Mean.npy: shape \(251,\)"),
    ],
)  # fmt: skip
def test_what_is_broken_is_named(tmp_path: Path, breaking: object, message: str) -> None:
    path = make_folder(tmp_path / "data")
    breaking(path)  # type: ignore[operator]
    with pytest.raises(TrainingDataError, match=message):
        list(open_folder(path).examples("train"))


def test_no_folder_and_an_empty_one(tmp_path: Path) -> None:
    with pytest.raises(TrainingDataError, match="no such folder"):
        open_folder(tmp_path / "none")
    with pytest.raises(TrainingDataError, match=r"no \.npy"):
        open_folder(tmp_path)


def test_nan_spans_mean_the_whole(tmp_path: Path) -> None:
    """Some published lines carry nan instead of 0."""
    (tmp_path / "a.txt").write_text("he waves#he/PRON#nan#nan\n")
    assert read_captions(tmp_path / "a.txt")[0].end_s is None
