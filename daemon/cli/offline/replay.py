"""`mmmd replay`: plays a recorded run again, through the same gate."""

from __future__ import annotations

import json as json_module
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import tyro

if TYPE_CHECKING:
    from daemon.dynamixel.ports.port import Port
    from daemon.host.clock import Clock
    from daemon.recording.mcap_reading import Log
    from retarget.robot.robot import RobotModel


def replay(
    log: Annotated[Path, tyro.conf.Positional],
    bus: str = "sim://",
    robot: str | None = None,
    json: bool = False,
) -> int:
    """Play a log's goals again and say whether the servos received the same ones.

    With sim:// in virtual time, as fast as the machine can; on a real bus at the robot's rate, after a slow way to the
    log's first goal. Exit status 0 when every goal was the same, bit for bit, 1 when not, 3 after a fault.

    Example: mmmd replay run.mcap --bus sim://

    Args:
        log: an .mcap written by `mmmd run --log`; one that is cut off is played as far as it can be read.
        bus: where to play it: sim:// or dxl:///dev/ttyUSB0?baud=1000000.
        robot: name or robot.toml; the log's robot when not given.
        json: print one JSON object.
    """
    from rich.console import Console
    from rich.progress import Progress

    from daemon.dynamixel.servo_bus import ServoBus
    from daemon.recording.mcap_reading import read_log
    from daemon.recording.replay import check_robot, robot_changed
    from daemon.recording.replay import replay as play
    from daemon.shared_memory.bus_link import BusLink
    from retarget.robot.loading import load_robot

    notes = Console(stderr=True)
    found = read_log(log)
    model = load_robot(robot or found.metadata["robot"])
    check_robot(found, model)
    for warning in (found.problem, robot_changed(found, model)):
        if warning:
            notes.print(f"warning: {warning}", style="yellow", highlight=False, soft_wrap=True)
    port, clock = _open(bus, model, found)
    link = BusLink.create(model.n_joints, model.n_servos)
    try:
        with Progress(console=notes, disable=json, transient=True) as bar:
            task = bar.add_task("replay", total=sum(c.torque for c in found.cycles))
            servo_bus = ServoBus.on_port(port, model.servos, clock)
            result = play(found, model, servo_bus, link, clock, lambda n: bar.update(task, completed=n))
    finally:
        port.close()
        link.close()
    figures = {
        "log": str(log), "robot": model.name, "bus": bus, "goals": result.goals, "same": result.same,
        "identical": result.identical, "first_difference": result.first_difference, "stretches": result.stretches,
        "missing_cycles": result.missing_cycles, "log_is_cut": found.is_cut, "log_problem": found.problem,
        "audit": _audit(port),
    }  # fmt: skip
    sys.stdout.write((json_module.dumps(figures) if json else _told(figures)) + "\n")
    return 0 if result.identical else 1


def _open(bus: str, robot: RobotModel, log: Log) -> tuple[Port, Clock]:
    """The port, and its clock; simulated servos start where those of the log stood."""
    import numpy as np

    from daemon.dynamixel.ports.opening import PortContext, open_port
    from daemon.host.clock import RealClock
    from retarget.robot.ticks import JointServoMap
    from sim.bus import SimBus
    from sim.clock import VirtualClock
    from sim.port import SimPort

    clock = VirtualClock() if bus.startswith("sim:") else RealClock()
    if bus != "sim://":
        return open_port(bus, PortContext(robot, clock)), clock
    first = next((c for c in log.cycles if c.torque), log.cycles[0])
    start_rad = JointServoMap(robot).tick_to_rad(np.array(first.goal_tick))
    return SimPort(SimBus(robot, start_rad=start_rad.tolist()), clock), clock


def _audit(port: Port) -> dict[str, Any] | None:
    """The simulator's audit of the goals that it received; None on a real bus."""
    from sim.port import SimPort

    return port.bus.audit.report() if isinstance(port, SimPort) else None


def _told(figures: dict[str, Any]) -> str:
    """The figures as text."""
    verdict = "the servos received the same goals" if figures["identical"] else "the servos received OTHER goals"
    lines = [f"{figures['log']}: {figures['same']} of {figures['goals']} goal sets identical: {verdict}"]
    if figures["first_difference"]:
        lines.append(f"first difference: {figures['first_difference']}")
    if figures["missing_cycles"]:
        lines.append(f"{figures['missing_cycles']} cycles are missing in the log: a new start behind each gap")
    if figures["audit"] is not None:
        lines.append(f"audit: {figures['audit']['violations']} violations in {figures['audit']['goals']} goals")
    return "\n".join(lines)
