"""Two rings of shared memory with one writer each: setpoints from the front, bus cycles from the bus process.

The writer fills a slot and then raises its index, a word of 64 bits that only the writer moves: a reader never waits, and a
stuck peer never blocks the bus.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

N_SETPOINTS = 256
N_CYCLES = 4096
_UNREAD = 64
"""Slots of the cycle ring that a reader leaves alone, because the bus process may be filling them."""


class RingWord(IntEnum):
    """Places of the indices among the words of shared memory."""

    PUSHED = 1
    POPPED = 2
    CYCLES = 5


def setpoint_dtype(n_joints: int) -> np.dtype[np.void]:
    """Type of one setpoint: plan and frame, whether it ends the plan, and (J,) radians.

    Where `instead` is not 0, this setpoint and those after it are left out: the setpoint with that number comes next.
    """
    return np.dtype([
        ("epoch", "u8"), ("plan_id", "u8"), ("instead", "u8"), ("frame", "u4"), ("last", "u1"), ("_", "V3"),
        ("q_rad", "f8", n_joints),
    ])  # fmt: skip


def cycle_dtype(n_joints: int, n_servos: int) -> np.dtype[np.void]:
    """Type of the record of one bus cycle: setpoints, goals after the gate, ticks written, and measurements.

    `t_mono_ns` is the time at which the goals were given to the ports, before the answers were waited for.
    """
    return np.dtype([
        ("cycle", "u8"), ("t_mono_ns", "i8"), ("plan_id", "u8"), ("frame", "u4"), ("state", "u1"), ("last", "u1"),
        ("underrun", "u1"), ("torque", "u1"), ("late_cycles", "u4"),
        ("setpoint_rad", "f8", n_joints), ("goal_rad", "f8", n_joints), ("velocity_rad_s", "f8", n_joints),
        ("goal_tick", "i4", n_servos), ("present_tick", "i4", n_servos), ("present_velocity_raw", "i4", n_servos),
        ("present_current_raw", "i4", n_servos), ("error", "u1", n_servos), ("valid", "u1", n_servos), ("clipped", "u1", n_joints),
    ])  # fmt: skip


@dataclass(frozen=True)
class Setpoint:
    """A setpoint taken from the ring."""

    plan_id: int
    frame: int
    last: bool
    q_rad: Array


class SetpointRing:
    """Setpoints that the front pushes and the bus process takes.

    Args:
        words: words of shared memory.
        slots: (N_SETPOINTS,) slots of `setpoint_dtype`.
    """

    def __init__(self, words: NDArray[np.uint64], slots: NDArray[np.void]) -> None:
        self._words, self._slots = words, slots
        self._left_out: list[tuple[int, int]] = []

    # The front.

    @property
    def queued_frames(self) -> int:
        """Number of setpoints pushed and not yet taken."""
        tail = int(self._words[RingWord.POPPED])
        self._left_out = [(first, end) for first, end in self._left_out if end > tail]
        return int(self._words[RingWord.PUSHED]) - tail - sum(end - max(first, tail) for first, end in self._left_out)

    def push(self, q_rad: Array, plan_id: int, first_frame: int, epoch: int, *, last: bool) -> int:
        """Append setpoints (N, J), radians, as far as there is room; returns how many. `last` marks the final one of the plan."""
        head = int(self._words[RingWord.PUSHED])
        n = min(len(q_rad), N_SETPOINTS - (head - int(self._words[RingWord.POPPED])))
        for i in range(n):
            slot = self._slots[(head + i) % N_SETPOINTS]
            slot["epoch"], slot["plan_id"], slot["frame"], slot["instead"] = epoch, plan_id, first_frame + i, 0
            slot["last"] = last and i == len(q_rad) - 1
            slot["q_rad"] = q_rad[i]
        self._words[RingWord.PUSHED] = head + n
        return n

    def take_back(self, n: int) -> int:
        """Leave out the last `n` setpoints pushed; returns how many of them the bus process had already reached.

        None of them may have been left out before. Each slot names the setpoint to continue with, the last slot first: wherever the
        bus process is then, it leaves out the setpoints that it has not reached.
        """
        head = int(self._words[RingWord.PUSHED])
        for index in range(head - 1, head - n - 1, -1):
            self._slots[index % N_SETPOINTS]["instead"] = head  # one aligned word: there or not
        first = max(head - n, int(self._words[RingWord.POPPED]))
        if first < head:
            self._left_out.append((first, head))
        return min(n, first - (head - n))

    # The bus process.

    def take(self, epoch_now: Callable[[], int]) -> Setpoint | None:
        """The next setpoint of the current epoch, skipping those of other epochs; None when there is none."""
        tail, head = int(self._words[RingWord.POPPED]), int(self._words[RingWord.PUSHED])
        epoch = epoch_now()  # after the indices: no setpoint below `head` is of a newer epoch and would be lost
        found: Setpoint | None = None
        while tail < head and found is None:
            slot = self._slots[tail % N_SETPOINTS]
            if int(slot["instead"]) > tail:
                tail = int(slot["instead"])
                continue
            if int(slot["epoch"]) == epoch:
                found = Setpoint(int(slot["plan_id"]), int(slot["frame"]), bool(slot["last"]), np.array(slot["q_rad"]))
            tail += 1
        self._words[RingWord.POPPED] = tail
        return found

    def drop(self) -> None:
        """Throw away every setpoint pushed so far."""
        self._words[RingWord.POPPED] = self._words[RingWord.PUSHED]


class CycleRing:
    """Records of bus cycles, which the bus process writes and any process reads.

    Args:
        words: words of shared memory.
        slots: (N_CYCLES,) slots of `cycle_dtype`.
    """

    def __init__(self, words: NDArray[np.uint64], slots: NDArray[np.void]) -> None:
        self._words, self._slots = words, slots

    # The bus process.

    def next_record(self) -> np.void:
        """The slot of the next cycle; fill it, then `publish`."""
        return self._slots[int(self._words[RingWord.CYCLES]) % N_CYCLES]

    def publish(self) -> None:
        """Make the slot visible."""
        self._words[RingWord.CYCLES] += np.uint64(1)

    # Readers.

    @property
    def count(self) -> int:
        """Cycles published so far."""
        return int(self._words[RingWord.CYCLES])

    def since(self, index: int) -> tuple[NDArray[np.void], int, int]:
        """Copies of the cycles from `index` on, the index to continue from, and how many were lost because of slow reading."""
        n = self.count
        first = max(index, n - (N_CYCLES - _UNREAD))
        rows = np.arange(first, n) % N_CYCLES
        return self._slots[rows], n, first - index
