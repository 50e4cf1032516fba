"""Parks the robot when the daemon ends."""

from __future__ import annotations

import asyncio
import logging
import time

from daemon.host.clock import TICK_S
from daemon.scheduling.scheduler import Scheduler
from daemon.shared_memory.bus_link import BusLink, BusRequest
from daemon.state.machine import RobotState

log = logging.getLogger(__name__)

PARK_AGAIN_S = 1.0
HELD_S = 5.0
"""Seconds that the robot holds when it is stopped meanwhile, before it parks again."""


async def park_at_the_end(
    performer: Scheduler, link: BusLink, timeout_s: float, ticking: asyncio.Task[None] | None
) -> RobotState:
    """End all commands and park, as far as the robot's state allows; returns the state in which the robot is left.

    A robot that is stopped meanwhile holds for `HELD_S`, then parks again.

    Args:
        performer: the commands and the robot's state.
        link: requests to the bus process.
        timeout_s: seconds to wait at most, and more after a stop.
        ticking: the task that ticks `performer`; it may have ended, which is why the robot is to be parked.
    """
    performer.end_all("shutdown")
    machine, follower = performer.machine, performer.follower
    ended = (RobotState.LIMP, RobotState.FAULT, RobotState.ESTOP)
    state = machine.state
    if state in ended or not follower.bus_alive:
        return state
    end_s = time.monotonic() + timeout_s
    asked_s = held_until_s = float("-inf")
    follower.stopped = False
    while (now_s := time.monotonic()) < end_s:
        if ticking is None or ticking.done():
            performer.tick()
        if machine.state in ended:
            return machine.state
        parking = machine.state is RobotState.PARKING and asked_s > 0  # an earlier parking may stay there
        if follower.stopped and held_until_s < asked_s:
            log.warning("stopped while it parks: the robot holds for %g s, then parks again", HELD_S)
            held_until_s = now_s + HELD_S
            end_s = max(end_s, held_until_s + timeout_s / 2)
        elif not parking and now_s - asked_s > PARK_AGAIN_S and now_s > held_until_s:
            follower.stopped = False
            link.request(BusRequest.PARK)
            asked_s = now_s
        await asyncio.sleep(TICK_S)
    log.error("the robot did not park in %g s; it is in %s", timeout_s, machine.state.value)
    return machine.state
