"""The report in Markdown: every figure with its mark, the machine, the runs and their methods, and other programs' figures."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from daemon.bench.all_figures.records import Record
from daemon.bench.all_figures.table import NOT_MEASURED, Column, Measurement, Row, rows_of, shown, typed, values_at

_HEAD = """\
Made by `mmmd bench all` from one JSON file for each run, never by hand; `mmmd bench all --help` says how to make one for
another machine. Machines that others use too are noisy: where they took a tenth of the processors or more, the line says so,
and its times and rates are no measure of what the code can do. What stands behind the figures, and what was tried:
model_history.md, evaluation.md, retargeting.md, bus.md, safety.md and decisions/."""
_QUICK = (
    "**Quick: runs marked so took small numbers of texts and trials. Their figures are no measurement of a release.**"
)
BUSY = 0.1
"""Share of the processors' time taken by other processes from which a figure's line mentions it."""


def report(table: Sequence[Measurement], records: Mapping[str, Record]) -> str:
    """The whole page.

    Args:
        table: all measurements.
        records: the records, by name.
    """
    known = {m.name: records[m.name] for m in table if m.name in records}
    lines = ["# Figures", "", _HEAD, "", _summary(table, known)]
    if any(r.quick for r in known.values()):
        lines += ["", _QUICK]
    lines += ["", *_figures(table, known), "", *_runs(table, known), "", *_not_measured(table, known)]
    lines += ["## How", "", *(f"- {m.name}: {m.how}" for m in table if m.how), ""]
    return "\n".join([*lines, *_peers(table, known)]).rstrip("\n") + "\n"


def judged(table: Sequence[Measurement], records: Mapping[str, Record]) -> list[tuple[Measurement, Row]]:
    """Every line of the report with its measurement."""
    return [(m, row) for m in table for row in rows_of(m, records[m.name].values if m.name in records else None)]


def _summary(table: Sequence[Measurement], records: Mapping[str, Record]) -> str:
    rows = [row for _, row in judged(table, records) if row.figure.has_mark]
    met, missed = (sum(row.is_met is wanted for row in rows) for wanted in (True, False))
    without = sum(row.shown == NOT_MEASURED for row in rows)
    return f"Of {len(rows)} marks {met} are met, {missed} are missed, {without} were not measured here."


def _figures(table: Sequence[Measurement], records: Mapping[str, Record]) -> list[str]:
    cells = list[tuple[str, ...]]()
    before = ""
    for measurement, row in judged(table, records):
        command = "" if measurement.name == before else _command(measurement, records.get(measurement.name))
        before = measurement.name
        verdict = row.verdict if row.is_met is not False else f"**{row.verdict}**"
        cells.append((row.figure.what, row.shown, row.to_reach, verdict, command))
    return _table(("figure", "measured", "to reach", "met", "command"), cells)


def _command(measurement: Measurement, record: Record | None) -> str:
    if measurement.without:
        return ""
    if record is None:
        return f"`{typed(measurement.words(0, quick=False))}`"
    busy = record.others_took is not None and record.others_took >= BUSY
    return f"`{record.command}`" + (f"; **others took {_share(record.others_took)}**" if busy else "")


def _runs(table: Sequence[Measurement], records: Mapping[str, Record]) -> list[str]:
    """A table of the runs: the time, the machine and the version of each."""
    cells = [
        (
            m.name + (" (quick)" if r.quick else ""), f"{r.seconds:,.0f} s", _share(r.others_took), _share(r.host_took),
            str((r.values or {}).get("n", "")) if not isinstance((r.values or {}).get("n"), dict) else "",
            str((r.values or {}).get("seed", "")), r.commit or r.version, r.date[:16].replace("T", " "),
        )
        for m in table if (r := records.get(m.name)) is not None
    ]  # fmt: skip
    lines = ["## Machine and runs", ""]
    lines += [
        f"- {machine}: {', '.join(names)}" for machine, names in _grouped((r.machine, r.name) for r in records.values())
    ]
    lines += [f"- {versions}" for versions, _ in _grouped((_versions(r), r.name) for r in records.values()) if versions]
    lines += [
        "",
        "Others and host: the share of the processors' time that other processes, and the host, took meanwhile.",
        "",
    ]
    head = ("run", "took", "others", "host", "n", "seed", "commit", "end, UTC")
    return [*lines, *_table(head, cells)] if cells else [*lines[:2], "Nothing was measured."]


def _grouped(pairs: Iterable[tuple[str, str]]) -> list[tuple[str, list[str]]]:
    groups = dict[str, list[str]]()
    for key, value in pairs:
        groups.setdefault(key, []).append(value)
    return list(groups.items())


def _versions(record: Record) -> str:
    versions: dict[str, str] = (record.values or {}).get("versions", {})
    return ", ".join(f"{name} {version}" for name, version in versions.items())


def _not_measured(table: Sequence[Measurement], records: Mapping[str, Record]) -> list[str]:
    lines = list[str]()
    for m in table:
        record = records.get(m.name)
        if m.without:
            lines.append(f"- {m.name}: {m.without}.")
        elif record is None:
            continue
        elif record.error:
            lines.append(f"- {m.name}: failed: {record.error}")
        elif record.status:
            lines.append(f"- {m.name}: ended with status {record.status}.")
    if not_run := [m.name for m in table if not m.without and m.name not in records]:
        lines.append(f"- Not run: {', '.join(not_run)}.")
    return ["## Not measured, or failed", "", *lines, ""] if lines else []


def _peers(table: Sequence[Measurement], records: Mapping[str, Record]) -> list[str]:
    lines = list[str]()
    for m in table:
        record = records.get(m.name)
        if m.peers is None or record is None or record.values is None:
            continue
        found: dict[str, Any] = record.values.get(m.peers.key, {})
        beside = {name: values for name, values in found.items() if not isinstance(values, str | int)}
        ours = ["mmmd", *(_cell(record.values, c, c.ours) for c in m.peers.columns)]
        cells = [tuple(ours)] if any(c.ours for c in m.peers.columns) else []
        cells += [(name, *(_cell(values, c, c.key) for c in m.peers.columns)) for name, values in beside.items()]
        missing = [name for name in m.peers.expected if not any(one.startswith(name) for one in beside)]
        lines += [f"## Beside others: {m.name}", ""]
        lines += _table(("", *(f"{c.title}, {c.unit}" for c in m.peers.columns)), cells) if cells else []
        lines += [f"Not installed: {', '.join(missing)} (`pip install '.[bench]'`)."] if missing else []
        lines += [""]
    return lines


def _cell(values: Any, column: Column, path: Any) -> str:
    found = [value for _, value in values_at(values, path)] if path else []
    return shown(found[0], column.unit) if found else ""


def _share(share: float | None) -> str:
    return "" if share is None else f"{100 * share:.0f} %"


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    return [
        f"| {' | '.join(head)} |",
        "|" + "---|" * len(head),
        *(f"| {' | '.join(cell.replace('|', '/') for cell in row)} |" for row in rows),
    ]
