"""One half-duplex wire and the adapter at its end: the time of each byte, and the result of collisions.

Ten bits a byte in both directions. Two talkers at once garble each other (`wire_bytes.py`). The adapter hands bytes on as they
come, in lumps by its latency timer (FTDI: when the timer fires or a USB packet is full), or in pieces cut anywhere.
"""

from __future__ import annotations

import math
import random
from collections import deque
from dataclasses import dataclass

from sim.errors import SimSettingError
from sim.wire.wire_bytes import TINY_S, Burst, put

BITS_PER_BYTE = 10
_GAP_S = 0.001
"""Seconds between bytes that are passed on as one burst: fewer wake-ups, the same result."""


@dataclass(frozen=True)
class WireSettings:
    """Settings of a wire and its adapter.

    Attributes:
        turnaround_s: from the last bit of an instruction to the first of an answer, besides the return delay.
        latency_s: period of the adapter's latency timer; 0 for a native UART. FTDI: 0.016 from the factory, 0.001 at least.
        usb_packet_bytes: bytes after which the adapter does not wait for the timer: 62, or 510 for high-speed ones.
        piece_bytes: (least, most) size of the pieces a read is cut into; None for whole bursts.
        no_wire_delay: answers arrive at once: for measuring software, not wires.
        seed: of the pieces' sizes and of the noise that collisions leave.
    """

    turnaround_s: float = 0.0
    latency_s: float = 0.0
    usb_packet_bytes: int = 62
    piece_bytes: tuple[int, int] | None = None
    no_wire_delay: bool = False
    seed: int = 0

    def __post_init__(self) -> None:
        """Refuse values that no wire can have."""
        for name in ("turnaround_s", "latency_s"):
            value = getattr(self, name)
            if not 0 <= value <= 1:
                raise SimSettingError(name, repr(value), "0 to 1 s")
        if self.usb_packet_bytes < 1:
            raise SimSettingError("usb_packet_bytes", str(self.usb_packet_bytes), "1 or more")
        if self.piece_bytes is not None and not 1 <= self.piece_bytes[0] <= self.piece_bytes[1]:
            raise SimSettingError("piece_bytes", str(self.piece_bytes), "1 <= least <= most")


