"""`mmmd say`: tell the robot what to do."""

from __future__ import annotations

import sys
from typing import Annotated

import tyro
from tyro.conf import OmitArgPrefixes

from daemon.commands.connection import Connection


def say(
    text: Annotated[str, tyro.conf.Positional],
    seed: int = 0,
    seconds: float | None = None,
    wait: bool = True,
    json: bool = False,
    at: OmitArgPrefixes[Connection] = Connection(),  # noqa: B008
) -> int:
    """Tell the robot what to do, and how it went.

    Example: mmmd say "wave with your right hand" --seed 3

    Args:
        text: what to do, in English.
        seed: the same text, seed and seconds give the same motion.
        seconds: length of the motion; the model chooses when it is not given.
        wait: return when the motion has ended; --no-wait returns once it is accepted.
        json: print each event as one JSON object a line.
        at: where the daemon is.
    """
    import uuid

    from daemon.client import FIRST_REPLY_TIMEOUT_S, MOTION_TIMEOUT_S
    from daemon.wire import MAX_SEED, Accepted, Cancelled, Failed, Refusal, Say, WireError, check_text, encode

    try:
        check_text(text)
    except WireError as error:
        sys.stderr.write(f"mmmd: {error}\n")
        return 2
    if not 0 <= seed <= MAX_SEED:
        sys.stderr.write(f"mmmd: --seed {seed}; allowed: 0 to {MAX_SEED}\n")
        return 2
    status = 0
    with at.client() as robot:
        request = Say(id=uuid.uuid4().hex, text=text, seed=seed, seconds=seconds)
        for event in robot.events_of(request, MOTION_TIMEOUT_S if wait else FIRST_REPLY_TIMEOUT_S):
            if json:
                sys.stdout.write(encode(event).decode() + "\n")
                sys.stdout.flush()
            elif not isinstance(event, Refusal):
                sys.stdout.write(describe(event) + "\n")
                sys.stdout.flush()
            if isinstance(event, Refusal):
                if not json:
                    sys.stderr.write(f"mmmd: {event.message}\n")
                status = 3 if isinstance(event, Failed) and event.code == "fault" else 1
            elif isinstance(event, Cancelled):
                status = 1
            if not wait and isinstance(event, Accepted):
                break
    return status


def describe(event: object) -> str:
    """One line about an event, for people."""
    from daemon.wire import Accepted, Cancelled, Done, Progress

    if isinstance(event, Accepted):
        reason = f" ({event.reason})" if event.reason else ""
        return f"{event.status}: understood as {event.understood}{reason}; {event.duration_s:.1f} s"
    if isinstance(event, Progress):
        if event.first_motion_ms is None:
            return f"{event.stage} ..."
        return f"{event.stage}: first servo frame {event.first_motion_ms:.0f} ms after the text"
    if isinstance(event, Done):
        return (
            f"done: {event.duration_s:.2f} s; peak {event.peak_speed_joint} at {100 * event.peak_speed_share:.0f} % of "
            f"its {event.peak_speed_limit_rad_s:.2f} rad/s; {event.clipped_frames} of {event.frames} frames clipped; "
            f"direction error {event.direction_error_deg:.1f} deg"
        )
    if isinstance(event, Cancelled):
        return f"cancelled by {event.by}"
    return str(event)
