"""The record of a robot: joints, limits, servos and bus, with angles in radians; `robot_file` reads it from a file."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from retarget.robot.linkage import Linkage
from retarget.robot.servos import ServoModel

_ARM_PARTS = (
    "shoulder_pitch", "shoulder_roll", "shoulder_yaw", "elbow", "forearm_yaw", "wrist", "wrist_pitch", "wrist_roll",
)  # fmt: skip
ROLES = (
    "head_yaw", "head_pitch", "head_roll", "waist_yaw", "waist_pitch", "waist_roll",
    *(f"{side}_{part}" for side in ("left", "right") for part in _ARM_PARTS),
)  # fmt: skip
"""Roles of joints. Joints that follow no human joint (wrists) rest."""
POINTS = ("left_wrist", "right_wrist", "head", "chest")
"""Names of the points that retargeting and pictures need: sites of the description, or [points] of the robot file."""
DIRECTIONS = {
    "x": (1.0, 0.0, 0.0), "-x": (-1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "-y": (0.0, -1.0, 0.0), "z": (0.0, 0.0, 1.0),
    "-z": (0.0, 0.0, -1.0),
}  # fmt: skip


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
    """A servo and the joints that move it.

    tick = zero_tick + direction * gear_ratio * a * ticks_per_turn / 2 pi, where a is the linkage's angle for the sum of
    coupling * joint angle; without a linkage the sum itself, and for most servos the angle of its one joint.

    Attributes:
        servo_id: id on the bus; negative while the robot file still has a blank there.
        joint_name: its joint, or its joints joined by "+".
        model: facts of the model.
        direction: 1 or -1.
        gear_ratio: turns of the servo for one of the joint.
        zero_tick: tick at angle 0.
        couplings: (joint index, coefficient) of each joint that moves it.
        min_tick: first goal that the servo accepts, or that the mechanics allow where the file has a limit.
        max_tick: last goal that the servo accepts, or that the mechanics allow.
        extended: whether it runs in extended position mode, of many turns.
        linkage: rods between servo and joint, None when there are none.
    """

    servo_id: int
    joint_name: str
    model: ServoModel
    direction: int
    gear_ratio: float
    zero_tick: int
    couplings: tuple[tuple[int, float], ...]
    min_tick: int
    max_tick: int
    extended: bool = False
    linkage: Linkage | None = None

    @classmethod
    def direct(cls, servo_id: int, joint_name: str, model: ServoModel, joint_idx: int = 0) -> ServoSpec:
        """A servo on a joint of its own, straight and in position mode."""
        zero = model.zero_tick
        return cls(servo_id, joint_name, model, 1, 1.0, zero, ((joint_idx, 1.0),), model.min_tick, model.max_tick)

    @property
    def ticks_per_rad(self) -> float:
        """Signed ticks per radian of the servo's angle after couplings and linkage."""
        return self.direction * self.gear_ratio * self.model.ticks_per_turn / (2 * np.pi)


@dataclass(frozen=True)
class BusSettings:
    """Protocol, baud rate and cycle rate of the robot's servo bus."""

    protocol: float
    baud: int
    rate_hz: float

    @property
    def period_s(self) -> float:
        """Seconds between two goals."""
        return 1.0 / self.rate_hz


@dataclass(frozen=True)
class PointSpec:
    """A point fixed to a body of the description, `offset_m` in the body's own axes."""

    body: str
    offset_m: tuple[float, float, float]


@dataclass(frozen=True)
class RobotModel:
    """A robot's upper body of J joints and S servos.

    Attributes:
        forward, up: the description's axes that point ahead and up, keys of `DIRECTIONS`.
        points: named points that the description itself has no site for.
        blanks: keys that the owner has not filled in yet; empty unless read by `load_robot(..., blanks=True)`.
    """

    name: str
    joints: tuple[JointSpec, ...]
    servos: tuple[ServoSpec, ...]
    bus: BusSettings
    description_path: Path
    path: Path
    licence: str
    forward: str = "x"
    up: str = "z"
    points: tuple[tuple[str, PointSpec], ...] = ()
    blanks: tuple[str, ...] = ()

    @property
    def n_joints(self) -> int:
        return len(self.joints)

    @property
    def n_servos(self) -> int:
        """Number of servos, larger than that of joints where several servos drive a joint."""
        return len(self.servos)

    @cached_property
    def joint_names(self) -> tuple[str, ...]:
        return tuple(j.name for j in self.joints)

    @cached_property
    def servo_ids(self) -> tuple[int, ...]:
        """Servo ids in order; servos stand in the order of their first joints."""
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
        """(J,) pose in which torque may be switched off."""
        return self.column("park_rad")

    def joint_with_role(self, role: str) -> int | None:
        """Index of the joint with `role`; None when the robot has no such joint."""
        return next((i for i, j in enumerate(self.joints) if j.role == role), None)
