"""`mmmd doctor`: checks of all conditions of a good run."""

from __future__ import annotations

import dataclasses
import json as json_module


def doctor(robot: str = "reference", bus: str = "dxl:///dev/ttyUSB0", fix: bool = False, json: bool = False) -> int:
    """Check rights, adapter, servos, their settings and the rate; every finding comes with the exact remedy.

    Nothing moves. With --fix the servos' return delay, status return level, operating mode, drive mode, startup
    configuration, shutdown mask and position limits are set as the robot file needs them; torque must be off. Exit status 1
    when something does not work.

    Example: mmmd doctor --robot op3 --bus "dxl:///dev/ttyUSB0?baud=2000000"
    and then: mmmd doctor --robot op3 --bus "dxl:///dev/ttyUSB0?baud=2000000" --fix

    Args:
        robot: name of a packaged robot, or the path of a robot.toml.
        bus: where its servos are; several ports with commas between them.
        fix: correct what can be corrected.
        json: print one JSON object.
    """
    from rich.console import Console

    from daemon.cli.tables import table_of
    from daemon.dynamixel.bus_opening import open_ports
    from daemon.dynamixel.ports.opening import PortContext
    from daemon.dynamixel.setup.doctor import ADVICE, BAD, GOOD, diagnose
    from daemon.host.clock import RealClock
    from retarget.robot.loading import load_robot

    model, clock, console = load_robot(robot), RealClock(), Console()
    diagnosis = diagnose(model, lambda: open_ports(bus, PortContext(model, clock)), clock, correct=fix)
    if json:
        checks = [dataclasses.asdict(c) for c in diagnosis.checks]
        console.out(json_module.dumps({"bad": diagnosis.bad, "checks": checks, "budget": diagnosis.budget}))
        return int(diagnosis.bad)
    colours = {GOOD: "green", ADVICE: "yellow", BAD: "red"}
    table = table_of(("", "what", "found", "remedy"), ("",), f"{model.name} on {bus}")
    for c in diagnosis.checks:
        table.add_row(f"[{colours[c.verdict]}]{c.verdict}[/]", c.what, c.found, c.remedy)
    console.print(table)
    for line in diagnosis.budget:
        console.out(f"  {line}")
    return int(diagnosis.bad)
