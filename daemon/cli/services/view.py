"""`mmmd view`: the web page of a running daemon, or of a recorded run."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import tyro
from tyro.conf import OmitArgPrefixes

from daemon.cli.connection import Connection
from daemon.settings.config import HTTP_ADDRESS


def view(
    run: Annotated[Path | None, tyro.conf.Positional] = None,
    http: str = HTTP_ADDRESS,
    robot: str | None = None,
    open: bool = False,
    at: OmitArgPrefixes[Connection] = Connection(),  # noqa: B008
) -> int:
    """Serve a web page that shows robot and person in 3D, takes texts, and stops the robot; until Ctrl-C.

    Without RUN it shows a daemon, which may start later and end earlier. `mmmd run --view` serves the same page. Other machines
    reach it with --http 0.0.0.0:5880, by a token that is made and printed with the address ($MMMD_TOKEN sets your own); it goes
    over the network unencrypted, so do this in a network that you trust.

    Example: mmmd view

    Example: mmmd view run.mcap

    Args:
        run: MCAP of `mmmd run --log` to scrub through, in place of a daemon.
        http: HOST:PORT to serve at.
        robot: name or robot.toml; the daemon's own when it ships with mmmd, or the run's.
        open: open the page in a browser.
        at: where the daemon is.
    """
    import asyncio
    import logging

    from daemon.view.process import serve

    logging.basicConfig(level=logging.INFO, format="view: %(message)s")
    asyncio.run(serve(http, at.endpoints, robot, run, page=True, open_page=open))
    return 0
