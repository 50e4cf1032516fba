"""The way of a stop as a small state machine, gone through exhaustively: every order of steps, crashes, freezes and restarts.

What is shared is the real thing: `RequestWords`, the code that asks, takes, voids and tells done in the daemon. What is around
it is as small as it can be, while each step that may be cut in two is two steps: ctl stamps a request, then writes its word, then
tells the front; the bus process takes a request, then sends its packets, then writes the second word; a successor attaches,
sends torque off where it is owed, and begins. A process may be killed or frozen between any two steps, the port may be lost.

Proved for every state that can be reached with the requests and failures below: (1) every e-stop whose word was written is
carried out once a bus process runs and has its port, and torque is off then, unless a reset was asked for after it; (2) nothing
asked for before an e-stop switches torque on after it; (3) the second word never says more than was done. An e-stop whose word was
not written, as ctl was killed before, has no `ack`; that ctl was lost is an e-stop of its own (`test_heartbeat.py`).
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace

import numpy as np
import pytest

from daemon.shared_memory.request_words import N_WORDS, Asked, Asker, BusRequest, RequestWords

A, S, E, R = BusRequest.ARM, BusRequest.STOP, BusRequest.ESTOP, BusRequest.RESET


@dataclass(frozen=True)
class World:
    """One state.

    Attributes:
        clock: logical time; each stamp takes one.
        words: of shared memory.
        left: what people will still ask for, in order.
        ctl: the step ctl is at: idle, or (kind, number, step); None while it is dead.
        handed: a request that the front has and has not asked for yet.
        bus: dead, starting, running or frozen.
        taken: what the running bus process has taken, as its own memory; empty without one.
        doing: what it carries out and has not told done.
        sent: whether the packets of `doing` went out.
        torque: at the servos.
        latched: whether the running bus process is in e-stop or fault.
        port: whether the port is there.
        crashes: how many failures may still come.
        last_reset: number of the newest reset that was asked for.
        estops: numbers of the e-stops whose word was written.
    """

    clock: int = 1
    words: bytes = bytes(8 * N_WORDS)
    left: tuple[BusRequest, ...] = ()
    ctl: tuple[BusRequest, int, str] | str | None = "idle"
    handed: tuple[BusRequest, int] | None = None
    bus: str = "running"
    taken: bytes = bytes(4 * N_WORDS)
    doing: tuple[BusRequest, int] | None = None
    sent: bool = False
    torque: bool = True
    latched: bool = False
    port: bool = True
    crashes: int = 2
    last_reset: int = 0
    estops: tuple[int, ...] = ()


def words_of(w: World) -> RequestWords:
    """The real words in this state, with the running bus process's memory of what it has taken."""
    made = RequestWords(np.frombuffer(bytearray(w.words), np.uint64))
    if w.bus in ("running", "frozen"):
        made._taken = np.frombuffer(bytearray(w.taken), np.uint64).reshape(made._taken.shape)
    return made


def kept(w: World, words: RequestWords, **changes) -> World:
    raw = np.concatenate([words._asked.ravel(), words._done.ravel()]).tobytes()
    taken = words._taken.tobytes() if changes.get("bus", w.bus) in ("running", "frozen") else bytes(4 * N_WORDS)
    return replace(w, words=raw, taken=taken, **changes)


def steps(w: World) -> list[World]:
    """Every state that may follow."""
    out: list[World] = []
    words = words_of(w)
    # A person asks; ctl takes three steps for it.
    if w.ctl == "idle" and w.left:
        out.append(replace(w, ctl=(w.left[0], 2 * w.clock, "stamped"), left=w.left[1:], clock=w.clock + 1))
    if isinstance(w.ctl, tuple):
        kind, number, step = w.ctl
        if step == "stamped" and kind in (S, E):
            words.ask(Asker.CTL, kind, number)
            estops = (*w.estops, number) if kind is E else w.estops
            out.append(kept(w, words, ctl=(kind, number, "written"), estops=estops))
        elif step == "stamped" and w.handed is None:
            out.append(replace(w, ctl="idle", handed=(kind, number)))
        elif step == "written":
            out.append(replace(w, ctl="idle"))
    # The front hands on what it was given, however late: frozen and dead, it does not.
    if w.handed is not None:
        kind, number = w.handed
        fresh = words_of(w)
        fresh.ask(Asker.FRONT, kind, number)
        out.append(kept(w, fresh, handed=None, last_reset=max(w.last_reset, number) if kind is R else w.last_reset))
        out.append(replace(w, handed=None))
    out += bus_steps(w)
    # Failures.
    if w.crashes:
        less = w.crashes - 1
        if w.bus != "dead":
            out.append(
                replace(w, bus="dead", taken=bytes(4 * N_WORDS), doing=None, sent=False, latched=False, crashes=less)
            )
        if w.bus == "running":
            out.append(replace(w, bus="frozen", crashes=less))
        if w.ctl is not None:
            out.append(
                replace(w, ctl=None, crashes=less)
            )  # who asks loses what was not written yet, and is not answered
        if w.port:
            out.append(replace(w, port=False, crashes=less))
    return out + repairs(w)


