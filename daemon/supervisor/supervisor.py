"""Starts the daemon's processes, watches them, parks the robot at the end.

Bus process and front are needed; a generator that dies or freezes is started again while the robot holds; a recorder
that dies is reported and the robot goes on.
"""

from __future__ import annotations

import asyncio
import gc
import importlib.util
import json
import logging
import os
import signal
import time
from importlib.metadata import entry_points
from pathlib import Path

import zmq
import zmq.asyncio

from daemon.ctl.channel import Channel
from daemon.errors import ConfigError, DaemonError
from daemon.front.front import Front
from daemon.front.metrics import MetricsServer, exposition
from daemon.generator.client import GeneratorClient
from daemon.generator.generated import GeneratorError
from daemon.host.cores import CoreClaim
from daemon.host.notify import Notifier
from daemon.host.realtime import BUS_PRIORITY, may_fifo
from daemon.logs.log_feed import SOCKET_VARIABLE, LogFeed
from daemon.network.keys import KeyFolder
from daemon.network.web_access import address_of
from daemon.recording.feed import RecorderFeed
from daemon.settings.config import HTTP_ADDRESS, DaemonConfig, config_error
from daemon.settings.sources import settings_of
from daemon.shared_memory.bus_link import BusLink, BusState, Readiness
from daemon.shared_memory.request_words import ESTOPS, BusRequest
from daemon.state.machine import RobotState
from daemon.supervisor.children import Child
from daemon.supervisor.ctl_keeper import CtlKeeper
from daemon.supervisor.run_folder import RunFolder
from retarget.robot.loading import load_robot
from retarget.robot.robot import RobotModel

log = logging.getLogger(__name__)

BUS_START_TIMEOUT_S = 20.0
BUS_END_TIMEOUT_S = 5.0
BUS_FROZEN_S = 2.5
"""A bus process so long silent is killed and started again; from 1 s on the robot is in fault."""
BUS_FROZEN_IN_AN_ESTOP_S = 1.0
"""The same while an e-stop waits for it."""
PING_EVERY_S, PING_TIMEOUT_S = 2.0, 5.0
GENERATOR_START_TIMEOUT_S = 120.0
"""Loading torch and the model from a slow card."""
GOOD_LIFE_S = 2.0
"""A process that lived so long did not fail to start: the wait before its next start is short again."""
FIRST_BACK_OFF_S, LONGEST_BACK_OFF_S = 0.5, 30.0
GOOD, ROBOT_FAULT = 0, 3
NO_TORCH = "PyTorch is not installed: `mmmd install-torch`, or `--generator` names one elsewhere"
SAFETENSORS_HEAD_BYTES = 9
"""Length of the header, eight bytes, and the brace that the header begins with."""


class BusStartError(DaemonError):
    """The bus process could not open the bus or found other servos; the message is its own."""


