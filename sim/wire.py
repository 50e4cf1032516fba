"""One half-duplex wire and the adapter at its end: when each byte is where, and what is left of bytes that met.

Ten bits a byte in both directions. Two talkers at once garble each other: bytes that start together are ANDed, as
open-collector drivers would; others are random. The adapter hands bytes on as they come, in lumps by its latency timer
(FTDI: when the timer fires or a USB packet is full), or in pieces cut anywhere.
"""

from __future__ import annotations

import math
import random
from collections import deque
from dataclasses import dataclass

from sim.errors import SimSettingError

BITS_PER_BYTE = 10
_GAP_S = 0.001
"""Bytes that follow each other within this are handed on as one burst: fewer wake-ups, the same end."""
_TINY_S = 1e-9


@dataclass(frozen=True)
class WireSettings:
    """How wire and adapter behave.

    Attributes:
        turnaround_s: from the last bit of an instruction to the first of an answer, besides the return delay.
        latency_s: period of the adapter's latency timer; 0 for a native UART. FTDI: 0.016 from the factory, 0.001 at least.
        usb_packet_bytes: bytes after which the adapter does not wait for the timer: 62, or 510 for high-speed ones.
        piece_bytes: (least, most) size of the pieces a read is cut into; None for whole bursts.
        no_wire_delay: answers arrive at once: for measuring software, not wires.
        seed: of the pieces and of what collisions leave.
    """

    turnaround_s: float = 0.0
    latency_s: float = 0.0
    usb_packet_bytes: int = 62
    piece_bytes: tuple[int, int] | None = None
    no_wire_delay: bool = False
    seed: int = 0

    def __post_init__(self) -> None:
        """Refuse what no wire can be."""
        for name in ("turnaround_s", "latency_s"):
            value = getattr(self, name)
            if not 0 <= value <= 1:
                raise SimSettingError(name, repr(value), "0 to 1 s")
        if self.usb_packet_bytes < 1:
            raise SimSettingError("usb_packet_bytes", str(self.usb_packet_bytes), "1 or more")
        if self.piece_bytes is not None and not 1 <= self.piece_bytes[0] <= self.piece_bytes[1]:
            raise SimSettingError("piece_bytes", str(self.piece_bytes), "1 <= least <= most")


@dataclass
class _Burst:
    """Bytes on their way to the client; `alone`: not to be joined with what follows."""

    start_s: float
    byte_s: float
    data: bytearray
    alone: bool = False

    @property
    def end_s(self) -> float:
        return self.start_s + len(self.data) * self.byte_s


