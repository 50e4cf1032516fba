"""`mmmd stream`: joint targets from standard input, under a lease."""

from __future__ import annotations

import json as json_module
import sys
import time
from typing import TYPE_CHECKING, Any, cast

from tyro.conf import OmitArgPrefixes

from daemon.cli.connection import Connection
from daemon.errors import CommandError

if TYPE_CHECKING:
    from daemon.client.streams import Angles


def stream(
    holder: str = "mmmd stream",
    rate: float = 0.0,
    silence_s: float | None = None,
    json: bool = False,
    at: OmitArgPrefixes[Connection] = Connection(),  # noqa: B008
) -> int:
    """Lead the joints by targets from standard input, one JSON line each, under a lease; its end releases it.

    A line is an array of radians in the robot's order (`mmmd capabilities --json`), or an object of some joints by name.
    The program that writes the lines has to keep writing: after `lease_s` without one the robot brakes and holds, later it parks.

    Example: my_tracker | mmmd stream --holder tracker

    Exit status 1 when targets were refused and none moved the robot.

    Example: mmmd stream --rate 50 < path.jsonl

    Args:
        holder: name of this program, which the refusal of a second program's request repeats.
        rate: lines a second, for a file; 0 sends each as it comes.
        silence_s: without a line for so long the robot brakes and holds; the daemon's `lease_s` when it is not given.
        json: print the lease's events as JSON.
        at: where the daemon is.
    """
    from daemon.client.event_text import describe
    from daemon.wire.codec import encode

    with at.client() as robot, robot.stream(holder, silence_s=silence_s) as lease:
        due_s = time.monotonic()
        for number, line in enumerate(sys.stdin, 1):
            if not line.strip():
                continue
            if rate > 0:
                due_s += 1 / rate
                time.sleep(max(0.0, due_s - time.monotonic()))
            lease.send(_target(line, number))
    stages: set[str] = set()
    for event in lease.news.events:
        stages.add(getattr(event, "stage", ""))
        sys.stdout.write((encode(event).decode() if json else describe(event)) + "\n")
    return int("bad_target" in stages and "moving" not in stages)


def _target(line: str, number: int) -> Angles:
    """The angles in a line.

    Raises:
        CommandError: the line has no angles.
    """
    try:
        found: Any = json_module.loads(line)
    except json_module.JSONDecodeError as error:
        raise CommandError(f"line {number}: no JSON ({error}); allowed: [radians, ...] or {{joint: radians}}") from None
    angles: list[Any] | None = None
    if isinstance(found, (list, dict)):
        angles = list(cast("dict[str, Any]", found).values()) if isinstance(found, dict) else cast("list[Any]", found)
    if not angles or not all(isinstance(a, (int, float)) and not isinstance(a, bool) for a in angles):
        raise CommandError(f"line {number}: {line.strip()[:60]!r}; allowed: [radians, ...] or {{joint: radians}}")
    return cast("Angles", found)
