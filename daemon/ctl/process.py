"""Entry of the ctl process: it alone stands between a person's e-stop and the bus process.

The ctl process shares no thread, interpreter lock, libzmq context or file descriptor table with the process that serves the
public, and needs none of them: the front may be flooded, frozen or dead. It beats in shared memory; a bus process that misses the
beat for 0.2 s enters an e-stop.
"""

from __future__ import annotations

import argparse
import gc
import logging
import signal
import socket
import sys
import time
from pathlib import Path

import zmq

from daemon.ctl.channel import Channel, Ready
from daemon.ctl.taker import Taker
from daemon.errors import ConfigError
from daemon.host.parent import Parent
from daemon.host.realtime import CONTROL_PRIORITY, lock_memory, take_fifo
from daemon.logs.log_feed import send_logs
from daemon.logs.log_lines import start_logging
from daemon.network.connections import ConnectionGuard, Share
from daemon.network.keys import Doorkeeper, KeyFolder
from daemon.network.sockets import bind
from daemon.settings.config import EndpointInUseError
from daemon.shared_memory.bus_link import BusLink
from daemon.shared_memory.request_words import Asker

log = logging.getLogger(__name__)

SWITCH_S = 0.001
"""Seconds that the doorkeeper's thread keeps the interpreter from the thread that takes e-stops at most."""
SCHED_FIFO = 1
"""Number of the scheduler in sched.h, which ZeroMQ takes."""
SHARE = Share(512, gives_way="oldest")
"""Connections to `ctl`: a newcomer always gets in, in place of the oldest connection, because it may bring an e-stop."""
ORPHAN_CHECK_S = 0.5


def main() -> int:
    """Serve until SIGTERM, or until front and bus process are both gone; returns 1 when the endpoint cannot be bound."""
    parser = argparse.ArgumentParser(description="serves the ctl socket of mmmd; started by `mmmd run`")
    for name in ("--endpoint", "--link"):
        parser.add_argument(name, required=True)
    for name in ("--joints", "--servos", "--channel"):
        parser.add_argument(name, type=int, required=True)
    parser.add_argument("--keys", type=Path)
    arguments = parser.parse_args()
    parent = Parent()
    start_logging("ctl")
    send_logs("ctl")
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches the whole group and is the front's to handle
    link = BusLink.attach(Path(arguments.link), arguments.joints, arguments.servos, asker=Asker.CTL)
    channel = Channel(socket.socket(fileno=arguments.channel))
    context: zmq.Context[zmq.Socket[bytes]] = zmq.Context()
    # The other threads start afterwards and inherit the priority: one of them that waited for a core while it holds the
    # interpreter would make the thread that takes e-stops wait, too.
    fifo = take_fifo(CONTROL_PRIORITY)
    if fifo:  # libzmq aborts where it is not permitted
        context.set(zmq.THREAD_SCHED_POLICY, SCHED_FIFO)
        context.set(zmq.THREAD_PRIORITY, CONTROL_PRIORITY)
    sys.setswitchinterval(SWITCH_S)
    keys = KeyFolder(arguments.keys) if arguments.keys is not None else None
    doorkeeper = Doorkeeper(context, keys) if keys is not None else None
    ctl = context.socket(zmq.ROUTER)
    try:
        bind(ctl, "ctl", arguments.endpoint, keys)
    except ConfigError as error:
        channel.send(Ready(failed=str(error), in_use=isinstance(error, EndpointInUseError)))
        context.destroy(linger=0)
        return 1
    guard = ConnectionGuard({"ctl": (ctl, SHARE)})
    guard.start()
    try:
        if fifo:
            log.info("the ctl process has FIFO priority")
        _serve(Taker(ctl, link, channel, guard), link, channel, parent)
    finally:
        guard.close()
        if doorkeeper is not None:
            doorkeeper.close()
        context.destroy(linger=200)  # the last replies still go out
    return 0


def _serve(taker: Taker, link: BusLink, channel: Channel, parent: Parent) -> None:
    asked_to_end = False

    def end(_number: int, _frame: object) -> None:
        nonlocal asked_to_end
        asked_to_end = True

    signal.signal(signal.SIGTERM, end)
    lock_memory()
    gc.collect()
    gc.freeze()
    link.ctl_beats()
    channel.send(Ready())  # before any request is passed on
    checked_s = time.monotonic()
    while not asked_to_end:
        if time.monotonic() - checked_s > ORPHAN_CHECK_S:
            checked_s = time.monotonic()
            asked_to_end = parent.gone and not link.bus_lives
        taker.turn()  # after the check: a bus process that carried out an e-stop and ended still has it acknowledged
    log.info("ended")


if __name__ == "__main__":
    sys.exit(main())
