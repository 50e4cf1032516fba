"""Memory shared between front and bus process: setpoints down, requests down, cycles up. No locks.

One file in memory, mapped by both. Each ring has one writer; indices are 64-bit words that only their owner moves, so a
reader never waits and a stuck peer never blocks the bus. Requests are words too (`daemon.shared_memory.request_words`): an e-stop
never queues behind anything, and is owed until a cycle has carried it out.
"""

from __future__ import annotations

import fcntl
import os
import tempfile
import threading
import time
from contextlib import suppress
from dataclasses import dataclass
from enum import IntEnum
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daemon.dynamixel.health import HEALTH
from daemon.shared_memory.request_words import ESTOPS, HALTS, N_WORDS, Asked, Asker, BusRequest, RequestWords

Array = NDArray[np.float64]

N_SETPOINTS = 256
N_CYCLES = 4096
_TEXT_BYTES = 4096
_MAGIC = 0x6D6D6D6404
_PREFIX = "mmmd-link-"


class BusState(IntEnum):
    """What the bus process is doing."""

    LIMP = 0
    ARMING = 1
    HOLDING = 2
    PLAYING = 3
    STOPPING = 4
    PARKING = 5
    FAULT = 6
    ESTOP = 7


class _Word(IntEnum):
    MAGIC = 0
    PUSHED = 1
    POPPED = 2
    HEARTBEAT_NS = 4
    CYCLES = 5
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
    """What was asked for cannot be: the URL of the bus names an option or a value that there is not."""


def setpoint_dtype(n_joints: int) -> np.dtype[np.void]:
    """One setpoint: which plan and frame, whether it ends the plan, and (J,) radians.

    Where `instead` is not 0 the setpoint and those after it are left out: the one of that number is next.
    """
    return np.dtype([
        ("epoch", "u8"), ("plan_id", "u8"), ("instead", "u8"), ("frame", "u4"), ("last", "u1"), ("_", "V3"),
        ("q_rad", "f8", n_joints),
    ])  # fmt: skip