class Supervisor:
    """One daemon, from start to park."""

    def __init__(self, config: DaemonConfig) -> None:
        check_scheme(config.bus)
        if config.http or config.view:
            check_web_server(config.http or HTTP_ADDRESS)
        if config.model is not None:
            check_model(config.model)
        self._config = config
        self._robot: RobotModel = load_robot(config.robot)
        self._link = BusLink.create(self._robot.n_joints, self._robot.n_servos)
        self._folder = RunFolder()
        self._context = zmq.asyncio.Context()
        self._children: list[Child] = []
        self._tasks: list[asyncio.Task[None]] = []
        self._asked_to_end = asyncio.Event()
        self._ending = False
        self._notifier = Notifier()
        self._metrics: MetricsServer | None = None
        arguments = ["--robot", config.robot, "--bus", config.bus, "--link", str(self._link.path)]
        # One core for a process at normal priority would keep it from going where there is room.
        self._core = CoreClaim() if may_fifo(BUS_PRIORITY) else CoreClaim(frozenset())
        if self._core.core is not None:
            arguments += ["--core", str(self._core.core)]
        self._log_path = self._folder.path / "log"
        self._environment = {SOCKET_VARIABLE: str(self._log_path)}
        self._link.set_estop_holds(config.estop == "hold")
        self._ctl = CtlKeeper(config, self._robot, self._link, self._environment)
        self._bus = Child("bus process", "daemon.control.process", arguments, self._environment)

    async def run(self) -> int:
        """Serve until SIGTERM or SIGINT; 0 after a park, 3 when the robot was left in a latched fault or e-stop.

        Raises:
            DaemonError: a port is taken, the bus cannot be opened, other servos were found.
        """
        try:
            endpoint = self._config.generator or f"ipc://{self._folder.path}/generator"
            keys = KeyFolder(self._config.endpoints.keys) if self._config.endpoints.keys is not None else None
            generator = GeneratorClient(self._context, endpoint, keys, self._config.model_hash)
            recorder = RecorderFeed(f"ipc://{self._folder.path}/events") if self._config.log else None
            front = Front(self._config, self._robot, self._link, self._context, generator, recorder)
            return await self._serve(front, generator, endpoint, recorder)
        finally:
            for task in self._tasks:
                task.cancel()
            await asyncio.gather(*self._tasks, return_exceptions=True)
            for child in reversed(self._children):
                await child.end(BUS_END_TIMEOUT_S)
            await self._ctl.close()  # last: it takes e-stops as long as there is somebody to carry them out
            self._context.destroy(linger=200)
            self._link.close()
            self._core.close()
            self._folder.close()

    async def _serve(
        self, front: Front, generator: GeneratorClient, endpoint: str, recorder: RecorderFeed | None
    ) -> int:
        loop = asyncio.get_running_loop()
        self._core.keep_off()
        logs = LogFeed(self._log_path, front.publish_log)
        for number in (signal.SIGTERM, signal.SIGINT):
            loop.add_signal_handler(number, self._end_asked)
        try:
            bus = self._bus
            self._children.append(bus)
            channel = await self._start_bus_and_ctl(bus)
            gc.collect()
            gc.freeze()  # a full collection of the tables of words would hold the front up for 36 ms
            front.start()
            front.ctl.attach(channel)
            self._watch(self._ctl.keep(front.ctl.attach))
            logs.start()
            self._watch(self._keep_bus(front, bus))
            if self._config.generator is not None:
                self._watch(self._follow_generator(generator))
            elif importlib.util.find_spec("torch") is None:
                generator.mark_down(NO_TORCH)
                log.warning("generator %s; gestures, replay, look, idle and stream work without it", generator.state)
            else:
                self._watch(self._keep_generator(generator, endpoint))
            ends = self._config.endpoints
            await self._start_extras(front)
            if recorder is not None:  # a start that fails leaves no log
                self._watch(self._watch_recorder(recorder, front))
            texts = ": texts wait for it" if generator.state == "starting" else ""
            told = (self._robot.name, self._config.bus, generator.state, texts)
            log.info("ready: robot %s on %s; generator %s%s", *told)
            log.info("cmd %s, ctl %s, pub %s, stream %s", ends.cmd, ends.ctl, ends.pub, ends.stream)
            failure = asyncio.create_task(front.failure())
            asked = asyncio.create_task(self._asked_to_end.wait())
            await asyncio.wait((failure, asked), return_when=asyncio.FIRST_COMPLETED)
            asked.cancel()
            if failure.done():
                log.error("the front failed", exc_info=failure.exception())
            self._notifier.stopping()
            state = await front.park()
            self._ending = True
            self._link.request(BusRequest.SHUTDOWN)
            await bus.end(BUS_END_TIMEOUT_S, terminate=False)
            failure.cancel()
            log.info("ended with the robot in %s", state.value)
            return GOOD if state is RobotState.LIMP else ROBOT_FAULT
        finally:
            if self._metrics is not None:
                await self._metrics.close()
            logs.close()
            await front.close()

    async def _start_extras(self, front: Front) -> None:
        """Metrics on request; readiness and signs of life for systemd."""
        if self._config.metrics:
            self._metrics = MetricsServer(
                self._config.metrics, lambda: exposition(front.state_event(), front.ledger.counts, front.view.health())
            )  # fmt: skip
            await self._metrics.start()
        if self._config.http or self._config.view:
            self._watch(self._keep_web_server())
        self._notifier.ready(f"robot {self._robot.name} on {self._config.bus}")
        if self._notifier.watchdog_s is not None:
            self._watch(self._sign_of_life(self._notifier.watchdog_s / 3))

    async def _keep_web_server(self) -> None:
        """Serve HTTP, WebSocket and the page, again when that process ends; the robot needs it for nothing."""
        ends, address = self._config.endpoints, self._config.http or HTTP_ADDRESS
        arguments = ["--http", address, "--robot", self._config.robot, *(["--page"] if self._config.view else [])]
        arguments += ["--cmd", ends.cmd, "--ctl", ends.ctl, "--pub", ends.pub, "--stream", ends.stream]
        arguments += ["--keys", str(ends.keys)] if ends.keys is not None else []
        child = Child("web server", "daemon.view.process", arguments, self._environment)
        self._children.append(child)
        back_off_s = FIRST_BACK_OFF_S
        while True:
            await child.start()
            status = await child.ended()
            back_off_s = FIRST_BACK_OFF_S if child.lived_s > GOOD_LIFE_S else min(2 * back_off_s, LONGEST_BACK_OFF_S)
            log.error("the web server ended with status %d and starts again in %g s", status, back_off_s)
            await asyncio.sleep(back_off_s)

    async def _sign_of_life(self, period_s: float) -> None:
        """The event loop runs: systemd may know. The bus process has its own supervision."""
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

    async def _start_bus_and_ctl(self, bus: Child) -> Channel:
        """Both at a time; the channel to the process that takes e-stops."""
        ctl_starts = asyncio.create_task(self._ctl.start())
        try:
            await self._start_bus(bus)
            return await ctl_starts
        finally:
            ctl_starts.cancel()

    async def _start_bus(self, bus: Child) -> None:
        self._link.set_ready(Readiness.STARTING)
        await bus.start()
        end_s = time.monotonic() + BUS_START_TIMEOUT_S
        while self._link.readiness is Readiness.STARTING and bus.running and time.monotonic() < end_s:
            if self._asked_to_end.is_set():
                raise BusStartError("ended while the bus was being opened")
            self._link.heartbeat()
            await asyncio.sleep(0.01)
            frozen_s = self._frozen_s
            if bus.stopped_s() > frozen_s:
                bus.kill()
                raise BusStartError(f"the bus process was frozen for {frozen_s:g} s while it started, and is killed")
        if self._link.readiness is Readiness.READY:
            return
        if self._link.readiness is Readiness.REFUSED:
            raise ConfigError(f"--bus {self._config.bus}: {self._link.text}")
        if self._link.readiness is Readiness.FAILED:
            raise BusStartError(self._link.text)
        if not bus.running:
            status = await bus.ended()
            raise BusStartError(f"the bus process ended with status {status}; what it printed says why")
        raise BusStartError(f"the bus process did not open {self._config.bus} in {BUS_START_TIMEOUT_S:g} s")

    async def _keep_bus(self, front: Front, bus: Child) -> None:
        """Notice the end of the bus process and start it again: in a latched fault, which a person has to reset."""
        back_off_s = FIRST_BACK_OFF_S
        while True:
            status = await self._lost_bus(front, bus)
            if self._ending:
                return
            front.follower.bus_alive = False
            if bus.lived_s > GOOD_LIFE_S:
                back_off_s = FIRST_BACK_OFF_S
            log.error("the bus process ended with status %d; servos that have a bus watchdog stop by it", status)
            await self._back_off(back_off_s, 0.0 if bus.lived_s > GOOD_LIFE_S else FIRST_BACK_OFF_S)
            back_off_s = min(2 * back_off_s, LONGEST_BACK_OFF_S)
            if self._ending:
                return
            bus.add_argument("--after-loss")
            try:
                await self._start_bus(bus)
            except (BusStartError, ConfigError) as error:
                log.error("the bus process could not be started again: %s", error)
                continue
            front.view.begin(BusState.FAULT)
            front.follower.bus_alive = True
            log.warning("the bus process runs again, in fault: `mmmd reset`, then `mmmd arm`")

    async def _back_off(self, seconds: float, least_s: float) -> None:
        """Wait before the next start of the bus process; not longer than `least_s` while an e-stop waits for it."""
        began_s = time.monotonic()
        while (waited_s := time.monotonic() - began_s) < seconds:
            if waited_s >= least_s and self._link.owes(*ESTOPS):
                return
            await asyncio.sleep(0.02)

    @property
    def _frozen_s(self) -> float:
        """Seconds of silence after which the bus process is taken to be frozen."""
        return BUS_FROZEN_IN_AN_ESTOP_S if self._link.owes(*ESTOPS) else BUS_FROZEN_S

    async def _lost_bus(self, front: Front, bus: Child) -> int:
        """Wait for the end of the bus process, which a frozen one is brought to; its status."""
        ended = asyncio.create_task(bus.ended())
        while not ended.done():
            await asyncio.wait({ended}, timeout=0.2)
            if front.view.silent_s > self._frozen_s and not ended.done():
                log.error("the bus process has been silent for %.1f s and is killed", front.view.silent_s)
                bus.kill()
        return ended.result()

    async def _keep_generator(self, client: GeneratorClient, endpoint: str) -> None:
        """Start the generator, and again whenever it ends or freezes."""
        arguments = ["--bind", endpoint, "--parent-pid", str(os.getpid())]
        if self._config.model is not None:
            arguments += ["--model", str(self._config.model)]
        child = Child("generator", "daemon.generator.process", arguments, self._environment, follow=True)
        self._children.append(child)
        back_off_s = FIRST_BACK_OFF_S
        while True:
            client.mark_starting()
            await child.start()
            answered = await self._attend(child, client)
            child.kill()
            status = await child.ended()
            why = child.said[-1] if child.said else "no message"
            back_off_s = FIRST_BACK_OFF_S if answered else min(2 * back_off_s, LONGEST_BACK_OFF_S)
            client.mark_down(f"ended with status {status} ({why}); starts again in {back_off_s:g} s")
            log.error("generator %s", client.state)
            await asyncio.sleep(back_off_s)

    async def _attend(self, child: Child, client: GeneratorClient) -> bool:
        """Return when the generator has ended or does not answer; whether it ever did."""
        answered, timeouts = False, client.timeouts
        began_s = time.monotonic()
        ended = asyncio.create_task(child.ended())
        while not ended.done():
            if not client.busy:
                try:
                    checkpoint = await client.ping(PING_TIMEOUT_S if answered else 0.25)
                except GeneratorError:
                    if answered or time.monotonic() - began_s > GENERATOR_START_TIMEOUT_S:
                        log.error("the generator does not answer and is started again")
                        return answered
                    timeouts = client.timeouts
                    continue
                if not answered:
                    client.mark_ready(checkpoint)
                    log.info("generator %s after %.1f s", client.state, time.monotonic() - began_s)
                answered = True
            if client.timeouts != timeouts:
                log.error("the generator left a text unanswered and is started again")
                return answered
            await asyncio.wait({ended}, timeout=PING_EVERY_S if answered else 0.1)
        return answered

    async def _follow_generator(self, client: GeneratorClient) -> None:
        """Notice whether a generator that somebody else runs answers."""
        ready = False
        while True:
            if not client.busy:
                try:
                    checkpoint = await client.ping(1.0 if ready else 0.25)
                    if not ready:
                        client.mark_ready(checkpoint)
                        log.info("generator %s", client.state)
                    ready = True
                except GeneratorError as error:
                    timeout = error.code == "generator_timeout"
                    why = f"no answer from {self._config.generator}" if timeout else str(error)
                    if ready or client.state == "starting" or not client.state.endswith(why):
                        client.mark_down(why)
                        log.error("generator %s", client.state)
                    ready = False
            await asyncio.sleep(PING_EVERY_S / 2 if ready else 0.1)

    async def _watch_recorder(self, feed: RecorderFeed, front: Front) -> None:
        """Record until the end; a recorder that fails leaves the robot without a log, which is said."""
        arguments = ["--robot", self._config.robot, "--link", str(self._link.path)]
        arguments += ["--events", feed.endpoint, "--out", str(self._config.log)]
        arguments += ["--size-mb", str(self._config.log_size_mb), "--total-mb", str(self._config.log_total_mb)]
        arguments += ["--settings", json.dumps(settings_of(self._config), default=str)]
        child = Child("recorder", "daemon.recording.recorder", arguments, self._environment)
        self._children.append(child)
        await child.start()
        try:
            status = await child.ended()
            front.recording = f"stopped (status {status}): {self._config.log}"
            log.error("recording ended with status %d; the robot goes on without a log", status)
        finally:
            await feed.close()


