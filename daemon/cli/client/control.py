"""`mmmd stop|estop|reset|arm|park|torque`: the verbs of the `ctl` socket."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Literal

from tyro.conf import OmitArgPrefixes, Positional

from daemon.cli.connection import Connection
from daemon.cli.interrupts import leaving_at_once
from daemon.cli.program import INTERRUPTED
from daemon.client.errors import NoAnswerError
from daemon.wire.showing import in_words

if TYPE_CHECKING:
    from daemon.client import Client
    from daemon.wire.events import Ack


def stop(at: OmitArgPrefixes[Connection] = Connection(), json: bool = False) -> int:  # noqa: B008
    """Brake within the limits, hold, and forget what was planned.

    Example: mmmd stop

    Args:
        at: where the daemon is.
        json: print one JSON object.
    """
    with at.client_to_stop() as robot:
        return _tell(robot, robot.stop(), json)


def estop(at: OmitArgPrefixes[Connection] = Connection(), json: bool = False) -> int:  # noqa: B008
    """Cut torque at once; where the daemon runs with `--estop hold`: brake and hold, and cut at the second one.

    Latched: `mmmd reset`, which makes the robot limp, then `mmmd arm`, lead out of it.

    Example: mmmd estop

    Args:
        at: where the daemon is.
        json: print one JSON object.
    """
    with at.client_to_stop() as robot:
        return _tell(robot, robot.estop(), json)


def reset(at: OmitArgPrefixes[Connection] = Connection(), json: bool = False) -> int:  # noqa: B008
    """Leave e-stop or fault. The robot is limp afterwards and moves only after `mmmd arm`.

    Example: mmmd reset

    Args:
        at: where the daemon is.
        json: print one JSON object.
    """
    with at.client() as robot:
        return _tell(robot, robot.reset(), json)


def arm(at: OmitArgPrefixes[Connection] = Connection(), json: bool = False) -> int:  # noqa: B008
    """Torque on over a goal pinned to the measured pose, then a slow move to the rest pose. Ctrl-C stops the robot.

    Example: mmmd arm

    Args:
        at: where the daemon is.
        json: print one JSON object.
    """
    return _moved(at, "arming", lambda robot: robot.arm(), json)


def park(at: OmitArgPrefixes[Connection] = Connection(), json: bool = False) -> int:  # noqa: B008
    """Move slowly to the park pose, then torque off. Ctrl-C stops the robot.

    Example: mmmd park

    Args:
        at: where the daemon is.
        json: print one JSON object.
    """
    return _moved(at, "parking", lambda robot: robot.park(), json)


def torque(
    which: Positional[Literal["on", "off"]],
    at: OmitArgPrefixes[Connection] = Connection(),  # noqa: B008
    json: bool = False,
) -> int:
    """Off: brake within the limits, then limp where the robot stands: hold its arms. On is `mmmd arm`, and alone leads on.

    Example: mmmd torque off

    Args:
        which: "on" or "off".
        at: where the daemon is.
        json: print one JSON object.
    """
    if which == "on":
        return _moved(at, "arming", lambda robot: robot.arm(), json)
    with at.client() as robot:
        return _tell(robot, robot.torque_off(), json)


OWED = "not carried out yet; it is, as soon as the bus process runs"


def _moved(at: Connection, moving: str, move: Callable[[Client], Ack], json: bool) -> int:
    """Print the result of a verb that moves the robot; Ctrl-C stops the robot before the command ends."""
    try:
        with at.client() as robot:
            return _tell(robot, move(robot), json)
    except KeyboardInterrupt:
        with leaving_at_once(moving):
            sys.stderr.write(f"\nmmmd: {moving} is stopped: the robot brakes; Ctrl-C again leaves at once\n")
            try:
                with at.client() as robot:
                    _tell(robot, robot.stop(), json)
            except NoAnswerError as error:
                sys.stderr.write(f"mmmd: NOT STOPPED, {moving} may go on: {error}\n")
    return INTERRUPTED


def _tell(robot: Client, ack: Ack, json: bool) -> int:
    """Print the result of the verb; return 3 when the robot is in fault or a stop is not carried out yet, 1 when arming failed."""
    after = robot.status()
    owed = ack.carried_out is False and after.state != "estop"
    broken_off = ack.verb == "arm" and after.state == "limp"
    if json:
        from daemon.wire.codec import encode

        sys.stdout.write(encode(after).decode() + "\n")
    else:
        waits = "; ".join(filter(None, (OWED, after.reason))) if owed else ""
        broken = "arming was broken off, see the daemon's log; `mmmd arm` again" if broken_off else ""
        reason = waits or after.reason or broken
        now = ", ".join(filter(None, (in_words(after.state), "" if owed else after.with_torque)))
        told = (
            f"the robot is {now}" if ack.state == after.state else f"the robot was {in_words(ack.state)} and is {now}"
        )
        sys.stdout.write(f"{ack.verb}: {told}{f': {reason}' if reason else ''}\n")
    return 3 if after.state == "fault" or owed else int(broken_off)
