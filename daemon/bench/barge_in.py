"""Overlapping commands at random instants through a whole daemon: takeover, stops, and that each command ends once."""

from __future__ import annotations

import tempfile
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import zmq

from daemon.bench.daemon_rig import arm_again, percentile, running_daemon
from daemon.bench.report import HostShare, context
from daemon.bench.texts import draw_texts
from daemon.client import Client
from daemon.client.errors import stamp
from daemon.recording.mcap_reading import LoggedCycle, read_log
from daemon.wire.codec import decode_event, encode
from daemon.wire.events import AnyEvent, Failed, Progress
from daemon.wire.requests import Say
from retarget.robot.loading import load_robot

SHORTEST_GAP_S, LONGEST_GAP_S = 0.03, 0.6
STOP_EVERY = 10
STOP_WATCHED_S = 0.6
SEEN_OUT = 0.5
"""Share of its cycles that the bus process must have made for a stop to be judged."""
SETTLED_S = 12.0
STILL_RAD_S = np.deg2rad(2.0)
_METHOD = (
    "mmmd run --bus sim:// with all its processes; texts at random gaps of {:g} to {:g} s, every {}th followed by a stop;"
    " takeover: text received to first changed servo goal of its own plan, of those not overtaken before; stop: ctl request"
    " sent to the cycle from which no joint's goal is faster than 2 deg/s; concurrent: cycles of an older plan after a newer"
    " one; lost stop: a joint still faster than that {:g} s after it; unseen: the bus process made less than half of its cycles in"
    " that time, as where the machine stands still, and whether the robot came to rest is not known"
)


@dataclass
class _Heard:
    """Replies and events received so far."""

    ends: Counter[str] = field(default_factory=Counter[str])
    takeover_ms: list[float] = field(default_factory=list[float])
    fault: str = ""

    def take(self, event: AnyEvent) -> None:
        if isinstance(event, Failed) and event.code == "fault":
            self.fault = event.found
        if event.terminal and event.id:
            self.ends[event.id] += 1
        if isinstance(event, Progress) and event.first_motion_ms is not None:
            self.takeover_ms.append(event.first_motion_ms)


def bench_barge_in(n: int = 1000, seed: int = 0, robot: str = "reference") -> dict[str, Any]:
    """`takeover_p95_ms`, `stop_p95_ms`, `concurrent`, `lost_stops`, `ended_once` (share of the commands).

    Where the machine holds up the bus process, faults follow, which are counted in `faults`, each reset and armed again. A stop
    after which the bus process made less than half of its cycles cannot be judged: `unseen_stops`.
    """
    rng = np.random.default_rng(seed)
    texts = draw_texts(n, seed)
    heard = _Heard()
    stops_s: list[float] = []
    host = HostShare()
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "run.mcap"
        with running_daemon(robot, "--log", str(log)) as (client, _):
            faults = _talk(client, texts, rng, heard, stops_s)
        cycles = read_log(log).cycles
    rate_hz = load_robot(robot).bus.rate_hz
    windows = [[c for c in cycles if t_s - 0.02 <= c.t_mono_ns * 1e-9 <= t_s + STOP_WATCHED_S] for t_s in stops_s]
    seen = [len(window) >= SEEN_OUT * STOP_WATCHED_S * rate_hz for window in windows]
    stop_s = [_still_after_s(w, t_s, rate_hz) for w, t_s, full in zip(windows, stops_s, seen, strict=True) if full]
    plans = np.array([c.plan_id for c in cycles])
    played = plans[plans > 0]
    concurrent = int((played < np.maximum.accumulate(played)).sum()) if len(played) else 0
    return {
        "takeover_p50_ms": percentile(heard.takeover_ms, 50),
        "takeover_p95_ms": percentile(heard.takeover_ms, 95),
        "stop_p95_ms": percentile([1e3 * s for s in stop_s if s is not None], 95),
        "concurrent": concurrent,
        "lost_stops": sum(s is None for s in stop_s),
        "unseen_stops": seen.count(False),
        "ended_once": round(sum(heard.ends[f"b{i}"] == 1 for i in range(n)) / n, 6),
        "ended_more_than_once": sum(k > 1 for k in heard.ends.values()),
        "n": n,
        "stops": len(stops_s),
        "moved": len(heard.takeover_ms),
        "faults": faults,
        **host.figures(),
        "robot": robot,
        **context(seed, _METHOD.format(SHORTEST_GAP_S, LONGEST_GAP_S, STOP_EVERY, STOP_WATCHED_S)),
    }


def _talk(client: Client, texts: list[str], rng: np.random.Generator, heard: _Heard, stops_s: list[float]) -> list[str]:
    """Say all texts, stop at random, receive events to the end; return the reasons of faults."""
    faults: list[str] = []
    context_: zmq.Context[zmq.Socket[bytes]] = zmq.Context()
    socket = context_.socket(zmq.DEALER)
    socket.connect(client.endpoints.cmd)

    def listen(seconds: float, until_all: int = 0) -> None:
        end_s = time.monotonic() + seconds
        while (left_s := end_s - time.monotonic()) > 0 and not (until_all and len(heard.ends) >= until_all):
            if socket.poll(max(1, int(1e3 * left_s))):
                heard.take(decode_event(socket.recv()))

    try:
        for i, text in enumerate(texts):
            seed = int(rng.integers(0, 2**31))  # pyright: ignore[reportUnknownArgumentType]
            said = Say(id=f"b{i}", text=text, seed=seed)
            stamp(said)
            socket.send(encode(said))
            listen(float(rng.uniform(SHORTEST_GAP_S, LONGEST_GAP_S)))
            if heard.fault:
                faults.append(heard.fault)
                arm_again(client)
                heard.fault = ""
            if i % STOP_EVERY == STOP_EVERY - 1:
                stops_s.append(time.monotonic())
                client.stop(wait=False)
                listen(STOP_WATCHED_S)
        listen(SETTLED_S, until_all=len(texts))
        listen(0.2)
    finally:
        context_.destroy(linger=0)
    return faults


def _still_after_s(window: list[LoggedCycle], t_s: float, rate_hz: float) -> float | None:
    """Seconds from `t_s` until no joint is faster than 2 deg/s for the rest of the watched time; None when a joint stays faster."""
    goals_rad = np.array([c.goal_rad for c in window], np.float64)
    speed = np.abs(np.diff(goals_rad, axis=0)).max(1) * rate_hz
    fast = np.flatnonzero(speed > STILL_RAD_S)
    if not len(fast):
        return 0.0
    if fast[-1] == len(speed) - 1:
        return None
    return max(0.0, window[int(fast[-1]) + 1].t_mono_ns * 1e-9 - t_s)
