"""`mmmd robot`: lists robots, checks and draws one, and makes a new one from its description."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import tyro

if TYPE_CHECKING:
    from retarget.robot.robot import RobotModel
    from retarget.setup.scaffold import Proposal

_NEEDS_NAME = {"new": "the description, an .xml or .urdf", "check": "a robot", "show": "a robot"}


def robot(
    verb: Annotated[Literal["list", "new", "check", "show"], tyro.conf.Positional],
    name: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="[NAME]")] = "",
    out: Path | None = None,
    servo: str = "?",
    text: str = "wave with your right hand",
    seed: int = 0,
) -> int:
    """List the packaged robots; make a robot file from a description; check a robot; draw one.

    `new` finds arms, neck and waist by forward kinematics and writes a commented robot.toml; what only you know (servo
    ids, which way they turn) is left blank. `check` says what is still missing, exit status 1 when anything is. `show`
    draws the rest pose, arms out, and four instants of a gesture.

    Example: mmmd robot new my.urdf --servo XL430-W250 --out my_robot
    then: mmmd robot check my_robot
    then: mmmd robot show my_robot --out my_robot.png

    Args:
        verb: list, new, check or show.
        name: for new the description; else a packaged robot, or the path of a robot.toml or its folder.
        out: for new the folder (beside the description when not given), for show the picture, .png, .svg, .pdf or .jpg (NAME.png).
        servo: for new, the model of all servos when they are alike.
        text: for show, the gesture.
        seed: for show, the gesture's seed.
    """
    from rich.console import Console

    from daemon.errors import CommandError
    from daemon.pictures.picture_files import check_picture
    from retarget.robot.loading import list_robots, load_robot

    console = Console(soft_wrap=True, highlight=False)
    if verb == "list":
        for known in list_robots():
            console.print(known)
        return 0
    if not name:
        raise CommandError(f"mmmd robot {verb} needs {_NEEDS_NAME[verb]}; example: mmmd robot {verb} "
                           + ("my.urdf" if verb == "new" else "reference"))  # fmt: skip
    if verb == "new":
        return _new(console, Path(name), out, servo)
    if verb == "show" and out is not None:
        check_picture(out, "--out")
    model = load_robot(name, blanks=True)
    if verb == "check":
        return _check(console, model)
    return _show(console, model, out or Path(f"{model.name}.png"), text, seed)


def _new(console: Any, description: Path, out: Path | None, servo: str) -> int:
    from daemon.errors import CommandError
    from retarget.setup.scaffold import propose

    if not description.is_file():
        raise CommandError(f"no file {description}; give an MJCF (.xml) or a URDF (.urdf)")
    robot_file = (out or description.parent) / "robot.toml"
    if robot_file.exists():
        raise CommandError(f"{robot_file} is there already; remove it, or choose another folder with --out")
    proposal = propose(description, robot_file, servo)
    _print_found(console, proposal)
    for note in proposal.anatomy.notes:
        console.print(f"note: {note}")
    for blank in proposal.blanks:
        console.print(f"blank: {blank}")
    console.print(f"{robot_file}: written; fill in the blanks, then `mmmd robot check {robot_file.parent}`")
    return 0


def _print_found(console: Any, proposal: Proposal) -> None:
    console.print("found by forward kinematics, axes with x forward, y left, z up:")
    rows = [("joint", "role", "axis", "range deg", "sign")]
    for joint in proposal.anatomy.joints:
        ends = "none" if joint.range_deg is None else f"{joint.range_deg[0]:.0f} to {joint.range_deg[1]:.0f}"
        axis = " ".join(f"{v + 0.0:.2f}" for v in joint.axis)
        rows.append((joint.name, joint.role, axis, ends, {1: "+1", -1: "-1", 0: "?"}[joint.sign]))
    _print_rows(console, rows)


def _print_rows(console: Any, rows: Sequence[tuple[str, ...]]) -> None:
    """Print aligned columns, complete at any width of the terminal."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    for row in rows:
        console.print("  ".join(f"{cell:<{w}}" for cell, w in zip(row, widths, strict=True)).rstrip(), markup=False)


