"""Removes the notation of Python's types from a command's help: no `{None}|FLOAT`, no `(default: None)`."""

from __future__ import annotations

import contextlib
import io
import re
import sys
from collections.abc import Generator

_OPTIONAL = re.compile(r"\{None\}\||(?<=\{)None,")
_NO_DEFAULT_WRAPPED = re.compile(r"\(default:( *[│|]?\n)[│|]? +None\) *[│|]?\n")
_NO_DEFAULT = re.compile(r" ?\(default:\s+None\)")


@contextlib.contextmanager
def plain_help() -> Generator[None]:
    """Collect the output inside the block and print it cleaned at the end, with its widths and borders."""
    out = sys.stdout
    kept = io.TextIOWrapper(
        io.BytesIO(), encoding=out.encoding or "utf-8", errors="replace"
    )  # the encoding decides on the borders
    sys.stdout = kept
    try:
        yield
    finally:
        sys.stdout = out
        kept.seek(0)
        out.write(cleaned(kept.read()))


def cleaned(text: str) -> str:
    """Help text without the notations for "not given"."""
    text = _NO_DEFAULT_WRAPPED.sub(lambda m: " " * len("(default:") + m[1], text)
    return "".join(_cleaned_line(line) for line in text.splitlines(keepends=True) if _says_more(line))


def _cleaned_line(line: str) -> str:
    plain = _NO_DEFAULT.sub("", _OPTIONAL.sub("", line))
    lost = len(line) - len(plain)
    end = line.rstrip("\n")[-1:]
    if not lost or end not in ("│", "|"):
        return plain
    return plain.rstrip("\n")[:-1] + " " * lost + end + "\n"


def _says_more(line: str) -> bool:
    """Whether a line has more text than a default of None."""
    return not re.fullmatch(r"[│|]?\s*\(default: None\)\s*[│|]?\n?", line)
