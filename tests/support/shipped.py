"""The model that ships, loaded once in a process: loading takes as long as a dozen motions."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

import pytest

from mmm_core.generate.engine import Engine


@cache
def shipped_engine() -> Engine:
    """Shared by all tests of a process: one that changes it loads its own."""
    return Engine.load()


@contextmanager
def loaded_once() -> Iterator[None]:
    """Commands that run in this process take the shared engine where they would load the shipped model."""
    shared, load = shipped_engine(), Engine.load

    def take(path: Any = None, *, threads: int | None = 1, precision: Any = None, **options: Any) -> Engine:
        if path is None and precision is None and not options:
            return shared
        return load(path, threads=threads, precision=precision, **options)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Engine, "load", take)
        yield
