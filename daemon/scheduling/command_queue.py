"""The queue of commands that are being generated or wait for their turn or time. The newest `now` wins over older ones.

Commands take effect in this order: a `now` and an `after` by their arrival, an `at` by the time for which it asks. A command ends
those before it at the moment in which it is accepted (an `at`: in which its time has come), never by its request alone: a
command that is refused ends no other. While a `now` that may soon win is being generated, an older command does not begin to move
(`Scheduler`), but waits no longer than generation usually takes.
"""

from __future__ import annotations

import asyncio
import time
from collections import OrderedDict
from dataclasses import dataclass, field

from daemon.host.clock import clock_id
from daemon.state.ledger import Entry
from daemon.wire.requests import Request

MOST_WAITING = 64
SHADOW_S = 0.1
"""Seconds after a stop in which a command that comes counts as sent before the stop, unless its sender's clock shows otherwise."""
CLOCKS_KEPT = 64
"""Number of other machines' clocks for which the newest halt is remembered."""
LONGEST_WAY_S = 10.0
"""Seconds by which a message of another machine may arrive later than one sent after it: TCP sends lost packets again. Stamps
that would need more than that to be true count as wrong."""


@dataclass(eq=False)
class QueuedCommand:
    """One command in the queue.

    Attributes:
        entry: its entry in the ledger.
        epoch: epoch of the link at its arrival; a stop makes it old.
        task: task that generates and plays it.
        cancelled_by: cause of its end; empty before.
        committing: whether it is now taking over, which is not interrupted.
        turn: whether its turn or its time has come.
        overtook: entries of the commands that it ends, which are told so once it is accepted.
    """

    entry: Entry
    epoch: int
    task: asyncio.Task[None] | None = None
    cancelled_by: str = ""
    committing: bool = False
    turn: bool = False
    overtook: list[Entry] = field(default_factory=list[Entry])

    @property
    def when(self) -> str:
        """When the command takes effect: "now", "after" or "at"."""
        return self.entry.request.when

    @property
    def undecided(self) -> bool:
        """Whether it is a `now` that is neither accepted nor refused yet."""
        return self.when == "now" and not (self.turn or self.entry.accepted)


@dataclass(frozen=True)
class _Stamp:
    """A message of another machine.

    Attributes:
        sent_s: time of sending on that machine's clock, seconds.
        came_s: time of arrival on this machine's clock, seconds.
    """

    sent_s: float
    came_s: float

    def sent_before(self, other: _Stamp) -> bool:
        """Whether this message was sent no later than `other`, which came before it, and was no longer on its way than possible."""
        return (
            self.sent_s <= other.sent_s and (other.sent_s - self.sent_s) + (self.came_s - other.came_s) <= LONGEST_WAY_S
        )


