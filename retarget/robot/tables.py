"""The keys of a robot file with their types, which msgspec checks before `robot_file` checks the values."""

from __future__ import annotations

from typing import Any, cast

import msgspec

FORMAT = 1
BLANK = "?"
"""Placeholder for a value that only the robot's owner knows."""


class LinkageTable(msgspec.Struct, forbid_unknown_fields=True):
    """Angles of joint and servo, row by row."""

    joint_deg: list[float]
    servo_deg: list[float]


class ServoTable(msgspec.Struct, forbid_unknown_fields=True):
    """A servo of a joint or of a differential."""

    id: int | str
    model: str
    direction: int = 1
    gear_ratio: float = 1.0
    zero_tick: int | None = None
    extended: bool = False
    position_limit_deg: tuple[float, float] | None = None
    linkage: LinkageTable | None = None


class JointTable(msgspec.Struct, forbid_unknown_fields=True):
    """A joint with one `servo`, with `servos` when several drive it, or with neither in a differential."""

    name: str
    role: str
    position_limit_deg: tuple[float, float]
    servo: ServoTable | None = None
    servos: list[ServoTable] = []
    rest_deg: float = 0.0
    park_deg: float = 0.0
    velocity_limit_deg_s: float | None = None
    acceleration_limit_deg_s2: float | None = None


class DifferentialTable(msgspec.Struct, forbid_unknown_fields=True):
    """A group of as many servos as joints that move each other: joint angles = joint_per_servo @ servo angles."""

    joints: list[str]
    servos: list[ServoTable]
    joint_per_servo: list[list[float]]


class BusTable(msgspec.Struct, forbid_unknown_fields=True):
    """Protocol, baud rate and cycle rate of the servo bus."""

    baud: int
    rate_hz: float
    protocol: float = 2.0


class MotionTable(msgspec.Struct, forbid_unknown_fields=True):
    """Bounds that hold for all joints."""

    velocity_margin: float
    acceleration_limit_deg_s2: float


class FrameTable(msgspec.Struct, forbid_unknown_fields=True):
    """Axes of the description that point ahead and up."""

    forward: str = "x"
    up: str = "z"


class PointTable(msgspec.Struct, forbid_unknown_fields=True):
    """A point on a body, at an offset in the body's axes."""

    body: str
    offset_m: tuple[float, float, float] = (0.0, 0.0, 0.0)


class PointTables(msgspec.Struct, forbid_unknown_fields=True):
    """The points that retargeting and pictures need."""

    left_wrist: PointTable | None = None
    right_wrist: PointTable | None = None
    head: PointTable | None = None
    chest: PointTable | None = None


class RobotTable(msgspec.Struct, forbid_unknown_fields=True):
    """The whole file."""

    format: int
    name: str
    description: str
    licence: str
    bus: BusTable
    motion: MotionTable
    joint: list[JointTable]
    differential: list[DifferentialTable] = []
    frame: FrameTable = msgspec.field(default_factory=FrameTable)
    points: PointTables = msgspec.field(default_factory=PointTables)


_PARTS: tuple[tuple[str, type[msgspec.Struct]], ...] = (
    ("linkage", LinkageTable), ("servo", ServoTable), ("differential", DifferentialTable), ("joint", JointTable),
    ("bus", BusTable), ("motion", MotionTable), ("frame", FrameTable), ("points.", PointTable), ("points", PointTables),
)  # fmt: skip


def keys_at(where: str) -> str:
    """The keys allowed at a place of the file, given in msgspec's notation (`$.joint[0].servo.id`)."""
    struct = next((kind for part, kind in _PARTS if f".{part}" in where), RobotTable)
    return ", ".join(f.name for f in msgspec.structs.fields(struct))


def walk(value: Any, where: str = "") -> list[tuple[str, str, Any]]:
    """(place, key, value) of every key of a parsed TOML, nested keys included; items of arrays have the place `key[i]`."""
    found: list[tuple[str, str, Any]] = []
    if isinstance(value, dict):
        for key, inner in cast(dict[str, Any], value).items():
            found.append((where, key, inner))
            found += walk(inner, f"{where}{key}.")
    elif isinstance(value, list):
        for i, inner in enumerate(cast(list[Any], value)):
            place = f"{where.rstrip('.')}[{i}]"
            found += walk(inner, f"{place}.") if isinstance(inner, (dict, list)) else [(place, "", inner)]
    return found
