"""The model that ships, loaded once in a process: loading takes as long as a dozen motions."""

from __future__ import annotations

from functools import cache

from mmm_core.generate.engine import Engine


@cache
def shipped_engine() -> Engine:
    """Shared by all tests of a process: one that changes it loads its own."""
    return Engine.load()
