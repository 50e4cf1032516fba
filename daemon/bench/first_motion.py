"""Text to first moving servo frame, warm, through the whole daemon: ZeroMQ, generator, retargeting, gate, bytes."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path
from typing import Any

from daemon.bench.report import context, percentiles_ms
from daemon.bench.texts import draw_texts
from daemon.client import Client
from daemon.demo import child, free_endpoints, wait_until_ready
from daemon.events import Done, Failed, Progress, Rejected
from daemon.requests import Say

N_WARM = 5
REST_S = 0.3
_METHOD = (
    "mmmd run --bus sim:// with all its processes; each text sent at rest, its clock starts when the front receives it and"
    " ends at the first bus cycle whose goal tick of any servo differs; stopped after that; {} texts before to warm up"
)


def bench_first_motion(n: int = 50, seed: int = 0, robot: str = "reference") -> dict[str, Any]:
    """`p50_ms`, `p95_ms` and `n`, from idle; stages of the median text beside them."""
    texts = draw_texts(N_WARM + n, seed)
    first_s: list[float] = []
    generate_s: list[float] = []
    refused: list[str] = []
    endpoints = free_endpoints()
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "daemon.log"
        ends = ["--cmd", endpoints.cmd, "--ctl", endpoints.ctl, "--pub", endpoints.pub]
        with (
            child(["run", "--robot", robot, "--bus", "sim://", "--quiet", *ends], log) as process,
            Client(endpoints) as client,
        ):
            wait_until_ready(client, process, log)
            client.arm()
            for i, text in enumerate(texts):
                first_ms, generate_ms = _first_motion(client, f"bench-{i}", text, i)
                if first_ms is None:
                    refused.append(text)
                elif i >= N_WARM:
                    first_s.append(first_ms / 1e3)
                    generate_s.append(generate_ms / 1e3)
                client.stop()
                client.wait_for("idle", "holding", timeout_s=10)
                time.sleep(REST_S)
            client.park()
    if not first_s:
        raise RuntimeError(f"no text moved the robot; refused: {refused}")
    return {
        **percentiles_ms(first_s),
        "n": len(first_s),
        "generate": percentiles_ms(generate_s),
        "without_motion": refused,
        "robot": robot,
        **context(seed, _METHOD.format(N_WARM)),
    }


def _first_motion(client: Client, command_id: str, text: str, seed: int) -> tuple[float | None, float]:
    """Milliseconds to the first moving frame (None when nothing moved) and spent in the generator."""
    generate_ms = 0.0
    for event in client.events_of(Say(id=command_id, text=text, seed=seed)):
        generate_ms = getattr(event, "generate_ms", generate_ms)
        if isinstance(event, Progress | Done) and event.first_motion_ms is not None:
            return event.first_motion_ms, generate_ms
        if isinstance(event, Rejected | Failed):
            break
    return None, generate_ms
