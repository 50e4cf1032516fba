"""The lists of docs/wire/stop_words.md: texts that stop, and texts that do not."""

from __future__ import annotations

from pathlib import Path

_PAGE = Path(__file__).parents[2] / "docs" / "wire" / "stop_words.md"


def listed(heading: str) -> list[str]:
    """The items below a heading of the page."""
    section = _PAGE.read_text("utf-8").split(f"## {heading}\n")[1].split("\n## ")[0]
    return [line[2:] for line in section.splitlines() if line.startswith("- ")]
