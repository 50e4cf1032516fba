"""Joint targets from another program: the lease that allows them, its end, and the targets themselves. Sans-I/O."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from daemon.wire.request_base import MAX_ID_CHARS, Command, Id, Request

SHORTEST_SILENCE_S, LONGEST_SILENCE_S = 0.02, 2.0
Secret = Annotated[
    str,
    Meta(
        pattern=r"^[A-Za-z0-9_-]{16,128}$",
        description="16 to 128 random letters, digits, _ and -, known to the holder alone",
    ),
]
MOST_JOINTS = 256
"""Longest row of angles that is read at all; the robot's own number is checked afterwards."""


def without_secret(frame: bytes, secret: str) -> bytes:
    """A frame as it is recorded: a log is read by more people than hold the lease."""
    return frame.replace(secret.encode(), b"(secret)") if secret else frame


class Lease(Command, tag="lease", kw_only=True):
    """The right to send joint targets to the `stream` socket, for one holder at a time.

    It begins when the robot is armed and its turn has come, and ends by `release` (done), by whatever ends a motion
    (cancelled), or by a silence that lasts (failed, and the robot parks).

    Attributes:
        secret: what every target shows. Ids are published; who reads one on `pub` must not lead the robot with it.
        holder: who asks, in a word or two; a second asker is told.
        silence_s: without a target for so long the robot brakes and holds; None takes the daemon's `lease_s`.
    """

    secret: Secret
    holder: Annotated[str, Meta(max_length=64)] = ""
    silence_s: Annotated[float, Meta(ge=SHORTEST_SILENCE_S, le=LONGEST_SILENCE_S)] | None = None

    @property
    def words(self) -> str:
        """Whose it is."""
        return f"stream of {self.holder}" if self.holder else "stream"


class Release(Request, tag="release", kw_only=True):
    """Give a lease back: the robot goes to the last target, brakes, and the lease ends in `done`.

    Attributes:
        lease: id of the lease; empty means whichever is held.
    """

    lease: Id = ""


class Target(Request, tag="target", kw_only=True):
    """Where the joints are to be, sent to the `stream` socket as one frame.

    Attributes:
        id: of the lease.
        secret: of the lease.
        q_rad: an angle for every joint in the robot's order, or some joints by name; the others keep their target.
    """

    id: Annotated[str, Meta(min_length=1, max_length=MAX_ID_CHARS, description="of the lease")]  # type: ignore[assignment]
    secret: Secret
    q_rad: Annotated[list[float], Meta(min_length=1, max_length=MOST_JOINTS)] | dict[str, float]
