"""Applies faults of the wire to one status packet; the result is pieces of bytes, each with its delay."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from sim.faults import Fault, FaultSchedule


@dataclass(frozen=True)
class Piece:
    """Bytes that are sent `after_s` seconds late; `alone`: read apart from the bytes that follow."""

    data: bytes
    after_s: float = 0.0
    alone: bool = False


def apply_packet_faults(
    faults: FaultSchedule, servo_id: int, encode: Callable[[int], bytes], t_s: float, byte_s: float
) -> list[Piece]:
    """The answer of a servo as sent at `t_s`; empty when it is lost.

    Args:
        faults: the schedule; its packet counter increases by one.
        servo_id: id of the answering servo.
        encode: the answer's bytes, given the id it is to carry.
        t_s: when.
        byte_s: seconds a byte takes.
    """
    faults.packet += 1
    if not faults.strikes_packets:
        return [Piece(encode(servo_id))]
    draw = faults.random

    def strikes(kind: str) -> Fault | None:
        return faults.active(kind, t_s, servo_id)

    if strikes("silent") or strikes("drop"):
        return []
    data = encode((servo_id + 1) % 252 if strikes("wrong_id") else servo_id)
    if strikes("corrupt"):
        at = draw.randrange(len(data))
        data = data[:at] + bytes([data[at] ^ (1 << draw.randrange(8))]) + data[at + 1 :]
    if strikes("collision"):
        at = draw.randrange(len(data))
        data = data[:at] + bytes(byte ^ draw.randrange(1, 256) for byte in data[at:])
    if fault := strikes("truncate"):
        data = data[: len(data) // 2 if fault.amount is None else int(fault.amount)]
    if strikes("duplicate"):
        data += data
    if strikes("foreign"):
        data = encode((servo_id + 100) % 252) + data
    if fault := strikes("noise"):
        data = draw.randbytes(8 if fault.amount is None else int(fault.amount)) + data
    late_s, alone = 0.0, False
    if fault := strikes("delay"):
        late_s, alone = 0.005 if fault.amount is None else fault.amount, True
    if len(data) > 1 and (fault := strikes("split")):
        at = draw.randrange(1, len(data))
        gap_s = 0.001 if fault.amount is None else fault.amount
        return [Piece(data[:at], late_s, alone=True), Piece(data[at:], late_s + at * byte_s + gap_s, alone=True)]
    return [Piece(data, late_s, alone)] if data else []
