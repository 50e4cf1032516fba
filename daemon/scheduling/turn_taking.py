"""Conditions for a command to take over: its deadline, its turn or time, an armed robot, and no newer command about to win."""

from __future__ import annotations

from collections.abc import Callable

from daemon.host.clock import TICK_S, LoopClock, sleep_while
from daemon.playback.bus_follower import BusFollower
from daemon.playback.playback import Playback
from daemon.playback.setpoint_buffer import SetpointBuffer
from daemon.scheduling.command_queue import CommandQueue, QueuedCommand
from daemon.shared_memory.bus_link import BusLink, BusRequest
from daemon.state.ledger import Entry
from daemon.state.machine import CommandRefusedError, RobotState, Trigger
from daemon.state.replies import too_late

YIELD_S = 0.25
"""Seconds that a finished motion waits at most for a newer one that is being generated: most take a tenth of that."""
ARMING_S = 1.5
"""Seconds that a limp robot needs at least to begin a motion: a command with a shorter deadline is rejected at once."""
ARM_TIMEOUT_S = 30.0
"""Seconds that arming may take."""
ARM_ANSWER_S = 2.0
"""Seconds that the bus process has to begin arming."""


class TurnTaking:
    """Decides when each command takes over.

    Args:
        queue: the commands that are not played yet.
        playback: the command that is played.
        planner: buffer of the frames still to be played.
        follower: the robot's state.
        link: shared memory, through which the bus process is asked to arm.
        clock: clock of the waiting.
    """

    def __init__(
        self,
        queue: CommandQueue,
        playback: Playback,
        planner: SetpointBuffer,
        follower: BusFollower,
        link: BusLink,
        clock: LoopClock,
    ) -> None:
        self._queue, self._playback, self._planner = queue, playback, planner
        self._follower, self._link, self._clock = follower, link, clock

    def check_deadline(self, entry: Entry) -> None:
        """Refuse at once a command that cannot begin in time.

        Raises:
            NotPlayableError: the command cannot begin before its deadline.
        """
        request, earliest_s = entry.request, self._clock.now_s()
        if request.deadline_s is None:
            return
        found = "the motion was ready too late"
        if request.when == "at" and request.at_s is not None:
            earliest_s, found = max(earliest_s, request.at_s), "its time is later than that"
        if request.when == "after" and self._playback.entry is not None:
            earliest_s, found = earliest_s + self._planner.ahead_s, "what is played before it ends later than that"
        if self._follower.machine.state is RobotState.LIMP:
            earliest_s, found = earliest_s + ARMING_S, "the robot has to be armed first"
        if earliest_s > entry.deadline_s:
            raise too_late(entry, found)

    async def come(self, pending: QueuedCommand, overtake: Callable[[QueuedCommand], None]) -> None:
        """Wait for the command's turn or time, then call `overtake` for a command that ends older ones.

        Raises:
            NotPlayableError: the command's turn did not come before its deadline.
        """
        request = pending.entry.request
        if request.when == "now":
            overtake(pending)
        elif request.when == "at" and request.at_s is not None:
            while (left_s := request.at_s - self._clock.now_s()) > 0:
                await self._clock.sleep(min(left_s, 1.0))
            self._queue.renew(pending)
            overtake(pending)
        elif request.when == "after":
            while self._playback.entry is not None or not self._queue.is_next(pending):
                await self._clock.sleep(TICK_S)
                if self._clock.now_s() > pending.entry.deadline_s:
                    raise too_late(pending.entry, "its turn did not come in time")
        pending.turn = True

    async def until_armed(self, entry: Entry, tell: Callable[[], None]) -> None:
        """Arm where a command may do so, and wait until the robot can move; `tell` is called when the robot must be armed first.

        Raises:
            CommandRefusedError: the robot went into a state in which it takes no command, or did not get ready.
            NotPlayableError: the robot got ready after the command's deadline.
        """
        machine = self._follower.machine
        machine.check(Trigger.SAY)
        if not self._follower.can_take_over:
            while machine.state is RobotState.LIMP and not self._ask_to_arm():
                await self._clock.sleep(TICK_S)
                machine.check(Trigger.SAY)
            if machine.state in (RobotState.LIMP, RobotState.ARMING):
                tell()
        asked_s = self._clock.now_s()
        while not self._follower.can_take_over:
            waited_s = self._clock.now_s() - asked_s
            if waited_s > (ARM_ANSWER_S if machine.state is RobotState.LIMP else ARM_TIMEOUT_S):
                do = f"the robot was not ready after {waited_s:.0f} s; see the log and `mmmd status`"
                raise CommandRefusedError(machine.state, Trigger.SAY, ("arm",), do)
            await self._clock.sleep(TICK_S)
            machine.check(Trigger.SAY)
        if self._clock.now_s() > entry.deadline_s:
            raise too_late(entry, "its turn came too late")

    def _ask_to_arm(self) -> bool:
        """Ask to arm, unless there is a halt that the front has not been told about yet; returns whether this was asked."""
        number = self._link.new_number()  # before the look at the halts, so that a halt after it makes the request void
        if self._link.epochs.unknown_halts:
            return False
        self._link.request(BusRequest.ARM, number=number)
        return True

    async def give_way(self, pending: QueuedCommand) -> None:
        """Wait a moment for a newer command that may soon take over, so that the robot does not start two motions."""
        at_most_s = min(YIELD_S, pending.entry.deadline_s - self._clock.now_s())
        await sleep_while(self._clock, lambda: self._queue.may_be_overtaken(pending), at_most_s)
