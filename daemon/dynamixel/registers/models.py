"""Data of each servo model for the bus: control table, indirect windows, bauds, and the features of its firmware.

Model numbers as answered to a ping. Initial values were transcribed from the pages of XM430-W350, XH430-W350,
XL430-W250, XL330-M288, XC330-T288, MX-64(2.0), MX-64, AX-12A, YM070-210-R099-RH, YM080-230-R099-RH and PH42-020-S300-R;
for the others the electrical ranges are their family's and the velocity limit is the no-load speed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

from daemon.dynamixel.registers.registers import (
    AX,
    MX1,
    MX1_CURRENT,
    MX2_CURRENT,
    MX2_LOAD,
    X330,
    X_CURRENT,
    X_LOAD,
    Table,
    hardware_error_text,
    with_values,
)
from daemon.dynamixel.registers.registers_series_y_p import INVERTER_ABOVE_MOTOR_C, LOW_VOLTS_RAW, P, Y, error_code_text


@dataclass(frozen=True)
class IndirectWindow:
    """`count` indirect data bytes from `data` on; byte i shows the address written at `address` + 2 i.

    `kept`: the addresses are kept without power, and written only while torque is off. `low` to `high` may be shown.
    """

    address: int
    data: int
    count: int
    kept: bool = False
    low: int = 64
    high: int = 661


@dataclass(frozen=True)
class Thermometer:
    """One temperature that a servo measures, and the item with the limit at which it trips.

    `above_c`: degrees by which it may be hotter, from the factory, than the temperature that is reported of the servo.
    """

    present: str
    limit: str
    above_c: int = 0


BAUD_CODES_X = {9600: 0, 57600: 1, 115200: 2, 1000000: 3, 2000000: 4, 3000000: 5, 4000000: 6, 4500000: 7}
_WINDOWS = (IndirectWindow(168, 224, 28), IndirectWindow(578, 634, 28))
_WINDOWS_330 = (IndirectWindow(168, 208, 20),)
_WINDOWS_330_BEFORE_52 = (IndirectWindow(168, 224, 28),)
_FIRMWARE_330_MOVED_WINDOW = 52
BAUD_CODES_YP = BAUD_CODES_X | {6000000: 8, 10500000: 9}
_WINDOWS_Y = (IndirectWindow(256, 634, 128, kept=True, low=0, high=919),)
_WINDOWS_P = (IndirectWindow(168, 634, 128, kept=True, low=512, high=1023),)
_THERMOMETER = (Thermometer("present_temperature", "temperature_limit"),)
_THERMOMETERS_Y = (
    Thermometer("present_motor_temperature", "motor_temperature_limit"),
    Thermometer("present_inverter_temperature", "inverter_temperature_limit", INVERTER_ABOVE_MOTOR_C),
)


@dataclass(frozen=True)
class BusModel:
    """One servo model as the bus sees it.

    Attributes:
        name: the maker's name.
        model_number: model number that it answers to a ping.
        family: x_current, x_load, x330, mx2_current, mx2_load, mx1, ax, y or p.
        protocol: 1.0 or 2.0.
        table: its control table.
        ticks_per_turn, zero_tick: position resolution (of 300 degrees for AX) and the middle.
        operating_modes: values of operating_mode it takes; empty where there is no such item.
        max_baud: highest baud.
        voltage_v: (low, high) it may be run at.
        fast_sync_firmware: first firmware that answers fast sync and bulk reads; None for none.
        watchdog_firmware: first firmware with a bus watchdog; None for none.
        watchdog_stops: whether the watchdog is known to stop the servo. Of the 330 size some firmware flags the trip
            but keeps moving (ROBOTIS forum 4814): it is armed there as well, but counts for nothing.
        axes: joints in one housing, each with an id of its own.
        thermometers: its temperature readings, each with the item of its limit.
    """

    name: str
    model_number: int
    family: str
    protocol: float
    table: Table
    ticks_per_turn: int
    zero_tick: int
    operating_modes: tuple[int, ...]
    max_baud: int
    voltage_v: tuple[float, float]
    fast_sync_firmware: int | None
    watchdog_firmware: int | None
    watchdog_stops: bool
    axes: int = 1
    thermometers: tuple[Thermometer, ...] = _THERMOMETER

    @cached_property
    def has_current(self) -> bool:
        """Whether it measures current, and not only a load."""
        return "present_current" in self.table

    @property
    def effort_item(self) -> str:
        """The item beside velocity and position: current where there is one, else load."""
        return "present_current" if self.protocol == 2.0 and self.has_current else "present_load"

    @cached_property
    def error_item(self) -> str:
        """Name of the item with its errors; empty on protocol 1.0, where every answer carries them."""
        return next((name for name in ("hardware_error_status", "error_code") if name in self.table), "")

    def error_text(self, value: int) -> str:
        """A value of `error_item` in words (on protocol 1.0 the error bits of an answer)."""
        return error_code_text(value) if self.error_item == "error_code" else hardware_error_text(value)

    @property
    def feedback_address(self) -> int:
        """Address of effort, velocity and position (protocol 2.0)."""
        return self.table[self.effort_item].address

    def decivolt(self, raw: int) -> int:
        """present_input_voltage in the 0.1 V of the voltage limits; see `LOW_VOLTS_RAW` for Y."""
        return round(raw / 10) if self.family == "y" and raw > LOW_VOLTS_RAW else raw

    def temperature_c(self, values: Mapping[str, int]) -> int | None:
        """Temperature of the servo; of several the one nearest to its limit. None when none is in `values`."""
        found = [values[t.present] - t.above_c for t in self.thermometers if t.present in values]
        return max(found, default=None)

    def indirect_windows(self, firmware: int) -> tuple[IndirectWindow, ...]:
        """Windows of indirect data; their addresses moved in the 330 size with firmware 52."""
        if self.protocol == 1.0:
            return ()
        if self.family == "x330":
            return _WINDOWS_330 if firmware >= _FIRMWARE_330_MOVED_WINDOW else _WINDOWS_330_BEFORE_52
        return {"y": _WINDOWS_Y, "p": _WINDOWS_P}.get(self.family, _WINDOWS)

    def has_fast_sync(self, firmware: int) -> bool:
        """Whether it can answer a fast sync read, as the manual says (it is tried all the same)."""
        return self.fast_sync_firmware is not None and firmware >= self.fast_sync_firmware

    def has_watchdog(self, firmware: int) -> bool:
        """Whether it has a bus watchdog."""
        return self.watchdog_firmware is not None and firmware >= self.watchdog_firmware

    def baud_code(self, baud: int) -> int | None:
        """Value of `baud_rate` for `baud`; None when the model does not have it."""
        if baud > self.max_baud:
            return None
        if self.protocol == 2.0:
            return self._baud_codes.get(baud)
        special = {2250000: 250, 2500000: 251, 3000000: 252}
        if baud in special:
            return special[baud]
        code = round(2_000_000 / baud) - 1
        return code if 0 <= code <= 249 and abs(2_000_000 / (code + 1) / baud - 1) < 0.03 else None

    def baud_of_code(self, code: int) -> int | None:
        """The baud a value of baud_rate stands for."""
        if self.protocol == 2.0:
            return next((baud for baud, known in self._baud_codes.items() if known == code), None)
        return {250: 2250000, 251: 2500000, 252: 3000000}.get(code, 2_000_000 // (code + 1))

    @property
    def _baud_codes(self) -> dict[int, int]:
        return BAUD_CODES_YP if self.family in ("y", "p") else BAUD_CODES_X


def _current_unit(table: Table, scale_ma: float) -> Table:
    items = ("current_limit", "goal_current", "present_current")
    return dict(table) | {name: replace(table[name], scale=scale_ma) for name in items}


_SIX, _FOUR = (0, 1, 3, 4, 5, 16), (1, 3, 4, 16)
_V12, _V_WIDE = (10.0, 14.8), (6.5, 14.8)


def _x(name: str, number: int, current: int, velocity: int, p_gain: int = 800) -> BusModel:
    table = with_values(
        X_CURRENT,
        current_limit=(0, current, current), velocity_limit=(0, 1023, velocity), position_p_gain=(0, 16383, p_gain),
    )  # fmt: skip
    return BusModel(name, number, "x_current", 2.0, table, 4096, 2048, _SIX, 4500000, _V12, 45, 38, True)


def _load(name: str, number: int, velocity: int, voltage_v: tuple[float, float], axes: int = 1) -> BusModel:
    table = with_values(
        X_LOAD,
        temperature_limit=(0, 100, 72), max_voltage_limit=(60, 140, 140), min_voltage_limit=(60, 140, 60),
        velocity_limit=(0, 1023, velocity), velocity_i_gain=(0, 16383, 1000), position_d_gain=(0, 16383, 4000),
        position_p_gain=(0, 16383, 640),
    )  # fmt: skip
    fast = 45 if axes == 1 else None  # 2XL and 2XC: not supported (manual, "Fast Sync Read")
    return BusModel(name, number, "x_load", 2.0, table, 4096, 2048, _FOUR, 4500000, voltage_v, fast, 38, True, axes)


def _x330(
    name: str, number: int, current: int, velocity: int, volts: tuple[int, int, int], gains: tuple[int, int, int]
) -> BusModel:
    low, high, shutdown = volts
    table = with_values(
        X330,
        baud_rate=(0, 6, 1), drive_mode=(0, 5, 0), temperature_limit=(0, 100, 70),
        max_voltage_limit=(low, high, high), min_voltage_limit=(low, high, 35 if low == 31 else low),
        current_limit=(0, current, current), velocity_limit=(0, 2047, velocity), shutdown=(0, 63, shutdown),
        velocity_i_gain=(0, 16383, gains[0]), velocity_p_gain=(0, 16383, gains[1]), position_p_gain=(0, 16383, gains[2]),
    )  # fmt: skip
    table = _current_unit(table, 1.0)
    voltage_v = (3.7, 6.0) if low == 31 else (6.5, 12.0)
    return BusModel(name, number, "x330", 2.0, table, 4096, 2048, _SIX, 4000000, voltage_v, 46, 1, False)


def _mx2(name: str, number: int, velocity: int, current: int | None) -> BusModel:
    values: dict[str, tuple[int, int, int]] = {
        "velocity_limit": (0, 1023, velocity),
        "position_p_gain": (0, 16383, 850),
    }
    if current is not None:
        values["current_limit"] = (0, current, current)
    table = with_values(MX2_LOAD if current is None else MX2_CURRENT, **values)
    family, modes = ("mx2_load", _FOUR) if current is None else ("mx2_current", _SIX)
    if current is not None:
        table = _current_unit(table, 3.36)
    return BusModel(name, number, family, 2.0, table, 4096, 2048, modes, 4500000, _V12, None, 38, True)


def _p1(name: str, number: int, table: Table, voltage_v: tuple[float, float]) -> BusModel:
    ax = table is AX
    return BusModel(
        name, number, "ax" if ax else "mx1", 1.0, table, 1024 if ax else 4096, 512 if ax else 2048, (),
        1000000 if ax else 3000000, voltage_v, None, None, False,
    )  # fmt: skip


def _y(name: str, number: int, velocity: int, acceleration: int) -> BusModel:
    """A model of series Y; `velocity` and `acceleration` are the highest values of its limits and its profile.

    The manual names no firmware without a bus watchdog, and says that it stops the servo; of fast sync reads it says nothing.
    """
    table = with_values(
        Y,
        velocity_limit=(0, velocity, 2020), profile_velocity=(0, velocity, 2020),
        acceleration_limit=(0, acceleration, 161), profile_acceleration=(0, acceleration, 161),
    )  # fmt: skip
    return BusModel(
        name, number, "y", 2.0, table, 524288, 0, (0, 1, 3), 10500000, (16.0, 32.0), None, 0, True,
        thermometers=_THERMOMETERS_Y,
    )  # fmt: skip


def _p(name: str, number: int) -> BusModel:
    """A model of series P, whose registers are arranged like those of Y."""
    modes = (0, 1, 3, 4, 16)
    return BusModel(name, number, "p", 2.0, P, 607500, 0, modes, 10500000, (15.0, 35.0), None, 0, True)


_LOW_V, _HIGH_V = (31, 70, 53), (55, 140, 52)
MODELS: dict[int, BusModel] = {
    m.model_number: m
    for m in (
        _x("XH430-W350", 1000, 648, 130, 900), _x("XH430-W210", 1010, 648, 218, 900),
        _x("XM430-W350", 1020, 1193, 200), _x("XM430-W210", 1030, 1193, 336),
        _x("XM540-W270", 1120, 2047, 131), _x("XM540-W150", 1130, 2047, 231),
        _load("XL430-W250", 1060, 265, (6.5, 12.0)), _load("2XL430-W250", 1090, 265, (6.5, 12.0), 2),
        _load("XC430-W150", 1070, 463, _V_WIDE), _load("XC430-W240", 1080, 306, _V_WIDE),
        _load("2XC430-W250", 1160, 279, _V_WIDE, 2),
        _x330("XL330-M077", 1190, 1750, 1672, _LOW_V, (1600, 180, 400)),
        _x330("XL330-M288", 1200, 1750, 445, _LOW_V, (1600, 180, 400)),
        _x330("XC330-M181", 1230, 1800, 563, _LOW_V, (1200, 40, 900)),
        _x330("XC330-M288", 1240, 1800, 354, _LOW_V, (1200, 40, 900)),
        _x330("XC330-T181", 1210, 910, 454, _HIGH_V, (1200, 40, 900)),
        _x330("XC330-T288", 1220, 910, 320, _HIGH_V, (1200, 40, 900)),
        _mx2("MX-28-2", 30, 240, None), _mx2("MX-64-2", 311, 435, 1941), _mx2("MX-106-2", 321, 197, 2047),
        _p1("MX-28", 29, MX1, _V12), _p1("MX-64", 310, MX1_CURRENT, _V12), _p1("MX-106", 320, MX1_CURRENT, _V12),
        _p1("AX-12A", 12, AX, (9.0, 12.0)), _p1("AX-18A", 18, AX, (9.0, 12.0)),
        _y("YM070-210-R099-RH", 4030, 6486, 389090), _y("YM080-230-R099-RH", 4150, 3591, 215515),
        _p("PH42-020-S300-R", 2000),
    )
}  # fmt: skip
"""All known models by model number."""

CONTROL_TABLES: dict[int, Table] = {number: model.table for number, model in MODELS.items()}
"""Items of each model by model number."""

MODEL_NUMBERS: dict[str, int] = {model.name: number for number, model in MODELS.items()}
"""Model number by the maker's name."""
