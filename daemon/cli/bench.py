"""`mmmd bench`: the figures of the project, measured on this machine."""

from __future__ import annotations

import importlib
import json as json_module
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, cast

import tyro

BenchName = Literal[
    "all",
    "generate",
    "official",
    "story",
    "retarget",
    "first-motion",
    "barge-in",
    "seams",
    "estop",
    "audit",
    "bus",
    "stream",
]
_WITH_N: dict[str, int | None] = {
    "story": 59, "official": None, "retarget": None, "first-motion": 50, "barge-in": 1000, "seams": 60, "estop": 30, "audit": 200,
    "stream": 50,
}  # fmt: skip
"""Figures that take a number of texts, clips or trials, and their default number (None: all)."""

_WITH_ROBOT = ("audit",)
"""Figures that can be measured on robot files of one's own."""

_MUST_BE_NONE = ("violations", "self_contacts", "lost")
"""Figures that fail the bench unless they are zero."""


def bench(
    name: Annotated[BenchName, tyro.conf.Positional], json: bool = False, seed: int = 0, n: int | None = None,
    robot: tuple[str, ...] = (), out: Annotated[Path | None, tyro.conf.arg(metavar="DIR")] = None, only: tuple[str, ...] = (),
    quick: bool = False, measure: bool = True, markdown: Path | None = None,
) -> int:  # fmt: skip
    """Measure one figure and print it, or all of them into one report.

    all: every figure by the command that measures it, each in a process of its own, one JSON file for each in a folder (--out),
    and a report in Markdown: measured, to reach, met or by how much not. A run that was cut short goes on with what is missing;
    what another version, machine or command line measured is measured again. A command that fails or takes too long is reported,
    the rest goes on. It takes some hours; with --only or --quick less. docs/BENCHMARKS.md is such a report.

    generate: a whole 196-frame motion on one thread. official: the same with the released model's size and ten
    steps, and its ids at --n lengths (all 49 without it) beside those of the released sampler written plainly.
    story: ten minutes of motion from 59 texts on two threads. retarget: time of all its stages and direction error for
    each robot, bounds and contacts checked again. first-motion: text to first moving servo frame, warm, through the
    daemon. barge-in: overlapping commands and stops at random instants. seams: jerk and steps where motions meet, and
    closure of loops. estop: e-stop to torque-off bytes with busy cores; then, under floods, with processes frozen and
    killed, while starting, arming and parking, and after a torn port: e-stops lost, and request to torque off of all
    servos (--n of each; progress on stderr). audit: many texts through the daemon's bus side on every robot, also under
    faults, every goal checked against the limits. bus: codec and servo bus against a wire kept on a pty, beside other
    drivers where they are installed. stream: joint target of another program to first moved goal.

    Example: mmmd bench first-motion --json
    or, for a robot of your own: mmmd bench audit --robot my_robot --n 30

    Example: mmmd bench all --out out/figures --quick
    or: mmmd bench all --out out/figures --only first-motion bus

    Args:
        name: what to measure.
        json: print one JSON object instead of lines.
        seed: seed of the texts and of generation.
        n: number of texts, clips or trials, where the figure has any.
        robot: for audit: packaged robots, or paths of robot files or their folders; every packaged robot when not given.
        out: for all: folder of the figures; measurements already in it count.
        only: for all: names of what to measure.
        quick: for all: small numbers of texts and trials, which the report says.
        measure: for all: --no-measure makes only the report of what the folder has.
        markdown: for all: file of the report; report.md in the folder when not given.
    """
    from rich.console import Console

    from daemon.errors import CommandError

    if robot and name not in _WITH_ROBOT:
        raise CommandError(f"bench {name}: --robot is for {', '.join(_WITH_ROBOT)}")
    if name == "all":
        return _all(out, only, quick=quick, seed=seed, measure=measure, markdown=markdown, json=json)
    if out or only or quick or markdown or not measure:
        raise CommandError(
            f"bench {name}: --out, --only, --quick, --no-measure and --markdown are for `mmmd bench all`"
        )
    chosen = {"robots": robot} if name in _WITH_ROBOT else {}

    file = name.replace("-", "_")
    function: Callable[..., dict[str, Any]] = getattr(importlib.import_module(f"daemon.bench.{file}"), f"bench_{file}")
    figures = function(n or _WITH_N[name], seed=seed, **chosen) if name in _WITH_N else function(seed=seed)
    console = Console()
    if json:
        console.out(json_module.dumps(figures))
    else:
        for line in _lines(figures):
            console.print(line, soft_wrap=True)
    failed = any(figures.get(key) for key in _MUST_BE_NONE) or figures.get("tokens_identical") is False
    return 1 if failed else 0


def _lines(figures: Mapping[str, Any], indent: str = "") -> Iterator[str]:
    """Yield a line for each figure; figures of parts (a robot, a disturbance) are indented below the part's name."""
    for key, value in figures.items():
        head = f"{indent}[bold]{key}[/bold]:"
        if not isinstance(value, Mapping):
            yield f"{head} {value}"
            continue
        below = cast("Mapping[str, Any]", value)
        if any(isinstance(v, Mapping) for v in below.values()):
            yield head
            yield from _lines(below, indent + "    ")
        else:
            yield f"{head} {', '.join(f'{k} {v}' for k, v in below.items())}"


def _all(
    out: Path | None, only: tuple[str, ...], *, quick: bool, seed: int, measure: bool, markdown: Path | None, json: bool
) -> int:
    from daemon.bench.all_figures.run import bench_all
    from daemon.errors import CommandError

    if out is None:
        raise CommandError("bench all: --out is missing; example: mmmd bench all --out out/figures")
    found, good = bench_all(out, only, quick=quick, seed=seed, measure=measure, markdown=markdown)
    if json:
        sys.stdout.write(json_module.dumps(found) + "\n")
    return 0 if good else 1
