"""Blocks of the pages that people read, examples of `--help`, and whether a command printed what a page promises.

A block is fenced, or indented by four spaces. What it is follows from its lines: commands, Python, JSON messages, TOML, or text (a
drawing, a formula). Comments before a block say what cannot be told from it:

    <!-- not run: REASON -->              nothing of the next block is run
    <!-- not run: PREFIX: REASON -->      of the next block the commands are not run that begin so
    <!-- output of: COMMAND -->           the next block is what COMMAND prints; a line "..." stands for any lines
"""

from __future__ import annotations

import ast
import contextlib
import re
import shlex
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).parents[2]
PROGRAMS = ("mmmd", "make", "pip", "python", "python3", "cp", "mkdir", "cd", "source", "sudo", "torchrun", "npm")
_NOT_RUN = re.compile(r"<!-- not run: (?:(mmmd [\w -]+): )?(.+?) -->")
_COMMENT = re.compile(r"^<!-- .* -->$")
_OUTPUT = re.compile(r"<!-- output of: (.+?) -->")


@dataclass
class Block:
    """A block of a page.

    Attributes:
        page: its path below the repository.
        line: of its first line in the page, from 1.
        kind: commands, python, json, toml, output or text.
        lines: without indentation.
        skipped: reasons by the beginning of the commands that are not run; "" for all.
        command: what prints it (output).
    """

    page: str
    line: int
    kind: str
    lines: list[str]
    skipped: dict[str, str] = field(default_factory=dict[str, str])
    command: str = ""

    def __str__(self) -> str:
        return f"{self.page}:{self.line}"

    @property
    def commands(self) -> list[str]:
        """Command lines, joined where they go on, without comments."""
        joined = "\n".join(self.lines).replace("\\\n", " ")
        return [c for line in joined.splitlines() if (c := _without_comment(line)) and c.split()[0] in PROGRAMS]

    def why_not(self, command: str) -> str:
        """Why a command of the block is not run; "" if it is."""
        return next((why for prefix, why in self.skipped.items() if command.startswith(prefix)), "")


def blocks(page: str) -> list[Block]:
    """The blocks of a page, in order."""
    found: list[Block] = []
    skipped, output = dict[str, str](), ""
    lines = (ROOT / page).read_text("utf-8").splitlines()
    i = 0
    while i < len(lines):
        if match := _NOT_RUN.search(lines[i]):
            skipped[match[1] or ""] = match[2]
        elif match := _OUTPUT.search(lines[i]):
            output = match[1]
        fence = re.match(r"^```(\w*)", lines[i])
        indented = lines[i].startswith("    ") and (i == 0 or not _COMMENT.sub("", lines[i - 1]).strip())
        if not fence and not indented:
            i += 1
            continue
        start = i + 1 if fence else i
        end = start
        while end < len(lines) and (not lines[end].startswith("```") if fence else _goes_on(lines, end)):
            end += 1
        body = [line if fence else line[4:] for line in lines[start:end]]
        kind = "output" if output else _kind(fence[1] if fence else "", body)
        found.append(Block(page, start + 1, kind, body, skipped, output))
        skipped, output = {}, ""
        i = end + 1
    return found


def _goes_on(lines: list[str], i: int) -> bool:
    """Whether an indented block goes on at line `i`: an empty line ends it unless an indented one follows."""
    return lines[i].startswith("    ") or (
        not lines[i].strip() and i + 1 < len(lines) and lines[i + 1].startswith("    ")
    )


def _kind(language: str, body: list[str]) -> str:
    if language in ("toml", "json", "python", "js", "mermaid"):
        return language
    words = [_without_comment(line).split() for line in body]
    if any(w and w[0] in PROGRAMS for w in words):
        return "commands"
    text = "\n".join(body)
    if text.lstrip().startswith('{"type"'):
        return "json"
    if re.search(r"^\[\[?[\w.]+\]\]?", text, re.MULTILINE):
        return "toml"
    return "python" if re.search(r"^(import|with) .*", text, re.MULTILINE) else "text"


def _without_comment(line: str) -> str:
    """A command line without what follows a # outside of quotes."""
    with contextlib.suppress(ValueError):
        lexer = shlex.shlex(line, posix=False, punctuation_chars="")
        lexer.whitespace_split, lexer.commenters = True, "#"
        return " ".join(lexer)
    return line.split(" #", maxsplit=1)[0].strip()


_NEXT_EXAMPLE = re.compile(r",? (?:or|and|then)\b[^:\"]{0,30}: (?=mmmd )| && |, of lines .*| \.\.\.$")
"""What stands between the commands of an example, and after the last one."""


def help_examples() -> list[tuple[str, str]]:
    """(command, command line) of every example of `--help`, as the docstrings have them."""
    found: list[tuple[str, str]] = []
    for path in sorted((ROOT / "daemon/cli").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and (text := ast.get_docstring(node)):
                for match in re.finditer(r"^Example[^:\n]*: (.+(?:\n(?!Example)[^\n]+)*)", text, re.MULTILINE):
                    parts = _NEXT_EXAMPLE.split(" ".join(match[1].split()))
                    found += [(node.name.replace("_", "-"), part) for part in parts if part]
    return found


def assert_prints(said: str, promised: list[str]) -> None:
    """Each promised line stands in the output, in order; "..." stands for any lines, blanks count once."""
    lines = [" ".join(line.split()) for line in said.splitlines()]
    at = 0
    for line in promised:
        wanted = " ".join(line.split())
        if wanted in ("", "..."):
            continue
        start = wanted.removesuffix(" ...").removesuffix(", ...")
        places = [
            i for i in range(at, len(lines)) if lines[i] == wanted or (start != wanted and lines[i].startswith(start))
        ]
        assert places, f"not printed: {wanted!r} in\n{said}"
        at = places[0] + 1
