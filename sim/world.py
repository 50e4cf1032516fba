"""A robot's servos and the body that they move, in one time shared by every port that leads to them."""

from __future__ import annotations

import logging
import math
import threading
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from daemon.dynamixel.registers.models import MODELS
from retarget.robot.robot import RobotModel, ServoSpec
from retarget.robot.ticks import JointServoMap
from sim.audit.audit import Audit
from sim.bodies.body import Body, PlainBody
from sim.bodies.motors import motor_of
from sim.errors import FaultFileError
from sim.faults import Fault, FaultSchedule
from sim.servos.drives import STEP_S, Drives
from sim.servos.servo import SimServo
from sim.servos.servo_power import ENCODER_BIT, OVERLOAD_BIT, RESET_SHARE
from sim.servos.servo_protocol1 import SimServo1
from sim.servos.servo_series_y_p import SimServoP, SimServoY

log = logging.getLogger(__name__)

BACKLASH_RAD = {
    "x_current": 0.0044, "mx1": 0.0058, "mx2_current": 0.0058, "mx2_load": 0.0058, "y": 0.00087, "p": 0.00175,
}  # fmt: skip
"""Radians of backlash by family: 15, 20, 3 and 6 arc minutes (e-manual, "Backlash"); other families get our estimate below."""
_BACKLASH_OTHER_RAD = 0.0044
_EPSILON_S = 1e-9


