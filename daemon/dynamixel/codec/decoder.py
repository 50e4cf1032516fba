"""Finds packets in a stream of bytes; the two protocols differ in their header, their checksum and their fields."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar, Generic, TypeVar

P = TypeVar("P")


class StreamDecoder(ABC, Generic[P]):
    """Decodes bytes to packets. Garbage is skipped and counted; a length counts as valid only once the checksum agrees.

    Attributes:
        skipped_bytes, bad_checksums: counts since the beginning.
        damaged_id: id in a packet that ended with the last byte fed and had a wrong checksum; None without one.
    """

    header: ClassVar[bytes]

    def __init__(self) -> None:
        self._buffer = bytearray()
        self.skipped_bytes = 0
        self.bad_checksums = 0
        self.damaged_id: int | None = None

    @abstractmethod
    def _end(self, start: int) -> int | None:
        """Index after the packet at `start`; 0 when there is none, None when bytes are missing."""

    @abstractmethod
    def _parse(self, raw: bytes) -> P:
        """The packet of bytes whose checksum agrees."""

    def feed(self, data: bytes) -> list[P]:
        """The packets completed by `data`."""
        self._buffer += data
        self.damaged_id = None
        packets: list[P] = []
        while (found := self._next()) is not None:
            packets.append(found)
        return packets

    def clear(self) -> None:
        """Discard the bytes that are not decoded yet."""
        self.skipped_bytes += len(self._buffer)
        self._buffer.clear()

    def _next(self) -> P | None:
        """First whole packet in the buffer; bytes before it are dropped, bytes of a packet that may still grow are kept."""
        buffer, start, keep_from = self._buffer, 0, None
        while (start := buffer.find(self.header, start)) >= 0:
            end = self._end(start)
            if end is None:  # may still grow; a later complete packet takes precedence
                keep_from = start if keep_from is None else keep_from
            elif end > 0:
                raw = bytes(buffer[start:end])
                self._drop(end, skipped=start)
                return self._parse(raw)
            start += 1
        if keep_from is None:
            keep_from = max(0, len(buffer) - (len(self.header) - 1))  # the header may have begun
            tail = bytes(buffer[keep_from:])
            while tail and not self.header.startswith(tail):
                tail = tail[1:]
            keep_from = len(buffer) - len(tail)
        self._drop(keep_from, skipped=keep_from)
        return None

    def _drop(self, end: int, skipped: int) -> None:
        self.skipped_bytes += skipped
        del self._buffer[:end]
