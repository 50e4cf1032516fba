"""Bytes in time on one wire, and the bytes that are left when two senders collide.

Bytes that begin together are ANDed bit by bit, as open-collector drivers do; bytes that do not line up become noise.
"""

from __future__ import annotations

import math
import random
from collections import deque
from dataclasses import dataclass

TINY_S = 1e-9
"""Seconds by which two times may differ and count as equal: hours into a run a double resolves some 1e-11 s."""


@dataclass
class Burst:
    """Bytes on their way to the client; `alone`: not to be joined with the bytes that follow."""

    start_s: float
    byte_s: float
    data: bytearray
    alone: bool = False

    @property
    def end_s(self) -> float:
        """Time at which the last byte ends."""
        return self.start_s + len(self.data) * self.byte_s

    def within(self, from_s: float, to_s: float) -> tuple[int, int]:
        """Range of the bytes that are on the wire, at least in part, between two times."""
        if self.byte_s <= 0:
            return 0, 0
        first = max(0, math.floor((from_s - self.start_s + TINY_S) / self.byte_s))
        last = min(len(self.data), math.ceil((to_s - self.start_s - TINY_S) / self.byte_s))
        return first, max(first, last)

    def garble(self, from_s: float, to_s: float, draw: random.Random) -> None:
        """Turn the bytes that are on the wire between two times into noise."""
        for i in range(*self.within(from_s, to_s)):
            self.data[i] ^= draw.randrange(1, 256)

    def part(self, first: int, last: int) -> Burst:
        """Some of the burst's bytes, at their time."""
        return Burst(self.start_s + first * self.byte_s, self.byte_s, self.data[first:last], self.alone)

    def meet(self, other: Burst, draw: random.Random) -> list[Burst]:
        """Collide with another burst: the result of the overlap stays in this burst; return the rest of `other`'s bytes."""
        if self.byte_s <= 0 or other.byte_s <= 0:
            return [other]
        first, last = other.within(self.start_s, self.end_s)
        if first == last:
            return [other]
        at = (other.start_s - self.start_s) / self.byte_s
        if other.byte_s == self.byte_s and abs(at - round(at)) * self.byte_s < TINY_S:
            for i in range(first, last):
                self.data[i + round(at)] &= other.data[i]
        else:
            self.garble(other.start_s, other.end_s, draw)
        return [part for part in (other.part(0, first), other.part(last, len(other.data))) if part.data]


def put(bursts: deque[Burst], burst: Burst) -> None:
    """Insert a burst among others that are in the order of time and do not overlap with it."""
    at = len(bursts)
    while at and bursts[at - 1].start_s > burst.start_s + TINY_S:
        at -= 1
    bursts.insert(at, burst)
