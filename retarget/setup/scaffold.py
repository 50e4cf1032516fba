"""Writes a robot file for a description: detected values, and blanks for values that only the owner knows."""

from __future__ import annotations

import os
import textwrap
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from retarget.errors import RobotFileError
from retarget.pipeline import Retargeter
from retarget.robot.loading import load_robot
from retarget.robot.servos import servo_models
from retarget.robot.tables import BLANK
from retarget.setup.anatomy import Anatomy, FoundJoint
from retarget.setup.limb_detection import find_anatomy
from retarget.setup.standing_pose import standing_pose

Array = NDArray[np.float64]
_UNLIMITED_DEG = (-90.0, 90.0)
_HAND_ACCELERATION_M_S2 = 12.0
"""Metres per second squared of the hand at the end of a straight arm: about the limit of the reference robot's arms."""
_CLEAR_M = 0.015
_OUTWARD = (0.15, 0.25, 0.35, 0.5, 0.7, 1.0)
"""Metres outwards per metre down of hanging arms, tried in this order until the arms are clear of the body."""


@dataclass(frozen=True)
class Proposal:
    """A proposed robot file and the findings behind it.

    Attributes:
        text: the TOML.
        anatomy: joints, points and notes.
        blanks: keys that only the owner can fill in.
    """

    text: str
    anatomy: Anatomy
    blanks: tuple[str, ...]


def propose(description: Path, robot_file: Path, servo: str = BLANK) -> Proposal:
    """Detect the anatomy of a description and write `robot_file`.

    Args:
        description: path of an MJCF or URDF.
        robot_file: path of the TOML; the path of the description in it is relative to this file.
        servo: model of all servos; a blank if they differ.

    Raises:
        RobotFileError: no arms in the description, or an unknown servo model.
    """
    if servo != BLANK and servo not in servo_models():
        raise RobotFileError(robot_file, "servo model", repr(servo), ", ".join(servo_models()))
    anatomy = find_anatomy(description)
    writer = _Writer(anatomy, robot_file, servo)
    robot_file.parent.mkdir(parents=True, exist_ok=True)
    robot_file.write_text(writer.text({}), "utf-8")
    robot = load_robot(str(robot_file), blanks=True)
    try:
        rest = _hanging(Retargeter(robot))
    except RobotFileError as error:
        writer.notes.append(f"rest and park pose are 0: {error.key}: {error.found}")
        rest = np.clip(np.zeros(robot.n_joints), robot.position_min_rad, robot.position_max_rad)
    text = writer.text(dict(zip(robot.joint_names, np.rad2deg(rest).tolist(), strict=True)))
    robot_file.write_text(text, "utf-8")
    found = replace(anatomy, notes=(*anatomy.notes, *writer.notes))
    return Proposal(text, found, load_robot(str(robot_file), blanks=True).blanks)


def _hanging(retargeter: Retargeter) -> Array:
    """(J,) pose with the arms down and a little outwards and the elbows a little bent, clear of the body if possible."""
    q = retargeter.robot.rest_rad
    for outward in _OUTWARD:
        q = standing_pose(retargeter, (0.0, outward, -1.0), (0.25, outward, -1.0))
        if retargeter.contact.clearance_m(q[None])[0] >= _CLEAR_M:
            break
    return q


