"""Facts of servo models: resolution, speed, model number."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

_FILE = Path(__file__).parent / "servos.toml"


@dataclass(frozen=True)
class ServoModel:
    """One servo model.

    Attributes:
        name: the maker's name, e.g. "XM430-W350".
        model_number: what the servo answers to a ping.
        protocol: 1.0 or 2.0.
        ticks_per_turn: position resolution.
        no_load_speed_rad_s: upper bound of its speed, at the rated voltage.
        has_current: whether it measures current (else load).
    """

    name: str
    model_number: int
    protocol: float
    ticks_per_turn: int
    no_load_speed_rad_s: float
    has_current: bool


@cache
def servo_models() -> dict[str, ServoModel]:
    """All known models by name."""
    return {name: ServoModel(name, **facts) for name, facts in tomllib.loads(_FILE.read_text("utf-8")).items()}