class StopOrdering:
    """Knows when a person last stopped, parked or cut torque, and whether a command was sent before that.

    Times are compared only on one clock: a command from this machine with the arrival of the halt here, a command from another
    machine with the sending of a halt from that machine.
    """

    def __init__(self, clock: str | None = None) -> None:
        self._clock = clock_id() if clock is None else clock
        self._stamps: OrderedDict[str, _Stamp] = OrderedDict()
        self._from = ""
        self._n_given = self._n_served = 0
        self.at_s, self.by = float("-inf"), ""

    def note(self, by: str, request: Request | None = None, *, at_s: float | None = None) -> None:
        """Note a halt, with the request that may say when it was sent; it came at `at_s`, None for now."""
        sent_s, clock = (None, None) if request is None else (request.t_mono, request.clock)
        self._n_given += 1
        self.at_s, self.by, self._from = time.monotonic() if at_s is None else at_s, by, clock or ""
        if clock and clock != self._clock and sent_s is not None:
            stamp, before = _Stamp(sent_s, self.at_s), self._stamps.pop(clock, None)
            self._stamps[clock] = before if before is not None and stamp.sent_before(before) else stamp
            if len(self._stamps) > CLOCKS_KEPT:
                self._stamps.popitem(last=False)

    def served(self) -> None:
        """Note that all commands that had arrived before a halt have ended. The event loop calls this once for each halt."""
        self._n_served += 1

    def overtook(self, entry: Entry) -> bool:
        """Whether a command that arrives now was sent before the halt.

        A command that cannot show its time of sending counts as sent before while the halt is being served, which takes a while
        behind many requests, and `SHADOW_S` longer.
        """
        after = self._sent_after(entry)
        if after is not None:
            return not after
        return self._n_served < self._n_given or time.monotonic() - self.at_s < SHADOW_S

    def spares(self, entry: Entry) -> bool:
        """Whether a command that came before the halt was served was surely sent after it."""
        return self._sent_after(entry) is True

    def _sent_after(self, entry: Entry) -> bool | None:
        """Whether the command was sent after the newest halt; None when no clock tells."""
        sent_s, clock = entry.request.t_mono, entry.request.clock
        if sent_s is None or not clock:
            return None
        if clock == self._clock:
            return self.at_s < sent_s if sent_s <= time.monotonic() else None
        halt = self._stamps.get(clock)
        if halt is None:
            return None
        stamp = _Stamp(sent_s, entry.t_received_ns * 1e-9)
        if sent_s <= halt.sent_s:
            return False if stamp.sent_before(halt) else None
        if clock != self._from:  # the newest halt came from elsewhere
            return None
        return True if stamp.came_s > halt.came_s or halt.sent_before(stamp) else None


class CommandQueue:
    """The commands that are not played yet, in order of arrival."""

    def __init__(self) -> None:
        self._all: list[QueuedCommand] = []

    def __iter__(self):
        return iter(list(self._all))

    def __len__(self) -> int:
        return len(self._all)

    def __contains__(self, pending: object) -> bool:
        return pending in self._all

    @property
    def full(self) -> bool:
        """Whether the queue takes no more commands."""
        return len(self._all) >= MOST_WAITING

    def add(self, pending: QueuedCommand) -> None:
        """Append a command that has just come."""
        self._all.append(pending)

    def remove(self, pending: QueuedCommand) -> None:
        """Remove a command that is played or has ended."""
        if pending in self._all:
            self._all.remove(pending)

    def withdraw(self, pending: QueuedCommand, by: str) -> None:
        """Remove a command that `by` ends, and its task with it."""
        pending.cancelled_by = by
        self.remove(pending)
        if not pending.committing and pending.task is not None:
            pending.task.cancel()

    def renew(self, pending: QueuedCommand) -> None:
        """Move a command whose time has come behind all others: it is the newest."""
        self._all.remove(pending)
        self._all.append(pending)

    def overtaken_by(self, newest: QueuedCommand) -> list[QueuedCommand]:
        """Commands that end because `newest` takes over: all before it, except an `at` whose time has not come."""
        before = self._all[: self._all.index(newest)]
        return [p for p in before if not p.committing and not (p.when == "at" and not p.turn)]

    def may_be_overtaken(self, pending: QueuedCommand) -> bool:
        """Whether a newer `now` is being generated that is neither accepted nor refused yet."""
        newer = self._all[self._all.index(pending) + 1 :]
        return any(p.undecided for p in newer)

    @property
    def oldest_undecided(self) -> QueuedCommand | None:
        """The first `now` that is still being generated; None without one."""
        return next((p for p in self._all if p.undecided), None)

    def is_next(self, pending: QueuedCommand) -> bool:
        """Whether no command before this one waits for its turn."""
        for p in self._all:
            if p is pending:
                return True
            if p.when != "at" or p.turn:
                return False
        return True

    @property
    def someone_is_about(self) -> bool:
        """Whether a `now` is in the queue."""
        return any(p.when == "now" for p in self._all)

    @property
    def someone_waits_after(self) -> bool:
        """Whether a command waits for the running motion to end."""
        return any(p.when == "after" for p in self._all)
