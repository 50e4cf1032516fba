"""The web server in a process of its own, so that the page's load does not reach the bus.

`python -m daemon.view.process --http HOST:PORT [--page] [--robot R] [--run F.mcap] --cmd E --ctl E --pub E --stream E [--keys D]`
"""

from __future__ import annotations

import argparse
import asyncio
import logging
import os
import secrets
import signal
import sys
import webbrowser
from pathlib import Path

from daemon.errors import DaemonError
from daemon.host.parent import Parent
from daemon.logs.log_lines import start_logging
from daemon.network.web_access import TOKEN_VARIABLE, Access, address_of, is_loopback
from daemon.settings.config import Endpoints
from retarget.errors import RetargetError
from retarget.robot.loading import list_robots, load_robot

log = logging.getLogger(__name__)

NICENESS = 5
"""Niceness of the page's server, which gives way to the robot's processes."""
PARENT_CHECK_S = 0.5


def main() -> int:
    """Serve until SIGTERM or the daemon's death; return 0, or 2 when the address cannot be bound."""
    parser = argparse.ArgumentParser(description="the web server of mmmd; started by `mmmd run --view` and `mmmd view`")
    parser.add_argument("--http", required=True)
    parser.add_argument("--page", action="store_true")
    parser.add_argument("--robot", default="")
    parser.add_argument("--run", type=Path)
    for name in ("cmd", "ctl", "pub", "stream"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--keys", type=Path)
    given = parser.parse_args()
    start_logging("web")
    os.nice(NICENESS)
    ends = Endpoints(given.cmd, given.ctl, given.pub, given.keys, given.stream)
    try:
        asyncio.run(serve(given.http, ends, given.robot or None, given.run, page=given.page, parent=Parent()))
    except (DaemonError, RetargetError) as error:
        log.error("%s", error)
        return 2
    except KeyboardInterrupt:
        pass
    return 0


async def serve(
    address: str,
    ends: Endpoints,
    robot: str | None,
    run: Path | None,
    *,
    page: bool,
    parent: Parent | None = None,
    open_page: bool = False,
) -> None:
    """Serve one daemon, or a recorded run, until SIGTERM, Ctrl-C or the end of the process that started this one.

    Args:
        address: HOST:PORT; beyond loopback it takes the token of $MMMD_TOKEN, or one that is made and printed.
        ends: endpoints of the daemon.
        robot: name or robot.toml of the daemon's robot, or of the run; None for one that ships.
        run: .mcap to scrub through; None for the daemon alone.
        page: whether the page is served beside the messages.
        parent: process with which this one ends; None for none.
        open_page: open the page in a browser.

    Raises:
        ConfigError: the address cannot be bound.
        LogError, RobotFileError: the run or the robot cannot be read.
    """
    from daemon.view.recorded_run import recorded_run
    from daemon.view.robot_shapes import robot_shapes
    from daemon.view.server import WebServer

    host, port = address_of(address)
    token = os.environ.get(TOKEN_VARIABLE) or ("" if is_loopback(host) else secrets.token_urlsafe(24))
    shapes: dict[str, bytes] = {}
    recorded = None
    if run is not None:
        model, recorded = recorded_run(run, robot)
        shapes[model.name] = robot_shapes(model)
    server = WebServer(Access(host, port, token), ends, shapes, page=page, run=recorded)
    server.bind()
    if page and run is None:
        for name in [robot] if robot else list_robots():
            model = load_robot(name)
            shapes[model.name] = robot_shapes(model)
    sys.stdout.write(f"{'page' if page else 'HTTP and WebSocket'} at {server.access.url}\n")
    sys.stdout.flush()
    if open_page:
        webbrowser.open(server.access.url)
    serving = asyncio.create_task(server.serve())
    loop = asyncio.get_running_loop()
    for number in (signal.SIGTERM, signal.SIGINT):
        loop.add_signal_handler(number, serving.cancel)
    while not serving.done() and not (parent is not None and parent.gone):
        await asyncio.wait({serving}, timeout=PARENT_CHECK_S)
    serving.cancel()
    await asyncio.gather(serving, return_exceptions=True)


if __name__ == "__main__":
    sys.exit(main())
