"""`mmmd eval`: how well the model does what it is told, and how near it comes to real motion."""

from __future__ import annotations

import json as json_module
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import tyro

from daemon.errors import CommandError

if TYPE_CHECKING:
    from mmm_core.evaluation.protocol import Reader
    from mmm_core.motion import Motion

PROBE_ROBOTS = ("reference", "op3")
EvalName = Literal["probes", "real", "paper"]


def eval(
    name: Annotated[EvalName, tyro.conf.Positional],
    json: bool = False,
    seeds: int = 5,
    repeats: int = 20,
    data: Annotated[Path | None, tyro.conf.arg(metavar="DIR")] = None,
    split: tuple[Literal["train", "val", "test"], ...] = (),
    model: tuple[Path, ...] = (),
    evaluator: Path | None = None,
    glove: Path | None = None,
    evaluator_mean: Path | None = None,
    evaluator_std: Path | None = None,
) -> int:
    """Measure the model.

    probes: side, limb, count (within one) and direction of motions for commands in words it was not trained on, as
    generated and as two robots' paths show them.

    real: against held-out motion of people with the evaluator of this repository: R-precision of generated against real,
    FID of generated against the tokenizer's own. --data is the folder of docs/DATA.md.

    paper: the tables of the paper's section 5 for the data and checkpoints given: 1 or 2 comparison, 3 speed, 4 editing in
    time, 5 upper body, 6 ablations (over steps, and over several --model).

    Example: mmmd eval probes --json

    Example: mmmd eval real --data ../shared/data --json

    Example: mmmd eval paper --data HumanML3D --model official.safetensors --evaluator finest.tar --glove glove
    --evaluator-mean meta/mean.npy --evaluator-std meta/std.npy

    Args:
        name: what to evaluate.
        json: print one JSON object instead of lines.
        seeds: motions for each probe.
        repeats: of the whole measurement, for 95 % intervals.
        data: data folder (real, paper).
        split: splits to take; val and test of a clips.jsonl folder, else test.
        model: checkpoint; the shipped one when it is not given; several for table 6.
        evaluator: an evaluator of `mmmd train evaluator`, or the published finest.tar; ours when it is not given.
        glove: folder of the published word vectors, with finest.tar.
        evaluator_mean: statistics finest.tar was trained with.
        evaluator_std: the same.
    """
    from rich.console import Console

    from daemon.bench.report import context

    first = model[0] if model else None
    if name == "probes":
        figures, shown = _probes(first, seeds)
    else:
        if data is None:
            raise CommandError(f"eval {name}: --data is missing; example: mmmd eval {name} --data ../shared/data")
        if not 1 <= repeats <= 1000:
            raise CommandError(f"eval {name}: --repeats {repeats}; allowed: 1 to 1000")
        splits = split or (("val", "test") if (data / "clips.jsonl").is_file() else ("test",))
        reader = _reader(evaluator, glove, evaluator_mean, evaluator_std)
        figures = (
            _real(reader, data, splits, first, repeats)
            if name == "real"
            else _paper(reader, data, splits, model, repeats)
        )
        figures |= context(0, f"{repeats} repeats, splits {', '.join(splits)}, lengths of the real motions")
        shown = figures
    console = Console()
    if json:
        console.out(json_module.dumps(figures))
    elif name == "paper":
        _print_tables(console, figures["tables"])
        console.print(f"n {figures['n']} pairs; {figures['caveat']}", highlight=False)
    else:
        for key, value in shown.items():
            console.print(f"{key}: {value}", highlight=False)
    return 0


def _probes(model: Path | None, seeds: int) -> tuple[dict[str, Any], dict[str, Any]]:
    """Every probe generated once for each seed; the same motions are then checked on each robot."""
    from rich.console import Console
    from rich.progress import Progress

    from daemon.bench.report import context
    from mmm_core.corpus.heldout import PROBES
    from mmm_core.engine import Engine
    from mmm_core.evaluation.probes import evaluate
    from retarget.as_human import shown_on_a_person
    from retarget.pipeline import Retargeter
    from retarget.robot import load_robot

    engine = Engine.load(model)
    motions: dict[tuple[str, int], Motion] = {}

    def generated(text: str, seed: int) -> Motion:
        motions[text, seed] = engine.generate(text, seed=seed).motion
        return motions[text, seed]

    figures: dict[str, Any] = {}
    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("generated", total=len(PROBES) * seeds)
        figures["generated"] = evaluate(generated, range(seeds), lambda n: bar.update(task, completed=n))
        for name in PROBE_ROBOTS:
            retargeter = Retargeter(load_robot(name))

            def on_robot(text: str, seed: int, retargeter: Retargeter = retargeter) -> Motion:
                return shown_on_a_person(retargeter, motions[text, seed])

            bar.reset(task, description=name, total=len(PROBES) * seeds)
            found = evaluate(on_robot, range(seeds), lambda n: bar.update(task, completed=n))
            figures.setdefault("retargeted", {})[name] = found
    method = (
        "held-out probes (mmm_core/corpus/heldout.py), kinematic checks on generated joints, and on the joints that a robot's "
        "path shows (retarget/as_human.py); refused counts as wrong"
    )
    figures |= {"n": figures["generated"]["n"], "checkpoint": engine.checkpoint_hash, **context(0, method)}
    return figures, {"generated": figures["generated"], **figures["retargeted"]}


