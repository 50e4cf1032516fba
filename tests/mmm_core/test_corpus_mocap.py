"""Motion capture files: joints come out where hand calculation and our own export put them; broken files are named."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mmm_core.bvh import save_bvh
from mmm_core.corpus.mocap.asf_amc import read_asf_amc
from mmm_core.corpus.mocap.bvh import read_bvh
from mmm_core.corpus.mocap.recording import Recording
from mmm_core.corpus.synthesis import synthesise
from mmm_core.errors import TrainingDataError
from mmm_core.features import recover
from mmm_core.motion import Motion
from mmm_core.skeleton import JOINT_NAMES

ASF = """# a hip and a thigh
:version 1.10
:units
  mass 1.0
  length 0.45
  angle deg
:root
   order TX TY TZ RX RY RZ
   axis XYZ
   position 0 0 0
   orientation 0 0 0
:bonedata
  begin
     id 1
     name lhipjoint
     direction 1 0 0
     length 2
     axis 0 0 0 XYZ
  end
  begin
     id 2
     name lfemur
     direction 0 -1 0
     length 4
     axis 0 0 {axis} XYZ
     dof rx ry rz
  end
:hierarchy
  begin
    root lhipjoint
    lhipjoint lfemur
  end
"""
AMC = """#!OML:ASF x
:FULLY-SPECIFIED
:DEGREES
1
root 10 20 30 0 0 0
lfemur 0 0 0
2
root 10 20 30 0 90 0
lfemur 90 0 0
"""


def write(folder: Path, asf: str, amc: str) -> tuple[Path, Path]:
    (folder / "s.asf").write_text(asf)
    (folder / "m.amc").write_text(amc)
    return folder / "s.asf", folder / "m.amc"


def test_asf_and_amc_give_the_joints_of_a_hand_calculation(tmp_path: Path) -> None:
    r = read_asf_amc(*write(tmp_path, ASF.format(axis=0), AMC), unit_m=1.0)
    assert r.names == ("root", "lhipjoint", "lfemur")
    assert r.fps == 120.0
    assert np.allclose(r.positions_m[0], [[10, 20, 30], [12, 20, 30], [12, 16, 30]])
    # yaw 90 turns x to -z; pitch 90 turns the hanging thigh (0, -1, 0) to (0, 0, -1), which the yaw turns to -x
    assert np.allclose(r.positions_m[1], [[10, 20, 30], [10, 20, 28], [6, 20, 28]])


def test_a_bone_turns_about_its_own_axes(tmp_path: Path) -> None:
    """With its axes turned 90 degrees about z, rx of the bone is a turn about the parent's y, which a hanging thigh ignores."""
    amc = AMC.replace("root 10 20 30 0 90 0", "root 10 20 30 0 0 0")
    r = read_asf_amc(*write(tmp_path, ASF.format(axis=90), amc), unit_m=1.0)
    assert np.allclose(r.positions_m[1], [[10, 20, 30], [12, 20, 30], [12, 16, 30]])


@pytest.mark.parametrize(
    ("asf", "amc", "message"),
    [
        (ASF.format(axis=0), AMC.replace("lfemur 90 0 0", "lfemur 90 0"), r"m\.amc.*lfemur.*2 values.*3"),
        (ASF.format(axis=0), AMC.replace("lfemur 0 0 0", "lfemur a b c"), r"m\.amc.*line"),
        (ASF.format(axis=0), ":DEGREES\n", r"m\.amc.*no frames"),
        (ASF.format(axis="north"), AMC, r"s\.asf.*line.*north"),
        ("nothing", AMC, r"s\.asf.*no :root order"),
        (ASF.format(axis=0).replace("root lhipjoint", "lfemur lhipjoint"), AMC, r"s\.asf.*hierarchy"),
    ],
)
def test_broken_asf_and_amc_are_named(tmp_path: Path, asf: str, amc: str, message: str) -> None:
    with pytest.raises(TrainingDataError, match=message):
        read_asf_amc(*write(tmp_path, asf, amc))


