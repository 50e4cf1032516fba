"""The daemon's two halves on one virtual clock, for a test."""

from __future__ import annotations

import pytest

from tests.support.playback_bench import Bench


@pytest.fixture
def bench():
    made = Bench()
    yield made
    made.close()
