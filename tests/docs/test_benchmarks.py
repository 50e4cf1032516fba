"""docs/BENCHMARKS.md is the report of the figures kept in docs/figures, so that nobody edits it by hand."""

from __future__ import annotations

from pathlib import Path

from daemon.bench.all_figures.markdown import report
from daemon.bench.all_figures.records import read_records
from daemon.bench.all_figures.table import read_table

ROOT = Path(__file__).parent.parent.parent
FIGURES, PAGE = ROOT / "docs/figures", ROOT / "docs/BENCHMARKS.md"
AGAIN = "mmmd bench all --out docs/figures --markdown docs/BENCHMARKS.md --no-measure"
MOST_LINES, MOST_BYTES = 150, 500_000


def test_the_page_of_figures_is_what_their_files_give():
    table = read_table()
    records = read_records(FIGURES, table)
    page = report(table, records)
    assert PAGE.read_text("utf-8") == page, f"it is made, not edited: {AGAIN}"
    assert len(page.splitlines()) < MOST_LINES
    assert {path.stem for path in FIGURES.glob("*")} == set(records), "a file is of a measurement that there is no more"
    assert sum(path.stat().st_size for path in FIGURES.glob("*")) < MOST_BYTES


def test_kept_figures_name_no_folder_of_a_machine():
    """A command's JSON goes into the repository as it is."""
    for path in FIGURES.glob("*.json"):
        found = [
            folder
            for folder in (*(f"/{name}/" for name in ("home", "tmp", "root")), str(ROOT))
            if folder in path.read_text("utf-8")
        ]
        assert not found, path
