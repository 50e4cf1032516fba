"""A daemon whose leases end soon, and clients that stream to it."""

from __future__ import annotations

import contextlib
import math
import threading
import time
from collections.abc import Iterator, Sequence

from daemon.client import Client
from daemon.client.streams import Stream
from daemon.wire import events as ev
from tests.support.harness import RunningDaemon, running_daemon

PARK_S, LIMP_S = 2.0, 0.4
PERIOD_S = 0.02


@contextlib.contextmanager
def leasing_daemon() -> Iterator[RunningDaemon]:
    """A running daemon; at its end the audit of everything that was sent to its servos (`running_daemon`)."""
    with running_daemon("--lease-park-s", str(PARK_S), "--lease-limp-s", str(LIMP_S)) as daemon:
        yield daemon


def wave(robot: Client, stream: Stream, seconds: float, rad: float = 0.3) -> int:
    """Send a sine of the first joints about the robot's rest; the number of targets."""
    rest, began_s, n = robot.status().goal_rad, time.monotonic(), 0
    while (t_s := time.monotonic() - began_s) < seconds:
        stream.send([q + rad * math.sin(3 * t_s) for q in rest])
        n += 1
        time.sleep(PERIOD_S)
    return n


@contextlib.contextmanager
def fed(stream: Stream, target_rad: Sequence[float]) -> Iterator[None]:
    """A client that goes on sending, however long the body takes."""
    over = threading.Event()

    def feed() -> None:
        while not over.wait(PERIOD_S):
            stream.send(target_rad)

    thread = threading.Thread(target=feed)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


def stages(stream: Stream) -> list[str]:
    return [e.stage for e in stream.news.events if isinstance(e, ev.Progress)]


def lease_is(robot: Client, state: str) -> bool:
    lease = robot.status().stream.lease
    return lease is not None and lease.state == state


def until_still(robot: Client, within_s: float = 3.0) -> list[float]:
    """Wait until two looks show the same goal; the goal."""
    end_s, before = time.monotonic() + within_s, [math.nan]
    while (now := robot.status().goal_rad) != before:
        assert time.monotonic() < end_s, "it still moves"
        before = now
        time.sleep(0.05)
    return before
