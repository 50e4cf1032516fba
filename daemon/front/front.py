"""The front: an asyncio shell around wire, ledger and scheduler. It loads no torch.

`cmd` (ROUTER) takes texts and returns their events; `pub` (XPUB) carries state and events to all; `ctl` has its own process
(`daemon.ctl`), which reaches the bus process directly and hands over the requests that the front decides.
"""

from __future__ import annotations

import asyncio
import logging
import sys
import time
from typing import Any

import zmq
import zmq.asyncio

from daemon.front.ctl_handler import CtlHandler
from daemon.front.parking import park_at_the_end
from daemon.front.publisher import SOCKET_BOUNDS, Publisher, Record
from daemon.front.rate_limits import RATE_HZ, RequestLimits
from daemon.front.request_handler import RequestHandler
from daemon.front.stop_texts import stops
from daemon.front.target_handler import TargetHandler
from daemon.generator.client import GeneratorClient
from daemon.gestures.library import GestureLibrary
from daemon.host.clock import TICK_S
from daemon.network.connections import ConnectionGuard, Share
from daemon.network.inbox import Inbox, Message
from daemon.network.keys import Doorkeeper, KeyFolder
from daemon.network.sockets import bind, send_now
from daemon.playback.bus_follower import BusFollower
from daemon.playback.setpoint_buffer import SetpointBuffer
from daemon.playback.sources.source_factory import SourceFactory
from daemon.scheduling.scheduler import Scheduler
from daemon.settings.config import DaemonConfig
from daemon.shared_memory.bus_link import BusLink
from daemon.state.bus_view import BusView
from daemon.state.ledger import Ledger, Route, split_route
from daemon.state.machine import RobotState, StateMachine
from daemon.wire.codec import WireError, decode_cmd, encode, error_event, only_frame
from daemon.wire.event_base import Event
from daemon.wire.events import Rejected
from daemon.wire.lease_requests import Lease, without_secret
from daemon.wire.status import HealthEvent, LogEvent, StateEvent
from retarget.robot.robot import RobotModel

log = logging.getLogger(__name__)

DRAIN_LIMIT = 10_000
HEALTH_EVERY_S = 1.0
STREAM_PAUSE_S = 0.001
"""Seconds between two readings of `stream`; of the targets that one sender sends meanwhile, the newest counts."""
MOST_TARGETS = 256
"""Number of targets received in one reading at most, so that a flood of targets does not block the event loop."""
SWITCH_S = 0.001
"""Seconds that a worker thread keeps the interpreter from the event loop at most."""
SHARES = {"cmd": Share(256), "pub": Share(256), "stream": Share(64)}
"""Number of connections that each socket serves at a time at most."""


