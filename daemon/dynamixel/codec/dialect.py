"""The two protocols behind one set of calls, so that the servo bus asks an AX as it asks an XM."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec import packet_protocol1 as packet1
from daemon.dynamixel.codec.decoder import StreamDecoder
from daemon.dynamixel.codec.packet import ALERT_BIT, Packet


class Dialect(Protocol):
    """What differs between the protocols for a controller."""

    version: float
    status_bytes: int
    """Length of a status packet without parameters."""

    def decoder(self) -> StreamDecoder[Packet]:
        """A decoder of answers."""
        ...

    def ping(self, servo_id: int) -> bytes:
        """Ask whether a servo is there."""
        ...

    def read(self, servo_id: int, address: int, length: int) -> bytes:
        """Ask for bytes."""
        ...

    def write(self, servo_id: int, address: int, data: bytes) -> bytes:
        """Write bytes."""
        ...

    def reboot(self, servo_id: int) -> bytes:
        """Restart a servo."""
        ...

    def sync_write(self, address: int, length: int, rows: Sequence[tuple[int, bytes]]) -> bytes:
        """Write to several servos at once."""
        ...

    def refusal(self, error: int) -> str:
        """What an error byte says against the request, in words; empty when it was carried out."""
        ...

    def alert(self, error: int) -> int:
        """ALERT_BIT when the error byte says that the servo itself is in trouble, else 0."""
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
        """A decoder of answers."""
        return packet.PacketDecoder()

    def refusal(self, error: int) -> str:
        """Low seven bits."""
        code = error & ~ALERT_BIT
        return packet.error_text(code) if code else ""

    def alert(self, error: int) -> int:
        """Bit 7."""
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
        """A decoder of answers."""
        return packet1.PacketDecoder(answers=True)

    def refusal(self, error: int) -> str:
        """The bits that speak of the request."""
        code = error & ~packet1.ALERT_BITS
        return packet1.error_text(code) if code else ""

    def alert(self, error: int) -> int:
        """The bits that speak of the servo."""
        return ALERT_BIT if error & packet1.ALERT_BITS else 0


DIALECTS: dict[float, Dialect] = {2.0: Protocol2(), 1.0: Protocol1()}
