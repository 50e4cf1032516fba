"""The robot's states as one transition table. No I/O.

Reports of the bus process move the state. A command is allowed where the table has an entry for it and
is refused elsewhere; the entry is the state it leads to once the bus process has carried it out.
"""

from __future__ import annotations

from enum import Enum

from daemon.errors import DaemonError
from daemon.wire.showing import in_words


class RobotState(Enum):
    """States of the robot as people see them."""

    LIMP = "limp"  # torque off
    ARMING = "arming"  # torque on over a pinned goal, slow move to the rest pose
    IDLE = "idle"  # armed, nothing to play
    MOVING = "moving"
    HOLDING = "holding"  # stopped by a person: decelerating, or still with torque on
    PARKING = "parking"  # slow move to the park pose, then torque off
    FAULT = "fault"  # latched: servo, bus or process failed
    ESTOP = "estop"  # latched: torque cut by a person, or held where the daemon is set so


class Trigger(Enum):
    """Commands of people and reports of the bus process (its `BusState` by name)."""

    SAY = "say"
    ARM = "arm"
    PARK = "park"
    STOP = "stop"
    TORQUE_OFF = "torque off"
    ESTOP = "estop"
    RESET = "reset"
    BUS_LIMP = "bus limp"
    BUS_ARMING = "bus arming"
    BUS_HOLDING = "bus holding"
    BUS_STOPPED = "bus holding after a stop"
    BUS_PLAYING = "bus playing"
    BUS_IDLING = "bus playing idle movements"
    BUS_STOPPING = "bus stopping"
    BUS_PARKING = "bus parking"
    BUS_FAULT = "bus fault"
    BUS_ESTOP = "bus estop"
    BUS_LOST = "bus lost"  # the bus process died or is frozen


COMMANDS = (
    Trigger.SAY, Trigger.ARM, Trigger.PARK, Trigger.STOP, Trigger.TORQUE_OFF, Trigger.ESTOP, Trigger.RESET,
)  # fmt: skip
REPORTS = tuple(t for t in Trigger if t not in COMMANDS)

_S, _T = RobotState, Trigger
_ARMED_REPORTS = {
    _T.BUS_LIMP: _S.LIMP, _T.BUS_STOPPED: _S.HOLDING, _T.BUS_PLAYING: _S.MOVING, _T.BUS_STOPPING: _S.HOLDING,
    _T.BUS_PARKING: _S.PARKING,
}  # fmt: skip
_ALWAYS = {
    _T.ESTOP: _S.ESTOP, _T.BUS_FAULT: _S.FAULT, _T.BUS_ESTOP: _S.ESTOP, _T.BUS_LOST: _S.FAULT,
}  # fmt: skip

TRANSITIONS: dict[RobotState, dict[Trigger, RobotState]] = {
    # Arming may begin and end between two reports of the bus process; motion and parking from limp may not.
    _S.LIMP: {
        **_ALWAYS, _T.SAY: _S.ARMING, _T.ARM: _S.ARMING, _T.PARK: _S.LIMP, _T.STOP: _S.LIMP, _T.TORQUE_OFF: _S.LIMP,
        _T.RESET: _S.LIMP, _T.BUS_LIMP: _S.LIMP, _T.BUS_ARMING: _S.ARMING, _T.BUS_HOLDING: _S.IDLE, _T.BUS_STOPPED: _S.IDLE,
    },
    _S.ARMING: {
        **_ALWAYS, **_ARMED_REPORTS, _T.SAY: _S.MOVING, _T.ARM: _S.ARMING, _T.PARK: _S.PARKING, _T.STOP: _S.HOLDING,
        _T.TORQUE_OFF: _S.LIMP, _T.RESET: _S.ARMING, _T.BUS_ARMING: _S.ARMING, _T.BUS_HOLDING: _S.IDLE,
    },
    _S.IDLE: {
        **_ALWAYS, **_ARMED_REPORTS, _T.SAY: _S.MOVING, _T.ARM: _S.IDLE, _T.PARK: _S.PARKING, _T.STOP: _S.IDLE,
        _T.TORQUE_OFF: _S.LIMP, _T.RESET: _S.IDLE, _T.BUS_HOLDING: _S.IDLE, _T.BUS_STOPPED: _S.IDLE,
        _T.BUS_IDLING: _S.IDLE,
    },
    _S.MOVING: {
        **_ALWAYS, **_ARMED_REPORTS, _T.SAY: _S.MOVING, _T.ARM: _S.MOVING, _T.PARK: _S.PARKING, _T.STOP: _S.HOLDING,
        _T.TORQUE_OFF: _S.LIMP, _T.RESET: _S.MOVING, _T.BUS_HOLDING: _S.IDLE, _T.BUS_IDLING: _S.IDLE,
    },
    _S.HOLDING: {
        **_ALWAYS, **_ARMED_REPORTS, _T.SAY: _S.MOVING, _T.ARM: _S.HOLDING, _T.PARK: _S.PARKING, _T.STOP: _S.HOLDING,
        _T.TORQUE_OFF: _S.LIMP, _T.RESET: _S.HOLDING, _T.BUS_HOLDING: _S.HOLDING, _T.BUS_IDLING: _S.HOLDING,
    },
    _S.PARKING: {
        **_ALWAYS, _T.PARK: _S.PARKING, _T.STOP: _S.HOLDING, _T.TORQUE_OFF: _S.LIMP,
        _T.BUS_LIMP: _S.LIMP, _T.BUS_PARKING: _S.PARKING, _T.BUS_STOPPING: _S.HOLDING, _T.BUS_HOLDING: _S.HOLDING,
        _T.BUS_STOPPED: _S.HOLDING, _T.BUS_ARMING: _S.ARMING,
    },
    # Both latch: only a reset leads out, and only to limp.
    _S.FAULT: {**_ALWAYS, _T.RESET: _S.LIMP, _T.STOP: _S.FAULT, _T.BUS_LIMP: _S.LIMP},
    _S.ESTOP: {
        _T.ESTOP: _S.ESTOP, _T.RESET: _S.LIMP, _T.STOP: _S.ESTOP,
        _T.BUS_ESTOP: _S.ESTOP, _T.BUS_LIMP: _S.LIMP, _T.BUS_FAULT: _S.FAULT, _T.BUS_LOST: _S.FAULT,
    },
}  # fmt: skip

