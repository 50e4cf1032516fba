"""Fixtures of the tests that start whole daemons."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.robot_states import Servos


@pytest.fixture
def servos(tmp_path: Path) -> Iterator[Servos]:
    """A simulated robot behind a tty of its own."""
    made = Servos(tmp_path)
    yield made
    made.close()
