"""`mmmd run` and `mmmd config`: the daemon, and where its settings come from."""

from __future__ import annotations

import logging
import sys
from pathlib import Path
from typing import Annotated, Any, Literal

import tyro


def run(
    robot: str | None = None,
    bus: str | None = None,
    config: Path | None = None,
    log: Path | None = None,
    log_size_mb: float | None = None,
    log_total_mb: float | None = None,
    generator: str | None = None,
    model: Path | None = None,
    model_hash: str | None = None,
    auto_arm: bool = True,
    estop: Literal["cut", "hold"] | None = None,
    idle: Literal["off", "calm", "lively"] | None = None,
    alive: bool = True,
    gestures: Path | None = None,
    motions: Path | None = None,
    cmd: str | None = None,
    ctl: str | None = None,
    pub: str | None = None,
    stream: str | None = None,
    keys: Path | None = None,
    lease_s: float | None = None,
    lease_park_s: float | None = None,
    lease_limp_s: float | None = None,
    metrics: str | None = None,
    http: str | None = None,
    view: bool = False,
    log_json: bool = False,
    quiet: bool = False,
) -> int:
    """Take texts over ZeroMQ and move servos, until SIGTERM or Ctrl-C, which park the robot.

    Every setting can also stand in a TOML file or in the environment (MMMD_ROBOT, ...); `mmmd config show` tells the
    values and where each came from.

    Exit status: 0 after a park, 3 when a fault or e-stop was latched, 1 when it could not start, 2 for bad use.

    Example: mmmd run --robot op3 --bus dxl:///dev/ttyUSB0 --log run.mcap

    Args:
        robot: name of a packaged robot, or path of a robot.toml; reference when nothing says otherwise.
        bus: where the servos are: sim:// or dxl://DEVICE?baud=N (without: the robot file's), several ports with commas
            between them.
        config: TOML file; else $MMMD_CONFIG, ~/.config/mmmd/mmmd.toml, /etc/mmmd/mmmd.toml.
        log: MCAP file to record into, or a folder: then each start has a file of its own, named by the time.
        log_size_mb: a log of this size is ended and the next one begun (NAME.1.mcap, ...); 0 for never.
        log_total_mb: oldest logs of this run are removed beyond so much together; 0 for never.
        generator: endpoint of a generator that runs already (`mmmd generator`); one is started when it is not given.
        model: checkpoint of the generator; the shipped one when it is not given.
        model_hash: beginning of the checkpoint's hash; a generator with another one is not used.
        auto_arm: the first text arms the robot; --no-auto-arm waits for `mmmd arm`.
        estop: what `mmmd estop` does: cut torque (when it is not given), or brake within the limits and hold; a second one cuts.
        idle: small movements while there is nothing to play.
        alive: trunk and head go along with generated gestures, by a few degrees; --no-alive plays them as they were generated.
        gestures: folder of your own gestures; your data folder when it is not given.
        motions: folder in which `edit` looks for files; the current one when it is not given.
        cmd: endpoint of requests.
        ctl: endpoint of stop, estop, reset, arm, park, torque, status.
        pub: endpoint of state and events.
        stream: endpoint of joint targets under a lease; beside `cmd` (four ports on, or PATH.stream) when it is not given.
        keys: folder of CURVE keys (`mmmd keys`): tcp sockets then take allowed clients only, and may be on any address.
        lease_s: a streaming program silent for so long: the robot brakes and holds (0.2 when it is not given).
        lease_park_s: silent for so long: its lease ends and the robot parks (5).
        lease_limp_s: so long in the park pose after that, then limp (2).
        metrics: HOST:PORT of Prometheus metrics, for this machine only (127.0.0.1:9109); none when it is not given.
        http: HOST:PORT of HTTP and WebSocket (127.0.0.1:5880); beyond this machine it takes a token, which is printed.
        view: the web page as well, at --http or http://127.0.0.1:5880.
        log_json: one JSON object a line instead of text.
        quiet: log only warnings.
    """
    given = dict(locals())
    from dataclasses import replace

    from daemon.logs.log_lines import start_logging
    from daemon.settings.sources import config_of, resolve
    from daemon.supervisor.start_checks import log_file, log_path_error
    from daemon.supervisor.supervisor import run as run_daemon

    settings = resolve(_flags(given), config)
    as_json = bool(settings["log_json"].value)
    start_logging("front", level=logging.WARNING if quiet else logging.INFO, as_json=as_json, stamp=True)
    chosen = config_of(settings)
    if settings["robot"].source == "default" and not quiet:
        from daemon.cli.first_look import first_look

        told = ("no --robot: the reference robot", *first_look().lines()[:1], "`mmmd run --help` tells how to choose")
        sys.stderr.write("".join(f"mmmd: {line}\n" for line in told))
    if chosen.log is not None:
        path = log_file(chosen.log)
        chosen = replace(chosen, log=path)
        if problem := log_path_error(path):
            sys.stderr.write(f"mmmd: {problem}\n")
            return 2
    return run_daemon(chosen)


def config(
    verb: Annotated[Literal["show"], tyro.conf.Positional],
    config: Path | None = None,
    json: bool = False,
) -> int:
    """Show every setting of `mmmd run` and where its value comes from: default, file, environment.

    Example: mmmd config show

    Args:
        verb: show.
        config: TOML file; else where `mmmd run` looks.
        json: print one JSON object.
    """
    from daemon.settings.sources import config_of, resolve

    settings = resolve({}, config)
    config_of(settings)
    if json:
        import json as json_module

        rows = {key: {"value": s.value, "source": s.source} for key, s in settings.items()}
        sys.stdout.write(json_module.dumps(rows, default=str) + "\n")
        return 0
    width = max(map(len, settings))
    values = {key: "-" if s.value in (None, "") else str(s.value) for key, s in settings.items()}
    wide = max(map(len, values.values()))
    lines = [f"{key:<{width}}  {values[key]:<{wide}}  {s.source}" for key, s in settings.items()]
    sys.stdout.write("\n".join(lines) + "\n")
    return 0


def _flags(given: dict[str, Any]) -> dict[str, Any]:
    """What was given on the command line; a switch that stands as it is by default was not."""
    flags = {key: value for key, value in given.items() if key not in ("config", "quiet")}
    flags["auto_arm"] = None if given["auto_arm"] else False
    flags["alive"] = None if given["alive"] else False
    flags["log_json"] = True if given["log_json"] else None
    flags["view"] = True if given["view"] else None
    return flags
