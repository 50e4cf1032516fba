"""Report of the changes that retargeting made, in numbers a user can read."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from retarget.path.limits import JointLimits

Array = NDArray[np.float64]
BONES = ("left_upper_arm", "right_upper_arm", "left_forearm", "right_forearm")
_AT_LIMIT = 0.995
"""Share of a velocity or acceleration limit from which the limit counts as reached."""
_CHANGED_RAD = np.deg2rad(1.0)


@dataclass(frozen=True)
class RetargetReport:
    """Figures of one retargeted clip.

    Attributes:
        direction_mean_deg: mean angle between the human's and the robot's arm bones.
        direction_p95_deg: its 95th percentile.
        direction_max_deg: its largest value.
        bone_mean_deg: the mean of each bone.
        bone_p95_deg: the 95th percentile of each bone.
        bone_max_deg: the largest value of each bone.
        clipped_frames: frames in which a position limit changed a joint's target.
        off_target_joints: frames for each joint that is over a degree off its target.
        at_limit: for "position", "velocity" and "acceleration", the frames in which it held up each joint.
        interventions: times the path was changed because the robot would have touched itself.
        peak_speed_share: largest speed as a share of the joint's limit.
        peak_speed_joint: the joint that had it.
        peak_acceleration_share: largest acceleration as a share of the limit.
        speed_headroom: share of the speed limit that was never used, by joint.
        acceleration_headroom: the same for acceleration.
        contacts: for each contact of the person's hands, frames in which they touch and in how many of those the robot's
            do; empty unless contacts were to be kept.
        time_stretch: how many times slower than the human, to keep an error asked for; 1 when nothing was asked.
    """

    direction_mean_deg: float
    direction_p95_deg: float
    direction_max_deg: float
    bone_mean_deg: dict[str, float]
    bone_p95_deg: dict[str, float]
    bone_max_deg: dict[str, float]
    clipped_frames: int
    off_target_joints: dict[str, int]
    at_limit: dict[str, dict[str, int]]
    interventions: int
    peak_speed_share: float
    peak_speed_joint: str
    peak_acceleration_share: float
    speed_headroom: dict[str, float]
    acceleration_headroom: dict[str, float]
    contacts: dict[str, dict[str, int]]
    time_stretch: float = 1.0

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON."""
        return asdict(self)


@dataclass(frozen=True)
class Comparison:
    """The data from which a report is computed.

    Attributes:
        names: J joint names.
        errors_deg: gives the (4, T) direction error of each of `BONES` in each frame.
        off_rad: (T, J) wanted angle less the angle of the path.
        outside: (T, J) whether the wanted angle lay outside a position limit.
        control_rad: (N, J) control points of the path.
        rate_hz: their rate.
        limits: the joints' limits.
        interventions: see the report.
        contacts: gives the report's counts of contacts.
        time_stretch: see the report.
    """

    names: Sequence[str]
    errors_deg: Callable[[], Array]
    off_rad: Array
    outside: NDArray[np.bool_]
    control_rad: Array
    rate_hz: float
    limits: JointLimits
    interventions: int
    contacts: Callable[[], dict[str, dict[str, int]]]
    time_stretch: float = 1.0

    def report(self) -> RetargetReport:
        """The figures."""
        every = self.errors_deg()
        speed = np.abs(np.diff(self.control_rad, axis=0)) * self.rate_hz / self.limits.velocity_rad_s
        bend = np.abs(np.diff(self.control_rad, n=2, axis=0)) * self.rate_hz**2 / self.limits.acceleration_rad_s2
        held_up = {"position": self.outside, "velocity": speed > _AT_LIMIT, "acceleration": bend > _AT_LIMIT}
        fastest, hardest = speed.max(0), bend.max(0)
        return RetargetReport(
            direction_mean_deg=_round(every.mean()),
            direction_p95_deg=_round(np.percentile(every, 95)),
            direction_max_deg=_round(every.max()),
            bone_mean_deg=dict(zip(BONES, map(_round, every.mean(1)), strict=True)),
            bone_p95_deg=dict(zip(BONES, map(_round, np.percentile(every, 95, axis=1)), strict=True)),
            bone_max_deg=dict(zip(BONES, map(_round, every.max(1)), strict=True)),
            clipped_frames=int(self.outside.any(1).sum()),
            off_target_joints=self._frames(np.abs(self.off_rad) > _CHANGED_RAD),
            at_limit={kind: self._frames(frames) for kind, frames in held_up.items()},
            interventions=self.interventions,
            peak_speed_share=_round(fastest.max(), 4),
            peak_speed_joint=self.names[int(fastest.argmax())],
            peak_acceleration_share=_round(hardest.max(), 4),
            speed_headroom=dict(zip(self.names, (_round(1 - s) for s in fastest), strict=True)),
            acceleration_headroom=dict(zip(self.names, (_round(1 - b) for b in hardest), strict=True)),
            contacts=self.contacts(),
            time_stretch=_round(self.time_stretch),
        )

    def _frames(self, of: NDArray[np.bool_]) -> dict[str, int]:
        """Number of frames by joint, for joints with at least one frame."""
        return {self.names[j]: int(n) for j, n in enumerate(of.sum(0)) if n}


def _round(value: float, digits: int = 3) -> float:
    return round(float(value), digits)
