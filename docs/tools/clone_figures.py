"""Seconds that a newcomer waits, as JSON: from a fresh clone to its first gesture; with `--suite N` for N runs of its tests.

`python -m docs.tools.clone_figures`: seconds of `make setup`, of `make demo` after it, and of both; megabytes on disk. What is
downloaded comes from the index that pip is configured for, and from pip's cache. `--suite 3`: seconds of `make test`, the longest
and each, how many runs had a test that failed at first, and the names of these tests.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
MB = 1_000_000


def main(runs: int) -> None:
    """Clone, measure, print; without `runs` the way to the first gesture, else the tests."""
    with tempfile.TemporaryDirectory() as name:
        clone = Path(name) / "mmmd"
        subprocess.run(["git", "clone", "-q", str(ROOT), str(clone)], check=True, timeout=300)
        figures = _suite(clone, runs) if runs else _first_gesture(clone)
        sys.stdout.write(json.dumps(figures) + "\n")


def _first_gesture(clone: Path) -> dict[str, Any]:
    setup_s, demo_s = _made(clone, "setup")[0], _made(clone, "demo")[0]
    disk = sum(path.lstat().st_size for path in clone.rglob("*") if path.is_file() and not path.is_symlink())
    return {
        "seconds": round(setup_s + demo_s, 1), "setup_s": round(setup_s, 1), "demo_s": round(demo_s, 1),
        "disk_mb": round(disk / MB), "cores": os.cpu_count(),
    }  # fmt: skip


def _suite(clone: Path, runs: int) -> dict[str, Any]:
    _made(clone, "setup")
    made = [_made(clone, "test") for _ in range(runs)]
    seconds = [round(took_s, 1) for took_s, _ in made]
    failed = sum(bool(re.search(r"\d+ (failed|error)", said)) for _, said in made)
    names = sorted({name for _, said in made for name in re.findall(r"^(?:FAILED|ERROR) (\S+)", said, re.MULTILINE)})
    return {
        "seconds": max(seconds), "each_s": seconds, "failed_at_first": failed, "failed": names, "n": runs,
        "cores": os.cpu_count(),
    }  # fmt: skip


def _made(clone: Path, target: str) -> tuple[float, str]:
    """Seconds of a make target, and what it printed."""
    shared = {"MMMD_SHARED": str(ROOT.parent / "shared")} if (ROOT.parent / "shared").is_dir() else {}
    began_s = time.monotonic()
    done = subprocess.run(
        ["make", target], cwd=clone, env=shared | os.environ, text=True, check=False,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    took_s = time.monotonic() - began_s
    if done.returncode:
        sys.stderr.write(done.stdout[-3000:])
        raise SystemExit(f"make {target}: status {done.returncode}")
    return took_s, done.stdout


if __name__ == "__main__":
    main(int(sys.argv[2]) if sys.argv[1:2] == ["--suite"] else 0)
