"""Stream a sine to one joint under a lease, beside `mmmd run`: `python stream_sine.py [JOINT] [SECONDS] [CMD CTL PUB]`.

The daemon keeps every limit and keeps the robot off itself; this program has to keep sending, and to be polite when the
robot is taken from it.
"""

import math
import sys
import time

from daemon.client import CancelledByError, Client, RefusedError
from daemon.settings.config import Endpoints

RATE_HZ, AMPLITUDE_RAD, SWING_HZ = 50, 0.3, 0.5


def main(joint: str = "", seconds: str = "5", *endpoints: str) -> int:
    """Swing a joint about where it stands; 0 when the robot was ours to the end."""
    with Client(Endpoints(*endpoints)) as robot:
        try:
            with robot.stream("sine example") as stream:
                now = robot.status()
                joint = joint or now.joint_names[0]
                middle_rad = now.goal_rad[now.joint_names.index(joint)]
                began_s = time.monotonic()
                while (t_s := time.monotonic() - began_s) < float(seconds):
                    swing = math.sin(2 * math.pi * SWING_HZ * t_s)
                    stream.send({joint: middle_rad + AMPLITUDE_RAD * swing})
                    time.sleep(1 / RATE_HZ)
        except (RefusedError, CancelledByError) as ended:
            sys.stderr.write(f"{ended}\n")
            return 1
    sys.stdout.write(f"{stream.news.end}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