def cycle_dtype(n_joints: int, n_servos: int) -> np.dtype[np.void]:
    """One bus cycle: what was wanted, what the gate let through, what was written and what was measured.

    `t_mono_ns` is when the goals were given to the ports, before the answers were waited for.
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


class BusLink:
    """Both ends of the shared memory; `create` in the front, `attach` in the bus process and in readers.

    Args:
        path: of the file.
        n_joints: of the robot.
        n_servos: of the robot.
        owner: whether to make the file, and to remove it in the end.
        asker: as whom this end asks the bus process for something.
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
        self._setpoints, self._cycles, self._text = parts[1].view(setpoints), parts[2].view(cycles), parts[3]
        self.health: NDArray[np.void] = parts[4].view(HEALTH)
        """(S,) state and counters of each servo; the bus process writes them in every cycle, anybody reads."""
        self._requests = RequestWords(parts[5].view(np.uint64))
        self._left_out: list[tuple[int, int]] = []
        self._asking = threading.Lock()
        self._known_halts: dict[BusRequest, int] = dict.fromkeys(HALTS, 0)
        if owner:
            self._words[_Word.MAGIC] = _MAGIC
            self.heartbeat()
        elif self._words[_Word.MAGIC] != _MAGIC:
            raise ValueError(f"{path}: is no shared memory of this mmmd version")

    @classmethod
    def create(cls, n_joints: int, n_servos: int | None = None) -> BusLink:
        """New shared memory, in /dev/shm where there is one; what daemons that were killed left there is removed."""
        folder = "/dev/shm" if os.access("/dev/shm", os.W_OK) else tempfile.gettempdir()
        _remove_orphans(Path(folder))
        fd, name = tempfile.mkstemp(prefix=f"{_PREFIX}{os.getpid()}-", dir=folder)
        os.close(fd)
        return cls(Path(name), n_joints, n_servos or n_joints, owner=True)

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
        """Grows with each halt that the front has asked for or knows of: setpoints of an older epoch are thrown away.

        So a halt that the front has not been told of yet voids what it pushes meanwhile as well.
        """
        return sum(self._requests.halts(Asker.FRONT).values()) + sum(self._known_halts.values())

    def know_of(self, halt: Asked) -> None:
        """The front has been told of a halt that was asked for on `ctl`, and pushes nothing of before it any more."""
        self._known_halts[halt.kind] = max(halt.number, self._known_halts[halt.kind])

    def knows_of(self, halt: Asked) -> bool:
        """Whether the front has been told of a halt."""
        return halt.number <= self._known_halts[halt.kind]

    @property
    def unknown_halts(self) -> list[Asked]:
        """Halts asked for on `ctl` of which the front has not been told."""
        halts = self._requests.halts(Asker.CTL).items()
        return [Asked(kind, number) for kind, number in halts if number > self._known_halts[kind]]

    @property
    def queued_frames(self) -> int:
        """Setpoints pushed that are still to be taken."""
        tail = int(self._words[_Word.POPPED])
        self._left_out = [(first, end) for first, end in self._left_out if end > tail]
        return int(self._words[_Word.PUSHED]) - tail - sum(end - max(first, tail) for first, end in self._left_out)

    def push(self, q_rad: Array, plan_id: int, first_frame: int, epoch: int, *, last: bool) -> int:
        """Append setpoints (N, J) as far as there is room; returns how many. `last` marks the final one of the plan."""
        head = int(self._words[_Word.PUSHED])
        n = min(len(q_rad), N_SETPOINTS - (head - int(self._words[_Word.POPPED])))
        for i in range(n):
            slot = self._setpoints[(head + i) % N_SETPOINTS]
            slot["epoch"], slot["plan_id"], slot["frame"], slot["instead"] = epoch, plan_id, first_frame + i, 0
            slot["last"] = last and i == len(q_rad) - 1
            slot["q_rad"] = q_rad[i]
        self._words[_Word.PUSHED] = head + n
        return n

    def take_back(self, n: int) -> int:
        """Leave out the last `n` setpoints pushed; how many of them the bus process had come to already.

        None may be left out before. Each tells where to go on, the last first: wherever the bus process is just then, it
        leaves out what it has not come to.
        """
        head = int(self._words[_Word.PUSHED])
        for index in range(head - 1, head - n - 1, -1):
            self._setpoints[index % N_SETPOINTS]["instead"] = head  # one aligned word: there or not
        first = max(head - n, int(self._words[_Word.POPPED]))
        if first < head:
            self._left_out.append((first, head))
        return min(n, first - (head - n))

    def new_number(self) -> int:
        """The number of a request that is asked for now."""
        return self._requests.next_number(self._asker, time.monotonic_ns())

    def request(self, kind: BusRequest, *, stay_s: float = 0.0, number: int | None = None) -> Asked:
        """Ask the bus process for something; a stop of any kind also voids every setpoint pushed before.

        Args:
            kind: what.
            stay_s: after so long in the park pose a `PARK` goes limp.
            number: of a request that was asked for before now; None takes a new one.
        """
        with self._asking:  # threads of one process
            if kind is BusRequest.PARK:
                self._words[_Word.PARK_STAY_MS] = round(1000 * stay_s)
            return self._requests.ask(self._asker, kind, self.new_number() if number is None else number)

    def carried_out(self, asked: Asked) -> bool:
        """Whether a bus cycle has carried out what this end has asked for."""
        return self._requests.carried_out(self._asker, asked)

    def overtaken(self, asked: Asked) -> bool:
        """Whether a halt that came after it has made a request void."""
        return self._requests.overtaken(asked)

    def owes(self, *kinds: BusRequest) -> bool:
        """Whether something of these kinds was asked for that no bus cycle has carried out."""
        return any(self._requests.owes(kind) for kind in kinds)

    def heartbeat(self) -> None:
        """Say that the front is alive."""
        self._words[_Word.HEARTBEAT_NS] = time.monotonic_ns()

    def set_estop_holds(self, holds: bool) -> None:
        """Whether an e-stop brakes and holds."""
        self._words[_Word.ESTOP_HOLDS] = int(holds)

    def show_robot_state(self, index: int) -> None:
        """Place of the robot's state in `daemon.state.machine.RobotState`, for the process that serves `ctl`."""
        self._words[_Word.ROBOT_STATE] = index

    @property
    def bus_lives(self) -> bool:
        """Whether a bus process has these requests to carry out, be it frozen."""
        return _is_held(self.path)

    # The side of the process that serves `ctl`.

    def ctl_beats(self) -> None:
        """Say that somebody takes e-stops."""
        self._words[_Word.CTL_BEAT_NS] = time.monotonic_ns()

    @property
    def ctl_beat(self) -> int:
        """Changes as long as somebody takes e-stops; 0 before."""
        return int(self._words[_Word.CTL_BEAT_NS])

    @property
    def estop_kind(self) -> BusRequest:
        """What an e-stop asks for, as the daemon is set."""
        return BusRequest.ESTOP_HOLD if self._words[_Word.ESTOP_HOLDS] else BusRequest.ESTOP

    @property
    def robot_state(self) -> int:
        """As the front shows it."""
        return int(self._words[_Word.ROBOT_STATE])

    @property
    def readiness(self) -> Readiness:
        """Whether the bus process has its port."""
        return Readiness(int(self._words[_Word.READY]))

    @property
    def text(self) -> str:
        """Why it failed or is in fault."""
        return bytes(self._text[: int(self._words[_Word.TEXT_LENGTH])]).decode("utf-8", "replace")

    @property
    def has_realtime(self) -> tuple[bool, bool]:
        """Whether the bus process got FIFO priority and locked memory."""
        return bool(self._words[_Word.REALTIME]), bool(self._words[_Word.MEMORY_LOCKED])

    @property
    def derating(self) -> tuple[float, int, int]:
        """Share of full speed, its cause (`daemon.control.derating.DeratedBy`), and the id of the servo that needs it most."""
        words = (_Word.SPEED_PERMILLE, _Word.DERATED_BY, _Word.DERATED_SERVO)
        permille, by, servo_id = (int(self._words[word]) for word in words)
        return (permille / 1000 if permille else 1.0), by, servo_id

    # Bus process's side.

    def hold(self) -> None:
        """Show, to the end of this process, that there is one to carry out requests."""
        self._held = os.open(self.path, os.O_RDONLY | os.O_CLOEXEC)
        fcntl.flock(self._held, fcntl.LOCK_EX)

    @property
    def park_stay_s(self) -> float:
        """How long the robot stays in the park pose with torque, as the newest `PARK` says."""
        return int(self._words[_Word.PARK_STAY_MS]) / 1000

    def take_setpoint(self) -> Setpoint | None:
        """The next setpoint of the current epoch; None when there is none."""
        tail, head, epoch = int(self._words[_Word.POPPED]), int(self._words[_Word.PUSHED]), self._halts
        found: Setpoint | None = None
        while tail < head and found is None:
            slot = self._setpoints[tail % N_SETPOINTS]
            if int(slot["instead"]) > tail:
                tail = int(slot["instead"])
                continue
            if int(slot["epoch"]) == epoch:
                found = Setpoint(int(slot["plan_id"]), int(slot["frame"]), bool(slot["last"]), np.array(slot["q_rad"]))
            tail += 1
        self._words[_Word.POPPED] = tail
        return found

    def drop_queued(self) -> None:
        """Throw away every setpoint pushed so far."""
        self._words[_Word.POPPED] = self._words[_Word.PUSHED]

    @property
    def cut_asked(self) -> bool:
        """Whether an e-stop that cuts torque waits to be taken."""
        return self._requests.waits(BusRequest.ESTOP)

    @property
    def estop_asked(self) -> bool:
        """Whether an e-stop of either kind waits to be taken."""
        return any(self._requests.waits(kind) for kind in ESTOPS)

    def take_request(self) -> Asked | None:
        """The oldest request that is neither taken nor void; owed to who asked until it is `done`."""
        return self._requests.take()

    def done(self, taken: Asked) -> None:
        """A cycle has carried out a request."""
        self._requests.done(taken)

    @property
    def _halts(self) -> int:
        """The epoch as it is, whoever knows of it."""
        return sum(sum(self._requests.halts(asker).values()) for asker in Asker)

    @property
    def heartbeat_age_s(self) -> float:
        """Seconds since the front's last heartbeat."""
        return (time.monotonic_ns() - int(self._words[_Word.HEARTBEAT_NS])) * 1e-9

    def set_ready(self, readiness: Readiness, text: str = "") -> None:
        """Tell the front how the start went."""
        self.set_text(text)
        self._words[_Word.READY] = readiness

    def set_text(self, text: str) -> None:
        """What went wrong, for `text`."""
        data = np.frombuffer(text.encode("utf-8")[:_TEXT_BYTES], np.uint8)
        self._text[: len(data)] = data
        self._words[_Word.TEXT_LENGTH] = len(data)

    def set_realtime(self, fifo: bool, locked: bool) -> None:
        """Tell the front which rights the bus process got."""
        self._words[_Word.REALTIME], self._words[_Word.MEMORY_LOCKED] = int(fifo), int(locked)

    def set_derating(self, share: float, by: int, servo_id: int) -> None:
        """Tell the front how fast the robot may move, and why."""
        self._words[_Word.SPEED_PERMILLE] = max(1, round(1000 * share))
        self._words[_Word.DERATED_BY], self._words[_Word.DERATED_SERVO] = by, servo_id

    def next_record(self) -> np.void:
        """The slot of the next cycle; fill it, then `publish`."""
        return self._cycles[int(self._words[_Word.CYCLES]) % N_CYCLES]

    def publish(self) -> None:
        """Make the slot visible."""
        self._words[_Word.CYCLES] += np.uint64(1)

    # Readers.

    @property
    def n_cycles(self) -> int:
        """Cycles published so far."""
        return int(self._words[_Word.CYCLES])

    def cycles_since(self, index: int) -> tuple[NDArray[np.void], int, int]:
        """Copies of the cycles from `index` on, the index to go on from, and how many were lost to slow reading."""
        n = self.n_cycles
        first = max(index, n - (N_CYCLES - 64))
        rows = np.arange(first, n) % N_CYCLES
        return self._cycles[rows], n, first - index


def _is_held(path: Path) -> bool:
    """Whether a bus process holds the lock of a memory's file, see `BusLink.hold`."""
    try:
        fd = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
    except OSError:
        return False
    try:
        fcntl.flock(fd, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    finally:
        os.close(fd)
    return False


def _remove_orphans(folder: Path) -> None:
    """Remove shared memory whose owner, named in the file name, is no more."""
    for path in folder.glob(f"{_PREFIX}*-*"):
        owner = path.name.removeprefix(_PREFIX).partition("-")[0]
        if not owner.isdigit():
            continue
        try:
            os.kill(int(owner), 0)
        except ProcessLookupError:
            if _is_held(path):  # its bus process still has the robot, and `ctl` looks for that by this file
                continue
            with suppress(OSError):  # another user's
                path.unlink()
        except (PermissionError, OverflowError):
            continue
