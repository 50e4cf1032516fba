"""Reads a robot file: a TOML beside an MJCF or URDF. Degrees there, radians here.

Everything is checked as it is read: a wrong key, unit or value is named with what was found and what is allowed. What
holds after that: every pose inside the joints' limits lies inside the range of every servo, and no joint moving within
its speed limit needs more than `velocity_margin` of any servo's no-load speed.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import msgspec
import numpy as np

from retarget.errors import RobotFileError
from retarget.linkage import Linkage
from retarget.robot import DIRECTIONS, ROLES, BusSettings, JointSpec, PointSpec, RobotModel, ServoSpec
from retarget.robot_tables import (
    BLANK,
    FORMAT,
    JointTable,
    LinkageTable,
    MotionTable,
    RobotTable,
    ServoTable,
    keys_at,
    walk,
)
from retarget.servos import ServoModel, servo_models

_MOST_RAD = 6.3
"""A file whose joints all end within so many "degrees" was written in radians."""
_UNKNOWN_MODEL = ServoModel(BLANK, 0, 2.0, 4096, 2048, 0, 4095, 5.0, False, True)
"""Stands for a servo whose model is still blank, when the file is only looked at."""


def read_robot_file(path: Path, blanks: bool = False) -> RobotModel:
    """The robot of a file; with `blanks`, also of one that still has some.

    Raises:
        RobotFileError: the file has a wrong key, unit or value, or a blank.
    """
    table = _parse(path)
    description = path.parent / table.description
    if not description.is_file():
        raise RobotFileError(path, "description", f"no file '{table.description}'", "an MJCF or URDF beside the TOML")
    _check_whole(path, table)
    drives = _drives(path, table)
    missing = tuple(key for d in drives for key in d.blanks)
    if missing and not blanks:
        raise RobotFileError(
            path, missing[0], f"blank, one of {len(missing)}", "0 to 252 for an id, a servo model's name for a model; "
            "`mmmd robot check` lists all blanks",
        )  # fmt: skip
    joints = tuple(_joint(path, i, j, table.motion) for i, j in enumerate(table.joint))
    servos = tuple(_servo(path, d, table, n) for n, d in enumerate(drives))
    for servo, drive in zip(servos, drives, strict=True):
        _refuse_beyond_servo(path, drive.limits_key(table), servo, joints)
    joints = _with_speeds(path, table, joints, servos)
    _refuse_doubles(path, "servo.id", [str(s.servo_id) for s in servos if s.servo_id >= 0])
    bus = BusSettings(table.bus.protocol, table.bus.baud, table.bus.rate_hz)
    points = tuple(
        (name, PointSpec(p.body, p.offset_m))
        for name, p in msgspec.structs.asdict(table.points).items()
        if p is not None
    )
    return RobotModel(
        table.name, joints, servos, bus, description, path, table.licence, table.frame.forward, table.frame.up, points,
        missing,
    )  # fmt: skip


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
    try:
        return msgspec.convert(raw, RobotTable)
    except msgspec.ValidationError as error:
        message, _, where = str(error).partition(" - at `$")
        raise RobotFileError(path, where.strip("`.") or "file", message, keys_at(where)) from error


def _check_whole(path: Path, table: RobotTable) -> None:
    """What can be said of the file without its servos."""
    if table.format != FORMAT:
        raise RobotFileError(path, "format", str(table.format), str(FORMAT))
    if not table.joint:
        raise RobotFileError(path, "joint", "none", "at least one [[joint]]")
    if not 1 <= table.bus.rate_hz <= 1000:
        raise RobotFileError(path, "bus.rate_hz", str(table.bus.rate_hz), "1 to 1000")
    if table.bus.protocol not in (1.0, 2.0):
        raise RobotFileError(path, "bus.protocol", str(table.bus.protocol), "1.0 or 2.0")
    if not 0 < table.motion.velocity_margin <= 1:
        raise RobotFileError(
            path, "motion.velocity_margin", str(table.motion.velocity_margin), "more than 0, at most 1"
        )
    forward, up = table.frame.forward, table.frame.up
    for key, value in (("forward", forward), ("up", up)):
        if value not in DIRECTIONS:
            raise RobotFileError(path, f"frame.{key}", repr(value), ", ".join(DIRECTIONS))
    if forward[-1] == up[-1]:
        raise RobotFileError(path, "frame", f"forward '{forward}' and up '{up}'", "two different axes")
    reach = max(abs(end) for j in table.joint for end in j.position_limit_deg)
    if reach <= _MOST_RAD:
        found = f"no limit beyond {reach:g} degrees: these look like radians"
        raise RobotFileError(path, "joint position_limit_deg", found, "degrees")
    _refuse_doubles(path, "name", [j.name for j in table.joint])
    _refuse_doubles(path, "role", [j.role for j in table.joint])


@dataclass(frozen=True)
class _Drive:
    """A servo of the file, where it stands there, and the joints that it moves with."""

    key: str
    table: ServoTable
    couplings: tuple[tuple[int, float], ...]

    @property
    def blanks(self) -> list[str]:
        """Keys of this servo that are blank."""
        return [f"{self.key}.{name}" for name in ("id", "model") if getattr(self.table, name) == BLANK]

    def limits_key(self, table: RobotTable) -> str:
        """Where its joints' position limits stand."""
        names = " and ".join(f"joint[{i}] '{table.joint[i].name}'" for i, _ in self.couplings)
        return f"{names}: position_limit_deg"


