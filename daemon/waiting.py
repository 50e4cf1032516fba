"""Commands on their way: being made, waiting for their turn or their time. The newest `now` wins over older ones."""

from __future__ import annotations

import asyncio
import time
from dataclasses import dataclass

from daemon.ledger import Entry

MOST_WAITING = 64
OVERTAKEN_S = 5.0
"""How much later than a stop a command may arrive that says it was sent before: it is not played."""
SHADOW_S = 0.1
"""A command that does not say when it was sent and comes so soon after a stop was on its way when it was given."""


@dataclass(eq=False)
class Pending:
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


class Halts:
    """When a person last stopped, parked or cut torque, and what that means for a command. Written by the ctl thread."""

    def __init__(self) -> None:
        self.at_s, self.by = float("-inf"), ""

    def note(self, by: str) -> None:
        """A halt was given."""
        self.at_s, self.by = time.monotonic(), by

    def overtook(self, entry: Entry) -> bool:
        """Whether a command that arrives now was sent before the halt."""
        sent_s, now_s = entry.request.t_mono, time.monotonic()
        if sent_s is None:
            return now_s - self.at_s < SHADOW_S
        return self.at_s - OVERTAKEN_S < sent_s < self.at_s

    def spares(self, entry: Entry) -> bool:
        """Whether a command that came before the halt was served says that it was sent after it."""
        sent_s = entry.request.t_mono
        return sent_s is not None and self.at_s < sent_s <= time.monotonic()


class WaitingRoom:
    """All commands on their way, in order of arrival."""

    def __init__(self) -> None:
        self._all: list[Pending] = []

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

    def add(self, pending: Pending) -> None:
        """A command came."""
        self._all.append(pending)

    def remove(self, pending: Pending) -> None:
        """It is played or has ended."""
        if pending in self._all:
            self._all.remove(pending)

    def overtaken_by(self, newest: Pending) -> list[Pending]:
        """Those that end because `newest` takes over: all but later ones, and those whose time has not come."""
        return [
            p for p in self._all
            if p is not newest and not p.committing and not (p.when == "at" and not p.turn)
        ]  # fmt: skip

    def is_next(self, pending: Pending) -> bool:
        """Whether no command stands before this one that waits for its turn."""
        for p in self._all:
            if p is pending:
                return True
            if p.when != "at" or p.turn:
                return False
        return True

    @property
    def someone_waits_after(self) -> bool:
        """Whether a command waits for what is played to end."""
        return any(p.when == "after" for p in self._all)
