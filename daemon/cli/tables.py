"""Tables for terminals of any width, in which a name that a person has to type is never cut."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.table import Table


def table_of(columns: Sequence[str], typed: Collection[str], title: str = "", right: Collection[str] = ()) -> Table:
    """An empty table.

    Args:
        columns: titles.
        typed: columns of names and numbers that a person types again: they stay in one line, and the others give way.
        title: of the table; none when empty.
        right: columns of numbers, aligned to the right.
    """
    from rich.table import Table

    table = Table(title=title or None)
    for column in columns:
        whole = column in typed
        table.add_column(column, overflow="fold", no_wrap=whole, justify="right" if column in right else "left")
    return table
