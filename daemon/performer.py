"""Carries texts out: generate, arm where allowed, take over, watch the plan to its end.

At most one text is played and one is on its way; the newest wins. Runs in the front's event loop.
"""

from __future__ import annotations

import asyncio
import logging
import time
from dataclasses import dataclass

import msgspec

from daemon.bus_view import BusView
from daemon.config import DaemonConfig
from daemon.generation import Generated, GeneratorClient, GeneratorError
from daemon.ledger import Entry, Ledger
from daemon.planner import Planner
from daemon.shared import BusLink, BusRequest, BusState
from daemon.state import CommandRefusedError, ImpossibleTransitionError, RobotState, StateMachine, Trigger
from daemon.wire import Accepted, Cancelled, CurrentCommand, Failed, Progress, Rejected
from retarget.errors import RetargetError

log = logging.getLogger(__name__)

TICK_S = 0.005
ARM_TIMEOUT_S = 30.0
ARM_ANSWER_S = 2.0
"""How long the bus process may take to begin arming."""
STALL_S = 0.5
"""A plan whose frames are all pushed and whose bus holds so long without playing them was dropped by the bus."""
OVERTAKEN_S = 5.0
"""How much later than a stop a text may arrive that says it was sent before: it is not played."""
BUS_SILENT_S = 1.0
"""A bus process that publishes no cycle for so long is frozen."""
REPORTS = {state: Trigger[f"BUS_{state.name}"] for state in BusState}
OUT_OF_SCOPE_DO = "ask for gestures of head, arms and torso, in English, e.g. 'wave with your right hand'"


@dataclass
class Pending:
    """A text on its way: being generated, waiting for the robot to be armed, or (committing) just being retargeted."""

    entry: Entry
    task: asyncio.Task[None] | None = None
    cancelled_by: str = ""
    committing: bool = False


