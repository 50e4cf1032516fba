"""Gestures, sentences and real clips: what training sees."""

from __future__ import annotations

import json
import os
import re
from itertools import islice
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.corpus.cmu import read_clips
from mmm_core.corpus.families import FAMILIES, Gesture
from mmm_core.corpus.families.gesture import Words
from mmm_core.corpus.families.phrases import parse_phrases
from mmm_core.corpus.grammar import caption
from mmm_core.corpus.plain_commands import known_commands, plain_phrases
from mmm_core.corpus.score import REST_ARM, Score
from mmm_core.corpus.stream import make_corpus
from mmm_core.corpus.synthesis import ClipSpec, draw_spec, synthesise, synthesise_spec
from mmm_core.errors import MotionFileError, TrainingDataError
from mmm_core.language.mirroring import mirror_words
from mmm_core.motion.bvh import save_bvh
from mmm_core.motion.features import recover
from mmm_core.motion.motion import Motion

SHARED = Path(os.environ.get("MMMD_SHARED", Path(__file__).parents[4] / "shared"))


@given(st.integers(0, 3000))
def test_every_clip_is_whole_tokens_finite_and_bounded_in_speed(seed: int) -> None:
    """An arm's ways are arcs: no wrist rushes, not even when a hanging arm is raised straight up."""
    clip = synthesise(np.random.default_rng(seed))
    assert len(clip.features) % 4 == 0
    assert 4 <= len(clip.features) <= 196
    assert np.isfinite(clip.features).all()
    joints = recover(clip.features).joints_m
    assert np.linalg.norm(np.diff(joints[:, [20, 21]], axis=0), axis=-1).max() * 20 < 7.0, "wrists, m/s"


def test_a_clip_depends_on_seed_and_number_alone() -> None:
    first, again = make_corpus(6, None, 3), make_corpus(4, None, 3)
    for a, b in zip(first[:4], again, strict=True):
        assert np.array_equal(a.features, b.features)
        assert a.captions == b.captions
    assert not np.array_equal(make_corpus(1, None, 4)[0].features, first[0].features)


@pytest.mark.parametrize("n_seeds", [1, pytest.param(4, marks=pytest.mark.soak)])
@pytest.mark.parametrize("name", sorted(FAMILIES))
def test_every_family_performs_and_speaks_in_all_its_forms(name: str, n_seeds: int) -> None:
    family = FAMILIES[name]
    for side in family.sides or ("",):
        for where in family.directions or ("",):
            for seed in range(n_seeds):
                spec = ClipSpec((Gesture(name, side, 2 if family.counts else 1, where),))
                clip = synthesise_spec(spec, np.random.default_rng(seed))
                assert clip is not None
                assert all(c and "{" not in c for c in clip.captions)


@given(st.integers(0, 3000))
def test_a_caption_has_no_mark_no_slot_and_single_spaces(seed: int) -> None:
    """Verbs that are bent and phrases without one, in any order: what marks them is gone in the end."""
    rng = np.random.default_rng(seed)
    spec = draw_spec(rng)
    said = caption(list(spec.gestures), spec.parallel, rng)
    assert not set(said) & set("~^{}()|")
    assert "  " not in said
    assert said == said.strip()


def test_a_phrase_without_a_verb_is_never_bent() -> None:
    """A noun is asked for, not done by somebody: no "a person a bows"."""
    nouns = {p for _, p in plain_phrases("bow") if p.startswith(("a ", "one "))}
    assert nouns
    for seed in range(300):
        said = caption([Gesture("bow")], False, np.random.default_rng(seed)).lower()
        assert not re.search(r"\b(aing|as bow|someone a |person a |is a )", said), said


@given(st.integers(0, 3000))
def test_a_sentence_names_no_side_that_the_motion_has_not(seed: int) -> None:
    """A plain one-armed gesture without contrast: "left" in the words means the left arm."""
    rng = np.random.default_rng(seed)
    side = str(rng.choice(["left", "right"]))
    other = {"left": "right", "right": "left"}[side]
    words = caption([Gesture("raise", side)], False, rng).lower().replace(",", " ").replace("-", " ")
    denied = any(
        w in words
        for w in ("not ", "don't", "instead", "leave", "keep", "without", "rests", "rather", "stop", "no ", "i said")
    )
    assert other not in words.split() or denied
    named = any(sorted(word.strip(".,!:;")) == sorted(side) for word in words.split())  # a slip of the finger counts
    assert named or side == "right", "an unnamed side is the right one"


