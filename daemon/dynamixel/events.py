"""Events on a bus besides the exchange of goals and measurements: named, counted, reported once each time they begin."""

from __future__ import annotations

import logging
from dataclasses import dataclass
from enum import Enum

log = logging.getLogger(__name__)

KEPT = 1000


class BusEventKind(Enum):
    """Kinds of events."""

    QUARANTINED = "quarantined"
    RETURNED = "returned"
    REBOOTED = "rebooted"
    BROWN_OUT = "brown-out"
    DUPLICATE_ID = "duplicate id"
    FOREIGN_PACKET = "foreign packet"
    ECHO = "echo"
    LOST = "lost"
    REPLUGGED = "replugged"
    FAST_SYNC_OFF = "fast sync off"
    WATCHDOG_TRIPPED = "watchdog tripped"
    HARDWARE_ERROR = "hardware error"


@dataclass(frozen=True)
class BusEvent:
    """One event; `servo_id` is None when it concerns the whole bus."""

    kind: BusEventKind
    t_s: float
    servo_id: int | None
    text: str


class EventLog:
    """Collects events; a repeated one is counted, and reported again only after a pause."""

    QUIET_S = 5.0

    def __init__(self) -> None:
        self.counts: dict[BusEventKind, int] = {}
        self._last_s: dict[tuple[BusEventKind, int | None], float] = {}
        self._waiting: list[BusEvent] = []

    def add(self, kind: BusEventKind, t_s: float, text: str, servo_id: int | None = None) -> None:
        self.counts[kind] = self.counts.get(kind, 0) + 1
        last_s = self._last_s.get((kind, servo_id))
        self._last_s[kind, servo_id] = t_s
        if last_s is not None and t_s - last_s < self.QUIET_S:
            return
        log.warning("%s: %s", kind.value, text)
        if len(self._waiting) < KEPT:
            self._waiting.append(BusEvent(kind, t_s, servo_id, text))

    def take(self) -> list[BusEvent]:
        """Events since the last call."""
        taken, self._waiting = self._waiting, []
        return taken
