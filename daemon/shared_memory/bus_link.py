"""Memory shared between front and bus process: setpoints down, requests down, cycles up. No locks.

One file in memory (`memory_files.py`), mapped by both, with two rings of one writer each (`rings.py`). Requests are words
(`request_words.py`): an e-stop never queues behind another request, and stays pending until a cycle has carried it out.
"""

from __future__ import annotations

import threading
import time
from enum import IntEnum
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daemon.dynamixel.health import HEALTH
from daemon.shared_memory.memory_files import create_file, hold, is_held
from daemon.shared_memory.request_words import ESTOPS, N_WORDS, Asked, Asker, BusRequest, Epochs, RequestWords
from daemon.shared_memory.rings import (
    N_CYCLES,
    N_SETPOINTS,
    CycleRing,
    Setpoint,
    SetpointRing,
    cycle_dtype,
    setpoint_dtype,
)

_TEXT_BYTES = 4096
_MAGIC = 0x6D6D6D6404


class BusState(IntEnum):
    """States of the bus process."""

    LIMP = 0
    ARMING = 1
    HOLDING = 2
    PLAYING = 3
    STOPPING = 4
    PARKING = 5
    FAULT = 6
    ESTOP = 7


class _Word(IntEnum):
    """Places of single values among the words of shared memory; those of the rings are in `RingWord`."""

    MAGIC = 0
    HEARTBEAT_NS = 4
    READY = 6
    TEXT_LENGTH = 7
    REALTIME = 24
    MEMORY_LOCKED = 25
    SPEED_PERMILLE = 26
    DERATED_BY = 27
    DERATED_SERVO = 28
    PARK_STAY_MS = 29
    CTL_BEAT_NS = 30
    ROBOT_STATE = 31
    ESTOP_HOLDS = 32


class Readiness(IntEnum):
    """Whether the bus process has its port."""

    STARTING = 0
    READY = 1
    FAILED = 2
    REFUSED = 3
    """The bus URL names an unknown option or value."""


