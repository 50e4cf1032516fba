"""`mmmd robot`: which robots there are, and what one is made of."""

from __future__ import annotations

from typing import Annotated, Literal

import tyro


def robot(
    verb: Annotated[Literal["list", "check"], tyro.conf.Positional], name: Annotated[str, tyro.conf.Positional] = ""
) -> int:
    """List the packaged robots, or read one (or your own robot.toml), check it and print its joints and servos.

    Example: mmmd robot check op3

    Args:
        verb: list or check.
        name: a packaged robot, or the path of a robot.toml.
    """
    import numpy as np
    from rich.console import Console
    from rich.table import Table

    from retarget.pipeline import Retargeter
    from retarget.robot import list_robots, load_robot

    console = Console()
    if verb == "list":
        for known in list_robots():
            console.print(known)
        return 0
    model = load_robot(name)
    contact = Retargeter(model).contact
    table = Table(title=f"{model.name}: {model.bus.baud} baud, {model.bus.rate_hz:g} Hz, protocol {model.bus.protocol}")
    for column in ("joint", "role", "range deg", "speed deg/s", "servo", "id", "direction", "gear"):
        table.add_column(column)
    for joint, servo in zip(model.joints, model.servos, strict=True):
        low, high = np.rad2deg([joint.position_min_rad, joint.position_max_rad])
        speed = np.rad2deg(joint.velocity_limit_rad_s)
        table.add_row(
            joint.name, joint.role, f"{low:.0f} to {high:.0f}", f"{speed:.0f}", servo.model.name,
            str(servo.servo_id), f"{servo.direction:+d}", f"{servo.gear_ratio:g}",
        )  # fmt: skip
    console.print(table)
    touching = contact.pairs(model.park_rad)
    for a, b in touching:
        console.print(f"park pose: {a} touches {b}")
    return 1 if touching else 0
