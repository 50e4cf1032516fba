"""`mmmd sim`: a robot's servos, simulated, behind a real tty."""

from __future__ import annotations

import json as json_module
import signal
from pathlib import Path


def sim(
    robot: str = "reference",
    link: Path | None = None,
    faults: Path | None = None,
    audit: Path | None = None,
    baud: int = 1_000_000,
) -> int:
    """Serve simulated servos on a tty until Ctrl-C, then print the audit of every goal they received.

    Anything that opens a serial port can talk to them: mmmd, dynamixel-sdk, the DYNAMIXEL Wizard.
    Exit status 1 when a goal broke a limit.

    Example: mmmd sim --robot op3 --link ./servos
    and then: mmmd run --robot op3 --bus "dxl://./servos?baud=1000000"

    Args:
        robot: name of a packaged robot, or the path of a robot.toml.
        link: path that will point to the tty; without it the tty's own path is printed.
        faults: TOML file with [[fault]] tables: kind (drop, corrupt, silent, trip, unplug), start_s, end_s,
            probability, servo_id.
        audit: file to write the audit to, as JSON.
        baud: what the servos are set to; at another baud they stay silent.
    """
    from rich.console import Console

    from retarget.robot import load_robot
    from sim.bus import SimBus
    from sim.faults import FaultSchedule
    from sim.pty import PtyServer

    console = Console()
    model = load_robot(robot)
    bus = SimBus(model, FaultSchedule.load(faults) if faults else None)
    server = PtyServer(bus, link, baud)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda _number, _frame: server.stop())
    where = f"{link} -> {server.device}" if link else server.device
    console.print(f"{model.n_servos} servos of '{model.name}' at {baud} baud on {where}", highlight=False)
    try:
        server.serve()
    finally:
        server.close()
    report = bus.audit.report()
    console.out(json_module.dumps(report))
    if audit is not None:
        audit.write_text(json_module.dumps(report, indent=1))
    return 1 if report["violations"] or report["self_contacts"] else 0