def _drives(path: Path, table: RobotTable) -> list[_Drive]:
    """All servos, in the order of their first joints."""
    found: list[_Drive] = []
    coupled = _differentials(path, table, found)
    for i, joint in enumerate(table.joint):
        key = f"joint[{i}] '{joint.name}'"
        own = [*([joint.servo] if joint.servo else []), *joint.servos]
        if i in coupled:
            if own:
                raise RobotFileError(path, key, "a servo of its own and a differential", "one of them")
            continue
        if not own or (joint.servo and joint.servos):
            found_text = "no servo" if not own else "both servo and servos"
            raise RobotFileError(path, key, found_text, "servo = {...}, servos = [{...}, ...], or a [[differential]]")
        names = ["servo"] if joint.servo else [f"servos[{k}]" for k in range(len(own))]
        found += [_Drive(f"{key}: {name}", servo, ((i, 1.0),)) for name, servo in zip(names, own, strict=True)]
    return sorted(found, key=lambda d: d.couplings[0][0])


def _differentials(path: Path, table: RobotTable, found: list[_Drive]) -> set[int]:
    """Add the differentials' servos to `found`; the joints that they drive."""
    index = {joint.name: i for i, joint in enumerate(table.joint)}
    taken: set[int] = set()
    for n, differential in enumerate(table.differential):
        key, names = f"differential[{n}]", differential.joints
        for name in names:
            if name not in index:
                raise RobotFileError(path, f"{key}.joints", f"'{name}'", ", ".join(index))
            if index[name] in taken:
                raise RobotFileError(path, f"{key}.joints", f"'{name}' twice", "each joint in one differential")
            taken.add(index[name])
        rows = differential.joint_per_servo
        square = len(rows) == len(names) == len(differential.servos) and all(len(row) == len(names) for row in rows)
        if not square or abs(np.linalg.det(np.array(rows))) < 1e-6:
            raise RobotFileError(
                path, f"{key}.joint_per_servo", f"{rows} for {len(names)} joints and {len(differential.servos)} servos",
                "a row for each joint, a column for each servo, with an inverse",
            )  # fmt: skip
        servo_per_joint = np.linalg.inv(np.array(rows, np.float64))
        for k, servo in enumerate(differential.servos):
            pairs = zip((index[name] for name in names), servo_per_joint[k].tolist(), strict=True)
            couplings = tuple(sorted((i, float(c)) for i, c in pairs if abs(c) > 1e-12))
            found.append(_Drive(f"{key}.servos[{k}]", servo, couplings))
    return taken


def _joint(path: Path, i: int, j: JointTable, motion: MotionTable) -> JointSpec:
    """A joint without its speed, which depends on its servos."""
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
    if not (acceleration > 0 and (speed is None or speed > 0)):
        raise RobotFileError(path, key, "a velocity or acceleration limit that is not positive", "more than 0")
    return JointSpec(
        j.name, j.role, math.radians(low), math.radians(high), math.nan if speed is None else math.radians(speed),
        math.radians(acceleration), math.radians(j.rest_deg), math.radians(j.park_deg),
    )  # fmt: skip


def _servo(path: Path, drive: _Drive, table: RobotTable, n: int) -> ServoSpec:
    key, s = drive.key, drive.table
    if s.id != BLANK and (isinstance(s.id, str) or not 0 <= s.id <= 252):
        raise RobotFileError(path, f"{key}.id", repr(s.id), "0 to 252")
    if s.direction not in (1, -1):
        raise RobotFileError(path, f"{key}.direction", str(s.direction), "1 or -1")
    if not s.gear_ratio > 0:
        raise RobotFileError(path, f"{key}.gear_ratio", str(s.gear_ratio), "more than 0; the sign is `direction`")
    model = _model(path, key, s.model)
    if s.model != BLANK and model.protocol != table.bus.protocol:
        found = f"{model.name} speaks protocol {model.protocol}, the bus {table.bus.protocol}"
        raise RobotFileError(path, f"{key}.model", found, "one protocol on a bus; MX servos flashed to 2.0 end in '-2'")
    if s.extended and not model.has_extended:
        raise RobotFileError(path, f"{key}.extended", f"{model.name} has no extended position mode", "false")
    zero_tick = model.zero_tick if s.zero_tick is None else s.zero_tick
    low, high = model.tick_range(s.extended)
    if s.position_limit_deg is not None:
        turn = s.direction * model.ticks_per_turn / 360
        ends = sorted(zero_tick + turn * end for end in s.position_limit_deg)
        low, high = max(low, math.ceil(ends[0])), min(high, math.floor(ends[1]))
    name = "+".join(table.joint[i].name for i, _ in drive.couplings)
    linkage = None
    if s.linkage is not None:
        (first, _), *others = drive.couplings
        if others:
            raise RobotFileError(path, f"{key}.linkage", "a linkage in a differential", "one or the other")
        linkage = _linkage(path, f"{key}.linkage", s.linkage, table.joint[first])
    servo_id = s.id if isinstance(s.id, int) else -1 - n
    return ServoSpec(
        servo_id, name, model, s.direction, s.gear_ratio, zero_tick, drive.couplings, low, high, s.extended, linkage
    )  # fmt: skip


