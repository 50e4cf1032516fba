"""Facts of servo models: resolution, range, speed, model number."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

_FILE = Path(__file__).parent / "servos.toml"
EXTENDED_TURNS = 256
"""Turns from zero within which goals lie in extended position mode (e-manual, Operating Mode 4)."""


@dataclass(frozen=True)
class ServoModel:
    """One servo model.

    Attributes:
        name: the maker's name, e.g. "XM430-W350".
        model_number: number in the servo's answer to a ping.
        protocol: 1.0 or 2.0.
        ticks_per_turn: position resolution per full turn, also for a servo that cannot make a full turn.
        zero_tick: middle of the range.
        min_tick, max_tick: first and last goal in position mode.
        no_load_speed_rad_s: upper bound of the speed, at the rated voltage.
        has_current: whether it measures current (else load).
        has_extended: whether it has the extended position mode, of many turns.
    """

    name: str
    model_number: int
    protocol: float
    ticks_per_turn: float
    zero_tick: int
    min_tick: int
    max_tick: int
    no_load_speed_rad_s: float
    has_current: bool
    has_extended: bool

    def tick_range(self, extended: bool) -> tuple[int, int]:
        """First and last goal that the servo accepts in position mode or, if `extended`, in extended position mode."""
        if not extended:
            return self.min_tick, self.max_tick
        reach = round(EXTENDED_TURNS * self.ticks_per_turn) - 1
        return -reach, reach


@cache
def servo_models() -> dict[str, ServoModel]:
    """All known models by name."""
    return {name: ServoModel(name, **facts) for name, facts in tomllib.loads(_FILE.read_text("utf-8")).items()}
