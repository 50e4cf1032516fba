"""The bus process (hot path): setpoints -> gate -> bytes, at the robot's rate; the only owner of port and torque.

One `cycle()` is one bus period: take a request, find the next goal, pass it through the gate, exchange it for a
measurement, judge the measurement, publish a record. `run()` calls it at absolute deadlines; a late cycle skips, never
bursts. Tests and replay call `cycle()` themselves in virtual time. `bus_state_machine.py` has the states.
"""

from __future__ import annotations

import gc
import logging
from contextlib import suppress

import numpy as np
from numpy.typing import NDArray

from daemon.control.arming import Armed
from daemon.control.bus_state_machine import ARMED, BusStateMachine
from daemon.control.derating import Derating
from daemon.control.fault_detector import FaultDetector
from daemon.control.leading_back import LeadingBack
from daemon.control.point_to_point import PointToPointMove
from daemon.control.safety_limiter import SafetyLimiter
from daemon.control.time_scaling import ScaledSetpoints, TimeScaling
from daemon.control.torque_ramp import TorqueRamp
from daemon.control.torque_switch import TORQUE_OFF_REPEATS
from daemon.control.turns import TurnWatch
from daemon.dynamixel.reading import BusReading
from daemon.dynamixel.servo_bus import ServoBus
from daemon.errors import LinkError, ServoFaultError
from daemon.host.clock import Clock
from daemon.shared_memory.bus_link import BusLink, BusRequest, BusState
from daemon.shared_memory.request_words import ESTOPS, Asked
from retarget.path.collision import SelfContact
from retarget.robot.robot import RobotModel
from retarget.robot.ticks import JointServoMap

log = logging.getLogger(__name__)

LOOK_S = 0.002
"""Seconds between two polls for an e-stop while the loop waits for its next cycle."""


