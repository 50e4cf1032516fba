"""Servos of a robot file: their couplings to joints through gears, linkages and differentials, and the joints' speeds.

A joint has a servo of its own or several servos, or a differential couples as many servos as joints.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from retarget.errors import RobotFileError
from retarget.robot.linkage import Linkage
from retarget.robot.robot import JointSpec, ServoSpec
from retarget.robot.servos import ServoModel, servo_models
from retarget.robot.tables import BLANK, JointTable, LinkageTable, RobotTable, ServoTable

_UNKNOWN_MODEL = ServoModel(BLANK, 0, 2.0, 4096, 2048, 0, 4095, 5.0, False, True)
"""Placeholder for a servo whose model is still blank, in a file that is only inspected."""
_MOST_CONDITION, _MOST_COUPLING = 1e3, 1000.0
"""Largest condition number and largest coefficient of a differential's inverse; a larger one is taken for a typing mistake."""
_STEEPEST = 50.0
"""Largest ratio of servo and joint speed, and of their inverse, in a linkage; beyond it the linkage is at its dead point."""


@dataclass(frozen=True)
class Drive:
    """A servo of the file: its key, its table, and its couplings as pairs of joint index and coefficient."""

    key: str
    table: ServoTable
    couplings: tuple[tuple[int, float], ...]

    @property
    def blanks(self) -> list[str]:
        """Keys of this servo that are still blank."""
        return [f"{self.key}.{name}" for name in ("id", "model") if getattr(self.table, name) == BLANK]

    def limits_key(self, table: RobotTable) -> str:
        """Key of the position limits of the joints that the servo drives, for error messages."""
        names = " and ".join(f"joint[{i}] '{table.joint[i].name}'" for i, _ in self.couplings)
        return f"{names}: position_limit_deg"


def read_drives(path: Path, table: RobotTable) -> list[Drive]:
    """All servos of a file, in the order of their first joints.

    Raises:
        RobotFileError: a joint has no servo or several kinds of drives, or a differential has no inverse.
    """
    found: list[Drive] = []
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
        found += [Drive(f"{key}: {name}", servo, ((i, 1.0),)) for name, servo in zip(names, own, strict=True)]
    return sorted(found, key=lambda d: d.couplings[0][0])


def _differentials(path: Path, table: RobotTable, found: list[Drive]) -> set[int]:
    """Append the differentials' servos to `found`; returns the indices of the joints that they drive."""
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
        if not square or not _has_inverse(np.array(rows, np.float64)):
            raise RobotFileError(
                path, f"{key}.joint_per_servo", f"{rows} for {len(names)} joints and {len(differential.servos)} servos",
                f"a row for each joint, a column for each servo, with an inverse of numbers up to {_MOST_COUPLING:g}",
            )  # fmt: skip
        servo_per_joint = np.linalg.inv(np.array(rows, np.float64))
        for k, servo in enumerate(differential.servos):
            pairs = zip((index[name] for name in names), servo_per_joint[k].tolist(), strict=True)
            couplings = tuple(sorted((i, float(c)) for i, c in pairs if abs(c) > 1e-12))
            found.append(Drive(f"{key}.servos[{k}]", servo, couplings))
    return taken


def _has_inverse(joint_per_servo: NDArray[np.float64]) -> bool:
    if np.linalg.cond(joint_per_servo) > _MOST_CONDITION:
        return False
    return bool(np.abs(np.linalg.inv(joint_per_servo)).max() <= _MOST_COUPLING)


def servo_of(path: Path, drive: Drive, table: RobotTable, n: int) -> ServoSpec:
    """The specification of the n-th servo.

    Raises:
        RobotFileError: the model, id, direction, mode or linkage is impossible.
    """
    key, s = drive.key, drive.table
    if s.id != BLANK and (isinstance(s.id, str) or not 0 <= s.id <= 252):
        raise RobotFileError(path, f"{key}.id", repr(s.id), "0 to 252")
    if s.direction not in (1, -1):
        raise RobotFileError(path, f"{key}.direction", str(s.direction), "1 or -1")
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
    steepness = np.abs(steps / np.diff(joint_deg))
    if steepness.min() < 1 / _STEEPEST or steepness.max() > _STEEPEST:
        found = f"{steepness.min():g} to {steepness.max():g} degrees of the servo for one of the joint"
        raise RobotFileError(path, key, found, f"{1 / _STEEPEST:g} to {_STEEPEST:g} between any two rows")
    low, high = joint.position_limit_deg
    if joint_deg[0] > low or joint_deg[-1] < high:
        found = f"rows from {joint_deg[0]:g} to {joint_deg[-1]:g} degrees"
        raise RobotFileError(path, key, found, f"rows that cover position_limit_deg [{low:g}, {high:g}]")
    return Linkage.of_table(np.deg2rad(joint_deg), np.deg2rad(servo_deg))


def refuse_beyond_servo(path: Path, key: str, servo: ServoSpec, joints: Sequence[JointSpec]) -> None:
    """Refuse a servo whose range does not cover every pose inside the joints' limits: it would refuse goals outside its range."""
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


def with_speeds(
    path: Path, table: RobotTable, joints: tuple[JointSpec, ...], servos: tuple[ServoSpec, ...]
) -> tuple[JointSpec, ...]:
    """Joints with speed limits that their servos can reach together.

    A joint's own limit holds where it is lower. The joints of a differential that have no limit of their own share equally
    the speed that the other joints leave.
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
