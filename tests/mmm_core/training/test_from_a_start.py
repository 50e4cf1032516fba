"""Trainings that begin with a finished model: more steps, more codes, a mean of models, layers of the text encoder."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
import torch

from daemon.cli import main
from mmm_core.generate.engine import Engine
from mmm_core.inference.checkpoint import file_hash, load_model, load_tensors, load_text_encoder, save_model
from mmm_core.inference.people_weights import people_file
from mmm_core.training.recipe import read_recipe
from mmm_core.training.run import Run, Schedule
from mmm_core.training.run import train as run_stage
from mmm_core.training.stages import Stages
from tests.support.motion_folders import make_folder
from tests.support.small_training import Finished, small

pytestmark = pytest.mark.usefixtures("quick_parts")


@pytest.mark.long
def test_a_recipe_with_more_codes_refines_those_of_its_start(tmp_path: Path, finished: Finished) -> None:
    """The refined model is made once; a run that is started again goes on from that model."""
    more, run = small(tmp_path / "more.toml"), tmp_path / "more"
    start = f'start = "{finished.model}"\n'
    more.write_text(start + more.read_text().replace("n_codes = 16", "n_codes = 24"))
    for _ in range(2):
        assert main(["train", "--config", str(more), "--run", str(run), "--sample-every", "0"]) == 0
        grown, made = (load_model(run / name) for name in ("start_refined.safetensors", "model.safetensors"))
        for name, tensor in grown.tokenizer.state_dict().items():
            assert torch.equal(made.tokenizer.state_dict()[name], tensor), name
        assert made.tokenizer.config.n_codes == made.transformer.config.n_codes == 24


@pytest.mark.long
def test_a_recipe_goes_on_from_a_finished_model(
    tmp_path: Path, finished: Finished, capsys: pytest.CaptureFixture[str]
) -> None:
    """Tokenizer and decoder stay as in the start; the transformer has the start's weights and is trained further."""
    start = tmp_path / "model.safetensors"
    shutil.copy(finished.model, start)
    old = load_model(start)
    for steps in (0, 8):
        config, run = small(tmp_path / f"more{steps}.toml", steps=steps, synthesised=14), tmp_path / f"more{steps}"
        config.write_text(f'start = "{start}"\n{config.read_text()}')
        assert main(["train", "--config", str(config), "--run", str(run), "--sample-every", "0"]) == 0
        new = load_model(run / "model.safetensors")
        for name, tensor in old.tokenizer.state_dict().items():
            assert torch.equal(new.tokenizer.state_dict()[name], tensor), name
        same = torch.equal(new.transformer.head.weight, old.transformer.head.weight)
        assert same == (steps == 0)
        assert new.provenance["clips"] == 14 and new.provenance["start"]["clips"] == 12
        assert "those of its start (synthesised gestures" in new.provenance["data"]
        assert torch.equal(new.length.out.weight, old.length.out.weight) == (steps == 0)
    folder = make_folder(tmp_path / "data", "humanml3d")
    for change, instead, options, named in (
        ("width = 32", "width = 64", [], "transformer"),
        ("n_codes = 16", "n_codes = 8", [], "tokenizer"),
        ("[data]", "[text]\nencoder = 'clip'\n[data]", [], "text"),
        ("", "", ["--data", str(folder)], "rest_pose"),
    ):
        other = tmp_path / f"{named}.toml"
        other.write_text(config.read_text().replace(change, instead) if change else config.read_text())
        assert main(["train", "transformer", "--config", str(other), "--run", str(tmp_path / named), *options]) == 2
        assert f"{start}: key '{named}'" in capsys.readouterr().err
    save_model(start, load_model())
    assert main(["train", "--config", str(config), "--run", str(run)]) == 2
    assert "which the run began with" in capsys.readouterr().err
    assert main(["train", "tokenizer", "--config", str(config), "--run", str(run)]) == 2
    assert "whose tokenizer stays" in capsys.readouterr().err