def _linkage(path: Path, key: str, table: LinkageTable, joint: JointTable) -> Linkage:
    joint_deg, servo_deg = np.array(table.joint_deg), np.array(table.servo_deg)
    if len(joint_deg) != len(servo_deg) or len(joint_deg) < 3:
        found = f"{len(joint_deg)} joint and {len(servo_deg)} servo angles"
        raise RobotFileError(path, key, found, "as many of each, at least 3")
    steps = np.diff(servo_deg)
    if not (np.diff(joint_deg) > 0).all() or not ((steps > 0).all() or (steps < 0).all()):
        raise RobotFileError(path, key, "angles that do not all rise", "joint_deg rising, servo_deg rising or falling")
    low, high = joint.position_limit_deg
    if joint_deg[0] > low or joint_deg[-1] < high:
        found = f"rows from {joint_deg[0]:g} to {joint_deg[-1]:g} degrees"
        raise RobotFileError(path, key, found, f"rows that cover position_limit_deg [{low:g}, {high:g}]")
    return Linkage.of_table(np.deg2rad(joint_deg), np.deg2rad(servo_deg))


def _refuse_beyond_servo(path: Path, key: str, servo: ServoSpec, joints: Sequence[JointSpec]) -> None:
    """A servo refuses goals outside its range: every pose inside the joints' limits must lie within."""
    least = sum(min(c * joints[i].position_min_rad, c * joints[i].position_max_rad) for i, c in servo.couplings)
    most = sum(max(c * joints[i].position_min_rad, c * joints[i].position_max_rad) for i, c in servo.couplings)
    reach = np.array([least, most])
    if servo.linkage is not None:
        reach = servo.linkage.to_servo(reach)
    low, high = sorted(float(t) for t in servo.zero_tick + servo.ticks_per_rad * reach)
    if math.ceil(low - 1e-9) < servo.min_tick or math.floor(high + 1e-9) > servo.max_tick:  # whole ticks are used
        found = f"reaches servo ticks {low:.0f} to {high:.0f}"
        allowed = f"ticks {servo.min_tick} to {servo.max_tick} of {servo.model.name} (servo {servo.servo_id})"
        raise RobotFileError(path, key, found, allowed)


def _with_speeds(
    path: Path, table: RobotTable, joints: tuple[JointSpec, ...], servos: tuple[ServoSpec, ...]
) -> tuple[JointSpec, ...]:
    """Joints with speeds that their servos can do together.

    A joint's own limit holds where it is lower. What the joints with limits of their own leave of a differential's
    servos is shared equally among its others.
    """
    given = [j.velocity_limit_rad_s for j in joints]
    speed = [math.inf if math.isnan(v) else v for v in given]
    for servo in servos:
        steepest = 1.0 if servo.linkage is None else servo.linkage.steepest
        budget = table.motion.velocity_margin * servo.model.no_load_speed_rad_s / (servo.gear_ratio * steepest)
        own = sum(abs(c) * given[i] for i, c in servo.couplings if not math.isnan(given[i]))
        unset = sum(math.isnan(given[i]) for i, _ in servo.couplings)
        if len(servo.couplings) > 1 and own > budget * (1 - 1e-9 * (not unset)):
            keys = " and ".join(f"'{joints[i].name}'" for i, _ in servo.couplings)
            found = f"the differential would turn a servo at {math.degrees(own):.0f} deg/s"
            raise RobotFileError(
                path, f"{keys}: velocity_limit_deg_s", found, f"at most {math.degrees(budget):.0f} deg/s"
            )
        for i, c in servo.couplings:
            share = (budget - own) / unset if math.isnan(given[i]) else budget
            speed[i] = min(speed[i], share / abs(c))
    return tuple(replace(j, velocity_limit_rad_s=v) for j, v in zip(joints, speed, strict=True))


def _model(path: Path, key: str, name: str) -> ServoModel:
    models = servo_models()
    if name == BLANK:
        return _UNKNOWN_MODEL
    if name not in models:
        raise RobotFileError(path, f"{key}: model", repr(name), ", ".join(models))
    return models[name]


def _refuse_doubles(path: Path, key: str, values: list[str]) -> None:
    for value in values:
        if values.count(value) > 1:
            raise RobotFileError(path, f"joint {key}", f"'{value}' used {values.count(value)} times", "each once")
