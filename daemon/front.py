"""The front: an asyncio shell around wire, ledger, planner and state. Holds no torch.

`cmd` (ROUTER) takes texts and returns their events; `pub` (XPUB) carries state and events to all; `ctl` has its own
thread (`daemon.control`). A text is generated, retargeted from where the joints will be, and pushed frame by frame.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import msgspec
import zmq
import zmq.asyncio

from daemon.config import DaemonConfig, config_error
from daemon.control import MAX_RECEIVE_BYTES, ControlThread, refusal
from daemon.generation import Generated, GeneratorClient, GeneratorError
from daemon.ledger import Entry, Ledger, Route, split_route
from daemon.planner import Planner
from daemon.state import CommandRefusedError, ImpossibleTransitionError, RobotState, StateMachine, Trigger
from daemon.wire import (
    Accepted,
    Ack,
    Cancel,
    Cancelled,
    CurrentCommand,
    Event,
    Failed,
    Progress,
    Rejected,
    Request,
    Say,
    StateEvent,
    Status,
    WireError,
    decode_cmd,
    encode,
    error_event,
)
from retarget.errors import RetargetError
from retarget.robot import RobotModel

if TYPE_CHECKING:
    from daemon.shared import BusLink, BusRequest, LogReader

log = logging.getLogger(__name__)

TICK_S = 0.005
ARM_TIMEOUT_S = 30.0
DRAIN_TIMEOUT_S = 0.05
"""Longest wait of a `stop` reply for the texts that came before it; the stop itself does not wait."""
STALL_S = 0.5
"""A plan whose frames are all pushed and whose bus holds so long without playing them was dropped by the bus."""
OUT_OF_SCOPE_DO = "ask for gestures of head, arms and torso, in English, e.g. 'wave with your right hand'"


@dataclass
class Pending:
    """A text that is being generated or waits for the robot to be armed; a newer one takes its place."""

    entry: Entry
    task: asyncio.Task[None] | None = None
    cancelled_by: str = ""
    committing: bool = False


class Front:
    """Takes commands, plays them, tells what happens.

    Args:
        config: endpoints, rates and time-outs.
        robot: the robot.
        link: shared memory with the bus process.
        log_reader: reads the bus process's cycle records.
        generator: asks the generator.
        record: called with (channel, payload) for every request and event, for the log.
    """

    def __init__(
        self,
        config: DaemonConfig,
        robot: RobotModel,
        link: BusLink,
        log_reader: LogReader,
        context: zmq.asyncio.Context,
        generator: GeneratorClient,
        record: Callable[[str, bytes], None] = lambda _channel, _payload: None,
    ) -> None:
        self._config, self._robot, self._link = config, robot, link
        self._generator = generator
        self._record = record
        self._context = context
        self.planner = Planner(robot, link, log_reader, config.queue_s)
        self.machine = StateMachine(auto_arm=config.auto_arm)
        self.ledger = Ledger(self._send, self._publish_event)
        self.generator_state = "starting"
        self.fault_reason = ""
        self.bus_alive = True
        self._started_s = time.monotonic()
        self._pending: Pending | None = None
        self._playing: Entry | None = None
        self._moving_told = False
        self._held_since_s: float | None = None
        self._last_values: dict[bytes, bytes] = {}
        self._tasks: list[asyncio.Task[None]] = []
        self._take_lock = asyncio.Lock()
        self._cmd = context.socket(zmq.ROUTER)
        self._pub = context.socket(zmq.XPUB)
        self._pub.setsockopt(zmq.XPUB_VERBOSE, 1)
        ctl = zmq.Context.instance().socket(zmq.ROUTER)
        for key, socket in (("cmd", self._cmd), ("pub", self._pub), ("ctl", ctl)):
            _bind(socket, key, getattr(config.endpoints, key))
        self._control = ControlThread(ctl, FrontControls(self))
        self._loop: asyncio.AbstractEventLoop | None = None

    @property
    def loop(self) -> asyncio.AbstractEventLoop:
        """The event loop the front runs in."""
        assert self._loop is not None, "Front.start was not called"
        return self._loop

    def start(self) -> None:
        """Begin to serve, in the running event loop."""
        self._loop = asyncio.get_running_loop()
        self._control.start()
        serve = (self._serve_cmd, self._serve_subscriptions, self._tick_forever, self._publish_state_forever)
        self._tasks = [asyncio.create_task(s(), name=s.__name__) for s in serve]

    async def wait(self) -> None:
        """Return when a task of the front ends, which none should.

        Raises:
            Exception: what ended it.
        """
        done, _ = await asyncio.wait(self._tasks, return_when=asyncio.FIRST_COMPLETED)
        for task in done:
            task.result()

    async def park_and_close(self) -> RobotState:
        """End all commands, park, close the sockets; the state the robot was left in."""
        self.end_commands("shutdown")
        with contextlib.suppress(CommandRefusedError):
            self.machine.check(Trigger.PARK)
            if self.machine.state is not RobotState.LIMP and self.bus_alive:
                await self._park()
        state = self.machine.state
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        self._control.close()
        await self._generator.close()
        self._cmd.close(200)
        self._pub.close(200)
        return state

    async def _park(self) -> None:
        self.planner.halt(lambda: self._ask_bus("PARK"))
        asked_again_s = time.monotonic()
        end_s = asked_again_s + self._config.park_timeout_s
        while time.monotonic() < end_s:
            if self.machine.state in (RobotState.LIMP, RobotState.FAULT, RobotState.ESTOP) or not self.bus_alive:
                return
            if self.machine.state is not RobotState.PARKING and time.monotonic() - asked_again_s > 1.0:
                self._ask_bus("PARK")
                asked_again_s = time.monotonic()
            await asyncio.sleep(0.02)
        log.error("the robot did not park in %g s", self._config.park_timeout_s)

    # --- cmd ---------------------------------------------------------------------------------------------------

    async def _serve_cmd(self) -> None:
        while True:
            frames = await self._cmd.recv_multipart()
            try:
                self._take_frames(frames)
            except Exception:  # one request must not end the daemon
                log.exception("a request failed")

    def _take_frames(self, frames: list[bytes]) -> None:
        t_received_ns = time.monotonic_ns()
        route, parts = split_route(frames)
        try:
            if len(parts) != 1:
                found = f"{len(parts)} frames"
                raise WireError("frames", "read a request", found, "1 frame", "send the request as one frame")
            request = decode_cmd(parts[0])
            self._record("cmd", parts[0])
            self._take(request, route, t_received_ns)
        except WireError as error:
            event = error_event(error)
            self.ledger.reply(route, event)
            self._publish_event(event)

    def _take(self, request: Request, route: Route, t_received_ns: int) -> None:
        if isinstance(request, Status):
            event = self.state_event()
            event.id = request.id
            self.ledger.reply(route, event)
        elif isinstance(request, Cancel):
            self._cancel(request, route)
        elif isinstance(request, Say):
            entry = self.ledger.open(request, route, t_received_ns)
            if entry is not None:
                self._say(entry)

    def _cancel(self, request: Cancel, route: Route) -> None:
        running = [e for e in (self._pending.entry if self._pending else None, self._playing) if e is not None]
        hit = [e for e in running if request.command in ("", e.id)]
        if not hit:
            found = ", ".join(repr(e.id) for e in running) or "nothing is running"
            event = Rejected(
                id=request.id, code="not_running", asked=f"cancel {request.command!r}", found=found,
                allowed="the id of a running command, or an empty one", do="see `mmmd status`",
            )  # fmt: skip
            self.ledger.reply(route, event)
            return
        state = self.machine.state.value
        if self._playing in hit:
            self.planner.halt(lambda: self._ask_bus("STOP"))
            self.end_commands("cancel")
        elif self._pending is not None:
            self._drop_pending("cancel")
        self.ledger.reply(route, Ack(id=request.id, verb="cancel", state=state))

    # --- say ---------------------------------------------------------------------------------------------------

    def _say(self, entry: Entry) -> None:
        try:
            self.machine.check(Trigger.SAY)
        except CommandRefusedError as error:
            self.ledger.emit(entry, refusal(entry.id, error))
            return
        if self._pending is not None and not self._pending.committing:
            self._drop_pending(f"say {entry.id}")
        pending = Pending(entry)
        self._pending = pending
        pending.task = asyncio.create_task(self._play(pending, self.planner.epoch), name=f"say {entry.id}")

    def _drop_pending(self, by: str) -> None:
        pending = self._pending
        if pending is None:
            return
        self._pending = None
        pending.cancelled_by = by
        if not pending.committing and pending.task is not None:
            pending.task.cancel()
        self.ledger.emit(pending.entry, Cancelled(plan_id=0, by=by))

    async def _play(self, pending: Pending, epoch: int) -> None:
        entry = pending.entry
        try:
            generated = await self._generate(entry)
            if generated is None:
                return
            plan_id = self.planner.new_plan_id()
            self.ledger.emit(entry, _accepted(entry, plan_id, generated))
            await self._until_armed(entry, plan_id)
            pending.committing = True
            async with self._take_lock:
                await self._take_over(pending, generated, plan_id, epoch)
        except CommandRefusedError as error:
            self.ledger.emit(entry, _failed(error.command.value, str(error), ", ".join(error.allowed), error.do))
        except RetargetError as error:
            self.planner.give_up()
            self.ledger.emit(
                entry, _failed("retarget", str(error), "a motion that fits the robot", "say it in other words")
            )
        except asyncio.CancelledError:
            self.ledger.emit(entry, Cancelled(plan_id=0, by=pending.cancelled_by or "shutdown"))
        except Exception as error:
            log.exception("playing %r failed", entry.request.text)
            self.planner.give_up()
            self.ledger.emit(entry, _failed("internal", str(error), "", "see the daemon's log"))
        finally:
            if self._pending is pending:
                self._pending = None

    async def _generate(self, entry: Entry) -> Generated | None:
        """The motion, or None after telling why there is none."""
        request = entry.request
        try:
            generated = await self._generator.generate(
                request.text, request.seed, request.seconds, self._config.generate_timeout_s
            )
        except GeneratorError as error:
            found = f"{error.found} (generator: {self.generator_state})"
            self.ledger.emit(
                entry,
                Failed(code=error.code, asked=error.asked, found=found, allowed=error.allowed, do=error.do),
            )
            return None
        if generated.motion.status != "rejected":
            return generated
        self.ledger.emit(
            entry,
            Rejected(
                code="out_of_scope",
                asked=f"say {request.text!r}",
                found=generated.reason or "nothing the model knows",
                allowed="upper-body motion of one person without objects",
                do=OUT_OF_SCOPE_DO,
                understood=generated.understood,
                scope_score=generated.motion.scope_score,
            ),
        )
        return None

    async def _until_armed(self, entry: Entry, plan_id: int) -> None:
        """Arm where a text may do so, and wait until the robot can move.

        Raises:
            CommandRefusedError: the robot went into a state in which it takes no text.
        """
        self.machine.check(Trigger.SAY)
        if self.machine.state is RobotState.LIMP:
            self._ask_bus("ARM")
        elif self._can_take_over():
            return
        if self.machine.state in (RobotState.LIMP, RobotState.ARMING):
            self.ledger.emit(entry, Progress(plan_id=plan_id, stage="arming"))
        end_s = time.monotonic() + ARM_TIMEOUT_S
        asked_s = time.monotonic()
        while not self._can_take_over():
            if time.monotonic() > end_s:
                raise CommandRefusedError(
                    self.machine.state, Trigger.SAY, (), f"the robot was not ready in {ARM_TIMEOUT_S:g} s; `mmmd status`"
                )
            if self.machine.state is RobotState.LIMP and time.monotonic() - asked_s > 1.0:
                raise CommandRefusedError(self.machine.state, Trigger.SAY, ("arm",), "the robot did not arm; see the log")
            await asyncio.sleep(TICK_S)
            self.machine.check(Trigger.SAY)

    def _can_take_over(self) -> bool:
        """Whether setpoints pushed now would be played from where the joints are."""
        return self._link.snapshot().bus_state.name in ("HOLDING", "PLAYING")

    async def _take_over(self, pending: Pending, generated: Generated, plan_id: int, epoch: int) -> None:
        """Retarget from the hand-over state and make it the plan; what was played ends in `cancelled`."""
        entry = pending.entry
        for _ in range(2):
            start = self.planner.hand_over()
            path = await asyncio.to_thread(self.planner.retarget, generated.motion, start)
            if pending.cancelled_by or epoch != self.planner.epoch:
                if epoch == self.planner.epoch:
                    self.planner.give_up()
                self.ledger.emit(entry, Cancelled(plan_id=plan_id, by=pending.cancelled_by or "stop"))
                return
            if not self.planner.hand_over_missed:
                break
            await self._until_holding()
        before, self._playing = self._playing, entry
        self._moving_told = False
        self._held_since_s = None
        self.planner.commit(path, plan_id, entry.id, epoch, entry.t_received_ns)
        if before is not None:
            self.ledger.emit(before, Cancelled(plan_id=0, by=f"say {entry.id}"))

    async def _until_holding(self) -> None:
        end_s = time.monotonic() + 2.0
        while self._link.snapshot().bus_state.name != "HOLDING" and time.monotonic() < end_s:
            await asyncio.sleep(TICK_S)

    def end_commands(self, by: str, failed: Failed | None = None) -> None:
        """End what is generated and what is played, in `cancelled`, or in `failed` when that is given."""
        self._drop_pending(by)
        entry, plan = self._playing, self.planner.current
        self._playing = None
        self.planner.drop()
        if entry is not None:
            plan_id = plan.plan_id if plan is not None else 0
            if failed is not None:
                failed.plan_id = plan_id
            self.ledger.emit(entry, failed or Cancelled(plan_id=plan_id, by=by))

    def drain_cmd(self) -> None:
        """Take the texts that wait in the socket, so that a stop ends them as well."""
        with contextlib.suppress(zmq.Again):
            for _ in range(1000):
                frames = zmq.Socket.recv_multipart(self._sync_cmd, zmq.DONTWAIT)
                self._take_frames(frames)

    @property
    def _sync_cmd(self) -> zmq.Socket[bytes]:
        return zmq.Socket.shadow(self._cmd)

    # --- the bus process ----------------------------------------------------------------------------------------

    def _ask_bus(self, name: str) -> None:
        from daemon.shared import BusRequest

        request: BusRequest = BusRequest[name]
        self._link.request(request)

    async def _tick_forever(self) -> None:
        while True:
            self._tick()
            await asyncio.sleep(TICK_S)

    def _tick(self) -> None:
        self._link.heartbeat()
        self.planner.pump()
        self.planner.read_log()
        snapshot = self._link.snapshot()
        report = Trigger[f"BUS_{snapshot.bus_state.name}"] if self.bus_alive else Trigger.BUS_LOST
        self._follow(report)
        self._watch_plan(report)

    def _follow(self, report: Trigger) -> None:
        before = self.machine.state
        try:
            changed = self.machine.report(report)
        except ImpossibleTransitionError as error:
            if before in (RobotState.ESTOP, RobotState.FAULT):
                log.error("%s; e-stop is asked for again", error)
                self._ask_bus("ESTOP")
            return
        if not changed:
            return
        state = self.machine.state
        log.info("state %s -> %s", before.value, state.value)
        if state is RobotState.FAULT:
            self.fault_reason = self.fault_reason or self._bus_reason()
            log.error("fault: %s", self.fault_reason)
            fault = _failed("fault", self.fault_reason, "a robot without fault", "find the cause, then `mmmd reset`")
            self.end_commands("fault", fault)
        elif before is RobotState.FAULT:
            self.fault_reason = ""
        if state is RobotState.ESTOP:
            self.end_commands("estop")
        elif state in (RobotState.LIMP, RobotState.PARKING) and before in (RobotState.MOVING, RobotState.IDLE):
            self.end_commands("park")

    def _bus_reason(self) -> str:
        return str(getattr(self._link.snapshot(), "message", "")) or "the bus process reported a fault"

    def _watch_plan(self, report: Trigger) -> None:
        plan, entry = self.planner.current, self._playing
        if plan is None or entry is None:
            return
        statistics = plan.statistics
        if not self._moving_told and statistics.first_motion_ms is not None:
            self._moving_told = True
            first_ms = round(statistics.first_motion_ms, 2)
            self.ledger.emit(entry, Progress(plan_id=plan.plan_id, stage="moving", first_motion_ms=first_ms))
        idle = plan.all_pushed and report is Trigger.BUS_HOLDING and self._link.queued_frames == 0
        self._held_since_s = (self._held_since_s or time.monotonic()) if idle else None
        stalled = self._held_since_s is not None and time.monotonic() - self._held_since_s > STALL_S
        if plan.played or (stalled and statistics.dropped):
            self._playing = None
            self.ledger.emit(entry, statistics.done(plan.path.report, len(plan.q_rad)))
        elif stalled:
            self._playing = None
            found = f"{statistics.last_frame + 1} of {len(plan.q_rad)} frames were played"
            self.ledger.emit(entry, _failed("bus_dropped", found, "all of them", "see the daemon's log"))

    # --- events -------------------------------------------------------------------------------------------------

    def _send(self, route: Route, event: Event) -> None:
        """Reply without waiting; a peer that never reads loses its own replies."""
        with contextlib.suppress(zmq.ZMQError):
            zmq.Socket.send_multipart(self._sync_cmd, [*route.frames, encode(event)], zmq.DONTWAIT)

    def _publish_event(self, event: Event) -> None:
        self._publish(b"v1/event", encode(event))
        log.info("%s", _line(event))

    def _publish(self, topic: bytes, payload: bytes) -> None:
        self._last_values[topic] = payload
        self._record(topic.decode(), payload)
        with contextlib.suppress(zmq.ZMQError):
            zmq.Socket.send_multipart(zmq.Socket.shadow(self._pub), [topic, payload], zmq.DONTWAIT)

    async def _publish_state_forever(self) -> None:
        while True:
            event = self.ledger.stamp(self.state_event())
            self._publish(b"v1/state", encode(event))
            await asyncio.sleep(1 / self._config.state_rate_hz)

    async def _serve_subscriptions(self) -> None:
        """Send the last value of each topic to whoever subscribes to it."""
        while True:
            frames = await self._pub.recv_multipart()
            if frames and frames[0][:1] == b"\x01":
                for topic, payload in list(self._last_values.items()):
                    if topic.startswith(frames[0][1:]):
                        await self._pub.send_multipart([topic, payload])

    def state_event(self) -> StateEvent:
        """The robot and the daemon now; may be called from any thread."""
        snapshot = self._link.snapshot()
        entry, plan = self._playing, self.planner.current
        command = None
        if entry is not None and plan is not None:
            command = CurrentCommand(entry.id, plan.plan_id, entry.request.text, len(plan.q_rad), plan.pushed)
        return StateEvent(
            robot=self._robot.name,
            bus=self._config.bus,
            state=self.machine.state.value,
            must_arm=self.machine.must_arm,
            reason=self.fault_reason,
            command=command,
            generator=self.generator_state,
            joint_names=list(self._robot.joint_names),
            goal_rad=[round(float(q), 5) for q in snapshot.goal_rad],
            present_rad=[round(float(q), 5) for q in snapshot.present_rad],
            queued_ms=round(1e3 * self._link.queued_frames / self._robot.bus.rate_hz, 1),
            bus_info=_bus_info(snapshot),
            recording=str(self._config.log) if self._config.log else "",
            uptime_s=round(time.monotonic() - self._started_s, 2),
        )


class FrontControls:
    """What the `ctl` thread does: the bus process first, the event loop afterwards."""

    def __init__(self, front: Front) -> None:
        self._front = front

    def stop(self, command_id: str) -> str:
        """Brake within the limits and hold."""
        return self._halt(Trigger.STOP, command_id)

    def estop(self, command_id: str) -> str:
        """Cut torque."""
        return self._halt(Trigger.ESTOP, command_id)

    def park(self, command_id: str) -> str:
        """Park, then torque off."""
        return self._halt(Trigger.PARK, command_id)

    def reset(self) -> str:
        """Leave fault or e-stop."""
        front, state = self._front, self._front.machine.state
        front.machine.check(Trigger.RESET)
        if not front.bus_alive:
            raise CommandRefusedError(state, Trigger.RESET, (), "the bus process is gone: start `mmmd run` again")
        front._ask_bus("RESET")
        return state.value

    def arm(self) -> str:
        """Torque on, slow move to rest."""
        front, state = self._front, self._front.machine.state
        front.machine.check(Trigger.ARM)
        front.machine.armed_by_person()
        front._ask_bus("ARM")
        return state.value

    def status(self) -> Event:
        """The state event."""
        return self._front.state_event()

    def stamp(self, event: Event) -> Event:
        """Number an event."""
        return self._front.ledger.stamp(event)

    def _halt(self, command: Trigger, command_id: str) -> str:
        front, state = self._front, self._front.machine.state
        front.machine.check(command)
        front.planner.halt(lambda: front._ask_bus(command.name))
        settled = _call_in_loop(front.loop, lambda: self._after_halt(command))
        settled(DRAIN_TIMEOUT_S)
        log.info("%s by %s in state %s", command.value, command_id or "a client", state.value)
        return state.value

    def _after_halt(self, command: Trigger) -> None:
        self._front.drain_cmd()
        self._front.end_commands(command.value)


def _call_in_loop(loop: asyncio.AbstractEventLoop, call: Callable[[], None]) -> Callable[[float], bool]:
    """Run `call` in the loop's thread; the result waits for it."""
    import threading

    ran = threading.Event()

    def run() -> None:
        try:
            call()
        finally:
            ran.set()

    try:
        loop.call_soon_threadsafe(run)
    except RuntimeError:  # the loop is closed: nothing is left to end
        ran.set()
    return ran.wait


