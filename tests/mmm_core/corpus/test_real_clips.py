"""Recordings among the training clips: mirrored, cut to their spans, in a folder of one's own, in any file that is read."""

from __future__ import annotations

import json
import os
from itertools import islice
from pathlib import Path

import numpy as np
import pytest

from mmm_core.corpus.cmu import read_clips
from mmm_core.corpus.families import Gesture
from mmm_core.corpus.synthesis import ClipSpec, synthesise_spec
from mmm_core.errors import MotionFileError, TrainingDataError
from mmm_core.motion.bvh import save_bvh
from mmm_core.motion.features import recover
from mmm_core.motion.motion import Motion

SHARED = Path(os.environ.get("MMMD_SHARED", Path(__file__).parents[4] / "shared"))


@pytest.mark.skipif(
    not (SHARED / "data/clips.jsonl").is_file(), reason="the shared motion data is not beside this checkout"
)
@pytest.mark.parametrize("at_most", [60, pytest.param(None, id="all", marks=pytest.mark.soak)])
def test_real_clips_come_with_their_mirror_and_only_usable_ones(at_most: int | None) -> None:
    clips = list(islice(read_clips(SHARED / "data"), at_most))
    assert len(clips) > 300 or len(clips) == at_most
    assert len(clips) % 2 == 0
    assert all(24 <= len(f) <= 196 and c for f, c in clips)


def folder(path: Path, clip: dict[str, object]) -> Path:
    (path / "trials.jsonl").write_text(json.dumps({"trial": "a", "terms": "CMU", "bad_frames": []}) + "\n")
    base = {
        "clip": "c1",
        "trial": "a",
        "start": 0,
        "end": 40,
        "split": "train",
        "captions": ["x"],
        "caption_source": ["ours"],
    }
    (path / "clips.jsonl").write_text(json.dumps(base | clip) + "\n")
    np.savez(path / "motions_common_skeleton.npz", a=np.zeros((40, 22, 3), np.float32))
    return path


def test_a_span_outside_its_recording_is_named(tmp_path: Path) -> None:
    with pytest.raises(TrainingDataError, match=r"c1.*frames 10 to 90.*40 frames"):
        list(read_clips(folder(tmp_path, {"start": 10, "end": 90})))


def test_further_recordings_take_the_place_of_their_older_copies(tmp_path: Path) -> None:
    """Where both folders hold a recording, under one name or under a benchmark's name, the copy in `more` is read."""

    def write(path: Path, trials: dict[str, str], **more: str) -> None:
        path.mkdir(exist_ok=True)
        lines = [{"trial": t, "terms": terms, "bad_frames": [], **more} for t, terms in trials.items()]
        clip = {"start": 0, "end": 40, "split": "train", "caption_source": ["ours"]}
        clips = [clip | {"clip": t, "trial": t, "captions": [f"{path.name} {t}"]} for t in trials]
        (path / "trials.jsonl").write_text("\n".join(map(json.dumps, lines)))
        (path / "clips.jsonl").write_text("\n".join(map(json.dumps, clips)))
        np.savez(path / "motions_common_skeleton.npz", **dict.fromkeys(trials, standing))

    made = synthesise_spec(ClipSpec((Gesture("bow"),)), np.random.default_rng(0))
    assert made is not None
    standing = recover(made.features[:40]).joints_m.astype(np.float32)
    old = tmp_path / "old"
    write(old, {"01": "CMU", "05": "CMU", "cmu-jumping_4-train": "CMU", "09": "unknown"})
    write(old / "more", {"05": "CMU", "13_32": "MIT", "m": "CC0", "n": "non-commercial"}, replaces_rig="cc")
    assert {c for _, captions in read_clips(old) for c in captions} == {"old 01", "more 05", "more 13_32", "more m"}


def test_an_unknown_recording_is_named(tmp_path: Path) -> None:
    with pytest.raises(TrainingDataError, match=r"'b' is unknown"):
        list(read_clips(folder(tmp_path, {"trial": "b"})))


def test_a_folder_without_files_is_named(tmp_path: Path) -> None:
    with pytest.raises(TrainingDataError, match=r"clips\.jsonl"):
        list(read_clips(tmp_path))


