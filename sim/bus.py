"""Simulated servos on one half-duplex wire: bytes in, bytes and their time of arrival out.

Modelled: time of every byte at the baud in both directions, return delay, silence of servos that are not addressed or
got bytes at another baud, faults on a schedule. Not modelled: collisions, echo, adapter latency, noise between packets.
"""

from __future__ import annotations

import struct
from collections.abc import Callable

import numpy as np

from daemon.bus.packet import BROADCAST_ID, Instruction, Packet, PacketDecoder, encode
from retarget.robot import RobotModel
from retarget.ticks import JointServoMap
from sim.audit import Audit
from sim.faults import FaultSchedule
from sim.servo import SimServo

_BITS_PER_BYTE = 10
_RETURN_DELAY_UNIT_S = 2e-6
_GOAL_POSITION = 116
_TORQUE_ENABLE = 64


class SimBus:
    """The servos of a robot behind real packets. Time comes from outside."""

    def __init__(
        self, robot: RobotModel, faults: FaultSchedule | None = None, start_rad: list[float] | None = None
    ) -> None:
        pose = start_rad if start_rad is not None else robot.park_rad.tolist()
        self.robot = robot
        ticks = JointServoMap(robot)
        angles = ((ticks.to_ticks(np.array(pose, np.float64)) - ticks.zero_tick) / ticks.ticks_per_rad).tolist()
        self.servos = {s.servo_id: SimServo(s, a) for s, a in zip(robot.servos, angles, strict=True)}
        self.faults = faults or FaultSchedule()
        self.audit = Audit(robot)
        self.on_goal: Callable[[float, int, int], None] | None = None
        """Called with (time, servo id, tick) for every goal position received; for comparisons."""
        self._decoder = PacketDecoder()
        self._tripped: set[int] = set()

    def receive(self, data: bytes, t_s: float, baud: int) -> list[tuple[float, bytes]]:
        """Replies to `data` sent at `t_s`, each with the time its last byte arrives."""
        replies: list[tuple[float, bytes]] = []
        sent_s = t_s + len(data) * _BITS_PER_BYTE / baud
        for p in self._decoder.feed(data):
            if p.instruction == Instruction.STATUS:
                continue
            self._advance(sent_s)
            for servo in self.servos.values():
                servo.fed(sent_s)
            for servo, reply in self._carry_out(p, sent_s):
                if servo.get("status_return_level") == 0 and p.instruction != Instruction.PING:
                    continue
                raw = self.faults.spoil(encode(reply), sent_s, servo.servo_id)
                delay = servo.get("return_delay_time") * _RETURN_DELAY_UNIT_S
                sent_s += delay + len(encode(reply)) * _BITS_PER_BYTE / baud
                if raw:
                    replies.append((sent_s, raw))
        return replies

    def _advance(self, t_s: float) -> None:
        for servo in self.servos.values():
            servo.advance(t_s)
            if servo.servo_id not in self._tripped and self.faults.active("trip", t_s, servo.servo_id):
                self._tripped.add(servo.servo_id)
                servo.trip(1 << 5)

    def _carry_out(self, p: Packet, t_s: float) -> list[tuple[SimServo, Packet]]:
        """Do what an instruction says; the status packets in the order they are sent."""
        if p.instruction == Instruction.SYNC_WRITE:
            self._sync_write(p.parameters, t_s)
            return []
        if p.instruction == Instruction.SYNC_READ:
            if len(p.parameters) < 4:
                return []
            address, length = struct.unpack_from("<HH", p.parameters)
            asked = [self.servos[i] for i in p.parameters[4:] if i in self.servos]
            return [(s, self._status(s, *s.read(address, length))) for s in asked]
        everyone = p.servo_id == BROADCAST_ID
        addressed = (
            list(self.servos.values()) if everyone else [s for s in self.servos.values() if s.servo_id == p.servo_id]
        )
        replies = [(s, self._one(s, p, t_s)) for s in addressed]
        return [(s, r) for s, r in replies if r is not None and (not everyone or p.instruction == Instruction.PING)]

    def _one(self, servo: SimServo, p: Packet, t_s: float) -> Packet | None:
        if p.instruction == Instruction.PING:
            data = struct.pack("<HB", servo.get("model_number"), servo.get("firmware_version"))
            return self._status(servo, 0, data)
        if p.instruction == Instruction.READ:
            if len(p.parameters) != 4:
                return self._status(servo, 5, b"")
            return self._status(servo, *servo.read(*struct.unpack("<HH", p.parameters)))
        if p.instruction == Instruction.WRITE:
            if len(p.parameters) < 3:
                return self._status(servo, 5, b"")
            error = self._write(servo, struct.unpack_from("<H", p.parameters)[0], p.parameters[2:], t_s)
            return self._status(servo, error, b"")
        if p.instruction == Instruction.REBOOT:
            self.audit.torque(t_s, servo.servo_id, False, 0, 0)
            servo.reboot()
            return self._status(servo, 0, b"")
        return self._status(servo, 2, b"")

    def _sync_write(self, parameters: bytes, t_s: float) -> None:
        if len(parameters) < 4:
            return
        address, length = struct.unpack_from("<HH", parameters)
        rows = parameters[4:]
        for at in range(0, len(rows) - length, length + 1):
            servo = self.servos.get(rows[at])
            if servo is not None:
                self._write(servo, address, rows[at + 1 : at + 1 + length], t_s)

    def _write(self, servo: SimServo, address: int, data: bytes, t_s: float) -> int:
        had_torque = servo.torque
        error = servo.write(address, data)
        covers = range(address, address + len(data))
        if _GOAL_POSITION in covers:
            if error:
                self.audit.refused(t_s, servo.servo_id, error)
            else:
                tick = servo.get("goal_position")
                self.audit.goal(t_s, servo.servo_id, tick, had_torque)
                if self.on_goal is not None:
                    self.on_goal(t_s, servo.servo_id, tick)
        if _TORQUE_ENABLE in covers and not error and servo.torque != had_torque:
            self.audit.torque(t_s, servo.servo_id, servo.torque, servo.get("goal_position"), round(servo.position_tick))
        return error

    @staticmethod
    def _status(servo: SimServo, error: int, data: bytes) -> Packet:
        return Packet(servo.servo_id, Instruction.STATUS, data, error | servo.alert())
