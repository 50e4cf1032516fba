"""`mmmd watch`: events, state and health as they happen."""

from __future__ import annotations

import sys

from tyro.conf import OmitArgPrefixes

from daemon.cli.connection import Connection


def watch(
    at: OmitArgPrefixes[Connection] = Connection(),  # noqa: B008
    json: bool = False,
    n: int | None = None,
) -> int:
    """Follow events, log lines and changes of state and of servos' health until interrupted.

    Each line begins with the seconds of the daemon's clock, as `t_mono` of its events.

    Example: mmmd watch --json

    Args:
        at: where the daemon is.
        json: print every message as one JSON object a line, all states included.
        n: end after so many lines.
    """
    from daemon.wire.codec import encode
    from daemon.wire.status import HealthEvent, LogEvent, StateEvent

    shown, last_state, last_health = 0, "", ""
    with at.client() as robot:
        for topic, event in robot.watch("v1/", timeout_s=at.timeout_s):
            if json:
                line = encode(event).decode()
            elif isinstance(event, StateEvent):
                if event.state == last_state:
                    continue
                last_state = event.state
                line = f"{event.t_mono:.3f} s: state {event.state}" + (f": {event.reason}" if event.reason else "")
            elif isinstance(event, HealthEvent):
                health = ", ".join(f"servo {s.id} ({s.joint}) {s.state}" for s in event.servos if s.state != "ok")
                if health == last_health:
                    continue
                last_health = health
                line = f"{event.t_mono:.3f} s: health {health or 'every servo ok'}"
            elif isinstance(event, LogEvent):
                line = f"{event.t_mono:.3f} s: {event.process} {event.level} {event.text}"
            else:
                from daemon.client.event_text import describe

                line = f"{event.t_mono:.3f} s: {topic} {event.id[:8]} {describe(event)}"
            sys.stdout.write(line + "\n")
            sys.stdout.flush()
            shown += 1
            if n is not None and shown >= n:
                break
    return 0
