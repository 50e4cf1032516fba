"""The table of all figures (`figures.toml`): the command that measures each, its mark, and the verdict on a measured value."""

from __future__ import annotations

import shlex
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, cast

import msgspec

from daemon.errors import CommandError

TABLE = Path(__file__).parent / "figures.toml"
KeyPath = tuple[str | tuple[str, ...], ...]
"""A path in a command's JSON: names of keys; "*" stands for every key, a tuple for the keys in it."""
RECORDINGS = "{recordings}"
"""Placeholder in a command for the folder of docs/DATA.md."""
NOT_MEASURED = "not measured here"
YES, NO = "yes", "no"


class Figure(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One line of the report.

    Attributes:
        what: the quantity, in words.
        keys: paths in the command's JSON, shown beside each other; the worst is judged.
        unit: "%" where the values are shares of 1.
        at_most: the mark from above; None for none.
        at_least: the mark from below; None for none.
        is_true: whether the mark is that the value is true.
        either: name of a group of figures, one of which has to meet its mark; "" for none.
        source: person or document that sets the mark.
    """

    what: str
    keys: tuple[KeyPath, ...]
    unit: str = ""
    at_most: float | None = None
    at_least: float | None = None
    is_true: bool = False
    either: str = ""
    source: str = ""

    @property
    def has_mark(self) -> bool:
        """Whether the figure has a mark to reach."""
        return self.is_true or self.at_most is not None or self.at_least is not None


class Column(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A column of peers: its title with the unit, and the keys of a peer's value and of ours (empty: ours has none)."""

    title: str
    unit: str
    key: KeyPath
    ours: KeyPath = ()


class Peers(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The key in a command's JSON under which other programs' figures stand, and the programs that may be there."""

    key: str
    expected: tuple[str, ...]
    columns: tuple[Column, ...]


class Measurement(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A command and the figures that it gives.

    Attributes:
        name: name of the measurement and of its file.
        command: program and arguments; "mmmd" and "python" of this installation; "{recordings}" is the folder of docs/DATA.md.
        options: further arguments.
        quick: the arguments in their place with --quick; None for the same.
        limit_s: seconds after which the command is ended.
        how: the method in a sentence.
        needs: "recordings" or "clone", which do not ship; "" for neither.
        without: reason why no command measures the figures; "" where one does.
        leave_out: keys of the JSON that are not kept.
        figures: lines of the report.
        peers: other programs in the same run; None for none.
    """

    name: str
    figures: tuple[Figure, ...]
    command: tuple[str, ...] = ()
    options: tuple[str, ...] = ()
    quick: tuple[str, ...] | None = None
    limit_s: float = 600.0
    how: str = ""
    needs: str = ""
    without: str = ""
    leave_out: tuple[str, ...] = ()
    peers: Peers | None = None

    def words(self, seed: int, *, quick: bool) -> tuple[str, ...]:
        """The command line: benches get a seed, and all commands of mmmd print JSON."""
        options = self.quick if quick and self.quick is not None else self.options
        seeded = ("--seed", str(seed)) if self.command[:2] == ("mmmd", "bench") and seed else ()
        return (*self.command, *options, *seeded, *(("--json",) if self.command[0] == "mmmd" else ()))


class Row(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A measured figure: values and mark in words, and whether the mark is met (None: no mark, or no value)."""

    figure: Figure
    shown: str
    to_reach: str
    verdict: str
    is_met: bool | None


def read_table(path: Path = TABLE) -> tuple[Measurement, ...]:
    """The measurements of a table, in its order."""
    return msgspec.convert(tomllib.loads(path.read_text("utf-8"))["measurement"], tuple[Measurement, ...])


def chosen(table: Sequence[Measurement], names: Sequence[str]) -> tuple[Measurement, ...]:
    """The figures with the given names, in the table's order; all figures where no name is given.

    Raises:
        CommandError: a name is not in the table.
    """
    known = [m.name for m in table]
    if unknown := [name for name in names if name not in known]:
        raise CommandError(f"bench all: no figures {unknown[0]!r}; allowed: {', '.join(known)}")
    return tuple(m for m in table if not names or m.name in names)


def typed(words: Sequence[str]) -> str:
    """A command line for display; the folder of the recordings is shown as DIR."""
    return shlex.join("DIR" if word == RECORDINGS else word for word in words)


def rows_of(measurement: Measurement, values: Mapping[str, Any] | None) -> list[Row]:
    """The lines of a measurement; `values` is the command's JSON, None where it was not measured."""
    rows = [_judged(figure, {} if values is None else values) for figure in measurement.figures]
    by_other = {r.figure.either for r in rows if r.figure.either and r.is_met}
    return [
        Row(r.figure, r.shown, r.to_reach, "not alone: the other mark is met", None)
        if r.is_met is False and r.figure.either in by_other
        else r
        for r in rows
    ]


def values_at(values: Any, path: KeyPath) -> Iterator[tuple[str, Any]]:
    """(name, value) pairs of everything that a path leads to; names are the keys that "*" or a tuple stood for."""
    if not path:
        if values is not None and not isinstance(values, Mapping):
            yield "", values
        return
    first, rest = path[0], path[1:]
    if not isinstance(values, Mapping):
        return
    known = cast(Mapping[str, Any], values)
    if first == "*" or isinstance(first, tuple):
        for key in known if first == "*" else first:
            for name, value in values_at(known.get(key), rest):
                yield f"{key} {name}".strip(), value
    else:
        yield from values_at(known.get(first), rest)


def shown(value: Any, unit: str) -> str:
    """A value as printed, without its unit."""
    if isinstance(value, bool):
        return YES if value else NO
    number = float(value) * (100 if unit == "%" else 1)
    if number.is_integer() or abs(number) >= 1000:
        return f"{number:,.0f}"
    digits = 1 if abs(number) >= 20 or unit == "%" else 2 if abs(number) >= 1 else 3
    return f"{number:,.{digits}f}"


def _judged(figure: Figure, values: Mapping[str, Any]) -> Row:
    found = [list(values_at(values, path)) for path in figure.keys]
    to_reach = _mark(figure)
    if not all(found) and (figure.has_mark or not any(found)):
        return Row(figure, NOT_MEASURED, to_reach, "", None)
    worst = [_worst(one, figure) for one in found if one]
    words = " / ".join(shown(value, figure.unit) for _, value in worst)
    names = [name for (name, _), one in zip(worst, (one for one in found if one), strict=True) if name and len(one) > 1]
    words = f"{words} {figure.unit}".strip() + (f" ({', '.join(names)})" if names else "")
    verdict, is_met = _verdict(figure, [value for _, value in worst])
    return Row(figure, words, to_reach, verdict, is_met)


def _worst(found: list[tuple[str, Any]], figure: Figure) -> tuple[str, Any]:
    return (min if figure.at_least is not None else max)(found, key=lambda one: one[1])


def _verdict(figure: Figure, values: Sequence[Any]) -> tuple[str, bool | None]:
    """Whether the mark is met, in words, with the distance where it is not."""
    if figure.is_true:
        return (YES, True) if all(values) else (NO, False)
    if figure.at_most is not None:
        over = max(values) - figure.at_most
        if over <= 0:
            return YES, True
        return (f"no: {_share(over / figure.at_most)} over" if figure.at_most else f"no: {shown(over, '')}"), False
    if figure.at_least is not None:
        short = figure.at_least - min(values)
        if short <= 0:
            return YES, True
        by = f"{100 * short:.1f} points" if figure.unit == "%" else _share(short / figure.at_least)
        return f"no: {by} short", False
    return "", None


def _share(share: float) -> str:
    return f"{100 * share:.0f} %" if share >= 0.1 else f"{100 * share:.1f} %"


def _mark(figure: Figure) -> str:
    if figure.is_true:
        return YES
    mark = figure.at_most if figure.at_most is not None else figure.at_least
    if mark is None:
        return ""
    sign = "" if mark == 0 else "≤ " if figure.at_most is not None else "≥ "
    number = f"{100 * mark:g}" if figure.unit == "%" else f"{mark:,g}"
    return f"{sign}{number} {figure.unit}".strip()
