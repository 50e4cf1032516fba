"""Bounds on the numbers of a robot file: wide enough for any servo robot, narrow enough that sums of them stay finite."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from retarget.errors import RobotFileError
from retarget.robot.tables import walk

BOUNDS: dict[str, tuple[float, float, str]] = {
    "rate_hz": (20, 1000, "20 to 1000: what is slower feeds no bus watchdog of 0.2 s, and brakes too late"),
    "baud": (9600, 10_500_000, "9600 to 10500000"),
    "velocity_margin": (0.05, 1, "at least 0.05, at most 1"),
    "acceleration_limit_deg_s2": (10, 100_000, "10 to 100000"),
    "velocity_limit_deg_s": (1, 10_000, "1 to 10000"),
    "gear_ratio": (0.01, 100, "0.01 to 100; the sign is `direction`"),
    "zero_tick": (-(2**27), 2**27, "within the 256 turns of extended position mode"),
    "position_limit_deg": (-92_160, 92_160, "degrees, within 256 turns"),
    "rest_deg": (-720, 720, "degrees, within position_limit_deg"),
    "park_deg": (-720, 720, "degrees, within position_limit_deg"),
    "joint_deg": (-720, 720, "-720 to 720 degrees"),
    "servo_deg": (-3600, 3600, "-3600 to 3600 degrees"),
    "joint_per_servo": (-100, 100, "-100 to 100"),
    "offset_m": (-10, 10, "-10 to 10 m"),
}  # fmt: skip
"""Least value, largest value and the text of the error by key; the bounds of a list hold for its items."""
_LAST_KEY = re.compile(r"([A-Za-z_0-9]+)(?:\[\d+\])*$")


def require_bounds(path: Path, raw: dict[str, Any]) -> None:
    """Refuse numbers that no robot has.

    Raises:
        RobotFileError: a number is outside its bounds.
    """
    for where, key, value in walk(raw):
        name = _LAST_KEY.search(f"{where}{key}")
        if isinstance(value, bool) or not isinstance(value, int | float) or name is None or name[1] not in BOUNDS:
            continue
        low, high, allowed = BOUNDS[name[1]]
        if not low <= value <= high:
            raise RobotFileError(path, f"{where}{key}", str(value)[:40], allowed)
