"""Keeps the ctl process: starts it, detects that it is lost or frozen, and starts it again. Part of the supervisor."""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Callable, Mapping

from daemon.ctl.channel import Channel, Ready, pair
from daemon.errors import ConfigError, DaemonError
from daemon.settings.config import DaemonConfig, EndpointInUseError
from daemon.shared_memory.bus_link import BusLink
from daemon.shared_memory.heartbeat import HeartbeatWatch
from daemon.supervisor.children import BackOff, Child
from retarget.robot.robot import RobotModel

log = logging.getLogger(__name__)

START_TIMEOUT_S = 20.0
LOOK_S = 0.04
"""Seconds between two readings of the ctl process's heartbeat."""
SILENT_S = 0.2
"""Seconds without a heartbeat after which the ctl process is killed; the bus process has entered an e-stop by then."""
FIRST_BACK_OFF_S, LONGEST_BACK_OFF_S = 0.1, 5.0
END_S = 2.0


class CtlStartError(DaemonError):
    """The ctl process could not be started."""


class CtlKeeper:
    """Owns the ctl process through all its starts.

    Args:
        config: endpoint and keys of `ctl`.
        robot: the robot.
        link: shared memory.
        environment: environment variables set for the process.
    """

    def __init__(self, config: DaemonConfig, robot: RobotModel, link: BusLink, environment: Mapping[str, str]) -> None:
        self._link, self._environment = link, environment
        self._arguments = ["--endpoint", config.endpoints.ctl, "--link", str(link.path)]
        self._arguments += ["--joints", str(robot.n_joints), "--servos", str(robot.n_servos)]
        if config.endpoints.keys is not None:
            self._arguments += ["--keys", str(config.endpoints.keys)]
        self._child: Child | None = None

    async def start(self) -> Channel:
        """Start the ctl process; returns the channel to it once it serves.

        Raises:
            ConfigError: the endpoint cannot be bound.
            CtlStartError: the process ended, or did not begin to serve in time.
        """
        ours, theirs = pair()
        with theirs:
            arguments = [*self._arguments, "--channel", str(theirs.fileno())]
            self._child = child = Child("ctl process", "daemon.ctl.process", arguments, self._environment)
            await child.start(pass_fds=(theirs.fileno(),))
        channel = Channel(ours)
        end_s = time.monotonic() + START_TIMEOUT_S
        while time.monotonic() < end_s:
            message = channel.receive()
            if isinstance(message, Ready):
                if message.failed:
                    channel.close()
                    raise EndpointInUseError(message.failed) if message.in_use else ConfigError(message.failed)
                return channel
            if channel.closed:
                break
            await asyncio.sleep(0.01)
        channel.close()
        child.kill()
        raise CtlStartError(f"the process that takes e-stops did not start (status {await child.ended()})")

    async def keep(self, attach: Callable[[Channel], None]) -> None:
        """Start the ctl process again whenever it ends or freezes, and call `attach` with the new channel."""
        back_off = BackOff(FIRST_BACK_OFF_S, LONGEST_BACK_OFF_S)
        while True:
            assert self._child is not None, "not started"
            status = await self._lost(self._child)
            log.error("the ctl process ended with status %d, which is an e-stop; it is started again", status)
            await asyncio.sleep(back_off.after(good=self._child.lived_s > LONGEST_BACK_OFF_S))
            try:
                attach(await self.start())
            except DaemonError as error:
                log.error("%s", error)
                continue
            log.warning("the ctl process serves again: `mmmd reset`, then `mmmd arm`")

    async def close(self) -> None:
        """End the ctl process."""
        if self._child is not None:
            await self._child.end(END_S)

    async def _lost(self, child: Child) -> int:
        """Wait for the end of the process, kill a frozen one, and return its exit status."""
        silence, ended = HeartbeatWatch(SILENT_S, LOOK_S), asyncio.create_task(child.ended())
        while not ended.done():
            await asyncio.wait({ended}, timeout=LOOK_S)
            if silence.lasts(self._link.ctl_beat) and not ended.done():
                log.error("the ctl process has been silent for %g s and is killed", SILENT_S)
                child.kill()
                break
        return await ended