@pytest.mark.parametrize("name", sorted(FAMILIES))
def test_each_family_can_be_said_in_twenty_ways_and_for_every_side(name: str) -> None:
    family = FAMILIES[name]
    phrases = {(row, p) for where in family.directions or ("",) for row, p in plain_phrases(name, where)}
    assert len({p for _, p in phrases}) >= 20
    rows = {row for row, _ in phrases}
    wanted = {"both": "both", "left": "one", "right": "one", "alternating": "alternating", "": "none"}
    assert {wanted[s] for s in family.sides or ("",)} <= rows


def test_phrases_are_read_by_section_and_direction() -> None:
    words, directed = parse_phrases("[bare]\nnod {n}\n\n[one]\nnod left\n[up: bare]\nlook up\n", "nod.txt")
    assert words == Words(("nod {n}",), one=("nod left",))
    assert directed == {"up": Words(("look up",))}


@pytest.mark.parametrize(
    ("text", "message"), [("[bear]\nnod\n", "nod.txt:1: section '[bear]'"), ("\nnod\n[bare]\n", "nod.txt:2: a phrase")]
)
def test_a_phrase_without_a_known_section_is_named(text: str, message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)):
        parse_phrases(text, "nod.txt")


def test_each_family_has_its_phrase_file_and_no_file_is_left_over() -> None:
    folder = Path(__file__).parents[3] / "mmm_core" / "corpus" / "phrases"
    assert {path.stem for path in folder.glob("*.txt")} == set(FAMILIES)


def test_known_commands_are_plain() -> None:
    known = known_commands(10_000)
    assert {"wave your left hand", "clap three times", "point up"} <= known
    assert not [c for c in known if "{" in c or "  " in c]


def test_sequences_and_parallels_are_drawn() -> None:
    specs = [draw_spec(np.random.default_rng(i)) for i in range(200)]
    assert {len(s.gestures) for s in specs} == {1, 2, 3}
    assert any(s.parallel for s in specs)


def test_a_score_holds_what_it_does_not_move() -> None:
    rest = {"left": REST_ARM.vector(), "head": np.zeros(3)}
    score = Score(np.random.default_rng(0), rest)
    score.hold(0.5)
    score.move(1.0, head=(1.0, 0.0, 0.0))
    times = np.array([0.0, 0.5, 1.0, 1.5, 3.0])
    assert np.allclose(score.sample("head", times)[:, 0], [0, 0, 0.5, 1, 1])
    assert np.allclose(score.sample("left", times), rest["left"])


@pytest.mark.parametrize(
    ("said", "mirrored"),
    [
        ("waves the left hand", "waves the right hand"),
        ("Left arm up", "Right arm up"),
        ("turns right right away", "turns left right away"),
        ("he left the room with his left hand up", "he left the room with his right hand up"),
        ("the hand on the left hip, then on the right", "the hand on the right hip, then on the left"),
        ("walks clockwise", "walks counterclockwise"),
        ("walks counter-clockwise", "walks clockwise"),
        ("is all right", "is all right"),
        ("raises its right arm right after", "raises its left arm right after"),
        ("with the hand on the left hip on the right", "with the hand on the right hip on the left"),
        ("puts the right hand on the left hip, right away", "puts the left hand on the right hip, right away"),
        ("he left the room waving", "he left the room waving"),
        ("they left, then turned left", "they left, then turned right"),
        ("is left standing, left hand up", "is left standing, right hand up"),
        ("what is left of the left arm", "what is left of the right arm"),
        ("the person's left hand is left out", "the person's right hand is left out"),
        ("turn right right there", "turn left right there"),
        ("right as he raises the left arm", "right as he raises the right arm"),
        ("right in front of him, the left hand", "right in front of him, the right hand"),
        ("it serves him right", "it serves him right"),
        ("you are right, wave with the left hand", "you are right, wave with the right hand"),
        ("the right way to wave", "the right way to wave"),
        ("a right angle with the left elbow", "a right angle with the right elbow"),
        ("leaves to the left", "leaves to the right"),
        ("has left to the right", "has left to the left"),
        ("a right-handed punch", "a left-handed punch"),
        ("the leftmost finger", "the rightmost finger"),
        ("circles anti-clockwise", "circles clockwise"),
        ("clockwise, then counter clockwise", "counterclockwise, then clockwise"),
        ("LEFT arm! Right arm!", "RIGHT arm! Left arm!"),
        ("bright light, upright posture, copyright", "bright light, upright posture, copyright"),
        ("the hand is right", "the hand is right"),
        ("the arm is to the right", "the arm is to the left"),
        ("his right arm is left of his head", "his left arm is right of his head"),
    ],
)
def test_words_of_a_mirrored_clip(said: str, mirrored: str) -> None:
    assert mirror_words(said) == mirrored


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
    """Of a recording that both folders hold under one name, or under a benchmark's name, the copy in `more` is read."""

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
    """The same person of another size, 30 cm higher: on the common body, on the floor, followed by the mirror image."""
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