_ADVICE = {
    _S.FAULT: "find the cause, then `mmmd reset` and `mmmd arm`",
    _S.ESTOP: "`mmmd reset`, then `mmmd arm`",
    _S.PARKING: "wait until the robot is limp, or `mmmd stop`",
}
_NEEDS_ARM = "`mmmd arm`: after an e-stop, a fault or `torque off` the robot moves only once a person has armed it"


class CommandRefusedError(DaemonError):
    """A command that the robot's state does not allow."""

    def __init__(self, state: RobotState, command: Trigger, allowed: tuple[str, ...], do: str) -> None:
        self.state, self.command, self.allowed, self.do = state, command, allowed, do
        super().__init__(
            f"{command.value}: the robot is {in_words(state.value)}; allowed now: {', '.join(allowed)}; {do}"
        )


class ImpossibleTransitionError(DaemonError):
    """The bus process reported a state that cannot follow the one before."""

    def __init__(self, state: RobotState, report: Trigger) -> None:
        self.state, self.report = state, report
        super().__init__(f"'{report.value}' cannot follow the robot's state '{state.value}'")


class StateMachine:
    """Holds the robot's state, which reports move, and decides which commands are allowed.

    Attributes:
        state: the robot's state.
        must_arm: whether an e-stop, a fault or `torque off` came since the last explicit `arm`; then `say` does not arm.
    """

    def __init__(self, *, auto_arm: bool = True) -> None:
        self.state = RobotState.LIMP
        self.must_arm = not auto_arm

    def check(self, command: Trigger) -> RobotState:
        """The state to which `command` leads from the present one.

        Raises:
            CommandRefusedError: the present state does not allow the command.
        """
        allowed = tuple(t.value for t in COMMANDS if self._allows(t))
        if not self._allows(command):
            do = _NEEDS_ARM if self.state is RobotState.LIMP else _ADVICE.get(self.state, "`mmmd status` tells more")
            raise CommandRefusedError(self.state, command, allowed, do)
        return TRANSITIONS[self.state][command]

    def armed_by_person(self) -> None:
        """Note an explicit `arm`, after which commands may arm again."""
        self.must_arm = False

    def limp_by_person(self) -> None:
        """Note an explicit `torque off`: only a person may arm next, because somebody may have the arms in their hands."""
        self.must_arm = True

    def report(self, report: Trigger) -> bool:
        """Follow a report of the bus process; returns whether the state changed.

        Raises:
            ImpossibleTransitionError: the report cannot follow the present state, which stays.
        """
        following = TRANSITIONS[self.state].get(report)
        if following is None or report not in REPORTS:
            raise ImpossibleTransitionError(self.state, report)
        changed = following is not self.state
        self.state = following
        if following in (RobotState.FAULT, RobotState.ESTOP):
            self.must_arm = True
        return changed

    def _allows(self, command: Trigger) -> bool:
        if command is Trigger.SAY and self.state is RobotState.LIMP and self.must_arm:
            return False
        return command in TRANSITIONS[self.state]