def run(config: DaemonConfig) -> int:
    """Run a daemon in this process until it is asked to end; its exit status.

    Raises:
        DaemonError: see `Supervisor.run`.
        RetargetError: the robot is unknown or its file is wrong.
    """

    async def start() -> int:
        return await Supervisor(config).run()

    return asyncio.run(start())


def check_scheme(bus: str) -> None:
    """Refuse a bus URL whose scheme nobody serves, before anything is started.

    Raises:
        ConfigError: it is unknown.
    """
    known = sorted(point.name for point in entry_points(group="mmmd.ports"))
    if bus.partition(":")[0] not in known:
        allowed = ", ".join(f"{name}://" for name in known)
        raise config_error("bus", f"'{bus}', an unknown scheme", allowed, "for example dxl:///dev/ttyUSB0?baud=1000000")


def check_web_server(address: str) -> None:
    """Refuse an address that is none, and a server whose library is missing, before anything is started.

    Raises:
        ConfigError: either.
    """
    address_of(address)
    if importlib.util.find_spec("tornado") is None:
        raise config_error("http", "no tornado, the library that serves it", "mmmd[view]", "`pip install 'mmmd[view]'`")


def check_model(path: Path) -> None:
    """Refuse a checkpoint that cannot be one, before a generator is started again and again for it.

    Raises:
        ConfigError: there is no such file, it cannot be read, or it is no safetensors file.
    """
    do = "write one with `mmmd train`, or leave --model out for the shipped one"
    try:
        with path.open("rb") as file:
            head = file.read(SAFETENSORS_HEAD_BYTES)
    except OSError as error:
        raise config_error("model", f"{path}: {error.strerror}", "a checkpoint (.safetensors)", do) from error
    length = int.from_bytes(head[:8], "little")
    if head[8:] != b"{" or not 0 < length <= path.stat().st_size - 8:
        raise config_error("model", f"{path}, which is no safetensors file", "a checkpoint (.safetensors)", do)


def log_file(path: Path) -> Path:
    """The file to record into: in a folder one named by the time, so that each start of a service has its own."""
    return path / time.strftime("mmmd-%Y%m%dT%H%M%S.mcap", time.gmtime()) if path.is_dir() else path


def log_path_error(path: Path) -> str | None:
    """Why a log cannot be written there; None when it can."""
    if path.exists():
        return f"--log {path}: the file exists; choose another name, or a folder; logs are not overwritten"
    if not path.parent.is_dir():
        return f"--log {path}: no folder {path.parent}; make it, or choose another"
    return None
