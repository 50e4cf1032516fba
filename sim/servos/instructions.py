"""Carries instructions out on one servo and returns its answer; reports goals and torque to the audit."""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec import packet_protocol1 as packet1
from daemon.dynamixel.codec.packet import BROADCAST_ID, Access, ErrorCode, Instruction, Packet
from daemon.errors import PacketError
from sim.audit.audit import Audit
from sim.servos.servo import SimServo

_FACTORY_KEEPS: dict[int, tuple[str, ...]] = {0xFF: (), 0x01: ("id",), 0x02: ("id", "baud_rate")}


class Instructions:
    """Carries instructions out."""

    def __init__(self, audit: Audit) -> None:
        self._audit = audit
        self.on_goal: Callable[[float, int, int], None] | None = None

    def carry_out(self, servo: SimServo, p: Packet, t_s: float, *, by_second_id: bool = False) -> tuple[int, bytes]:
        """Carry out an instruction packet; return the answer's error code and parameters.

        `by_second_id`: the packet was for the servo's second id, by which its EEPROM cannot be changed (e-manual,
        "Secondary ID").
        """
        kind, parameters = p.instruction, p.parameters
        if kind == Instruction.PING:
            return 0, _identity(servo)
        if kind in (Instruction.READ, Instruction.WRITE, Instruction.REG_WRITE):
            try:
                access = accesses_of(p, servo.model.protocol, strict=True)[0]
            except PacketError:
                return servo.errors.length, b""
            if kind == Instruction.READ:
                return servo.read(access.address, access.length)
            if by_second_id and servo.writes_eeprom(access.address, access.data):
                return servo.errors.access, b""
            if kind == Instruction.WRITE:
                return self.write(servo, access.address, access.data, t_s), b""
            return servo.register(access.address, access.data), b""
        if kind == Instruction.ACTION:
            pending = servo.act()
            return (servo.errors.instruction if pending is None else self.write(servo, *pending, t_s)), b""
        if kind == Instruction.REBOOT and servo.model.protocol == 2.0:
            self._audit.torque(t_s, servo.spec.servo_id, False, 0, 0)
            servo.reboot()
            return 0, b""
        if by_second_id and kind in (Instruction.FACTORY_RESET, Instruction.CONTROL_TABLE_BACKUP):
            return servo.errors.access, b""
        if kind == Instruction.FACTORY_RESET:
            return self._factory_reset(servo, p), b""
        if kind == Instruction.CLEAR and parameters == packet.CLEAR_MULTI_TURN:
            return (0 if servo.clear_turns() else ErrorCode.RESULT_FAIL), b""
        if kind == Instruction.CONTROL_TABLE_BACKUP:
            return self._backup(servo, parameters), b""
        return servo.errors.instruction, b""

    def _factory_reset(self, servo: SimServo, p: Packet) -> int:
        if servo.model.protocol == 1.0:
            servo.restore_factory()
            return 0
        keep = _FACTORY_KEEPS.get(p.parameters[0]) if p.parameters else None
        if keep is None or (p.servo_id == BROADCAST_ID and not keep):
            return ErrorCode.DATA_RANGE  # "reset all" is refused when broadcast (firmware 42 and later)
        servo.restore_factory(keep)
        return 0

    @staticmethod
    def _backup(servo: SimServo, parameters: bytes) -> int:
        if servo.torque:
            return ErrorCode.RESULT_FAIL
        if parameters == packet.BACKUP_STORE:
            servo.store_backup()
            return 0
        if parameters == packet.BACKUP_RESTORE:
            return 0 if servo.restore_backup() else ErrorCode.RESULT_FAIL
        return ErrorCode.DATA_RANGE

    def missed(self, servos: Sequence[SimServo], access: Access, t_s: float) -> None:
        """Report a write that its servos did not receive to the audit."""
        for servo in servos:
            item = servo.items["goal_position"]
            at = item.address - access.address
            if servo.servo_id == access.servo_id and 0 <= at <= len(access.data) - item.size:
                self._audit.missed(t_s, servo.spec.servo_id, item.decode(access.data[at : at + item.size]))

    def write(self, servo: SimServo, address: int, data: bytes, t_s: float) -> int:
        """Write to a servo and report the write to the audit; return the error code."""
        had_torque, was_faulted, servo_id = servo.torque, servo.is_faulted, servo.spec.servo_id
        error = servo.write(address, data)
        if "goal_position" in servo.asked:
            if error:
                self._audit.refused(t_s, servo_id, error, faulted=was_faulted, tripped=servo.watchdog_tripped)
            else:
                tick = servo.memory.get("goal_position")
                self._audit.goal(t_s, servo_id, tick, had_torque, faulted=was_faulted)
                if self.on_goal is not None:
                    self.on_goal(t_s, servo_id, tick)
        if "torque_limit" in servo.asked and not error:
            limit, most = servo.memory.get("torque_limit"), servo.memory.get("max_torque")
            self._audit.torque_limit(t_s, servo_id, limit, most)
        if "torque_enable" in servo.asked and error and was_faulted:
            self._audit.torque_in_fault(t_s, servo_id)
        if servo.torque != had_torque:
            goal = servo.memory.get("goal_position")
            self._audit.torque(t_s, servo_id, servo.torque, goal, round(servo.position_tick))
        return error


def accesses_of(p: Packet, protocol: float, *, strict: bool = False) -> list[Access]:
    """The accesses that a packet requests of each servo; empty when the packet is cut short, or PacketError when `strict`."""
    try:
        return (packet if protocol == 2.0 else packet1).accesses(p)
    except PacketError:
        if strict:
            raise
        return []


def _identity(servo: SimServo) -> bytes:
    """Parameters of a servo's answer to a ping."""
    if servo.model.protocol == 1.0:
        return b""
    return struct.pack("<HB", servo.memory.get("model_number"), servo.memory.get("firmware_version"))
