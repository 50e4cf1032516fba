"""`mmmd train` as a user runs it: small recipes, a killed run, two processes, and what bad input gets."""

from __future__ import annotations

import csv
import functools
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
import torch

from daemon.cli import main
from mmm_core.corpus.plain_commands import known_commands
from mmm_core.errors import CheckpointError, TrainingDataError
from mmm_core.evaluation.extractors import load_evaluator
from mmm_core.generate.engine import Engine
from mmm_core.inference.checkpoint import load_model, load_text_encoder, save_model
from mmm_core.model.text import MiniLm, TextEncoder
from mmm_core.training import samples, scope_training
from mmm_core.training.batches import CaptionStates
from mmm_core.training.recipe import known_recipes, read_recipe
from mmm_core.training.run import Run, Schedule
from mmm_core.training.run import train as run_stage
from mmm_core.training.stages import Stages
from tests.support.motion_folders import make_folder
from tests.support.sizes import few_and_long

SCHEDULE = "steps = {steps}\nlearning_rate = 1e-3\nwarmup_steps = 2\nsave_every = 3\n"
SMALL = """
seed = 3
[data]
synthesised = {synthesised}
licence = "made for a test"
[tokenizer]
layout = "{layout}"
n_codes = 16
code_dim = 8
width = 16
batch = 8
window_frames = 40
[tokenizer.schedule]
{schedule}
[tokenizer.decoder]
{schedule}
[transformer]
width = 32
n_heads = 2
n_cross = 1
n_self = 1
dropout = 0.0
tokens_per_batch = 96
[transformer.corruption]
part_share = 0.5
[transformer.schedule]
{schedule}
[length]
{schedule}
[evaluator]
{schedule}
[scope]
sentences = 100
outside = 100
"""


@functools.cache
def index_commands() -> list[str]:
    """The known commands in the index: reading all that ship have takes longer than the training here."""
    return sorted(known_commands(1))[::20]


_VECTORS: dict[str, torch.Tensor] = {}
"""Vectors of the scope's sentences: most are the same in every training here, and reading them takes longer than it."""
_STATES: dict[tuple[int, tuple[str, ...]], CaptionStates] = {}
"""Caption states by the layers that the encoder leaves out: runs of one seed have the same captions."""


@pytest.fixture(scope="module", autouse=True)
def quick_parts() -> Iterator[None]:
    vectors_of, states_of = scope_training.sentence_vectors, CaptionStates.encode

    def sentence_vectors(texts: list[str], encoder: TextEncoder) -> torch.Tensor:
        if new := [text for text in dict.fromkeys(texts) if text not in _VECTORS]:
            _VECTORS.update(zip(new, vectors_of(new, encoder), strict=True))
        return torch.stack([_VECTORS[text] for text in texts])

    def encode(captions: Sequence[str], encoder: MiniLm) -> CaptionStates:
        key = encoder.n_left_out, tuple(captions)
        if key not in _STATES:
            _STATES[key] = states_of(captions, encoder)
        return _STATES[key]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(scope_training, "sentence_vectors", sentence_vectors)
        patch.setattr(CaptionStates, "encode", encode)
        patch.setattr(samples, "INSTANTS", 2)  # most of the time of a picture is its axes
        patch.setattr(scope_training, "known_commands", lambda *_: set(index_commands()))
        patch.setattr(scope_training, "OUTSIDE", scope_training.OUTSIDE[::8])
        yield


class Finished(NamedTuple):
    """A recipe's file, and the model that its run gave."""

    recipe: Path
    model: Path


def small(path: Path, layout: str = "parts", steps: int = 8, synthesised: int = 12) -> Path:
    schedule = SCHEDULE.format(steps=steps)
    path.write_text(SMALL.format(layout=layout, schedule=schedule, synthesised=synthesised))
    return path


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Finished:
    """A small recipe and the model that it gave, from which the runs of several tests go on."""
    folder = tmp_path_factory.mktemp("finished")
    recipe = small(folder / "first.toml")
    assert main(["train", "--config", str(recipe), "--run", str(folder / "first"), "--sample-every", "0"]) == 0
    return Finished(recipe, folder / "first" / "model.safetensors")


