"""Keeps the bus process: starts it, detects that it is lost or frozen, and starts it again in a latched fault."""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Mapping, Sequence

from daemon.errors import ConfigError, DaemonError
from daemon.front.front import Front
from daemon.settings.config import DaemonConfig
from daemon.shared_memory.bus_link import BusLink, BusState, Readiness
from daemon.shared_memory.request_words import ESTOPS, BusRequest
from daemon.supervisor.children import FIRST_BACK_OFF_S, GOOD_LIFE_S, LONGEST_BACK_OFF_S, BackOff, Child

log = logging.getLogger(__name__)

START_TIMEOUT_S = 20.0
END_TIMEOUT_S = 5.0
FROZEN_S = 2.5
"""Seconds of silence after which the bus process is killed and started again; from 1 s on the robot is in fault."""
FROZEN_IN_AN_ESTOP_S = 1.0
"""Seconds of silence after which the bus process is killed while an e-stop waits for it."""


class BusStartError(DaemonError):
    """The bus process could not open the bus or found other servos; its message says which."""


class BusKeeper:
    """Owns the bus process, from its first start to the shutdown request.

    Attributes:
        child: the process.

    Args:
        config: robot and bus.
        link: shared memory.
        asked_to_end: set when the daemon is asked to end, which breaks off a start.
        environment: environment variables set for the process.
        more: arguments of the process besides robot, bus and shared memory.
    """

    def __init__(
        self,
        config: DaemonConfig,
        link: BusLink,
        asked_to_end: asyncio.Event,
        environment: Mapping[str, str],
        more: Sequence[str] = (),
    ) -> None:
        arguments = ["--robot", config.robot, "--bus", config.bus, "--link", str(link.path), *more]
        self.child = Child("bus process", "daemon.control.process", arguments, environment)
        self._url, self._link, self._asked_to_end = config.bus, link, asked_to_end
        self._ending = False

    async def start(self) -> None:
        """Start the bus process and wait until it has verified the servos.

        Raises:
            ConfigError: the bus process refuses the bus URL.
            BusStartError: the bus process could not open the bus, ended or froze, or the daemon is asked to end.
        """
        self._link.set_ready(Readiness.STARTING)
        await self.child.start()
        end_s = time.monotonic() + START_TIMEOUT_S
        while self._link.readiness is Readiness.STARTING and self.child.running and time.monotonic() < end_s:
            if self._asked_to_end.is_set():
                raise BusStartError("ended while the bus was being opened")
            self._link.heartbeat()
            await asyncio.sleep(0.01)
            frozen_s = self._frozen_s
            if self.child.stopped_s() > frozen_s:
                self.child.kill()
                raise BusStartError(f"the bus process was frozen for {frozen_s:g} s while it started, and is killed")
        if self._link.readiness is Readiness.READY:
            return
        if self._link.readiness is Readiness.REFUSED:
            raise ConfigError(f"--bus {self._url}: {self._link.text}")
        if self._link.readiness is Readiness.FAILED:
            raise BusStartError(self._link.text)
        if not self.child.running:
            status = await self.child.ended()
            raise BusStartError(f"the bus process ended with status {status}; what it printed says why")
        raise BusStartError(f"the bus process did not open {self._url} in {START_TIMEOUT_S:g} s")

    async def keep(self, front: Front) -> None:
        """Start the bus process again whenever it ends, in a latched fault, which a person has to reset."""
        back_off = BackOff(FIRST_BACK_OFF_S, LONGEST_BACK_OFF_S)
        while True:
            status = await self._lost(front)
            if self._ending:
                return
            front.follower.bus_alive = False
            has_lived = self.child.lived_s > GOOD_LIFE_S
            log.error("the bus process ended with status %d; servos that have a bus watchdog stop by it", status)
            await self._wait(back_off.after(good=has_lived), 0.0 if has_lived else FIRST_BACK_OFF_S)
            if self._ending:
                return
            self.child.add_argument("--after-loss")
            try:
                await self.start()
            except (BusStartError, ConfigError) as error:
                log.error("the bus process could not be started again: %s", error)
                continue
            front.view.begin(BusState.FAULT)
            front.follower.bus_alive = True
            log.warning("the bus process runs again, in fault: `mmmd reset`, then `mmmd arm`")

    async def end(self) -> None:
        """Ask the bus process to shut down and wait for its end, which no longer counts as a loss."""
        self._ending = True
        self._link.request(BusRequest.SHUTDOWN)
        await self.child.end(END_TIMEOUT_S, terminate=False)

    async def _wait(self, seconds: float, least_s: float) -> None:
        """Wait before the next start; not longer than `least_s` while an e-stop waits for the bus process."""
        began_s = time.monotonic()
        while (waited_s := time.monotonic() - began_s) < seconds:
            if waited_s >= least_s and self._link.owes(*ESTOPS):
                return
            await asyncio.sleep(0.02)

    @property
    def _frozen_s(self) -> float:
        """Seconds of silence after which the bus process is taken to be frozen."""
        return FROZEN_IN_AN_ESTOP_S if self._link.owes(*ESTOPS) else FROZEN_S

    async def _lost(self, front: Front) -> int:
        """Wait for the end of the bus process, kill a frozen one, and return its exit status."""
        ended = asyncio.create_task(self.child.ended())
        while not ended.done():
            await asyncio.wait({ended}, timeout=0.2)
            if front.view.silent_s > self._frozen_s and not ended.done():
                log.error("the bus process has been silent for %.1f s and is killed", front.view.silent_s)
                self.child.kill()
        return ended.result()
