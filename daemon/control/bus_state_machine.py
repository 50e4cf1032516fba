"""States of the bus process and their transitions: requests, faults, e-stops, a silent front or ctl process.

    LIMP --arm--> ARMING --torque on, at rest pose--> HOLDING <--setpoints--> PLAYING
    armed --stop, torque off--> STOPPING --at rest--> HOLDING or LIMP
    armed --park--> PARKING --at park pose--> LIMP
    any but ESTOP --fault--> FAULT, any --e-stop--> ESTOP; only a reset leaves these two states, to LIMP

Armed are ARMING, HOLDING, PLAYING, STOPPING and PARKING; a stop or park before torque is on leads to LIMP at once. The control
loop takes one step in each cycle, and makes the goals.
"""

from __future__ import annotations

import logging
from collections.abc import Generator

from daemon.control.arming import Armed, arm_in_steps
from daemon.control.front_watch import FrontLoss, FrontWatch
from daemon.control.point_to_point import NO_WAY_LIMP_S, PointToPointMove
from daemon.control.torque_ramp import EFFORT_START
from daemon.control.torque_switch import TorqueSwitch
from daemon.control.turns import TurnWatch
from daemon.dynamixel.servo_bus import ServoBus
from daemon.errors import DaemonError
from daemon.host.clock import Clock
from daemon.shared_memory.bus_link import BusLink, BusRequest, BusState
from daemon.shared_memory.heartbeat import HeartbeatWatch
from daemon.shared_memory.request_words import ESTOPS
from retarget.robot.robot import RobotModel

log = logging.getLogger(__name__)

CTL_LOST_S = 0.18
"""Seconds without a heartbeat of the ctl process, which takes e-stops, before an e-stop: 0.2 s with the next cycle."""
CTL_LOST = (
    "nobody took e-stops for 0.2 s, which counts as one: the ctl process was lost or held up; it is started again"
)
HELD_UP = "the bus process was silent for more than 1 s and is back; the robot holds: `mmmd reset` makes it limp"
ARMED = (BusState.ARMING, BusState.HOLDING, BusState.PLAYING, BusState.STOPPING, BusState.PARKING)
_COMES_TO = {
    BusRequest.STOP: BusState.STOPPING, BusRequest.TORQUE_OFF: BusState.STOPPING, BusRequest.PARK: BusState.PARKING,
}  # fmt: skip
"""Requests that bring an armed robot to rest, and the state in which it comes to rest."""