def environment() -> dict[str, str]:
    root = str(Path(__file__).parents[3])
    return {**os.environ, "PYTHONPATH": root, "OMP_NUM_THREADS": "1", "OMP_WAIT_POLICY": "passive"}


def losses(path: Path) -> np.ndarray:
    with path.open() as f:
        rows = list(csv.reader(f))
    return np.array([[float(v) for v in row[2:]] for row in rows if row[0] != "step"])


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
    assert main(["train", "--config", str(tuned), "--run", str(tmp_path / "tuned")]) == 1
    assert "text.tuned_layers" in capsys.readouterr().err


@pytest.mark.long
def test_a_recipe_with_more_codes_refines_those_of_its_start(tmp_path: Path, finished: Finished) -> None:
    """The refined model is made once; a run that is started again goes on from it as it is."""
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
    """The tokenizer, decoder and all, is as it was; the transformer has its weights and goes on from there."""
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
        assert main(["train", "transformer", "--config", str(other), "--run", str(tmp_path / named), *options]) == 1
        assert f"{start}: key '{named}'" in capsys.readouterr().err
    save_model(start, load_model())
    assert main(["train", "--config", str(config), "--run", str(run)]) == 1
    assert "which the run began with" in capsys.readouterr().err
    assert main(["train", "tokenizer", "--config", str(config), "--run", str(run)]) == 2
    assert "whose tokenizer stays" in capsys.readouterr().err


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
    assert main(["train", "average", "--models", str(out), str(other), "--out", str(tmp_path / "no")]) == 1
    assert f"{other}: key 'transformer'" in capsys.readouterr().err
    elsewhere = ["train", "--config", str(first), "--seed", "6", "--run", str(tmp_path / "elsewhere")]
    assert main([*elsewhere, "--sample-every", "0"]) == 0
    made_elsewhere = tmp_path / "elsewhere" / "model.safetensors"
    assert main(["train", "average", "--models", str(out), str(made_elsewhere), "--out", str(tmp_path / "no")]) == 1
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
        assert main(["train", "transformer", "--config", str(other), "--run", str(tmp_path / named)]) == 1
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


@pytest.mark.parametrize("recipe", ["ablation", "compact_deterministic", "compact_lengths"])
def test_the_recipes_that_go_on_fit_the_shipped_model(tmp_path: Path, recipe: str) -> None:
    assert Stages(read_recipe(recipe), Run(tmp_path)).start is not None


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
@pytest.mark.parametrize("times", [1, pytest.param(6, marks=pytest.mark.soak)])
def test_a_killed_run_goes_on_with_the_same_weights(tmp_path: Path, times: int) -> None:
    """SIGKILL at a random moment, in the soak run again and again; then against a run that nobody cut."""
    config = small(tmp_path / "small.toml", steps=60)
    train = ["train", "tokenizer", "--config", str(config), "--sample-every", "0", "--run"]
    command = [sys.executable, "-m", "daemon.cli", *train, str(tmp_path / "cut")]
    state, rng, killed = tmp_path / "cut" / "tokenizer.pt", np.random.default_rng(), 0
    for _ in range(times):
        before = state.stat().st_mtime_ns if state.is_file() else 0
        process = subprocess.Popen(command, env=environment(), stdout=subprocess.DEVNULL)
        deadline = time.monotonic() + 60
        while process.poll() is None and not (state.is_file() and state.stat().st_mtime_ns != before):
            assert time.monotonic() < deadline, "it saves no state"
            time.sleep(0.005)
        time.sleep(rng.uniform(0, 0.1))
        process.kill()
        killed += process.wait() == -signal.SIGKILL
    assert killed
    assert main([*train, str(tmp_path / "cut")]) == 0
    assert main([*train, str(tmp_path / "whole")]) == 0
    cut, whole = (torch.load(tmp_path / r / "tokenizer.pt", weights_only=True) for r in ("cut", "whole"))
    assert cut["step"] == whole["step"] == 60
    for name, tensor in whole["module"].items():
        assert torch.equal(cut["module"][name], tensor), name
    assert all(torch.equal(a, b) for a, b in zip(cut["averages"], whole["averages"], strict=True))