def repairs(w: World) -> list[World]:
    """What the supervisor, a person at the plug, or the scheduler brings back."""
    out: list[World] = []
    if w.bus == "dead":
        out.append(replace(w, bus="starting"))
    if w.bus == "frozen":  # goes on by itself, or is killed
        out.append(replace(w, bus="running"))
        out.append(replace(w, bus="dead", taken=bytes(4 * N_WORDS), doing=None, sent=False, latched=False))
    if w.ctl is None:
        out.append(replace(w, ctl="idle"))
    if not w.port:
        out.append(replace(w, port=True))
    return out


def bus_steps(w: World) -> list[World]:
    """One step of the bus process, as `start` and `ControlLoop.cycle` make it."""
    words = words_of(w)
    if w.bus == "starting":
        if not w.port:
            return [replace(w, bus="dead")]
        torque = w.torque and not words.owes(E)  # the first bytes it sends
        return [kept(w, words, bus="running", torque=torque, latched=True)]
    if w.bus != "running":
        return []
    if w.doing is None:
        asked = words.take()
        if asked is None:
            return []
        return [kept(w, words, doing=(asked.kind, asked.number), sent=False)]
    kind, number = w.doing
    if not w.sent:
        if kind is E:
            return [replace(w, latched=True, torque=w.torque and not w.port, sent=w.port)]
        if kind is R:
            return [replace(w, latched=False, torque=w.torque and not w.port, sent=True)]
        return [replace(w, torque=w.torque or (kind is A and not w.latched and w.port), sent=True)]
    words.done(Asked(kind, number))
    return [kept(w, words, doing=None, sent=False)]


def reachable(start: World) -> dict[World, None]:
    seen: dict[World, None] = {start: None}
    ahead = deque([start])
    while ahead:
        for following in steps(ahead.popleft()):
            if following not in seen:
                seen[following] = None
                ahead.append(following)
    return seen


def settled(w: World) -> World:
    """What comes of it when nobody asks and nothing fails any more: repairs first, then the bus process to its end."""
    w = replace(w, left=(), crashes=0, handed=None, ctl=None)
    for _ in range(200):
        if w.bus == "frozen":
            w = replace(w, bus="running")
        elif w.bus == "dead":
            w = replace(w, bus="starting")
        elif not w.port:
            w = replace(w, port=True)
        else:
            following = bus_steps(w)
            if not following:
                return w
            w = following[0]
    raise AssertionError(f"it never comes to rest: {w}")


@pytest.mark.parametrize(
    "asked",
    [
        (E,), (E, E), (S, E), (A, E),
        *(pytest.param(asked, marks=pytest.mark.long) for asked in ((E, R, A), (R, A, E), (E, R, E), (A, E, R), (S, A, E))),
    ],
    ids=lambda kinds: "-".join(k.name.lower() for k in kinds),
)  # fmt: skip
def test_from_every_reachable_state_an_estop_reaches_torque_off(asked):
    states = reachable(World(left=asked))
    assert len(states) > 100
    for w in states:
        end = settled(w)
        words = words_of(end)
        for number in end.estops:
            assert words.carried_out(Asker.CTL, Asked(E, number)), f"lost: {w}"
        newest = max(end.estops, default=0)
        if newest and end.last_reset < newest:
            assert not end.torque and end.latched, f"torque after the e-stop: {w} -> {end}"


@pytest.mark.parametrize(
    "asked",
    [(E,), (A, E), pytest.param((R, A, E), marks=pytest.mark.long)],
    ids=lambda kinds: "-".join(k.name.lower() for k in kinds),
)
def test_a_report_never_says_more_than_was_done_and_no_older_undoes_it(asked):
    for w in reachable(World(left=asked)):
        done = [n for n in w.estops if words_of(w).carried_out(Asker.CTL, Asked(E, n))]
        if done and w.last_reset < max(done):
            assert not w.torque, f"told done, and there is torque: {w}"


def test_a_word_that_is_marked_when_taken_is_found_out_by_this_model(monkeypatch):
    """The fault that was there: who takes a request and dies has it carried out by nobody. The model must see that."""

    class Forgetful(RequestWords):
        def take(self) -> Asked | None:
            asked = super().take()
            if asked is not None:
                self.done(asked)
            return asked

    monkeypatch.setitem(globals(), "RequestWords", Forgetful)
    with pytest.raises(AssertionError, match="torque after the e-stop"):
        test_from_every_reachable_state_an_estop_reaches_torque_off((E,))
