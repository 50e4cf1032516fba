"""`mmmd train` as a user runs it: every stage of a small recipe, a folder of one's own, and what bad input gets."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import torch

from daemon.cli import main
from mmm_core.errors import TrainingDataError
from mmm_core.evaluation.extractors import load_evaluator
from mmm_core.generate.engine import Engine
from mmm_core.inference.checkpoint import load_model, save_model
from mmm_core.training.recipe import known_recipes, read_recipe
from tests.support.motion_folders import make_folder
from tests.support.sizes import few_and_long
from tests.support.small_training import index_commands, small

pytestmark = pytest.mark.usefixtures("quick_parts")


@pytest.mark.long
@pytest.mark.parametrize("layout", few_and_long(["parts"], ["whole", "halves"]))
def test_every_stage_of_every_layout_gives_a_model_that_generates(tmp_path: Path, layout: str) -> None:
    config, run, out = small(tmp_path / "small.toml", layout), tmp_path / "run", tmp_path / "model.safetensors"
    command = ["train", "--config", str(config), "--run", str(run), "--out", str(out), "--sample-every", "8"]
    assert main(command) == 0
    model = load_model(out)
    assert model.provenance["seed"] == 3
    assert "synthesised gestures" in model.provenance["data"]
    assert set(model.provenance["metrics"]) >= {"tokenizer", "transformer", "length"}
    assert (run / "samples" / "transformer_000008.png").read_bytes().startswith(b"\x89PNG")
    engine = Engine.load(out, threads=None)
    if layout != "halves":
        assert engine.generate("wave with your right hand", seed=1, seconds=1).motion.joints_m.shape == (20, 22, 3)


@pytest.mark.long
def test_a_recipe_makes_clips_while_it_trains(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Rounds are made when their first step comes; lengths and, where asked for, the decoder of a start learn from the newest."""
    config, run = small(tmp_path / "fresh.toml"), tmp_path / "run"
    fresh = "[data.fresh]\nclips = 2\nfirst = 4\nevery = 4\nrounds = 1\ncaptions = 1\n"
    config.write_text(config.read_text().replace("[tokenizer]", fresh + "[tokenizer]", 1))
    assert main(["train", "--config", str(config), "--run", str(run), "--sample-every", "0"]) == 0
    assert sorted(p.name for p in (run / "fresh").iterdir()) == ["round_0000.pt", "round_0001.pt"]
    assert load_model(run / "model.safetensors").provenance["recipe"]["data"]["fresh"]["clips"] == 2
    more = tmp_path / "more.toml"
    more.write_text(
        f'start = "{run / "model.safetensors"}"\n'
        + config.read_text().replace("layout =", "tune_start = true\nlayout =")
    )
    assert main(["train", "--config", str(more), "--run", str(tmp_path / "more"), "--sample-every", "0"]) == 0
    old, new = (load_model(folder / "model.safetensors").tokenizer for folder in (run, tmp_path / "more"))
    changed = {name.split(".")[0] for name, t in old.state_dict().items() if not torch.equal(t, new.state_dict()[name])}
    assert changed == {"decoder"}, "its ids stay what they are"
    tuned = tmp_path / "tuned.toml"
    tuned.write_text(config.read_text() + "[text]\ntuned_layers = 1\n")
    assert main(["train", "--config", str(tuned), "--run", str(tmp_path / "tuned")]) == 2
    assert "text.tuned_layers" in capsys.readouterr().err