@pytest.mark.soak  # three more processes that import PyTorch, for training on several machines
def test_two_processes_have_the_loss_of_one_with_the_whole_batch(tmp_path: Path) -> None:
    config = small(tmp_path / "small.toml", steps=41)
    options = ["train", "transformer", "--config", str(config), "--sample-every", "0", "--run-dir"]
    assert main([*options, str(tmp_path / "one")]) == 0
    launcher = [sys.executable, "-m", "torch.distributed.run", "--standalone", "--nproc-per-node", "2"]
    done = subprocess.run([*launcher, "-m", "daemon.cli", *options, str(tmp_path / "two")], env=environment(),
                          capture_output=True, text=True, timeout=100, check=False)  # fmt: skip
    assert done.returncode == 0, done.stderr[-2000:]
    for stage in ("tokenizer", "transformer"):
        one, two = losses(tmp_path / "one" / f"{stage}.csv"), losses(tmp_path / "two" / f"{stage}.csv")
        assert len(one) == len(two) == 3
        np.testing.assert_allclose(two[:, 0], one[:, 0], rtol=2e-3)
    np.testing.assert_allclose(two[0], one[0], rtol=1e-4, atol=1e-4)


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
    assert known_recipes() == ["ablation", "compact", "compact_deterministic", "compact_lengths", "paper", "small"]
    for name in known_recipes():
        read_recipe(name)
    assert main(["train", "--config", "nothing"]) == 2
    assert "ablation, compact, compact_deterministic, compact_lengths, paper" in capsys.readouterr().err


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
    assert main(["train", "--device", "cuda", "--run", str(tmp_path)]) == 1
    assert "no CUDA device" in capsys.readouterr().err


def test_data_without_a_clip_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    config = small(tmp_path / "small.toml", synthesised=0)
    assert main(["train", "--config", str(config), "--run", str(tmp_path / "run")]) == 1
    assert "no clip" in capsys.readouterr().err


class TestStateFiles:
    SCHEDULE = Schedule(steps=4, warmup_steps=1, save_every=2)

    @staticmethod
    def loss_of(model: torch.nn.Module, fill_disk_at: int | None = None) -> object:
        def loss_fn(step: int, generator: torch.Generator) -> dict[str, torch.Tensor]:
            if step == fill_disk_at:
                _, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
                resource.setrlimit(resource.RLIMIT_FSIZE, (2000, hard))
            return {"loss": model(torch.randn(4, 64, generator=generator)).square().mean()}

        return loss_fn

    def test_a_full_disk_leaves_the_older_state_whole(self, tmp_path: Path) -> None:
        """No file may grow beyond 2 kB, as on a full disk, from the third step on."""
        model = torch.nn.Linear(64, 64)
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        ignored = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        try:
            with pytest.raises(CheckpointError, match="earlier step is whole"):
                run_stage(model, self.loss_of(model, 2), self.SCHEDULE, Run(tmp_path), "m")  # type: ignore[arg-type]
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
            signal.signal(signal.SIGXFSZ, ignored)
        assert torch.load(tmp_path / "m.pt", weights_only=True)["step"] == 2
        assert [p.name for p in tmp_path.iterdir() if p.suffix == ".pt"] == ["m.pt"]

    def test_a_state_that_is_none_is_named(self, tmp_path: Path) -> None:
        (tmp_path / "m.pt").write_bytes(b"nothing")
        model = torch.nn.Linear(64, 64)
        with pytest.raises(CheckpointError, match="delete it to begin anew"):
            run_stage(model, self.loss_of(model), self.SCHEDULE, Run(tmp_path), "m")  # type: ignore[arg-type]
