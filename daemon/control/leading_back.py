"""The first goals after arming are the measured ticks; from them the goals approach the ticks that the joint angles map to.

A joint angle maps exactly onto a servo's tick unless several servos drive one joint: play and horns then leave each servo slightly
off the angle that they share. Sending the mapped ticks as first goals would make each servo jump by its own offset.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from retarget.robot.ticks import JointServoMap

STEP_TICK, _TICKS_PER_TURN = 1, 4096
"""Ticks a cycle by which the goal of a servo with 4096 ticks a turn moves; a finer servo moves by the same angle."""


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
        """Whether goals equal the mapped ticks; until then the joints must be held still."""
        return self._beside is None

    def begin(self, measured_tick: NDArray[np.int32]) -> NDArray[np.float64]:
        """Joint angles (J,) at the measured ticks (S,); the caller's next goals must continue from these angles."""
        q_rad = self._ticks.tick_to_rad(measured_tick)
        beside = measured_tick - self._mapped(q_rad)
        self._beside = beside if beside.any() else None
        return q_rad

    def goal_tick(self, q_rad: NDArray[np.float64]) -> NDArray[np.int32]:
        """Goal ticks (S,) for joint angles (J,): the measured ticks right after `begin`, then nearer to the mapped ones."""
        goal = self._mapped(q_rad)
        if self._beside is None:
            return goal
        goal += self._beside
        beside = np.sign(self._beside) * np.maximum(np.abs(self._beside) - self._step, 0)
        self._beside = beside.astype(np.int32) if beside.any() else None
        return goal

    def _mapped(self, q_rad: NDArray[np.float64]) -> NDArray[np.int32]:
        return np.rint(self._ticks.to_ticks(q_rad)).astype(np.int32)