class Performer:
    """Plays texts on the robot.

    Attributes:
        bus_alive: whether the bus process runs.
        fault_reason: why the robot is in fault, else empty.
        halted_s: when a person last stopped, parked or cut torque, monotonic; `halted_by` tells which.
        stopped: whether a person stopped the robot since the last motion began.
    """

    def __init__(
        self,
        config: DaemonConfig,
        link: BusLink,
        view: BusView,
        planner: Planner,
        machine: StateMachine,
        ledger: Ledger,
        generator: GeneratorClient,
    ) -> None:
        self._config, self._link, self._view, self._generator = config, link, view, generator
        self.planner, self.machine, self._ledger = planner, machine, ledger
        self.bus_alive = True
        self.fault_reason = ""
        self.stopped = False
        self.halted_s, self.halted_by = float("-inf"), ""
        self._pending: Pending | None = None
        self._playing: Entry | None = None
        self._moving_told = False
        self._held_since_s: float | None = None
        self._epoch, self._settled_at = planner.epoch, 0
        self._take_lock = asyncio.Lock()

    def say(self, entry: Entry) -> None:
        """Begin a text; an older one that is still on its way ends in `cancelled`."""
        try:
            self.machine.check(Trigger.SAY)
        except CommandRefusedError as error:
            self._ledger.emit(entry, refusal(entry.id, error))
            return
        sent_s = entry.request.t_mono
        if sent_s is not None and self.halted_s - OVERTAKEN_S < sent_s < self.halted_s:
            self._ledger.emit(entry, Cancelled(plan_id=0, by=self.halted_by))  # the stop came later but arrived first
            return
        if self._pending is not None and not self._pending.committing:
            self._drop_pending(f"say {entry.id}")
        self._pending = Pending(entry)
        self._pending.task = asyncio.create_task(self._perform(self._pending, self.planner.epoch))

    def running_ids(self) -> list[str]:
        """Ids of the commands that have not ended."""
        return [e.id for e in (self._pending.entry if self._pending else None, self._playing) if e is not None]

    def cancel(self, command_id: str) -> None:
        """End one command (any, when the id is empty); a robot that moves for it brakes and holds."""
        if self._playing is not None and command_id in ("", self._playing.id):
            self.stopped = True
            self._link.request(BusRequest.STOP)
            self.end_all("cancel")
        else:
            self._drop_pending("cancel")

    def end_halted(self) -> None:
        """End everything but a text that was sent after the halt, as its own clock says."""
        newest = self._pending.entry if self._pending is not None else self._playing
        sent_s = None if newest is None else newest.request.t_mono
        if sent_s is None or not self.halted_s < sent_s <= time.monotonic():
            self.end_all(self.halted_by)

    def end_all(self, by: str, failed: Failed | None = None) -> None:
        """End what is on its way and what is played, in `cancelled`, or in `failed` when that is given."""
        self._drop_pending(by, failed)
        entry, plan = self._playing, self.planner.current
        self._playing = None
        self.planner.drop()
        if entry is not None:
            plan_id = plan.plan_id if plan is not None else 0
            self._ledger.emit(entry, _ending(plan_id, by, failed))

    def current_command(self) -> CurrentCommand | None:
        """What is being played."""
        entry, plan = self._playing, self.planner.current
        if entry is None or plan is None:
            return None
        return CurrentCommand(entry.id, plan.plan_id, entry.request.text, len(plan.q_rad), plan.pushed)

    def tick(self) -> None:
        """Push setpoints, read the bus's records, follow its state, end the plan that is over."""
        self._link.heartbeat()
        self.planner.pump()
        if self.planner.epoch != self._epoch:  # a stop is on its way: two cycles later the bus process has taken it
            self._epoch, self._settled_at = self.planner.epoch, self._view.index + 3
        self.planner.read_cycles()
        lost = not self.bus_alive or self._view.silent_s > BUS_SILENT_S
        report = Trigger.BUS_LOST if lost else REPORTS[self._view.state]
        if report is Trigger.BUS_HOLDING and self.stopped:
            report = Trigger.BUS_STOPPED
        self._follow(report)
        self._watch_plan()

    def _drop_pending(self, by: str, failed: Failed | None = None) -> None:
        pending, self._pending = self._pending, None
        if pending is None:
            return
        pending.cancelled_by = by
        if not pending.committing and pending.task is not None:
            pending.task.cancel()
        self._ledger.emit(pending.entry, _ending(0, by, failed))

    async def _perform(self, pending: Pending, epoch: int) -> None:
        entry = pending.entry
        try:
            generated = await self._generate(entry)
            if generated is None:
                return
            plan_id = self.planner.new_plan_id()
            self._ledger.emit(entry, _accepted(entry, plan_id, generated))
            await self._until_armed(entry, plan_id)
            pending.committing = True
            async with self._take_lock:
                await self._take_over(pending, generated, plan_id, epoch)
        except CommandRefusedError as error:
            found = f"the robot is in {error.state.value}"
            failed = _failed("wrong_state", found, ", ".join(error.allowed), error.do)
            self._ledger.emit(entry, failed)
        except RetargetError as error:
            self.planner.give_up()
            failed = _failed("retarget", str(error), "a motion that fits the robot", "say it in other words")
            self._ledger.emit(entry, failed)
        except asyncio.CancelledError:
            self._ledger.emit(entry, Cancelled(plan_id=0, by=pending.cancelled_by or "shutdown"))
        except Exception as error:  # one text must not end the daemon
            log.exception("playing %r failed", entry.request.text)
            self.planner.give_up()
            self._ledger.emit(entry, _failed("internal", str(error), "", "see the daemon's log"))
        finally:
            if self._pending is pending:
                self._pending = None

    async def _generate(self, entry: Entry) -> Generated | None:
        """The motion, or None after telling why there is none."""
        request, timeout_s = entry.request, self._config.generate_timeout_s
        try:
            generated = await self._generator.generate(request.text, request.seed, request.seconds, timeout_s)
        except GeneratorError as error:
            found = f"{error.found} (generator: {self._generator.state})"
            failed = Failed(code=error.code, asked=error.asked, found=found, allowed=error.allowed, do=error.do)
            self._ledger.emit(entry, failed)
            return None
        if generated.motion.status != "rejected":
            return generated
        rejected = Rejected(
            code="out_of_scope",
            asked=f"say {request.text!r}",
            found=generated.reason or "nothing the model knows",
            allowed="upper-body motion of one person without objects",
            do=OUT_OF_SCOPE_DO,
            understood=generated.understood,
            scope_score=round(generated.motion.scope_score, 4),
        )
        self._ledger.emit(entry, rejected)
        return None

    async def _until_armed(self, entry: Entry, plan_id: int) -> None:
        """Arm where a text may do so, and wait until the robot can move.

        Raises:
            CommandRefusedError: the robot went into a state in which it takes no text, or did not get ready.
        """
        self.machine.check(Trigger.SAY)
        if self._can_take_over():
            return
        if self.machine.state is RobotState.LIMP:
            self._link.request(BusRequest.ARM)
        if self.machine.state in (RobotState.LIMP, RobotState.ARMING):
            self._ledger.emit(entry, Progress(plan_id=plan_id, stage="arming"))
        asked_s = time.monotonic()
        while not self._can_take_over():
            waited_s = time.monotonic() - asked_s
            if waited_s > (ARM_ANSWER_S if self.machine.state is RobotState.LIMP else ARM_TIMEOUT_S):
                do = f"the robot was not ready after {waited_s:.0f} s; see the log and `mmmd status`"
                raise CommandRefusedError(self.machine.state, Trigger.SAY, ("arm",), do)
            await asyncio.sleep(TICK_S)
            self.machine.check(Trigger.SAY)

    def _can_take_over(self) -> bool:
        """Whether setpoints pushed now would be played from where the joints are."""
        return self._view.state in (BusState.HOLDING, BusState.PLAYING) and self._view.index >= self._settled_at

    async def _take_over(self, pending: Pending, generated: Generated, plan_id: int, epoch: int) -> None:
        """Retarget from the hand-over state and make it the plan; what was played ends in `cancelled`."""
        entry = pending.entry
        while True:
            start = self.planner.hand_over()
            path = await asyncio.to_thread(self.planner.retarget, generated.motion, start)
            if epoch != self.planner.epoch or pending.cancelled_by:
                self.planner.give_up()
                self._ledger.emit(entry, Cancelled(plan_id=plan_id, by=pending.cancelled_by or "stop"))
                return
            if not self.planner.hand_over_missed:
                break
            await self._until_holding()  # the next round starts at rest and cannot miss
        before, self._playing = self._playing, entry
        self._moving_told, self._held_since_s, self.stopped = False, None, False
        previous = self.planner.current
        self.planner.commit(path, plan_id, entry.id, epoch, entry.t_received_ns)
        if before is not None:
            cancelled = Cancelled(plan_id=previous.plan_id if previous else 0, by=f"say {entry.id}")
            self._ledger.emit(before, cancelled)

    async def _until_holding(self) -> None:
        end_s = time.monotonic() + 2.0
        while self._view.state is not BusState.HOLDING and time.monotonic() < end_s:
            await asyncio.sleep(TICK_S)

    def _follow(self, report: Trigger) -> None:
        before = self.machine.state
        try:
            changed = self.machine.report(report)
        except ImpossibleTransitionError as error:
            log.error("%s; e-stop is asked for", error)
            self._link.request(BusRequest.ESTOP)
            return
        if not changed:
            return
        state = self.machine.state
        log.info("state %s -> %s", before.value, state.value)
        if state is RobotState.FAULT:
            self.fault_reason = self._reason(report)
            log.error("fault: %s", self.fault_reason)
            do = "find the cause, then `mmmd reset` and `mmmd arm`"
            self.end_all("fault", _failed("fault", self.fault_reason, "a robot without fault", do))
            return
        self.fault_reason = ""
        if state is RobotState.ESTOP:
            self.end_all("estop")
        elif state in (RobotState.LIMP, RobotState.PARKING):
            self._end_played("park")

    def _reason(self, report: Trigger) -> str:
        if report is not Trigger.BUS_LOST:
            return self._view.message or "the bus process reported a fault"
        how = "silent" if self.bus_alive else "gone"
        return f"the bus process is {how}; its last word: {self._view.message or 'none'}"

    def _end_played(self, by: str) -> None:
        """The robot leaves its torque: what is played ends; a text on its way is refused or arms again by itself."""
        if self._playing is not None:
            self.end_all(by)

    def _watch_plan(self) -> None:
        plan, entry = self.planner.current, self._playing
        if plan is None or entry is None:
            return
        statistics = plan.statistics
        if not self._moving_told and statistics.first_motion_ms is not None:
            self._moving_told = True
            first_ms = round(statistics.first_motion_ms, 2)
            self._ledger.emit(entry, Progress(plan_id=plan.plan_id, stage="moving", first_motion_ms=first_ms))
        idle = plan.all_pushed and self._view.state is BusState.HOLDING and self._link.queued_frames == 0
        self._held_since_s = (self._held_since_s or time.monotonic()) if idle else None
        stalled = self._held_since_s is not None and time.monotonic() - self._held_since_s > STALL_S
        if plan.played or (stalled and statistics.dropped):
            self._playing = None
            self._ledger.emit(entry, statistics.done(plan.path.report, len(plan.q_rad)))
        elif stalled:
            self._playing = None
            found = f"{statistics.last_frame + 1} of {len(plan.q_rad)} frames were played"
            self._ledger.emit(entry, _failed("bus_dropped", found, "all of them", "see the daemon's log"))


def refusal(request_id: str, error: CommandRefusedError) -> Rejected:
    """The event of a command that the robot's state does not allow."""
    return Rejected(
        id=request_id,
        code="wrong_state",
        asked=error.command.value,
        found=f"the robot is in {error.state.value}",
        allowed=", ".join(error.allowed),
        do=error.do,
    )


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


def _ending(plan_id: int, by: str, failed: Failed | None) -> Cancelled | Failed:
    """The event that ends a command; each gets its own, for the ledger fills in its id."""
    return Cancelled(plan_id=plan_id, by=by) if failed is None else msgspec.structs.replace(failed, plan_id=plan_id)


def _failed(code: str, found: str, allowed: str, do: str) -> Failed:
    return Failed(code=code, asked="say", found=found, allowed=allowed, do=do)
