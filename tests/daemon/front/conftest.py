"""A running daemon, its client and a context of sockets, for the tests of a module."""

from __future__ import annotations

import pytest
import zmq

from tests.support.front_sockets import OPEN
from tests.support.harness import running_daemon


@pytest.fixture(scope="module")
def running():
    with running_daemon() as daemon:
        yield daemon


@pytest.fixture
def robot(running):
    with running.armed() as client:
        yield client


@pytest.fixture
def context():
    made = zmq.Context()
    yield made
    made.destroy(linger=0)
    OPEN.clear()