class Wire:
    """Bytes on the wire towards the client, and bytes that the adapter has not passed on yet."""

    def __init__(self, settings: WireSettings | None = None) -> None:
        self.settings = settings or WireSettings()
        self._random = random.Random(self.settings.seed)
        self._coming: deque[Burst] = deque()
        self._held = bytearray()  # the rest of a lump that was read in part
        self._timer_s = 0.0
        self._client_start_s, self._client_end_s = -math.inf, -math.inf
        self.collisions = 0

    def talk(self, t_s: float, data: bytes, baud: int, *, patient: bool = False) -> tuple[float, float, bytearray]:
        """Let the client send: return start time, seconds per byte, and the bytes as servos receive them, garbled by collisions.

        A `patient` client starts after the answers under way. Real-time ports use this: a simulator that was held up would send
        answers late, and a client that sent in time would collide with them.
        """
        byte_s = 0.0 if self.settings.no_wire_delay else BITS_PER_BYTE / baud
        start_s = max(t_s, self._client_end_s)
        if patient and self._coming:
            start_s = max(start_s, self._coming[-1].end_s)
        heard = Burst(start_s, byte_s, bytearray(data))
        self._client_start_s, self._client_end_s = start_s, heard.end_s
        for burst in self._coming:
            if burst.end_s > start_s + TINY_S and burst.start_s < self._client_end_s - TINY_S:
                heard.garble(burst.start_s, burst.end_s, self._random)
                burst.garble(start_s, self._client_end_s, self._random)
                self.collisions += 1
        return start_s, byte_s, heard.data

    def answer(self, start_s: float, data: bytes, baud: int, *, alone: bool = False) -> float:
        """Let a servo send from `start_s` on; return the time at which its last byte ends."""
        byte_s = 0.0 if self.settings.no_wire_delay else BITS_PER_BYTE / baud
        burst = Burst(start_s, byte_s, bytearray(data), alone)
        if start_s < self._client_end_s - TINY_S and burst.end_s > self._client_start_s + TINY_S:
            burst.garble(self._client_start_s, self._client_end_s, self._random)
            self.collisions += 1
        last = self._coming[-1] if self._coming else None
        if last is not None and start_s < last.end_s - TINY_S:
            for part in self._overlay(burst):
                self._add(part)
        elif (
            last is not None
            and not alone
            and not last.alone
            and start_s < last.end_s + TINY_S
            and last.byte_s == byte_s
        ):
            last.data += burst.data
        else:
            self._add(burst)
        return burst.end_s

    def echo(self, start_s: float, data: bytes, byte_s: float) -> None:
        """Return the client's own bytes to it as an echo."""
        for part in self._overlay(Burst(start_s, byte_s, bytearray(data))):
            put(self._coming, part)

    def _overlay(self, burst: Burst) -> list[Burst]:
        """Let a burst collide with all bytes on the wire at its time; return the parts that met none."""
        parts = [burst]
        for other in self._coming:
            if other.start_s < burst.end_s - TINY_S and burst.start_s < other.end_s - TINY_S:
                parts = [rest for part in parts for rest in other.meet(part, self._random)]
                self.collisions += 1
        return parts

    def _add(self, burst: Burst) -> None:
        if self.settings.piece_bytes is not None and not burst.alone:
            self._cut(burst)
        elif burst.data:
            put(self._coming, burst)

    def _cut(self, burst: Burst) -> None:
        least, most = self.settings.piece_bytes or (1, 1)
        at = 0
        while at < len(burst.data):
            size = self._random.randint(least, most)
            piece = burst.part(at, min(at + size, len(burst.data)))
            piece.alone = True
            put(self._coming, piece)
            at += size

    # The client's end.

    def clear(self) -> None:
        """Discard all bytes under way: the cable is out."""
        self._coming.clear()
        self._held.clear()

    def ready_s(self, most: int = 1 << 30, until_s: float = math.inf) -> float | None:
        """Time at which bytes are next passed to the client, at best `most` at once; None when none are under way.

        Without latency timer and pieces this is the end of the burst, or `until_s` within one.
        """
        if self._held:
            return -math.inf
        if not self._coming:
            return None
        first = self._coming[0]
        if self.settings.latency_s:
            return self._flush_of(first)
        wanted, end_s = 0, first.start_s + first.byte_s
        for burst in self._coming:
            if wanted and (burst.alone or burst.start_s > end_s + _GAP_S or burst.start_s + burst.byte_s > until_s):
                break
            share = min(len(burst.data), most - wanted)
            within = len(burst.data)
            if burst.byte_s > 0 and burst.end_s > until_s:
                within = max(1, math.floor((until_s - burst.start_s) / burst.byte_s + 1e-6))
            share = min(share, within)
            wanted, end_s = wanted + share, max(end_s, burst.start_s + share * burst.byte_s)
            if burst.alone or wanted >= most:
                break
        return end_s

    def take(self, t_s: float, most: int = 1 << 30) -> bytes:
        """Bytes the client can read at `t_s`."""
        if self.settings.latency_s:
            return self._take_lumps(t_s, most)
        out = bytearray()
        while self._coming and len(out) < most:
            burst = self._coming[0]
            n = self._arrived(burst, t_s)
            if not n:
                break
            n = min(n, most - len(out))
            out += burst.data[:n]
            self._shorten(burst, n)
            if burst.alone:
                break
        return bytes(out)

    def _arrived(self, burst: Burst, t_s: float) -> int:
        """Number of bytes of a burst that have arrived by `t_s`."""
        if burst.end_s <= t_s + TINY_S:
            return len(burst.data)
        if burst.byte_s <= 0:
            return 0
        return max(0, math.floor((t_s - burst.start_s) / burst.byte_s + 1e-6))

    def _shorten(self, burst: Burst, n: int) -> None:
        if n >= len(burst.data):
            self._coming.popleft()
        else:
            del burst.data[:n]
            burst.start_s += n * burst.byte_s

    # The adapter's buffer.

    def _flush_of(self, burst: Burst) -> float:
        """Time at which the first byte of the next burst is passed on: when the timer fires, or earlier when a packet is full."""
        period, first_s = self.settings.latency_s, burst.start_s + burst.byte_s
        by_timer_s = self._timer_s + period * max(1, math.ceil((first_s - self._timer_s) / period - 1e-9))
        missing, full_s = self.settings.usb_packet_bytes, math.inf
        for coming in self._coming:
            if len(coming.data) >= missing:
                full_s = coming.start_s + missing * coming.byte_s
                break
            missing -= len(coming.data)
        return min(by_timer_s, full_s)

    def _take_lumps(self, t_s: float, most: int) -> bytes:
        """All bytes whose lump has been passed on by `t_s`."""
        out = bytearray()
        if self._held:
            n = min(len(self._held), most)
            out += self._held[:n]
            del self._held[:n]
        while self._coming and len(out) < most:
            flush_s = self._flush_of(self._coming[0])
            if flush_s > t_s + TINY_S:
                break
            self._timer_s = flush_s
            lump = bytearray()
            while (
                self._coming
                and (n := self._arrived(self._coming[0], flush_s))
                and len(lump) < self.settings.usb_packet_bytes
            ):
                n = min(n, self.settings.usb_packet_bytes - len(lump))
                lump += self._coming[0].data[:n]
                self._shorten(self._coming[0], n)
            room = most - len(out)
            out += lump[:room]
            self._held += lump[room:]
        return bytes(out)
