"""What `mmmd say`, `story`, `inbetween`, `edit` and `gesture play` share: options, sending, and printing what happens."""

from __future__ import annotations

import sys
import uuid
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, TypeVar

from daemon.cli.connection import Connection
from daemon.client.event_text import describe
from daemon.errors import CommandError

if TYPE_CHECKING:
    from daemon.wire.requests import Play, PlayOptions


@dataclass(frozen=True)
class PlayFlags:
    """How it is to be played.

    Attributes:
        tempo: how much faster than it was made, 0.5 to 2.
        amplitude: size of the movement, 0.3 to 1.2.
        mirror: left for right.
        repeat: how often.
        loop: go round until something ends it.
        hold: stop in the pose that says most, and stay.
        when: now (takes over), after (what is played), or at (with --at-s).
        at_s: when to take over, on the daemon's clock (`t_mono` of its events).
        deadline_s: reject it when it cannot begin so many seconds from now.
        id: the same id twice is one command; one is chosen when it is not given.
    """

    tempo: float = 1.0
    amplitude: float = 1.0
    mirror: bool = False
    repeat: int = 1
    loop: bool = False
    hold: bool = False
    when: Literal["now", "after", "at"] = "now"
    at_s: float | None = None
    deadline_s: float | None = None
    id: str = ""

    def options(self) -> PlayOptions:
        """For the request."""
        return {
            "tempo": self.tempo, "amplitude": self.amplitude, "mirror": self.mirror, "repeat": self.repeat,
            "loop": self.loop, "hold": self.hold, "when": self.when, "at_s": self.at_s, "deadline_s": self.deadline_s,
        }  # fmt: skip


INTERRUPTED = 130
"""Exit status after Ctrl-C, as shells expect it."""

P = TypeVar("P", bound="Play")


def built(kind: type[P], how: PlayFlags, **fields: Any) -> P:
    """A request with the flags of the command line.

    Raises:
        CommandError: the flags contradict each other, or the seed is none.
    """
    from daemon.wire.requests import MAX_SEED

    seed = fields.get("seed", 0)
    if not 0 <= seed <= MAX_SEED:
        raise CommandError(f"--seed {seed}; allowed: 0 to {MAX_SEED}")
    try:
        return kind(id=how.id or uuid.uuid4().hex, **fields, **how.options())
    except ValueError as error:
        raise CommandError(str(error)) from None


def play(request: Play, at: Connection, *, wait: bool, json: bool) -> int:
    """Send a request and print its events; the exit status. Ctrl-C cancels the command."""
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
    """Send a request and print its events; the exit status."""
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
                status = 1
            if not wait and isinstance(event, Accepted):
                break
    return status


def _interrupted(request: Play, at: Connection) -> int:
    """Cancel a command after Ctrl-C and say what came of it; a second Ctrl-C leaves at once and says what goes on."""
    from daemon.client.errors import NoAnswerError, RefusedError

    what = f"{request.words[:60]!r}"
    try:
        sys.stderr.write(f"\nmmmd: cancelling {what}: the robot brakes and holds; Ctrl-C again leaves at once\n")
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
    except KeyboardInterrupt:
        sys.stderr.write(f"\nmmmd: left; {what} may go on: `mmmd stop` brakes and holds, `mmmd estop` cuts torque\n")
    return INTERRUPTED
