"""Starts the daemon's processes in their order, watches them, parks the robot at the end.

The daemon needs front, bus process (`bus_keeper.py`) and ctl process (`ctl_keeper.py`); a generator that dies or freezes is
started again while the robot holds (`generator_keeper.py`); web server and recorder are extras (`side_processes.py`).
"""

from __future__ import annotations

import asyncio
import gc
import logging
import signal

import zmq
import zmq.asyncio

from daemon.ctl.channel import Channel
from daemon.front.front import Front
from daemon.front.metrics import MetricsServer, exposition
from daemon.generator.client import GeneratorClient
from daemon.host.cores import CoreClaim
from daemon.host.notify import Notifier
from daemon.host.realtime import BUS_PRIORITY, may_fifo
from daemon.logs.log_feed import SOCKET_VARIABLE, LogFeed
from daemon.network.keys import KeyFolder
from daemon.recording.feed import RecorderFeed
from daemon.settings.config import DaemonConfig
from daemon.shared_memory.bus_link import BusLink
from daemon.shared_memory.request_words import BusRequest
from daemon.state.machine import RobotState
from daemon.supervisor.bus_keeper import END_TIMEOUT_S, BusKeeper
from daemon.supervisor.children import Child
from daemon.supervisor.ctl_keeper import CtlKeeper
from daemon.supervisor.generator_keeper import GeneratorKeeper
from daemon.supervisor.run_folder import RunFolder
from daemon.supervisor.side_processes import keep_web_server, record, recorder, web_server
from daemon.supervisor.start_checks import check_config
from retarget.robot.loading import load_robot
from retarget.robot.robot import RobotModel

log = logging.getLogger(__name__)

GOOD, ROBOT_FAULT = 0, 3
"""Exit statuses: after parking, and when the robot was left in a latched fault or e-stop."""


