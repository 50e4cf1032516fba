"""Motion files of other programs: what is read is the same person, and what cannot be read is named."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mmm_core.errors import MotionFileError
from mmm_core.imports.recordings.asf_amc import read_amc
from mmm_core.imports.recordings.files import find_motions, read_motion
from mmm_core.motion.bvh import save_bvh
from mmm_core.motion.motion import Motion
from retarget.human.human import read_human
from tests.retarget.gestures import gesture


@pytest.fixture(scope="module")
def wave() -> Motion:
    return gesture("wave")


def same_arms(a: Motion, b: Motion, atol: float) -> None:
    first, second = read_human(a), read_human(b)
    np.testing.assert_allclose(first.upper, second.upper, atol=atol)
    np.testing.assert_allclose(first.fore, second.fore, atol=atol)


def test_our_own_bvh_is_read_back(wave: Motion, tmp_path: Path) -> None:
    save_bvh(wave, tmp_path / "wave.bvh")
    read = read_motion(tmp_path / "wave.bvh")
    assert (len(read.joints_m), read.fps) == (len(wave.joints_m), 20.0)
    same_arms(read, wave, 0.03)
    np.testing.assert_allclose(read_human(read).head_rotation, read_human(wave).head_rotation, atol=0.12)


def test_humanml3ds_joints_and_features_are_read(wave: Motion, tmp_path: Path) -> None:
    np.save(tmp_path / "joints.npy", wave.joints_m)
    same_arms(read_motion(tmp_path / "joints.npy"), wave, 1e-6)
    body = gesture("point")
    from mmm_core.motion.features import features_from_joints, joints_from_positions

    features = features_from_joints(
        body.joints_m.astype(np.float64),
        np.tile(np.eye(3), (len(body.joints_m), 1, 1)),
        np.zeros((len(body.joints_m), 2)),
    )
    np.save(tmp_path / "features.npy", features)
    read = read_motion(tmp_path / "features.npy")
    np.testing.assert_allclose(read.joints_m, joints_from_positions(features), atol=1e-5)


def test_a_motion_without_a_head_orientation_looks_where_the_body_faces(wave: Motion, tmp_path: Path) -> None:
    """The identity would be the world's front: a person who faces left would look over the shoulder."""
    turned = wave.joints_m[..., [2, 1, 0]] * np.array([1, 1, -1], np.float32)  # faces +x
    np.savez(tmp_path / "turned.npz", joints=turned, fps=20.0)
    forward = read_human(read_motion(tmp_path / "turned.npz")).head_rotation[:, 0, 0]
    assert forward.min() > 0.8


def test_another_rate_is_brought_to_ours(wave: Motion, tmp_path: Path) -> None:
    fine = np.repeat(wave.joints_m, 3, 0)[: 3 * len(wave.joints_m) - 2]
    fine[1:-1:3] = (2 * wave.joints_m[:-1] + wave.joints_m[1:]) / 3
    fine[2::3] = (wave.joints_m[:-1] + 2 * wave.joints_m[1:]) / 3
    np.savez(tmp_path / "fine.npz", joints=fine, fps=60.0)
    read = read_motion(tmp_path / "fine.npz")
    assert len(read.joints_m) == len(wave.joints_m)
    np.testing.assert_allclose(read.joints_m, wave.joints_m, atol=1e-5)


CMU_BVH = """HIERARCHY
ROOT Hips
{ OFFSET 0 0 0 CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
 JOINT LeftUpLeg { OFFSET 3 -1 0 CHANNELS 3 Zrotation Yrotation Xrotation
  JOINT LeftLeg { OFFSET 0 -16 0 CHANNELS 3 Zrotation Yrotation Xrotation
   JOINT LeftFoot { OFFSET 0 -16 0 CHANNELS 3 Zrotation Yrotation Xrotation End Site { OFFSET 0 0 3 } } } }
 JOINT RightUpLeg { OFFSET -3 -1 0 CHANNELS 3 Zrotation Yrotation Xrotation
  JOINT RightLeg { OFFSET 0 -16 0 CHANNELS 3 Zrotation Yrotation Xrotation
   JOINT RightFoot { OFFSET 0 -16 0 CHANNELS 3 Zrotation Yrotation Xrotation End Site { OFFSET 0 0 3 } } } }
 JOINT Spine { OFFSET 0 4 0 CHANNELS 3 Zrotation Yrotation Xrotation
  JOINT Spine1 { OFFSET 0 6 0 CHANNELS 3 Zrotation Yrotation Xrotation
   JOINT Neck { OFFSET 0 6 0 CHANNELS 3 Zrotation Yrotation Xrotation
    JOINT Head { OFFSET 0 3 0 CHANNELS 3 Zrotation Yrotation Xrotation End Site { OFFSET 0 4 0 } } }
   JOINT LeftShoulder { OFFSET 1 5 0 CHANNELS 3 Zrotation Yrotation Xrotation
    JOINT LeftArm { OFFSET 5 0 0 CHANNELS 3 Zrotation Yrotation Xrotation
     JOINT LeftForeArm { OFFSET 10 0 0 CHANNELS 3 Zrotation Yrotation Xrotation
      JOINT LeftHand { OFFSET 9 0 0 CHANNELS 3 Zrotation Yrotation Xrotation End Site { OFFSET 2 0 0 } } } } }
   JOINT RightShoulder { OFFSET -1 5 0 CHANNELS 3 Zrotation Yrotation Xrotation
    JOINT RightArm { OFFSET -5 0 0 CHANNELS 3 Zrotation Yrotation Xrotation
     JOINT RightForeArm { OFFSET -10 0 0 CHANNELS 3 Zrotation Yrotation Xrotation
      JOINT RightHand { OFFSET -9 0 0 CHANNELS 3 Zrotation Yrotation Xrotation End Site { OFFSET -2 0 0 } } } } }
  } }
}
MOTION
Frames: 2
Frame Time: 0.05
"""
N_BVH_JOINTS = 19


