"""Turns the targets of a lease into frames that are safe to send. No clock of its own, no I/O.

The frames are joint angles, not poses: targets are meant for this robot, and are not retargeted.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daemon.state.lease import LeaseClock, LeaseState
from retarget.path.paths import JointState
from retarget.path.safety_filter import SafetyFilter
from retarget.robot.robot import RobotModel

Array = NDArray[np.float64]
LONGEST_GLIDE_S = 0.1
"""Seconds between targets beyond which each target is approached at once, as fast as the limits allow."""
_SHARE_OF_NEWEST = 0.3
SELF_COLLISION, SILENCE = "self-collision", "silence"


class Glide:
    """Interpolates linearly between targets that come less often than frames, over the mean time between them."""

    def __init__(self, rate_hz: float) -> None:
        self._rate_hz = rate_hz
        self._apart_s: float | None = None
        self._last_s = float("-inf")
        self._left = 0
        self._at_rad: Array = np.zeros(0)
        self.target_rad: Array = np.zeros(0)

    def begin(self, position_rad: Array) -> None:
        """Start at a position (J,), radians, without a target."""
        self._at_rad, self.target_rad, self._left = position_rad.copy(), position_rad.copy(), 0

    def take(self, target_rad: Array, now_s: float) -> None:
        """Take a new target (J,), radians, which came at `now_s`."""
        apart_s, self._last_s = now_s - self._last_s, now_s
        if apart_s > LONGEST_GLIDE_S:
            self._apart_s = None
        elif self._apart_s is None:
            self._apart_s = apart_s
        else:
            self._apart_s += _SHARE_OF_NEWEST * (apart_s - self._apart_s)
        self.target_rad = target_rad.copy()
        self._left = 1 if self._apart_s is None else max(1, math.ceil(self._apart_s * self._rate_hz))

    def frame(self) -> Array:
        """(J,) position of the next frame, radians."""
        if self._left > 1:
            self._at_rad = self._at_rad + (self.target_rad - self._at_rad) / self._left
            self._left -= 1
        else:
            self._at_rad = self.target_rad
        return self._at_rad


class StreamSource:
    """Gives the frames of one lease.

    Args:
        robot: the robot.
        guard: safety filter that makes each step.
        clock: clock of the lease.

    Attributes:
        holder: holder of the lease, in words.
        targets, bad: number of targets taken and refused.
        clipped: number of frames with a target beyond a position limit, which they approach as far as the limit allows.
    """

    def __init__(self, robot: RobotModel, guard: SafetyFilter, clock: LeaseClock, holder: str) -> None:
        self._guard, self.clock, self.holder = guard, clock, holder
        self._glide = Glide(robot.bus.rate_hz)
        self._gaze_rad: dict[int, float] = {}
        self.targets = self.bad = self.clipped = 0
        self.begun = False

    def begin(self, start: JointState, now_s: float) -> None:
        """Begin to lead the joints, from `start` on."""
        self.go_on(start)
        self.clock.begin(now_s)
        self.begun = True

    def go_on(self, start: JointState) -> None:
        """Continue to the same target from `start`, because the joints are not where the frames led."""
        self._guard.reset(start.position_rad, start.velocity_rad_s)
        if not self.begun or not self.targets:
            self._glide.begin(start.position_rad)

    def take(self, q_rad: Array, now_s: float) -> bool:
        """Take a checked target (J,), NaN for a joint that keeps its target; returns whether the lease takes it."""
        if not self.begun or not self.clock.target(now_s):
            return False
        self.targets += 1
        self._glide.take(np.where(np.isnan(q_rad), self._glide.target_rad, q_rad), now_s)
        return True

    def look(self, gaze_rad: dict[int, float]) -> None:
        """Set the angles of joints that a gaze holds, radians by index; an empty map frees them."""
        self._gaze_rad = dict(gaze_rad)

    def frame(self) -> Array:
        """(J,) the next frame, radians."""
        if self.clock.state in (LeaseState.SILENT, LeaseState.OVER):
            return self._guard.brake()
        wanted = self._glide.frame().copy()
        for joint, angle_rad in self._gaze_rad.items():
            wanted[joint] = angle_rad
        q_rad = self._guard.step(wanted)
        self.clipped += self._guard.clipped
        return q_rad

    @property
    def state(self) -> JointState:
        """Position and velocity after the last frame."""
        return JointState(self._guard.position_rad, self._guard.velocity_rad_s)

    @property
    def at_rest(self) -> bool:
        """Whether the last frame moved no joint."""
        return self._guard.at_rest

    @property
    def released(self) -> bool:
        """Whether the lease ends as soon as the joints are at rest."""
        return self.clock.state is LeaseState.RELEASED

    @property
    def held_by(self) -> str:
        """Cause that keeps the robot from its target: "self-collision", "silence", or "" for none."""
        if self.clock.state in (LeaseState.SILENT, LeaseState.OVER):
            return SILENCE
        return SELF_COLLISION if self._guard.held else ""

    @property
    def holds(self) -> int:
        """Number of times the filter braked for a contact."""
        return self._guard.holds

    def touching(self) -> str:
        """Bodies that would touch at the target, in words; empty when they would touch only on the way there."""
        pairs = self._guard.touching(self._glide.target_rad)
        return ", ".join(f"{a} and {b}" for a, b in pairs[:3])
