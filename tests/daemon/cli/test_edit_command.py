"""`mmmd edit` and `mmmd generate --story` on files, as a user runs them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from daemon.cli import main
from daemon.generator.generated import arrays_of
from daemon.generator.messages import EditMessage, GenerateMessage, UnfitRequestError
from daemon.generator.service import EngineService
from mmm_core.generate import shown_edits
from mmm_core.motion.motion import load_npz
from tests.support.shipped import loaded_once, shipped_engine
from tests.support.sizes import few_and_long

WRIST, SHOULDER = 20, 16
"""Joints of the left arm."""


@pytest.fixture(scope="module", autouse=True)
def one_engine() -> Iterator[None]:
    with loaded_once():
        yield


@pytest.fixture(scope="module")
def wave(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("motions") / "wave.npz"
    assert main(["generate", "wave with your right hand", "--seconds", "4", "--out", str(path)]) == 0
    return path


def test_one_part_of_a_motion_is_made_again(wave: Path, tmp_path: Path) -> None:
    out = tmp_path / "edited.npz"
    command = ["edit", str(wave), "raise your left arm", "--part", "left_arm", "--out", str(out)]
    assert main([*command, "--bvh", str(tmp_path / "e.bvh")]) == 0
    before, after = load_npz(wave), load_npz(out)
    assert before.joints_m[:, WRIST, 1].max() < before.joints_m[:, SHOULDER, 1].min(), "the arm hangs"
    assert after.joints_m[:, WRIST, 1].max() > after.joints_m[:, SHOULDER, 1].max() + 0.2, "the arm is raised"
    assert (tmp_path / "e.bvh").read_text().startswith("HIERARCHY")


def test_a_motion_grows_at_its_end(wave: Path, tmp_path: Path) -> None:
    out = tmp_path / "longer.npz"
    assert main(["edit", str(wave), "bow", "--after-s", "4", "--out", str(out)]) == 0
    assert len(load_npz(out).joints_m) == 160


def test_what_is_not_reached_ends_with_status_1(
    wave: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The nearest motion is written, so that it can be looked at."""
    monkeypatch.setattr(shown_edits, "CANDIDATES", 1)
    out = tmp_path / "near.npz"
    nod = tmp_path / "nod.npz"
    assert main(["generate", "nod twice", "--seconds", "3", "--out", str(nod)]) == 0
    capsys.readouterr()
    assert main(["edit", str(nod), "clap your hands", "--part", "left_arm", "--out", str(out)]) == 1
    said = capsys.readouterr()
    assert "not reached: asked was a motion that claps" in said.err
    assert str(out) in said.out
    assert len(load_npz(out).joints_m) == 60


@pytest.mark.long
def test_the_generator_says_what_is_not_reached() -> None:
    """`rejected` with `not_reached`: the robot does not move."""
    maker = EngineService(shipped_engine())
    (nod,) = maker.generate(GenerateMessage(id=1, text="nod twice", seconds=3.0))
    with pytest.raises(UnfitRequestError) as caught:
        maker.edit(EditMessage(id=2, motion=arrays_of(nod.motion), text="clap your hands", parts=["left_arm"]))
    assert caught.value.code == "not_reached"
    assert caught.value.allowed.startswith("a motion that claps")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--part", "tail"], "left_arm, right_arm, rest"),
        (["--start-s", "2", "--end-s", "1"], "0 <= start < end <= 4.0 s"),
        (["--part", "rest", "--after-s", "1"], "one or the other"),
        (["--then", "other.npz"], "--after-s"),
    ],
)
def test_what_does_not_fit_is_said(
    wave: Path, tmp_path: Path, options: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["edit", str(wave), "bow", *options, "--out", str(tmp_path / "out.npz")]) == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "out.npz").exists()


def test_a_story_becomes_one_motion(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scenes, out = tmp_path / "scenes.jsonl", tmp_path / "story.npz"
    scenes.write_text('{"text": "wave with your right hand", "seconds": 2}\n\n{"text": "xq zzt"}\n{"text": "bow"}\n')
    assert main(["generate", "--story", str(scenes), "--out", str(out)]) == 0
    story = load_npz(out)
    assert story.text == "wave with your right hand; bow"
    assert len(story.joints_m) == 4 * len(story.tokens)
    assert "left out: 'xq zzt'" in capsys.readouterr().err


def test_a_bad_scene_is_named_by_its_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scenes = tmp_path / "scenes.jsonl"
    scenes.write_text('{"text": "bow"}\n{"txt": "bow"}\n')
    assert main(["generate", "--story", str(scenes), "--out", str(tmp_path / "s.npz")]) == 2
    assert "line 2" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("names", "bone"),
    few_and_long([("cmu", "LowerBack")], [("mixamo", "mixamorig:Spine2"), ("mmmd", "spine1")]),
)
def test_bvh_is_written_with_the_names_that_are_asked_for(wave: Path, tmp_path: Path, names: str, bone: str) -> None:
    out = ["--out", str(tmp_path / "m.npz"), "--bvh", str(tmp_path / "m.bvh"), "--bvh-names", names]
    assert main(["generate", "nod", "--seconds", "2", *out]) == 0
    assert f"JOINT {bone}\n" in (tmp_path / "m.bvh").read_text()
    assert main(["retarget", str(tmp_path / "m.bvh"), "--out", str(tmp_path / "ticks.npz")]) == 0
    (tmp_path / "m.bvh").unlink()
    assert main(["edit", str(wave), "nod", "--part", "rest", *out]) == 0
    assert f"JOINT {bone}\n" in (tmp_path / "m.bvh").read_text()