class Front:
    """Receives commands, hands them to the scheduler, and publishes events and state.

    Args:
        config: endpoints, rates and time-outs.
        robot: the robot.
        link: shared memory with the bus process.
        context: context of the asyncio sockets.
        generator: client of the generator.
        record: called with (channel, payload) for every request and event, for the log.

    Raises:
        ConfigError: an endpoint cannot be bound.
    """

    def __init__(
        self,
        config: DaemonConfig,
        robot: RobotModel,
        link: BusLink,
        context: zmq.asyncio.Context,
        generator: GeneratorClient,
        record: Record | None = None,
    ) -> None:
        self._config, self._robot, self.link = config, robot, link
        self._generator, self._record = generator, record
        self.machine = StateMachine(auto_arm=config.auto_arm)
        self.view = BusView(link, robot)
        self._planner = planner = SetpointBuffer(robot, link, self.view, config.queue_s, config.stream_queue_s)
        self.follower = BusFollower(link, self.view, planner, self.machine)
        self._publisher = Publisher(context, record)
        self.ledger = Ledger(self._send, self._publisher.event)
        sources = SourceFactory(config, robot, generator, GestureLibrary(config.gestures))
        self.performer = Scheduler(config, link, planner, self.follower, self.ledger, sources)
        self._desk = RequestHandler(config, robot, self.performer, sources, self.ledger, generator, self.state_event)
        self._started_s = time.monotonic()
        self.recording = str(config.log) if config.log else ""
        self._rates = RequestLimits()
        self._tasks: list[asyncio.Task[None]] = []
        self._events_dropped = 0
        self._cmd = context.socket(zmq.ROUTER)
        self._cmd.setsockopt(zmq.ROUTER_MANDATORY, 1)  # sending to a peer that does not read fails
        self._stream = context.socket(zmq.SUB)
        self._stream.subscribe(b"")  # not CONFLATE, with which libzmq aborts the process upon a message of two parts
        self._targets = TargetHandler(robot, self.performer, self.ledger, self._publisher.event)
        self.ctl = CtlHandler(
            link, self.performer, self.ledger, self.drain_cmd, self.state_event, self._publisher.event
        )
        sys.setswitchinterval(SWITCH_S)
        keys = KeyFolder(config.endpoints.keys) if config.endpoints.keys is not None else None
        self._doorkeeper = Doorkeeper(context, keys) if keys is not None else None
        sockets: dict[str, zmq.Socket[Any]] = {"cmd": self._cmd, "pub": self._publisher.socket, "stream": self._stream}
        try:
            for key, socket in sockets.items():
                bounds = SOCKET_BOUNDS if key == "pub" else {}
                bind(socket, key, getattr(config.endpoints, key), keys, **bounds)
        except BaseException:
            if self._doorkeeper is not None:
                self._doorkeeper.close()
            for socket in sockets.values():
                socket.close(0)
            raise
        self._guard = ConnectionGuard({key: (socket, SHARES[key]) for key, socket in sockets.items()})
        self._cmd_inbox, self._stream_inbox = Inbox(self._cmd, self._guard), Inbox(self._stream, self._guard)
        self._last_values = self._publisher.guarded_by(self._guard)

    def start(self) -> None:
        """Begin to serve, in the running event loop."""
        self.view.begin()
        serve = (self._serve_cmd, self._last_values.serve, self._serve_stream, self._tick_forever)
        self._tasks = [asyncio.create_task(s(), name=s.__name__) for s in serve]
        for topic, period_s, event in (
            ("v1/state", 1 / self._config.state_rate_hz, self.state_event),
            ("v1/health", HEALTH_EVERY_S, self._health_event),
        ):
            work = self._publisher.publish_every(period_s, topic, lambda event=event: self.ledger.stamp(event()))
            self._tasks.append(asyncio.create_task(work, name=topic))
        self._guard.start()

    async def failure(self) -> None:
        """Wait for a task of the front to end, which none should do.

        Raises:
            Exception: the error that ended the task.
        """
        done, _ = await asyncio.wait(self._tasks, return_when=asyncio.FIRST_COMPLETED)
        for task in done:
            task.result()

    async def park(self) -> RobotState:
        """End all commands and park, as far as the robot's state allows; returns the state in which the robot is left."""
        ticking = next((t for t in self._tasks if t.get_name() == self._tick_forever.__name__), None)
        return await park_at_the_end(self.performer, self.link, self._config.park_timeout_s, ticking)

    async def close(self) -> None:
        """Stop to serve and close the sockets."""
        self.performer.end_all("shutdown")
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        self.ctl.detach()
        await asyncio.to_thread(self._guard.close)
        if self._doorkeeper is not None:
            await asyncio.to_thread(self._doorkeeper.close)
        await self._generator.close()
        self._cmd.close(200)  # the last events still go out
        self._publisher.socket.close(200)
        self._stream.close(0)

    async def _serve_cmd(self) -> None:
        while True:
            self._take_message(await self._cmd_inbox.receive())
            await asyncio.sleep(0)  # receiving what is there already never yields: a flood would hold up the robot

    async def _serve_stream(self) -> None:
        """Take the newest target of each sender, so that a sender that floods does not displace the targets of another."""
        while True:
            newest = {message.fd: message.parts async for message in self._stream_inbox.arrived(MOST_TARGETS)}
            for parts in newest.values():
                if self._record is not None:
                    self._record("stream", without_secret(parts[0], self._targets.secret))
                self._targets.take(parts)
            await asyncio.sleep(STREAM_PAUSE_S)

    def _take_message(self, message: Message) -> None:
        self.ctl.take_waiting()  # serve a stop that came before this message
        t_received_ns = time.monotonic_ns()
        route, parts = split_route(message.parts)
        allowed = self._rates.allows(route.frames[0], message.peer, t_received_ns * 1e-9)
        if not allowed and not stops(parts):
            self._refuse_rate(route)
            return
        try:
            frame = only_frame(parts)
            request = decode_cmd(frame)
            if self._record is not None:
                self._record("cmd", without_secret(frame, request.secret if isinstance(request, Lease) else ""))
            self._desk.take(request, route, t_received_ns, (route.frames[0], message.peer))
        except WireError as error:
            event = error_event(error)
            self.ledger.reply(route, event)
            self._publisher.event(event)
        except Exception as error:  # one request must not end the daemon
            log.exception("a request failed")
            event = Rejected(code="internal", asked="cmd", found=str(error), allowed="", do="see the daemon's log")
            self.ledger.reply(route, event)

    def _refuse_rate(self, route: Route) -> None:
        """Tell a client that it sends too many requests, once in a thousand of them."""
        if self._rates.refused % 1000 == 1:
            do, allowed = "ask less often; texts that were dropped were not accepted", f"{RATE_HZ:g} requests a second"
            error = WireError("too_fast", "read a request", "more than that for a while", allowed, do)
            self.ledger.reply(route, error_event(error))

    async def drain_cmd(self) -> None:
        """Take the requests that wait in the socket; the other tasks run between them."""
        for _ in range(DRAIN_LIMIT):
            message = await self._cmd_inbox.waiting()
            if message is None:
                return
            self._take_message(message)
            await asyncio.sleep(0)

    async def _tick_forever(self) -> None:
        while True:
            self.ctl.tick()
            self.performer.tick()
            await asyncio.sleep(TICK_S)

    def _send(self, route: Route, event: Event) -> None:
        self._events_dropped += not send_now(self._cmd, [*route.frames, encode(event)])

    def publish_log(self, event: LogEvent) -> None:
        """Publish a log line, with the time at which it was written."""
        written_s = event.t_mono
        self.ledger.stamp(event)
        event.t_mono = written_s
        self._publisher.publish("v1/log", event)

    def _health_event(self) -> HealthEvent:
        silent_ms = round(1e3 * self.view.silent_s, 1)
        return HealthEvent(robot=self._robot.name, servos=self.view.health(), silent_ms=silent_ms)

    def state_event(self) -> StateEvent:
        """The present state of robot and daemon."""
        posture = self._planner.posture_now
        return StateEvent(
            robot=self._robot.name,
            bus=self._config.bus,
            state=self.machine.state.value,
            must_arm=self.machine.must_arm,
            reason=self.follower.fault_reason,
            command=self.performer.current_command(),
            generator=self._generator.state,
            joint_names=list(self._robot.joint_names),
            goal_rad=[round(float(q), 5) for q in self.view.goal_rad],
            present_rad=[round(float(q), 5) for q in self.view.present_rad],
            queued_ms=round(1e3 * self.link.setpoints.queued_frames / self._robot.bus.rate_hz, 1),
            bus_info=self.view.counters()
            | {
                "requests_dropped": self._rates.refused,
                "events_dropped": self._events_dropped,
                "subscribers_overrun": self._publisher.overruns,
                "connections_shut": self._guard.shut.total(),
            },
            recording=self.recording,
            uptime_s=round(time.monotonic() - self._started_s, 2),
            waiting=self.performer.waiting_ids(),
            idle=self.performer.layers.idle_style or "off",
            gaze_deg=self.performer.layers.gaze_deg,
            stream=self._targets.info(self._config.endpoints.stream),
            servos_not_ok=[s for s in self.view.health() if s.state != "ok"],
            person_m=posture.joints_m[0].round(3).ravel().tolist(),
            person_faces=posture.faces()[0].round(3).tolist(),
            effort=self.view.effort.round(1).tolist(),
            torque=self.view.torque if self.follower.bus_answers else None,
        )
