"""`mmmd train`: trains the shipped model anew, or a model on your own data."""

from __future__ import annotations

import logging
import os
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import tyro

from daemon.errors import CommandError

if TYPE_CHECKING:
    from mmm_core.training.recipe import Recipe
    from mmm_core.training.run import Run

Stage = Literal[
    "all",
    "tokenizer",
    "transformer",
    "length",
    "evaluator",
    "scope",
    "tagger",
    "gestures",
    "parser",
    "choice",
    "manner",
    "average",
    "ablation",
]


def train(
    stage: Annotated[Stage, tyro.conf.Positional] = "all",
    config: str = "",
    data: Annotated[Path | None, tyro.conf.arg(metavar="DIR")] = None,
    run_dir: Annotated[Path | None, tyro.conf.arg(aliases=["--run"])] = None,
    out: Path | None = None,
    seed: int | None = None,
    device: str = "cpu",
    precision: Literal["fp32", "bf16"] = "fp32",
    threads: int = 1,
    sample_every: int = 500,
    tensorboard: bool = False,
    variant: tuple[str, ...] = (),
    models: tuple[Path, ...] = (),
    yes: bool = False,
) -> int:
    """Train a model, or one stage of it with what it needs, from one TOML recipe.

    An interrupted run, even a killed one, goes on where it was with the same result: give the same --run (tagger, gestures,
    choice and manner begin anew). Recipes that
    ship: small (a small model from nothing in minutes, to try things with), compact (a model from nothing, about four hours
    on two CPU cores), compact_deterministic (the model in this package
    trained further, an hour and a half on one core), compact_lengths (its length predictor anew), people (a change of
    the shipped weights for captions of people, 46 minutes on one core) and paper (MMM as published;
    a GPU and HumanML3D). Several GPUs or machines: start it with torchrun. OMP_WAIT_POLICY=passive helps on a busy machine.

    Example: mmmd train --config small --run runs/small --out small.safetensors

    Example: mmmd train --data DIR --run runs/compact --out model.safetensors

    Example, the paper's tokenizer: mmmd train tokenizer --config paper --data HumanML3D --device cuda --precision bf16

    Example, from the shipped model on: mmmd train --config compact_deterministic --data DIR --out more.safetensors

    Example, weights for captions of people, to lie beside the shipped checkpoint: mmmd train --config people --data DIR
    --run runs/people --out mmm_compact_people.safetensors

    Example, only the scope of a finished run anew: mmmd train scope --run runs/compact --out model.safetensors

    Example, what divides a sentence into commands: mmmd train tagger --out tagger.safetensors

    Example, which gestures a whole sentence asks for: mmmd train parser --run runs/parser --out parser.safetensors

    Example, more sentences for the shipped parser: mmmd train parser --models mmm_core/weights/sentence_parser.safetensors
    --run runs/further --out parser.safetensors

    Example, what tells which gesture is meant: mmmd train gestures --out gestures.safetensors

    Example, what chooses among the ways to read a sentence: mmmd train choice --out choice.txt

    Example, which words ask for a tempo or a size: mmmd train manner --out manner_words.txt

    Example, the mean of models with one start: mmmd train average --models a.safetensors b.safetensors --out c.safetensors

    Example, one choice of the recipe changed at a time: mmmd train ablation --data DIR --precision bf16 --run runs/ablation

    Example, two processes: torchrun --nproc-per-node 2 -m daemon.cli train --config my.toml --run-dir runs/my

    Args:
        stage: all of them and a checkpoint, or one; scope builds what refusals rest on again for the run's checkpoint;
            tagger trains what divides sentences into commands, from the marked sentences that ship (50 minutes, no recipe);
            gestures trains what tells which gesture other words mean, from the phrases that ship (an hour, no recipe);
            parser trains what tells which gestures a sentence asks for, from the labelled sentences (an hour, no recipe), or
            one of --models further, on more of them;
            choice finds the weights with which one of the ways to read a sentence is chosen (eight minutes, no recipe);
            manner finds the weights of words that ask for a tempo or a size, and manner_choice.txt beside --out (a minute);
            average writes the mean of --models; ablation trains variants of a recipe and prints what the probes and real
            captions say of each.
        config: name of a recipe that ships, or a TOML file (docs/training.md); compact, or ablation for that stage.
        data: folder with clips.jsonl, or a HumanML3D or KIT-ML folder; stands for the recipe's data.folder.
        run_dir: folder of the run: corpus, states, CSV logs, samples; runs/NAME when it is not given.
        out: checkpoint to write after all stages; model.safetensors in the run's folder when it is not given.
        seed: of clips and draws, instead of the recipe's; another needs a run folder of its own.
        device: cpu, cuda or cuda:N.
        precision: of matrix products.
        threads: CPU threads.
        sample_every: steps between pictures in the run's samples/; 0 for none.
        tensorboard: write TensorBoard events as well (extra `train`).
        variant: names of variants (ablation); all when none is given.
        models: average takes the mean of two checkpoints or more; parser trains one parser further.
        yes: begin without a question. Only a person at a terminal is asked, and only before a run that is new.
    """
    os.environ.setdefault("OMP_WAIT_POLICY", "passive")
    import torch

    from mmm_core import distributed
    from mmm_core.training.make_model import make_model
    from mmm_core.training.recipe import read_recipe
    from mmm_core.training.run import Run
    from mmm_core.training.scope_training import renew_scope
    from mmm_core.training.stages import Stages

    logging.basicConfig(level=logging.INFO, format="%(message)s")
    torch.set_num_threads(threads)
    if variant and stage != "ablation":
        raise CommandError(f"train {stage}: --variant is for `mmmd train ablation`")
    most_models = {"average": len(models), "parser": 1}.get(stage, 0)
    if len(models) > most_models:
        raise CommandError(
            f"train {stage}: --models has {len(models)} files, {most_models} of which can be used; `mmmd train average` takes two "
            f"or more, `mmmd train parser` one that learns further"
        )
    if stage == "average":
        return _average(models, out)
    if stage in ("tagger", "gestures", "parser", "choice", "manner"):
        return _reader_part(stage, out, run_dir or Path("runs") / stage, models)
    config = config or ("ablation" if stage == "ablation" else "compact")
    recipe = read_recipe(config, seed)
    if stage == "tokenizer" and recipe.start and not recipe.tokenizer.rank:
        raise CommandError(
            f"train tokenizer: {config} goes on from {recipe.start}, whose tokenizer stays; train another stage"
        )
    folder = run_dir or Path("runs") / Path(config).stem
    if not yes and stage in _HOURS and not folder.exists() and not _agreed(stage, config, folder):
        return 1
    where = Run(folder, device, precision, sample_every, tensorboard)
    distributed.start(where.torch_device)
    if stage == "ablation":
        return _ablation(recipe, replace(where, sample_every=0), data, variant)
    if stage == "all":
        written = out or folder / "model.safetensors"
        make_model(recipe, where, data, written)
    elif stage == "scope":
        written = out or folder / "model.safetensors"
        if distributed.rank() == 0:
            renew_scope(recipe, folder / "model.safetensors", written)
    else:
        stages = Stages(recipe, where, data)
        getattr(stages, stage)
        written = folder / ("evaluator.safetensors" if stage == "evaluator" else f"{stage}.pt")
    if distributed.rank() == 0:
        sys.stdout.write(f"{written}\n")
    return 0


