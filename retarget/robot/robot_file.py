"""Reads a robot file, a TOML beside an MJCF or URDF, and converts degrees to radians.

Every key is checked on reading; an error names the key, the value found and the values allowed. A robot that was read has two
properties: every pose inside the joints' limits lies inside the range of every servo, and no joint that keeps its speed limit needs
more than `velocity_margin` of a servo's no-load speed.
"""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import msgspec

from retarget.errors import RobotFileError
from retarget.robot.bounds import require_bounds
from retarget.robot.drives import read_drives, refuse_beyond_servo, servo_of, with_speeds
from retarget.robot.robot import DIRECTIONS, ROLES, BusSettings, JointSpec, PointSpec, RobotModel
from retarget.robot.tables import FORMAT, JointTable, MotionTable, RobotTable, keys_at, walk
from retarget.robot.ticks import JointServoMap

MOST_RAD = 6.3
"""Degrees: if no joint's limit is larger, the file is taken to be written in radians and is refused; of one joint it is doubted."""


def read_robot_file(path: Path, blanks: bool = False) -> RobotModel:
    """The robot of a file; `blanks` accepts a file in which servo ids or models are still blank.

    Raises:
        RobotFileError: the file has a wrong key, unit or value, or a blank.
    """
    table = _parse(path)
    description = path.parent / table.description
    if not description.is_file():
        raise RobotFileError(path, "description", f"no file '{table.description}'", "an MJCF or URDF beside the TOML")
    _check_whole(path, table)
    drives = read_drives(path, table)
    missing = tuple(key for d in drives for key in d.blanks)
    if missing and not blanks:
        raise RobotFileError(
            path, missing[0], f"blank, one of {len(missing)}", "0 to 252 for an id, a servo model's name for a model; "
            "`mmmd robot check` lists all blanks",
        )  # fmt: skip
    joints = tuple(_joint(path, i, j, table.motion) for i, j in enumerate(table.joint))
    servos = tuple(servo_of(path, d, table, n) for n, d in enumerate(drives))
    for servo, drive in zip(servos, drives, strict=True):
        refuse_beyond_servo(path, drive.limits_key(table), servo, joints)
    joints = with_speeds(path, table, joints, servos)
    _refuse_doubles(path, "servo.id", [str(s.servo_id) for s in servos if s.servo_id >= 0])
    bus = BusSettings(table.bus.protocol, table.bus.baud, table.bus.rate_hz)
    points = tuple(
        (name, PointSpec(p.body, p.offset_m))
        for name, p in msgspec.structs.asdict(table.points).items()
        if p is not None
    )
    robot = RobotModel(
        table.name, joints, servos, bus, description, path, table.licence, table.frame.forward, table.frame.up, points,
        missing,
    )  # fmt: skip
    _refuse_no_room(path, robot)
    return robot


def _refuse_no_room(path: Path, robot: RobotModel) -> None:
    """Refuse a joint whose range contains no whole tick of its servos."""
    low, high = JointServoMap(robot).position_range_rad
    for joint, room_rad in zip(robot.joints, (high - low).tolist(), strict=True):
        if not room_rad > 0:
            found = f"[{math.degrees(joint.position_min_rad):g}, {math.degrees(joint.position_max_rad):g}]"
            raise RobotFileError(
                path, f"joint '{joint.name}': position_limit_deg", found, "a range of more than two ticks of its servos"
            )


def _parse(path: Path) -> RobotTable:
    try:
        raw = tomllib.loads(path.read_text("utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise RobotFileError(path, "file", f"not TOML ({error})", "TOML 1.0 in UTF-8") from error
    for where, key, value in walk(raw):
        if "_rad" in key:
            right = key.replace("_rad", "_deg")
            raise RobotFileError(path, f"{where}{key}", "radians", f"degrees in this file: '{right}'")
        if isinstance(value, float) and not math.isfinite(value):
            raise RobotFileError(path, f"{where}{key}", str(value), "a finite number")
    require_bounds(path, raw)
    try:
        return msgspec.convert(raw, RobotTable)
    except msgspec.ValidationError as error:
        message, _, where = str(error).partition(" - at `$")
        raise RobotFileError(path, where.strip("`.") or "file", message, keys_at(where)) from error


def _check_whole(path: Path, table: RobotTable) -> None:
    """Check the keys that do not depend on servos."""
    if table.format != FORMAT:
        raise RobotFileError(path, "format", str(table.format), str(FORMAT))
    if not table.joint:
        raise RobotFileError(path, "joint", "none", "at least one [[joint]]")
    if table.bus.protocol not in (1.0, 2.0):
        raise RobotFileError(path, "bus.protocol", str(table.bus.protocol), "1.0 or 2.0")
    forward, up = table.frame.forward, table.frame.up
    for key, value in (("forward", forward), ("up", up)):
        if value not in DIRECTIONS:
            raise RobotFileError(path, f"frame.{key}", repr(value), ", ".join(DIRECTIONS))
    if forward[-1] == up[-1]:
        raise RobotFileError(path, "frame", f"forward '{forward}' and up '{up}'", "two different axes")
    reach = max(abs(end) for j in table.joint for end in j.position_limit_deg)
    if reach <= MOST_RAD:
        found = f"no limit beyond {reach:g} degrees: these look like radians"
        raise RobotFileError(path, "joint position_limit_deg", found, "degrees")
    _refuse_doubles(path, "name", [j.name for j in table.joint])
    _refuse_doubles(path, "role", [j.role for j in table.joint])


def _joint(path: Path, i: int, j: JointTable, motion: MotionTable) -> JointSpec:
    """A joint without its speed limit, which depends on its servos."""
    key = f"joint[{i}] '{j.name}'"
    low, high = j.position_limit_deg
    if not (-720 <= low < high <= 720):
        raise RobotFileError(path, f"{key}: position_limit_deg", f"[{low}, {high}]", "[low, high], low < high, degrees")
    if j.role not in ROLES:
        raise RobotFileError(path, f"{key}: role", repr(j.role), ", ".join(ROLES))
    for field, value in (("rest_deg", j.rest_deg), ("park_deg", j.park_deg)):
        if not low <= value <= high:
            raise RobotFileError(path, f"{key}: {field}", str(value), f"within position_limit_deg [{low}, {high}]")
    speed, acceleration = j.velocity_limit_deg_s, j.acceleration_limit_deg_s2 or motion.acceleration_limit_deg_s2
    return JointSpec(
        j.name, j.role, math.radians(low), math.radians(high), math.nan if speed is None else math.radians(speed),
        math.radians(acceleration), math.radians(j.rest_deg), math.radians(j.park_deg),
    )  # fmt: skip


def _refuse_doubles(path: Path, key: str, values: list[str]) -> None:
    for value in values:
        if values.count(value) > 1:
            raise RobotFileError(path, f"joint {key}", f"'{value}' used {values.count(value)} times", "each once")