def motion() -> Motion:
    clip = synthesise(np.random.default_rng(4))
    r = recover(clip.features)
    f32 = np.float32
    return Motion(
        r.joints_m.astype(f32), 20.0, r.head_quat_wxyz.astype(f32), r.forearm_twist_rad.astype(f32), clip.features,
        np.zeros(len(clip.features) // 4, np.int32), "x", 0, "accepted", 1.0,
    )  # fmt: skip


def test_what_we_export_as_bvh_comes_back(tmp_path: Path) -> None:
    made = motion()
    save_bvh(made, tmp_path / "m.bvh")
    back = read_bvh(tmp_path / "m.bvh").common()
    assert back.shape == made.joints_m.shape
    floor_m = np.percentile(made.joints_m[:, (10, 11), 1], 2)
    there = back - back[:1, :1] * [1, 0, 1]
    start = made.joints_m - made.joints_m[:1, :1] * [1, 0, 1] - [0, floor_m, 0]
    assert np.abs(there - start).max() < 2e-3


def test_a_faster_recording_is_resampled() -> None:
    made = motion().joints_m.astype(float)
    fine = np.repeat(made, 6, axis=0)
    at20 = Recording(Path("x"), JOINT_NAMES, fine, 120.0).common()
    assert abs(len(at20) - len(made)) <= 1


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("HIERARCHY", "TREE"), r"m\.bvh.*HIERARCHY"),
        (("Frame Time: 0.05", "Frame Time: 0"), r"Frame Time"),
        (("Frames: ", "Frames: 9"), r"MOTION.*values"),
        (("OFFSET", "SHIFT"), r"HIERARCHY.*SHIFT"),
        (("left_elbow", "hook"), r"left_elbow"),
    ],
)
def test_broken_bvh_is_named(tmp_path: Path, change: tuple[str, str], message: str) -> None:
    save_bvh(motion(), tmp_path / "m.bvh")
    text = (tmp_path / "m.bvh").read_text().replace(*change)
    (tmp_path / "m.bvh").write_text(text)
    with pytest.raises(TrainingDataError, match=message):
        read_bvh(tmp_path / "m.bvh").common()


CMU_BONES = {
    "pelvis": "root",
    "left_hip": "lhipjoint",
    "left_knee": "lfemur",
    "left_ankle": "ltibia",
    "left_foot": "lfoot",
    "right_hip": "rhipjoint",
    "right_knee": "rfemur",
    "right_ankle": "rtibia",
    "right_foot": "rfoot",
    "spine1": "lowerback",
    "spine2": "upperback",
    "spine3": "thorax",
    "neck": "lowerneck",
    "head": "upperneck",
    "left_shoulder": "lclavicle",
    "left_elbow": "lhumerus",
    "left_wrist": "lradius",
    "right_shoulder": "rclavicle",
    "right_elbow": "rhumerus",
    "right_wrist": "rradius",
}
CMU_BVH = {
    "pelvis": "Hips",
    "left_hip": "LeftUpLeg",
    "left_knee": "LeftLeg",
    "left_ankle": "LeftFoot",
    "left_foot": "LeftToeBase",
    "right_hip": "RightUpLeg",
    "right_knee": "RightLeg",
    "right_ankle": "RightFoot",
    "right_foot": "RightToeBase",
    "spine1": "Spine",
    "spine2": "Spine1",
    "spine3": "Neck",
    "neck": "Neck1",
    "head": "Head",
    "left_shoulder": "LeftArm",
    "left_elbow": "LeftForeArm",
    "left_wrist": "LeftHand",
    "right_shoulder": "RightArm",
    "right_elbow": "RightForeArm",
    "right_wrist": "RightHand",
}


@pytest.mark.parametrize("names", [CMU_BONES, CMU_BVH], ids=["asf", "bvh"])
def test_names_of_cmu_skeletons_are_known_and_a_missing_collar_is_put_in(names: dict[str, str]) -> None:
    made = motion().joints_m.astype(float)
    keep = [JOINT_NAMES.index(n) for n in names]
    back = Recording(Path("x"), tuple(names.values()), made[:, keep], 20.0).common()
    for elbow, wrist in ((18, 20), (19, 21), (1, 4)):
        bones = [m[:, wrist] - m[:, elbow] for m in (back, made)]
        assert np.allclose(bones[0], bones[1], atol=1e-6)


def test_a_missing_joint_or_a_bone_without_length_is_named() -> None:
    made = motion().joints_m.astype(float)
    with pytest.raises(TrainingDataError, match=r"head.*one called upperneck or head"):
        Recording(Path("x"), (*JOINT_NAMES[:15], "top", *JOINT_NAMES[16:]), made, 20.0).common()
    made[:, 20] = made[:, 18]
    with pytest.raises(TrainingDataError, match=r"left_wrist.*left_elbow"):
        Recording(Path("x"), JOINT_NAMES, made, 20.0).common()
