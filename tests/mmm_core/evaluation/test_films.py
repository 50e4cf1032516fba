"""Films and contact sheets: what is drawn, which stretch of a recording, and that a refused prompt is said."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from PIL.GifImagePlugin import GifImageFile

from mmm_core.errors import TrainingDataError
from mmm_core.evaluation import films
from mmm_core.evaluation.films import FILMS, PANEL, Film, PostureFeatures, contact_sheet, film, liveliest, make, person
from mmm_core.evaluation.worst_films import make_worst, read_ranking
from mmm_core.generate.engine import Engine
from mmm_core.motion.skeleton import Array


def shown(engine: Engine, text: str, seconds: float) -> PostureFeatures:
    motion = engine.generate(text, seconds=seconds).motion
    return PostureFeatures.of(motion.joints_m, motion.head_quat_wxyz)


def reds(image: Image.Image) -> Array:
    """Columns of the red pixels: the person's left side."""
    pixels = np.asarray(image.convert("RGB"), np.int32)
    return np.nonzero((pixels[..., 0] > 150) & (pixels[..., 2] < 110))[1].astype(np.float64)


def test_there_are_24_prompts_and_as_many_files() -> None:
    assert len(FILMS) == len({f.stem for f in FILMS}) == 24
    assert Film("Bow, then nod!").stem == "bow_then_nod"


def test_a_persons_left_is_on_the_right(engine: Engine) -> None:
    motion = shown(engine, "raise your left arm", 2)
    assert reds(person(motion, 0)).mean() > PANEL[0] / 2
    image = np.asarray(person(motion, 30))
    assert image.shape == (PANEL[1], PANEL[0], 3) and (image < 200).any() and (image[:, [0, -1]] > 200).all()


def test_a_turned_head_is_seen(engine: Engine) -> None:
    motion = shown(engine, "look to the left", 2)
    turned = PostureFeatures(motion.joints_m, -motion.face)
    assert np.abs(motion.face[:, 0]).max() > 0.3
    assert not np.array_equal(np.asarray(person(motion, 20)), np.asarray(person(turned, 20)))


def test_a_film_has_every_second_frame_and_the_shorter_one_stands(engine: Engine, tmp_path: Path) -> None:
    one, two = shown(engine, "wave", 3), shown(engine, "nod", 1)
    film(tmp_path / "a.gif", [one, two])
    with GifImageFile(tmp_path / "a.gif") as gif:
        assert gif.size == (2 * PANEL[0], PANEL[1])
        assert 0.6 * 30 <= gif.n_frames <= 30  # equal neighbours are joined
    assert (tmp_path / "a.gif").stat().st_size < 150_000
    contact_sheet(tmp_path / "sheet.png", [("a", one), ("b", two)])
    with Image.open(tmp_path / "sheet.png") as sheet:
        assert sheet.size[0] == 8 * PANEL[0]


def test_the_liveliest_stretch() -> None:
    joints = np.zeros((60, 22, 3))
    joints[30:40, 20, 0] = np.sin(np.arange(10))
    motion = PostureFeatures(joints, np.zeros((60, 3)))
    found = liveliest(motion, 15)
    assert len(found) == 15 and np.abs(found.joints_m[:, 20, 0]).sum() == pytest.approx(np.abs(joints[:, 20, 0]).sum())
    assert liveliest(motion, 60) is motion


@pytest.mark.long
def test_all_together(engine: Engine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real = {"somebody waves": shown(engine, "wave with your right hand", 4)}
    monkeypatch.setattr(films, "recordings", lambda _folder, wanted: {c: real[c] for c in wanted})
    wanted = (
        Film("wave with your right hand", "somebody waves"),
        Film("clap"),
        Film("kick the ball with your left foot"),
    )
    written = make(engine, tmp_path, tmp_path / "out", wanted)
    assert [p.name for p in written] == ["wave_with_your_right_hand.gif", "clap.gif", "sheet_1.png", "README.md"]
    page = written[-1].read_text()
    assert "refused: " in page and "somebody waves" in page and "no recording of such a thing" in page
    with Image.open(written[0]) as a, Image.open(written[1]) as b:
        assert (a.size[0], b.size[0]) == (2 * PANEL[0], PANEL[0])


def test_a_folder_without_the_recordings_is_refused(tmp_path: Path) -> None:
    with pytest.raises(TrainingDataError):
        films.recordings(tmp_path, ["a person throws punches"])


@pytest.mark.long
def test_the_worst_families_stand_beside_the_corpus(engine: Engine, tmp_path: Path) -> None:
    told = tmp_path / "fidelity.json"
    told.write_text(
        json.dumps({"worst": [["row", 0.0], ["clap", 0.25]], "families": {"row": {}, "clap": {}, "bow": {}}, "n": 12})
    )
    written = make_worst(engine, read_ranking(told), tmp_path)
    assert [p.name for p in written] == ["worst_row.gif", "worst_clap.gif", "worst.md"]
    with GifImageFile(written[0]) as gif:
        assert gif.size == (2 * PANEL[0], PANEL[1]) and gif.n_frames > 10
    page = written[-1].read_text()
    assert "worst of 3 families" in page and "by 12 motions," in page
    assert "| clap | 0.25 |" in page and "worst_row.gif" in page and engine.checkpoint_hash[:12] in page
    told.write_text("{}")
    with pytest.raises(TrainingDataError, match="worst"):
        read_ranking(told)
