"""Calls of the client over `ctl`: stop, arm and park the robot, and read its state."""

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
    """Calls that the ctl process answers even when the rest of the daemon does not."""

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

        While `carried_out` of the reply is false (the bus process is dead, frozen or starting, or its port is lost) the e-stop
        stays pending, and is carried out when the bus process is back; the state is `estop` then.

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
        """Switch torque on over a pinned goal and move slowly to the rest pose.

        The robot is limp again if arming is broken off; `status` says why.

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
        """Brake within the limits, then go limp where the robot stands; it moves again only after `arm`.

        Raises:
            RefusedError: the state does not allow it.
            NoAnswerError: not in time.
        """
        ack = self._control(Torque(id=uuid.uuid4().hex, on=False))
        if wait:
            self.wait_for("limp", "fault", "estop", timeout_s=timeout_s)
        return ack

    def park(self, *, wait: bool = True, timeout_s: float = 30.0) -> Ack:
        """Move slowly to the park pose, then switch torque off.

        Raises:
            RefusedError: the state does not allow it.
            NoAnswerError: not in time.
        """
        ack = self._control(Park(id=uuid.uuid4().hex))
        if wait:
            self.wait_for("limp", "fault", "estop", timeout_s=timeout_s)
        return ack

    def status(self) -> StateEvent:
        """The present state of robot and daemon, over `ctl`.

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
