"""Arms the robot for a command, where a command may do so, and waits until it can move."""

from __future__ import annotations

from collections.abc import Callable

from daemon.host.clock import TICK_S, LoopClock
from daemon.playback.bus_follower import BusFollower
from daemon.shared_memory.bus_link import BusLink, BusRequest
from daemon.state.machine import CommandRefusedError, RobotState, Trigger

ARM_TIMEOUT_S = 30.0
ARM_ANSWER_S = 2.0
"""How long the bus process may take to begin arming."""


async def until_armed(follower: BusFollower, link: BusLink, tell: Callable[[], None], clock: LoopClock) -> None:
    """Arm where a command may do so, and wait until the robot can move; `tell` is called when it has to be armed first.

    Raises:
        CommandRefusedError: the robot went into a state in which it takes no command, or did not get ready.
    """
    machine = follower.machine
    machine.check(Trigger.SAY)
    if follower.can_take_over:
        return
    if machine.state is RobotState.LIMP:
        link.request(BusRequest.ARM)
    if machine.state in (RobotState.LIMP, RobotState.ARMING):
        tell()
    asked_s = clock.now_s()
    while not follower.can_take_over:
        waited_s = clock.now_s() - asked_s
        if waited_s > (ARM_ANSWER_S if machine.state is RobotState.LIMP else ARM_TIMEOUT_S):
            do = f"the robot was not ready after {waited_s:.0f} s; see the log and `mmmd status`"
            raise CommandRefusedError(machine.state, Trigger.SAY, ("arm",), do)
        await clock.sleep(TICK_S)
        machine.check(Trigger.SAY)
