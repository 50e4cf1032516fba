"""Builds the events that report how a command ended."""

from __future__ import annotations

import time

import msgspec

from daemon.generator.generated import GeneratorError
from daemon.state.ledger import Entry
from daemon.state.machine import CommandRefusedError, Trigger
from daemon.wire.events import Cancelled, Failed, Rejected
from daemon.wire.requests import Command, Lease, tag_of
from daemon.wire.showing import in_words
from mmm_core.language.stop_words import asks_for_no_power


class NotPlayableError(Exception):
    """A command ended before it was played; `event` says how."""

    def __init__(self, event: Rejected | Failed) -> None:
        self.event = event
        super().__init__(event.message)


def refusal(request_id: str, error: CommandRefusedError) -> Rejected:
    """The event of a command that the robot's state does not allow; the ledger fills in what a motion was asked by."""
    return Rejected(
        id=request_id,
        code="wrong_state",
        asked="" if error.command is Trigger.SAY else error.command.value,
        found=f"the robot is {in_words(error.state.value)}",
        allowed=", ".join(error.allowed),
        do=error.do,
    )


def refused_later(error: CommandRefusedError) -> Failed:
    """The event of an accepted command that fails because the robot did not become, or stay, ready."""
    return failed("wrong_state", f"the robot is {in_words(error.state.value)}", ", ".join(error.allowed), error.do)


def too_late(entry: Entry, found: str) -> NotPlayableError:
    """The error of a command that cannot begin in time: its event is `rejected`, or `failed` once it was accepted."""
    kind = Failed if entry.accepted else Rejected
    asked = f"{tag_of(entry.request)} within {entry.request.deadline_s:g} s"
    do = "leave out the deadline, or ask when the robot is free"
    return NotPlayableError(kind(code="deadline", asked=asked, found=found, allowed="a beginning in time", do=do))


def generator_failed(error: GeneratorError, state: str) -> Failed:
    """The event of a command for which the generator, in `state`, gave no motion."""
    found = error.found if state in error.found else f"{error.found} (generator: {state})"
    return Failed(code=error.code, asked=error.asked, found=found, allowed=error.allowed, do=error.do)


def ending(plan_id: int, by: str, failure: Failed | None) -> Cancelled | Failed:
    """The event that ends a command: a copy of `failure`, or `cancelled` without one. The ledger fills in the command's id."""
    return Cancelled(plan_id=plan_id, by=by) if failure is None else msgspec.structs.replace(failure, plan_id=plan_id)


def as_failure(event: Rejected | Failed) -> Failed:
    """A rejection as the failure of a command that was already accepted."""
    return Failed(code=event.code, asked=event.asked, found=event.found, allowed=event.allowed, do=event.do)


def failed(code: str, found: str, allowed: str, do: str) -> Failed:
    """The event of a command that could not be carried out; the ledger fills in by what kind of request it was asked."""
    return Failed(code=code, asked="", found=found, allowed=allowed, do=do)


def lease_held(lease: Entry) -> Rejected:
    """The event of a lease request while another program holds a lease."""
    since_s = time.monotonic() - lease.t_received_ns * 1e-9
    return Rejected(
        code="lease_held", asked="lease", found=f"{lease.request.words} holds lease {lease.id!r} since {since_s:.1f} s",
        allowed="one lease at a time", do="ask its holder to `release` it, or end it with `cancel`",
    )  # fmt: skip


def lease_silent(park_s: float, targets: int) -> Failed:
    """The event of a lease whose holder sends no more targets: the holder broke the lease's terms, so it ends in `failed`."""
    return Failed(
        code="lease_silent", asked="lease", found=f"no target for {park_s:g} s, after {targets}",
        allowed="targets at least as often as the lease says, or `release`", do="the robot parks; ask for a new lease",
    )  # fmt: skip


def queue_full(request: Command | Lease, n_waiting: int, most: int) -> Rejected:
    """The event for a command for which there is no place in the queue."""
    asked, allowed = f"{tag_of(request)} {request.when}", f"at most {most} commands waiting"
    do = "wait until some have been played, or cancel some"
    return Rejected(code="queue_full", asked=asked, found=f"{n_waiting}", allowed=allowed, do=do)


def stop_note(words: str, n_ended: int) -> str:
    """What the answer to a text that means to stop says, where `n_ended` commands were ended."""
    note = f"{words[:60]!r} means to stop: the robot brakes and holds; commands ended: {n_ended}"
    if asks_for_no_power(words):
        note += "; no text cuts torque: `mmmd torque off`, `mmmd park` and `mmmd estop` do"
    return note