def _reader(evaluator: Path | None, glove: Path | None, mean: Path | None, std: Path | None) -> Reader:
    """The evaluator to measure with."""
    import numpy as np
    import torch

    from mmm_core.checkpoint import EVALUATOR_FILE, load_text_encoder
    from mmm_core.evaluation.extractors import load_evaluator, load_published
    from mmm_core.evaluation.protocol import Reader
    from mmm_core.evaluation.words import read_vectors

    if glove is None:
        return Reader(load_evaluator(evaluator or EVALUATOR_FILE)[0], load_text_encoder())
    if evaluator is None or mean is None or std is None:
        raise CommandError("eval: --glove goes with --evaluator finest.tar, --evaluator-mean and --evaluator-std")
    statistics = [torch.tensor(np.load(p, allow_pickle=False)) for p in (mean, std)]
    return Reader(load_published(evaluator, *statistics, n_features=len(statistics[0])), read_vectors(glove))


def _real(reader: Reader, data: Path, splits: tuple[Any, ...], model: Path | None, repeats: int) -> dict[str, Any]:
    from mmm_core.engine import Engine
    from mmm_core.evaluation.paper import comparison
    from mmm_core.evaluation.protocol import read_pairs

    engine, pairs = Engine.load(model), read_pairs(data, splits)
    with _Bar("real") as progress:
        table = comparison(reader, engine, pairs, repeats, progress)
    lines = {name: {key: _number(value) for key, value in row.items()} for name, row in table.items()}
    made, real, again = lines["generated"], lines["real motion"], lines["tokenizer"]
    return {
        "r1_ratio": round(made["R1"] / real["R1"], 4) if real.get("R1") else None,
        "fid_ratio": round(made["FID"] / again["FID"], 4) if again["FID"] else None,
        "r_precision": {name: [row.get(f"R{k}") for k in (1, 2, 3)] for name, row in lines.items()},
        "fid": {name: row["FID"] for name, row in lines.items()},
        "mm_dist": {name: row["MM-Dist"] for name, row in lines.items()},
        "diversity": {name: row["Diversity"] for name, row in lines.items()},
        "mmodality": made["MModality"],
        "n": len(pairs),
        "n_texts": len({p.text for p in pairs}),
        "caveat": _caveat(len(pairs), reader),
        "checkpoint": engine.checkpoint_hash,
    }


def _paper(
    reader: Reader, data: Path, splits: tuple[Any, ...], models: tuple[Path, ...], repeats: int
) -> dict[str, Any]:
    from mmm_core.engine import Engine
    from mmm_core.evaluation import paper
    from mmm_core.evaluation.protocol import read_pairs

    engines = {path.name: Engine.load(path) for path in models} or {"shipped": Engine.load()}
    engine, pairs = next(iter(engines.values())), read_pairs(data, splits)
    comparison = "2 (comparison, KIT-ML)" if pairs[0].features.shape[1] == 251 else "1 (comparison)"
    makers: dict[str, Callable[[_Bar], Any]] = {
        comparison: lambda bar: paper.comparison(reader, engine, pairs, repeats, bar),
        "3 (speed)": lambda bar: paper.speed(reader, engine, pairs, min(repeats, 3), bar),
        "4 (editing in time)": lambda bar: paper.editing_in_time(reader, engine, pairs, repeats, bar),
        "5 (editing the upper body)": lambda bar: paper.editing_the_upper_body(reader, engine, pairs, repeats, bar),
        "6 (ablations)": lambda bar: paper.ablations(reader, engines, pairs, min(repeats, 5), bar),
    }
    tables: dict[str, Any] = {}
    for title, make in makers.items():
        with _Bar(f"table {title}") as progress:
            table = make(progress)
        tables[title] = {name: {k: _both(v) for k, v in row.items()} for name, row in table.items()}
    return {"tables": tables, "n": len(pairs), "caveat": _caveat(len(pairs), reader)}


class _Bar:
    """A line on stderr that says how far a table is."""

    def __init__(self, title: str) -> None:
        from rich.console import Console

        self._status = Console(stderr=True).status(title)
        self._title = title

    def __enter__(self) -> _Bar:
        self._status.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._status.stop()

    def __call__(self, text: str) -> None:
        self._status.update(f"{self._title} {text}")


def _number(value: Any) -> float:
    return round(float(getattr(value, "mean", value)), 4)


def _both(value: Any) -> Any:
    """A mean with its half width, or a plain number."""
    if hasattr(value, "half_width"):
        return [round(value.mean, 4), round(value.half_width, 4)]
    return round(float(value), 4)


def _caveat(n: int, reader: Reader) -> str:
    width = reader.evaluator.config.embedding
    small = f"{n} pairs are few for FID in {width} dimensions" if n < 10 * width else "enough pairs for FID"
    return f"{small}; the literature measures 4,400 (HumanML3D)"


def _print_tables(console: Any, tables: dict[str, Any]) -> None:
    from rich.table import Table

    for title, lines in tables.items():
        shown = Table(title=f"Table {title}", title_justify="left")
        columns = sorted({key for row in lines.values() for key in row})
        for column in ("", *columns):
            shown.add_column(column)
        for name, row in lines.items():
            cells = [row.get(c, "") for c in columns]
            shown.add_row(name, *(f"{c[0]:.3f}±{c[1]:.3f}" if isinstance(c, list) else str(c) for c in cells))
        console.print(shown if lines else f"Table {title}: nothing to show, the model has no body parts")