def bvh_frames(left_arm_z_deg: float, left_forearm_y_deg: float, hips_y_deg: float = 0.0) -> str:
    names = [
        w for before, w in zip(["", *CMU_BVH.split()], CMU_BVH.split(), strict=False) if before in ("ROOT", "JOINT")
    ]
    row = [0.0, 90.0, 0.0] + [0.0] * (3 * len(names))
    row[3 + 3 * names.index("Hips") + 1] = hips_y_deg
    row[3 + 3 * names.index("LeftArm")] = left_arm_z_deg
    row[3 + 3 * names.index("LeftForeArm") + 1] = left_forearm_y_deg
    line = " ".join(map(str, row))
    return CMU_BVH + f"{line}\n{line}\n"


@pytest.mark.parametrize("facing_deg", [0.0, 70.0])
def test_a_bvh_with_cmus_names_points_where_its_angles_say(tmp_path: Path, facing_deg: float) -> None:
    """T-pose; the left arm lowered by 90 degrees about z, its forearm bent forward: by hand, not by another reader."""
    (tmp_path / "t.bvh").write_text(bvh_frames(-90, -90, facing_deg))
    human = read_human(read_motion(tmp_path / "t.bvh"))
    np.testing.assert_allclose(human.upper[0, 0], [0, 0, -1], atol=1e-6)
    np.testing.assert_allclose(human.fore[0, 0], [1, 0, 0], atol=1e-6)
    np.testing.assert_allclose(human.upper[1, 0], [0, -1, 0], atol=1e-6)
    np.testing.assert_allclose(human.head_rotation[0], np.eye(3), atol=1e-6)


@pytest.mark.parametrize("neck_before_spine", [-2.0, 0.0, 1.0, 3.0])
@pytest.mark.parametrize("bow_deg", [0.0, 30.0])
def test_whoever_stands_upright_is_upright_however_the_neck_is_set(
    tmp_path: Path, neck_before_spine: float, bow_deg: float
) -> None:
    """The neck of a skeleton stands before or behind its spine; only what the person bends is a bend."""
    text = bvh_frames(0, 0).replace("JOINT Neck { OFFSET 0 6 0", f"JOINT Neck {{ OFFSET 0 6 {neck_before_spine}")
    values = text.splitlines()[-1].split()
    names = [w for before, w in zip(["", *text.split()], text.split(), strict=False) if before in ("ROOT", "JOINT")]
    values[3 + 3 * names.index("Spine") + 2] = str(bow_deg)
    (tmp_path / "t.bvh").write_text(text.replace(text.splitlines()[-1], " ".join(values)))
    chest = read_human(read_motion(tmp_path / "t.bvh")).chest_rotation[0]
    bow = np.deg2rad(bow_deg)
    forward_up = [[np.cos(bow), 0, np.sin(bow)], [0, 1, 0], [-np.sin(bow), 0, np.cos(bow)]]  # about y, the left
    np.testing.assert_allclose(chest, forward_up, atol=1e-6)


ASF = """:version 1.10
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
{bones}
:hierarchy
begin
root lhipjoint rhipjoint lowerback
lhipjoint lfemur
lfemur ltibia
ltibia lfoot
rhipjoint rfemur
rfemur rtibia
rtibia rfoot
lowerback upperback
upperback thorax
thorax lowerneck lclavicle rclavicle
lowerneck upperneck
upperneck head
lclavicle lhumerus
lhumerus lradius
rclavicle rhumerus
rhumerus rradius
end
"""
BONES = {
    "lhipjoint": (1, -0.5, 0), "rhipjoint": (-1, -0.5, 0), "lfemur": (0, -1, 0), "rfemur": (0, -1, 0), "ltibia": (0, -1, 0),
    "rtibia": (0, -1, 0), "lfoot": (0, 0, 1), "rfoot": (0, 0, 1), "lowerback": (0, 1, 0), "upperback": (0, 1, 0),
    "thorax": (0, 1, 0), "lowerneck": (0, 1, 0), "upperneck": (0, 1, 0), "head": (0, 1, 0), "lclavicle": (1, 0, 0),
    "rclavicle": (-1, 0, 0), "lhumerus": (1, 0, 0), "rhumerus": (-1, 0, 0), "lradius": (1, 0, 0), "rradius": (-1, 0, 0),
}  # fmt: skip