def test_a_folder_of_ones_own_needs_recordings_and_captions_alone(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """Recordings with terms that are not in the list were left out without a word, and a line had to have nine fields."""
    caplog.set_level("INFO")
    made = synthesise_spec(ClipSpec((Gesture("bow"),)), np.random.default_rng(0))
    assert made is not None
    standing = recover(made.features[:40]).joints_m.astype(np.float32)
    np.savez(tmp_path / "motions_common_skeleton.npz", a=standing, b=standing[:20])
    (tmp_path / "clips.jsonl").write_text(
        '{"trial": "a", "captions": ["bow low"]}\n{"trial": "b", "captions": ["bow"]}\n'
    )
    (features, captions), (_, mirrored) = read_clips(tmp_path)
    assert len(features) == 40 and captions == mirrored == ["bow low"]
    assert "1 clips of train are left out: 24 frames or fewer" in caplog.text

    (tmp_path / "trials.jsonl").write_text('{"trial": "a", "terms": "mine"}\n{"trial": "b"}\n')
    assert list(read_clips(tmp_path)) == []
    assert "terms 'mine', where CMU, MIT, CC0, own are used" in caplog.text
    (tmp_path / "clips.jsonl").write_text('{"trial": "a"}\n')
    (tmp_path / "trials.jsonl").unlink()
    with pytest.raises(TrainingDataError, match="captions None"):
        list(read_clips(tmp_path))


def test_recordings_may_be_files_of_any_kind_that_is_read(tmp_path: Path) -> None:
    """A motion of `mmmd generate` and an array of HumanML3D's joints were "unknown": BVH and AMC alone were looked for."""
    made = synthesise_spec(ClipSpec((Gesture("bow"),)), np.random.default_rng(0))
    assert made is not None
    joints = recover(made.features[:40]).joints_m.astype(np.float32)
    np.savez(tmp_path / "generated.npz", joints=joints, fps=20.0)
    np.save(tmp_path / "recorded.npy", joints)
    lines = [json.dumps({"trial": name, "captions": [name]}) for name in ("generated", "recorded")]
    (tmp_path / "clips.jsonl").write_text("\n".join(lines))
    (one, _), _, (other, _), _ = read_clips(tmp_path)
    np.testing.assert_array_equal(one, other)

    (tmp_path / "clips.jsonl").write_text('{"trial": "nobody", "captions": ["bow"]}')
    with pytest.raises(TrainingDataError, match=r"'nobody' is unknown.*\.npz, \.npy, \.bvh, \.amc"):
        list(read_clips(tmp_path))


def test_clips_are_cut_from_bvh_files_where_there_is_no_array(tmp_path: Path) -> None:
    """A person of another size, 30 cm higher, is read on the common body and on the floor, followed by the mirror image."""
    made = synthesise_spec(ClipSpec((Gesture("wave", "right", 3),)), np.random.default_rng(0))
    assert made is not None
    r, n, f32 = recover(made.features), len(made.features), np.float32
    motion = Motion(
        r.joints_m.astype(f32) * 1.2 + np.array([0, 0.3, 0], f32), 20.0, r.head_quat_wxyz.astype(f32),
        r.forearm_twist_rad.astype(f32), made.features, np.zeros(n // 4, np.int32), "x", 0, "accepted", 1.0,
    )  # fmt: skip
    clip = {
        "trial": "01_01",
        "clip": "c",
        "start": 0,
        "end": n,
        "split": "train",
        "captions": ["wave right"],
        "caption_source": ["us"],
    }
    (tmp_path / "trials.jsonl").write_text(json.dumps({"trial": "01_01", "terms": "CMU", "bad_frames": []}))
    (tmp_path / "clips.jsonl").write_text(json.dumps(clip))
    save_bvh(motion, tmp_path / "01_01.bvh")
    (features, captions), (_, mirrored) = read_clips(tmp_path)
    assert (captions, mirrored) == (["wave right"], ["wave left"])
    joints, original = recover(features).joints_m, r.joints_m[: len(features)]
    for j, parent in ((18, 16), (19, 17), (20, 18), (21, 19)):
        bones = [m[:, j] - m[:, parent] for m in (joints, original)]
        assert np.abs(bones[0] - bones[1]).max() < 0.02
    assert abs(np.percentile(joints[:, (10, 11), 1], 2)) < 0.03

    (tmp_path / "01_01.bvh").write_text("HIERARCHY\nnonsense")
    with pytest.raises(MotionFileError, match=r"01_01\.bvh"):
        list(read_clips(tmp_path))
