"""`mmmd train`: make the shipped model again, or one on your own data."""

from __future__ import annotations

import logging
import os
from pathlib import Path
from typing import Annotated

import tyro


def train(
    data: Annotated[Path | None, tyro.conf.arg(metavar="DIR")] = None,
    run: Path = Path("runs/compact"),
    out: Path = Path("runs/compact/model.safetensors"),
    clips: int = 14_000,
    tokenizer_steps: int = 2600,
    transformer_steps: int = 6200,
    length_steps: int = 2500,
    threads: int = 1,
    seed: int = 0,
) -> int:
    """Train the compact model: corpus, tokenizer, length predictor, transformer, checkpoint.

    An interrupted run goes on where it was: give the same --run. About two hours on one CPU core with the defaults.
    Start it with OMP_WAIT_POLICY=passive when the machine does other work as well.

    Example: mmmd train --data ../shared/data --run runs/compact --out model.safetensors

    Args:
        data: folder with clips.jsonl and motions_*.npz (docs/DATA.md); without it only synthesised gestures are used.
        run: folder of the run: corpus, states, CSV logs.
        out: the checkpoint to write.
        clips: number of synthesised motions.
        tokenizer_steps: steps of the tokenizer, 0.2 s each on one core.
        transformer_steps: steps of the transformer, 0.5 s each on one core.
        length_steps: steps of the length predictor.
        threads: CPU threads.
        seed: of the corpus and of every stage.
    """
    import dataclasses

    import torch

    from mmm_core.training.compact import Recipe, make_model

    logging.basicConfig(level=logging.INFO, format="%(message)s")
    os.environ.setdefault("OMP_WAIT_POLICY", "passive")
    torch.set_num_threads(threads)
    plain = Recipe()
    recipe = Recipe(
        n_synthesised=clips,
        tokenizer=dataclasses.replace(plain.tokenizer, steps=tokenizer_steps, seed=seed),
        transformer=dataclasses.replace(plain.transformer, steps=transformer_steps, seed=seed),
        length=dataclasses.replace(plain.length, steps=length_steps, seed=seed),
        seed=seed,
    )
    make_model(recipe, data, run, out)
    return 0
