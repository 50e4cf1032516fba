"""`mmmd bench all`: what it measures again and what not, what it says of commands that fail, and the report that it writes."""

from __future__ import annotations

import functools
import json
import signal
import subprocess
import sys
import textwrap
import time
from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import msgspec
import pytest
import tyro

from daemon.bench.all_figures.markdown import report
from daemon.bench.all_figures.process import Outcome
from daemon.bench.all_figures.records import Record, here, read_records, record_of, why_again
from daemon.bench.all_figures.run import bench_all
from daemon.bench.all_figures.table import NOT_MEASURED, Figure, Measurement, read_table, rows_of
from daemon.cli import bench as bench_command
from daemon.cli import main
from daemon.cli.offline import eval as eval_command
from daemon.errors import CommandError

TABLE = """
[[measurement]]
name = "quick-one"
command = ["python", "{script}", "{folder}/quick-one", '{{"ms": 12.3456, "t": 1, "of": {{"a": {{"x": 1.1}}, "b": {{"x": 1.3}}}}}}']
options = ["--n", "50"]
quick = ["--n", "2"]
how = "A program that prints."
leave_out = ["t"]

[[measurement.figures]]
what = "time"
keys = [["ms"]]
unit = "ms"
at_most = 10
source = "a test"

[[measurement.figures]]
what = "worst robot"
keys = [["of", "*", "x"]]
at_most = 1.5
source = "a test"

[[measurement]]
name = "fails"
command = ["python", "-c", "import sys; sys.exit('no | servo')"]

[[measurement.figures]]
what = "never"
keys = [["share"]]
unit = "%"
at_least = 0.9
source = "a test"

[[measurement]]
name = "hangs"
command = ["python", "{script}", "{folder}/hangs", "hang"]
limit_s = 2

[[measurement.figures]]
what = "too late"
keys = [["share"]]
at_least = 0.9
source = "a test"

[[measurement]]
name = "last"
command = ["python", "{script}", "{folder}/last", '{{"lost": 0, "n": 4}}']

[[measurement.figures]]
what = "lost"
keys = [["lost"]]
at_most = 0
source = "a test"
"""
SCRIPT = """
import os, subprocess, sys, time
with open(sys.argv[1], "a") as calls:
    calls.write(" ".join(sys.argv[3:]) + "\\n")
if sys.argv[2] == "hang":
    hung = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
    with open(sys.argv[1] + ".pid", "w") as pid:
        pid.write(str(hung.pid))
    time.sleep(600)
print(sys.argv[2])
"""


@pytest.fixture
def table(tmp_path: Path) -> Path:
    (tmp_path / "program.py").write_text(SCRIPT)
    path = tmp_path / "figures.toml"
    path.write_text(TABLE.format(script=tmp_path / "program.py", folder=tmp_path))
    return path


def calls(folder: Path, name: str) -> list[str]:
    return (folder / name).read_text().splitlines() if (folder / name).exists() else []


def is_running(pid: int) -> bool:
    stat = Path(f"/proc/{pid}/stat")
    return stat.exists() and ") Z " not in stat.read_text()


def eventually(condition: Callable[[], bool], within_s: float = 30.0) -> None:
    end_s = time.monotonic() + within_s
    while not condition():
        assert time.monotonic() < end_s
        time.sleep(0.02)


def record(name: str, **values: object) -> Record:
    return Record(
        name=name, command=f"mmmd bench {name} --json", version="0.1.0", commit="abc", code="c0de", machine="a machine",
        date="2026-01-02T03:04:05+00:00", seconds=12.0, others_took=0.25, host_took=0.0, values=values,
    )  # fmt: skip


