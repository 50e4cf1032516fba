"""The last commands of each client, for texts that refer to them: "again", "slower", "with the other hand".

A client is one connection of one peer, as for the request limits. No client can refer to another client's commands.
"""

from __future__ import annotations

import time
from collections import OrderedDict, deque
from collections.abc import Callable
from functools import lru_cache

import msgspec

from daemon.state.ledger import Entry
from daemon.state.replies import NotPlayableError
from daemon.wire.events import Accepted, Rejected
from daemon.wire.requests import MAX_TEXT_CHARS, Gesture, Lease, Say, tag_of
from mmm_core.language.command_changes import NothingToReferToError
from mmm_core.language.commands import EXACTLY, Reading, exactly, read_exactly
from mmm_core.language.context import InContext, in_context
from mmm_core.language.delays import delayed
from mmm_core.language.endless import endless
from mmm_core.language.reading import read
from mmm_core.language.warming import warmed

KEPT = 512
"""Clients that are remembered; the one with the oldest request is forgotten first."""
KEPT_COMMANDS = 4
"""Newest commands kept for each client: a refused command does not count, and the one before it does."""
FORGET_S = 120.0
"""Seconds after its last event in which a command may be referred to; a command that is not over may be at any time."""
_HOW_OFTEN = ("repeat", "loop", "hold")
_HOLD_ON = ("tempo", "amplitude", "mirror", "seconds", "seed", *_HOW_OFTEN)
"""Options of the last command that stay in force when the request that refers to it does not set them."""
Client = tuple[bytes, str]
"""A connection's address, and the name of its key or else its network address."""


class Conversations:
    """Remembers the last commands of each connection.

    Args:
        words_of: returns the words of a named gesture; empty for an unknown one.
        now_s: monotonic clock, seconds.
    """

    def __init__(self, words_of: Callable[[str], str], now_s: Callable[[], float] = time.monotonic) -> None:
        self._words_of, self._now_s = words_of, now_s
        self._clients: OrderedDict[Client, deque[Entry]] = OrderedDict()
        self._read = lru_cache(maxsize=KEPT)(read)
        warmed()
        in_context("again", self._read("nod"))  # loads the table of words that refer to the last command
        endless("keep waving")

    def take(self, entry: Entry, client: Client) -> None:
        """Remember a new command of a client; a text that refers to the last command is replaced by its full meaning.

        Raises:
            NotPlayableError: there is no command that the text can refer to.
        """
        request = entry.request
        if isinstance(request, Lease):
            return
        if isinstance(request, Say) and request.context:
            self._resolve(entry, request, self._last(client))
        known = self._clients.pop(client, None)
        entries: deque[Entry] = deque(maxlen=KEPT_COMMANDS) if known is None else known
        entries.append(entry)
        self._clients[client] = entries
        while len(self._clients) > KEPT:
            self._clients.popitem(last=False)

    def read_ahead(self, entry: Entry) -> None:
        """Read the words of a command before the next text refers to it, so that the robot does not wait for the reading then."""
        self._reading_of(entry)

    def _resolve(self, entry: Entry, request: Say, last: Entry | None) -> None:
        """Replace a text that refers to the last command by its full meaning, and one that asks for no end by what it repeats.

        Raises:
            NotPlayableError: the text refers to a command, and there is none that it can refer to.
        """
        try:
            meant = in_context(request.text, None if last is None else self._reading_of(last))
            if meant is None or last is None:
                entry.request = _without_end(_later(request, self._now_s()))
                return
            text = exactly(meant.reading.steps)
            if len(text) > MAX_TEXT_CHARS:
                raise NothingToReferToError("the last command is too long", f"one of {MAX_TEXT_CHARS} characters")
        except NothingToReferToError as error:
            raise NotPlayableError(_nothing_to_refer_to(request, last, error)) from error
        entry.request = _played(request, last, meant, text)
        entry.refers_to = last.id

    def _last(self, client: Client) -> Entry | None:
        """The client's newest command that was not refused; None without one, or when it is forgotten."""
        for entry in reversed(self._clients.get(client, ())):
            if entry.ended and not entry.accepted:
                continue
            at_s = entry.events[-1].t_mono if entry.ended else self._now_s()
            return entry if self._now_s() - at_s <= FORGET_S else None
        return None

    def _reading_of(self, entry: Entry) -> Reading | None:
        """The commands that the generator, or else the rules, read in a command; None for one without words."""
        if isinstance(entry.request, Say):
            return _as_accepted(entry) or self._read(entry.request.text)
        words = self._words_of(entry.request.name) if isinstance(entry.request, Gesture) else ""
        return self._read(words) if words else None


def _as_accepted(entry: Entry) -> Reading | None:
    """The commands that a command's `accepted` event says; None before it, and where it says none."""
    commands = next((event.commands for event in entry.events if isinstance(event, Accepted)), ())
    return read_exactly(f"{EXACTLY} {'; '.join(commands)}") if commands else None


def _played(request: Say, last: Entry, meant: InContext, text: str) -> Say:
    """The request with its full text, and with the options of the last command that it does not set itself."""
    default = Say(text=text)
    given = {name for name in _HOLD_ON if getattr(request, name) != getattr(default, name)}
    options = {name: getattr(last.request, name, getattr(default, name)) for name in _HOLD_ON if name not in given}
    if given & set(_HOW_OFTEN) or meant.keeps_going or meant.is_counted:
        options |= {name: getattr(request, name) for name in _HOW_OFTEN}
    if meant.keeps_going and not given & set(_HOW_OFTEN):
        options["hold" if meant.is_pose else "loop"] = True
    elif meant.times and not request.loop:
        options["repeat"] = meant.times
    return msgspec.structs.replace(request, text=text, **options)


def _later(request: Say, now_s: float) -> Say:
    """The request at the time that its text names, where it says not when itself: "in ten seconds, clap"."""
    found = delayed(request.text) if request.when == "now" else None
    if found is None:
        return request
    return msgspec.structs.replace(request, text=found.text, when="at", at_s=now_s + found.delay_s)


def _without_end(request: Say) -> Say:
    """The request as a loop or with a held pose, where its text asks for a motion without end and it says not how often."""
    default = Say(text=request.text)
    if any(getattr(request, name) != getattr(default, name) for name in _HOW_OFTEN):
        return request
    found = endless(request.text)
    if found is None:
        return request
    option = "hold" if found.is_pose else "loop"
    return msgspec.structs.replace(request, text=found.text, **{option: True})


def _nothing_to_refer_to(request: Say, last: Entry | None, error: NothingToReferToError) -> Rejected:
    found = error.found
    if last is not None and not isinstance(last.request, Say | Gesture):
        found = f"the last command was a {tag_of(last.request)}, which is no text"
    return Rejected(
        code="nothing_to_refer_to", asked=f"say {request.text[:200]!r}", found=found, allowed=error.allowed,
        do="say the whole command, e.g. 'wave with your right hand'",
    )  # fmt: skip
