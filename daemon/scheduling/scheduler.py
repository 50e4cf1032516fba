"""Carries commands out: generate the motion, wait for its turn, arm where allowed, take over, follow it to its end.

At most one motion is played; the newest `now` that is accepted wins (`daemon.scheduling.command_queue` has the rule).
The scheduler runs in the front's event loop.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from daemon.host.clock import REAL_CLOCK, LoopClock
from daemon.playback.bus_follower import BusFollower
from daemon.playback.playback import Playback
from daemon.playback.setpoint_buffer import SetpointBuffer
from daemon.playback.sources.prepared_source import PreparedSource
from daemon.playback.sources.source_factory import SourceFactory
from daemon.playback.sources.stream_source import StreamSource
from daemon.poses.layers import Layers
from daemon.scheduling.command_queue import MOST_WAITING, CommandQueue, QueuedCommand, StopOrdering
from daemon.scheduling.turn_taking import TurnTaking
from daemon.settings.config import DaemonConfig
from daemon.shared_memory.bus_link import BusLink, BusRequest
from daemon.state.lease import LeaseState
from daemon.state.ledger import Entry, Ledger
from daemon.state.machine import CommandRefusedError, RobotState, StateMachine, Trigger
from daemon.state.replies import (
    NotPlayableError,
    ending,
    failed,
    lease_held,
    lease_silent,
    queue_full,
    refusal,
    refused_later,
    stop_note,
)
from daemon.wire.events import Ack, Cancelled, Failed, Progress
from daemon.wire.requests import Lease
from daemon.wire.status import CurrentCommand
from retarget.errors import RetargetError

log = logging.getLogger(__name__)


class Scheduler:
    """Plays commands on the robot.

    Attributes:
        follower: the robot's state.
        halts: knows when a person last stopped the robot.
        layers: gaze and idle movements.
    """

    def __init__(
        self,
        config: DaemonConfig,
        link: BusLink,
        planner: SetpointBuffer,
        follower: BusFollower,
        ledger: Ledger,
        sources: SourceFactory,
        clock: LoopClock = REAL_CLOCK,
    ) -> None:
        self._config, self._link, self._ledger, self._sources = config, link, ledger, sources
        self.planner, self.follower = planner, follower
        self.layers = Layers(config.idle)
        self.halts = StopOrdering()
        self._waiting = CommandQueue()
        self._player = Playback(planner, follower, ledger, self.layers, sources.verdict, clock)
        self._turns = TurnTaking(self._waiting, self._player, planner, follower, link, clock)

    @property
    def machine(self) -> StateMachine:
        """The robot's state machine."""
        return self.follower.machine

    def play(self, entry: Entry) -> None:
        """Begin a command; older commands that it overtakes end in `cancelled` once it is accepted."""
        try:
            self.machine.check(Trigger.SAY)
        except CommandRefusedError as error:
            self._ledger.emit(entry, refusal(entry.id, error))
            return
        if self.halts.overtook(entry):  # the stop came later but arrived first
            self._ledger.emit(entry, Cancelled(plan_id=0, by=self.halts.by))
            return
        if isinstance(entry.request, Lease) and (lease := self.lease) is not None:
            self._ledger.emit(entry, lease_held(lease))
            return
        pending = QueuedCommand(entry, self.planner.epoch)
        if self._waiting.full and entry.request.when == "now":  # a `now` always gets in; one being generated gives way
            if (oldest := self._waiting.oldest_undecided) is not None:
                self._drop(oldest, entry.named)
        elif self._waiting.full:
            self._ledger.emit(entry, queue_full(entry.request, len(self._waiting), MOST_WAITING))
            return
        self._waiting.add(pending)
        pending.task = asyncio.create_task(self._perform(pending))

    def stop_for(self, entry: Entry) -> None:
        """Brake within the limits and hold, because a command's text means to stop, and end all other commands."""
        state, n_ended = self.machine.state, len(self.running_ids())
        try:
            self.machine.check(Trigger.STOP)
        except CommandRefusedError as error:
            self._ledger.emit(entry, refusal(entry.id, error))
            return
        self.halts.note(Trigger.STOP.value, entry.request)
        self.follower.stopped = True
        self._link.request(BusRequest.STOP)
        self.end_halted()
        self.halts.served()
        self._ledger.emit(entry, Ack(verb="stop", state=state.value, note=stop_note(entry.request.words, n_ended)))

    def running_ids(self) -> list[str]:
        """Ids of the commands that have not ended."""
        playing = self._player.entry
        return [*self.waiting_ids(), *([playing.id] if playing is not None else [])]

    @property
    def lease(self) -> Entry | None:
        """The lease that is held, from its request to its end; None without one."""
        playing = self._player.entry
        entries = [p.entry for p in self._waiting] + ([playing] if playing is not None else [])
        return next((entry for entry in entries if isinstance(entry.request, Lease) and not entry.ended), None)

    @property
    def stream(self) -> StreamSource | None:
        """The stream of the lease that is played; None without one."""
        return self._player.stream

    def release(self) -> None:
        """Give the lease back for its holder: a lease that is played moves on to its last target, one that waits is cancelled."""
        if (score := self._player.stream) is not None:
            score.clock.release()
        elif (lease := self.lease) is not None:
            self.cancel(lease.id)

    def target(self, q_rad: NDArray[np.float64]) -> bool:
        """Take a checked target (J,) of the lease that is played, radians; returns whether the lease takes it."""
        return self._player.target(q_rad)

    def waiting_ids(self) -> list[str]:
        """Ids of the commands that are not played yet."""
        return [p.entry.id for p in self._waiting]

    def cancel(self, command_id: str) -> None:
        """End one command, or all when the id is empty; a robot that moves for it brakes and holds."""
        playing = self._player.entry
        if playing is not None and command_id in ("", playing.id):
            before = self.planner.epoch
            self.follower.stopped = True
            self._link.request(BusRequest.STOP)
            for pending in self._waiting:
                if pending.epoch == before:  # a command that waits for its turn has not been stopped
                    pending.epoch = self.planner.epoch
            self._player.end("cancel")
        for pending in self._waiting:
            if command_id in ("", pending.entry.id):
                self._drop(pending, "cancel")

    def end_halted(self) -> None:
        """End all commands except those sent after the halt, by their own clock.

        A motion ends as well that began to play before the front knew of the halt: the bus process has thrown its setpoints away.
        """
        playing = self._player.entry
        if playing is None or not self.halts.spares(playing) or not self.planner.running:
            self._player.end(self.halts.by)
        for pending in self._waiting:
            if self.halts.spares(pending.entry):
                pending.epoch = self.planner.epoch
            else:
                self._drop(pending, self.halts.by)

    def end_all(self, by: str, failure: Failed | None = None) -> None:
        """End all commands that wait or are played, in `cancelled`, or in `failed` when `failure` is given."""
        for pending in self._waiting:
            self._drop(pending, by, failure)
        self._player.end(by, failure)

    def current_command(self) -> CurrentCommand | None:
        """The command that is being played; None without one."""
        return self._player.current_command()

    def look_again(self) -> None:
        """Apply a changed gaze to the running motion, or to the pose that is held."""
        self._player.start(self._player.follow_gaze())

    def tick(self) -> None:
        """Follow the bus process, end what is over, supply the running motion with frames, idle."""
        for state in self.follower.update():
            self._entered(state)
        waiting = self._waiting
        self._player.watch(finish_loop=waiting.someone_waits_after, is_to_last=not waiting.someone_is_about)
        self._end_silent_lease()
        self._player.idle(free=not len(self._waiting))

    def _end_silent_lease(self) -> None:
        """End a lease in failure when its holder was silent for too long; the robot then parks, unless a command waits for it."""
        score = self._player.stream
        if score is None or score.clock.state is not LeaseState.OVER:
            return
        self._player.end("silence", lease_silent(score.clock.park_s, score.targets))
        if not len(self._waiting):
            log.warning("a lease fell silent for %g s: parking", score.clock.park_s)
            self._link.request(BusRequest.PARK, stay_s=self._config.lease_limp_s)

    def _entered(self, state: RobotState) -> None:
        """End the commands that the robot's new state ends."""
        if state is RobotState.FAULT:
            do = "find the cause, then `mmmd reset` and `mmmd arm`"
            self.end_all("fault", failed("fault", self.follower.fault_reason, "a robot without fault", do))
        elif state is RobotState.ESTOP:
            self.end_all("estop")
        elif state in (RobotState.LIMP, RobotState.PARKING):
            self._player.end("park")  # a command in the queue is refused or arms again by itself

    def _overtake(self, newest: QueuedCommand) -> None:
        for pending in self._waiting.overtaken_by(newest):
            self._waiting.withdraw(pending, newest.entry.named)
            newest.overtook.append(pending.entry)
        if newest.entry.accepted:
            self._tell_overtaken(newest)

    def _tell_overtaken(self, newest: QueuedCommand) -> None:
        for entry in newest.overtook:
            self._ledger.emit(entry, ending(0, newest.entry.named, None))

    def _drop(self, pending: QueuedCommand, by: str, failure: Failed | None = None) -> None:
        self._waiting.withdraw(pending, by)
        self._ledger.emit(pending.entry, ending(0, by, failure))

    async def _perform(self, pending: QueuedCommand) -> None:
        entry = pending.entry
        try:
            prepared = await self._sources.prepare(entry, self._player)
            if pending.cancelled_by:  # Python 3.11's `wait_for` may swallow the cancellation
                return
            self._turns.check_deadline(entry)
            plan_id = self.planner.new_plan_id()
            self._sources.kept.number(entry.id, plan_id)
            if not self._begins_now(pending):
                await self._accept(pending, prepared, plan_id)
            await self._turns.come(pending, self._overtake)
            arming = Progress(plan_id=plan_id, stage="arming")
            await self._turns.until_armed(entry, lambda: self._ledger.emit(entry, arming))
            await self._turns.give_way(pending)
            await self._take_over(pending, prepared, plan_id)
        except NotPlayableError as error:
            self._ledger.emit(entry, error.event)
        except CommandRefusedError as error:
            self._ledger.emit(entry, refused_later(error))
        except RetargetError as error:
            event = failed("retarget", str(error), "a motion that fits the robot", "say it in other words")
            self._ledger.emit(entry, event)
        except asyncio.CancelledError:
            if not pending.cancelled_by:  # else whoever cancelled it tells so
                self._ledger.emit(entry, Cancelled(plan_id=0, by="shutdown"))
        except Exception as error:  # one command must not end the daemon
            log.exception("playing %r failed", entry.request.words)
            self._ledger.emit(entry, failed("internal", str(error), "", "see the daemon's log"))
        finally:
            self._tell_overtaken(pending)
            self._waiting.remove(pending)

    def _begins_now(self, pending: QueuedCommand) -> bool:
        """Whether the robot can begin a command at once; the description for `accepted` is then read after the first frames."""
        is_now = pending.entry.request.when == "now" and not self._waiting.may_be_overtaken(pending)
        return is_now and self.follower.can_take_over

    async def _accept(self, pending: QueuedCommand, prepared: PreparedSource, plan_id: int) -> None:
        entry = pending.entry
        if not (entry.accepted or entry.ended):
            self._ledger.emit(entry, await prepared.accepted(entry, plan_id))
        self._tell_overtaken(pending)

    async def _take_over(self, pending: QueuedCommand, prepared: PreparedSource, plan_id: int) -> None:
        """Play the command from now on; the command played before ends in `cancelled`."""
        entry = pending.entry
        pending.committing = True
        alive: Callable[[], bool] = lambda: not pending.cancelled_by and pending.epoch == self.planner.epoch  # noqa: E731

        async def told() -> None:
            self._waiting.remove(pending)
            await self._accept(pending, prepared, plan_id)

        try:
            begun = await self._player.take_over(entry, prepared.score, plan_id, pending.epoch, alive, told)
        except RetargetError:
            await told()
            raise
        if not begun:
            self._ledger.emit(entry, Cancelled(plan_id=plan_id, by=pending.cancelled_by or self.halts.by or "stop"))
