"""The bus process (hot path): setpoints -> gate -> bytes, at the robot's rate; the only owner of port and torque.

One `cycle()` is one bus period: take requests, find the next goal, pass it through the gate, exchange it for a
measurement, judge what came back, publish a record. `run()` calls it at absolute deadlines; a late cycle skips, never
bursts. Tests and replay call `cycle()` themselves in virtual time.
"""

from __future__ import annotations

import gc
import logging
from collections.abc import Generator, Sequence
from contextlib import suppress

import numpy as np
from numpy.typing import NDArray

from daemon.control.arming import Armed, arm_in_steps
from daemon.control.derating import Derating
from daemon.control.fault_detector import MAY_HAVE_TRIPPED_S, FaultDetector
from daemon.control.leading_back import LeadingBack
from daemon.control.point_to_point import PointToPointMove
from daemon.control.safety_limiter import SafetyLimiter
from daemon.control.time_scaling import ScaledSetpoints, TimeScaling
from daemon.control.torque_ramp import EFFORT_START, TorqueRamp
from daemon.control.turns import TurnWatch
from daemon.dynamixel.reading import BusReading
from daemon.dynamixel.servo_bus import ServoBus
from daemon.errors import DaemonError, LinkError, LinkLostError, ServoFaultError
from daemon.host.clock import Clock
from daemon.shared_memory.bus_link import BusLink, BusRequest, BusState
from daemon.shared_memory.heartbeat import HeartbeatWatch
from daemon.shared_memory.request_words import ESTOPS, Asked
from retarget.path.collision import SelfContact
from retarget.robot.robot import RobotModel
from retarget.robot.ticks import JointServoMap

log = logging.getLogger(__name__)

HEARTBEAT_LOST_S = 0.5
PARK_AFTER_S = 5.0
"""A silent front: after the first time decelerate and hold, after the second park and go limp."""
LOOK_S = 0.002
"""How often it looks for an e-stop between two cycles."""
FAULT_LIMP_S = 10.0
"""A fault or e-stop in which torque was kept, and a front so long silent: nobody will come, the servos go limp."""
NO_WAY_LIMP_S = 10.0
"""Where no way to rest or park was found that keeps off the robot itself it holds in a fault, and goes limp after so long."""
TORQUE_OFF_REPEATS = 5
"""Torque off is a packet that nobody answers: it is sent again, so that a spoilt one or a lost port costs nothing."""
CTL_LOST_S = 0.18
"""Cycles, in seconds, without a beat of the process that takes e-stops: with the next one 0.2 s."""
CTL_LOST = (
    "nobody took e-stops for 0.2 s, which counts as one: the ctl process was lost or held up; it is started again"
)
HELD_UP = "the bus process was silent for more than 1 s and is back; the robot holds: `mmmd reset` makes it limp"
_COMES_TO = {
    BusRequest.STOP: BusState.STOPPING, BusRequest.TORQUE_OFF: BusState.STOPPING, BusRequest.PARK: BusState.PARKING,
}  # fmt: skip
"""What brings an armed robot to rest, and by way of which state."""
_ARMED = (BusState.ARMING, BusState.HOLDING, BusState.PLAYING, BusState.STOPPING, BusState.PARKING)


