"""Every error that a user can meet, how a test provokes it, and the page made of it: `python -m tests.support.errors_page`.

The text of an error is never written here: it is what the program said when the error was provoked.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path

from daemon.cli import main
from daemon.wire.codec import WireError, decode_cmd, decode_ctl, decode_target
from tests.support.errors_table import ANSWERED, FRAMES, NOWHERE, TYPED, Frame, Typed

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "errors.md"
_DECODE = {"cmd": decode_cmd, "ctl": decode_ctl, "stream": decode_target}


@contextlib.contextmanager
def in_folder(files: tuple[tuple[str, str], ...]) -> Iterator[None]:
    """In a new folder with these files."""
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            for name, text in files:
                Path(name).write_text(text)
            yield
        finally:
            os.chdir(before)


def typed(row: Typed) -> tuple[int, str]:
    """Exit status and message of a command line."""
    out = io.StringIO()
    with in_folder(row.files), contextlib.redirect_stderr(out), contextlib.redirect_stdout(out):
        status = main(list(row.arguments))
    lines = [line.strip("│╭╰─╮╯| \n") for line in out.getvalue().splitlines()]
    return status, " ".join(line for line in lines if line)


def refused(row: Frame) -> WireError:
    """The error of a frame."""
    try:
        _DECODE[row.socket](row.frame)
    except WireError as error:
        return error
    raise AssertionError(f"{row.frame!r} is taken")


def page() -> str:
    """The page."""
    lines = [
        "# Errors", "",
        "Made by `python -m tests.support.errors_page`: each error below is provoked by a test, and its text is what was said then.", "",
        "Every error says what was asked, what was found, what is allowed and what to do. `MMMD_DEBUG=1` adds where in the program.", "",
        "## Exit status", "",
        "| status | meaning |", "|---|---|",
        "| 0 | done |",
        "| 1 | the command was right and did not succeed: no daemon, no adapter, a port in use, a text that was refused, cancelled |",
        "| 2 | the command, a file that it names or a value in it is wrong |",
        "| 3 | the robot is in a fault or e-stop that a person has to reset |",
        "| 130 | Ctrl-C |", "",
        "## At the command line", "",
        "| typed | status | said | cause | what to do |", "|---|---|---|---|---|",
    ]  # fmt: skip
    for row in TYPED:
        status, said = typed(row)
        shown = " ".join(
            repr(a) if " " in a or not a else a
            for a in row.arguments
            if a not in NOWHERE and a not in ("--cmd", "--pub")
        )
        shown = shown.removesuffix(" --ctl") if NOWHERE[3] in row.arguments else shown
        lines.append(f"| `mmmd {shown}` | {status} | {_cell(said)} | {row.cause} | {_cell(row.remedy)} |")
    lines += [
        "",
        "## Frames that are no request (`error`)",
        "",
        "| code | socket | said | cause |",
        "|---|---|---|---|",
    ]
    for frame in FRAMES:
        lines.append(f"| `{frame.code}` | {frame.socket} | {_cell(str(refused(frame)))} | {frame.cause} |")
    lines += ["", "## What the daemon answers (`rejected`, `failed`, `error`)", ""]
    lines += ["| code | cause | what to do |", "|---|---|---|"]
    lines += [f"| `{row.code}` | {row.cause} | {row.remedy} |" for row in ANSWERED]
    return "\n".join(lines) + "\n"


def _cell(text: str) -> str:
    """Text in a cell of a table, on one line and not too long; temporary folders and versions are left out."""
    text = re.sub(r"/tmp/tmp\w+", "FOLDER", " ".join(text.split())).replace("|", "\\|").replace("<", "&lt;")
    return text if len(text) <= 400 else f"{text[:400]} ..."


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
    print(json.dumps({"written": str(PAGE)}))  # noqa: T201
