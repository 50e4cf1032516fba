"""Time from e-stop to torque-off bytes, through a whole daemon, with every core busy; then under disturbances."""

from __future__ import annotations

import math
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from daemon.bench.daemon_rig import busy_cores, percentile, running_daemon
from daemon.bench.estop_disturbed import measure_disturbed
from daemon.bench.estop_rig import CLIENT_PRIORITY
from daemon.bench.report import context
from daemon.client import Client
from daemon.host.realtime import give_back_fifo, take_fifo
from daemon.recording.mcap_reading import read_log
from retarget.robot.loading import load_robot

_METHOD = (
    "mmmd run --bus sim:// while one busy process for each core runs at normal priority; e-stop sent during a motion by a"
    " client that has FIFO priority where permitted, as its own wait for a core is not the daemon's; bus periods from the"
    " moment before it sends to the cycle whose bytes cut torque, rounded up; {} times, the robot reset and armed between."
    " Disturbances: servos behind a tty that outlive the daemon's processes, with FIFO priority for"
    " the kernel's workers that carry a pty's bytes where permitted; the client as before, on ctl alone; from its request"
    " to the instant at which no servo has torque, looked for every 0.5 ms; from_back: from the first bytes of a bus process that"
    " was away"
)


def bench_estop(n: int = 30, seed: int = 0, robot: str = "reference") -> dict[str, Any]:
    """`cycles_max`, `cycles_p95` and milliseconds with all cores busy; `disturbances`, with the sums `lost` and `violations`.

    Args:
        n: e-stops with all cores busy, and in each disturbance.
        seed: seed of the instants.
        robot: name of the robot.
    """
    busy = _measure_busy(n, seed, robot)
    disturbances, violations = measure_disturbed(n, seed, robot)
    return {
        **busy,
        "disturbances": disturbances,
        "lost": sum(one["lost"] for one in disturbances.values()),
        "violations": violations,
        **context(seed, _METHOD.format(n)),
    }


def _measure_busy(n: int, seed: int, robot: str) -> dict[str, Any]:
    rng = np.random.default_rng(seed)
    asked_s: list[float] = []
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "run.mcap"
        with running_daemon(robot, "--log", str(log)) as (client, _), busy_cores():
            take_fifo(CLIENT_PRIORITY)
            with Client(client.endpoints) as urgent:  # its I/O thread inherits the priority
                for i in range(n):
                    urgent.gesture("wave_right" if i % 2 else "wave_left", wait=False)
                    urgent.wait_for("moving", timeout_s=10)
                    time.sleep(float(rng.uniform(0.0, 0.5)))
                    asked_s.append(time.monotonic())
                    urgent.estop(wait=False)
                    urgent.wait_for("estop", timeout_s=5)
                    urgent.reset()
                    urgent.arm()
            give_back_fifo()
        cycles = read_log(log).cycles
    off_s = np.array([c.t_mono_ns * 1e-9 for c in cycles if not c.torque])
    period_s = load_robot(robot).bus.period_s
    took_s = [float(off_s[off_s > t_s][0] - t_s) for t_s in asked_s if (off_s > t_s).any()]
    took_cycles = [math.ceil(t_s / period_s) for t_s in took_s]
    return {
        "cycles_max": max(took_cycles) if len(took_cycles) == n else None,
        "cycles_p95": percentile([float(c) for c in took_cycles], 95),
        "p50_ms": percentile([1e3 * t for t in took_s], 50),
        "max_ms": percentile([1e3 * t for t in took_s], 100),
        "missing": n - len(took_cycles),
        "n": n,
        "robot": robot,
    }
