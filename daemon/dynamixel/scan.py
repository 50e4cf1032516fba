"""Finds the servos on a port, at every baud and in both protocols. Only pings and reads: nothing on the bus changes."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec import packet_protocol1 as packet1
from daemon.dynamixel.codec.dialect import DIALECTS
from daemon.dynamixel.codec.packet import BROADCAST_ID, Packet
from daemon.dynamixel.feedback import is_status
from daemon.dynamixel.ports.port import Port
from daemon.dynamixel.registers.models import MODELS
from daemon.dynamixel.timing import BITS_PER_BYTE
from daemon.errors import PortBaudError
from daemon.host.clock import Clock

BAUDS = (57_600, 1_000_000, 2_000_000, 3_000_000, 4_000_000, 115_200, 9_600, 4_500_000)
"""Bauds in the order of their use by robots: factory, Poppy and OP2, OP3, and the rest."""
_SILENCE_S = 0.06
"""Seconds of silence that end a broadcast ping: slightly more than two periods of an adapter with default settings."""
_ANSWER_S = 0.02
"""Seconds to wait for the answer to a single ping: one period of such an adapter."""


@dataclass(frozen=True)
class Found:
    """A servo that answered."""

    baud: int
    protocol: float
    servo_id: int
    model_number: int
    firmware: int

    @property
    def model_name(self) -> str:
        """The maker's name of the model, or its number when unknown."""
        model = MODELS.get(self.model_number)
        return model.name if model else f"model {self.model_number}"


@dataclass(frozen=True)
class ScanResult:
    """Result of a scan.

    Attributes:
        found: the servos.
        garbled_bauds: bauds with answers that could not be decoded: two servos with one id, or servos of the
            other protocol.
        impossible_bauds: bauds that the port does not support.
    """

    found: tuple[Found, ...]
    garbled_bauds: tuple[int, ...]
    impossible_bauds: tuple[int, ...] = ()


def scan(
    open_at: Callable[[int], Port],
    clock: Clock,
    *,
    bauds: Sequence[int] = BAUDS,
    protocols: Sequence[float] = (2.0, 1.0),
    ids: Sequence[int] = range(packet.MAX_ID + 1),
    on_progress: Callable[[int, float, float], None] = lambda _baud, _protocol, _share: None,
) -> ScanResult:
    """Search servos at each baud, in each protocol.

    Args:
        open_at: opens the port at a baud.
        clock: clock of the waiting.
        bauds: bauds to try.
        protocols: protocols to try.
        ids: ids tried one by one in protocol 1.0, which has no broadcast ping worth waiting for.
        on_progress: called with (baud, protocol, share done of this pair).
    """
    found: list[Found] = []
    garbled: list[int] = []
    impossible: list[int] = []
    for baud in bauds:
        try:
            opened = open_at(baud)
        except PortBaudError:
            impossible.append(baud)
            continue
        with contextlib.closing(opened) as port:
            for protocol in protocols:
                on_progress(baud, protocol, 0.0)
                if protocol == 2.0:
                    answers, clear = _broadcast(port, clock)
                    found += [Found(baud, 2.0, *answer) for answer in answers]
                    if not clear:
                        garbled.append(baud)
                else:
                    for i, servo_id in enumerate(ids):
                        on_progress(baud, protocol, i / len(ids))
                        found += [Found(baud, 1.0, *answer) for answer in _single(port, clock, servo_id)]
                on_progress(baud, protocol, 1.0)
    return ScanResult(tuple(found), tuple(garbled), tuple(impossible))


def answering(port: Port, clock: Clock) -> list[Found]:
    """All servos of Protocol 2.0 at the port's baud, found by one broadcast ping."""
    return [Found(port.baud, 2.0, *answer) for answer in _broadcast(port, clock)[0]]


def _broadcast(port: Port, clock: Clock) -> tuple[list[tuple[int, int, int]], bool]:
    """(id, model number, firmware) of all servos that answer a broadcast ping, and whether no other bytes came."""
    decoder, heard = packet.PacketDecoder(), b""
    _drain(port)
    request = packet.ping(BROADCAST_ID)
    port.write(request)
    slot_s = 14 * BITS_PER_BYTE / port.baud + 0.001  # servos answer in the order of their ids
    last_s = clock.now_s() + packet.MAX_ID * slot_s
    answers: list[tuple[int, int, int]] = []
    quiet_s = clock.now_s() + _SILENCE_S + 4 * slot_s
    while (now_s := clock.now_s()) < max(quiet_s, last_s if not heard else 0.0):
        data = port.read(4096, max(quiet_s, last_s if not heard else 0.0) - now_s)
        if not data:
            break
        heard += data
        quiet_s = clock.now_s() + _SILENCE_S + 64 * slot_s
        for p in decoder.feed(data):
            if p.instruction == packet.Instruction.STATUS and len(p.parameters) == 3:
                answers.append((p.servo_id, int.from_bytes(p.parameters[:2], "little"), p.parameters[2]))
    noise = decoder.skipped_bytes > 0 or len(answers) != len({a[0] for a in answers})
    return sorted(set(answers)), not noise


def identify(port: Port, clock: Clock, servo_id: int, protocol: float) -> tuple[int, int] | None:
    """Model number and firmware of the servo with this id, requested once in this protocol; None when it does not answer."""
    request = packet.ping(servo_id) if protocol == 2.0 else packet1.read(servo_id, 0, 3)
    answer = _asked(port, clock, protocol, servo_id, request, 3)
    return None if answer is None else (int.from_bytes(answer.parameters[:2], "little"), answer.parameters[2])


def _single(port: Port, clock: Clock, servo_id: int) -> list[tuple[int, int, int]]:
    """The servo with this id in protocol 1.0: a ping finds it, a read gets its model."""
    if _asked(port, clock, 1.0, servo_id, packet1.ping(servo_id), 0) is None:
        return []
    number, firmware = identify(port, clock, servo_id, 1.0) or (0, 0)
    return [(servo_id, number, firmware)]


def _asked(port: Port, clock: Clock, protocol: float, servo_id: int, request: bytes, length: int) -> Packet | None:
    """Send one request; return the answer if it has the expected number of parameters, else None."""
    _drain(port)
    dialect = DIALECTS[protocol]
    decoder = dialect.decoder()
    port.write(request)
    n_bytes = len(request) + dialect.status_bytes + length
    deadline_s = clock.now_s() + n_bytes * BITS_PER_BYTE / port.baud + _ANSWER_S
    while (left_s := deadline_s - clock.now_s()) > 0:
        data = port.read(256, left_s)
        if not data:
            return None
        for p in decoder.feed(data):
            if p.servo_id == servo_id and is_status(p) and len(p.parameters) == length:
                return p
    return None


def _drain(port: Port) -> None:
    while port.read(4096, 0.0):
        pass
