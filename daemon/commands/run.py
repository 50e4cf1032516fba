"""`mmmd run`: the daemon."""

from __future__ import annotations

import logging
import sys
from pathlib import Path
from typing import Literal

from daemon.config import Endpoints

_DEFAULT = Endpoints()


def run(
    robot: str = "reference",
    bus: str = "sim://",
    log: Path | None = None,
    generator: str | None = None,
    model: Path | None = None,
    auto_arm: bool = True,
    idle: Literal["off", "calm", "lively"] = "off",
    gestures: Path | None = None,
    cmd: str = _DEFAULT.cmd,
    ctl: str = _DEFAULT.ctl,
    pub: str = _DEFAULT.pub,
    keys: Path | None = None,
    model_hash: str = "",
    quiet: bool = False,
) -> int:
    """Take texts over ZeroMQ and move servos, until SIGTERM or Ctrl-C, which park the robot.

    Exit status: 0 after a park, 3 when a fault or e-stop was latched, 1 when it could not start, 2 for bad use.

    Example: mmmd run --robot op3 --bus "dxl:///dev/ttyUSB0?baud=1000000" --log run.mcap

    Args:
        robot: name of a packaged robot, or path of a robot.toml.
        bus: where the servos are: sim:// or dxl://DEVICE?baud=N.
        log: MCAP file to record into.
        generator: endpoint of a generator that runs already (`mmmd generator`); one is started when it is not given.
        model: checkpoint of the generator; the shipped one when it is not given.
        auto_arm: the first text arms the robot; --no-auto-arm waits for `mmmd arm`.
        idle: small movements while there is nothing to play.
        gestures: folder of your own gestures; your data folder when it is not given.
        cmd: endpoint of requests.
        ctl: endpoint of stop, estop, reset, arm, park, status.
        pub: endpoint of state and events.
        keys: folder of CURVE keys (`mmmd keys`): tcp sockets then take allowed clients only, and may be on any address.
        model_hash: beginning of the checkpoint's hash; a generator with another one is not used.
        quiet: log only warnings.
    """
    from daemon.config import DaemonConfig
    from daemon.supervisor import log_path_error
    from daemon.supervisor import run as run_daemon

    logging.basicConfig(
        level=logging.WARNING if quiet else logging.INFO, format="%(asctime)s %(message)s", datefmt="%H:%M:%S"
    )
    if log is not None and (problem := log_path_error(log)):
        sys.stderr.write(f"mmmd: {problem}\n")
        return 2
    endpoints = Endpoints(cmd, ctl, pub, keys)
    return run_daemon(
        DaemonConfig(
            robot,
            bus,
            endpoints,
            log,
            generator=generator,
            model=model,
            auto_arm=auto_arm,
            idle=idle,
            gestures=gestures,
            model_hash=model_hash,
        )
    )