def test_what_fails_or_hangs_is_reported_and_the_rest_goes_on(table: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    found, good = bench_all(out, table_file=table)
    assert not good
    assert [f["met"] for f in found["figures"]] == [False, True, None, None, True]
    assert found["quick-one"] == {"ms": 12.3456, "of": {"a": {"x": 1.1}, "b": {"x": 1.3}}}, "t is left out"
    assert "no | servo" in found["runs"]["fails"]["error"]
    assert found["runs"]["hangs"]["error"] == "ended after 2 s"
    assert not is_running(int((tmp_path / "hangs.pid").read_text())), "what it started is ended too"
    page = (out / "report.md").read_text("utf-8")
    assert "| time | 12.35 ms | ≤ 10 ms | **no: 23 % over** | `python" in page
    assert "| worst robot | 1.30 (b) | ≤ 1.5 | yes |  |" in page
    assert f"| never | {NOT_MEASURED} | ≥ 90 % |  | `python" in page
    assert "- hangs: failed: ended after 2 s" in page
    assert "Of 5 marks 2 are met, 1 are missed, 2 were not measured here." in page


def test_a_second_run_makes_what_is_missing_alone(table: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    bench_all(out, ["last"], table_file=table)
    assert len(calls(tmp_path, "last")) == 1 and not calls(tmp_path, "quick-one")
    _, good = bench_all(out, ["quick-one", "last"], table_file=table)
    assert good and len(calls(tmp_path, "last")) == 1 and len(calls(tmp_path, "quick-one")) == 1
    bench_all(out, ["fails"], table_file=table)
    found, good = bench_all(out, ["fails"], table_file=table)
    assert not good and "last" in found, "the report has what was there; a failure is tried again and is a failure"
    bench_all(out, measure=False, table_file=table)
    assert not calls(tmp_path, "hangs")


def test_an_interrupted_run_keeps_what_it_has_and_ends_what_it_runs(table: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    code = (
        "from pathlib import Path; from daemon.bench.all_figures.run import bench_all; "
        f"bench_all(Path({str(out)!r}), ['quick-one', 'hangs'], table_file=Path({str(table)!r}))"
    )
    table.write_text(table.read_text().replace("limit_s = 2", "limit_s = 200"))
    with subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.DEVNULL) as run:
        pid = tmp_path / "hangs.pid"
        eventually(lambda: pid.exists() and pid.read_text() != "")
        run.send_signal(signal.SIGINT)
        assert run.wait(60) != 0
    eventually(lambda: not is_running(int(pid.read_text())))
    assert list(read_records(out, read_table(table))) == ["quick-one"]
    bench_all(out, ["quick-one", "last"], table_file=table)
    assert len(calls(tmp_path, "quick-one")) == 1 and len(calls(tmp_path, "last")) == 1


def test_other_options_code_or_machine_are_measured_again(table: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    bench_all(out, ["quick-one"], quick=True, table_file=table)
    assert "(quick)" in (out / "report.md").read_text("utf-8")
    bench_all(out, ["quick-one"], table_file=table)
    assert calls(tmp_path, "quick-one") == ["--n 2", "--n 50"]
    kept = read_records(out, read_table(table))["quick-one"]
    now = here()
    assert why_again(kept, kept.command, now) == ""
    for other, said in (
        (replace(now, machine="another"), "machine"),
        (replace(now, code="another"), "code"),
    ):
        assert said in why_again(kept, kept.command, other)
    assert "measured by" in why_again(kept, f"{kept.command} --quick", now)
    assert "failed" in why_again(msgspec.structs.replace(kept, error="status 1"), kept.command, now)
    assert why_again(None, "", now) == "missing"


def test_a_figure_of_code_that_changed_while_it_ran_is_not_kept(table: Path) -> None:
    """A checkout in the middle of a run had given figures of the new code under the old one's commit."""
    one, said = read_table(table)[3], Outcome(0, '{"lost": 0}', "", 1.0, None, None)
    now, date = here(), datetime(2026, 1, 2, tzinfo=UTC)
    assert record_of(one, "x", said, now, date, quick=False).values == {"lost": 0}
    other = record_of(one, "x", said, replace(now, code="before"), date, quick=False)
    assert other.values is None and "changed" in other.error


def test_a_file_that_is_no_record_and_a_wrong_name_are_refused(table: Path, tmp_path: Path) -> None:
    (tmp_path / "last.json").write_text("{}")
    with pytest.raises(CommandError, match=r"last\.json"):
        bench_all(tmp_path, table_file=table)
    with pytest.raises(CommandError, match="allowed: quick-one, fails, hangs, last"):
        bench_all(tmp_path / "out", ["none"], table_file=table)
    assert main(["bench", "all"]) == 2
    assert main(["bench", "all", "--out", str(tmp_path / "out"), "--only", "none"]) == 2
    assert main(["bench", "story", "--quick"]) == 2
    assert main(["bench", "all", "--out", str(tmp_path / "out"), "--no-measure"]) == 0


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
    assert "**Quick:" in page and f"{figure} |" in page and f"{figure} | {NOT_MEASURED}" not in page
    assert main(words[:-1]) == 0
    assert "there already" in capsys.readouterr().err
