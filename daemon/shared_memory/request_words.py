"""Requests to the bus process as words of shared memory: each stays pending until a bus cycle has carried it out.

Two processes make requests: the ctl process and the front. Each kind of request has two words for each of them: the number
of the newest request made, which only its asker writes and only raises, and the number of the newest one carried out, which only
the bus process writes. A request is pending while the two differ, so it outlives the bus process that it was meant for,
and no writer can undo what another has written. Numbers are the monotonic time of asking: they put the requests
of both askers in one order, in which a halt voids what was asked before it, carried out or not. Sans-I/O.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

Words = NDArray[np.uint64]


class BusRequest(IntEnum):
    """Kinds of requests to the bus process; the value is the column of their words."""

    ARM = 0
    PARK = 1
    STOP = 2
    ESTOP = 3
    RESET = 4
    SHUTDOWN = 5
    TORQUE_OFF = 6
    ESTOP_HOLD = 7
    FAULT = 8
    """The front reported a fault while the bus process was silent; the bus process latches it when it is back."""


class Asker(IntEnum):
    """Processes that make requests; the value is the row of their words."""

    CTL = 0
    FRONT = 1


ESTOPS = (BusRequest.ESTOP, BusRequest.ESTOP_HOLD)
HALTS = (BusRequest.STOP, BusRequest.PARK, BusRequest.TORQUE_OFF, *ESTOPS)
"""Requests that end the running motion: every setpoint pushed before is void."""
LASTING = (BusRequest.STOP, BusRequest.TORQUE_OFF, *ESTOPS, BusRequest.FAULT, BusRequest.SHUTDOWN)
"""Requests that a starting bus process still has to carry out. Others would move the robot, or unlatch it, long after they were
made."""

_MOVES = (BusRequest.ARM, BusRequest.PARK)
_VOIDS: dict[BusRequest, tuple[BusRequest, ...]] = {
    BusRequest.ESTOP: tuple(k for k in BusRequest if k not in (BusRequest.SHUTDOWN, BusRequest.ESTOP)),
    BusRequest.ESTOP_HOLD: tuple(k for k in BusRequest if k not in (BusRequest.SHUTDOWN, *ESTOPS)),
    BusRequest.FAULT: (*_MOVES, BusRequest.RESET),
    BusRequest.STOP: _MOVES,
}
"""Earlier requests that each halt makes void, so that none of them undoes the halt when it is read afterwards."""

N_WORDS = 2 * len(Asker) * len(BusRequest)
_LASTS = np.array([kind in LASTING for kind in BusRequest])


@dataclass(frozen=True)
class Asked:
    """One request.

    Attributes:
        kind: kind of the request.
        number: twice the monotonic time of the request in nanoseconds, plus the asker, so that no two are equal.
    """

    kind: BusRequest
    number: int


class RequestWords:
    """Reads and writes the words, for both ends.

    Args:
        words: (N_WORDS,) in shared memory, zeros at first.
    """

    def __init__(self, words: Words) -> None:
        parts = words.reshape(2, len(Asker), len(BusRequest))
        self._asked, self._done = parts[0], parts[1]
        self._last_number = 0
        self._taken: Words = np.where(_LASTS, self._done, self._asked)

    # The askers' side.

    def next_number(self, asker: Asker, now_ns: int) -> int:
        """A number above all that `asker` has used."""
        last = max(int(self._asked[asker].max()), self._last_number)
        self._last_number = max(2 * now_ns, 2 * (last // 2 + 1)) + asker
        return self._last_number

    def ask(self, asker: Asker, kind: BusRequest, number: int) -> Asked:
        """Make a request; a newer request of its kind with a higher number covers it."""
        self._asked[asker, kind] = max(number, int(self._asked[asker, kind]))
        return Asked(kind, number)

    def carried_out(self, asker: Asker, asked: Asked) -> bool:
        """Whether a bus cycle has carried out a request, or a later one of its kind."""
        return int(self._done[asker, asked.kind]) >= asked.number

    def overtaken(self, asked: Asked) -> bool:
        """Whether a later halt has made a request void."""
        return any(self._newest(halt) > asked.number for halt, void in _VOIDS.items() if asked.kind in void)

    def halts(self, asker: Asker) -> dict[BusRequest, int]:
        """The newest number of each halt that `asker` has requested."""
        return {kind: int(self._asked[asker, kind]) for kind in HALTS}

    # The bus process's side.

    def owes(self, kind: BusRequest) -> bool:
        """Whether a request of a kind is pending: no bus cycle has carried out the newest."""
        return bool((self._asked[:, kind] != self._done[:, kind]).any())

    def waits(self, kind: BusRequest) -> bool:
        """Whether this process has not taken the newest request of a kind."""
        return bool((self._asked[:, kind] != self._taken[:, kind]).any())

    def take(self) -> Asked | None:
        """The oldest request that this process has not taken and that is not void; None when there is none.

        The request stays pending until `done`: should this process end before, the next one takes it again.
        """
        waiting = np.argwhere(self._asked != self._taken)
        asked = sorted((int(self._asked[asker, kind]), int(asker), BusRequest(int(kind))) for asker, kind in waiting)
        for number, asker, kind in asked:
            self._taken[asker, kind] = number
            taken = Asked(kind, number)
            if self.overtaken(taken):
                self._done[asker, kind] = max(number, int(self._done[asker, kind]))
            elif not any(k is kind for n, _, k in asked if n > number):  # the newest of a kind stands for all
                return taken
        return None

    def done(self, taken: Asked) -> None:
        """Record that a cycle has carried out `taken`, and with it all earlier requests of its kind."""
        for asker in Asker:
            asked = min(int(self._asked[asker, taken.kind]), taken.number)
            self._done[asker, taken.kind] = max(asked, int(self._done[asker, taken.kind]))

    def _newest(self, kind: BusRequest) -> int:
        return int(self._asked[:, kind].max())


class Epochs:
    """Epochs of setpoints: each halt begins one, and setpoints of an older epoch are thrown away.

    The front pushes setpoints of the epoch that it knows. A halt requested on `ctl` therefore also voids setpoints that the front
    pushes before it knows of the halt.
    """

    def __init__(self, requests: RequestWords) -> None:
        self._requests = requests
        self._known: dict[BusRequest, int] = dict.fromkeys(HALTS, 0)

    def now(self) -> int:
        """The epoch after all halts, whether or not the front knows of them."""
        return sum(sum(self._requests.halts(asker).values()) for asker in Asker)

    @property
    def of_front(self) -> int:
        """The epoch after the halts that the front has requested or knows of."""
        return sum(self._requests.halts(Asker.FRONT).values()) + sum(self._known.values())

    def know_of(self, halt: Asked) -> None:
        """Record that the front knows of a halt requested on `ctl`, and pushes no setpoints of an earlier epoch any more."""
        self._known[halt.kind] = max(halt.number, self._known[halt.kind])

    def knows_of(self, halt: Asked) -> bool:
        """Whether the front knows of a halt."""
        return halt.number <= self._known[halt.kind]

    @property
    def unknown_halts(self) -> list[Asked]:
        """Halts requested on `ctl` that the front has not been told about yet."""
        halts = self._requests.halts(Asker.CTL).items()
        return [Asked(kind, number) for kind, number in halts if number > self._known[kind]]
