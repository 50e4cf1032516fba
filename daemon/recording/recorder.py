"""The recorder: its own process, so that a slow disk never reaches the bus.

The recorder reads cycles from shared memory and events from a bounded queue; those that it is too slow for are dropped and counted.
`python -m daemon.recording.recorder --robot R --link NAME --events ENDPOINT --out F.mcap`
"""

from __future__ import annotations

import argparse
import logging
import signal
import sys
import time
from pathlib import Path

import msgspec
import zmq

from daemon.host.parent import Parent
from daemon.logs.log_feed import send_logs
from daemon.logs.log_lines import start_logging
from daemon.recording.rotation import RotatingLog
from daemon.recording.schemas import DROPPED_TOPIC, Dropped
from daemon.shared_memory.bus_link import N_CYCLES, BusLink
from retarget.robot.loading import load_robot

log = logging.getLogger(__name__)

POLL_S = 0.1
FLUSH_S = 1.0
"""Seconds between two flushes: a kill of the recorder loses as much."""
EVENT_QUEUE = 2000


def main() -> int:
    """Record until SIGTERM or the daemon's death; returns 0 with a finished log, 1 after a disk error (the robot goes on)."""
    parser = argparse.ArgumentParser(description="the recorder of mmmd; started by `mmmd run --log`")
    for name in ("--robot", "--link", "--events", "--out"):
        parser.add_argument(name, required=True)
    for name in ("--size-mb", "--total-mb"):
        parser.add_argument(name, type=float, default=0.0)
    parser.add_argument("--settings", default="", help="of the daemon, as JSON; kept in the log")
    arguments = parser.parse_args()
    parent = Parent()
    start_logging("recorder")
    send_logs("recorder")
    robot = load_robot(arguments.robot)
    link = BusLink.attach(Path(arguments.link), robot.n_joints, robot.n_servos)
    stopping: list[int] = []
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, lambda number, _frame: stopping.append(number))
    context = zmq.Context()
    events = context.socket(zmq.PULL)
    events.setsockopt(zmq.RCVHWM, EVENT_QUEUE)
    events.bind(arguments.events)
    index, flushed_s = max(0, link.cycles.count - N_CYCLES // 2), time.monotonic()  # from the cycles still in the ring
    try:
        bounds = (arguments.size_mb, arguments.total_mb)
        with RotatingLog(Path(arguments.out), robot, *bounds, arguments.settings) as writer:
            while True:
                last_round = bool(stopping) or parent.gone
                events.poll(round(POLL_S * 1e3))  # in the last round for what is still on its way
                records, index, lost = link.cycles.since(index)
                if lost:
                    writer.cycles_dropped += lost
                    log.warning("%d cycles dropped: the disk is too slow", writer.cycles_dropped)
                for record in records:
                    writer.cycle(record)
                for _ in range(EVENT_QUEUE):
                    if not events.poll(0):
                        break
                    topic, payload = events.recv_multipart()
                    writer.event(topic.decode(), payload)
                    if topic.decode() == DROPPED_TOPIC:
                        writer.messages_dropped = msgspec.json.decode(payload, type=Dropped).messages
                if time.monotonic() - flushed_s >= FLUSH_S:
                    flushed_s = time.monotonic()
                    writer.flush()
                if last_round:
                    break
    except OSError as error:
        log.error("recording stopped (%s); the robot goes on without a log", error)
        return 1
    finally:
        events.close(0)
        context.term()
    return 0


if __name__ == "__main__":
    sys.exit(main())
