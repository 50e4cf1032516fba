"""`mmmd bench`: the figures of the project, measured on this machine."""

from __future__ import annotations

import json as json_module
from typing import Annotated, Literal

import tyro

BenchName = Literal["generate", "official", "story", "first-motion", "retarget", "audit"]


def bench(
    name: Annotated[BenchName, tyro.conf.Positional], json: bool = False, seed: int = 0, n: int | None = None
) -> int:
    """Measure one figure and print it.

    generate: a whole 196-frame motion on one thread. official: the same with the released model's size and ten steps.
    story: ten minutes of motion from 59 texts on two threads. first-motion: text to first moving servo frame, warm, through
    the daemon. retarget: time of all its stages and direction error per robot, bounds and contacts checked again. audit:
    many texts through the daemon's bus side on two robots, every goal checked against the limits.

    Example: mmmd bench first-motion --json

    Args:
        name: what to measure.
        json: print one JSON object instead of lines.
        seed: seed of the texts and of generation.
        n: number of texts or clips, where the figure has any.
    """
    from rich.console import Console

    if name == "generate":
        from daemon.bench.generate import bench_generate

        figures = bench_generate(seed)
    elif name == "official":
        from daemon.bench.official import bench_official

        figures = bench_official(seed)
    elif name == "story":
        from daemon.bench.story import N_SCENES, bench_story

        figures = bench_story(n or N_SCENES, seed)
    elif name == "first-motion":
        from daemon.bench.first_motion import bench_first_motion

        figures = bench_first_motion(n or 50, seed)
    elif name == "retarget":
        from daemon.bench.retarget import bench_retarget

        figures = bench_retarget(n, seed)
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
