"""`mmmd bench all`: every figure by its own command in a fresh process, stored at once, and one report of all."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import msgspec
from rich.console import Console
from rich.markup import escape

from daemon.bench.all_figures.markdown import judged, report
from daemon.bench.all_figures.process import run_command
from daemon.bench.all_figures.records import ROOT, Here, Record, here, read_records, record_of, why_again, write_record
from daemon.bench.all_figures.table import RECORDINGS, TABLE, Measurement, chosen, read_table, typed
from daemon.bench.motions import recordings_folder
from daemon.bench.report import context

REPORT = "report.md"
_METHOD = "each figure by its own command in a fresh process; its method stands with it"
_WIDTH = 100
"""Characters of a command's last line that are shown while it runs."""


def bench_all(
    out: Path,
    only: Sequence[str] = (),
    *,
    quick: bool = False,
    seed: int = 0,
    measure: bool = True,
    markdown: Path | None = None,
    table_file: Path = TABLE,
) -> tuple[dict[str, Any], bool]:
    """Make the missing measurements of a folder, and write the report of all that it has.

    Args:
        out: folder of one JSON file for each measurement; files of this code and machine are not measured again.
        only: names of measurements to make; all when empty. The report has all that the folder has.
        quick: small numbers of texts and trials.
        seed: seed of the benches that take one.
        measure: False to make only the report, from the folder's files.
        markdown: path of the report; `out`/report.md when None.
        table_file: the table of figures.

    Returns:
        Every record's values under its name with the verdicts; whether every command of this call ended with status 0.

    Raises:
        CommandError: an unknown name in `only`, or a file of the folder that is no record.
    """
    table = read_table(table_file)
    wanted, console = chosen(table, only), Console(stderr=True, highlight=False)
    records, good = read_records(out, table), True
    if measure:
        for record in _measured(wanted, records, out, quick, seed, console):
            records[record.name] = record
            good = good and record.status == 0 and not record.error
    path = markdown or out / REPORT
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(report(table, records), "utf-8")
    console.print(f"report: {path}", markup=False, soft_wrap=True)
    return {**_as_json(table, records), **context(seed, _METHOD)}, good


def _measured(
    wanted: Sequence[Measurement], records: dict[str, Record], out: Path, quick: bool, seed: int, console: Console
) -> Iterator[Record]:
    """Make the missing records, one after another, each written at once."""
    given = {RECORDINGS: str(recordings_folder())}
    for i, m in enumerate(wanted):
        place = f"[{i + 1}/{len(wanted)}] {m.name}"
        if reason := m.without or _missing_need(m):
            console.print(f"{place}: not measured: {reason}", markup=False, soft_wrap=True)
            continue
        words = m.words(seed, quick=quick)
        command = typed(words)
        now = here()
        reason = why_again(records.get(m.name), command, now)
        if not reason:
            console.print(f"{place}: there already, {records[m.name].date}", markup=False, soft_wrap=True)
            continue
        console.print(f"{place}: {reason}; {command}, at most {m.limit_s:,.0f} s", markup=False, soft_wrap=True)
        yield _one(m, [given.get(word, word) for word in words], command, now, out, quick, console)


def _one(
    m: Measurement, words: Sequence[str], command: str, now: Here, out: Path, quick: bool, console: Console
) -> Record:
    with console.status(m.name) as status:
        outcome = run_command(words, m.limit_s, ROOT, lambda line: status.update(escape(f"{m.name}: {line[:_WIDTH]}")))
    record = record_of(m, command, outcome, now, datetime.now(UTC), quick=quick and m.quick is not None)
    write_record(out, record)
    others = "" if record.others_took is None else f", others took {100 * record.others_took:.0f} % of the processors"
    console.print(
        f"  {record.error or f'status {record.status}'} after {record.seconds:,.0f} s{others}",
        markup=False,
        soft_wrap=True,
    )
    return record


def _missing_need(m: Measurement) -> str:
    """The missing resource that a measurement needs; "" where it can be made here."""
    if m.needs == "recordings" and recordings_folder() is None:
        return "it needs the recordings of docs/DATA.md, in $MMMD_SHARED/data or in ../shared/data"
    if m.needs == "clone" and not (ROOT / "docs" / "tools").is_dir():
        return "it needs a clone"
    return ""


def _as_json(table: Sequence[Measurement], records: dict[str, Record]) -> dict[str, Any]:
    """Each command's JSON under its name, `runs` with the time and load of each, `figures` with marks and verdicts."""
    figures = [
        {"figure": row.figure.what, "measured": row.shown, "to_reach": row.to_reach, "met": row.is_met, "verdict": row.verdict,
         "source": row.figure.source, "run": m.name}
        for m, row in judged(table, records)
    ]  # fmt: skip
    runs = {name: {k: v for k, v in msgspec.to_builtins(r).items() if k != "values"} for name, r in records.items()}
    return {**{name: r.values for name, r in records.items()}, "runs": runs, "figures": figures}
