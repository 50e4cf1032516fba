"""`mmmd replay`: a recorded run again, through the same gate."""

from __future__ import annotations

import json as json_module
from pathlib import Path
from typing import Annotated

import tyro


def replay(
    log: Annotated[Path, tyro.conf.Positional],
    bus: str = "sim://",
    robot: str | None = None,
    json: bool = False,
) -> int:
    """Play a log's goals again and say whether the servos received the same ones.

    With sim:// in virtual time, as fast as the machine can; on a real bus at the robot's rate, after a slow way to the
    log's first goal. Exit status 0 when every goal was the same, 1 when not.

    Example: mmmd replay run.mcap --bus sim://

    Args:
        log: an .mcap written by `mmmd run --log`.
        bus: where to play it: sim:// or dxl:///dev/ttyUSB0?baud=1000000.
        robot: name or robot.toml; the log's robot when not given.
        json: print one JSON object.
    """
    import numpy as np
    from rich.console import Console
    from rich.progress import Progress

    from daemon.bus.open import PortContext, open_port
    from daemon.bus.servo_bus import ServoBus
    from daemon.clock import RealClock
    from daemon.mcap_log import read_log
    from daemon.replay import replay as play
    from daemon.shared import BusLink
    from retarget.robot import load_robot
    from retarget.ticks import JointServoMap
    from sim.bus import SimBus
    from sim.clock import VirtualClock
    from sim.port import SimPort

    console = Console()
    found = read_log(log)
    model = load_robot(robot or found.metadata["robot"])
    audit = None
    if bus == "sim://":
        clock = VirtualClock()
        armed = next((c for c in found.cycles if c.torque), found.cycles[0])
        start_rad = JointServoMap(model).tick_to_rad(np.array(armed.goal_tick))
        simulated = SimBus(model, start_rad=start_rad.tolist())
        port, audit = SimPort(simulated, clock), simulated.audit
    else:
        clock = RealClock()
        port = open_port(bus, PortContext(model, clock))
    link = BusLink.create(model.n_joints)
    try:
        with Progress(console=console, disable=json, transient=True) as bar:
            task = bar.add_task("replay", total=sum(c.torque for c in found.cycles))
            servo_bus = ServoBus(port, model.servos, clock)
            result = play(found, model, servo_bus, link, clock, lambda n: bar.update(task, completed=n))
    finally:
        port.close()
        link.close()
    figures = {
        "log": str(log), "robot": model.name, "goals": result.goals, "same": result.same, "identical": result.identical,
        "first_difference": result.first_difference, "log_is_cut": found.is_cut, "audit": audit.report() if audit else None,
    }  # fmt: skip
    if json:
        console.out(json_module.dumps(figures))
    else:
        verdict = "the servos received the same goals" if result.identical else "the servos received OTHER goals"
        console.print(f"{log}: {result.same} of {result.goals} goal sets identical: {verdict}")
        if found.is_cut:
            console.print(f"{found.problem} and played")
        if result.first_difference:
            console.print(f"first difference: {result.first_difference}")
        if audit is not None:
            console.print(f"audit: {audit.report()['violations']} violations in {audit.report()['goals']} goals")
    return 0 if result.identical else 1
