"""A test in two sizes: a part of its cases in the default suite, all of them in `make soak`."""

from __future__ import annotations

from collections.abc import Iterable

import pytest


def some_and_all(some: Iterable[object], every: Iterable[object]) -> list[object]:
    """Values of one parameter that takes the cases as a tuple.

    Args:
        some: the cases of the default suite: those that once failed, the ends, and a few between.
        every: all cases; run under the mark `soak`.

    Returns:
        the two values with their ids, for `pytest.mark.parametrize`.
    """
    return [pytest.param(tuple(some), id="some"), pytest.param(tuple(every), id="all", marks=pytest.mark.soak)]
