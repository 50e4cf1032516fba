"""Calls of the asyncio client that go through `ctl`; arguments and errors as for `daemon.client.controls`."""

from __future__ import annotations

import asyncio
import time
import uuid

from daemon.client.async_connection import AsyncConnection
from daemon.client.compositions import NOT_MOVING
from daemon.client.errors import ARMING_ENDS, unexpected, waited_in_vain
from daemon.wire.events import Ack
from daemon.wire.requests import Arm, Estop, Park, Reset, Status, Stop, Torque
from daemon.wire.status import StateEvent


class AsyncControlCalls(AsyncConnection):
    """Calls that the ctl process answers even when the rest of the daemon does not."""

    async def stop(self, *, wait: bool = True) -> Ack:
        """Brake within the limits and hold; with `wait`, return once nothing is played any more."""
        ack = await self._control(Stop(id=uuid.uuid4().hex))
        if wait:
            await self.wait_for(*NOT_MOVING, timeout_s=self._timeout_s)
        return ack

    async def estop(self, *, wait: bool = True) -> Ack:
        """Cut torque at once (or hold, as the daemon is set), latched; with `wait`, return once it is confirmed."""
        ack = await self._control(Estop(id=uuid.uuid4().hex))
        if wait:
            await self.wait_for("estop", "fault", timeout_s=self._timeout_s)
        return ack

    async def reset(self, *, wait: bool = True) -> Ack:
        """Leave e-stop or fault; the robot is limp and must be armed."""
        ack = await self._control(Reset(id=uuid.uuid4().hex))
        if wait and ack.state in ("fault", "estop"):
            await self.wait_for("limp", "fault", timeout_s=self._timeout_s)
        return ack

    async def arm(self, *, wait: bool = True, timeout_s: float = 30.0) -> Ack:
        """Switch torque on over a pinned goal and move slowly to the rest pose; the robot is limp again if that is broken off."""
        ack = await self._control(Arm(id=uuid.uuid4().hex))
        if wait:
            began_s = time.monotonic()
            if (await self.wait_for("arming", *ARMING_ENDS, timeout_s=timeout_s)).state == "arming":
                left_s = timeout_s - (time.monotonic() - began_s)
                await self.wait_for("limp", *ARMING_ENDS, timeout_s=left_s)
        return ack

    async def torque_off(self, *, wait: bool = True, timeout_s: float = 30.0) -> Ack:
        """Brake within the limits, then go limp where the robot stands; it moves again only after `arm`."""
        ack = await self._control(Torque(id=uuid.uuid4().hex, on=False))
        if wait:
            await self.wait_for("limp", "fault", "estop", timeout_s=timeout_s)
        return ack

    async def park(self, *, wait: bool = True, timeout_s: float = 30.0) -> Ack:
        """Move slowly to the park pose, then switch torque off."""
        ack = await self._control(Park(id=uuid.uuid4().hex))
        if wait:
            await self.wait_for("limp", "fault", "estop", timeout_s=timeout_s)
        return ack

    async def status(self) -> StateEvent:
        """The present state of robot and daemon, over `ctl`."""
        event = await self._ask(Status(id=uuid.uuid4().hex), self.endpoints.ctl)
        if not isinstance(event, StateEvent):
            raise unexpected(event, "status")
        return event

    async def wait_for(self, *states: str, timeout_s: float) -> StateEvent:
        """Poll until the robot is in one of `states`.

        Raises:
            NoAnswerError: the robot was in none of them in time.
        """
        end_s = time.monotonic() + timeout_s
        while True:
            status = await self.status()
            if status.state in states:
                return status
            if time.monotonic() > end_s:
                raise waited_in_vain(self.endpoints.ctl, states, status, timeout_s)
            await asyncio.sleep(0.05)
