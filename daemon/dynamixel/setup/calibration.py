"""Zero positions and ranges of a robot's joints, found by moving them by hand with torque off."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daemon.dynamixel.reading import BusReading
from daemon.dynamixel.servo_bus import ServoBus
from daemon.errors import CommandError
from retarget.errors import RobotFileError
from retarget.robot.loading import load_robot
from retarget.robot.robot import RobotModel, ServoSpec

_TRIES = 30
MOVED_TICKS = 100
"""Ticks (9 degrees) below which a movement was not on purpose: the joint's range in the file stays."""
SUSPECT_DEG = 15.0
"""Degrees by which a zero may differ from the robot file's before a person is asked: a horn set one tooth off is 15 at most."""
MOST_OFFSET_TICK = 1024
"""Homing offset, either way, beyond which a servo in position mode ignores it (e-manual, "Homing Offset")."""
MARGIN_S = 0.03
"""Seconds by which an answer may be late during calibration: nothing waits for it, and a busy machine is no brown-out."""


class Ranges:
    """Positions unwrapped over the servos' turn, and the ends that each has reached.

    A servo in position mode reads within one turn: from 4095 the next tick is 0. The steps between two readings are
    short, so the joint has moved the shorter way round.

    Args:
        start_tick: (S,) first reading.
        ticks_per_turn: (S,) of each servo; a servo that does not turn round (AX) never wraps.
    """

    def __init__(self, start_tick: NDArray[np.int32], ticks_per_turn: NDArray[np.int32]) -> None:
        self._turn = ticks_per_turn.astype(np.int64)
        self._last = start_tick.astype(np.int64)
        self.tick = self._last.copy()
        """(S,) unwrapped position: outside of one turn once a servo has passed its wrap."""
        self.low, self.high = self.tick.copy(), self.tick.copy()

    def update(self, tick: NDArray[np.int32], valid: NDArray[np.bool_]) -> None:
        """Add a reading; servos that did not answer keep their position."""
        step = np.where(valid, tick - self._last, 0)
        step = (step + self._turn // 2) % self._turn - self._turn // 2
        self._last[valid] = tick[valid]
        self.tick += step
        np.minimum(self.low, self.tick, out=self.low)
        np.maximum(self.high, self.tick, out=self.high)


@dataclass(frozen=True)
class Calibrated:
    """Result of the calibration for one servo.

    Attributes:
        servo_id: id of the servo.
        joint_name: its joint, or its joints joined by "+".
        zero_tick: its position in the zero pose.
        low_deg, high_deg: range in joint angles; None when the joint was not moved, or is moved by several servos.
        problem: why the result cannot be used unchanged; empty when it can.
        off_deg: difference of the zero from the robot file's, in degrees of the joint.
        moved: whether the servo turned while every joint was to be moved to its ends.
    """

    servo_id: int
    joint_name: str
    zero_tick: int
    low_deg: float | None
    high_deg: float | None
    problem: str = ""
    off_deg: float = 0.0
    moved: bool = True

    @property
    def doubt(self) -> str:
        """Why a person should check the result before it is written; empty without a reason."""
        if abs(self.off_deg) > SUSPECT_DEG:
            was = f"its zero is {abs(self.off_deg):.0f} deg from the robot file's"
            return f"{was}, and it was not moved to its ends" if not self.moved else was
        return "" if self.moved else "it was not moved to its ends: its range stays"


def calibrate(
    bus: ServoBus,
    robot: RobotModel,
    *,
    wait_zero: Callable[[Callable[[], Ranges]], None],
    wait_range: Callable[[Callable[[], Ranges]], None],
    margin_deg: float = 2.0,
) -> list[Calibrated]:
    """Cut the torque of all servos, then follow the joints while a person moves them.

    Args:
        bus: the verified bus.
        robot: the robot.
        wait_zero: returns when the robot is held in its zero pose; calls its argument for each live reading.
        wait_range: returns when every joint has been moved to both of its ends; likewise.
        margin_deg: degrees by which the ranges end before the ends that were reached.

    Raises:
        CommandError: a servo does not answer, or kept its torque.
    """
    bus.write_all("torque_enable", 0)
    turns = np.array([_wrap_ticks(s) for s in robot.servos], np.int32)
    ranges = Ranges(_whole(bus).position_tick, turns)

    def follow() -> Ranges:
        now = bus.exchange(None)
        ranges.update(now.position_tick, now.valid)
        return ranges

    wait_zero(follow)
    ranges.update(_whole(bus).position_tick, np.ones(len(turns), bool))
    zero = ranges.tick.copy()
    ranges.low[:], ranges.high[:] = zero, zero
    wait_range(follow)
    return [_of_servo(robot, i, int(zero[i]), ranges, margin_deg) for i in range(len(robot.servos))]


def _whole(bus: ServoBus) -> BusReading:
    """A reading with values of every servo; repeated, because on a busy machine an answer may come too late for one reading.

    Raises:
        CommandError: a servo does not answer.
    """
    reading = bus.exchange(None)
    for _ in range(_TRIES):
        if reading.valid.all():
            return reading
        reading = bus.exchange(None)
    silent = ", ".join(str(i) for i, ok in zip(bus.ids, reading.valid, strict=True) if not ok)
    raise CommandError(f"servo {silent} does not answer; check cable and power")


def _wrap_ticks(servo: ServoSpec) -> int:
    """Ticks after which a reading wraps; beyond any reading in extended position mode, and on an AX, which ends at 300 degrees."""
    turn = round(servo.model.ticks_per_turn)
    return turn if not servo.extended and servo.model.max_tick - servo.model.min_tick + 1 >= turn else 1 << 30


def _of_servo(robot: RobotModel, i: int, zero: int, ranges: Ranges, margin_deg: float) -> Calibrated:
    servo = robot.servos[i]
    name, wrap = servo.joint_name, _wrap_ticks(servo)
    offset = zero // wrap * wrap  # the zero pose in the servo's own turn
    low, high, zero = int(ranges.low[i]) - offset, int(ranges.high[i]) - offset, zero - offset
    if servo.linkage is not None:
        return Calibrated(servo.servo_id, name, servo.zero_tick, None, None, "moved through rods: set its zero by hand")
    moved = high - low >= MOVED_TICKS
    off_deg = math.degrees(_shortest(zero - servo.zero_tick, wrap) / servo.ticks_per_rad)
    if not moved or not _alone(robot, servo):
        return Calibrated(servo.servo_id, name, zero, None, None, "", off_deg, moved)
    deg_per_tick = math.degrees(1 / servo.ticks_per_rad) / servo.couplings[0][1]
    ends = sorted(((low - zero) * deg_per_tick, (high - zero) * deg_per_tick))
    first, last = servo.model.tick_range(servo.extended)
    problem = ""
    if low < first or high > last:
        middle = round((first + last) / 2 - (low + high) / 2)
        shift = max(-MOST_OFFSET_TICK, min(MOST_OFFSET_TICK, middle))
        problem = f"its range crosses the end of the servo's turn (ticks {low} to {high}): turn the horn"
        if low + shift >= first and high + shift <= last:
            command = f"mmmd servo set {servo.servo_id} homing_offset {shift:+d}"
            problem += f", or {command} added to what is there (beyond {MOST_OFFSET_TICK} in all it is ignored)"
        problem += ", and calibrate again"
    low_deg, high_deg = round(ends[0] + margin_deg, 1), round(ends[1] - margin_deg, 1)
    return Calibrated(servo.servo_id, name, zero, low_deg, high_deg, problem, off_deg)


def _shortest(ticks: int, turn: int) -> int:
    """A difference of ticks by the shorter way round."""
    return (ticks + turn // 2) % turn - turn // 2


def _alone(robot: RobotModel, servo: ServoSpec) -> bool:
    """Whether this servo moves exactly one joint, and no other servo moves that joint."""
    joints = {j for j, _ in servo.couplings}
    return len(joints) == 1 and sum(bool(joints & {j for j, _ in s.couplings}) for s in robot.servos) == 1


def copy_of(file: Path) -> Path | None:
    """Path for the copy of a file before it is overwritten: beside the file, with the first free number; None without a file."""
    if not file.exists():
        return None
    number = 1
    while (copy := file.with_name(f"{file.stem}.before-{number}{file.suffix}")).exists():
        number += 1
    return copy


def write_robot_file(robot: RobotModel, found: list[Calibrated], out: Path) -> Path | None:
    """Write the robot's file with the calibrated zero ticks and ranges; comments and order stay.

    Returns:
        The copy of the file that was there; None when there was none.

    Raises:
        CommandError: the result is no valid robot file (it is not kept).
    """
    text = robot.path.read_text("utf-8")
    for c in found:
        text = _with_zero(text, c)
    blocks = re.split(r"(?m)^(?=\[\[joint\]\])", text)
    ranges = {c.joint_name: c for c in found if c.low_deg is not None and not c.problem}
    for i, block in enumerate(blocks):
        name = re.search(r'(?m)^name\s*=\s*"([^"]*)"', block)
        if block.startswith("[[joint]]") and name is not None and name[1] in ranges:
            blocks[i] = _with_range(block, ranges[name[1]])
    before = out.read_text("utf-8") if out.exists() else ""
    copy = copy_of(out)
    if copy is not None:
        copy.write_text(before, "utf-8")
    out.write_text("".join(blocks), "utf-8")
    try:
        load_robot(str(out))
    except RobotFileError as error:
        if copy is not None:
            copy.replace(out)
        else:
            out.unlink()
        raise CommandError(f"{out} would be no valid robot file: {error}") from error
    return copy


def _with_zero(text: str, c: Calibrated) -> str:
    """The text with the zero tick in the inline table of this servo."""
    table = re.search(rf"\{{[^{{}}]*\bid\s*=\s*{c.servo_id}\b[^{{}}]*\}}", text)
    if table is None:
        raise CommandError(f"servo {c.servo_id} is not in one inline table {{ id = {c.servo_id}, ... }}: write it so")
    inner = table[0]
    if re.search(r"\bzero_tick\s*=", inner):
        inner = re.sub(r"(\bzero_tick\s*=\s*)-?\d+", rf"\g<1>{c.zero_tick}", inner)
    else:
        inner = re.sub(r"\s*\}$", f", zero_tick = {c.zero_tick} }}", inner)
    return text[: table.start()] + inner + text[table.end() :]


def _with_range(block: str, c: Calibrated) -> str:
    assert c.low_deg is not None and c.high_deg is not None
    numbers = f"[{_inward(c.low_deg, math.ceil)}, {_inward(c.high_deg, math.floor)}]"
    return re.sub(r"(position_limit_deg\s*=\s*)\[[^\]]*\]", rf"\g<1>{numbers}", block, count=1)


def _inward(deg: float, towards: Callable[[float], int]) -> float:
    """`deg` in steps of 0.1 degrees, rounded by `towards` away from the joint's end."""
    return towards(deg * 10) / 10
