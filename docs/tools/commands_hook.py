"""The page of all commands, as MkDocs asks for it: what each says with `--help`, so that no copy of it can grow old."""

from __future__ import annotations

import contextlib
import html
import io
import os
import re

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

from daemon.cli.program import COMMANDS, main

PAGE = "commands.md"
COLUMNS = "100"
_BOX = "╭"
"""The first character of the options, which are drawn in boxes."""


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the page."""
    files.append(File.generated(config, PAGE, content=commands_page()))
    return files


def commands_page() -> str:
    """The page in Markdown."""
    head = (
        "# Commands\n\nWhat each command says with `--help`. Exit status: 0 good, 1 failed, 2 bad use, 3 robot fault.\n"
    )
    return "\n".join([head, *(_section(name) for name in COMMANDS)])


def _section(name: str) -> str:
    """One command: its usage, what it does, its examples, its options."""
    words, _, boxes = help_of(name).partition(_BOX)
    usage, *paragraphs = [" ".join(part.split()) for part in words.split("\n\n") if part.strip()]
    told = "\n\n".join(_paragraph(part) for part in paragraphs)
    return f"## mmmd {name}\n\n{COMMANDS[name].summary}\n\n```\n{usage}\n```\n\n{told}\n\n```\n{_BOX}{boxes.rstrip()}\n```\n"


def _paragraph(text: str) -> str:
    example = re.fullmatch(r"(Example[^:]*): (.+)", text)
    if example is None:
        return html.escape(text, quote=False)
    lines = example[2].replace(" or: mmmd ", "\nmmmd ")
    return f"{example[1]}:\n\n```\n{lines}\n```"


def help_of(name: str) -> str:
    """What `mmmd NAME --help` prints on a terminal of `COLUMNS` columns."""
    os.environ.update(COLUMNS=COLUMNS, NO_COLOR="1")
    out = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")
    with contextlib.redirect_stdout(out):
        main([name, "--help"])
    out.seek(0)
    return out.read()
