"""Entry of the bus process: privileges, port, loop. `python -m daemon.control.process --robot R --bus URL --link NAME`."""

from __future__ import annotations

import argparse
import logging
import signal
import sys
import threading
import time
from pathlib import Path

from daemon.control.control_loop import ControlLoop
from daemon.control.starting import start
from daemon.dynamixel.bus_opening import open_bus
from daemon.dynamixel.servo_bus import ServoBus
from daemon.host.clock import RealClock
from daemon.host.cores import keep_to
from daemon.host.parent import Parent
from daemon.host.realtime import BUS_PRIORITY, give_back_fifo, lock_memory, take_fifo
from daemon.logs.log_feed import send_logs
from daemon.logs.log_lines import start_logging
from daemon.shared_memory.bus_link import BusLink
from retarget.robot.loading import load_robot

log = logging.getLogger(__name__)

ORPHAN_CHECK_S = 0.5
ORPHAN_END_S = 30.0
"""Seconds for which the bus process lives on without a front: enough to hold, park and end a fault or e-stop with torque."""
SLOW_EVERY = 10
"""Cycles between two readings of slow registers; each reads one servo."""


def main() -> int:
    """Run until a shutdown request; return 0 after that, 1 when the bus could not be opened."""
    parser = argparse.ArgumentParser(description="the bus process of mmmd; started by `mmmd run`")
    for name in ("--robot", "--bus", "--link"):
        parser.add_argument(name, required=True)
    parser.add_argument("--after-loss", action="store_true")
    parser.add_argument("--core", type=int)
    arguments = parser.parse_args()
    parent = Parent()
    start_logging("bus")
    send_logs("bus")
    robot = load_robot(arguments.robot)
    link = BusLink.attach(Path(arguments.link), robot.n_joints, robot.n_servos)
    link.hold()
    clock = RealClock()

    def opened() -> ServoBus:
        return open_bus(arguments.bus, robot, clock, slow_every=SLOW_EVERY)

    locked = lock_memory()  # loading all pages takes long: not between the start and the first cycle
    streamer = start(robot, opened, link, clock, after_loss=arguments.after_loss)
    if streamer is None:
        return 1
    fifo = take_fifo(BUS_PRIORITY)
    link.set_realtime(fifo, locked)
    log.info("FIFO priority %sgranted, locked memory %sgranted", "" if fifo else "not ", "" if locked else "not ")
    if arguments.core is not None and keep_to(arguments.core):
        log.info("keeps to core %d", arguments.core)

    def stop(_number: int, _frame: object) -> None:
        streamer.stopping = True

    # The front parks the robot and then asks for shutdown; Ctrl-C reaches the whole group and is the front's to handle.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, stop)
    threading.Thread(target=_end_with_parent, args=(streamer, parent), daemon=True).start()
    try:
        streamer.run()
    finally:
        give_back_fifo()  # closing takes time: no other robot's bus process shall wait for this one
        streamer.close()
    return 0


def _end_with_parent(streamer: ControlLoop, parent: Parent) -> None:
    """End the loop once the front is gone for good: when the robot is parked, or after `ORPHAN_END_S`."""
    while not parent.gone:
        time.sleep(ORPHAN_CHECK_S)
    orphaned_s = time.monotonic()
    while not streamer.made_limp and time.monotonic() - orphaned_s < ORPHAN_END_S:
        time.sleep(ORPHAN_CHECK_S)
    log.warning("the front is gone; ending with the robot in %s", streamer.state.name)
    streamer.stopping = True


if __name__ == "__main__":
    sys.exit(main())
