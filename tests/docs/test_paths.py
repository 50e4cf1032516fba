"""Every file and folder of ours that a page names exists."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent.parent
PAGES = sorted([ROOT / "README.md", *(ROOT / "docs").rglob("*.md")])
FOLDERS = ("mmm_core", "retarget", "daemon", "sim", "tests", "docs")
NAMED = re.compile(r"`([A-Za-z_0-9./]+)`")
NOT_OURS = {"make_policy.py"}
"""Files of other projects that a page cites."""


@pytest.fixture(scope="module")
def files() -> list[str]:
    found = [str(path.relative_to(ROOT)) for folder in FOLDERS for path in (ROOT / folder).rglob("*")]
    return [f"/{name}" for name in found if "__pycache__" not in name]


@pytest.mark.parametrize("page", PAGES, ids=[str(page.relative_to(ROOT)) for page in PAGES])
def test_files_and_folders_named_on_a_page_exist(page: Path, files: list[str]) -> None:
    named = {name.rstrip("/") for name in NAMED.findall(page.read_text("utf-8"))}
    ours = {name for name in named if name.endswith(".py") or ("/" in name and name.split("/")[0] in FOLDERS)}
    missing = {name for name in ours if not any(file.endswith(f"/{name}") for file in files)}
    assert missing - NOT_OURS == set(), "a renamed file has another name on its pages too"
