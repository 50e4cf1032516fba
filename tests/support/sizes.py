"""A test in sizes: few cases in the default suite, more in `make test-long`, all in `make soak`.

`make test` is run before each change: of every promise it tries one cheap case, and all cases where they cost little. The marker
`long` is for tests that repeat a promise at length or in further variants: other robots, examples in other languages, other
sockets, other moments of a kill, whole trainings, the wheel. `make test-long` runs them, and so does `.ci/run` after `make test`.
The marker `soak` is for hours.

Properties are tried on few examples in the default suite, the same in each run; `make soak` tries them on three times as many,
drawn anew (profiles of tests/conftest.py).
"""

from __future__ import annotations

from collections.abc import Iterable

import pytest
from hypothesis import settings


def few_and_long(few: Iterable[object], every: Iterable[object]) -> list[object]:
    """Cases for `pytest.mark.parametrize` and `pytest.fixture`; a tuple holds the values of several parameters.

    Args:
        few: the cases of the default suite: the cheapest that shows each kind of failure.
        every: the other cases, run under the mark `long`; those of `few` may be among them.

    Returns:
        the cases of the default suite, then the others with their mark.
    """
    few = list(few)
    others = [case if isinstance(case, tuple) else (case,) for case in every if case not in few]
    return [*few, *(pytest.param(*values, marks=pytest.mark.long) for values in others)]


def some_and_all(some: Iterable[object], every: Iterable[object]) -> list[object]:
    """Values of one parameter that takes the cases as a tuple.

    Args:
        some: the cases of the default suite: those that once failed, the ends, and a few between.
        every: all cases; run under the mark `soak`.

    Returns:
        the two values with their ids, for `pytest.mark.parametrize`.
    """
    return [pytest.param(tuple(some), id="some"), pytest.param(tuple(every), id="all", marks=pytest.mark.soak)]


def examples(many: int) -> int:
    """How many examples a property is tried on: `many` in the soak run, a third of them otherwise, four at the least."""
    return many if settings.get_current_profile_name() == "soak" else max(4, many // 3)