class Supervisor:
    """Runs one daemon, from start to park."""

    def __init__(self, config: DaemonConfig) -> None:
        check_config(config)
        self._config = config
        self._robot: RobotModel = load_robot(config.robot)
        self._link = BusLink.create(self._robot.n_joints, self._robot.n_servos)
        self._folder = RunFolder()
        self._context = zmq.asyncio.Context()
        self._children: list[Child] = []
        self._tasks: list[asyncio.Task[None]] = []
        self._asked_to_end = asyncio.Event()
        self._notifier = Notifier()
        self._metrics: MetricsServer | None = None
        # A process at normal priority is not kept to one core: that would keep it from going where there is room.
        self._core = CoreClaim() if may_fifo(BUS_PRIORITY) else CoreClaim(frozenset())
        core = ["--core", str(self._core.core)] if self._core.core is not None else []
        self._log_path = self._folder.path / "log"
        self._environment = {SOCKET_VARIABLE: str(self._log_path)}
        self._link.set_estop_holds(config.estop == "hold")
        self._ctl = CtlKeeper(config, self._robot, self._link, self._environment)
        self._bus = BusKeeper(config, self._link, self._asked_to_end, self._environment, core)

    async def run(self) -> int:
        """Serve until SIGTERM or SIGINT; returns 0 after parking, 3 when the robot was left in a latched fault or e-stop.

        Raises:
            DaemonError: a port is taken, the bus cannot be opened, or other servos were found.
        """
        try:
            endpoint = self._config.generator or f"ipc://{self._folder.path}/generator"
            keys = KeyFolder(self._config.endpoints.keys) if self._config.endpoints.keys is not None else None
            client = GeneratorClient(self._context, endpoint, keys, self._config.model_hash)
            feed = RecorderFeed(f"ipc://{self._folder.path}/events") if self._config.log else None
            front = Front(self._config, self._robot, self._link, self._context, client, feed)
            return await self._serve(front, GeneratorKeeper(self._config, client, endpoint, self._environment), feed)
        finally:
            for task in self._tasks:
                task.cancel()
            await asyncio.gather(*self._tasks, return_exceptions=True)
            for child in reversed(self._children):
                await child.end(END_TIMEOUT_S)
            await self._ctl.close()  # last: it takes e-stops as long as a bus process can carry them out
            self._context.destroy(linger=200)
            self._link.close()
            self._core.close()
            self._folder.close()

    async def _serve(self, front: Front, generator: GeneratorKeeper, feed: RecorderFeed | None) -> int:
        loop = asyncio.get_running_loop()
        self._core.keep_off()
        logs = LogFeed(self._log_path, front.publish_log)
        for number in (signal.SIGTERM, signal.SIGINT):
            loop.add_signal_handler(number, self._end_asked)
        try:
            # The robot first: a daemon that cannot drive it starts nothing else.
            self._children.append(self._bus.child)
            channel = await self._start_bus_and_ctl()
            gc.collect()
            gc.freeze()  # a full collection of the tables of words would hold the front up for 36 ms
            front.start()
            front.ctl.attach(channel)
            self._watch(self._ctl.keep(front.ctl.attach))
            logs.start()
            self._watch(self._bus.keep(front))
            self._children.append(generator.child)
            if (work := generator.work()) is not None:
                self._watch(work)
            await self._start_extras(front)
            if feed is not None:  # a start that fails leaves no log
                child = recorder(self._config, self._link, feed.endpoint, self._environment)
                self._children.append(child)
                self._watch(record(child, feed, front, str(self._config.log)))
            self._log_ready(generator.client.state)
            # Serve.
            failure = asyncio.create_task(front.failure())
            asked = asyncio.create_task(self._asked_to_end.wait())
            await asyncio.wait((failure, asked), return_when=asyncio.FIRST_COMPLETED)
            asked.cancel()
            if failure.done():
                log.error("the front failed", exc_info=failure.exception())
            # Park, then let the bus process go.
            self._notifier.stopping()
            state = await front.park()
            await self._bus.end()
            failure.cancel()
            log.info("ended with the robot in %s", state.value)
            return GOOD if state is RobotState.LIMP else ROBOT_FAULT
        finally:
            if self._metrics is not None:
                await self._metrics.close()
            logs.close()
            await front.close()

    def _log_ready(self, generator: str) -> None:
        ends = self._config.endpoints
        texts = ": texts wait for it" if generator == "starting" else ""
        log.info("ready: robot %s on %s; generator %s%s", self._robot.name, self._config.bus, generator, texts)
        log.info("cmd %s, ctl %s, pub %s, stream %s", ends.cmd, ends.ctl, ends.pub, ends.stream)

    async def _start_extras(self, front: Front) -> None:
        """Start metrics and web server on request, and report readiness and signs of life to systemd."""
        if self._config.metrics:
            self._metrics = MetricsServer(
                self._config.metrics, lambda: exposition(front.state_event(), front.ledger.counts, front.view.health())
            )  # fmt: skip
            await self._metrics.start()
        if self._config.http or self._config.view:
            child = web_server(self._config, self._environment)
            self._children.append(child)
            self._watch(keep_web_server(child))
        self._notifier.ready(f"robot {self._robot.name} on {self._config.bus}")
        if self._notifier.watchdog_s is not None:
            self._watch(self._sign_of_life(self._notifier.watchdog_s / 3))

    async def _sign_of_life(self, period_s: float) -> None:
        """Report to systemd that the event loop runs. The bus process has its own supervision."""
        while True:
            self._notifier.alive()
            await asyncio.sleep(period_s)

    def _end_asked(self) -> None:
        if self._asked_to_end.is_set():
            log.warning("asked to end a second time: torque off at once")
            self._link.request(BusRequest.ESTOP)
        self._asked_to_end.set()

    def _watch(self, work: object) -> None:
        self._tasks.append(asyncio.ensure_future(work))  # type: ignore[arg-type]

    async def _start_bus_and_ctl(self) -> Channel:
        """Start bus process and ctl process at the same time; returns the channel to the ctl process."""
        ctl_starts = asyncio.create_task(self._ctl.start())
        try:
            await self._bus.start()
            return await ctl_starts
        finally:
            ctl_starts.cancel()


def run(config: DaemonConfig) -> int:
    """Run a daemon in this process until it is asked to end; returns its exit status.

    Raises:
        DaemonError: see `Supervisor.run`.
        RetargetError: the robot is unknown or its file is wrong.
    """

    async def start() -> int:
        return await Supervisor(config).run()

    return asyncio.run(start())
