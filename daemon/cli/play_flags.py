"""Options, sending and printing of events, shared by `mmmd say`, `story`, `inbetween`, `edit` and `gesture play`."""

from __future__ import annotations

import math
import sys
import uuid
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeVar, cast

import tyro

from daemon.cli.connection import Connection
from daemon.cli.interrupts import leaving_at_once
from daemon.cli.program import FAILED, INTERRUPTED, ROBOT_FAULT
from daemon.client.event_text import describe
from daemon.errors import CommandError
from daemon.wire.request_base import LEAST_AMPLITUDE, LEAST_TEMPO, MOST_AMPLITUDE, MOST_TEMPO

if TYPE_CHECKING:
    from daemon.wire.requests import Play, PlayOptions


@dataclass(frozen=True)
class PlayFlags:
    """Options of playing a motion, as in `daemon.wire.requests.Play`, and the command's id.

    Attributes:
        mirror: exchange left and right.
        repeat: number of times that the motion is played.
        loop: play the motion again and again until another command or a stop ends it.
        hold: stop in the most telling pose of the motion, and stay in it.
        when: now (replaces the running motion), after (the running motion has ended), or at (with --at-s).
        at_s: time at which the motion begins with --when at, in seconds of the daemon's clock (`t_mono` of its events).
        deadline_s: seconds from now after which the motion is rejected instead of begun.
        id: name of the command; the same id sent twice is one command. A random one when it is not given.
    """

    tempo: Annotated[
        float, tyro.conf.arg(help=f"speed, as a multiple of the generated one, {LEAST_TEMPO:g} to {MOST_TEMPO:g}.")
    ] = 1.0
    amplitude: Annotated[
        float, tyro.conf.arg(help=f"size of the movement, as a multiple, {LEAST_AMPLITUDE:g} to {MOST_AMPLITUDE:g}.")
    ] = 1.0
    mirror: bool = False
    repeat: int = 1
    loop: bool = False
    hold: bool = False
    when: Literal["now", "after", "at"] = "now"
    at_s: float | None = None
    deadline_s: float | None = None
    id: str = ""

    def options(self) -> PlayOptions:
        """Keyword arguments of the request."""
        return cast("PlayOptions", {f.name: getattr(self, f.name) for f in fields(self) if f.name != "id"})


P = TypeVar("P", bound="Play")


def built(kind: type[P], how: PlayFlags, **fields: Any) -> P:
    """A request with the flags of the command line.

    Raises:
        CommandError: the flags contradict each other, or the seed or a number is invalid.
    """
    from daemon.wire.requests import MAX_SEED

    seed = fields.get("seed", 0)
    if not 0 <= seed <= MAX_SEED:
        raise CommandError(f"--seed {seed}; allowed: 0 to {MAX_SEED}")
    for name, value in {**fields, **how.options()}.items():
        if isinstance(value, float) and not math.isfinite(value):
            raise CommandError(f"--{name.replace('_', '-')} {value}; allowed: a finite number")
    try:
        return kind(id=how.id or uuid.uuid4().hex, **fields, **how.options())
    except ValueError as error:
        raise CommandError(str(error)) from None


def play(request: Play, at: Connection, *, wait: bool, json: bool) -> int:
    """Send a request and print its events; return the exit status. Ctrl-C cancels the command."""
    from daemon.wire.codec import WireError, check_request

    try:
        check_request(request)
    except WireError as error:
        sys.stderr.write(f"mmmd: {error}\n")
        return 2
    try:
        return _watched(request, at, wait=wait, json=json)
    except KeyboardInterrupt:
        return _interrupted(request, at)


def _watched(request: Play, at: Connection, *, wait: bool, json: bool) -> int:
    """Send a request and print its events; return the exit status."""
    from daemon.cli.loading_note import LoadingNote
    from daemon.client.compositions import FIRST_REPLY_TIMEOUT_S, patience_s
    from daemon.client.errors import exit_status
    from daemon.wire.codec import encode
    from daemon.wire.events import Accepted, Cancelled, Refusal

    status = 0
    timeout_s = patience_s(request) if wait else FIRST_REPLY_TIMEOUT_S
    with at.client() as robot, LoadingNote(at) as note:
        for event in robot.events_of(request, timeout_s):
            note.answered()
            if json:
                sys.stdout.write(encode(event).decode() + "\n")
            elif not isinstance(event, Refusal):
                sys.stdout.write(describe(event) + "\n")
            sys.stdout.flush()
            if isinstance(event, Refusal):
                if not json:
                    sys.stderr.write(f"mmmd: {event.message}\n")
                status = exit_status(event)
            elif isinstance(event, Cancelled):
                status = ROBOT_FAULT if event.by == "estop" else FAILED
            if not wait and isinstance(event, Accepted):
                break
    return status


def _interrupted(request: Play, at: Connection) -> int:
    """Cancel a command after Ctrl-C and print the result; a second Ctrl-C ends the process at once and says what goes on."""
    from daemon.client.errors import NoAnswerError, RefusedError

    what = f"{request.words[:60]!r}"
    with leaving_at_once(what):
        sys.stderr.write(f"\nmmmd: cancelling {what}: the robot brakes and holds; Ctrl-C again leaves at once\n")
        try:
            with at.client() as robot:
                try:
                    robot.cancel(request.id)
                    sys.stderr.write(f"mmmd: cancelled {what}\n")
                except RefusedError:
                    sys.stderr.write(f"mmmd: {what} had ended, or had not begun\n")
                except NoAnswerError:
                    robot.stop()  # on `ctl`, which answers where `cmd` does not
                    sys.stderr.write("mmmd: stopped: no answer on `cmd`, so everything was stopped on `ctl`\n")
        except NoAnswerError as error:
            sys.stderr.write(f"mmmd: NOT CANCELLED, {what} may go on: {error}\n")
    return INTERRUPTED
