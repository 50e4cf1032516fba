"""`mmmd eval`: how well the model does what it is told."""

from __future__ import annotations

import json as json_module
from pathlib import Path
from typing import Annotated, Literal

import tyro


def eval(
    name: Annotated[Literal["probes"], tyro.conf.Positional],
    json: bool = False,
    seeds: int = 5,
    model: Path | None = None,
) -> int:
    """Measure the model on commands in words it was not trained on.

    probes: side, limb, count (within one) and direction of generated motions, checked on joints and head.

    Example: mmmd eval probes --json

    Args:
        name: what to evaluate.
        json: print one JSON object instead of lines.
        seeds: motions for each probe.
        model: checkpoint; the shipped one when it is not given.
    """
    from rich.console import Console
    from rich.progress import Progress

    from daemon.bench.report import context
    from mmm_core.corpus.heldout import PROBES
    from mmm_core.engine import Engine
    from mmm_core.evaluation.probes import evaluate

    engine = Engine.load(model)
    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(name, total=len(PROBES) * seeds)
        generated = evaluate(
            lambda text, seed: engine.generate(text, seed=seed).motion,
            range(seeds),
            lambda n: bar.update(task, completed=n),
        )
    method = (
        "held-out probes (mmm_core/corpus/heldout.py), kinematic checks on generated joints; refused counts as wrong"
    )
    figures = {"generated": generated, "n": generated["n"], "checkpoint": engine.checkpoint_hash, **context(0, method)}
    console = Console()
    if json:
        console.out(json_module.dumps(figures))
    else:
        for key, value in generated.items():
            console.print(f"{key}: {value}", highlight=False)
    return 0
