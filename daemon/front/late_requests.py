"""Refuses a request whose sender looked at an old state of the robot: a connection held it back, and nobody expects it now.

No clocks are compared: a state carries the daemon's own time, the sender returns that time with the request, and the daemon looks
at its own clock. A stalled connection thus makes the request old, whatever the sender's clock says. No I/O.
"""

from __future__ import annotations

from daemon.wire.events import Rejected
from daemon.wire.requests import Command, Request, TimelyRequest, Torque, tag_of

OLDEST_STATE_S = 3.0
"""Seconds between a state and the service of a request that names it, at most. States come at least once a second
(`state_rate_hz`), so two seconds are left for both ways of a slow network and for the eye."""
MOST_SHOWN = 60
"""Characters of a command that its refusal repeats, at most."""


def refused_as_late(request: Request, now_s: float, started_s: float) -> Rejected | None:
    """The event of a request that names a state which is too old or of another daemon; None for any other request.

    Args:
        request: a request on `ctl` or `cmd`. A stop or an e-stop names no state and is never refused here; a text that means
            to stop must not come here.
        now_s: the daemon's monotonic clock, seconds.
        started_s: the same clock at the daemon's start.
    """
    state_s = request.state_t_mono if isinstance(request, TimelyRequest) else None
    if not isinstance(state_s, float):
        return None
    if started_s <= state_s and now_s - OLDEST_STATE_S <= state_s <= now_s:
        return None
    if started_s <= state_s < now_s:
        found = f"the newest state that its sender had was {now_s - state_s:.1f} s old when it arrived"
    else:
        when = "before this daemon's start" if state_s < started_s else "a time that is still to come"
        found = f"the newest state that its sender had is from {when}, so from another daemon"
    asked, do = tag_of(request), "not carried out: look at the robot, wait for its newest state, then ask again"
    if isinstance(request, Torque):
        asked = f"torque {'on' if request.on else 'off'}"
        do += "" if request.on else "; `estop` is never refused"
    elif isinstance(request, Command):
        asked += f" {request.words[:MOST_SHOWN]!r}"
    allowed = f"a state of this daemon, at most {OLDEST_STATE_S:g} s old"
    return Rejected(id=request.id, code="stale_state", asked=asked, found=found, allowed=allowed, do=do)
