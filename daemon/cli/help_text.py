"""Help of a command without the words of Python's type system: no `{None}|FLOAT`, no `(default: None)`."""

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
    """What is printed meanwhile is printed at the end, cleaned: widths and borders stay."""
    out = sys.stdout
    kept = io.TextIOWrapper(io.BytesIO(), encoding=out.encoding or "utf-8", errors="replace")  # borders go by encoding
    sys.stdout = kept
    try:
        yield
    finally:
        sys.stdout = out
        kept.seek(0)
        out.write(cleaned(kept.read()))


def cleaned(text: str) -> str:
    """Help text with what stands for "not given" left out."""
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
    """Whether something is left of a line that had no more than a default of None."""
    return not re.fullmatch(r"[│|]?\s*\(default: None\)\s*[│|]?\n?", line)
