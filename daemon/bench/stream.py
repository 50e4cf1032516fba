"""Time from joint target to first moved servo goal, through the whole daemon: ZeroMQ, checks, guard, gate, bytes."""

from __future__ import annotations

import time
from typing import Any

from daemon.bench.daemon_rig import running_daemon
from daemon.bench.report import context, percentiles_ms
from daemon.client import Client
from daemon.wire.events import Progress

REST_S, STEP_RAD, SHOWN_S = 0.15, 0.02, 0.4
_METHOD = (
    "mmmd run --bus sim:// with all its processes, a client in another process, loopback tcp; one lease for each"
    " trial, robot at rest; sent: the clock starts just before the client sends its first target that differs from where the"
    " robot stands (same machine, same clock) and ends at the first bus cycle whose goal tick of any servo differs;"
    " received: it starts when the front has read the target; while the robot moves already, what is in hand of the bus"
    " process (stream_queue_s) is played first"
)


def bench_stream(n: int = 50, seed: int = 0, robot: str = "reference") -> dict[str, Any]:
    """`p50_ms`, `p95_ms` and `n` counted from sending; the same from receiving under `received`."""
    sent_s: list[float] = []
    received_s: list[float] = []
    with running_daemon(robot, "--quiet") as (client, _):
        for i in range(n):
            sent, received = _first_motion(client, STEP_RAD if i % 2 else -STEP_RAD)
            sent_s.append(sent)
            received_s.append(received)
    figures: dict[str, Any] = percentiles_ms(sent_s) | {"n": n, "received": percentiles_ms(received_s)}
    return {**figures, "robot": robot, **context(seed, _METHOD)}


def _first_motion(client: Client, step_rad: float) -> tuple[float, float]:
    """Seconds from sending, and from receiving, to the first moved goal."""
    now = client.status()
    joint = _freest(client)
    target = {now.joint_names[joint]: now.goal_rad[joint] + step_rad}
    with client.stream("bench") as stream:
        time.sleep(REST_S)
        began_s = time.monotonic()
        while time.monotonic() - began_s < SHOWN_S:
            stream.send(target)
            time.sleep(0.02)
    moving = next(e for e in stream.news.events if isinstance(e, Progress) and e.first_motion_ms is not None)
    assert moving.first_motion_ms is not None and moving.target_t_mono is not None, "the joint moved"
    return moving.target_t_mono - began_s + moving.first_motion_ms / 1e3, moving.first_motion_ms / 1e3


def _freest(client: Client) -> int:
    """Index of the joint with the most room on both sides of its position."""
    now = client.status()
    room = [
        min(j.position_max_rad - q, q - j.position_min_rad)
        for j, q in zip(client.capabilities().joints, now.goal_rad, strict=True)
    ]
    return room.index(max(room))
