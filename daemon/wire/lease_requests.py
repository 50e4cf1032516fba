"""Joint targets from another program: the lease that allows them, its end, and the targets themselves. No I/O."""

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
"""Number of angles in a target that is decoded, at most; the robot's own number is checked afterwards."""


def without_secret(frame: bytes, secret: str) -> bytes:
    """A frame for the log, without the lease's secret: more people read a log than may hold the lease."""
    return frame.replace(secret.encode(), b"(secret)") if secret else frame


class Lease(Command, tag="lease", kw_only=True):
    """The right to send joint targets to the `stream` socket, for one holder at a time.

    It begins when the robot is armed and its turn has come, and ends by `release` (done), by whatever ends a motion
    (cancelled), or by a silence that lasts (failed, and the robot parks).

    Attributes:
        secret: word that every target contains. Ids are published, and reading one on `pub` must not suffice to move the robot.
        holder: name of the requesting program in a word or two, reported to a second one.
        silence_s: seconds without a target after which the robot brakes and holds; None takes the daemon's `lease_s`.
    """

    secret: Secret
    holder: Annotated[str, Meta(max_length=64)] = ""
    silence_s: Annotated[float, Meta(ge=SHORTEST_SILENCE_S, le=LONGEST_SILENCE_S)] | None = None

    @property
    def words(self) -> str:
        """The holder of the lease, in words."""
        return f"stream of {self.holder}" if self.holder else "stream"


class Release(Request, tag="release", kw_only=True):
    """Release a lease: the robot goes to the last target, brakes, and the lease ends in `done`.

    Attributes:
        lease: id of the lease; empty means the present one.
    """

    lease: Id = ""


class Target(Request, tag="target", kw_only=True):
    """Target angles of the joints, sent to the `stream` socket as one frame.

    Attributes:
        id: of the lease.
        secret: of the lease.
        q_rad: an angle for every joint in the robot's order, or some joints by name; the others keep their target.
    """

    id: Annotated[str, Meta(min_length=1, max_length=MAX_ID_CHARS, description="of the lease")]  # type: ignore[assignment]
    secret: Secret
    q_rad: Annotated[list[float], Meta(min_length=1, max_length=MOST_JOINTS)] | dict[str, float]
