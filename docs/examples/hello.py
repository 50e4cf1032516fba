"""A text, its events, and a stop: `mmmd run`, then `python docs/examples/hello.py`. It needs `pip install 'mmmd[client]'` alone.

Right after the start of `mmmd run` the first text waits some seconds for the motion model.
"""

from __future__ import annotations

import argparse
import uuid

from daemon.client import Client
from daemon.client.event_text import describe
from daemon.settings.config import Endpoints
from daemon.wire.events import Done
from daemon.wire.requests import Say


def main() -> int:
    """Say a text, print what becomes of it as it comes, then begin a wave and stop it in the middle; 0 when all of it was done."""
    default = Endpoints.of_environment()
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("cmd", "ctl", "pub"):
        parser.add_argument(f"--{name}", default=getattr(default, name))
    given = parser.parse_args()
    with Client(Endpoints(given.cmd, given.ctl, given.pub)) as robot:
        done = False
        for event in robot.events_of(Say(id=uuid.uuid4().hex, text="wave with your right hand")):
            print(describe(event), flush=True)
            done = isinstance(event, Done)
        if not done:
            return 1
        robot.gesture("wave_right", loop=True, wait=False)
        robot.wait_for("moving", timeout_s=10)
        print("the robot waves again, until it is stopped", flush=True)
        print("stopped, the robot was", robot.stop().state)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
