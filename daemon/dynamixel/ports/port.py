"""The contract of a port: bytes out, bytes in, and no call that blocks for ever."""

from __future__ import annotations

from typing import Protocol, runtime_checkable


class Port(Protocol):
    """A half-duplex byte stream to servos.

    A lost device raises `LinkLostError` from `write` or `read`.
    """

    @property
    def name(self) -> str:
        """The URL with which the port was opened, for messages."""
        ...

    @property
    def baud(self) -> int:
        """Bits per second on the wire."""
        ...

    def write(self, data: bytes) -> None:
        """Send all of `data`."""
        ...

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """At least one and at most `max_bytes` bytes; empty when none came within `timeout_s`."""
        ...

    def close(self) -> None:
        """Release the device; may be called twice."""
        ...


@runtime_checkable
class Reopenable(Port, Protocol):
    """A port that can come back after its device was lost."""

    def reopen(self) -> None:
        """Open the device again, at its old path or at the adapter's new one.

        Raises:
            LinkLostError: the device is not back.
        """
        ...
