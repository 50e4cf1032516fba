"""`mmmd train ablation`: variants are trained and measured alike, what has figures is not made again, bad input is named."""

from __future__ import annotations

import json
import os
import re
from dataclasses import replace
from pathlib import Path

import pytest

from daemon.cli import main
from mmm_core.corpus.heldout import PROBES
from mmm_core.errors import TrainingDataError
from mmm_core.evaluation import probes, reconstruction
from mmm_core.inference.checkpoint import load_model
from mmm_core.model.tokenizer import TokenizerConfig
from mmm_core.training import ablation
from mmm_core.training.ablation import BASE, TOKENIZERS, TRANSFORMERS, run_ablations, table
from mmm_core.training.recipe import read_recipe
from mmm_core.training.run import Run

DATA = Path(os.environ.get("MMMD_SHARED", Path(__file__).parents[4] / "shared")) / "data"
needs_data = pytest.mark.skipif(
    not (DATA / "clips.jsonl").is_file(), reason="the shared motion data is not beside this checkout"
)
SMALL = "2048 x 4"
TUNED = "last two layers of the text encoder trained"
FOLDER, SMALL_FOLDER = (name.replace(" ", "_") for name in (TUNED, SMALL))
EACH_KIND = [
    next(p for p in PROBES if expects(p))
    for expects in (
        lambda p: p.count and not p.then, lambda p: p.direction and p.side, lambda p: p.hold_s, lambda p: p.tempo, lambda p: p.then
    )
]  # fmt: skip


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    """Few probes and repeats: each is a motion made and judged."""
    for module in (probes, reconstruction):
        monkeypatch.setattr(module, "PROBES", EACH_KIND)
    monkeypatch.setattr(reconstruction, "N_EACH", 1)
    for name in ("PROBE_SEEDS", "REAL_REPEATS"):
        monkeypatch.setattr(ablation, name, 1)
    monkeypatch.setattr(ablation, "REAL_EACH", 2)


@pytest.fixture
def some_recordings(tmp_path: Path) -> Path:
    """A folder with a dozen clips to train on, and as many held-out ones as R-precision needs."""
    folder = tmp_path / "data"
    folder.mkdir()
    for name in ("trials.jsonl", "motions_common_skeleton.npz"):
        (folder / name).symlink_to(DATA / name)
    lines = (DATA / "clips.jsonl").read_text().splitlines()
    train, test = ([line for line in lines if f'"split": "{split}"' in line] for split in ("train", "test"))
    (folder / "clips.jsonl").write_text("\n".join([*train[:12], *test]))
    return folder


@pytest.mark.long
@needs_data
@pytest.mark.usefixtures("few")
def test_variants_are_trained_and_measured_and_kept(
    tmp_path: Path, some_recordings: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    recipe = tmp_path / "small.toml"
    shipped = (Path(ablation.__file__).parent / "recipes" / "ablation.toml").read_text()
    small = shipped.replace("synthesised = 10000", "synthesised = 20")
    small = re.sub(r"steps = \d+", "steps = 2", small)
    recipe.write_text(small.replace("[transformer]", "[transformer]\ntokens_per_batch = 96"))
    command = ["train", "ablation", "--config", str(recipe), "--data", str(some_recordings), "--run", str(tmp_path / "run"),
               "--variant", TUNED, SMALL]  # fmt: skip
    assert main(command) == 0
    printed = capsys.readouterr().out
    assert all(f"| {name} |" in printed for name in (TUNED, SMALL)) and "error_mm" in printed
    figures = {path.parent.name: json.loads(path.read_text()) for path in tmp_path.glob("run/*/figures.json")}
    assert set(figures) == {FOLDER, SMALL_FOLDER}
    assert load_model(tmp_path / "run" / FOLDER / "model.safetensors").transformer.config.n_words == 2
    assert figures[FOLDER]["r1_ratio"] >= 0 and figures[SMALL_FOLDER]["codes_used"] > 0
    (tmp_path / "run" / FOLDER / "figures.json").write_text(json.dumps({"limb": 0.25}))
    assert run_ablations(read_recipe(str(recipe)), Run(tmp_path / "run"), some_recordings, [TUNED]) == {
        TUNED: {"limb": 0.25}
    }


def test_what_is_asked_for_wrongly_is_named(tmp_path: Path) -> None:
    with pytest.raises(TrainingDataError, match=r"1024 x 2.*128 x 16"):
        run_ablations(read_recipe("ablation"), Run(tmp_path), DATA, ["1024 x 2"])
    with pytest.raises(TrainingDataError, match="'start': none"):
        run_ablations(read_recipe("compact"), Run(tmp_path), DATA)


def test_on_the_command_line_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["train", "ablation", "--data", str(tmp_path), "--run", str(tmp_path)]) != 0
    assert "clips.jsonl" in capsys.readouterr().err
    assert main(["train", "length", "--variant", BASE, "--run", str(tmp_path)]) != 0
    assert "mmmd train ablation" in capsys.readouterr().err


def test_a_variant_differs_from_the_shipped_recipe_in_its_one_choice() -> None:
    base, shipped = read_recipe("ablation"), read_recipe("compact")
    sizes, shipped_sizes = base.tokenizer.config(263), shipped.tokenizer.config(263)
    assert isinstance(sizes, TokenizerConfig) and isinstance(shipped_sizes, TokenizerConfig)
    assert base.transformer.corruption == shipped.transformer.corruption
    assert replace(sizes, n_codes=shipped_sizes.n_codes) == shipped_sizes, "the shipped codebooks were refined since"
    for name, variant in {**TRANSFORMERS, **TOKENIZERS}.items():
        changed = {**variant.corruption, **variant.tokenizer, **variant.text}
        here = {**vars(base.transformer.corruption), **vars(base.tokenizer), **vars(base.text)}
        different = [key for key, value in changed.items() if here[key] != value]
        assert len(different) == (0 if name == BASE or "as shipped" in name else 1), name


def test_a_table_has_a_line_for_each_variant() -> None:
    figures = {"a": {"limb": 0.5, "side": 1.0}, "b": {"limb": 0.12345, "side": 0.0}}
    assert table(figures, ["b", "c", "a"]).splitlines() == [
        "|  | limb | side |", "| --- | --- | --- |", "| b | 0.123 | 0 |", "| a | 0.5 | 1 |"
    ]  # fmt: skip
    assert table(figures, ["c"]) == ""
