"""Settings for all tests."""

from __future__ import annotations

import gc
import signal
import time
from collections.abc import Generator
from typing import TYPE_CHECKING

import pytest
from hypothesis import settings

from tests.host_watch import HostWatch
from tests.realtime_turn import RealtimeTurn, processors

if TYPE_CHECKING:
    from mmm_core.generate.engine import Engine

# No timed assertions: machines are shared and noisy; speed lives in `mmmd bench`.
settings.register_profile("mmmd", deadline=None, max_examples=34, derandomize=True)
settings.register_profile("soak", deadline=None, max_examples=100)
settings.load_profile("mmmd")

WATCH = pytest.StashKey[HostWatch]()
TURN = pytest.StashKey[RealtimeTurn]()
BEGAN = pytest.StashKey[float]()


@pytest.fixture(scope="session")
def engine() -> Engine:
    """The shipped model, as it is: a test that changes it loads its own."""
    from tests.support.shipped import shipped_engine  # PyTorch is loaded where a test needs it

    return shipped_engine()


def pytest_addoption(parser: pytest.Parser) -> None:
    text = "a realtime test that fails while the machine stands still is void: skipped, with the reason"
    parser.addoption("--void-when-held-up", action="store_true", help=text)


def pytest_configure(config: pytest.Config) -> None:
    gc.disable()  # collecting makes a million objects that all stay: looking for rubbish among them takes an eighth of its time
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # a suite in the background hands that on to its children
        signal.signal(signal.SIGINT, signal.default_int_handler)
    if hasattr(config, "workerinput"):
        config.stash[TURN] = RealtimeTurn(config.workerinput["testrunuid"], processors())
    if config.getoption("--void-when-held-up"):
        config.stash[WATCH] = HostWatch().start()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Files in real time, which wait for turns, between files that only compute, so that processors are never without work.

    In a file the tests that share something come last: a daemon that they share would run while the others wait.
    """
    waiting = {item.path for item in items if item.get_closest_marker("realtime")}
    gc.freeze()
    gc.enable()
    files = dict.fromkeys(item.path for item in items)
    first = sorted((f for f in files if f in waiting), key=lambda f: "end_to_end" not in f.parts)
    others = [f for f in files if f not in waiting]
    # The number of a file among its kind, as a share: half of both kinds come in the first half.
    place = {f: (k / len(kind), kind is others) for kind in (first, others) for k, f in enumerate(kind)}
    items.sort(key=lambda item: (place[item.path], _shares(item)))


def _shares(item: pytest.Item) -> bool:
    """Whether a test uses a fixture of its module."""
    if not isinstance(item, pytest.Function):
        return False
    known = item._fixtureinfo.name2fixturedefs  # pytest tells the scope of a fixture nowhere else
    return any(fixture.scope == "module" for found in known.values() for fixture in found)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    if (turn := item.config.stash.get(TURN, None)) and item.get_closest_marker("realtime"):
        turn.take()
    watch = item.config.stash.get(WATCH, None)
    if watch is not None and item.get_closest_marker("realtime"):
        watch.wait_until_still()
        item.stash[BEGAN] = time.monotonic()
        module = item.getparent(pytest.Module)
        assert module is not None
        module.stash.setdefault(BEGAN, item.stash[BEGAN])


@pytest.hookimpl(trylast=True)
def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> None:
    """A file keeps its turn to its end: what its tests share works on between them."""
    if (turn := item.config.stash.get(TURN, None)) and (nextitem is None or nextitem.path != item.path):
        turn.give_back()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[None]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    report = yield
    if report.failed:  # what it has left open must not fail the test in which it is collected
        item.config.addinivalue_line("filterwarnings", "ignore::ResourceWarning")
    watch = item.config.stash.get(WATCH, None)
    if watch is not None and report.failed and call.excinfo is not None and BEGAN in item.stash:
        module = item.getparent(pytest.Module)
        # What a module shares is judged at its end, by all that happened to it.
        since_s = module.stash[BEGAN] if report.when == "teardown" and module else item.stash[BEGAN]
        pause_s = watch.longest_s(since_s)
        if pause_s:
            found = call.excinfo.exconly().partition("\n")[0]
            reason = f"void: the machine stood still for {pause_s:.2f} s meanwhile; {found}"
            report.outcome = "skipped"
            report.longrepr = (str(item.path), item.location[1] or 0, reason)
    return report
