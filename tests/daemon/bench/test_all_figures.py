"""`mmmd bench all`: what it measures again and what not, and what it says of commands that fail."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import msgspec
import pytest

from daemon.bench.all_figures.process import Outcome
from daemon.bench.all_figures.records import here, read_records, record_of, why_again
from daemon.bench.all_figures.run import bench_all
from daemon.bench.all_figures.table import NOT_MEASURED, read_table
from daemon.cli import main
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


@pytest.mark.long
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


@pytest.mark.long
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


@pytest.mark.long
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