_HOURS = ("all", "tokenizer", "transformer", "evaluator", "ablation")
"""Stages that take hours."""


def _agreed(stage: str, config: str, folder: Path) -> bool:
    """Whether a person at a terminal agrees to the work; True where no one can be asked."""
    if not sys.stdin.isatty():
        return True
    how_long = "for minutes" if config == "small" else "for hours"
    sys.stdout.write(
        f"This trains ({stage}, recipe {config}) {how_long}, in {folder}; it can be interrupted. Go on? [y/N] "
    )
    sys.stdout.flush()
    return sys.stdin.readline().strip().lower() in ("y", "yes")


def _average(models: Sequence[Path], out: Path | None) -> int:
    """Write the mean of checkpoints."""
    from mmm_core.training.averaging import average_models

    if len(models) < 2 or out is None:
        raise CommandError("train average: --models A B ... --out F: two checkpoints or more, and where the mean goes")
    average_models(models, out)
    sys.stdout.write(f"{out}\n")
    return 0


def _reader_part(
    stage: Literal["tagger", "gestures", "parser", "choice", "manner"],
    out: Path | None,
    folder: Path,
    start: Sequence[Path],
) -> int:
    """Train and write a part of the reader: one of its networks, or weights of readings or of words of manner."""
    from mmm_core.training.choice_training import train_choice
    from mmm_core.training.gesture_training import train_classifier
    from mmm_core.training.manner_training import train_evidence, train_manner
    from mmm_core.training.parser_training import train_parser
    from mmm_core.training.tagger_training import train_tagger

    if out is None:
        raise CommandError(f"train {stage}: --out F: where the weights go; the shipped file is not overwritten unasked")
    if stage == "tagger":
        train_tagger(out)
    elif stage == "gestures":
        train_classifier(out)
    elif stage == "parser":
        train_parser(out, folder, start=start[0] if start else None)
    elif stage == "manner":
        n_texts, n_pieces = train_manner(out)
        n, n_manners, n_found = train_evidence(out.with_name("manner_choice.txt"))
        sys.stdout.write(
            f"{n_pieces} pieces of {n_texts} texts; {n} sentences, {n_manners} of them with a manner: {n_found} are read right "
            f"with weights that were found without their set\n"
        )
    else:
        n, n_possible, n_chosen = train_choice(out)
        sys.stdout.write(
            f"{n} sentences may be read in several ways, {n_possible} of them in a right one; "
            f"it is chosen in {n_chosen} with weights that were found without their set\n"
        )
    sys.stdout.write(f"{out}\n")
    return 0


def _ablation(recipe: Recipe, run: Run, data: Path | None, variants: Sequence[str]) -> int:
    """Train and measure variants; print their tables."""
    from mmm_core.training.ablation import TOKENIZERS, TRANSFORMERS, run_ablations, table

    folder = data or (Path(recipe.data.folder) if recipe.data.folder else None)
    if folder is None or not (folder / "clips.jsonl").is_file():
        raise CommandError(
            "train ablation: --data with clips.jsonl is needed: real captions are measured (docs/DATA.md)"
        )
    figures = run_ablations(recipe, run, folder, variants)
    tables = [table(figures, TRANSFORMERS), table(figures, TOKENIZERS)]
    sys.stdout.write("\n\n".join(t for t in tables if t) + "\n")
    return 0
