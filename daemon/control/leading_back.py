"""The first goals after arming are the measured ticks themselves; from there the servos are led onto the map of joints.

Joint angles map onto every servo's tick but where several servos drive one joint: play and horns leave each a little
beside the angle that all together stand for. Written as joints their first goals would be a jump of as much.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from retarget.robot.ticks import JointServoMap

STEP_TICK, _TICKS_PER_TURN = 1, 4096
"""Ticks a cycle by which a servo of 4096 ticks a turn is led; a servo of finer ticks is led by as many degrees."""


class LeadingBack:
    """Goals in ticks for joint angles, led from the measured ticks onto the map.

    Args:
        ticks: the robot's map.
        ticks_per_turn: (S,) of its servos.
    """

    def __init__(self, ticks: JointServoMap, ticks_per_turn: NDArray[np.float64]) -> None:
        self._ticks = ticks
        self._step = np.maximum(STEP_TICK, np.rint(STEP_TICK * ticks_per_turn / _TICKS_PER_TURN)).astype(np.int32)
        self._beside: NDArray[np.int32] | None = None

    @property
    def done(self) -> bool:
        """Whether goals are what the map says; until then the joints must be held still."""
        return self._beside is None

    def begin(self, measured_tick: NDArray[np.int32]) -> NDArray[np.float64]:
        """(J,) the joints' angles at (S,) measured ticks, from which the next goals go on."""
        q_rad = self._ticks.tick_to_rad(measured_tick)
        beside = measured_tick - self._mapped(q_rad)
        self._beside = beside if beside.any() else None
        return q_rad

    def goal_tick(self, q_rad: NDArray[np.float64]) -> NDArray[np.int32]:
        """(S,) goals for joints (J,); right after `begin` the measured ticks, then nearer to the map with each call."""
        goal = self._mapped(q_rad)
        if self._beside is None:
            return goal
        goal += self._beside
        beside = np.sign(self._beside) * np.maximum(np.abs(self._beside) - self._step, 0)
        self._beside = beside.astype(np.int32) if beside.any() else None
        return goal

    def _mapped(self, q_rad: NDArray[np.float64]) -> NDArray[np.int32]:
        return np.rint(self._ticks.to_ticks(q_rad)).astype(np.int32)
