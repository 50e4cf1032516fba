"""HumanML3D and KIT-ML folders, made here in their form; and KIT's features and joints."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mmm_core.errors import TrainingDataError
from mmm_core.imports.datasets import open_folder, read_captions
from mmm_core.imports.kit import joints_from_kit, kit_facing_yaw_rad
from mmm_core.motion.features import joints_from_positions, joints_of
from tests.support.motion_folders import features, kit_walk, make_folder


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


def test_the_few_that_humanml3ds_notebooks_cannot_make_are_left_out(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """Its lists name motions that are never made and some with NaN; a loader that refused them refused every real folder."""
    path = make_folder(tmp_path / "data")
    names = ["009707", "000002", *["000001"] * 198]
    (path / "train.txt").write_text("\n".join(names))
    np.save(path / "new_joint_vecs" / "000002.npy", np.full((60, 263), np.nan))
    examples = list(open_folder(path).examples("train"))
    assert {e.name for e in examples} == {"000001", "000001_1"}
    assert "2 of 200 motions of 'train'" in caplog.text
    assert "009707 000002" in caplog.text
    (path / "train.txt").write_text("\n".join(["011059", *names]))
    with pytest.raises(TrainingDataError, match="NaN"):
        list(open_folder(path).examples("train"))


@pytest.mark.parametrize(("kind", "used"), [("humanml3d", False), ("kit", True)])
def test_kit_motions_may_be_shorter(tmp_path: Path, kind: str, used: bool) -> None:
    """24 frames at 12.5 a second are as long as 40 at 20."""
    path = make_folder(tmp_path / "data", kind)
    np.save(path / "new_joint_vecs" / "000001.npy", np.zeros((24, 263 if kind == "humanml3d" else 251)))
    (path / "texts" / "000001.txt").write_text("a person waves.#a/DET#0.0#0.0\n")
    assert any(e.name == "000001" for e in open_folder(path).examples("train")) == used


def test_no_folder_and_an_empty_one(tmp_path: Path) -> None:
    with pytest.raises(TrainingDataError, match="no such folder"):
        open_folder(tmp_path / "none")
    with pytest.raises(TrainingDataError, match=r"no \.npy"):
        open_folder(tmp_path)


def test_nan_spans_mean_the_whole(tmp_path: Path) -> None:
    """Some published lines carry nan instead of 0."""
    (tmp_path / "a.txt").write_text("he waves#he/PRON#nan#nan\n")
    assert read_captions(tmp_path / "a.txt")[0].end_s is None
