"""Fixtures of the trainings that take a second (tests/support/small_training.py)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from tests.support.small_training import Finished


@pytest.fixture(scope="module", name="quick_parts")
def _quick_parts() -> Iterator[None]:
    """The trainings of a module take the shortcuts."""
    from tests.support.small_training import quick_parts  # PyTorch is loaded where a test needs it

    with quick_parts():
        yield


@pytest.fixture(scope="session")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Finished:
    """A small recipe and the model that it gave, from which the runs of several tests go on."""
    from tests.support.small_training import finish

    return finish(tmp_path_factory.mktemp("finished"))
