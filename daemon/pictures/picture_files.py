"""Endings of picture files, checked before any work is done."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from daemon.errors import CommandError

STILL = (".png", ".svg", ".pdf", ".jpg")
"""Endings of pictures that matplotlib writes on every machine."""


def check_picture(path: Path, option: str, endings: Sequence[str] = STILL) -> None:
    """Refuse a picture file that could not be written.

    Args:
        path: file to write.
        option: option of the command line that names the file, such as "--out".
        endings: allowed endings.

    Raises:
        CommandError: the ending is not allowed, or the folder does not exist.
    """
    if path.suffix.lower() not in endings:
        found = f"'{path.suffix}'" if path.suffix else "no ending"
        raise CommandError(
            f"{option} {path}: found {found}; allowed: {', '.join(endings)}; name the file with one of these"
        )
    if not path.parent.is_dir():
        raise CommandError(f"{option} {path}: no folder '{path.parent}'; make it, or choose another")