def test_a_recipe_with_a_rank_writes_changes_that_its_start_uses(
    tmp_path: Path, finished: Finished, capsys: pytest.CaptureFixture[str]
) -> None:
    """The start is not changed; captions of people have other motions with the changes beside it, gestures have the same."""
    start = tmp_path / "model.safetensors"
    shutil.copy(finished.model, start)
    plain = Engine.load(start, threads=None, precision="fp32")
    config, out = small(tmp_path / "people.toml", steps=8), people_file(start)
    ranked = config.read_text().replace("[transformer]\n", "[transformer]\nrank = 2\nguidance = 1.5\n")
    ranked = ranked.replace("[tokenizer]\n", "[tokenizer]\nrank = 2\n")
    config.write_text(f'start = "{start}"\n{ranked}')
    arguments = ["train", "--config", str(config), "--sample-every", "0", "--out", str(out), "--run"]
    assert main([*arguments, str(tmp_path / "without")]) == 2 and "no clip of a person" in capsys.readouterr().err
    data = tmp_path / "data"
    data.mkdir()
    motion = plain.generate("wave", seed=1, seconds=3).motion
    np.save(data / "dribble.npy", motion.joints_m)
    (data / "clips.jsonl").write_text('{"trial": "dribble", "captions": ["a person dribbles a basketball"]}\n')
    assert main([*arguments, str(tmp_path / "run"), "--data", str(data)]) == 0
    tensors, metadata = load_tensors(out, "mmmd-people")
    assert tensors["head.up"].shape == (3 * 16, 2) and tensors["head.up"].abs().max() > 0
    assert tensors["tokenizer.decoder.stem.up"].abs().max() > 0
    assert metadata["guidance"] == 1.5 and metadata["provenance"]["start"]["sha256"] == file_hash(finished.model)
    engine = Engine.load(start, threads=None, precision="fp32")
    assert engine.people is not None and plain.people is None
    for name, tensor in plain.model.transformer.state_dict().items():
        assert torch.equal(engine.model.transformer.state_dict()[name], tensor), name
    for own, other in zip(engine.model.tokenizer.books, engine.people.tokenizer.books, strict=True):
        assert torch.equal(own.codebook, other.codebook)
    config.write_text(ranked)
    assert main(["train", "transformer", "--config", str(config), "--run", str(tmp_path / "new")]) == 2
    config.write_text(f'start = "{start}"\n' + ranked.replace("[transformer]\nrank = 2", "[transformer]"))
    assert main(["train", "--config", str(config), "--run", str(tmp_path / "alone"), "--data", str(data)]) == 2
    assert "tokenizer.rank" in capsys.readouterr().err


@pytest.mark.long
def test_the_mean_of_models_that_went_on_from_one_start(
    tmp_path: Path, finished: Finished, capsys: pytest.CaptureFixture[str]
) -> None:
    first, start = finished
    made: list[Path] = []
    for seed in (4, 5):
        config = tmp_path / "on.toml"
        config.write_text(f'start = "{start}"\n{first.read_text()}')
        made.append(tmp_path / f"{seed}.safetensors")
        options = {"config": config, "seed": seed, "run": tmp_path / f"{seed}", "sample-every": 0, "out": made[-1]}
        assert main(["train", *(word for key, value in options.items() for word in (f"--{key}", str(value)))]) == 0
    out = tmp_path / "mean.safetensors"
    assert main(["train", "average", "--models", *map(str, made), "--out", str(out)]) == 0
    a, b, mean = (load_model(p) for p in (*made, out))
    assert not torch.equal(a.transformer.head.weight, b.transformer.head.weight)
    for part in ("transformer", "length", "tokenizer"):
        states = [m.modules[part].state_dict() for m in (a, b, mean)]
        for name, tensor in states[2].items():
            torch.testing.assert_close(
                tensor, ((states[0][name] + states[1][name]) / 2).to(tensor.dtype), atol=1e-3, rtol=1e-3
            )
    assert a.scope is not None and mean.scope is not None and torch.equal(a.scope.vectors, mean.scope.vectors)
    assert [m["seed"] for m in mean.provenance["average_of"]] == [4, 5]
    assert mean.provenance["data"] == a.provenance["data"], "named once"
    with_start = tmp_path / "with_start.safetensors"
    assert main(["train", "average", "--models", str(made[0]), str(start), "--out", str(with_start)]) == 0
    told, as_start = load_model(with_start).provenance["average_of"]
    assert told["start"]["sha256"] == as_start["sha256"] and as_start.keys() == {"sha256"}, "told once"
    assert (
        len(Engine.load(out, precision="fp32").generate("wave with your right hand", seed=1, seconds=1).motion.joints_m)
        == 20
    )

    other = tmp_path / "other.safetensors"
    save_model(other, load_model())
    assert main(["train", "average", "--models", str(out), str(other), "--out", str(tmp_path / "no")]) == 2
    assert f"{other}: key 'transformer'" in capsys.readouterr().err
    elsewhere = ["train", "--config", str(first), "--seed", "6", "--run", str(tmp_path / "elsewhere")]
    assert main([*elsewhere, "--sample-every", "0"]) == 0
    made_elsewhere = tmp_path / "elsewhere" / "model.safetensors"
    assert main(["train", "average", "--models", str(out), str(made_elsewhere), "--out", str(tmp_path / "no")]) == 2
    assert f"{made_elsewhere}: key 'tokenizer'" in capsys.readouterr().err
    for wrong in (["average"], ["average", "--models", str(out)], ["scope", "--models", str(out)]):
        assert main(["train", *wrong]) == 2
    assert not (tmp_path / "no").exists()


