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

if TYPE_CHECKING:
    from mmm_core.generate.engine import Engine

# No timed assertions: machines are shared and noisy; speed lives in `mmmd bench`.
settings.register_profile("mmmd", deadline=None, max_examples=34, derandomize=True)
settings.register_profile("soak", deadline=None, max_examples=100)
settings.load_profile("mmmd")

WATCH = pytest.StashKey[HostWatch]()
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
    if config.getoption("--void-when-held-up"):
        config.stash[WATCH] = HostWatch().start()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Files with whole daemons first: they take longest and mostly wait; what only computes fills the processors at the end.

    In a file the tests that share something come last: a daemon that they share would run while the others wait.
    """
    waiting = {item.path for item in items if item.get_closest_marker("realtime")}
    gc.freeze()
    gc.enable()
    place = {path: k for k, path in enumerate(dict.fromkeys(item.path for item in items))}
    items.sort(
        key=lambda item: (
            item.path not in waiting, "end_to_end" not in item.path.parts, place[item.path], _shares(item)
        )
    )  # fmt: skip


def _shares(item: pytest.Item) -> bool:
    """Whether a test uses a fixture of its module."""
    if not isinstance(item, pytest.Function):
        return False
    known = item._fixtureinfo.name2fixturedefs  # pytest tells the scope of a fixture nowhere else
    return any(fixture.scope == "module" for found in known.values() for fixture in found)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    watch = item.config.stash.get(WATCH, None)
    if watch is not None and item.get_closest_marker("realtime"):
        watch.wait_until_still()
        item.stash[BEGAN] = time.monotonic()
        module = item.getparent(pytest.Module)
        assert module is not None
        module.stash.setdefault(BEGAN, item.stash[BEGAN])


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