def asf(axis: str) -> str:
    """A T-pose skeleton; the left upper arm's own axes are turned by `axis`, it moves about all three."""
    rows = []
    for i, (name, v) in enumerate(BONES.items()):
        own = axis if name == "lhumerus" else "0 0 0 XYZ"
        rows.append(f"begin\n id {i + 1}\n name {name}\n direction {v[0]} {v[1]} {v[2]}\n length 3\n axis {own}")
        if name == "lhumerus":
            rows.append(" dof rx ry rz\n limits (-180 180)\n (-180 180)\n (-180 180)")
        rows.append("end")
    return ASF.replace("{bones}", "\n".join(rows))


@pytest.mark.parametrize(
    ("axis", "angles", "direction"),
    [
        ("0 0 0 XYZ", "0 0 -90", [0, 0, -1]),  # about z: from the side to hanging
        ("0 0 0 XYZ", "0 -90 0", [1, 0, 0]),  # about y: from the side to the front
        ("0 0 90 XYZ", "-90 0 0", [1, 0, 0]),  # its x is the body's y: the same
        ("0 90 0 XYZ", "0 0 90", [0, 1, 0]),  # its z is the body's x: only a twist
    ],
)
def test_an_amc_turns_about_the_bones_own_axes(tmp_path: Path, axis: str, angles: str, direction: list[float]) -> None:
    (tmp_path / "01.asf").write_text(asf(axis))
    (tmp_path / "01_02.amc").write_text(
        "#!\n:FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 17 0 0 0 0\nlhumerus " + angles + "\n"
    )
    motion = read_amc(tmp_path / "01_02.amc")
    np.testing.assert_allclose(read_human(motion).upper[0, 0], direction, atol=1e-6)
    assert 0.4 < np.linalg.norm(motion.joints_m[0, 20] - motion.joints_m[0, 16]) < 0.6, "scaled to a person"


BAD = [
    ("none.npz", None, "no such file"),
    ("a.txt", "x", "a .txt file"),
    ("a.bvh", "HIER", "begins with HIERARCHY"),
    ("a.bvh", CMU_BVH + "1 2 3\n", "3 values for 2 frames"),
    ("a.bvh", CMU_BVH.replace("LeftForeArm", "Tentacle") + "0 " * 2, "values"),
    ("a.bvh", bvh_frames(0, 0).replace("LeftForeArm", "Tentacle"), "left_elbow"),
    ("a.bvh", bvh_frames(0, 0).replace("Frame Time: 0.05", "Frame Time: 0"), "Frame Time"),
    ("a.bvh", bvh_frames(0, 0).replace("90.0", "nan"), "not finite"),
    ("a.bvh", "HIERARCHY\nROOT Hips {", "cut short"),
    ("a.amc", "1\nroot 0 0 0 0 0 0\n", "no .asf"),
]


@pytest.mark.parametrize(("name", "text", "said"), BAD, ids=[f"{i} {b[2]}" for i, b in enumerate(BAD)])
def test_what_cannot_be_read_is_named(tmp_path: Path, name: str, text: str | None, said: str) -> None:
    if text is not None:
        (tmp_path / name).write_text(text)
    with pytest.raises(MotionFileError) as caught:
        read_motion(tmp_path / name)
    assert said in str(caught.value) and name in str(caught.value)


def test_arrays_that_are_no_motion_are_named(tmp_path: Path, wave: Motion) -> None:
    broken = wave.joints_m.copy()
    broken[7, 3, 1] = np.nan
    for name, array, said in (
        ("order", wave.joints_m[:, :21], "(T, 22, 3)"), ("nan", broken, "the first is 7"), ("empty", wave.joints_m[:0], "none"),
        ("text", np.array("hello"), "shape ()"), ("features", np.full((4, 263), np.inf), "NaN or infinite"),
    ):  # fmt: skip
        np.save(tmp_path / f"{name}.npy", array)
        with pytest.raises(MotionFileError) as caught:
            read_motion(tmp_path / f"{name}.npy")
        assert said in str(caught.value), str(caught.value)
    np.savez(tmp_path / "rate.npz", joints=wave.joints_m)
    with pytest.raises(MotionFileError, match="fps"):
        read_motion(tmp_path / "rate.npz")


def test_a_humanml3d_folder_is_read_by_its_joints(tmp_path: Path, wave: Motion) -> None:
    for folder in ("new_joints", "new_joint_vecs", "texts"):
        (tmp_path / folder).mkdir()
        np.save(tmp_path / folder / "000001.npy", wave.joints_m)
    assert find_motions(tmp_path) == [tmp_path / "new_joints" / "000001.npy"]
