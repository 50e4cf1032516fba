"""Figures of `mmmd eval` that compare motions with real ones of a data folder, as the paper's tables do."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daemon.errors import CommandError

if TYPE_CHECKING:
    pass

MOST_REPEATS = 1000


@dataclass(frozen=True)
class _Asked:
    """The size of a measurement."""

    repeats: int
    each: int
    tables: tuple[int, ...]
    temperature: float | None


def checked(name: str, repeats: int, each: int, tables: tuple[int, ...], temperature: float | None) -> _Asked:
    """The size of a measurement from the flags, checked."""
    if not 1 <= repeats <= MOST_REPEATS:
        raise CommandError(f"eval {name}: --repeats {repeats}; allowed: 1 to {MOST_REPEATS}")
    if not 2 <= each <= MOST_REPEATS:
        raise CommandError(f"eval {name}: --motions-per-text {each}; allowed: 2 to {MOST_REPEATS}")
    if not set(tables) <= {1, 2, 3, 4, 5, 6}:
        raise CommandError(f"eval {name}: --tables {' '.join(map(str, tables))}; allowed: 1 to 6")
    if temperature is not None and not 0 <= temperature <= 10:
        raise CommandError(f"eval {name}: --temperature {temperature}; allowed: 0 to 10")
    return _Asked(repeats, each, tables, temperature)


def data_folder(name: str, data: Path | None) -> Path:
    """The folder given by `--data`, which `real` and `paper` need."""
    if data is None:
        raise CommandError(f"eval {name}: --data is missing; example: mmmd eval {name} --data ../shared/data")
    return data


def measured(
    name: str,
    data: Path,
    split: Sequence[Any],
    models: Sequence[Path],
    evaluator: tuple[Path | None, Path | None, Path | None, Path | None],
    asked: _Asked,
) -> dict[str, Any]:
    """Figures of a model beside real motions."""
    from daemon.bench.report import context
    from mmm_core.evaluation import paper, report
    from mmm_core.generate.engine import Engine

    if evaluator[1] is not None and None in evaluator:
        raise CommandError("eval: --glove goes with --evaluator finest.tar, --evaluator-mean and --evaluator-std")
    splits = split or report.default_splits(data)
    reader, evaluator_hash = report.load_reader(*evaluator)
    loaded: dict[str, Engine] = {str(path): Engine.load(path) for path in models} or {"shipped": Engine.load()}
    engines = {key: paper.for_evaluation(engine, asked.temperature) for key, engine in loaded.items()}
    engine = next(iter(engines.values()))
    pairs = report.measured_pairs(reader, list(engines.values()), data, splits)
    with _Bar() as bar:
        if name == "real":
            figures = report.real_figures(reader, engine, pairs, asked.repeats, asked.each, bar.titled("real"))
        else:
            figures = report.paper_figures(
                reader, engines, pairs, asked.repeats, asked.each, asked.tables, bar.titled
            )  # fmt: skip
    method = (
        f"{asked.repeats} repeats, splits {', '.join(splits)}, one caption of each motion a repeat, lengths of the real "
        f"motions, temperature {engine.settings.temperature}, {asked.each} motions a text for MModality; docs/evaluation.md"
    )
    return {
        **figures, "splits": list(splits), "checkpoint": engine.checkpoint_hash, "evaluator": evaluator_hash,
        **context(0, method),
    }  # fmt: skip


class _Bar:
    """A line on stderr with the progress of a table."""

    def __init__(self) -> None:
        from rich.console import Console

        self._status = Console(stderr=True).status("reading")

    def __enter__(self) -> _Bar:
        self._status.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._status.stop()

    def titled(self, title: str) -> Callable[[str], None]:
        """A function that takes the progress as text."""
        return lambda text: self._status.update(f"{title}, repeat {text}")


def print_tables(console: Any, tables: dict[str, Any]) -> None:
    """Print the paper's tables."""
    from rich.table import Table

    from mmm_core.evaluation.report import COLUMNS

    for title, lines in tables.items():
        found = {key for row in lines.values() for key in row}
        columns = [c for c in COLUMNS if c in found] + sorted(found - set(COLUMNS))
        shown = Table("", *columns, title=f"Table {title}", title_justify="left")
        for name, row in lines.items():
            cells = [row.get(c, "") for c in columns]
            shown.add_row(name, *(f"{c[0]:.3f}±{c[1]:.3f}" if isinstance(c, list) else str(c) for c in cells))
        console.print(shown if lines else f"Table {title}: nothing to show, the model has no body parts")