class ControlLoop:
    """Loop of the bus process.

    Args:
        robot: the robot.
        bus: its servos.
        link: setpoints and requests down, records up.
        clock: time of the cycles.
        watch_front: whether a silent front makes the robot hold and park.

    Attributes:
        stopping: set to end `run`.
        rest_rad: (J,) pose that arming leads to; replay sets a log's first goal.
    """

    def __init__(
        self, robot: RobotModel, bus: ServoBus, link: BusLink, clock: Clock, *, watch_front: bool = True
    ) -> None:
        self.robot, self._bus, self._link, self._clock = robot, bus, link, clock
        self._ticks = JointServoMap(robot)
        self._turns = TurnWatch(robot, self._ticks, bus)
        self._leading = LeadingBack(self._ticks, np.array([s.model.ticks_per_turn for s in robot.servos]))
        contact = SelfContact(robot)
        self._gate = SafetyLimiter(robot, contact=contact)
        self._slow = PointToPointMove(robot, contact, self._gate)
        self._states = BusStateMachine(robot, bus, link, clock, self._turns, self._slow)
        self._torque = self._states.torque
        self._period_s = robot.bus.period_s
        self._watch_front = watch_front
        self.stopping = False
        self.rest_rad = robot.rest_rad
        self._held = False
        self._setpoint_rad = robot.park_rad.copy()
        self._plan_id, self._frame, self._last = 0, 0, True
        self._underrun = False
        self._cycle, self._told_s, self._late_cycles = 0, clock.now_s(), 0
        self._judge, self._ramp = FaultDetector(robot, bus), TorqueRamp(bus, robot.bus.period_s)
        self._derating = Derating(robot.n_servos, robot.bus.period_s)
        self._setpoints, self._pace = ScaledSetpoints(link), TimeScaling(robot.bus.period_s)
        self._owed: list[Asked] = []

    def run(self) -> None:
        """Cycle at the robot's rate until a shutdown request or `stopping`, torque off at the end."""
        gc.collect()
        gc.freeze()
        due_s = self._clock.now_s()
        while not self.stopping:
            now_s = self._clock.now_s()
            if now_s > due_s + self._period_s / 2:  # skip what was missed; never burst
                self._late_cycles += round((now_s - due_s) / self._period_s)
                due_s = now_s
            self.cycle()
            due_s = self._waited_until(due_s + self._period_s)
        self._end()

    def _end(self) -> None:
        """Cut torque, repeat that as cycles do, then ask the servos whether they have received it."""
        self._states.cut_torque()
        due_s = self._clock.now_s()
        for _ in range(TORQUE_OFF_REPEATS):
            due_s += self._period_s
            self._clock.sleep_until(due_s)
            with suppress(LinkError, ServoFaultError):
                self._torque.repeat_off()
                self._bus.exchange(None)
        self._torque.confirm_off()

    @property
    def state(self) -> BusState:
        return self._states.state

    def found_holding(self) -> None:
        """Latch a fault in which servos may have torque that this process did not give them; torque off reaches these too."""
        self._states.state, self._torque.may_hold = BusState.FAULT, True

    def close(self) -> None:
        """Release the port."""
        self._slow.begin()
        self._bus.close()

    @property
    def made_limp(self) -> bool:
        """Whether the robot is limp, or was made so in a fault or e-stop by torque-offs that all went out."""
        return self.state is BusState.LIMP or (self.state in (BusState.ESTOP, BusState.FAULT) and self._torque.has_cut)

    def cycle(self) -> None:
        """Run one bus period."""
        self._told_s = self._clock.now_s()  # time of a cycle in which no goals are sent
        try:
            asked = self._link.take_request()
            if asked is not None:  # one a cycle, so that the front sees each state; an e-stop voids earlier requests
                self._owed.append(asked)
                self._states.serve(asked.kind)
                if asked.kind is BusRequest.SHUTDOWN:
                    self.stopping = True
            self._states.watch_ctl()
            self._torque.repeat_off()
            self._states.watch_front(watched=self._watch_front)
            self._states.limp_when_due()
            if (armed := self._states.arm_further()) is not None:
                self._armed(armed)
            self._check_stall()
            goal_rad = self._next_goal()
            if goal_rad is not None and self._torque.goal_tick is not None and not self._ramp.holds_goals:
                self._torque.goal_tick = self._leading.goal_tick(goal_rad)
            self._told_s = self._clock.now_s()
            reading = self._bus.exchange(
                None if self._ramp.holds_goals or not self._torque.on else self._torque.goal_tick
            )
            self._turns.update(reading, self._clock.now_s())
            if self._torque.on and self.state in (BusState.FAULT, BusState.ESTOP):
                self._judge.withhold_tripped(reading)
            elif self._torque.on and (why := self._judge.fault(reading)):
                self._states.fault(why)
            self._derate(reading)
        except (LinkError, ServoFaultError) as error:
            self._states.fault(str(error))
        self._publish(self._bus.reading)
        self._tell_done()
        self._cycle += 1

    def _waited_until(self, due_s: float) -> float:
        """Wait for the next cycle and return its start time. An e-stop that cuts torque starts the cycle early: no goal follows."""
        while (now_s := self._clock.now_s()) < due_s:
            if self._link.cut_asked:
                return now_s
            self._clock.sleep_until(min(due_s, now_s + LOOK_S))
        return due_s

    def _tell_done(self) -> None:
        """Report a request as carried out: a cut once its packets went out on every port, others after their cycle."""
        for asked in list(self._owed):
            if not (self._torque.cut_waits and asked.kind in ESTOPS):
                self._link.done(asked)
                self._owed.remove(asked)

    def _armed(self, armed: Armed) -> None:
        """Begin after torque came on: goals continue from the servos' positions, with a low effort limit at first."""
        self._derating.limits = armed.limits
        self._judge.armed(self._clock.now_s())
        self._ramp.begin()
        self._gate.reset(self._leading.begin(armed.goal_tick))

    # Goals.

    def _next_goal(self) -> NDArray[np.float64] | None:
        """(J,) goal of this cycle after the gate; None while torque is off."""
        self._underrun = False
        self._frame_or_none()
        if not self._torque.on:
            return None
        if self.state in ARMED:
            self._ramp.step()
        if (self._ramp.holds_goals or not self._leading.done) and self.state is not BusState.STOPPING:
            return self._gate.brake()  # at the pinned goals
        if self.state in (BusState.ARMING, BusState.PARKING):
            return self._move_slowly()
        if self.state is BusState.STOPPING:
            goal = self._gate.brake()
            if self._gate.at_rest and self._states.limp_at_rest:
                self._states.go_limp()
            elif self._gate.at_rest:
                self._states.enter(BusState.HOLDING)
            return goal
        if self.state in (BusState.HOLDING, BusState.PLAYING):
            goal = self._play()
            self._tell_held()
            return goal
        return self._gate.brake()  # fault or e-stop with torque still on: hold

    def _frame_or_none(self) -> None:
        """Clear the frame number: between plans a record belongs to no plan."""
        if self.state is not BusState.PLAYING:
            self._plan_id, self._frame, self._last = 0, 0, True
            self._setpoints.reset()

    def _play(self) -> NDArray[np.float64]:
        setpoint = self._setpoints.take(min(self._derating.share, self._pace.update(held=self._gate.held)))
        if setpoint is not None:
            self._plan_id, self._frame, self._last = setpoint.plan_id, setpoint.frame, setpoint.last
            self._setpoint_rad = setpoint.q_rad
            self._states.enter(BusState.PLAYING)
            return self._gate.step(setpoint.q_rad)
        if self.state is BusState.PLAYING and not self._last:
            self._underrun = True  # the front is late: slow down, continue when frames arrive
            return self._gate.brake()
        goal = self._gate.brake()
        if self._gate.at_rest:
            self._states.enter(BusState.HOLDING)
        return goal

    def _tell_held(self) -> None:
        """Log once per hold that the gate keeps the motion from leading the robot into itself."""
        if self._gate.held and not self._held:
            pairs = ", ".join(f"{a} and {b}" for a, b in self._gate.touching(self._setpoint_rad)[:3])
            log.warning(
                "held: plan %d would lead the robot into itself%s", self._plan_id, f" ({pairs})" if pairs else ""
            )
        self._held = self._gate.held

    def _move_slowly(self) -> NDArray[np.float64]:
        """Return the goal of the slow move: to the rest pose, then hold; or to the park pose, then go limp."""
        parking = self.state is BusState.PARKING
        to_rad = self.robot.park_rad if parking else self.rest_rad
        goal = self._slow.step(to_rad, self._link.park_stay_s if parking else 0.0)
        if self._slow.setpoint_rad is not None:
            self._setpoint_rad = self._slow.setpoint_rad
        if self._slow.blocked is not None:
            self._states.no_way()
        elif self._slow.arrived and parking:
            self._states.go_limp()
        elif self._slow.arrived:
            self._states.enter(BusState.HOLDING)
        return goal

    # Judgement.

    def _check_stall(self) -> None:
        """After a pause in which the servos' watchdogs may have run out, check them: tripped servos stop and refuse goals."""
        driven = self._torque.on and self._torque.goal_tick is not None
        if why := self._judge.stalled(self._clock.now_s(), driven=driven):
            self._torque.goal_tick = None
            self._states.fault(why)

    def _derate(self, reading: BusReading) -> None:
        """Slow down the running motion before a servo trips."""
        d = self._derating
        if d.update(reading):
            log.warning("%s", d.cause(self.robot))
        self._link.set_derating(d.share, d.by, self._bus.ids[d.row])

    def _publish(self, reading: BusReading) -> None:
        record = self._link.cycles.next_record()
        record["cycle"], record["t_mono_ns"] = self._cycle, int(self._told_s * 1e9)
        record["plan_id"], record["frame"], record["last"] = self._plan_id, self._frame, self._last
        record["state"], record["underrun"], record["torque"] = self.state, self._underrun, self._torque.on
        record["late_cycles"] = self._late_cycles
        record["setpoint_rad"], record["goal_rad"] = self._setpoint_rad, self._gate.position_rad
        record["velocity_rad_s"], record["clipped"] = self._gate.velocity_rad_s, self._gate.clipped
        record["goal_tick"] = reading.position_tick if self._torque.goal_tick is None else self._torque.goal_tick
        record["present_tick"], record["valid"] = reading.position_tick, reading.valid
        record["present_velocity_raw"], record["present_current_raw"] = reading.velocity_raw, reading.current_raw
        record["error"] = reading.error
        self._bus.show_health(self._link.health)
        self._link.health["temperature_c"] = reading.temperature_c
        self._link.cycles.publish()