@pytest.mark.long
def test_the_last_layers_of_the_text_encoder_become_the_models_own(
    tmp_path: Path, finished: Finished, capsys: pytest.CaptureFixture[str]
) -> None:
    """They begin as the encoder's: untrained they change nothing. Trained they change words and leave sentences as they were."""
    (first, start), text = finished, "wave with your right hand"
    made = {}
    for steps in (0, 8):
        config, run = small(tmp_path / f"tuned{steps}.toml", steps=steps), tmp_path / f"tuned{steps}"
        config.write_text(f'start = "{start}"\n[text]\ntuned_layers = 2\ntuned_rate = 0.5\n{config.read_text()[9:]}')
        assert main(["train", "--config", str(config), "--run", str(run), "--sample-every", "0"]) == 0
        made[steps] = Engine.load(run / "model.safetensors", threads=None, precision="fp32")
    old, (untrained, trained) = Engine.load(start, threads=None, precision="fp32"), (made[0], made[8])
    for engine in (untrained, trained):
        ours, theirs = engine.understand(text)[0], old.understand(text)[0]
        torch.testing.assert_close(ours.sentence, theirs.sentence)
        assert not torch.allclose(ours.words, theirs.words, atol=0.1), "they come from below the last layers"
    motions = [engine.generate(text, seed=4, seconds=2).motion for engine in (old, untrained)]
    np.testing.assert_array_equal(motions[0].tokens, motions[1].tokens)
    base = load_text_encoder().layers[-1].state_dict()
    kept, moved = (load_model(tmp_path / f"tuned{steps}" / "model.safetensors").transformer for steps in (0, 8))
    assert all(torch.equal(t, base[name]) for name, t in kept.word_layers[-1].state_dict().items())
    assert not torch.equal(moved.word_layers[-1].state_dict()["qkv.weight"], base["qkv.weight"])
    again = tmp_path / "again.toml"
    again.write_text(config.read_text().replace(str(start), str(tmp_path / "tuned8" / "model.safetensors")))
    assert main(["train", "length", "--config", str(again), "--run", str(tmp_path / "again")]) == 0
    frozen = tmp_path / "frozen.toml"
    frozen.write_text(
        again.read_text().replace("tuned_layers = 2", "tuned_layers = 0").replace("steps = 8", "steps = 0")
    )
    assert main(["train", "--config", str(frozen), "--run", str(tmp_path / "frozen"), "--sample-every", "0"]) == 0
    left = load_model(tmp_path / "frozen" / "model.safetensors").transformer
    assert left.config.n_words == 0 and torch.equal(left.head.weight, moved.head.weight)
    for recipe, tuned, named in ((again, 1, "transformer"), (first, 7, "text.tuned_layers")):
        other = tmp_path / f"{named}.toml"
        rest = recipe.read_text().replace("tuned_layers = 2", f"tuned_layers = {tuned}")
        other.write_text(rest if "tuned_layers" in rest else f"{rest}[text]\ntuned_layers = {tuned}\n")
        assert main(["train", "transformer", "--config", str(other), "--run", str(tmp_path / named)]) == 2
        assert named in capsys.readouterr().err


def test_a_share_of_the_learning_rate_for_a_part(tmp_path: Path) -> None:
    """Adam's first step is as long as the rate, whatever the gradient."""
    module = torch.nn.ModuleDict({"fast": torch.nn.Linear(4, 4), "slow": torch.nn.Linear(4, 4)})
    before = {name: p.detach().clone() for name, p in module.named_parameters()}

    def loss(_step: int, _generator: torch.Generator) -> dict[str, torch.Tensor]:
        return {"loss": torch.stack([layer(torch.ones(4)).square().sum() for layer in module.values()]).sum()}

    schedule = Schedule(steps=1, learning_rate=1e-2, warmup_steps=0, weight_decay=0.0, ema_decay=0.0, clip_norm=0.0)
    run_stage(module, loss, schedule, Run(tmp_path), "parts", slower={"slow.": 0.1})
    moved = {name: float((p.detach() - before[name]).abs().max()) for name, p in module.named_parameters()}
    assert moved["fast.weight"] == pytest.approx(1e-2, rel=1e-2)
    assert moved["slow.weight"] == pytest.approx(1e-3, rel=1e-2)


@pytest.mark.parametrize("recipe", ["ablation", "compact_deterministic", "compact_lengths", "people"])
def test_the_recipes_that_go_on_fit_the_shipped_model(tmp_path: Path, recipe: str) -> None:
    assert Stages(read_recipe(recipe), Run(tmp_path)).start is not None
