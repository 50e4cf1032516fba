"""The BVH read back by a parser of its own: joint positions by forward kinematics are those of the motion."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from mmm_core.corpus.families import Gesture
from mmm_core.corpus.synthesis import ClipSpec, synthesise_spec
from mmm_core.evaluation.robot_capability import as_motion
from mmm_core.imports.recordings.bvh import read_bvh
from mmm_core.motion.bvh import bvh_text, save_bvh
from mmm_core.motion.motion import Motion
from mmm_core.motion.skeleton import (
    JOINT_NAMES,
    PARENTS,
    facing_yaw_rad,
    forward_kinematics,
    local_rotations,
    matrix_from_quat,
    quat_wxyz,
    rotation_about,
    rotation_y,
)
from tests.support.sizes import few_and_long


def a_motion(turn_rad: float, seed: int = 0, T: int = 30) -> Motion:
    """Random smooth bending of every bone on the common body, turned by `turn_rad`, walking a little."""
    rng = np.random.default_rng(seed)
    phase = np.linspace(0, 2 * np.pi, T)
    local = np.tile(np.eye(3), (T, 22, 1, 1))
    for j in range(1, 22):
        axis = rng.normal(size=3)
        local[:, j] = rotation_about(
            axis / np.linalg.norm(axis), rng.uniform(0.1, 0.7) * np.sin(phase + rng.uniform(0, 6))
        )
    local[:, 0] = rotation_y(turn_rad + 0.2 * np.sin(phase))
    root = np.stack([np.sin(phase), 0.9 + 0.02 * np.sin(phase), 0.3 * phase], -1)
    joints, world = forward_kinematics(local, root)
    return Motion(joints.astype(np.float32), 20.0, quat_wxyz(world[:, 15]).astype(np.float32), np.full((T, 2), 0.4, np.float32),
                  np.zeros((T, 263), np.float32), np.zeros(0, np.int32), "", 0, "accepted", 1.0)  # fmt: skip


def a_gesture(family: str, turn_rad: float = 0.0) -> Motion:
    """A gesture of the corpus, turned about the vertical."""
    gesture = Gesture(family, *{"clap": ("both", 2), "wave": ("left", 3), "twist": ("", 1, "left")}.get(family, ()))
    clip = synthesise_spec(ClipSpec((gesture,)), np.random.default_rng(3))
    assert clip is not None
    motion, turn = as_motion(clip.body.features()), rotation_y(np.array(turn_rad))
    head = quat_wxyz(turn @ matrix_from_quat(motion.head_quat_wxyz.astype(float)))
    return replace(
        motion, joints_m=(motion.joints_m @ turn.T).astype(np.float32), head_quat_wxyz=head.astype(np.float32)
    )


def parse(text: str):
    """Node name -> (parent, offset cm, channels), end sites as `NAME_end`; frames; frame time."""
    head, _, tail = text.partition("MOTION\n")
    nodes, stack, channels, name = {}, [], [], ""
    for line in head.splitlines()[1:]:
        word, *rest = line.split()
        if word in ("ROOT", "JOINT"):
            name = rest[0]
        elif word == "End":
            name = stack[-1] + "_end"
        elif word == "{":
            assert name not in nodes, f"{name} twice"
            nodes[name] = [stack[-1] if stack else None, None, []]
            stack.append(name)
        elif word == "}":
            stack.pop()
        elif word == "OFFSET":
            nodes[stack[-1]][1] = np.array(rest, float)
        elif word == "CHANNELS":
            assert int(rest[0]) == len(rest) - 1
            nodes[stack[-1]][2] = rest[1:]
            channels += [(stack[-1], channel) for channel in rest[1:]]
        else:
            raise AssertionError(f"not BVH: {line}")
    assert not stack
    count = int(re.search(r"^Frames: (\d+)$", tail, re.M)[1])
    frame_time = float(re.search(r"^Frame Time: ([\d.]+)$", tail, re.M)[1])
    rows = np.array([line.split() for line in tail.splitlines()[2:]], float)
    assert rows.shape == (count, len(channels))
    return nodes, channels, rows, frame_time


def elementary(axis: str, deg: float) -> np.ndarray:
    c, s = np.cos(np.deg2rad(deg)), np.sin(np.deg2rad(deg))
    return np.array({"X": [[1, 0, 0], [0, c, -s], [0, s, c]], "Y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
                     "Z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}[axis])  # fmt: skip


def positions_cm(nodes, channels, row):
    R, at, values = {}, {}, {}
    for (name, channel), value in zip(channels, row, strict=True):
        values.setdefault(name, []).append((channel, value))
    for name, (parent, offset, _) in nodes.items():
        above_R, above = (np.eye(3), np.zeros(3)) if parent is None else (R[parent], at[parent])
        at[name] = above + above_R @ offset
        R[name] = above_R
        for channel, value in values.get(name, []):
            if channel.endswith("position"):
                at[name]["XYZ".index(channel[0])] += value
            else:
                R[name] = R[name] @ elementary(channel[0], value)
    return at


@pytest.mark.parametrize("turn_deg", [0, 90, 180, -135])
def test_joints_by_fk_are_those_of_the_motion(turn_deg):
    motion = a_motion(np.deg2rad(turn_deg), seed=turn_deg % 7)
    nodes, channels, rows, frame_time = parse(bvh_text(motion))
    assert frame_time == pytest.approx(1 / 20)
    ends = {"left_foot": "left_ankle_end", "right_foot": "right_ankle_end", "head": "neck_end",
            "left_wrist": "left_elbow_end", "right_wrist": "right_elbow_end"}  # fmt: skip
    starts = {"spine3": "spine3_neck"}
    for t in range(0, len(rows), 7):
        at = positions_cm(nodes, channels, rows[t])
        for j, name in enumerate(JOINT_NAMES):
            found = at[ends.get(name, starts.get(name, name))]
            assert found == pytest.approx(100 * motion.joints_m[t, j], abs=0.05), (name, t)


def test_head_orientation_and_forearm_twist_survive():
    motion = a_motion(0.5)
    _, channels, rows, _ = parse(bvh_text(motion))
    local = local_rotations(
        motion.joints_m.astype(float), facing_yaw_rad(motion.joints_m.astype(float)), None, motion.forearm_twist_rad
    )
    without = local_rotations(motion.joints_m.astype(float), facing_yaw_rad(motion.joints_m.astype(float)), None, None)
    assert not np.allclose(local[:, 20], without[:, 20])
    columns = [i for i, (name, _) in enumerate(channels) if name == "left_elbow"]
    R = np.eye(3)
    for i in columns:
        R = R @ elementary(channels[i][1][0], rows[3, i])
    assert pytest.approx(local[3, 20], abs=1e-4) == R


def test_angles_do_not_jump():
    _, _, rows, _ = parse(bvh_text(a_motion(np.pi, T=120)))
    assert np.abs(np.diff(rows[:, 3:], axis=0)).max() < 30


def test_names_are_unique_and_every_bone_is_there():
    nodes, *_ = parse(bvh_text(a_motion(0.0)))
    assert len([n for n in nodes if not n.endswith("_end")]) == 1 + len(PARENTS) - 1


def test_a_motion_without_frames_is_refused(tmp_path):
    empty = Motion(np.zeros((0, 22, 3), np.float32), 20.0, np.zeros((0, 4), np.float32), np.zeros((0, 2), np.float32),
                   np.zeros((0, 263), np.float32), np.zeros(0, np.int32), "", 0, "rejected", 0.0)  # fmt: skip
    with pytest.raises(ValueError, match="no BVH"):
        save_bvh(empty, tmp_path / "x.bvh")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("names", "prefix"), [("cmu", ""), ("mixamo", "mixamorig:")])
class TestStandardNames:
    """Retargeting programs find bones by name: those of Mixamo's rig, and of the CMU recordings' BVH conversion."""

    def test_bones_have_the_names_that_programs_know(self, names, prefix):
        nodes, *_ = parse(bvh_text(a_motion(0.0), names))
        sided = [f"{side}{bone}" for side in ("Left", "Right") for bone in
                 ("UpLeg", "Leg", "Foot", "ToeBase", "Shoulder", "Arm", "ForeArm", "Hand")]  # fmt: skip
        spine = {"cmu": ["LowerBack", "Spine", "Spine1"], "mixamo": ["Spine", "Spine1", "Spine2"]}[names]
        wanted = {prefix + bone for bone in ("Hips", *spine, "Neck", "Head", *sided)}
        assert {n for n in nodes if not n.endswith("_end")} == wanted

    def test_no_bone_has_length_zero_and_arms_rest_in_a_t(self, names, prefix):
        nodes, *_ = parse(bvh_text(a_motion(0.0), names))
        assert all(np.linalg.norm(offset) > 1 for parent, offset, _ in nodes.values() if parent is not None)
        for side, sign in (("Left", 1), ("Right", -1)):
            for bone in ("ForeArm", "Hand"):
                offset = nodes[f"{prefix}{side}{bone}"][1]
                assert offset[0] * sign == pytest.approx(np.linalg.norm(offset))

    @pytest.mark.parametrize(
        ("family", "turn_deg"), few_and_long([("twist", -135)], [("clap", 0), ("bow", 90), ("wave", 180), ("nod", 0)])
    )
    def test_our_reader_finds_the_motion_again(self, names, prefix, family, turn_deg, tmp_path):
        """Pelvis and chest are rigid in these skeletons: a motion that bends them has its joints within two centimetres."""
        motion = a_gesture(family, np.deg2rad(turn_deg))
        save_bvh(motion, tmp_path / "motion.bvh", names)
        again = read_bvh(tmp_path / "motion.bvh")
        off = np.linalg.norm(again.joints_m - motion.joints_m, axis=-1)
        assert off.max() < 0.02, off.max()
        turned = matrix_from_quat(again.head_quat_wxyz) @ np.swapaxes(matrix_from_quat(motion.head_quat_wxyz), -1, -2)
        cosine = np.clip((np.trace(turned, axis1=1, axis2=2) - 1) / 2, -1, 1)
        assert np.rad2deg(np.arccos(cosine)).max() < 4, (
            "the reader's upright is the line from pelvis to shoulders: 3.4 degrees"
        )

    def test_angles_do_not_jump(self, names, prefix):
        _, _, rows, _ = parse(bvh_text(a_gesture("clap", np.pi), names))
        assert np.abs(np.diff(rows[:, 3:], axis=0)).max() < 40
