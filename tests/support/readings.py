"""Readings as one line, for tables of sentences."""

from __future__ import annotations

from mmm_core.language.reading import read


def said(text: str) -> str:
    """The commands that are read and what is denied, as one line: "wave | not: bow"."""
    reading = read(text)
    return "; ".join(reading.sentences) + (f" | not: {', '.join(reading.denied)}" if reading.denied else "")
