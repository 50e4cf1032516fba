"""Fixtures of the tests that start whole daemons."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from daemon.client import Client
from tests.support.harness import RunningDaemon
from tests.support.live_page import Page, served_page
from tests.support.robot_states import Servos, SharedDaemon
from tests.support.streaming import leasing_daemon


@pytest.fixture
def servos(tmp_path: Path) -> Iterator[Servos]:
    """A simulated robot behind a tty of its own."""
    made = Servos(tmp_path)
    yield made
    made.close()


@pytest.fixture(scope="module")
def module_daemon(tmp_path_factory: pytest.TempPathFactory) -> Iterator[SharedDaemon]:
    """A daemon on such servos, not yet started; a module that wants options or answers of its own has its own fixture."""
    made = SharedDaemon(tmp_path_factory.mktemp("shared"))
    yield made
    made.close()


@pytest.fixture
def shared(module_daemon: SharedDaemon) -> Iterator[SharedDaemon]:
    """The module's daemon with a limp robot; every limit is kept at the end."""
    yield module_daemon.ready()
    module_daemon.servos.assert_kept()


@pytest.fixture(scope="module")
def running() -> Iterator[RunningDaemon]:
    """A daemon whose leases end soon; its servos are in the bus process."""
    with leasing_daemon() as daemon:
        yield daemon


@pytest.fixture
def robot(running: RunningDaemon) -> Iterator[Client]:
    """A client of that daemon, its robot armed."""
    with running.armed() as client:
        yield client


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    """The web page of a running daemon, in a browser."""
    with served_page(tmp_path_factory.mktemp("log")) as one:
        yield one
