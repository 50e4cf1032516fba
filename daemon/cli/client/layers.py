"""`mmmd look`, `mmmd idle`, `mmmd cancel`, `mmmd capabilities`: requests that are no motion of their own."""

from __future__ import annotations

import sys
from typing import Annotated, Literal

import tyro
from tyro.conf import OmitArgPrefixes

from daemon.cli.client.status import gaze_words
from daemon.cli.connection import Connection
from daemon.wire.showing import in_words


def look(
    yaw: float | None = None,
    pitch: float | None = None,
    at: OmitArgPrefixes[Connection] = Connection(),  # noqa: B008
) -> int:
    """Turn the head during any motion; without angles the head follows the motion again.

    Example: mmmd look --yaw 30 --pitch -10

    Args:
        yaw: degrees to the left.
        pitch: degrees down.
        at: where the daemon is.
    """
    with at.client() as robot:
        ack = robot.look(yaw, pitch)
    if yaw is None and pitch is None:
        told = "the head is free again"
    else:
        told = f"{gaze_words(yaw or 0.0, pitch or 0.0)}, held until `mmmd look` without angles"
    sys.stdout.write(f"look: {told}{f'; {ack.note}' if ack.note else ''}\n")
    return 0


def idle(
    style: Annotated[Literal["off", "calm", "lively"], tyro.conf.Positional],
    at: OmitArgPrefixes[Connection] = Connection(),  # noqa: B008
) -> int:
    """Play small movements of breath and gaze while no command is played.

    Example: mmmd idle calm

    Args:
        style: off, calm or lively.
        at: where the daemon is.
    """
    with at.client() as robot:
        ack = robot.idle(style != "off", "lively" if style == "lively" else "calm")
    on = "no idle movements any more" if style == "off" else "moves a little while there is nothing to play"
    sys.stdout.write(f"idle {style}: {on}; the robot is {in_words(ack.state)}\n")
    return 0


def cancel(
    command: Annotated[str, tyro.conf.Positional] = "",
    at: OmitArgPrefixes[Connection] = Connection(),  # noqa: B008
) -> int:
    """End a command; the robot brakes within its limits and holds.

    Example: mmmd cancel

    Args:
        command: its id; everything that runs or waits when it is not given.
        at: where the daemon is.
    """
    with at.client() as robot:
        ack = robot.cancel(command)
    sys.stdout.write(f"cancel: ended {command or 'all commands'}; the robot was {in_words(ack.state)}\n")
    return 0


def capabilities(
    at: OmitArgPrefixes[Connection] = Connection(),  # noqa: B008
    json: bool = False,
) -> int:
    """Show what the robot and the daemon can do: joints, requests, options, gestures, topics.

    Example: mmmd capabilities --json

    Args:
        at: where the daemon is.
        json: print one JSON object.
    """
    from daemon.wire.codec import encode

    with at.client() as robot:
        found = robot.capabilities()
    if json:
        sys.stdout.write(encode(found).decode() + "\n")
        return 0
    lines = [
        f"mmmd {found.version}, robot {found.robot}, {len(found.joints)} joints at {found.rate_hz:g} Hz",
        f"generator: {found.generator}",
        f"stream: {found.stream}, lease: {', '.join(f'{k} {v:g}' for k, v in found.lease.items())}",
        *(f"{socket}: {', '.join(names)}" for socket, names in found.requests.items()),
        *(f"topic {topic}: {text}" for topic, text in found.topics.items()),
        *(f"option {name}: {low:g} to {high:g}" for name, (low, high) in found.options.items()),
        f"{len(found.gestures)} gestures (`mmmd gesture list`), idle styles {', '.join(found.idle_styles)}",
    ]
    sys.stdout.write("\n".join(lines) + "\n")
    return 0
