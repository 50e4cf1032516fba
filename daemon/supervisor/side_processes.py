"""Processes that the robot can do without: the web server, which is started again, and the recorder, which is not."""

from __future__ import annotations

import asyncio
import json
import logging
from collections.abc import Mapping

from daemon.front.front import Front
from daemon.recording.feed import RecorderFeed
from daemon.settings.config import HTTP_ADDRESS, DaemonConfig
from daemon.settings.sources import settings_of
from daemon.shared_memory.bus_link import BusLink
from daemon.supervisor.children import FIRST_BACK_OFF_S, GOOD_LIFE_S, LONGEST_BACK_OFF_S, BackOff, Child

log = logging.getLogger(__name__)


def web_server(config: DaemonConfig, environment: Mapping[str, str]) -> Child:
    """The process that serves HTTP, WebSocket and the page."""
    ends = config.endpoints
    arguments = ["--http", config.http or HTTP_ADDRESS, "--robot", config.robot, *(["--page"] if config.view else [])]
    arguments += ["--cmd", ends.cmd, "--ctl", ends.ctl, "--pub", ends.pub, "--stream", ends.stream]
    arguments += ["--keys", str(ends.keys)] if ends.keys is not None else []
    return Child("web server", "daemon.view.process", arguments, environment)


async def keep_web_server(child: Child) -> None:
    """Start the web server, and start it again whenever it ends."""
    back_off = BackOff(FIRST_BACK_OFF_S, LONGEST_BACK_OFF_S, last_s=FIRST_BACK_OFF_S)
    while True:
        await child.start()
        status = await child.ended()
        wait_s = back_off.after(good=child.lived_s > GOOD_LIFE_S)
        log.error("the web server ended with status %d and starts again in %g s", status, wait_s)
        await asyncio.sleep(wait_s)


def recorder(config: DaemonConfig, link: BusLink, events: str, environment: Mapping[str, str]) -> Child:
    """The process that records cycles from shared memory and the front's events from the endpoint `events`."""
    arguments = ["--robot", config.robot, "--link", str(link.path), "--events", events, "--out", str(config.log)]
    arguments += ["--size-mb", str(config.log_size_mb), "--total-mb", str(config.log_total_mb)]
    arguments += ["--settings", json.dumps(settings_of(config), default=str)]
    return Child("recorder", "daemon.recording.recorder", arguments, environment)


async def record(child: Child, feed: RecorderFeed, front: Front, out: str) -> None:
    """Run the recorder until the end; after it fails, `mmmd status` shows that the robot has no log."""
    await child.start()
    try:
        status = await child.ended()
        front.recording = f"stopped (status {status}): {out}"
        log.error("recording ended with status %d; the robot goes on without a log", status)
    finally:
        await feed.close()
