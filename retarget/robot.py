"""A robot: its joints, limits, servos and bus, read from a short TOML beside an MJCF or URDF.

Angles are degrees in the file and radians here. The file is checked when it is read: every wrong key, unit or value is
named with what is allowed.
"""

from __future__ import annotations

import math
import tomllib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, cast

import msgspec
import numpy as np
from numpy.typing import NDArray

from retarget.errors import RobotFileError, UnknownRobotError
from retarget.servos import ServoModel, servo_models

ROBOTS_DIR = Path(__file__).parent / "robots"
FORMAT = 1
ROLES = (
    "head_yaw", "head_pitch", "waist_yaw", "waist_pitch",
    *(f"{side}_{part}" for side in ("left", "right") for part in
      ("shoulder_pitch", "shoulder_roll", "shoulder_yaw", "elbow", "forearm_yaw", "wrist")),
)  # fmt: skip
"""What a joint is for. Arms of three (pitch, roll, elbow) to six joints are known."""


class _ServoTable(msgspec.Struct, forbid_unknown_fields=True):
    id: int
    model: str
    direction: int = 1
    gear_ratio: float = 1.0
    zero_tick: int = 2048


class _JointTable(msgspec.Struct, forbid_unknown_fields=True):
    name: str
    role: str
    position_limit_deg: tuple[float, float]
    servo: _ServoTable
    rest_deg: float = 0.0
    park_deg: float = 0.0
    velocity_limit_deg_s: float | None = None
    acceleration_limit_deg_s2: float | None = None


class _BusTable(msgspec.Struct, forbid_unknown_fields=True):
    baud: int
    rate_hz: float
    protocol: float = 2.0


class _MotionTable(msgspec.Struct, forbid_unknown_fields=True):
    velocity_margin: float
    acceleration_limit_deg_s2: float


class _RobotTable(msgspec.Struct, forbid_unknown_fields=True):
    format: int
    name: str
    description: str
    licence: str
    bus: _BusTable
    motion: _MotionTable
    joint: list[_JointTable]


@dataclass(frozen=True)
class JointSpec:
    """One joint; see `RobotModel` for the arrays."""

    name: str
    role: str
    position_min_rad: float
    position_max_rad: float
    velocity_limit_rad_s: float
    acceleration_limit_rad_s2: float
    rest_rad: float
    park_rad: float


@dataclass(frozen=True)
class ServoSpec:
    """The servo that drives a joint: tick = zero_tick + direction * gear_ratio * angle * ticks_per_turn / 2 pi."""

    servo_id: int
    joint_name: str
    model: ServoModel
    direction: int
    gear_ratio: float
    zero_tick: int


@dataclass(frozen=True)
class BusSettings:
    """How the robot's servos are reached."""

    protocol: float
    baud: int
    rate_hz: float

    @property
    def period_s(self) -> float:
        """Time between two goals."""
        return 1.0 / self.rate_hz


@dataclass(frozen=True)
class RobotModel:
    """A robot's upper body; joint j is driven by servo j."""

    name: str
    joints: tuple[JointSpec, ...]
    servos: tuple[ServoSpec, ...]
    bus: BusSettings
    description_path: Path
    path: Path
    licence: str

    @property
    def n_joints(self) -> int:
        """Number of joints."""
        return len(self.joints)

    @cached_property
    def joint_names(self) -> tuple[str, ...]:
        """Joint names in order."""
        return tuple(j.name for j in self.joints)

    @cached_property
    def servo_ids(self) -> tuple[int, ...]:
        """Servo ids in the order of the joints."""
        return tuple(s.servo_id for s in self.servos)

    def column(self, field: str) -> NDArray[np.float64]:
        """(J,) values of one field of all joints."""
        return np.array([getattr(j, field) for j in self.joints], np.float64)

    @cached_property
    def position_min_rad(self) -> NDArray[np.float64]:
        """(J,) lower position limits."""
        return self.column("position_min_rad")

    @cached_property
    def position_max_rad(self) -> NDArray[np.float64]:
        """(J,) upper position limits."""
        return self.column("position_max_rad")

    @cached_property
    def velocity_limit_rad_s(self) -> NDArray[np.float64]:
        """(J,) speed limits."""
        return self.column("velocity_limit_rad_s")

    @cached_property
    def acceleration_limit_rad_s2(self) -> NDArray[np.float64]:
        """(J,) acceleration limits."""
        return self.column("acceleration_limit_rad_s2")

    @cached_property
    def rest_rad(self) -> NDArray[np.float64]:
        """(J,) pose after arming."""
        return self.column("rest_rad")

    @cached_property
    def park_rad(self) -> NDArray[np.float64]:
        """(J,) pose in which torque may be cut."""
        return self.column("park_rad")

    def joint_with_role(self, role: str) -> int | None:
        """Index of the joint with `role`, None when the robot has none."""
        return next((i for i, j in enumerate(self.joints) if j.role == role), None)