@pytest.mark.long
def test_the_scope_of_a_finished_run_is_built_again(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    config, run, out = small(tmp_path / "small.toml"), tmp_path / "run", tmp_path / "again.safetensors"
    old = load_model()
    run.mkdir()
    save_model(run / "model.safetensors", old)
    assert main(["train", "scope", "--config", str(config), "--run", str(run), "--out", str(out)]) == 0
    model = load_model(out)
    assert model.scope is not None and model.scope.classifier is not None
    assert model.scope.commands[: model.scope.n_known] == index_commands()
    assert torch.equal(model.transformer.head.weight, old.transformer.head.weight)
    old.scope = None
    save_model(run / "model.safetensors", old)
    assert main(["train", "scope", "--config", str(config), "--run", str(run)]) != 0
    assert "a model without one" in capsys.readouterr().err


@pytest.mark.long
def test_an_evaluator_is_trained_and_written(tmp_path: Path) -> None:
    config, run = small(tmp_path / "small.toml"), tmp_path / "run"
    assert main(["train", "evaluator", "--config", str(config), "--run", str(run)]) == 0
    evaluator, provenance = load_evaluator(run / "evaluator.safetensors")
    assert evaluator.config.n_features == 263
    assert provenance["clips"] == 12


@pytest.mark.parametrize("kind", few_and_long(["kit"], ["humanml3d"]))
def test_a_users_own_folder_trains(tmp_path: Path, kind: str) -> None:
    folder = make_folder(tmp_path / "data", kind)
    config = small(tmp_path / "small.toml", "whole", synthesised=0)
    run = tmp_path / "run"
    assert main(["train", "--config", str(config), "--data", str(folder), "--run", str(run)]) == 0
    model = load_model(run / "model.safetensors")
    assert model.rest_pose == "humanml3d"
    assert "data: made for a test" in model.provenance["data"]
    assert model.tokenizer.config.n_features == (263 if kind == "humanml3d" else 251)  # type: ignore[union-attr]
    np.testing.assert_array_equal(model.tokenizer.mean.numpy(), np.load(folder / "Mean.npy").astype(np.float32))


@pytest.mark.long
def test_bf16_trains_too(tmp_path: Path) -> None:
    config = small(tmp_path / "small.toml")
    options = ["train", "transformer", "--config", str(config), "--run", str(tmp_path / "run"), "--precision", "bf16"]
    assert main([*options, "--sample-every", "0"]) == 0
    weights = torch.load(tmp_path / "run" / "transformer.pt", weights_only=True)["module"]
    assert all(torch.isfinite(w).all() for w in weights.values())
    assert weights["head.weight"].dtype == torch.float32


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ("[tokenizer]\nwidht = 3\n", r"tokenizer\.widht.*allowed|tokenizer\.widht.*unknown"),
        ("[tokenizer.schedule]\nsteps = 'many'\n", r"tokenizer\.schedule\.steps"),
        ("tokenizer = 3\n", r"a table \[tokenizer\]"),
        ("[tokenizer]\nlayout = 'thirds'\n", r"tokenizer\.layout"),
        ("[tokenizer\n", "not TOML"),
    ],
)
def test_a_bad_recipe_is_named_by_its_key(tmp_path: Path, change: str, message: str) -> None:
    (tmp_path / "r.toml").write_text(change)
    with pytest.raises(TrainingDataError, match=message):
        read_recipe(str(tmp_path / "r.toml"))


def test_an_unknown_recipe_lists_those_that_ship(capsys: pytest.CaptureFixture[str]) -> None:
    assert known_recipes() == [
        "ablation",
        "compact",
        "compact_deterministic",
        "compact_lengths",
        "paper",
        "people",
        "small",
    ]
    for name in known_recipes():
        read_recipe(name)
    assert main(["train", "--config", "nothing"]) == 2
    assert "ablation, compact, compact_deterministic, compact_lengths, paper, people" in capsys.readouterr().err


def test_the_papers_recipe_has_the_released_sizes() -> None:
    recipe = read_recipe("paper")
    tokenizer = recipe.tokenizer.config(263)
    transformer = recipe.transformer.config(tokenizer, 1, 512)
    from mmm_core.model.transformer import OFFICIAL
    from mmm_core.model.vqvae import VqVaeConfig

    assert tokenizer == VqVaeConfig()
    assert transformer == OFFICIAL


@pytest.mark.skipif(torch.cuda.is_available(), reason="there is a GPU here")
def test_a_missing_gpu_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["train", "--device", "cuda", "--run", str(tmp_path)]) == 2
    assert "no CUDA device" in capsys.readouterr().err


def test_data_without_a_clip_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    config = small(tmp_path / "small.toml", synthesised=0)
    assert main(["train", "--config", str(config), "--run", str(tmp_path / "run")]) == 2
    assert "no clip" in capsys.readouterr().err
