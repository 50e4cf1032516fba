"""`mmmd calibrate`: zero positions and ranges of the joints, by hand."""

from __future__ import annotations

import math
import select
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.table import Table

    from daemon.bus.calibration import Ranges
    from retarget.robot import RobotModel

_REFRESH_S = 0.05


def calibrate(
    robot: str = "reference", bus: str = "dxl:///dev/ttyUSB0", out: Path | None = None, limp: bool = False,
    margin_deg: float = 2.0,
) -> int:  # fmt: skip
    """Find every joint's zero position and range by moving the robot by hand, and write them to its file.

    The torque of all servos is cut: hold the robot, or lay it down; --limp says that you have. Then hold it in its zero
    pose and press Enter; move every joint to both ends and press Enter. Joints that were not moved keep their range.

    Example: mmmd calibrate --robot my/robot.toml --bus dxl:///dev/ttyUSB0 --limp --out my/robot.toml

    Args:
        robot: name of a packaged robot, or the path of a robot.toml.
        bus: where its servos are; several ports with commas between them.
        out: file to write; beside the robot's description. Default: calibrated.toml beside the robot's file.
        limp: the robot may go limp now.
        margin_deg: the ranges end so far before the ends that were reached.
    """
    from rich.console import Console
    from rich.live import Live

    from daemon.bus.calibration import calibrate as find
    from daemon.bus.calibration import write_robot_file
    from daemon.bus.multi import open_bus
    from daemon.clock import RealClock
    from daemon.errors import CommandError
    from retarget.robot import load_robot

    if not limp:
        raise CommandError("calibrate cuts the torque of every servo: hold the robot, then add --limp")
    model, clock, console = load_robot(robot), RealClock(), Console()
    path = out or model.path.with_name("calibrated.toml")

    def wait(what: str) -> Callable[[Callable[[], Ranges]], None]:
        def until_enter(follow: Callable[[], Ranges]) -> None:
            console.print(f"[bold]{what}[/bold], then press Enter")
            with Live(console=console, auto_refresh=False, transient=True) as live:
                while not select.select([sys.stdin], [], [], _REFRESH_S)[0]:
                    live.update(_table(model, follow()), refresh=True)
            if not sys.stdin.readline():
                raise CommandError("calibrate: end of input; nothing was written")

        return until_enter

    servo_bus = open_bus(bus, model, clock)
    try:
        servo_bus.verify()
        found = find(
            servo_bus, model, wait_zero=wait("hold the robot in its zero pose"),
            wait_range=wait("move every joint to both of its ends"), margin_deg=margin_deg,
        )  # fmt: skip
    finally:
        servo_bus.close()
    write_robot_file(model, found, path)
    for c in found:
        span = "range kept" if c.low_deg is None else f"{c.low_deg:.1f} to {c.high_deg:.1f} deg"
        console.print(f"{c.joint_name}: zero at tick {c.zero_tick}, {span}{'; ' + c.problem if c.problem else ''}")
    console.print(f"written to {path}")
    return 1 if any(c.problem for c in found) else 0


def _table(model: RobotModel, ranges: Ranges) -> Table:
    from rich.table import Table

    table = Table()
    for column in ("joint", "servo", "tick", "lowest", "highest", "range deg"):
        table.add_column(column, justify="left" if column == "joint" else "right")
    for i, servo in enumerate(model.servos):
        low, high = int(ranges.low[i]), int(ranges.high[i])
        degrees = math.degrees((high - low) / abs(servo.ticks_per_rad))
        table.add_row(
            servo.joint_name, str(servo.servo_id), str(int(ranges.tick[i])), str(low), str(high), f"{degrees:.0f}"
        )
    return table
