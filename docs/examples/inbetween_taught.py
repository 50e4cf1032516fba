"""From one taught pose to another and back, beside `mmmd run`: `python docs/examples/inbetween_taught.py arm_out arm_up`.

Teach the poses first, on the robot's own machine (docs/teaching.md):

    mmmd gesture teach arm_out --pose
    mmmd gesture teach arm_up --pose
    mmmd arm

What lies between the poses is generated: people do not move along straight lines, and a text may say how they go there.
"""

from __future__ import annotations

import argparse

from daemon.client import Client, RefusedError
from daemon.settings.config import Endpoints
from daemon.wire.requests import KeyPoseOf


def main() -> int:
    """Go through the poses; 0 when the robot has met them."""
    default = Endpoints.of_environment()
    parser = argparse.ArgumentParser(description="a way between two taught poses")
    parser.add_argument("first", help="gesture whose pose is met at 2 s")
    parser.add_argument("second", help="gesture whose pose is met at 4 s")
    parser.add_argument("--text", default="", help="what happens between them, in English")
    for name in ("cmd", "ctl", "pub"):
        parser.add_argument(f"--{name}", default=getattr(default, name))
    given = parser.parse_args()
    poses = [
        KeyPoseOf(at_s=2.0, gesture=given.first),
        KeyPoseOf(at_s=4.0, gesture=given.second),
        KeyPoseOf(at_s=6.0, gesture=given.first),
    ]
    with Client(Endpoints(given.cmd, given.ctl, given.pub)) as robot:
        taught = sorted(gesture.name for gesture in robot.capabilities().gestures if gesture.own)
        try:
            done = robot.inbetween(poses, given.text).done
        except RefusedError as refused:
            print(f"{refused}; your own gestures: {', '.join(taught) or 'none'}")
            return 1
        assert done is not None, "a motion that is waited for has ended"
        print(f"{given.first}, {given.second} and {given.first} again in {done.duration_s:.1f} s")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
