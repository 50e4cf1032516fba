"""Follows the bus process: its reports move the robot's state. A report that the state table does not allow leads to an e-stop."""

from __future__ import annotations

import logging

from daemon.playback.setpoint_buffer import SetpointBuffer
from daemon.shared_memory.bus_link import Asked, BusLink, BusRequest, BusState
from daemon.state.bus_view import BusView
from daemon.state.machine import ImpossibleTransitionError, RobotState, StateMachine, Trigger

log = logging.getLogger(__name__)

BUS_SILENT_S = 1.0
"""Seconds without a published cycle after which the bus process counts as frozen."""
SETTLING_CYCLES = 3
"""Number of bus cycles after a stop by which the bus process has surely taken it."""
_PLACES = {state: place for place, state in enumerate(RobotState)}
REPORTS = {state: Trigger[f"BUS_{state.name}"] for state in BusState}


class BusFollower:
    """Keeps the robot's state, updated once a tick.

    Attributes:
        bus_alive: whether the bus process runs.
        fault_reason: reason of the robot's fault, or of an e-stop without a request; else empty.
        stopped: whether a person stopped the robot since it was armed and the last motion began.
        idling: whether idle movements are played.
    """

    def __init__(self, link: BusLink, view: BusView, planner: SetpointBuffer, machine: StateMachine) -> None:
        self._link, self._view, self._planner, self.machine = link, view, planner, machine
        self.bus_alive = True
        self.fault_reason = ""
        self._own_estop = ""
        self._to_latch: Asked | None = None
        self.stopped = False
        self.idling = False
        self._epoch: int = planner.epoch
        self._settled_at = 0

    def update(self) -> list[RobotState]:
        """Send the heartbeat, push setpoints, read records and update the state; returns the states entered since the last call."""
        self._link.heartbeat()
        self._planner.pump()
        if self._planner.epoch != self._epoch:
            self._epoch, self._settled_at = self._planner.epoch, self._view.index + SETTLING_CYCLES
        was_latched = self._to_latch is not None and self._link.carried_out(self._to_latch)
        self._planner.read_cycles()
        if self.machine.state is RobotState.FAULT and self.bus_alive and self._view.message:
            self.fault_reason = self._view.message  # the bus process is back and reports the reason itself
        entered = [self._follow(self._report(state)) for state in self._view.passed or [self._view.state]]
        if was_latched and self._to_latch is not None:  # a reset, or a new bus process, came before the fault was seen
            self._to_latch = None
            entered.append(self._follow(self._report(self._view.state)))
        self._link.show_robot_state(_PLACES[self.machine.state])
        return [state for state in entered if state is not None]

    @property
    def can_take_over(self) -> bool:
        """Whether setpoints pushed now would be played from where the joints are."""
        return self._view.state in (BusState.HOLDING, BusState.PLAYING) and self._view.index >= self._settled_at

    @property
    def holds(self) -> bool:
        """Whether the bus process holds and has nothing left to play."""
        return self._view.state is BusState.HOLDING and self._link.setpoints.queued_frames == 0

    @property
    def bus_answers(self) -> bool:
        """Whether the bus process runs, and its newest cycle is not old."""
        return self.bus_alive and self._view.silent_s <= BUS_SILENT_S

    @property
    def at_rest(self) -> bool:
        """Whether no goal moves."""
        return self._view.at_rest

    def _report(self, state: BusState) -> Trigger:
        if not self.bus_answers:
            if self.bus_alive and self._to_latch is None:
                # A frozen bus process must not continue its motion when it runs again.
                self._to_latch = self._link.request(BusRequest.FAULT)
            return Trigger.BUS_LOST
        if self._to_latch is not None and state not in (BusState.FAULT, BusState.ESTOP):
            return Trigger.BUS_LOST  # cycles of a bus process that has not taken the request yet
        self._to_latch = None
        report = REPORTS[state]
        if report is Trigger.BUS_HOLDING and self.stopped:
            return Trigger.BUS_STOPPED
        if report is Trigger.BUS_PLAYING and self.idling:
            return Trigger.BUS_IDLING
        return report

    def _follow(self, report: Trigger) -> RobotState | None:
        before = self.machine.state
        try:
            changed = self.machine.report(report)
        except ImpossibleTransitionError as error:
            log.error("%s; e-stop is asked for", error)
            self._own_estop = self._own_estop or f"the daemon gave this e-stop itself: {error}{self._was_in_fault()}"
            self._link.request(BusRequest.ESTOP)
            return None
        if not changed:
            return None
        state = self.machine.state
        log.info("state %s -> %s", before.value, state.value)
        self.fault_reason, own_estop, self._own_estop = "", self._own_estop, ""
        if state is RobotState.ESTOP:
            self.fault_reason = own_estop or self._view.message  # the bus process may have a reason of its own
        elif state is RobotState.FAULT:
            self.fault_reason = self._reason(report)
            log.error("fault: %s", self.fault_reason)
        elif state in (RobotState.LIMP, RobotState.ARMING):
            self._planner.stand()
            self.stopped = False  # a stop of the limp robot is over once it is armed
        return state

    def _was_in_fault(self) -> str:
        return f", which was there because {self.fault_reason}" if self.fault_reason else ""

    def _reason(self, report: Trigger) -> str:
        if report is not Trigger.BUS_LOST:
            return self._view.message or "the bus process reported a fault"
        how = "silent" if self.bus_alive else "gone"
        return f"the bus process is {how}; its last word: {self._view.message or 'none'}"
