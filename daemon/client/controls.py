"""Calls of the client that go through `ctl`: what stops, arms and parks the robot, and what it is doing."""

from __future__ import annotations

import time
import uuid

from daemon.client.compositions import NOT_MOVING
from daemon.client.connection import Connection
from daemon.client.errors import ARMING_ENDS, unexpected, waited_in_vain
from daemon.wire.events import Ack
from daemon.wire.requests import Arm, Estop, Park, Reset, Status, Stop, Torque
from daemon.wire.status import StateEvent


class ControlCalls(Connection):
    """They are answered whatever the rest of the daemon does."""

    def stop(self, *, wait: bool = True) -> Ack:
        """Brake within the limits and hold; with `wait`, return once nothing is played any more.

        Raises:
            NoAnswerError: not in time.
        """
        ack = self._control(Stop(id=uuid.uuid4().hex))
        if wait:
            self.wait_for(*NOT_MOVING, timeout_s=self._timeout_s)
        return ack

    def estop(self, *, wait: bool = True) -> Ack:
        """Cut torque at once (or hold, as the daemon is set), latched; with `wait`, return once the bus process has confirmed it.

        Where `carried_out` of the reply is false (the bus process is dead, frozen or starting, its port is lost) it stays asked
        for, and is carried out when the bus process is back; the state is `estop` then.

        Raises:
            NoAnswerError: not in time.
        """
        ack = self._control(Estop(id=uuid.uuid4().hex))
        if wait:
            self.wait_for("estop", "fault", timeout_s=self._timeout_s)
        return ack

    def reset(self, *, wait: bool = True) -> Ack:
        """Leave e-stop or fault; the robot is limp and must be armed.

        Raises:
            RefusedError: the state does not allow it, or (with `wait`) the robot did not get limp.
            NoAnswerError: not in time.
        """
        ack = self._control(Reset(id=uuid.uuid4().hex))
        if wait and ack.state in ("fault", "estop"):
            self.wait_for("limp", "fault", timeout_s=self._timeout_s)
        return ack

    def arm(self, *, wait: bool = True, timeout_s: float = 30.0) -> Ack:
        """Torque on over a pinned goal, slow move to the rest pose; limp again where that was broken off (`status` tells).

        Raises:
            RefusedError: the state does not allow it.
            NoAnswerError: not in time.
        """
        ack = self._control(Arm(id=uuid.uuid4().hex))
        if wait:
            began_s = time.monotonic()
            if self.wait_for("arming", *ARMING_ENDS, timeout_s=timeout_s).state == "arming":
                left_s = timeout_s - (time.monotonic() - began_s)
                self.wait_for("limp", *ARMING_ENDS, timeout_s=left_s)
        return ack

    def torque_off(self, *, wait: bool = True, timeout_s: float = 30.0) -> Ack:
        """Brake within the limits, then limp where the robot stands; it moves again only after `arm`.

        Raises:
            RefusedError: the state does not allow it.
            NoAnswerError: not in time.
        """
        ack = self._control(Torque(id=uuid.uuid4().hex, on=False))
        if wait:
            self.wait_for("limp", "fault", "estop", timeout_s=timeout_s)
        return ack

    def park(self, *, wait: bool = True, timeout_s: float = 30.0) -> Ack:
        """Slow move to the park pose, then torque off.

        Raises:
            RefusedError: the state does not allow it.
            NoAnswerError: not in time.
        """
        ack = self._control(Park(id=uuid.uuid4().hex))
        if wait:
            self.wait_for("limp", "fault", "estop", timeout_s=timeout_s)
        return ack

    def status(self) -> StateEvent:
        """The robot and the daemon now, by way of `ctl`.

        Raises:
            NoAnswerError: not in time.
        """
        request = Status(id=uuid.uuid4().hex)
        event = self._ask(request, self._ctl_socket(), self.endpoints.ctl)
        if not isinstance(event, StateEvent):
            raise unexpected(event, "status")
        return event

    def wait_for(self, *states: str, timeout_s: float) -> StateEvent:
        """Poll until the robot is in one of `states`.

        Raises:
            NoAnswerError: not in time.
        """
        end_s = time.monotonic() + timeout_s
        while True:
            status = self.status()
            if status.state in states:
                return status
            if time.monotonic() > end_s:
                raise waited_in_vain(self.endpoints.ctl, states, status, timeout_s)
            time.sleep(0.05)
