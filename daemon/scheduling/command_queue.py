"""Commands on their way: being made, waiting for their turn or their time. The newest `now` wins over older ones.

The order of commands is that in which they are to take effect: a `now` and an `after` from when they came, an `at` from
when its time has come. A command ends those before it in that moment in which it is accepted (an `at`: in which its time
has come), never by being asked alone: one that is refused ends nothing but itself. As long as a `now` is being made that
may be about to win, an older one does not begin to move (`Scheduler`), but only so long as that usually takes.
"""

from __future__ import annotations

import asyncio
import time
from collections import OrderedDict
from dataclasses import dataclass

from daemon.host.clock import clock_id
from daemon.state.ledger import Entry
from daemon.wire.requests import Request

MOST_WAITING = 64
SHADOW_S = 0.1
"""Seconds after a stop in which a command that comes counts as sent before the stop, unless its sender's clock shows otherwise."""
CLOCKS_KEPT = 64
"""Number of other machines' clocks for which the newest halt is remembered."""
LONGEST_WAY_S = 10.0
"""Seconds by which a message of another machine may come later than one that it sent after it: TCP sends lost packets anew.
Stamps that would need more than that to be true are taken for wrong."""


@dataclass(eq=False)
class QueuedCommand:
    """One command on its way.

    Attributes:
        entry: of the ledger.
        epoch: of the link when it came; a stop makes it old.
        task: what makes and plays it.
        cancelled_by: what ended it, empty while it lives.
        committing: whether it is just taking over, which is not interrupted half way.
        turn: whether its turn or time has come.
    """

    entry: Entry
    epoch: int
    task: asyncio.Task[None] | None = None
    cancelled_by: str = ""
    committing: bool = False
    turn: bool = False

    @property
    def when(self) -> str:
        """now, after or at."""
        return self.entry.request.when

    @property
    def undecided(self) -> bool:
        """Whether it is a `now` of which is not known yet whether it is accepted or refused."""
        return self.when == "now" and not (self.turn or self.entry.accepted)


@dataclass(frozen=True)
class _Stamp:
    """A message of another machine.

    Attributes:
        sent_s: when it was sent, on that machine's clock.
        came_s: when it came, on ours.
    """

    sent_s: float
    came_s: float

    def sent_before(self, other: _Stamp) -> bool:
        """Whether it was sent before (or with) one that came before it, and no longer on its way than messages are."""
        return (
            self.sent_s <= other.sent_s and (other.sent_s - self.sent_s) + (self.came_s - other.came_s) <= LONGEST_WAY_S
        )


class StopOrdering:
    """When a person last stopped, parked or cut torque, and what that means for a command.

    Times are compared only where they are of one clock: what was sent from this machine against when the halt came here,
    what was sent from another against when a halt was sent from there.
    """

    def __init__(self, clock: str | None = None) -> None:
        self._clock = clock_id() if clock is None else clock
        self._stamps: OrderedDict[str, _Stamp] = OrderedDict()
        self._from = ""
        self._n_given = self._n_served = 0
        self.at_s, self.by = float("-inf"), ""

    def note(self, by: str, request: Request | None = None, *, at_s: float | None = None) -> None:
        """A halt was given, by a request that may say when it was sent; it came at `at_s`, now where that is None."""
        sent_s, clock = (None, None) if request is None else (request.t_mono, request.clock)
        self._n_given += 1
        self.at_s, self.by, self._from = time.monotonic() if at_s is None else at_s, by, clock or ""
        if clock and clock != self._clock and sent_s is not None:
            stamp, before = _Stamp(sent_s, self.at_s), self._stamps.pop(clock, None)
            self._stamps[clock] = before if before is not None and stamp.sent_before(before) else stamp
            if len(self._stamps) > CLOCKS_KEPT:
                self._stamps.popitem(last=False)

    def served(self) -> None:
        """What had arrived before a halt has ended. Called by the event loop, once for each halt."""
        self._n_served += 1

    def overtook(self, entry: Entry) -> bool:
        """Whether a command that arrives now was sent before the halt; of one that cannot show it, that is assumed.

        It is as long as the halt is being served, which takes a while behind many requests, and a moment longer.
        """
        after = self._sent_after(entry)
        if after is not None:
            return not after
        return self._n_served < self._n_given or time.monotonic() - self.at_s < SHADOW_S

    def spares(self, entry: Entry) -> bool:
        """Whether a command that came before the halt was served was surely sent after it."""
        return self._sent_after(entry) is True

    def _sent_after(self, entry: Entry) -> bool | None:
        """Whether it was sent after the newest halt; None when no clock tells."""
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
    """The commands on their way, in order of arrival."""

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
        """Whether no more may wait."""
        return len(self._all) >= MOST_WAITING

    def add(self, pending: QueuedCommand) -> None:
        """Append a command that has just come."""
        self._all.append(pending)

    def remove(self, pending: QueuedCommand) -> None:
        """Remove a command that is played or has ended."""
        if pending in self._all:
            self._all.remove(pending)

    def renew(self, pending: QueuedCommand) -> None:
        """Move a command whose time has come behind all others: it is the newest."""
        self._all.remove(pending)
        self._all.append(pending)

    def overtaken_by(self, newest: QueuedCommand) -> list[QueuedCommand]:
        """Commands that end because `newest` takes over: all before it but those whose time has not come."""
        before = self._all[: self._all.index(newest)]
        return [p for p in before if not p.committing and not (p.when == "at" and not p.turn)]

    def may_be_overtaken(self, pending: QueuedCommand) -> bool:
        """Whether a newer `now` is being made of which is not known yet whether it is accepted."""
        newer = self._all[self._all.index(pending) + 1 :]
        return any(p.undecided for p in newer)

    @property
    def oldest_undecided(self) -> QueuedCommand | None:
        """The first `now` that is still being made."""
        return next((p for p in self._all if p.undecided), None)

    def is_next(self, pending: QueuedCommand) -> bool:
        """Whether no command stands before this one that waits for its turn."""
        for p in self._all:
            if p is pending:
                return True
            if p.when != "at" or p.turn:
                return False
        return True

    @property
    def someone_is_about(self) -> bool:
        """Whether a `now` is on its way to take over."""
        return any(p.when == "now" for p in self._all)

    @property
    def someone_waits_after(self) -> bool:
        """Whether a command waits for what is played to end."""
        return any(p.when == "after" for p in self._all)