class BusLink:
    """Both ends of the shared memory; `create` in the front, `attach` in the bus process and in readers.

    Attributes:
        setpoints: the ring from the front to the bus process.
        cycles: the ring from the bus process to its readers.
        epochs: the halts that void setpoints.

    Args:
        path: path of the file.
        n_joints: number of the robot's joints.
        n_servos: number of the robot's servos.
        owner: whether to create the file, and to remove it in the end.
        asker: the process for which this end sends requests to the bus process.
    """

    def __init__(self, path: Path, n_joints: int, n_servos: int, *, owner: bool, asker: Asker = Asker.FRONT) -> None:
        self.path, self.n_joints, self._owner, self._asker = path, n_joints, owner, asker
        setpoints, cycles = setpoint_dtype(n_joints), cycle_dtype(n_joints, n_servos)
        sizes = [
            64 * 8, N_SETPOINTS * setpoints.itemsize, N_CYCLES * cycles.itemsize, _TEXT_BYTES, n_servos * HEALTH.itemsize,
            N_WORDS * 8,
        ]  # fmt: skip
        starts = np.concatenate([[0], np.cumsum(sizes)])
        if owner:
            with path.open("wb") as f:
                f.truncate(int(starts[-1]))
        memory = np.memmap(path, np.uint8, "r+").view(np.ndarray)  # indexing a memmap is several times slower
        if len(memory) != starts[-1]:
            raise ValueError(f"{path}: {len(memory)} bytes; expected {starts[-1]} for {n_joints} joints")
        parts = [memory[a:b] for a, b in pairwise(starts)]
        self._words = parts[0].view(np.uint64)
        self.setpoints = SetpointRing(self._words, parts[1].view(setpoints))
        self.cycles = CycleRing(self._words, parts[2].view(cycles))
        self._text = parts[3]
        self.health: NDArray[np.void] = parts[4].view(HEALTH)
        """(S,) state and counters of each servo; the bus process writes them in every cycle, any process may read them."""
        self._requests = RequestWords(parts[5].view(np.uint64))
        self._asking = threading.Lock()
        self.epochs = Epochs(self._requests)
        if owner:
            self._words[_Word.MAGIC] = _MAGIC
            self.heartbeat()
        elif self._words[_Word.MAGIC] != _MAGIC:
            raise ValueError(f"{path}: is no shared memory of this mmmd version")

    @classmethod
    def create(cls, n_joints: int, n_servos: int | None = None) -> BusLink:
        """New shared memory in a file of `create_file`."""
        return cls(create_file(), n_joints, n_servos or n_joints, owner=True)

    @classmethod
    def attach(cls, path: Path, n_joints: int, n_servos: int | None = None, *, asker: Asker = Asker.FRONT) -> BusLink:
        """The memory that another process created."""
        return cls(path, n_joints, n_servos or n_joints, owner=False, asker=asker)

    def close(self) -> None:
        """Remove the memory's file; mappings end with their processes."""
        if self._owner:
            self.path.unlink(missing_ok=True)

    # Front's side.

    @property
    def epoch(self) -> int:
        """Epoch of the setpoints that the front pushes now."""
        return self.epochs.of_front

    def new_number(self) -> int:
        """A number for a request that is made now."""
        return self._requests.next_number(self._asker, time.monotonic_ns())

    def request(self, kind: BusRequest, *, stay_s: float = 0.0, number: int | None = None) -> Asked:
        """Send a request to the bus process; a halt of any kind also voids every setpoint pushed before.

        Args:
            kind: the request.
            stay_s: seconds in the park pose after which `PARK` makes the robot limp.
            number: number of a request that was made earlier; None takes a new one.
        """
        with self._asking:  # threads of one process
            if kind is BusRequest.PARK:
                self._words[_Word.PARK_STAY_MS] = round(1000 * stay_s)
            return self._requests.ask(self._asker, kind, self.new_number() if number is None else number)

    def carried_out(self, asked: Asked) -> bool:
        """Whether a bus cycle has carried out this end's request."""
        return self._requests.carried_out(self._asker, asked)

    def overtaken(self, asked: Asked) -> bool:
        """Whether a later halt has made a request void."""
        return self._requests.overtaken(asked)

    def owes(self, *kinds: BusRequest) -> bool:
        """Whether a request of these kinds is pending: made, and carried out by no bus cycle."""
        return any(self._requests.owes(kind) for kind in kinds)

    def heartbeat(self) -> None:
        """Record the time of the front's heartbeat."""
        self._words[_Word.HEARTBEAT_NS] = time.monotonic_ns()

    def set_estop_holds(self, holds: bool) -> None:
        """Set whether an e-stop brakes and holds instead of cutting torque."""
        self._words[_Word.ESTOP_HOLDS] = int(holds)

    def show_robot_state(self, index: int) -> None:
        """Publish the robot's state, as its index in `daemon.state.machine.RobotState`, for the ctl process."""
        self._words[_Word.ROBOT_STATE] = index

    @property
    def bus_lives(self) -> bool:
        """Whether a bus process exists that can carry out requests, even a frozen one."""
        return is_held(self.path)

    # The ctl process's side.

    def ctl_beats(self) -> None:
        """Record the time of the ctl process's heartbeat: e-stops can be received."""
        self._words[_Word.CTL_BEAT_NS] = time.monotonic_ns()

    @property
    def ctl_beat(self) -> int:
        """Monotonic time of the ctl process's last heartbeat, nanoseconds; 0 before the first."""
        return int(self._words[_Word.CTL_BEAT_NS])

    @property
    def estop_kind(self) -> BusRequest:
        """The request that an e-stop stands for, by the daemon's setting `estop`."""
        return BusRequest.ESTOP_HOLD if self._words[_Word.ESTOP_HOLDS] else BusRequest.ESTOP

    @property
    def robot_state(self) -> int:
        """Index of the robot's state, as published by `show_robot_state`."""
        return int(self._words[_Word.ROBOT_STATE])

    @property
    def readiness(self) -> Readiness:
        """Whether the bus process has its port."""
        return Readiness(int(self._words[_Word.READY]))

    @property
    def text(self) -> str:
        """Why the bus process failed to start, or is in fault."""
        return bytes(self._text[: int(self._words[_Word.TEXT_LENGTH])]).decode("utf-8", "replace")

    @property
    def has_realtime(self) -> tuple[bool, bool]:
        """Whether the bus process got FIFO priority and locked memory."""
        return bool(self._words[_Word.REALTIME]), bool(self._words[_Word.MEMORY_LOCKED])

    @property
    def derating(self) -> tuple[float, int, int]:
        """Share of full speed, its cause (`daemon.control.derating.DeratedBy`), and the id of the servo with the least margin."""
        words = (_Word.SPEED_PERMILLE, _Word.DERATED_BY, _Word.DERATED_SERVO)
        permille, by, servo_id = (int(self._words[word]) for word in words)
        return (permille / 1000 if permille else 1.0), by, servo_id

    # Bus process's side.

    def hold(self) -> None:
        """Mark, to the end of this process, that a bus process exists to carry out requests."""
        self._held = hold(self.path)

    @property
    def park_stay_s(self) -> float:
        """Seconds that the robot stays in the park pose with torque, set by the newest `PARK`."""
        return int(self._words[_Word.PARK_STAY_MS]) / 1000

    def take_setpoint(self) -> Setpoint | None:
        """The next setpoint of the current epoch; None when there is none."""
        return self.setpoints.take(self.epochs.now)

    @property
    def cut_asked(self) -> bool:
        """Whether an e-stop that cuts torque has not been taken yet."""
        return self._requests.waits(BusRequest.ESTOP)

    @property
    def estop_asked(self) -> bool:
        """Whether an e-stop of either kind has not been taken yet."""
        return any(self._requests.waits(kind) for kind in ESTOPS)

    def take_request(self) -> Asked | None:
        """The oldest request that is neither taken nor void; it stays pending until `done`. None without one."""
        return self._requests.take()

    def done(self, taken: Asked) -> None:
        """Record that a cycle has carried out a request."""
        self._requests.done(taken)

    @property
    def heartbeat_age_s(self) -> float:
        """Seconds since the front's last heartbeat."""
        return (time.monotonic_ns() - int(self._words[_Word.HEARTBEAT_NS])) * 1e-9

    def set_ready(self, readiness: Readiness, text: str = "") -> None:
        """Report the result of the start to the front."""
        self.set_text(text)
        self._words[_Word.READY] = readiness

    def set_text(self, text: str) -> None:
        """Set the reason of a failure or fault, see `text`."""
        data = np.frombuffer(text.encode("utf-8")[:_TEXT_BYTES], np.uint8)
        self._text[: len(data)] = data
        self._words[_Word.TEXT_LENGTH] = len(data)

    def set_realtime(self, fifo: bool, locked: bool) -> None:
        """Report to the front whether the bus process got FIFO priority and locked memory."""
        self._words[_Word.REALTIME], self._words[_Word.MEMORY_LOCKED] = int(fifo), int(locked)

    def set_derating(self, share: float, by: int, servo_id: int) -> None:
        """Report the derating to the front: share of full speed, its cause, and the servo concerned."""
        self._words[_Word.SPEED_PERMILLE] = max(1, round(1000 * share))
        self._words[_Word.DERATED_BY], self._words[_Word.DERATED_SERVO] = by, servo_id
