"""Names of picture files: which endings there are, refused before any work is done."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from daemon.errors import CommandError

STILL = (".png", ".svg", ".pdf", ".jpg")
"""Endings of pictures that matplotlib writes on every machine."""


def check_picture(path: Path, option: str, endings: Sequence[str] = STILL) -> None:
    """Refuse a picture that could not be written.

    Args:
        path: to write.
        option: of the command line that named it, "--out".
        endings: that are allowed.

    Raises:
        CommandError: its ending is none of these, or there is no such folder.
    """
    if path.suffix.lower() not in endings:
        found = f"'{path.suffix}'" if path.suffix else "no ending"
        raise CommandError(
            f"{option} {path}: found {found}; allowed: {', '.join(endings)}; name the file with one of these"
        )
    if not path.parent.is_dir():
        raise CommandError(f"{option} {path}: no folder '{path.parent}'; make it, or choose another")
