"""`mmmd sim`: a robot's simulated servos behind a real tty; or the replay of a log on them."""

from __future__ import annotations

import json as json_module
import logging
import signal
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from retarget.robot.robot import RobotModel


def sim(
    robot: str | None = None,
    link: Path | None = None,
    port: tuple[str, ...] = (),
    faults: Path | None = None,
    audit: Path | None = None,
    baud: int | None = None,
    body: str = "plain",
    latency_ms: str = "0",
    pieces: str = "",
    turnaround_us: float = 0.0,
    factory: bool = False,
    replay: Path | None = None,
    json: bool = False,
) -> int:
    """Serve simulated servos on a tty until Ctrl-C, then print the audit of every goal they received.

    Anything that opens a serial port can talk to them: mmmd, dynamixel-sdk, rustypot, the DYNAMIXEL Wizard.
    Exit status 1 when a goal broke a limit, or led the robot into itself, as told or in the body.
    What is modelled and what is not: docs/simulator.md.

    Example: mmmd sim --robot op3 --link ./servos --body mujoco
    and then: mmmd run --robot op3 --bus "dxl://./servos"

    Example: mmmd sim --robot reference --port ./left=1-8 ./right=9-16 --faults faults.toml --latency-ms 1
    Example: mmmd sim --replay run.mcap --body mujoco --json

    Args:
        robot: name of a packaged robot, or the path of a robot.toml; "reference" when neither this nor a log names one.
        link: path that will point to the tty; without it the tty's own path is printed.
        port: several ports in place of --link, each LINK=IDS with ids as in 1-4,7.
        faults: TOML file of [[fault]] tables, see docs/simulator.md: drop, corrupt, delay, unplug, overload, ...
        audit: file to write the audit to, as JSON.
        baud: what the servos are set to, what the robot's file says by default; at another baud they stay silent.
        body: "plain" (each shaft for itself) or "mujoco" (gravity, inertia, contact, stops).
        latency_ms: latency timer of the adapter: 16 for an FTDI as it comes, 1 when set, 0 for a native UART.
        pieces: cut what is read into pieces of LEAST-MOST bytes.
        turnaround_us: what a servo takes to answer, besides its return delay.
        factory: servos as from the box, but for their ids: 57600 baud, 500 us return delay.
        replay: play the goals of this log to the servos, in no time, and compare where they go with where the log's went.
        json: with --replay: figures as JSON.
    """
    from rich.console import Console

    from daemon.host.realtime import BUS_PRIORITY, take_fifo
    from retarget.robot.loading import load_robot
    from sim.faults import FaultSchedule
    from sim.options import world_of

    if replay is not None:
        return _compare(replay, robot, body, as_json=json)
    console = Console()
    logging.basicConfig(level=logging.INFO, format="%(levelname)s %(message)s")
    model = load_robot(robot or "reference")
    schedule = FaultSchedule.load(faults) if faults else None
    world = world_of(model, schedule, body, factory=factory)
    servers = _servers(model, world, link, port, (latency_ms, pieces, turnaround_us), 57_600 if factory else baud)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda _number, _frame: [server.stop() for server in servers])
    for server in servers:
        where = f"{server.link} -> {server.device}" if server.link else server.device
        console.print(
            f"{len(server.bus.on_wire)} servos of '{model.name}' at {server.baud} baud on {where}", highlight=False
        )
    others = [threading.Thread(target=server.serve) for server in servers[1:]]
    if not take_fifo(BUS_PRIORITY):  # real servos have processors of their own; the other threads inherit the priority
        console.print("no real-time priority: on a busy machine the servos answer late (`mmmd doctor` has the remedy)")
    try:
        for thread in others:
            thread.start()
        servers[0].serve()
    finally:
        for server in servers:
            server.stop()
        for thread in others:
            thread.join()
        for server in servers:
            server.close()
    report = world.audit.report() | {
        "faults": dict(world.faults.struck),
        "collisions": sum(server.bus.wire.collisions for server in servers),
        "overrun_bytes": sum(server.overruns for server in servers),
    }
    console.out(json_module.dumps(report))
    if audit is not None:
        audit.write_text(json_module.dumps(report, indent=1))
    return 1 if any(report[broken] for broken in ("violations", "self_contacts", "led_contacts")) else 0


def _servers(
    robot: RobotModel,
    world: Any,
    link: Path | None,
    ports: tuple[str, ...],
    wire: tuple[str, str, float],
    baud: int | None,
) -> list[Any]:
    """One tty for all servos, or one for each group of them."""
    from sim.bus import SimBus
    from sim.errors import SimSettingError
    from sim.options import servo_ids_of, wire_settings
    from sim.pty import PtyServer

    settings = wire_settings(wire[0], wire[1], turnaround_us=wire[2])
    if not ports:
        return [PtyServer(SimBus(robot, world=world, wire=settings), link, baud)]
    parts = {Path(name): servo_ids_of(ids, robot) for name, _, ids in (text.partition("=") for text in ports)}
    seen = [servo_id for ids in parts.values() for servo_id in ids]
    if link is not None or len(set(seen)) < len(seen) or len(parts) < len(ports):
        raise SimSettingError("--port", " ".join(ports), "each link and each servo once, and no --link beside it")
    if len(parts) > 1 and any(fault.path is not None for fault in world.faults.faults):
        raise SimSettingError(
            "path of an unplug fault", "several ports", "one port: two cannot come back under one link"
        )
    return [
        PtyServer(SimBus(robot, world=world, wire=settings, servo_ids=ids), path, baud) for path, ids in parts.items()
    ]


def _compare(path: Path, robot: str | None, body: str, *, as_json: bool) -> int:
    """Replay a log on simulated servos; print the differences from the logged positions."""
    import dataclasses
    import sys

    import numpy as np

    from daemon.recording.mcap_reading import read_log
    from daemon.recording.replay import check_robot, stretches
    from retarget.robot.loading import load_robot
    from sim.replay import Stretch, compare

    log = read_log(path)
    model = load_robot(robot or log.metadata["robot"])
    check_robot(log, model)
    rows = [
        Stretch(
            np.array([(c.t_mono_ns - cycles[0].t_mono_ns) * 1e-9 for c in cycles]),
            np.array([c.goal_tick for c in cycles], np.int64),
            np.array([c.present_tick for c in cycles], np.int64),
        )
        for cycles in stretches(log)
    ]
    found = compare(rows, model, body)
    if as_json:
        figures = dataclasses.asdict(found) | {
            "log": str(path),
            "robot": model.name,
            "body": body,
            "rms_deg": found.rms_deg,
        }
        sys.stdout.write(json_module.dumps(figures) + "\n")
        return 0
    lines = [f"{path}: {found.seconds:.1f} s with torque in {found.stretches} stretches, body '{body}'"]
    lines += [
        f"  servo {s.servo_id:>3} {s.joint_name:<22} apart {s.rms_deg:6.2f} deg rms, {s.max_deg:6.2f} most;"
        f" lag {_ms(s.lag_logged_ms)} in the log, {_ms(s.lag_simulated_ms)} here"
        for s in found.servos
    ]
    lines.append(f"all servos: {found.rms_deg:.2f} deg rms; {found.refused_goals} goals refused")
    sys.stdout.write("\n".join(lines) + "\n")
    return 0


def _ms(value: float | None) -> str:
    return "   -   " if value is None else f"{value:3.0f} ms "
