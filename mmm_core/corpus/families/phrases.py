"""Reads the phrases of a gesture family from `mmm_core/corpus/phrases/<family>.txt`.

A file holds one phrase a line, in the notation of `Words`. A line in square brackets begins a section and names the field of
`Words` that the phrases below belong to, after a direction if the family has phrases of its own for the direction:

    [bare]
    clap {n}
    [up: bare]
    clap above your head {n}
"""

from __future__ import annotations

from dataclasses import fields
from importlib.resources import files

from mmm_core.corpus.families.gesture import Words

_FIELDS = tuple(field.name for field in fields(Words))


def read_phrases(family: str) -> tuple[Words, dict[str, Words]]:
    """The phrases of a family, and those of its single directions in the order of the file.

    Args:
        family: name of the family, which is the name of the file.

    Raises:
        ValueError: as `parse_phrases`.
    """
    name = f"{family}.txt"
    return parse_phrases(files("mmm_core.corpus").joinpath("phrases", name).read_text(encoding="utf-8"), name)


def parse_phrases(text: str, name: str) -> tuple[Words, dict[str, Words]]:
    """The phrases in `text`, and those of the single directions in their order.

    Args:
        text: content of a phrase file.
        name: name of the file in errors.

    Raises:
        ValueError: a section is no field of `Words`, or a phrase stands above the first section.
    """
    found: dict[str, dict[str, list[str]]] = {}
    section: list[str] | None = None
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("[") and line.endswith("]"):
            direction, _, field = line[1:-1].rpartition(": ")
            if field not in _FIELDS:
                raise ValueError(f"{name}:{number}: section {line!r}; allowed are {', '.join(_FIELDS)}")
            section = found.setdefault(direction, {}).setdefault(field, [])
        elif line:
            if section is None:
                raise ValueError(f"{name}:{number}: a phrase stands before the first section, for example [bare]")
            section.append(line)
    words = {direction: Words(**{f: tuple(p) for f, p in some.items()}) for direction, some in found.items()}
    return words.pop("", Words()), words
