"""`mmmd calibrate`: zero positions and ranges of the joints, by hand."""

from __future__ import annotations

import math
import select
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from daemon.dynamixel.setup.calibration import Calibrated, Ranges
    from retarget.robot.robot import RobotModel

_REFRESH_S = 0.05


def calibrate(
    robot: str = "reference", bus: str = "dxl:///dev/ttyUSB0", out: Path | None = None, limp: bool = False,
    margin_deg: float = 2.0, picture: Path | None = None, yes: bool = False,
) -> int:  # fmt: skip
    """Find every joint's zero position and range by moving the robot by hand, and write them to its file.

    The torque of all servos is cut: hold the robot, or lay it down; --limp says that you have. The zero pose is described in
    words and drawn: hold the robot in it and press Enter; move every joint to both ends and press Enter. Joints that were not
    moved keep their range. A zero that is more than 15 degrees from the robot file's, and a joint that was not moved, are
    asked about before anything is written; a file that is there is copied first.

    Example: mmmd calibrate --robot my/robot.toml --bus dxl:///dev/ttyUSB0 --limp --out my/robot.toml

    Args:
        robot: name of a packaged robot, or the path of a robot.toml.
        bus: where its servos are; several ports with commas between them.
        out: file to write; beside the robot's description. Default: calibrated.toml beside the robot's file.
        limp: the robot may go limp now.
        margin_deg: the ranges end so far before the ends that were reached.
        picture: PNG of the zero pose to draw; zero_pose.png beside the file that is written when not given.
        yes: write without a question.
    """
    import numpy as np
    from rich.console import Console
    from rich.live import Live

    from daemon.dynamixel.bus_opening import open_bus
    from daemon.dynamixel.setup.calibration import MARGIN_S, write_robot_file
    from daemon.dynamixel.setup.calibration import calibrate as find
    from daemon.errors import CommandError
    from daemon.host.clock import RealClock
    from daemon.pictures.picture_files import check_picture
    from daemon.pictures.robot_picture import Pose, robot_picture
    from retarget.robot.loading import load_robot
    from retarget.robot.pose_words import pose_in_words

    if picture is not None:
        check_picture(picture, "--picture")
    if not limp:
        raise CommandError("calibrate cuts the torque of every servo: hold the robot, then add --limp")
    model, clock, console = load_robot(robot), RealClock(), Console()
    path = out or model.path.with_name("calibrated.toml")
    picture = picture or path.with_name("zero_pose.png")
    zero_rad = np.zeros(model.n_joints)

    def wait(what: str) -> Callable[[Callable[[], Ranges]], None]:
        def until_enter(follow: Callable[[], Ranges]) -> None:
            console.print(f"[bold]{what}[/bold], then press Enter")
            with Live(console=console, auto_refresh=False, transient=True) as live:
                while not select.select([sys.stdin], [], [], _REFRESH_S)[0]:
                    live.update(_table(model, follow()), refresh=True)
            if not sys.stdin.readline():
                raise CommandError("calibrate: end of input; nothing was written")

        return until_enter

    servo_bus = open_bus(bus, model, clock, margin_s=MARGIN_S)
    try:
        servo_bus.verify()
        robot_picture(model, [Pose(f"{model.name}: zero pose, front and left", zero_rad)], picture)
        console.print(f"the zero pose of {model.name} (drawn in {picture}):", highlight=False, soft_wrap=True)
        for line in pose_in_words(model, zero_rad):
            console.print(f"  {line}", highlight=False, soft_wrap=True)
        found = find(
            servo_bus, model, wait_zero=wait("hold the robot in its zero pose"),
            wait_range=wait("move every joint to both of its ends"), margin_deg=margin_deg,
        )  # fmt: skip
    finally:
        servo_bus.close()
    for c in found:
        span = "range kept" if c.low_deg is None else f"{c.low_deg:.1f} to {c.high_deg:.1f} deg"
        said = f"{c.joint_name}: zero at tick {c.zero_tick} ({c.off_deg:+.1f} deg from the file's), {span}"
        console.print(f"{said}{'; ' + c.problem if c.problem else ''}", highlight=False, soft_wrap=True)
    doubts = [c for c in found if c.doubt and not c.problem]
    if doubts and not yes and not _confirmed(console, doubts):
        console.print("nothing was written")
        return 1
    copy = write_robot_file(model, found, path)
    if copy is not None:
        console.print(f"the file that was there is kept as {copy}", highlight=False, soft_wrap=True)
    console.print(f"written to {path}", highlight=False, soft_wrap=True)
    return 1 if any(c.problem for c in found) else 0


def _confirmed(console: Console, doubts: Sequence[Calibrated]) -> bool:
    """Whether a person wants doubtful results to be written.

    Raises:
        CommandError: standard input is no terminal, so no one can be asked.
    """
    from daemon.errors import CommandError

    for c in doubts:
        console.print(f"[yellow]{c.joint_name}: {c.doubt}[/yellow]", highlight=False, soft_wrap=True)
    console.print(
        "was the robot in the zero pose? Write this all the same? (yes or no)", highlight=False, soft_wrap=True
    )
    answer = sys.stdin.readline()
    if not answer:
        raise CommandError(
            "calibrate: end of input before an answer; nothing was written; --yes writes without a question"
        )
    return answer.strip().lower() in ("y", "yes")


def _table(model: RobotModel, ranges: Ranges) -> Table:
    from daemon.cli.tables import table_of

    columns = ("joint", "servo", "tick", "lowest", "highest", "range deg")
    table = table_of(columns, ("joint", "servo"), right=columns[1:])
    for i, servo in enumerate(model.servos):
        low, high = int(ranges.low[i]), int(ranges.high[i])
        degrees = math.degrees((high - low) / abs(servo.ticks_per_rad))
        table.add_row(
            servo.joint_name, str(servo.servo_id), str(int(ranges.tick[i])), str(low), str(high), f"{degrees:.0f}"
        )
    return table