class BusStateMachine:
    """The state of the bus process, the servos' torque, and the arming that is under way.

    Attributes:
        state: the current state.
        torque: torque of the servos and the goals that they hold.
        limp_at_rest: whether a robot that is stopping goes limp, instead of holding, once it stands.

    Args:
        robot: the robot.
        bus: its servos.
        link: requests and heartbeats.
        clock: time of the cycles.
        turns: says whether the servos' whole turns are known.
        move: the slow move to rest or park pose, which every change of state begins anew.
    """

    def __init__(
        self, robot: RobotModel, bus: ServoBus, link: BusLink, clock: Clock, turns: TurnWatch, move: PointToPointMove
    ) -> None:
        self._robot, self._bus, self._link, self._clock = robot, bus, link, clock
        self._turns, self._move = turns, move
        self.state = BusState.LIMP
        self.torque = TorqueSwitch(bus)
        self.limp_at_rest = False
        self._arming: Generator[None, None, Armed] | None = None
        self._front = FrontWatch(link)
        self._ctl_silence = HeartbeatWatch(CTL_LOST_S, robot.bus.period_s)

    def enter(self, state: BusState) -> None:
        if state is not self.state:
            log.info("%s -> %s", self.state.name, state.name)
            self.state = state

    def serve(self, request: BusRequest) -> None:
        """Carry out a request as far as the state allows; the control loop serves a shutdown request itself."""
        if request is BusRequest.STOP:
            self._front.stopped(self._clock.now_s())
        self._carry_out(request)

    def _carry_out(self, request: BusRequest) -> None:
        log.info("request %s in %s", request.name, self.state.name)
        if request in ESTOPS:
            self._link.set_text("")
            self._estop(holds=request is BusRequest.ESTOP_HOLD)
        elif request in _COMES_TO:
            self._link.setpoints.drop()
            if self._arming is not None:
                self.go_limp()  # before torque is on no joint has to be brought to rest
            elif self.state in ARMED:
                self._forget_move()
                self.limp_at_rest = request is BusRequest.TORQUE_OFF
                self.enter(_COMES_TO[request])
            elif request is BusRequest.TORQUE_OFF and self.state is BusState.FAULT:
                self.cut_torque()  # the robot has come to rest in a fault, and stays in the fault
        elif request is BusRequest.FAULT:
            self.fault(HELD_UP)
        elif request is BusRequest.RESET:
            if self.state in (BusState.ESTOP, BusState.FAULT):
                self._bus.look_again()
                self.cut_torque()
                self._link.set_text("")
                self._link.setpoints.drop()
                self.enter(BusState.LIMP)
        elif request is BusRequest.ARM and self.state is BusState.LIMP:
            self._link.setpoints.drop()
            self._link.set_text("")
            self._arming = arm_in_steps(
                self._robot, self._bus, self._clock, EFFORT_START, self._turns, lambda: self._link.estop_asked
            )
            self.enter(BusState.ARMING)

    def arm_further(self) -> Armed | None:
        """Take one step of arming; return the robot's torque and limits after the last step, else None.

        Any error during arming is a fault, and torque is cut.
        """
        if self._arming is None:
            return None
        try:
            next(self._arming)
        except StopIteration as done:
            armed: Armed = done.value
            self._arming = None
            self.torque.switched_on(armed.goal_tick)
            self._forget_move()
            return armed
        except DaemonError as error:
            self.cut_torque()
            self.fault(f"cannot arm: {error}")
        return None

    def watch_ctl(self) -> None:
        """Trigger an e-stop when the ctl process has stopped; a reset is refused until it runs again."""
        if self._ctl_silence.lasts(self._link.ctl_beat) and self.state is not BusState.ESTOP:
            log.error("the ctl process was silent for %g s: e-stop", CTL_LOST_S)
            self._estop(holds=self._link.estop_kind is BusRequest.ESTOP_HOLD)
            self._link.set_text(CTL_LOST)

    def watch_front(self, *, watched: bool) -> None:
        """Hold, park or go limp when the front is silent, if the robot has torque and `watched` is true."""
        has_torque = self.torque.on or self._arming is not None or self.torque.may_hold
        loss = self._front.step(self.state, self._clock.now_s(), watched=watched and has_torque)
        if loss is FrontLoss.HOLD:
            self._carry_out(BusRequest.STOP)
        elif loss is FrontLoss.PARK:
            self._carry_out(BusRequest.PARK)
        elif loss is FrontLoss.LIMP:
            self.cut_torque()

    def fault(self, text: str) -> None:
        """Latch a fault: servos with torque come to rest and hold, and no servo re-arms by itself. An e-stop stays an e-stop."""
        if self.state is BusState.ESTOP:
            self._link.set_text(text)
            return
        if self.state is not BusState.FAULT:
            log.error("fault: %s", text)
            self._link.set_text(text)
        self._link.setpoints.drop()
        self._forget_move()
        self._arming = None
        self.enter(BusState.FAULT)

    def no_way(self) -> None:
        """Latch a fault because the slow move found no free path; go limp after the time that the fault's text names."""
        self.fault(self._move.no_way("park" if self.state is BusState.PARKING else "rest"))
        self.torque.cut_at(self._clock.now_s() + NO_WAY_LIMP_S)

    def limp_when_due(self) -> None:
        """Go limp when no free path was found and the announced time is over."""
        if self.torque.cut_is_due(self._clock.now_s(), in_fault=self.state is BusState.FAULT):
            log.warning("no free way was found %g s ago: torque off", NO_WAY_LIMP_S)
            self.cut_torque()

    def go_limp(self) -> None:
        self.cut_torque()
        self.enter(BusState.LIMP)

    def cut_torque(self) -> None:
        """Cut torque at once, which ends arming; the state stays."""
        self.torque.cut()
        self._arming = None

    def _estop(self, *, holds: bool) -> None:
        """Enter the e-stop: cut torque, unless `holds` is true and the robot is armed; it then brakes and holds."""
        self._link.setpoints.drop()
        self._forget_move()
        if not holds or self._arming is not None or self.state not in ARMED:
            self._arming = None
            self.torque.cut_by_repeat()  # the first packet goes out in this cycle
        self.enter(BusState.ESTOP)

    def _forget_move(self) -> None:
        self._move.begin()
        self.limp_at_rest = False
