"""Time from text to first moving servo frame, warm, through the whole daemon: ZeroMQ, generator, retargeting, gate, bytes."""

from __future__ import annotations

import contextlib
import subprocess
import sys
import tempfile
import time
from collections.abc import Generator, Sequence
from pathlib import Path
from typing import Any

from daemon.bench.daemon_rig import HALTED, arm_again, busy_cores, running_daemon
from daemon.bench.report import HostShare, context, percentiles_ms
from daemon.bench.texts import draw_texts
from daemon.client import Client
from daemon.demo.main_job import free_endpoints
from daemon.errors import DaemonError
from daemon.network.keys import KeyFolder
from daemon.wire.events import Cancelled, Done, Failed, Progress, Rejected
from daemon.wire.requests import Say

N_WARM = 5
REST_S = 0.3
STORY_S = 1.0
"""Seconds that a story is played before a text interrupts it."""
_STORY = ("wave with your right hand", "clap your hands", "nod twice", "bow")
_METHOD = (
    "mmmd run --bus sim:// with all its processes; the clock starts when the front receives the text and ends when the"
    " goals of the first bus cycle in which the goal tick of any servo differs are given to the port; from rest: the robot stands"
    " still; idle: idle movements are going on; during: a motion is being played; story: a story without end is being told;"
    " loaded: from rest, while one busy process for each core runs at normal priority;"
    " remote: from rest, generator in another process over loopback TCP with CURVE; {} texts before to warm up; faults, where the"
    " machine holds the bus process up, are told, reset and armed again; host_took: the share of processor time that a virtual"
    " machine's host took meanwhile"
)


def bench_first_motion(n: int = 50, seed: int = 0, robot: str = "reference") -> dict[str, Any]:
    """`p50_ms`, `p95_ms` and `n` from rest; the same under `idle`, `during`, `story`, `loaded` and `remote`."""
    texts = draw_texts(N_WARM + n, seed)
    with running_daemon(robot, "--quiet") as (client, _):
        _times(client, texts[:N_WARM], seed, "warm")
        rest = _times(client, texts[N_WARM:], seed, "rest")
        during = _times(client, texts[N_WARM:], seed, "during", stop=False)
        client.stop()
        story = _times(client, texts[N_WARM:], seed, "story", stop=False, before=_STORY)
        client.stop()
        if client.status().state in HALTED:
            arm_again(client)
        client.idle(True, "lively")
        idle = _times(client, texts[N_WARM:], seed, "idle", cancel=False)
        client.idle(False)
        with busy_cores():
            loaded = _times(client, texts[N_WARM:], seed, "loaded")
    with _remote_generator() as options, running_daemon(robot, "--quiet", *options) as (client, _):
        _times(client, texts[:N_WARM], seed, "warm")
        remote = _times(client, texts[N_WARM:], seed, "remote")
    return {
        **rest,
        "idle": idle,
        "during": during,
        "story": story,
        "loaded": loaded,
        "remote": remote,
        "robot": robot,
        **context(seed, _METHOD.format(N_WARM)),
    }


def from_rest(client: Client, texts: list[str], seed: int, name: str) -> dict[str, Any]:
    """`p50_ms`, `p95_ms` and `n` of texts said while the robot stands still."""
    return _times(client, texts, seed, name)


def _times(
    client: Client,
    texts: list[str],
    seed: int,
    name: str,
    *,
    stop: bool = True,
    cancel: bool = True,
    before: Sequence[str] = (),
) -> dict[str, Any]:
    """Say each text: with `stop` at rest, else while the text before is played, or (without `cancel`) once it idles.

    With `before` each text interrupts a story of these scenes.
    """
    first_s: list[float] = []
    generate_s: list[float] = []
    refused: dict[str, str] = {}
    faults: list[str] = []
    host = HostShare()
    for i, text in enumerate(texts):
        if client.status().state in HALTED:  # a fault or e-stop came while the text before was played
            faults.append(f"after text {i}")
            arm_again(client)
        try:
            if before:
                client.story(before, loop=True, seed=seed + i, wait=False)
                client.wait_for("moving", timeout_s=10)
                time.sleep(STORY_S)
            first_ms, generate_ms, reason = _first_motion(client, f"{name}-{i}", text, seed + i)
            if first_ms is None:
                refused[text] = reason
            else:
                first_s.append(first_ms / 1e3)
                generate_s.append(generate_ms / 1e3)
            if not cancel:
                client.wait_for("idle", timeout_s=15)
                time.sleep(1.2)
            elif stop:
                client.stop()
                client.wait_for("idle", "holding", timeout_s=10)
                time.sleep(REST_S)
            else:
                time.sleep(REST_S)
        except DaemonError as error:
            if client.status().state not in HALTED:
                raise
            faults.append(str(error))
            arm_again(client)
    if not first_s:
        raise RuntimeError(f"no text moved the robot ({name}): {refused}")
    figures: dict[str, Any] = percentiles_ms(first_s) | {"n": len(first_s), "generate": percentiles_ms(generate_s)}
    figures |= host.figures() | ({"faults": faults} if faults else {})
    return figures | ({"without_motion": refused} if refused else {})


def _first_motion(client: Client, command_id: str, text: str, seed: int) -> tuple[float | None, float, str]:
    """Milliseconds to the first moving frame (None when nothing moved), milliseconds in the generator, and why nothing moved."""
    generate_ms, reason = 0.0, "no end was told"
    for event in client.events_of(Say(id=command_id, text=text, seed=seed)):
        generate_ms = getattr(event, "generate_ms", generate_ms)
        if isinstance(event, Progress | Done) and event.first_motion_ms is not None:
            return event.first_motion_ms, generate_ms, ""
        if isinstance(event, Rejected | Failed | Cancelled | Done):
            reason = str(event)
            break
    return None, generate_ms, reason


@contextlib.contextmanager
def _remote_generator() -> Generator[list[str]]:
    """Run a generator behind keys; yield the options with which a daemon uses it."""
    with tempfile.TemporaryDirectory() as folder:
        server, board = KeyFolder(Path(folder) / "server"), KeyFolder(Path(folder) / "board")
        server.allow("board", board.new().public.decode())
        board.trust("generator", server.new().public.decode())
        public = board.own().public.decode()
        board.trust("daemon", public)
        board.allow("bench", public)
        address = free_endpoints().cmd
        command = [sys.executable, "-m", "daemon.cli", "generator", "--bind", address, "--keys", str(server.path)]
        process = subprocess.Popen(command, stderr=subprocess.DEVNULL)
        try:
            yield ["--generator", address, "--keys", str(board.path)]
        finally:
            process.terminate()
            process.wait(10)