def _bind(socket: zmq.Socket[Any], key: str, endpoint: str) -> None:
    socket.setsockopt(zmq.LINGER, 0)
    socket.setsockopt(zmq.MAXMSGSIZE, MAX_RECEIVE_BYTES)
    socket.setsockopt(zmq.SNDHWM, 1000)
    socket.setsockopt(zmq.RCVHWM, 1000)
    try:
        socket.bind(endpoint)
    except zmq.ZMQError as error:
        do = "stop the other daemon (`mmmd status` shows it), or choose another port"
        raise config_error(key, f"{endpoint} cannot be bound: {error}", "a free endpoint", do) from error


def _accepted(entry: Entry, plan_id: int, generated: Generated) -> Accepted:
    motion = generated.motion
    return Accepted(
        plan_id=plan_id,
        text=entry.request.text,
        status=motion.status,
        understood=generated.understood,
        reason=generated.reason,
        scope_score=round(motion.scope_score, 4),
        duration_s=round(motion.duration_s, 3),
        generate_ms=round(sum(generated.timings_ms.values()), 2),
    )


def _failed(code: str, found: str, allowed: str, do: str) -> Failed:
    return Failed(code=code, asked="say", found=found, allowed=allowed, do=do)


def _bus_info(snapshot: Any) -> dict[str, Any]:
    info = getattr(snapshot, "counters", None)
    return dict(info) if isinstance(info, dict) else {}


def _line(event: Event) -> str:
    """An event as one line of the log, without what every event has."""
    fields = msgspec.structs.asdict(event)
    skip = ("v", "seq", "t_mono", "id")
    text = " ".join(f"{k}={v!r}" for k, v in fields.items() if k not in skip)
    return f"{event.__struct_config__.tag} {event.id[:8]} {text}"
