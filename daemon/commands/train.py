"""`mmmd train`: make the shipped model again, or one on your own data."""

from __future__ import annotations

import logging
import os
import sys
from pathlib import Path
from typing import Annotated, Literal

import tyro

from daemon.errors import CommandError

Stage = Literal["all", "tokenizer", "transformer", "length", "evaluator", "scope"]


def train(
    stage: Annotated[Stage, tyro.conf.Positional] = "all",
    config: str = "compact",
    data: Annotated[Path | None, tyro.conf.arg(metavar="DIR")] = None,
    run_dir: Annotated[Path | None, tyro.conf.arg(aliases=["--run"])] = None,
    out: Path | None = None,
    device: str = "cpu",
    precision: Literal["fp32", "bf16"] = "fp32",
    threads: int = 1,
    sample_every: int = 500,
    tensorboard: bool = False,
) -> int:
    """Train a model, or one stage of it with what it needs, from one TOML recipe.

    An interrupted run, even a killed one, goes on where it was with the same result: give the same --run. Recipes that
    ship: compact (the model in this package, about four hours on two CPU cores), compact_go_on (that model and more words,
    an hour on a core that multiplies bf16) and paper (MMM as published; a GPU and HumanML3D). Several GPUs or machines:
    start it with torchrun. OMP_WAIT_POLICY=passive helps on a busy machine.

    Example: mmmd train --data ../shared/data --run runs/compact --out model.safetensors

    Example, the paper's tokenizer: mmmd train tokenizer --config paper --data HumanML3D --device cuda --precision bf16

    Example, from the shipped model on: mmmd train --config compact_go_on --data DIR --precision bf16 --out more.safetensors

    Example, only the scope of a finished run anew: mmmd train scope --run runs/compact --out model.safetensors

    Example, two processes: torchrun --nproc-per-node 2 -m daemon.cli train --config my.toml --run-dir runs/my

    Args:
        stage: all of them and a checkpoint, or one; scope builds what refusals rest on again for the run's checkpoint.
        config: name of a recipe that ships, or a TOML file (docs/training.md).
        data: folder with clips.jsonl, or a HumanML3D or KIT-ML folder; stands for the recipe's data.folder.
        run_dir: folder of the run: corpus, states, CSV logs, samples; runs/NAME when it is not given.
        out: checkpoint to write after all stages; model.safetensors in the run's folder when it is not given.
        device: cpu, cuda or cuda:N.
        precision: of matrix products.
        threads: CPU threads.
        sample_every: steps between pictures in the run's samples/; 0 for none.
        tensorboard: write TensorBoard events as well (extra `train`).
    """
    os.environ.setdefault("OMP_WAIT_POLICY", "passive")
    import torch

    from mmm_core import distributed
    from mmm_core.training.recipe import read_recipe
    from mmm_core.training.run import Run
    from mmm_core.training.stages import Stages, make_model, renew_scope

    logging.basicConfig(level=logging.INFO, format="%(message)s")
    torch.set_num_threads(threads)
    recipe = read_recipe(config)
    if stage == "tokenizer" and recipe.start:
        raise CommandError(
            f"train tokenizer: {config} goes on from {recipe.start}, whose tokenizer stays; train another stage"
        )
    folder = run_dir or Path("runs") / Path(config).stem
    where = Run(folder, device, precision, sample_every, tensorboard)
    distributed.start(where.torch_device)
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
