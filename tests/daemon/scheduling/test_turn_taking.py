"""A text arms a limp robot only when no halt is pending that the front has not been told about."""

from __future__ import annotations

import asyncio
from contextlib import closing
from types import SimpleNamespace
from typing import Any, cast

from daemon.host.clock import RealClock
from daemon.scheduling.turn_taking import TurnTaking
from daemon.shared_memory.bus_link import BusLink, BusRequest
from daemon.shared_memory.request_words import Asker
from daemon.state.machine import RobotState, StateMachine


def test_a_text_does_not_arm_after_a_stop_that_the_front_has_not_read() -> None:
    async def told(link: BusLink, ctl: BusLink) -> None:
        machine = StateMachine()
        machine.state = RobotState.LIMP
        follower = SimpleNamespace(machine=machine, can_take_over=False)
        nothing = cast(Any, None)
        turns = TurnTaking(nothing, nothing, nothing, cast(Any, follower), link, RealClock())
        stop = ctl.request(BusRequest.STOP)
        waiting = asyncio.create_task(turns.until_armed(cast(Any, SimpleNamespace(deadline_s=1e9)), lambda: None))
        await asyncio.sleep(0.1)
        assert not link.owes(BusRequest.ARM)
        link.epochs.know_of(stop)
        await asyncio.sleep(0.1)
        assert link.owes(BusRequest.ARM)
        waiting.cancel()

    link = BusLink.create(2)
    try:
        with closing(BusLink.attach(link.path, link.n_joints, asker=Asker.CTL)) as ctl:
            asyncio.run(told(link, ctl))
    finally:
        link.close()
