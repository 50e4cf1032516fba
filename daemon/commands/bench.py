"""`mmmd bench`: the figures of the project, measured on this machine."""

from __future__ import annotations

import json as json_module
from typing import Annotated, Literal

import tyro

BenchName = Literal["generate", "first-motion", "audit", "bus"]


def bench(
    name: Annotated[BenchName, tyro.conf.Positional], json: bool = False, seed: int = 0, n: int | None = None
) -> int:
    """Measure one figure and print it.

    generate: a whole 196-frame motion on one thread. first-motion: text to first moving servo frame, warm, through the
    daemon. audit: many texts through the daemon's bus side on two robots, every goal checked against the limits. bus:
    codec and servo bus against a wire kept on a pty, beside other drivers where they are installed.

    Example: mmmd bench first-motion --json

    Args:
        name: what to measure.
        json: print one JSON object instead of lines.
        seed: seed of the texts and of generation.
        n: number of texts, where the figure has any.
    """
    from rich.console import Console

    if name == "generate":
        from daemon.bench.generate import bench_generate

        figures = bench_generate(seed)
    elif name == "first-motion":
        from daemon.bench.first_motion import bench_first_motion

        figures = bench_first_motion(n or 50, seed)
    elif name == "bus":
        from daemon.bench.bus import bench_bus

        figures = bench_bus(seed=seed)
    else:
        from daemon.bench.audit import bench_audit

        figures = bench_audit(n or 200, seed)
    console = Console()
    if json:
        console.out(json_module.dumps(figures))
    else:
        for key, value in figures.items():
            console.print(f"[bold]{key}[/bold]: {value}")
    return 1 if figures.get("violations") else 0
