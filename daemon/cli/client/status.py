"""`mmmd status`: the state of the robot and the daemon."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from tyro.conf import OmitArgPrefixes

from daemon.cli.connection import Connection
from daemon.cli.program import GOOD, ROBOT_FAULT

if TYPE_CHECKING:
    from daemon.wire.status import ServoHealth, StateEvent

_COUNTED = {"timeouts": "time-outs", "crc": "spoilt", "late": "late", "retries": "asked again", "alerts": "alerts"}


def status(at: OmitArgPrefixes[Connection] = Connection(), json: bool = False) -> int:  # noqa: B008
    """Show what the robot and the daemon are doing. Exit status 3 when the robot is in a fault or e-stop.

    Example: mmmd status --json

    Args:
        at: where the daemon is.
        json: print one JSON object.
    """
    from daemon.wire.codec import encode

    with at.client() as robot:
        now = robot.status()
    exit_status = ROBOT_FAULT if now.state in ("fault", "estop") else GOOD
    if json:
        sys.stdout.write(encode(now).decode() + "\n")
        return exit_status
    from rich.console import Console
    from rich.table import Table

    playing = (
        f"{now.command.text!r}, {now.command.frames_pushed} of {now.command.frames} frames" if now.command else "-"
    )
    rows = {
        "robot": f"{now.robot} on {now.bus}",
        "state": f"{', '.join(filter(None, (now.state, now.with_torque)))}{_needs(now)}{f': {now.reason}' if now.reason else ''}",
        "playing": playing,
        "looking": "as the motion does"
        if now.gaze_deg is None
        else f"{gaze_words(*now.gaze_deg)}, held until `mmmd look`",
        "stream": _stream(now),
        "buffer": f"{now.queued_ms:.0f} ms of setpoints",
        "generator": now.generator,
        "recording": now.recording or "-",
        "servos": "; ".join(_servo(s) for s in now.servos_not_ok) or "all ok",
        "bus": ", ".join(f"{k.replace('_', ' ')} {v}" for k, v in now.bus_info.items() if v != ""),
        "up": f"{now.uptime_s:.0f} s",
    }
    table = Table(show_header=False, box=None)
    for key, value in rows.items():
        table.add_row(f"[bold]{key}[/bold]", value)
    Console().print(table)
    return exit_status


def gaze_words(yaw_deg: float, pitch_deg: float) -> str:
    """Direction of the head in words: "30 degrees left, 10 down"."""
    sides = ((yaw_deg, "left", "right"), (pitch_deg, "down", "up"))
    named = [f"{abs(angle):g} degrees {one if angle > 0 else other}" for angle, one, other in sides if angle]
    return ", ".join(named) or "straight ahead"


def _needs(now: StateEvent) -> str:
    """The commands that lead out of a state, in their order."""
    if now.state in ("fault", "estop"):
        return " (needs `mmmd reset`, then `mmmd arm`)"
    return " (needs `mmmd arm`)" if now.must_arm else ""


def _servo(servo: ServoHealth) -> str:
    """A servo that is not ok, with its counters."""
    counted = ", ".join(f"{n} {text}" for name, text in _COUNTED.items() if (n := getattr(servo, name)))
    return f"{servo.id} ({servo.joint}) {servo.state}{f': {counted}' if counted else ''}"


def _stream(now: StateEvent) -> str:
    """The socket for joint targets, and the holder of its lease."""
    if now.stream is None:
        return "-"
    bad = f"; refused: {', '.join(f'{n} {code}' for code, n in now.stream.bad.items())}" if now.stream.bad else ""
    lease = now.stream.lease
    if lease is None:
        return f"{now.stream.endpoint}, no lease{bad}"
    held = f", held by {lease.held_by}" if lease.held_by else ""
    who = f"{lease.state} by {lease.holder or 'somebody'}"
    return f"{now.stream.endpoint}, {who} (lease {lease.id[:8]}), {lease.targets} targets{held}{bad}"