class ControlLoop:
    """State and loop of the bus process."""

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
        self._period_s = robot.bus.period_s
        self._watch_front = watch_front
        self.state = BusState.LIMP
        self.stopping = False
        self.rest_rad = robot.rest_rad
        """Where arming leads to; replay sets a log's first goal."""
        self._torque = False
        self._limp_at_s: float | None = None
        self._held = False
        self._goal_tick: NDArray[np.int32] | None = None
        self._setpoint_rad = robot.park_rad.copy()
        self._plan_id, self._frame, self._last = 0, 0, True
        self._underrun = False
        self._cycle, self._told_s, self._late_cycles = 0, clock.now_s(), 0
        self._front_lost_s: float | None = None
        self._torque_off_left = 0
        self._made_limp = self._limp_at_rest = self._may_hold = False
        self._arming: Generator[None, None, Armed] | None = None
        self._judge, self._ramp = FaultDetector(robot, bus), TorqueRamp(bus, robot.bus.period_s)
        self._derating = Derating(robot.n_servos, robot.bus.period_s)
        self._setpoints, self._pace = ScaledSetpoints(link), TimeScaling(robot.bus.period_s)
        self._owed: list[Asked] = []
        self._ctl_silence = HeartbeatWatch(CTL_LOST_S, robot.bus.period_s)
        self._fed_s = clock.now_s()

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
        self._cut_torque()

    def found_holding(self) -> None:
        """Servos may have torque that this process did not give them: a latched fault, and they are not forgotten in it."""
        self.state, self._may_hold = BusState.FAULT, True

    def close(self) -> None:
        """Release the port."""
        self._slow.begin()
        self._bus.close()

    @property
    def made_limp(self) -> bool:
        """Whether the robot is limp, or was made so in a fault or e-stop by torque-offs that all went out."""
        was_cut = self._made_limp and not self._torque and not self._torque_off_left
        return self.state is BusState.LIMP or (self.state in (BusState.ESTOP, BusState.FAULT) and was_cut)

    def cycle(self) -> None:
        """One bus period."""
        self._told_s = self._clock.now_s()  # of a cycle in which no goals go out
        try:
            asked = self._link.take_request()
            if asked is not None:  # one a cycle, so that the front sees each state; an e-stop voids what came before it
                self._owed.append(asked)
                self._serve(asked.kind)
            self._watch_ctl()
            self._repeat_torque_off()
            self._watch_heartbeat()
            self._limp_when_due()
            self._go_on_arming()
            self._check_stall()
            goal_rad = self._next_goal()
            if goal_rad is not None and self._goal_tick is not None and not self._ramp.holds_goals:
                self._goal_tick = self._leading.goal_tick(goal_rad)
            self._told_s = self._clock.now_s()
            reading = self._bus.exchange(None if self._ramp.holds_goals or not self._torque else self._goal_tick)
            self._turns.update(reading, self._clock.now_s())
            if self._torque and self.state in (BusState.FAULT, BusState.ESTOP):
                self._judge.withhold_tripped(reading)
            elif self._torque and (why := self._judge.fault(reading)):
                self._fault(why)
            self._derate(reading)
        except (LinkError, ServoFaultError) as error:
            self._fault(str(error))
        self._publish(self._bus.reading)
        self._tell_done()
        self._cycle += 1

    def _waited_until(self, due_s: float) -> float:
        """Wait for the next cycle; when it began. An e-stop that cuts waits for none: no goal follows that would come early."""
        while (now_s := self._clock.now_s()) < due_s:
            if self._link.cut_asked:
                return now_s
            self._clock.sleep_until(min(due_s, now_s + LOOK_S))
        return due_s

    # Requests.

    def _serve(self, request: BusRequest) -> None:
        log.info("request %s in %s", request.name, self.state.name)
        if request in ESTOPS:
            self._link.set_text("")
            self._estop(holds=request is BusRequest.ESTOP_HOLD)
        elif request in _COMES_TO:
            self._link.drop_queued()
            if self._arming is not None:
                self._go_limp()  # before torque is on there is nothing to bring to rest
            elif self.state in _ARMED:
                self._forget_way()
                self._limp_at_rest = request is BusRequest.TORQUE_OFF
                self._enter(_COMES_TO[request])
            elif request is BusRequest.TORQUE_OFF and self.state is BusState.FAULT:
                self._cut_torque()  # it has come to rest in a fault, and stays in it
        elif request is BusRequest.FAULT:
            self._fault(HELD_UP)
        elif request is BusRequest.RESET:
            if self.state in (BusState.ESTOP, BusState.FAULT):
                self._bus.look_again()
                self._cut_torque()
                self._link.set_text("")
                self._link.drop_queued()
                self._enter(BusState.LIMP)
        elif request is BusRequest.ARM:
            if self.state is BusState.LIMP:
                self._link.drop_queued()
                self._link.set_text("")
                self._arming = arm_in_steps(
                    self.robot, self._bus, self._clock, EFFORT_START, self._turns, lambda: self._link.estop_asked
                )
                self._enter(BusState.ARMING)
        else:
            self.stopping = True

    def _tell_done(self) -> None:
        """Say that a request is carried out: a cut once its packets went out on every port, the others after their cycle."""
        cut_waits = not self._torque and self._torque_off_left == TORQUE_OFF_REPEATS
        for asked in list(self._owed):
            if not (cut_waits and asked.kind in ESTOPS):
                self._link.done(asked)
                self._owed.remove(asked)

    def _estop(self, *, holds: bool) -> None:
        """Cut torque; or brake and hold, where nothing is latched that holds already."""
        self._link.drop_queued()
        self._forget_way()
        if not holds or self._arming is not None or self.state not in _ARMED:
            self._torque, self._goal_tick, self._arming = False, None, None
            self._made_limp, self._may_hold = True, False
            self._torque_off_left = TORQUE_OFF_REPEATS  # the first goes out in this cycle
        self._enter(BusState.ESTOP)

    def _go_on_arming(self) -> None:
        """A step towards torque; then a slow way to rest. Any doubt is a fault, torque off."""
        if self._arming is None:
            return
        try:
            next(self._arming)
        except StopIteration as done:
            self._armed(done.value)
        except DaemonError as error:
            self._cut_torque()
            self._fault(f"cannot arm: {error}")

    def _armed(self, armed: Armed) -> None:
        self._arming, self._torque, self._made_limp = None, True, False
        self._goal_tick, self._derating.limits = armed.goal_tick, armed.limits
        self._fed_s = self._clock.now_s()
        self._judge.armed()
        self._ramp.begin()
        self._gate.reset(self._leading.begin(armed.goal_tick))
        self._forget_way()

    def _go_limp(self) -> None:
        self._cut_torque()
        self._enter(BusState.LIMP)

    # Goals.

    def _next_goal(self) -> NDArray[np.float64] | None:
        """(J,) goal of this cycle through the gate; None while torque is off."""
        self._underrun = False
        self._frame_or_none()
        if not self._torque:
            return None
        if self.state in _ARMED:
            self._ramp.step()
        if (self._ramp.holds_goals or not self._leading.done) and self.state is not BusState.STOPPING:
            return self._gate.brake()  # where it was pinned
        if self.state in (BusState.ARMING, BusState.PARKING):
            return self._move_slowly()
        if self.state is BusState.STOPPING:
            goal = self._gate.brake()
            if self._gate.at_rest and self._limp_at_rest:
                self._go_limp()
            elif self._gate.at_rest:
                self._enter(BusState.HOLDING)
            return goal
        if self.state in (BusState.HOLDING, BusState.PLAYING):
            goal = self._play()
            self._tell_held()
            return goal
        return self._gate.brake()  # fault or e-stop with torque still on: hold

    def _frame_or_none(self) -> None:
        """Between plans a record belongs to no plan."""
        if self.state is not BusState.PLAYING:
            self._plan_id, self._frame, self._last = 0, 0, True
            self._setpoints.reset()

    def _play(self) -> NDArray[np.float64]:
        setpoint = self._setpoints.take(min(self._derating.share, self._pace.update(held=self._gate.held)))
        if setpoint is not None:
            self._plan_id, self._frame, self._last = setpoint.plan_id, setpoint.frame, setpoint.last
            self._setpoint_rad = setpoint.q_rad
            self._enter(BusState.PLAYING)
            return self._gate.step(setpoint.q_rad)
        if self.state is BusState.PLAYING and not self._last:
            self._underrun = True  # the front is late: slow down, go on when it is back
            return self._gate.brake()
        goal = self._gate.brake()
        if self._gate.at_rest:
            self._enter(BusState.HOLDING)
        return goal

    def _tell_held(self) -> None:
        """Log once when what is played begins to be held off the robot itself."""
        if self._gate.held and not self._held:
            pairs = ", ".join(f"{a} and {b}" for a, b in self._gate.touching(self._setpoint_rad)[:3])
            log.warning(
                "held: plan %d would lead the robot into itself%s", self._plan_id, f" ({pairs})" if pairs else ""
            )
        self._held = self._gate.held

    def _move_slowly(self) -> NDArray[np.float64]:
        """To the rest pose, then it holds; to the park pose, then it is limp."""
        parking = self.state is BusState.PARKING
        to_rad = self.robot.park_rad if parking else self.rest_rad
        goal = self._slow.step(to_rad, self._link.park_stay_s if parking else 0.0)
        if self._slow.setpoint_rad is not None:
            self._setpoint_rad = self._slow.setpoint_rad
        if self._slow.blocked is not None:
            self._no_way(self._slow.blocked.touching())
        elif self._slow.arrived and parking:
            self._go_limp()
        elif self._slow.arrived:
            self._enter(BusState.HOLDING)
        return goal

    def _no_way(self, touching: Sequence[tuple[str, str]]) -> None:
        """Hold and say so; limp after a while: the robot is never led through itself."""
        where = "park" if self.state is BusState.PARKING else "rest"
        near = ", ".join(f"{a} and {b}" for a, b in touching[:3])
        self._fault(
            f"no free way to the {where} pose: the robot is in its own way{f' ({near})' if near else ''}; it holds, and goes"
            f" limp in {NO_WAY_LIMP_S:g} s; lead its arms clear by hand, then reset and arm"
        )
        self._limp_at_s = self._clock.now_s() + NO_WAY_LIMP_S

    def _forget_way(self) -> None:
        self._slow.begin()
        self._limp_at_rest = False

    # Judgement.

    def _watch_ctl(self) -> None:
        """An e-stop when nobody takes e-stops any more; none can be reset before somebody does."""
        if self._ctl_silence.lasts(self._link.ctl_beat) and self.state is not BusState.ESTOP:
            log.error("the ctl process was silent for %g s: e-stop", CTL_LOST_S)
            self._estop(holds=self._link.estop_kind is BusRequest.ESTOP_HOLD)
            self._link.set_text(CTL_LOST)

    def _watch_heartbeat(self) -> None:
        has_torque = self._torque or self._arming is not None or self._may_hold
        if not self._watch_front or not has_torque or self.state is BusState.PARKING:
            self._front_lost_s = None
            return
        age_s = self._link.heartbeat_age_s
        if self.state in (BusState.FAULT, BusState.ESTOP):
            if age_s > FAULT_LIMP_S:
                log.warning("in %s and the front silent for %.1f s: torque off", self.state.name.lower(), age_s)
                self._cut_torque()
            return
        if age_s < HEARTBEAT_LOST_S:
            self._front_lost_s = None
        elif age_s > PARK_AFTER_S:
            log.warning("front silent for %.1f s: parking", age_s)
            self._serve(BusRequest.PARK)
        elif self._front_lost_s is None:
            self._front_lost_s = age_s
            log.warning("front silent for %.1f s: holding", age_s)
            self._serve(BusRequest.STOP)

    def _limp_when_due(self) -> None:
        """Where there was no free way, after the time that was said."""
        if self._limp_at_s is None:
            return
        if not self._torque or self.state is not BusState.FAULT:
            self._limp_at_s = None
        elif self._clock.now_s() >= self._limp_at_s:
            log.warning("no free way was found %g s ago: torque off", NO_WAY_LIMP_S)
            self._cut_torque()

    def _check_stall(self) -> None:
        """After a pause in which the servos' watchdog may have run out: they then stand still and refuse goals."""
        pause_s, self._fed_s = self._clock.now_s() - self._fed_s, self._clock.now_s()
        if not self._torque or self._goal_tick is None or pause_s < MAY_HAVE_TRIPPED_S:
            return
        tripped = self._bus.tripped_watchdogs()
        if tripped:
            self._goal_tick = None
            self._fault(f"the bus process was held up for {pause_s:.2f} s: servo {tripped[0]} stopped by its watchdog")

    def _derate(self, reading: BusReading) -> None:
        """Slow down what is played before a servo trips."""
        d = self._derating
        if d.update(reading):
            servo = self.robot.servos[d.row]
            cause = (
                "full speed again"
                if not d.by
                else f"slower: {d.by.name.lower()} of servo {servo.servo_id} ({servo.joint_name})"
            )
            log.warning("%s", cause)
        self._link.set_derating(d.share, d.by, self._bus.ids[d.row])

    def _fault(self, text: str) -> None:
        """Latch a fault: what still has torque comes to rest and holds; nothing re-arms by itself. An e-stop stays one."""
        if self.state is BusState.ESTOP:
            self._link.set_text(text)
            return
        if self.state is not BusState.FAULT:
            log.error("fault: %s", text)
            self._link.set_text(text)
        self._link.drop_queued()
        self._forget_way()
        self._arming = None
        self._enter(BusState.FAULT)

    def _cut_torque(self) -> None:
        try:
            self._bus.send_torque_off()
        except LinkError as error:
            log.error("torque off not sent: %s", error)
        self._torque, self._goal_tick, self._made_limp, self._arming = False, None, True, None
        self._may_hold = False
        self._torque_off_left = TORQUE_OFF_REPEATS

    def _repeat_torque_off(self) -> None:
        if self._torque:
            return
        if self._torque_off_left:
            with suppress(LinkLostError):  # the exchange tells of it, and reads the ports that are left
                self._bus.send_torque_off()
                self._torque_off_left -= 1
            return
        holding = np.flatnonzero(self._bus.reading.torque == 1) if self._made_limp else ()
        if len(holding):  # read since: it heard none of them, a cable may have been loose
            ids = ", ".join(str(self._bus.ids[row]) for row in holding)
            log.warning("servo %s still has torque: torque off is sent again", ids)
            self._bus.send_torque_off()

    def _enter(self, state: BusState) -> None:
        if state is not self.state:
            log.info("%s -> %s", self.state.name, state.name)
            self.state = state

    def _publish(self, reading: BusReading) -> None:
        record = self._link.next_record()
        record["cycle"], record["t_mono_ns"] = self._cycle, int(self._told_s * 1e9)
        record["plan_id"], record["frame"], record["last"] = self._plan_id, self._frame, self._last
        record["state"], record["underrun"], record["torque"] = self.state, self._underrun, self._torque
        record["late_cycles"] = self._late_cycles
        record["setpoint_rad"], record["goal_rad"] = self._setpoint_rad, self._gate.position_rad
        record["velocity_rad_s"], record["clipped"] = self._gate.velocity_rad_s, self._gate.clipped
        record["goal_tick"] = reading.position_tick if self._goal_tick is None else self._goal_tick
        record["present_tick"], record["valid"] = reading.position_tick, reading.valid
        record["present_velocity_raw"], record["present_current_raw"] = reading.velocity_raw, reading.current_raw
        record["error"] = reading.error
        self._bus.show_health(self._link.health)
        self._link.health["temperature_c"] = reading.temperature_c
        self._link.publish()
