"""What retargeting changed, in numbers a user can read."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True)
class RetargetReport:
    """Figures of one retargeted clip.

    Attributes:
        direction_mean_deg: mean angle between the human's and the robot's arm bones.
        direction_p95_deg: its 95th percentile.
        direction_max_deg: its largest value.
        bone_mean_deg: the mean of each bone.
        clipped_frames: frames in which a position limit changed a joint's target.
        clipped_joints: frames for each joint that was changed at all.
        interventions: times the path was changed because the robot would have touched itself.
        peak_speed_share: largest speed as a share of the joint's limit.
        peak_speed_joint: the joint that had it.
        peak_acceleration_share: largest acceleration as a share of the limit.
    """

    direction_mean_deg: float
    direction_p95_deg: float
    direction_max_deg: float
    bone_mean_deg: dict[str, float]
    clipped_frames: int
    clipped_joints: dict[str, int]
    interventions: int
    peak_speed_share: float
    peak_speed_joint: str
    peak_acceleration_share: float

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON."""
        return asdict(self)
