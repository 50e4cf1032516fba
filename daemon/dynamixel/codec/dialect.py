"""The two protocols behind one set of calls, so that the servo bus treats an AX like an XM."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec import packet_protocol1 as packet1
from daemon.dynamixel.codec.decoder import StreamDecoder
from daemon.dynamixel.codec.packet import ALERT_BIT, Packet


class Dialect(Protocol):
    """The calls in which the protocols differ for a controller."""

    version: float
    status_bytes: int
    """Length of a status packet without parameters."""

    def decoder(self) -> StreamDecoder[Packet]:
        """A decoder of answers."""
        ...

    def ping(self, servo_id: int) -> bytes:
        """The request for a sign of life from a servo."""
        ...

    def read(self, servo_id: int, address: int, length: int) -> bytes:
        """The request for `length` bytes at `address`."""
        ...

    def write(self, servo_id: int, address: int, data: bytes) -> bytes:
        """The request to write bytes."""
        ...

    def reboot(self, servo_id: int) -> bytes:
        """The request to restart a servo."""
        ...

    def sync_write(self, address: int, length: int, rows: Sequence[tuple[int, bytes]]) -> bytes:
        """The request to write to several servos at once."""
        ...

    def refusal(self, error: int) -> str:
        """Why an error byte refuses the request, in words; empty when the request was carried out."""
        ...

    def alert(self, error: int) -> int:
        """ALERT_BIT when the error byte reports an error of the servo itself, else 0."""
        ...


class Protocol2:
    """X series, MX with 2.0 firmware."""

    version = 2.0
    status_bytes = 11
    ping = staticmethod(packet.ping)
    read = staticmethod(packet.read)
    write = staticmethod(packet.write)
    reboot = staticmethod(packet.reboot)
    sync_write = staticmethod(packet.sync_write)

    def decoder(self) -> StreamDecoder[Packet]:
        return packet.PacketDecoder()

    def refusal(self, error: int) -> str:
        """The refusal in the low seven bits of the error byte."""
        code = error & ~ALERT_BIT
        return packet.error_text(code) if code else ""

    def alert(self, error: int) -> int:
        """The alert in bit 7 of the error byte."""
        return error & ALERT_BIT


class Protocol1:
    """AX, MX."""

    version = 1.0
    status_bytes = 6
    ping = staticmethod(packet1.ping)
    read = staticmethod(packet1.read)
    write = staticmethod(packet1.write)
    reboot = staticmethod(packet1.reboot)
    sync_write = staticmethod(packet1.sync_write)

    def decoder(self) -> StreamDecoder[Packet]:
        return packet1.PacketDecoder(answers=True)

    def refusal(self, error: int) -> str:
        """The refusal in the error bits that concern the request."""
        code = error & ~packet1.ALERT_BITS
        return packet1.error_text(code) if code else ""

    def alert(self, error: int) -> int:
        """The alert in the error bits that concern the servo."""
        return ALERT_BIT if error & packet1.ALERT_BITS else 0


DIALECTS: dict[float, Dialect] = {2.0: Protocol2(), 1.0: Protocol1()}
