"""Answers of simulated servos on the wire: one status packet, several in a row, or one packet of many parts.

Where the manual is silent we chose: in a sync or bulk read the next servo waits for as long as a missing answer would take (on
protocol 1.0 for ever, as it waits for the packet itself); a fast read ends at the first silent servo, because the next ones cannot
continue its checksum.
"""

from __future__ import annotations

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec import packet_protocol1 as packet1
from daemon.dynamixel.codec.packet import ALERT_BIT, Access, Instruction, Packet, Part
from daemon.dynamixel.registers.registers import RETURN_DELAY_UNIT_S
from sim.servos.instructions import accesses_of
from sim.servos.servo import SimServo
from sim.wire.fast_reply import share_as, shares_of
from sim.wire.packet_faults import Piece, apply_packet_faults
from sim.wire.wire import Wire
from sim.world import World


class Answers:
    """Puts the servos' answers on the wire.

    Args:
        wire: the wire.
        world: faults that strike the packets, and the audit.
    """

    def __init__(self, wire: Wire, world: World) -> None:
        self._wire, self._world = wire, world

    def send(self, servo: SimServo, servo_id: int, error: int, parameters: bytes, t_s: float, baud: int) -> float:
        """Put one status packet of `servo_id` on the wire; return the time at which it ends, or would have ended."""
        byte_s = 0.0 if self._wire.settings.no_wire_delay else 10 / baud
        status = packet.status if servo.model.protocol == 2.0 else packet1.status
        start_s = t_s + self._pause_s(servo)
        alert = servo.alert()
        error |= alert
        end_s = start_s + byte_s * (len(parameters) + (11 if servo.model.protocol == 2.0 else 6))
        pieces = apply_packet_faults(
            self._world.faults, servo_id, lambda i: status(i, error, parameters), start_s, byte_s
        )
        if ((alert and servo.is_faulted) or servo.watchdog_tripped) and pieces == [
            Piece(status(servo_id, error, parameters))
        ]:
            self._world.audit.heard_in_fault(t_s, servo.spec.servo_id)
        for piece in pieces:
            sent_s = self._wire.answer(start_s + piece.after_s, piece.data, baud, alone=piece.alone)
            end_s = max(end_s, sent_s) if not piece.after_s else end_s
        return end_s

    def _pause_s(self, servo: SimServo) -> float:
        if self._wire.settings.no_wire_delay:
            return 0.0
        return servo.memory.get("return_delay_time") * RETURN_DELAY_UNIT_S + self._wire.settings.turnaround_s

    def group(self, p: Packet, protocol: float, by_id: dict[int, list[SimServo]], t_s: float, baud: int) -> None:
        """Send one status packet after another, in the order requested; on protocol 1.0 each waits for the one before."""
        for access in accesses_of(p, protocol):
            ends_s = [
                self.send(servo, access.servo_id, *servo.read(access.address, access.length), t_s, baud)
                for servo in by_id.get(access.servo_id, ())
                if answers(servo, Instruction.READ)
            ]
            if protocol == 1.0 and (not ends_s or self._world.faults.active("silent", t_s, access.servo_id)):
                return
            byte_s = 0.0 if self._wire.settings.no_wire_delay else 10 / baud
            t_s = max(ends_s, default=t_s + (11 + access.length) * byte_s)

    def fast(self, p: Packet, by_id: dict[int, list[SimServo]], t_s: float, baud: int) -> None:
        """Send one packet to which each servo adds its part; servos with the same id send at once."""
        turns: list[list[SimServo]] = []
        parts: list[list[Part]] = []
        accesses = accesses_of(p, 2.0)
        for access in accesses:
            able = [servo for servo in by_id.get(access.servo_id, ()) if _answers_fast(servo)]
            if not able:
                break
            turns.append(able)
            parts.append([_part(servo, access) for servo in able])
            if len(turns) == 1 and len({self._pause_s(servo) for servo in able}) > 1:
                break  # two parts begin at different times: no servo can continue such a packet
        if not turns:
            return
        length = 1 + sum(4 + access.length for access in accesses)
        shares = shares_of(parts, length)
        start_s = t_s + self._pause_s(turns[0][0])
        if not self._world.faults.strikes_packets and all(
            len(said) == 1 for said in shares
        ):  # no other packet comes between the parts
            self._world.faults.packet += len(turns)
            for (servo,), (part,) in zip(turns, parts, strict=True):
                if (part.error & ALERT_BIT and servo.is_faulted) or servo.watchdog_tripped:
                    self._world.audit.heard_in_fault(t_s, servo.spec.servo_id)
            self._wire.answer(start_s, b"".join(own for (own,) in shares), baud)
            return
        byte_s = 0.0 if self._wire.settings.no_wire_delay else 10 / baud
        for turn, servos in enumerate(turns):
            pieces = [
                (start_s if turn else t_s + self._pause_s(servo), piece)
                for servo, part in zip(servos, parts[turn], strict=True)
                for piece in apply_packet_faults(
                    self._world.faults, part.servo_id, share_as(parts[:turn], part, length), start_s, byte_s
                )
            ]
            for own_s, piece in pieces:
                self._wire.answer(own_s + piece.after_s, piece.data, baud, alone=piece.alone)
            if not pieces:
                return
            start_s += len(shares[turn][0]) * byte_s


def answers(servo: SimServo, kind: int) -> bool:
    """Whether the servo's status return level lets it answer."""
    level = servo.memory.get("status_return_level")
    return level == 2 or kind == Instruction.PING or (level == 1 and kind == Instruction.READ)


def _answers_fast(servo: SimServo) -> bool:
    """Whether the servo takes part in a fast read."""
    return servo.model.has_fast_sync(servo.firmware) and answers(servo, Instruction.READ)


def _part(servo: SimServo, access: Access) -> Part:
    """The part of a fast read's answer that a servo sends."""
    error, data = servo.read(access.address, access.length)
    return Part(access.servo_id, error | servo.alert(), data.ljust(access.length, b"\0"))
