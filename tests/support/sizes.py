"""A test in two sizes: a part of its cases in the default suite, all of them in `make soak`.

Properties are tried on few examples there, the same in each run; `make soak` tries them on three times as many, drawn anew
(profiles of tests/conftest.py).
"""

from __future__ import annotations

from collections.abc import Iterable

import pytest
from hypothesis import settings


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