class World:
    """Servos, body, faults and audit of one robot.

    Args:
        robot: the robot.
        faults: what goes wrong; nothing when None.
        start_rad: (J,) pose to begin in; the park pose when None.
        body: makes the body from the robot, the motors and the start angles of the shafts; plain shafts when None.
        firmware: version of single servos, by id.
        extra: servos on the wire that belong to no joint, such as one with an id that is there twice.

    Raises:
        FaultFileError: a fault of a servo that is not there, or that it cannot have.
    """

    def __init__(
        self,
        robot: RobotModel,
        faults: FaultSchedule | None = None,
        start_rad: Sequence[float] | None = None,
        body: Callable[..., Body] | None = None,
        firmware: Mapping[int, int] | None = None,
        extra: Sequence[ServoSpec] = (),
    ) -> None:
        pose = np.array(start_rad, np.float64) if start_rad is not None else robot.park_rad
        specs = (*robot.servos, *extra)
        if faults is not None:
            faults.check_servos({s.servo_id for s in specs})
        self.robot, self.faults, self.audit = robot, faults or FaultSchedule(), Audit(robot, self._true_ticks)
        motors = [motor_of(s.model.model_number) for s in specs]
        rad_per_tick = [2 * np.pi / s.model.ticks_per_turn for s in specs]
        ticks = [*JointServoMap(robot).to_ticks(pose).tolist(), *(s.zero_tick for s in extra)]
        shaft_rad = np.array(ticks, np.float64) * rad_per_tick
        self.body: Body = PlainBody(motors, shaft_rad) if body is None else body(robot, motors, shaft_rad)
        families = [MODELS[s.model.model_number].family for s in specs]
        backlash = [BACKLASH_RAD.get(f, _BACKLASH_OTHER_RAD) / r for f, r in zip(families, rad_per_tick, strict=True)]
        self.drives = Drives(motors, rad_per_tick, backlash, self.body)
        versions = firmware or {}
        self.all = [make_servo(s, self.drives, i, versions.get(s.servo_id)) for i, s in enumerate(specs)]
        self.servos = {s.servo_id: servo for s, servo in zip(robot.servos, self.all[: len(robot.servos)], strict=True)}
        for servo in self.all:
            servo.set_baud(robot.bus.baud)
        self._check_encoder_faults()
        self.t_s = 0.0
        self.lock = threading.RLock()
        """Held during every access to the servos: each port may be served by a thread of its own."""
        self.on_clock_jump: Callable[[float], None] | None = None
        self._steps = 0
        self._done_s = -math.inf

    def advance(self, t_s: float) -> None:
        """Advance to time `t_s`; earlier times change nothing."""
        if t_s <= self._done_s:
            return
        self._done_s = t_s
        while (next_s := (self._steps + 1) * STEP_S) <= t_s + _EPSILON_S:
            self._steps += 1
            for fault in self.faults.begin(next_s):
                self._strike(fault, next_s)
            if self.drives.step():
                self._judge(next_s)
        for fault in self.faults.begin(t_s):
            self._strike(fault, t_s)
        self.t_s = max(self.t_s, t_s)
        for servo in self.all:
            servo.watch(t_s)

    def move_by_hand(self, pose_rad: Sequence[float]) -> None:
        """Move the limp joints to a pose (J,) as a hand would; servos with torque do not follow."""
        ticks = JointServoMap(self.robot).to_ticks(np.array(pose_rad, np.float64))
        with self.lock:
            for servo, tick in zip(self.servos.values(), ticks.tolist(), strict=True):
                if not servo.torque:
                    self.drives.place(servo.index, tick)

    def lead_by_hand(self, pose_rad: Sequence[float]) -> None:
        """Lead the joints to a pose by hand, then switch servos that count turns off and on in that pose."""
        self.move_by_hand(pose_rad)
        for servo in self.servos.values():
            if servo.spec.extended:
                servo.lose_power()
                servo.restore_power()

    def _judge(self, t_s: float) -> None:
        """Update power, latched errors and watchdogs, and report self-contact to the audit; every 20 ms."""
        self._keep_up(t_s)
        volts = self.drives.voltage_v
        for servo in self.all:
            enough = volts[servo.index] >= RESET_SHARE * servo.model.voltage_v[0]
            if not enough:
                servo.lose_power()
            elif not servo.powered:
                servo.restore_power()
            servo.watch(t_s)
            servo.judge()
        touched = self.body.self_contacts - self.audit.body_contacts
        if touched:
            self.audit.touched(touched, led=all(servo.torque for servo in self.all))

    def _keep_up(self, t_s: float) -> None:
        """Apply the lasting faults that are in force now to the drives."""
        share = np.ones(self.drives.n)
        for fault in self.faults.in_force("brown_out"):
            for servo in self._meant(fault):
                share[servo.index] = min(share[servo.index], 0.3 if fault.amount is None else fault.amount)
        stuck = np.zeros(self.drives.n, bool)
        for fault in self.faults.in_force("stuck"):
            for servo in self._meant(fault):
                stuck[servo.index] = True
        push = [0.0] * self.drives.n
        for fault in self.faults.in_force("push"):
            for servo in self._meant(fault):
                push[servo.index] += fault.amount or 0.0
        now = (share.tolist(), stuck.tolist(), push)
        if now != getattr(self, "_lasting", None):
            self._lasting = now
            self.drives.supply_share, self.drives.stuck = share, stuck
            for i, torque_nm in enumerate(push):
                self.body.push(i, torque_nm)
            self.drives.touch()

    def _true_ticks(self) -> list[int]:
        """(S,) true positions of the robot file's servos, in the ticks of their registers."""
        return [round(servo.position_tick) for servo in self.servos.values()]

    def _strike(self, fault: Fault, t_s: float) -> None:
        """Carry out a fault that happens at an instant."""
        for servo in self._meant(fault):
            i = servo.index
            if fault.kind in ("overload", "trip"):
                servo.trip(OVERLOAD_BIT)
            elif fault.kind == "encoder" and servo.has_encoder_error:
                servo.trip(ENCODER_BIT)
            elif fault.kind == "hot":
                self.drives.temperature_c[i] = 90.0 if fault.amount is None else fault.amount
                servo.judge()
            elif fault.kind == "reboot":
                servo.watch(t_s)
                servo.reboot()
            elif fault.kind == "slip":
                self.drives.place(
                    i, float(self.drives.position_tick[i]) + (100 if fault.amount is None else fault.amount)
                )
        if fault.kind == "clock_jump" and self.on_clock_jump is not None:
            self.on_clock_jump(1.0 if fault.amount is None else fault.amount)

    def _check_encoder_faults(self) -> None:
        """Refuse encoder faults of servos that report no encoder error (Protocol 1.0)."""
        able = [servo.spec.servo_id for servo in self.all if servo.has_encoder_error]
        for i, fault in enumerate(self.faults.faults, 1):
            if fault.kind == "encoder" and (fault.servo_id not in able if fault.servo_id is not None else not able):
                whom = "any servo" if fault.servo_id is None else f"servo {fault.servo_id}"
                allowed = f"Protocol 2.0: servo {', '.join(map(str, able)) or 'none'}"
                raise FaultFileError("fault schedule", f"fault {i}: kind", f"'encoder' for {whom}", allowed)

    def _meant(self, fault: Fault) -> list[SimServo]:
        return [s for s in self.all if fault.servo_id is None or s.spec.servo_id == fault.servo_id]


def make_servo(spec: ServoSpec, drives: Drives, index: int, firmware: int | None = None) -> SimServo:
    """The simulated servo of a model, by its protocol and family."""
    model = MODELS[spec.model.model_number]
    other = {"y": SimServoY, "p": SimServoP}.get(model.family, SimServo)
    return (SimServo1 if model.protocol == 1.0 else other)(spec, drives, index, firmware)
