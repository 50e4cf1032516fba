"""A socket for a generator."""

from __future__ import annotations

import tempfile

import pytest


@pytest.fixture
def endpoint():
    with tempfile.TemporaryDirectory(prefix="mmmd-test-") as folder:
        yield f"ipc://{folder}/gen"
