"""No file of the packages holds more than one reads at a sitting; those that do stand here with the reason."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).parent.parent
PACKAGES = ("mmm_core", "retarget", "daemon", "sim")
MOST_LINES = 300
LONGER: dict[str, str] = {}


def test_no_file_is_longer_than_one_reads_at_a_sitting():
    lines = {
        str(path.relative_to(ROOT)): len(path.read_text("utf-8").splitlines())
        for package in PACKAGES
        for path in (ROOT / package).rglob("*.py")
    }
    assert len(lines) > 300, "the packages were found"
    longer = {name for name, n in lines.items() if n > MOST_LINES}
    assert longer - LONGER.keys() == set(), f"split these along their concepts, {MOST_LINES} lines each"
    assert LONGER.keys() - longer == set(), "these need no exception any more"
