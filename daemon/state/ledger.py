"""The ledger of all commands: sender, events so far, and exactly one end each. No I/O."""

from __future__ import annotations

import itertools
import time
import uuid
from collections import Counter, deque
from collections.abc import Callable
from dataclasses import dataclass, field

import msgspec

from daemon.wire.codec import WireError
from daemon.wire.event_base import Event
from daemon.wire.events import Accepted, Failed, Progress, Rejected
from daemon.wire.requests import Command, tag_of

KEPT = 1024
"""Commands that are remembered, so that a repeated id means the same command; the command that ended first is forgotten first."""
KEPT_SCENES = 8
"""Newest scenes of a story, or newest events of a lease, that a later asker receives."""
LEASE_NEWS = ("held", "silent", "streaming", "bad_target")
"""Stages of a lease's events that may come any number of times."""


@dataclass(frozen=True)
class Route:
    """Address of the peer that receives a reply.

    Attributes:
        frames: the ROUTER's address frames, with the empty delimiter of a REQ peer.
        once: whether the peer is a REQ socket, which takes exactly one reply for each request.
    """

    frames: tuple[bytes, ...]
    once: bool


def split_route(frames: list[bytes]) -> tuple[Route, list[bytes]]:
    """The sender's route and the frames that it sent, from the frames of a ROUTER socket."""
    if len(frames) >= 3 and frames[1] == b"":
        return Route(tuple(frames[:2]), once=True), frames[2:]
    return Route(tuple(frames[:1]), once=False), frames[1:]


@dataclass
class Entry:
    """One command that plays something.

    Attributes:
        id: id of the command.
        request: the request to carry out: the one received, or its meaning after an earlier command.
        routes: peers that receive its events.
        events: its events so far.
        ended: whether its last event was sent.
        t_received_ns: monotonic time at which the request arrived, nanoseconds.
        asked: the request as received.
        refers_to: id of the earlier command that the text refers to, else empty.
    """

    id: str
    request: Command
    t_received_ns: int
    routes: list[Route]
    events: list[Event] = field(default_factory=list[Event])
    ended: bool = False
    refers_to: str = ""

    def __post_init__(self) -> None:
        """Keep the request as received."""
        self.asked = self.request

    @property
    def accepted(self) -> bool:
        """Whether the command was accepted."""
        return any(isinstance(event, Accepted) for event in self.events)

    @property
    def named(self) -> str:
        """The `by` in the events of the commands that this one ends."""
        return f"{tag_of(self.request)} {self.id}"

    def keep(self, event: Event) -> None:
        """Remember an event for later askers; of scenes and lease events only the newest are kept."""
        if _any_number(event):
            many = [e for e in self.events if _any_number(e)]
            if len(many) >= KEPT_SCENES:
                self.events.remove(many[0])
        self.events.append(event)

    @property
    def deadline_s(self) -> float:
        """Monotonic time by which its motion has to begin, seconds; infinite without a deadline."""
        wanted_s = self.request.deadline_s
        return float("inf") if wanted_s is None else self.t_received_ns * 1e-9 + wanted_s


class Ledger:
    """Keeps all commands that the daemon knows.

    Args:
        send: called with each route and the event to send to it.
        publish: called once with each event.

    Attributes:
        counts: number of events so far, by type.
    """

    def __init__(self, send: Callable[[Route, Event], None], publish: Callable[[Event], None]) -> None:
        self._send, self._publish = send, publish
        self._entries: dict[str, Entry] = {}
        self._ended: deque[str] = deque()
        self._seq = itertools.count(1)
        self.counts: Counter[str] = Counter()

    def stamp(self, event: Event) -> Event:
        """Give an event its number and time."""
        event.seq, event.t_mono = next(self._seq), time.monotonic()
        self.counts[tag_of(event)] += 1
        return event

    def open(self, request: Command, route: Route, t_received_ns: int) -> Entry | None:
        """The entry of a new command; None when its id is known: the sender then receives the events so far and those to come.

        Raises:
            WireError: the id belongs to another request.
        """
        known = self._entries.get(request.id) if request.id else None
        if known is not None:
            if _without_stamp(known.asked) != _without_stamp(request):
                found = f"id {request.id!r}, which stands for {known.asked.words!r}"
                asked, allowed = tag_of(request), "the same request, or a new id"
                raise WireError("id_in_use", asked, found, allowed, "choose a new id", request.id)
            self._catch_up(known, route)
            return None
        entry = Entry(request.id or uuid.uuid4().hex, request, t_received_ns, [route])
        self._entries[entry.id] = entry
        while len(self._entries) > KEPT and self._ended:
            del self._entries[self._ended.popleft()]
        return entry

    def emit(self, entry: Entry, event: Event) -> None:
        """Send an event of a command to all its routes, with its id and kind; nothing follows the event that ends it."""
        if entry.ended:
            return
        event.id = entry.id
        if isinstance(event, Rejected | Failed) and not event.asked:
            event.asked = tag_of(entry.request)
        self.stamp(event)
        entry.keep(event)
        entry.ended = event.terminal
        if entry.ended:
            self._ended.append(entry.id)
        for route in list(entry.routes):
            self._send(route, event)
            if route.once:
                entry.routes.remove(route)
        self._publish(event)

    def reply(self, route: Route, event: Event) -> None:
        """Send an event that belongs to no command."""
        self._send(route, self.stamp(event))

    def _catch_up(self, entry: Entry, route: Route) -> None:
        if not route.once:
            for event in entry.events:
                self._send(route, event)
            if route not in entry.routes:
                entry.routes.append(route)
        elif entry.events:
            self._send(route, entry.events[-1])
        else:
            entry.routes.append(route)


def _any_number(event: Event) -> bool:
    return isinstance(event, Progress) and (event.scene is not None or event.stage in LEASE_NEWS)


def _without_stamp(request: Command) -> Command:
    """The request without number, time, clock and shown state, which differ between two sendings of one request."""
    return msgspec.structs.replace(request, seq=None, t_mono=None, clock=None, state_t_mono=None)