def _check(console: Any, model: RobotModel) -> int:
    import numpy as np

    from retarget.setup.inspection import inspect_robot

    found = inspect_robot(model)
    console.print(f"{model.name}: {model.bus.baud} baud, {model.bus.rate_hz:g} Hz, protocol {model.bus.protocol}")
    rows = [("joint", "role", "range deg", "speed deg/s", "servo", "id", "turns")]
    for i, joint in enumerate(model.joints):
        low, high = np.rad2deg([joint.position_min_rad, joint.position_max_rad])
        servos = [s for s in model.servos if any(j == i for j, _ in s.couplings)]
        rows.append((
            joint.name, joint.role, f"{low:.0f} to {high:.0f}", f"{np.rad2deg(joint.velocity_limit_rad_s):.0f}",
            ", ".join(dict.fromkeys(s.model.name for s in servos)),
            ", ".join("?" if s.servo_id < 0 else str(s.servo_id) for s in servos),
            ", ".join(_turns(s.direction * s.gear_ratio * dict(s.couplings)[i], s.linkage is not None) for s in servos),
        ))  # fmt: skip
    _print_rows(console, rows)
    said, doubts, missing = _bus_time(model)
    if said:
        console.print(said)
    for doubt in (*found.doubts, *doubts):
        console.print(f"look at: {doubt}")
    for lack in (*found.missing, *missing):
        console.print(f"missing: {lack}")
    if not found.missing and not missing:
        console.print("nothing is missing")
    return 1 if found.missing or missing else 0


def _bus_time(model: RobotModel) -> tuple[str, list[str], list[str]]:
    """The time of a cycle on the wire; findings to check; findings that make the rate impossible."""
    from daemon.dynamixel.rate_plan import plan_for
    from daemon.dynamixel.registers.models import MODEL_NUMBERS, MODELS
    from daemon.errors import ConfigError

    strange = sorted({s.model.name for s in model.servos if s.model.name not in MODEL_NUMBERS} - {"?"})
    if strange:
        return "", [f"the bus has no control table of {', '.join(strange)}: `mmmd run` refuses this robot"], []
    if any(s.model.name == "?" for s in model.servos):
        return "", [], []
    plan = plan_for([MODELS[MODEL_NUMBERS[s.model.name]] for s in model.servos], model.bus.baud)
    period_ms = model.bus.period_s * 1e3
    said = f"bus: {plan.certain_s * 1e3:.2f} of {period_ms:.1f} ms a cycle with return delay 0, adapter not counted"
    try:
        plan.require(model.bus.rate_hz)
    except ConfigError as error:
        return said, [], [str(error)]
    return said, [], []


def _turns(ratio: float, linkage: bool) -> str:
    return f"{ratio:+g} by linkage" if linkage else f"{ratio:+.4g}"


def _show(console: Any, model: RobotModel, out: Path, text: str, seed: int) -> int:
    """Draw the robot, with progress on stderr: it takes some seconds, mostly to load the motion model."""
    from rich.console import Console

    with Console(stderr=True).status("loading the motion model for the gesture") as progress:
        from daemon.pictures.robot_picture import Pose, robot_picture
        from mmm_core.generate.engine import Engine
        from retarget.pipeline import Retargeter
        from retarget.setup.standing_pose import standing_pose

        # int8 would need a calibration by more motions than the drawn one
        motion = Engine.load(threads=None, precision="fp32").generate(text, seed=seed).motion
        progress.update(f"fitting {text!r} to {model.name}")
        retargeter = Retargeter(model)
        poses = [
            Pose("rest", model.rest_rad),
            Pose("arms out", standing_pose(retargeter, (0.0, 1.0, 0.0), (0.0, 1.0, 0.0))),
        ]
        if len(motion.joints_m):
            q_rad = retargeter.retarget(motion).q_rad
            for share in (0.2, 0.4, 0.6, 0.8):
                frame = round(share * (len(q_rad) - 1))
                poses.append(Pose(f"{text}, {frame / motion.fps:.1f} s", q_rad[frame]))
        progress.update(f"drawing {len(poses)} poses")
        robot_picture(model, poses, out)
    console.print(f"{out}: drawn")
    return 0