class Wire:
    """What is on the wire towards the client, and what the adapter has not handed on yet."""

    def __init__(self, settings: WireSettings | None = None) -> None:
        self.settings = settings or WireSettings()
        self._random = random.Random(self.settings.seed)
        self._coming: deque[_Burst] = deque()
        self._held = bytearray()  # the rest of a lump that was read in part
        self._timer_s = 0.0
        self._client_start_s, self._client_end_s = -math.inf, -math.inf
        self.collisions = 0

    def talk(self, t_s: float, data: bytes, baud: int, *, patient: bool = False) -> tuple[float, float, bytearray]:
        """The client sends: (start, seconds per byte, the bytes as servos hear them). What it meets is garbled.

        `patient`: not before the answers under way are through. For doors in real time, where a simulator that was held up
        would make answers late, and a client that was in time collide with them.
        """
        byte_s = 0.0 if self.settings.no_wire_delay else BITS_PER_BYTE / baud
        start_s = max(t_s, self._client_end_s)
        if patient and self._coming:
            start_s = max(start_s, self._coming[-1].end_s)
        heard = bytearray(data)
        self._client_start_s, self._client_end_s = start_s, start_s + len(data) * byte_s
        for burst in self._coming:
            if burst.end_s > start_s + _TINY_S and burst.start_s < self._client_end_s - _TINY_S:
                self.garble(heard, start_s, byte_s, burst.start_s, burst.end_s)
                self.garble(burst.data, burst.start_s, burst.byte_s, start_s, self._client_end_s)
                self.collisions += 1
        return start_s, byte_s, heard

    def answer(self, start_s: float, data: bytes, baud: int, *, alone: bool = False) -> float:
        """A servo sends from `start_s` on; the time its last byte ends."""
        byte_s = 0.0 if self.settings.no_wire_delay else BITS_PER_BYTE / baud
        burst = _Burst(start_s, byte_s, bytearray(data), alone)
        if start_s < self._client_end_s - _TINY_S and burst.end_s > self._client_start_s + _TINY_S:
            self.garble(burst.data, start_s, byte_s, self._client_start_s, self._client_end_s)
            self.collisions += 1
        last = self._coming[-1] if self._coming else None
        if last is not None and start_s < last.end_s - _TINY_S:
            self._meet(last, burst)
        elif (
            last is not None
            and not alone
            and not last.alone
            and abs(start_s - last.end_s) < _TINY_S
            and last.byte_s == byte_s
        ):
            last.data += data
            return last.end_s
        if self.settings.piece_bytes is not None and not alone:
            self._cut(burst)
        elif burst.data:
            self._coming.append(burst)
        return burst.end_s

    def echo(self, start_s: float, data: bytes, byte_s: float) -> None:
        """The client hears what it sends."""
        self._coming.append(_Burst(start_s, byte_s, bytearray(data)))

    def garble(self, data: bytearray, start_s: float, byte_s: float, from_s: float, to_s: float) -> tuple[int, int]:
        """Make noise of the bytes of `data` that are on the wire between two times; their range."""
        if byte_s <= 0:
            return 0, 0
        first = max(0, math.floor((from_s - start_s) / byte_s + 1e-6))
        last = min(len(data), math.ceil((to_s - start_s) / byte_s - 1e-6))
        for i in range(first, last):
            data[i] ^= self._random.randrange(1, 256)
        return first, last

    def _meet(self, first: _Burst, second: _Burst) -> None:
        """Two servos at once: the same bytes at the same time survive, the rest does not."""
        self.collisions += 1
        if abs(first.start_s - second.start_s) < _TINY_S:
            n = min(len(first.data), len(second.data))
            for i in range(n):
                first.data[i] &= second.data[i]
            del second.data[:n]
            second.start_s += n * second.byte_s
            return
        self.garble(first.data, first.start_s, first.byte_s, second.start_s, second.end_s)
        overlap = self.garble(second.data, second.start_s, second.byte_s, first.start_s, first.end_s)[1]
        del second.data[:overlap]
        second.start_s += overlap * second.byte_s

    def _cut(self, burst: _Burst) -> None:
        least, most = self.settings.piece_bytes or (1, 1)
        at = 0
        while at < len(burst.data):
            size = self._random.randint(least, most)
            start_s = burst.start_s + at * burst.byte_s
            self._coming.append(_Burst(start_s, burst.byte_s, burst.data[at : at + size], alone=True))
            at += size

    # The client's end.

    def clear(self) -> None:
        """The cable is out: what was under way is gone."""
        self._coming.clear()
        self._held.clear()

    def ready_s(self, most: int = 1 << 30, until_s: float = math.inf) -> float | None:
        """When something is handed to the client next, at best `most` bytes at once; None when nothing is under way.

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

    def _arrived(self, burst: _Burst, t_s: float) -> int:
        """How many bytes of a burst are in by `t_s`."""
        if burst.end_s <= t_s + _TINY_S:
            return len(burst.data)
        if burst.byte_s <= 0:
            return 0
        return max(0, math.floor((t_s - burst.start_s) / burst.byte_s + 1e-6))

    def _shorten(self, burst: _Burst, n: int) -> None:
        if n >= len(burst.data):
            self._coming.popleft()
        else:
            del burst.data[:n]
            burst.start_s += n * burst.byte_s

    # The adapter's buffer.

    def _flush_of(self, burst: _Burst) -> float:
        """When the first byte of what comes next is handed on: by the timer, or when a packet is full before."""
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
        """Everything whose lump has been handed on by `t_s`."""
        out = bytearray()
        if self._held:
            n = min(len(self._held), most)
            out += self._held[:n]
            del self._held[:n]
        while self._coming and len(out) < most:
            flush_s = self._flush_of(self._coming[0])
            if flush_s > t_s + _TINY_S:
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
