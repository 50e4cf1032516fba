"""The allowed time of an exchange: bytes on the wire, delays of servos and adapter, and a margin.

dynamixel-sdk waits a fixed 34 ms for a silent servo; here a silent servo costs the time of its answer plus the margin.
"""

from __future__ import annotations

BITS_PER_BYTE = 10  # 8 data bits, start, stop
MARGIN_S = 0.004
"""Seconds added to all computed and measured times, for scheduling on a shared machine."""
SETUP_MARGIN_S = 0.03
"""Seconds of margin for single requests outside the cycle: nothing waits for them, and a busy machine may answer late."""
_GAIN = 0.05


class Timing:
    """Wire time of a port, and the turnaround measured on it.

    Attributes:
        return_delay_s: return delay of each answer, seconds; the longest of the servos once it was read from them.
        turnaround_s: time of an exchange beyond its wire time and return delays; a running mean, 0 until measured.
    """

    def __init__(self, baud: int, margin_s: float = MARGIN_S) -> None:
        self._byte_s = BITS_PER_BYTE / baud
        self.margin_s = margin_s
        self.return_delay_s = 0.0005
        self.turnaround_s = 0.0

    def wire_s(self, n_bytes: int) -> float:
        """Seconds that `n_bytes` take on the wire."""
        return n_bytes * self._byte_s

    def expected_s(self, n_bytes: int, answers: int) -> float:
        """Shortest seconds of an exchange of `n_bytes` in both directions and `answers` answers."""
        return n_bytes * self._byte_s + answers * self.return_delay_s

    def longest_s(self, n_bytes: int, answers: int) -> float:
        """Seconds after which no more bytes are expected."""
        return self.expected_s(n_bytes, answers) + self.turnaround_s + self.margin_s

    def measured(self, n_bytes: int, answers: int, took_s: float) -> None:
        """Update the turnaround from a complete exchange, which took `took_s`."""
        extra_s = max(0.0, took_s - self.expected_s(n_bytes, answers))
        self.turnaround_s += _GAIN * (min(extra_s, 0.02) - self.turnaround_s)
