"""The report of `mmmd bench all`: values judged by their marks, and the table of what is measured."""

from __future__ import annotations

import functools
import json
import textwrap
from pathlib import Path

import msgspec
import pytest
import tyro

from daemon.bench.all_figures.markdown import report
from daemon.bench.all_figures.records import Record
from daemon.bench.all_figures.table import NOT_MEASURED, Figure, Measurement, read_table, rows_of
from daemon.cli import bench as bench_command
from daemon.cli import main
from daemon.cli.offline import eval as eval_command


def record(name: str, **values: object) -> Record:
    return Record(
        name=name, command=f"mmmd bench {name} --json", version="0.1.0", commit="abc", code="c0de", machine="a machine",
        date="2026-01-02T03:04:05+00:00", seconds=12.0, others_took=0.25, host_took=0.0, values=values,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("figure", "values", "shown", "to_reach", "verdict", "met"),
    [
        (Figure("a", (("ms",),), "ms", at_most=50), {"ms": 50}, "50 ms", "≤ 50 ms", "yes", True),
        (Figure("a", (("ms",),), "ms", at_most=50), {"ms": 52.5}, "52.5 ms", "≤ 50 ms", "no: 5.0 % over", False),
        (Figure("a", (("p",),), "%", at_least=0.95), {"p": 0.931}, "93.1 %", "≥ 95 %", "no: 1.9 points short", False),
        (Figure("a", (("hz",),), "Hz", at_least=20), {"hz": 15}, "15 Hz", "≥ 20 Hz", "no: 25 % short", False),
        (Figure("a", (("lost",),), at_most=0), {"lost": 3}, "3", "0", "no: 3", False),
        (Figure("a", (("same",),), is_true=True), {"same": False}, "no", "yes", "no", False),
        (Figure("a", (("p",), ("q",)), "%", at_least=0.9), {"p": 0.95, "q": 0.8}, "95 / 80 %", "≥ 90 %",
         "no: 10.0 points short", False),
        (Figure("a", (("p",), ("q",)), "%", at_least=0.9), {"p": 0.95}, NOT_MEASURED, "≥ 90 %", "", None),
        (Figure("a", (("p",), ("q",)), "s"), {"p": 0.95}, "0.950 s", "", "", None),
        (Figure("a", ((("x", "y"), "ms"),), "ms", at_most=9), {"x": {"ms": 1}, "y": {"ms": 12}, "z": {"ms": 99}},
         "12 ms (y)", "≤ 9 ms", "no: 33 % over", False),
        (Figure("a", (("*", "ms"),), "ms", at_most=9), {"x": {"ms": None}, "n": 4}, NOT_MEASURED, "≤ 9 ms", "", None),
    ],
)  # fmt: skip
def test_values_are_judged(
    figure: Figure, values: dict, shown: str, to_reach: str, verdict: str, met: bool | None
) -> None:
    (row,) = rows_of(Measurement("one", (figure,)), values)
    assert (row.shown, row.to_reach, row.verdict, row.is_met) == (shown, to_reach, verdict, met)


def test_of_two_marks_either_is_enough() -> None:
    figures = (Figure("a", (("a",),), at_most=1, either="x"), Figure("b", (("b",),), at_most=1, either="x"))
    one = Measurement("one", figures)
    assert [r.is_met for r in rows_of(one, {"a": 2, "b": 1})] == [None, True]
    assert [r.is_met for r in rows_of(one, {"a": 2, "b": 2})] == [False, False]


def test_the_report_of_given_files() -> None:
    """Every part of the page, for the packaged table."""
    values = {"p50_ms": 41.0, "p95_ms": 95.0, "n": 50, "seed": 3, "versions": {"mmmd": "0.1.0"},
              "during": {"p50_ms": 50, "p95_ms": 100}, "idle": {"p50_ms": 61.5, "p95_ms": 100}}  # fmt: skip
    bus = {"codec_us": 13.4, "peers": {"rustypot": {"1000000": {"share": 0.5, "cpu_us": 263}}}}
    still = msgspec.structs.replace(record("bus", **bus), others_took=0.02)
    slow = msgspec.structs.replace(record("official"), values=None, error="ended after 1800 s", status=None)
    page = report(read_table(), {"first-motion": record("first-motion", **values), "bus": still, "official": slow})
    assert [line for line in page.splitlines() if line.startswith("#")] == [
        "# Figures", "## Machine and runs", "## Not measured, or failed", "## How", "## Beside others: bus",
    ]  # fmt: skip
    for line in textwrap.dedent("""\
        | figure | measured | to reach | met | command |
        | text to first moving servo frame from rest, p95 | 95 ms | ≤ 90 ms | **no: 5.6 % over** |  |
        | text to first moving servo frame out of idle movements, p50 | 61.5 ms | ≤ 60 ms | **no: 2.5 % over** |  |
        | codec: goals built, 20 answers parsed and stored | 13.40 us | ≤ 20 us | yes | `mmmd bench bus --json` |
        | first motion while the page is open, against without | not measured here | ≤ 1.05 |  | `python -m docs.tools.page_open` |
        - a machine: first-motion, official, bus
        - mmmd 0.1.0
        | run | took | others | host | n | seed | commit | end, UTC |
        | first-motion | 12 s | 25 % | 0 % | 50 | 3 | abc | 2026-01-02 03:04 |
        - official: failed: ended after 1800 s
        | mmmd | 13.40 |  |  |  |  |
        | rustypot |  | 50 | 263 |  |  |
        Not installed: dynamixel-sdk (`pip install '.[bench]'`).""").splitlines():
        assert line in page.splitlines(), line
    first = next(line for line in page.splitlines() if "from rest, p50 |" in line)
    assert first.endswith("| 41 ms | ≤ 50 ms | yes | `mmmd bench first-motion --json`; **others took 25 %** |")
    assert len(page.splitlines()) < 150


@pytest.mark.parametrize("measurement", read_table(), ids=lambda m: m.name)
def test_commands_of_the_table_exist_and_marks_have_a_source(measurement: Measurement) -> None:
    assert bool(measurement.command) != bool(measurement.without) and measurement.figures
    assert all(f.source for f in measurement.figures if f.has_mark)
    for quick in (False, True) if measurement.command[:1] == ("mmmd",) else ():
        _, name, *words = measurement.words(3, quick=quick)
        real = {"bench": bench_command.bench, "eval": eval_command.eval}[name]

        @functools.wraps(real)
        def read(*_args: object, **_kwargs: object) -> int:
            return 0

        assert tyro.cli(read, args=words) == 0


@pytest.mark.long
@pytest.mark.timeout(240)
@pytest.mark.parametrize(
    ("name", "key"),
    [("story", "total_s"), pytest.param("generate", "motion_ms", marks=pytest.mark.soak)],
)
def test_a_figure_is_measured_quickly(name: str, key: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The real command, in a process of its own."""
    words = ["bench", "all", "--out", str(tmp_path), "--only", name, "--quick", "--json"]
    assert main(words) == 0
    found = json.loads(capsys.readouterr().out)
    assert found[name][key] > 0 and (name != "story" or found[name]["scenes"] == 4)
    assert {run["status"] for run in found["runs"].values()} == {0}
    page = (tmp_path / "report.md").read_text("utf-8")
    figure = {"story": "ten minutes of story", "generate": "whole 196-frame motion from text, one thread"}[name]
    assert ("**Quick:" in page) == (name == "story"), "generate has no quicker way"
    assert f"{figure} |" in page and f"{figure} | {NOT_MEASURED}" not in page
    assert main(words[:-1]) == 0
    assert "there already" in capsys.readouterr().err