class _Writer:
    """Writes the text of the file and collects its decisions in `notes`."""

    def __init__(self, anatomy: Anatomy, robot_file: Path, servo: str) -> None:
        self._anatomy, self._file, self._servo = anatomy, robot_file, servo
        self.notes: list[str] = []
        self._guessed: list[str] = []

    def text(self, rest_deg: dict[str, float]) -> str:
        """The whole TOML."""
        self.notes, self._guessed = [], []
        anatomy = self._anatomy
        model = servo_models().get(self._servo)
        protocol = 2.0 if model is None else model.protocol
        name = self._file.parent.resolve().name if self._file.name == "robot.toml" else self._file.stem
        description = os.path.relpath(anatomy.path.resolve(), self._file.parent.resolve()).replace(os.sep, "/")
        lines = [
            f'# Robot file for {anatomy.path.name}. Angles in degrees. What only you know stands as "?".',
            *(f"# {note}" for note in _wrapped(anatomy.notes)),
            "format = 1",
            f'name = "{name}"',
            f'description = "{description}"',
            'licence = "yours"',
            "",
            "[bus]",
            f"protocol = {protocol}",
            "baud = 1000000      # what your servos are set to",
            f"rate_hz = {100 if protocol == 2.0 else 50}",
            "",
            "[motion]",
            "velocity_margin = 0.9             # share of each servo's no-load speed: a loaded joint is slower",
            f"acceleration_limit_deg_s2 = {self._acceleration()}  # a start; lower it for heavy arms",
            "",
            "[frame]  # which of the description's axes look ahead and up",
            f'forward = "{anatomy.forward}"',
            f'up = "{anatomy.up}"',
        ]
        for point, place in anatomy.points.items():
            lines += ["", f"[points.{point}]", f'body = "{place.body}"', f"offset_m = {list(place.offset_m)}"]
        for joint in anatomy.joints:
            lines += ["", *self._joint(joint, rest_deg.get(joint.name, 0.0))]
        if self._guessed:
            ends = f"{_UNLIMITED_DEG[0]:g} to {_UNLIMITED_DEG[1]:g}"
            self.notes.append(f"no range in the description, so {ends} degrees is a guess: {', '.join(self._guessed)}")
        return "\n".join(lines) + "\n"

    def _joint(self, joint: FoundJoint, rest_deg: float) -> list[str]:
        low, high = joint.range_deg or _UNLIMITED_DEG
        low, high = (float(end) + 0.0 for end in (np.ceil(low * 10 - 1e-3) / 10, np.floor(high * 10 + 1e-3) / 10))
        remark = ""
        if joint.range_deg is None:
            remark = "  # ? the description has no range: a guess, measure it"
            self._guessed.append(joint.name)
        rest = float(np.clip(round(rest_deg), low, high)) + 0.0
        sense = {1: "the usual sense", -1: "against the usual sense", 0: "see its axis"}[joint.sign]
        axis = ", ".join(f"{v + 0.0:.2f}" for v in np.round(joint.axis, 2))
        return [
            "[[joint]]",
            f'name = "{joint.name}"',
            f'role = "{joint.role}"  # axis ({axis}); positive: {sense}',
            f"position_limit_deg = [{low:g}, {high:g}]{remark}",
            f"rest_deg = {rest:g}",
            f"park_deg = {rest:g}",
            f"servo = {self._servo_table(joint, low, high)}  # direction: try it, 1 or -1",
        ]

    def _servo_table(self, joint: FoundJoint, low_deg: float, high_deg: float) -> str:
        gear, direction = joint.gear or (1.0, 1)
        keys = [f'id = "{BLANK}"', f'model = "{self._servo}"', f"direction = {direction}"]
        if gear != 1.0:
            keys.append(f"gear_ratio = {gear:g}")
        model = servo_models().get(self._servo)
        turn, zero, first, last = (4096, 2048, 0, 4095) if model is None else (
            model.ticks_per_turn, model.zero_tick, model.min_tick, model.max_tick
        )  # fmt: skip
        ends = sorted(direction * gear * end * turn / 360 for end in (low_deg, high_deg))
        if zero + ends[0] < first or zero + ends[1] > last:
            if ends[1] - ends[0] <= last - first:
                keys.append(f"zero_tick = {round((first + last) / 2 - sum(ends) / 2)}")
            elif model is None or model.has_extended:
                keys.append("extended = true")
            else:
                self.notes.append(f"{joint.name}: its range is more than {self._servo} can turn; narrow it")
        return "{ " + ", ".join(keys) + " }"

    def _acceleration(self) -> int:
        """Acceleration limit in degrees/s^2 from the length of the arm, so that hands on arms of all lengths accelerate alike."""
        reach = max(self._anatomy.reach_m, 0.1)
        return int(np.clip(round(np.rad2deg(_HAND_ACCELERATION_M_S2 / reach), -2), 300, 3000))


def _wrapped(notes: tuple[str, ...], width: int = 116) -> list[str]:
    return [line for note in notes for line in textwrap.wrap(note, width, subsequent_indent="  ")]
