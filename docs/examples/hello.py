"""A text, its events, and a stop: `mmmd run`, then `python docs/examples/hello.py`. It needs `pip install 'mmmd[client]'` alone."""

from __future__ import annotations

import argparse

from daemon.client import Client
from daemon.settings.config import Endpoints


def main() -> None:
    """Say a text, print what becomes of it, and stop the next one in the middle."""
    default = Endpoints()
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("cmd", "ctl", "pub"):
        parser.add_argument(f"--{name}", default=getattr(default, name))
    given = parser.parse_args()
    with Client(Endpoints(given.cmd, given.ctl, given.pub)) as robot:
        for event in robot.say("wave with your right hand").events:
            print(type(event).__name__.lower())
        robot.gesture("wave_right", loop=True, wait=False)
        print("stopped, the robot was", robot.stop().state)


if __name__ == "__main__":
    main()
