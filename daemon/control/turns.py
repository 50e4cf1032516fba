"""Checks before torque comes on that the servos' ticks can mean only one pose. Part of the bus process.

A servo in extended position mode forgets whole turns without power: at 192 degrees it reports -168 after a power cycle, and a joint
that may be at either angle could be turned the wrong way. Whole turns are known once every other number of turns would put the
joints outside their range, and as long as each servo answers without a pause in which it could have lost power.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import NDArray

from daemon.dynamixel.reading import BusReading
from daemon.dynamixel.servo_bus import ServoBus
from daemon.errors import ServoFaultError
from retarget.robot.robot import RobotModel
from retarget.robot.ticks import JointServoMap

PAUSE_S = 0.15
"""Seconds of silence in which a servo may have lost its power and started again (which takes longer)."""
SLACK_RAD = math.radians(5.0)
"""Radians by which a joint may be outside its range while a number of turns, reported or not, still counts as possible."""
MOST_APART_RAD = math.radians(2.0)
"""Radians by which the servos of one joint may disagree: the sum of play, horns and zeros."""
TURNS_UNKNOWN = "it forgets whole turns without power"
"""Words of a refusal where a person has to lead the joint by hand."""
LOOK_CYCLES = 10
"""Bus cycles between two checks while turns are not known."""


class TurnWatch:
    """Follows the servos' positions and reports whether their whole turns are known.

    Args:
        robot: the robot.
        ticks: the robot's map between joints and ticks.
        bus: the servos, for their names in errors.
    """

    def __init__(self, robot: RobotModel, ticks: JointServoMap, bus: ServoBus) -> None:
        self._robot, self._ticks, self._bus = robot, ticks, bus
        self._turn_tick = np.array([s.model.ticks_per_turn for s in robot.servos], np.float64)
        self._servo_groups, self._joint_groups = _groups(robot)
        span = (ticks.position_max_tick - ticks.position_min_tick) / self._turn_tick
        shifts: list[NDArray[np.float64]] = []
        for servos in self._servo_groups:
            most = [max(1, math.ceil(span[row])) for row in np.flatnonzero(servos)]
            for turns in itertools.product(*(range(-k, k + 1) for k in most)):
                shift = np.zeros(robot.n_servos)
                shift[servos] = turns
                shifts.append(shift)
        moved = [shift for shift in shifts if shift.any()]
        self._shifts = np.array(moved)  # (N, S) whole turns, of one group each
        self._of_shift = np.array(
            [next(g for g, servos in enumerate(self._servo_groups) if shift[servos].any()) for shift in moved], np.intp
        )
        extended = np.array([s.extended for s in robot.servos])
        counts = np.array([extended[servos].any() for servos in self._servo_groups])
        self._believed_rad = np.where(counts, SLACK_RAD, -SLACK_RAD)[self._of_shift]
        self.known = np.zeros(len(self._servo_groups), bool)
        """(G,) whether whole turns are known, of each group of servos that move the same joints."""
        self._tick = np.zeros(robot.n_servos, np.int64)
        self._read_s = np.full(robot.n_servos, -np.inf)
        self._cycle = 0

    def update(self, reading: BusReading, now_s: float) -> None:
        """Follow one cycle's reading."""
        self._cycle += 1
        paused = np.where(reading.valid, reading.read_s, now_s) - self._read_s > PAUSE_S
        jumped = reading.valid & (2 * np.abs(reading.position_tick - self._tick) > self._turn_tick)
        unsure = paused | jumped
        if unsure.any():
            self.known[(self._servo_groups & unsure).any(1)] = False
        np.copyto(self._tick, reading.position_tick, where=reading.valid)
        np.copyto(self._read_s, reading.read_s, where=reading.valid)
        if self._cycle % LOOK_CYCLES == 0 and not self.known.all() and reading.valid.all():
            self.known[self._other_counts(reading.position_tick) < 0] = True

    def require_one_pose(self, present_tick: NDArray[np.int32]) -> None:
        """Refuse a robot whose servos, at measured ticks (S,), may stand elsewhere than they report.

        Raises:
            ServoFaultError: whole turns are not known, or several servos of one joint disagree.
        """
        other = np.where(self.known, -1, self._other_counts(present_tick))
        for n in other[other >= 0].tolist():
            row = int(np.flatnonzero(self._shifts[n])[0])
            turn, zero = self._turn_tick[row], self._robot.servos[row].zero_tick
            said = (int(present_tick[row]) - zero) * 360 / turn
            text = (
                f"{said:.0f} degrees from its zero, which may as well be {said + 360 * self._shifts[n][row]:.0f}: {TURNS_UNKNOWN}."
                " Turn the joint by hand to its park pose, then reset and arm; where that is refused as well, switch the"
                " servos' power off and on there"
            )
            raise ServoFaultError(self._bus.ids[row], f"position of {self._robot.servos[row].joint_name}", text)
        apart = np.abs(self._apart_tick(present_tick.astype(np.float64))) * 2 * math.pi / self._turn_tick
        row = int(apart.argmax())
        if 2 * apart[row] > MOST_APART_RAD:
            joint = self._robot.servos[row].joint_name
            ids = ", ".join(str(s.servo_id) for s in self._robot.servos if s.joint_name == joint)
            text = (
                f"servos {ids} disagree by {math.degrees(2 * apart[row]):.1f} degrees, allowed are"
                f" {math.degrees(MOST_APART_RAD):g}; check horns and zero_tick"
            )
            raise ServoFaultError(self._bus.ids[row], f"position of {joint}", text)

    def _apart_tick(self, ticks: NDArray[np.float64]) -> NDArray[np.float64]:
        """(..., S) ticks from each servo's position to the one that the pose shared by all servos of the joint implies."""
        return ticks - np.rint(self._ticks.to_ticks(self._ticks.tick_to_rad(ticks)))

    def _other_counts(self, present_tick: NDArray[np.int32]) -> NDArray[np.intp]:
        """(G,) for each group the row of `_shifts` that is as possible as the reported turns; -1 for none."""
        base = present_tick.astype(np.float64)
        poses = base + np.concatenate([np.zeros((1, len(base))), self._shifts * self._turn_tick])
        servo_rad, joint_rad = self._outside_rad(poses)
        servos, joints = self._servo_groups[self._of_shift], self._joint_groups[self._of_shift]
        found = (servo_rad[0] * servos).sum(1) + (joint_rad[0] * joints).sum(1)
        other = (servo_rad[1:] * servos).sum(1) + (joint_rad[1:] * joints).sum(1)
        best = np.full(len(self.known), -1, np.intp)
        likely = np.flatnonzero(other <= found + self._believed_rad)
        for n in likely[np.argsort(-other[likely])]:  # the most likely one last
            best[self._of_shift[n]] = n
        return best

    def _outside_rad(self, poses: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(N, S) and (N, J) radians by which servos and joints are outside their ranges, or servos of a joint apart."""
        q_rad = self._ticks.tick_to_rad(poses)
        robot, ticks = self._robot, self._ticks
        joint = np.maximum(q_rad - robot.position_max_rad, robot.position_min_rad - q_rad)
        servo = np.maximum(poses - ticks.position_max_tick, ticks.position_min_tick - poses)
        servo = np.maximum(servo, 0.0) + np.abs(self._apart_tick(poses))
        return servo * 2 * math.pi / self._turn_tick, np.maximum(joint, 0.0)


def _groups(robot: RobotModel) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """(G, S) and (G, J) masks: the servos and joints of each group that move together."""
    moved = np.zeros((robot.n_servos, robot.n_joints), bool)
    for row, servo in enumerate(robot.servos):
        moved[row, [j for j, _ in servo.couplings]] = True
    servos: list[NDArray[np.bool_]] = []
    for row in range(robot.n_servos):
        if any(group[row] for group in servos):
            continue
        joints = np.array(moved[row])
        while (wider := np.array(moved[(moved & joints).any(1)].any(0))).sum() > joints.sum():
            joints = wider
        servos.append(np.asarray((moved & joints).any(1)))
    groups = np.array(servos)
    return groups, groups @ moved
