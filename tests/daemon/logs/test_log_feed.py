"""Lines of all processes on `v1/log`: handed on in order, never waited for, lost where nobody is there."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import time

import pytest

from daemon.logs.log_feed import EVENT_LOGGER, MOST_BYTES, SOCKET_VARIABLE, LogFeed, LogSender, send_logs
from daemon.wire.status import LogEvent


@contextlib.contextmanager
def sender(path, process: str = "bus"):
    """A logger of its own that sends to `path`."""
    log, handler = logging.Logger("daemon.somewhere"), LogSender(process, str(path))
    log.addHandler(handler)
    try:
        yield log
    finally:
        log.removeHandler(handler)
        handler.close()


async def heard(feed: LogFeed, found: list[LogEvent], act) -> list[LogEvent]:
    """What the feed hands on while `act` is done."""
    feed.start()
    try:
        act()
        await asyncio.sleep(0.05)
    finally:
        feed.close()
    return found


def test_log_lines_come_in_order_with_level_time_and_cause(tmp_path):
    found: list[LogEvent] = []

    def act() -> None:
        logging.getLogger("daemon.front.front").warning("mine %d", 1)
        logging.getLogger(EVENT_LOGGER).warning("said on v1/event already")
        log.info("one")
        try:
            raise OSError("no cable")
        except OSError:
            log.exception("two")

    with sender(tmp_path / "log") as log:
        asyncio.run(heard(LogFeed(tmp_path / "log", found.append), found, act))
    assert [(e.process, e.level, e.text) for e in found] == [
        ("front", "warning", "mine 1"), ("bus", "info", "one"), ("bus", "error", "two (OSError: no cable)"),
    ]  # fmt: skip
    assert all(abs(e.t_mono - time.monotonic()) < 5 for e in found) and found[0].module == "daemon.front.front"


@pytest.mark.timeout(60)
@pytest.mark.parametrize("reader", ["none", "never reads"])
def test_who_logs_waits_for_nobody(tmp_path, reader):
    found: list[LogEvent] = []
    feed = LogFeed(tmp_path / "log", found.append) if reader == "never reads" else None
    with sender(tmp_path / "log") as log:
        for i in range(2000):
            log.warning("line %d %s", i, "x" * 3 * MOST_BYTES)
    if feed is not None:  # it reads only now: what found room is there, the rest was lost and nobody waited
        asyncio.run(heard(feed, found, lambda: None))
        assert [e.text.split()[1] for e in found] == [str(i) for i in range(len(found))] and 0 < len(found) < 2000


def test_a_line_that_cannot_be_written_ends_nobodys_work(tmp_path, capsys):
    found: list[LogEvent] = []

    def act() -> None:
        log.warning("%d", "no number")
        log.warning("half a sign: %s", "\ud800")
        log.warning("after it")

    with sender(tmp_path / "log") as log:
        asyncio.run(heard(LogFeed(tmp_path / "log", found.append), found, act))
    assert [e.text for e in found] == ["after it"]
    assert capsys.readouterr().err.count("--- Logging error ---") == 2


def test_a_datagram_that_is_no_line_is_passed_over(tmp_path):
    found: list[LogEvent] = []
    with sender(tmp_path / "log") as log:
        handler = log.handlers[0]
        assert isinstance(handler, LogSender)

        def act() -> None:
            for data in (b"", b"\xff", b"{}", b"[1]"):
                handler._socket.sendto(data, handler._path)
            log.info("a line of many signs: %s", "\u00e9" * MOST_BYTES)

        asyncio.run(heard(LogFeed(tmp_path / "log", found.append), found, act))
    assert len(found) == 1 and found[0].text.startswith("a line of many signs: \u00e9")


def test_a_process_that_no_daemon_started_sends_nothing(monkeypatch):
    monkeypatch.delenv(SOCKET_VARIABLE, raising=False)
    before = list(logging.getLogger().handlers)
    send_logs("generator")
    assert logging.getLogger().handlers == before