def list_robots() -> list[str]:
    """Names of the packaged robots."""
    return sorted(p.parent.name for p in ROBOTS_DIR.glob("*/robot.toml"))


def load_robot(name_or_path: str) -> RobotModel:
    """The packaged robot of that name, or the one of a robot.toml (or its folder).

    Raises:
        UnknownRobotError: neither.
        RobotFileError: the file has a wrong key, unit or value.
    """
    path = ROBOTS_DIR / name_or_path / "robot.toml"
    if name_or_path not in list_robots():
        path = Path(name_or_path)
        if path.is_dir():
            path = path / "robot.toml"
        if not path.is_file():
            raise UnknownRobotError(name_or_path, list_robots())
    return _read(path)


def _read(path: Path) -> RobotModel:
    try:
        raw = tomllib.loads(path.read_text("utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise RobotFileError(path, "file", f"not TOML ({error})", "TOML 1.0 in UTF-8") from error
    _refuse_radians(path, raw, "")
    try:
        table = msgspec.convert(raw, _RobotTable)
    except msgspec.ValidationError as error:
        message, _, where = str(error).partition(" - at `$")
        raise RobotFileError(path, where.strip("`.") or "file", message, _allowed_at(where)) from error
    if table.format != FORMAT:
        raise RobotFileError(path, "format", str(table.format), str(FORMAT))
    if not table.joint:
        raise RobotFileError(path, "joint", "none", "at least one [[joint]]")
    description = path.parent / table.description
    if not description.is_file():
        raise RobotFileError(path, "description", f"no file '{table.description}'", "an MJCF or URDF beside the TOML")
    if not 1 <= table.bus.rate_hz <= 1000:
        raise RobotFileError(path, "bus.rate_hz", str(table.bus.rate_hz), "1 to 1000")
    joints = tuple(_joint(path, i, j, table.motion) for i, j in enumerate(table.joint))
    servos = tuple(_servo(path, i, j) for i, j in enumerate(table.joint))
    for i, (joint, servo) in enumerate(zip(joints, servos, strict=True)):
        _refuse_beyond_servo(path, f"joint[{i}] '{joint.name}'", joint, servo)
    _refuse_doubles(path, "name", [j.name for j in joints])
    _refuse_doubles(path, "role", [j.role for j in joints])
    _refuse_doubles(path, "servo.id", [str(s.servo_id) for s in servos])
    bus = BusSettings(table.bus.protocol, table.bus.baud, table.bus.rate_hz)
    return RobotModel(table.name, joints, servos, bus, description, path, table.licence)


def _joint(path: Path, i: int, j: _JointTable, motion: _MotionTable) -> JointSpec:
    key = f"joint[{i}] '{j.name}'"
    low, high = j.position_limit_deg
    if not (-720 <= low < high <= 720):
        raise RobotFileError(path, f"{key}: position_limit_deg", f"[{low}, {high}]", "[low, high], low < high, degrees")
    if j.role not in ROLES:
        raise RobotFileError(path, f"{key}: role", repr(j.role), ", ".join(ROLES))
    for field, value in (("rest_deg", j.rest_deg), ("park_deg", j.park_deg)):
        if not low <= value <= high:
            raise RobotFileError(path, f"{key}: {field}", str(value), f"within position_limit_deg [{low}, {high}]")
    if not 0 < motion.velocity_margin <= 1:
        raise RobotFileError(path, "motion.velocity_margin", str(motion.velocity_margin), "more than 0, at most 1")
    servo_speed = _model(path, key, j.servo.model).no_load_speed_rad_s / abs(j.servo.gear_ratio or 1.0)
    velocity = motion.velocity_margin * servo_speed
    if j.velocity_limit_deg_s is not None:
        velocity = min(velocity, math.radians(j.velocity_limit_deg_s))
    acceleration_deg_s2 = j.acceleration_limit_deg_s2 or motion.acceleration_limit_deg_s2
    if not (velocity > 0 and acceleration_deg_s2 > 0):
        raise RobotFileError(path, key, "a velocity or acceleration limit that is not positive", "more than 0")
    return JointSpec(
        j.name, j.role, math.radians(low), math.radians(high), velocity, math.radians(acceleration_deg_s2),
        math.radians(j.rest_deg), math.radians(j.park_deg),
    )  # fmt: skip


def _refuse_beyond_servo(path: Path, key: str, joint: JointSpec, servo: ServoSpec) -> None:
    """In position mode a servo takes goals of one turn only and refuses the rest."""
    turn = servo.model.ticks_per_turn
    scale = servo.direction * servo.gear_ratio * turn / (2 * math.pi)
    low, high = sorted(servo.zero_tick + scale * q for q in (joint.position_min_rad, joint.position_max_rad))
    if low < 0 or high > turn - 1:
        found = f"reaches servo ticks {low:.0f} to {high:.0f}"
        raise RobotFileError(path, f"{key}: position_limit_deg", found, f"ticks 0 to {turn - 1} of {servo.model.name}")


def _servo(path: Path, i: int, j: _JointTable) -> ServoSpec:
    key, s = f"joint[{i}] '{j.name}': servo", j.servo
    if not 0 <= s.id <= 252:
        raise RobotFileError(path, f"{key}.id", str(s.id), "0 to 252")
    if s.direction not in (1, -1):
        raise RobotFileError(path, f"{key}.direction", str(s.direction), "1 or -1")
    if not s.gear_ratio > 0:
        raise RobotFileError(path, f"{key}.gear_ratio", str(s.gear_ratio), "more than 0; the sign is `direction`")
    return ServoSpec(s.id, j.name, _model(path, key, s.model), s.direction, s.gear_ratio, s.zero_tick)


def _model(path: Path, key: str, name: str) -> ServoModel:
    models = servo_models()
    if name not in models:
        raise RobotFileError(path, f"{key}: model", repr(name), ", ".join(models))
    return models[name]


def _refuse_doubles(path: Path, key: str, values: list[str]) -> None:
    for value in values:
        if values.count(value) > 1:
            raise RobotFileError(path, f"joint {key}", f"'{value}' used {values.count(value)} times", "each once")


def _refuse_radians(path: Path, value: Any, where: str) -> None:
    """A key in radians is a unit mistake worth its own message."""
    if isinstance(value, dict):
        for key, inner in cast(dict[str, Any], value).items():
            if "_rad" in key:
                right = key.replace("_rad", "_deg")
                raise RobotFileError(path, f"{where}{key}", "radians", f"degrees in this file: '{right}'")
            _refuse_radians(path, inner, f"{where}{key}.")
    elif isinstance(value, list):
        for i, inner in enumerate(cast(list[Any], value)):
            _refuse_radians(path, inner, f"{where.rstrip('.')}[{i}].")


def _allowed_at(where: str) -> str:
    struct: type[msgspec.Struct] = _RobotTable
    for part, kind in (("servo", _ServoTable), ("joint", _JointTable), ("bus", _BusTable), ("motion", _MotionTable)):
        if f".{part}" in where:
            struct = kind
            break
    return ", ".join(f.name for f in msgspec.structs.fields(struct))
