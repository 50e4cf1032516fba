"""Several simulated robots with one generator: `python docs/examples/several_robots.py reference op3` starts and ends all.

The motion model takes most of the memory and of the processor; a daemon without one of its own runs on a small board. Over a
network, with keys (`mmmd keys --help`), the generator and each robot are started by

    mmmd generator --bind tcp://0.0.0.0:5874 --keys ~/.config/mmmd/keys
    mmmd run --robot op3 --bus dxl:///dev/ttyUSB0 --generator tcp://HOST:5874 --keys ~/.config/mmmd/keys

Each robot has its own sockets, limits and stop. One text and seed give all of them one motion; each shows it with its own joints.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import subprocess
import sys
import tempfile
import time

from daemon.client import AsyncClient, NoAnswerError
from daemon.errors import DaemonError
from daemon.settings.config import Endpoints

MMMD = [sys.executable, "-m", "daemon.cli"]
START_S = 120.0
"""Seconds within which generator and robots have to be ready."""


async def until_ready(robot: AsyncClient, name: str) -> None:
    """Wait until a daemon answers and has found the generator.

    Raises:
        TimeoutError: not in `START_S` seconds.
    """
    end_s = time.monotonic() + START_S
    while time.monotonic() < end_s:
        with contextlib.suppress(NoAnswerError):
            if (await robot.status()).generator.startswith("ready"):
                return
        await asyncio.sleep(0.2)
    raise TimeoutError(f"{name} was not ready in {START_S:g} s")


async def show(robot: AsyncClient, name: str, text: str) -> None:
    """Say a text to one robot, and print what was seen on it, or why it does not show it."""
    try:
        done = (await robot.say(text, seed=1)).done
        print(f"{name}: {done.seen} ({done.shown})" if done else f"{name}: stopped", flush=True)
    except DaemonError as refused:
        print(f"{name}: {refused}", flush=True)


async def main() -> None:
    """Start a generator and the robots, let them move at the same time, and park them."""
    parser = argparse.ArgumentParser(description="several robots with one generator")
    parser.add_argument(
        "robots", nargs="+", help="names of packaged robots, or paths of a robot.toml; one may come twice"
    )
    parser.add_argument("--text", default="wave with your right hand")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="robots-") as folder, contextlib.ExitStack() as processes:

        def start(*arguments: str) -> None:
            process = processes.enter_context(subprocess.Popen([*MMMD, *arguments]))
            processes.callback(process.terminate)  # comes before its context's end, which waits: the robot parks

        generator = f"ipc://{folder}/generator"
        start("generator", "--bind", generator)
        async with contextlib.AsyncExitStack() as clients:
            names, robots = [f"{name}[{k}]" for k, name in enumerate(given.robots)], list[AsyncClient]()
            for k, name in enumerate(given.robots):
                at = Endpoints(f"ipc://{folder}/{k}.cmd", f"ipc://{folder}/{k}.ctl", f"ipc://{folder}/{k}.pub")
                sockets = ("--cmd", at.cmd, "--ctl", at.ctl, "--pub", at.pub, "--stream", at.stream)
                start("run", "--robot", name, "--bus", "sim://", "--generator", generator, "--quiet", *sockets)
                robots.append(await clients.enter_async_context(AsyncClient(at)))
            await asyncio.gather(*(until_ready(*both) for both in zip(robots, names, strict=True)))
            await asyncio.gather(*(show(*both, given.text) for both in zip(robots, names, strict=True)))


if __name__ == "__main__":
    asyncio.run(main())
