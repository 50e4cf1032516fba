"""Control tables: where each item stands, how long it is, whether it is signed and writable.

ROBOTIS e-manual, "Control Table" of XM430-W350, XL430-W250 and XL330-M288. Below 64 is EEPROM: writable only while
torque is off. Units: position 0.0015340 rad (4096 ticks a turn), velocity 0.0239808 rad/s, current 2.69 mA (XM430) or
1 mA (XL330), voltage 0.1 V, bus watchdog 20 ms.
"""

from __future__ import annotations

from dataclasses import dataclass

EEPROM_END = 64
VELOCITY_UNIT_RAD_S = 0.02398082392
WATCHDOG_UNIT_S = 0.02
WATCHDOG_TRIPPED = -1


@dataclass(frozen=True)
class Item:
    """One item of a control table."""

    name: str
    address: int
    size: int
    signed: bool = False
    writable: bool = True

    def decode(self, data: bytes) -> int:
        """Value of `size` little-endian bytes."""
        return int.from_bytes(data, "little", signed=self.signed)

    def encode(self, value: int) -> bytes:
        """Little-endian bytes; negative values and their unsigned twins are both taken.

        Raises:
            OverflowError: the value does not fit.
        """
        return value.to_bytes(self.size, "little", signed=value < 0)


def _items(*rows: tuple[str, int, int, str]) -> dict[str, Item]:
    """Rows (name, address, size, flags): s signed, r read only."""
    return {name: Item(name, address, size, "s" in flags, "r" not in flags) for name, address, size, flags in rows}


_COMMON = _items(
    ("model_number", 0, 2, "r"), ("firmware_version", 6, 1, "r"), ("id", 7, 1, ""), ("baud_rate", 8, 1, ""),
    ("return_delay_time", 9, 1, ""), ("drive_mode", 10, 1, ""), ("operating_mode", 11, 1, ""),
    ("secondary_id", 12, 1, ""), ("protocol_type", 13, 1, ""), ("homing_offset", 20, 4, "s"), ("moving_threshold", 24, 4, ""),
    ("temperature_limit", 31, 1, ""), ("max_voltage_limit", 32, 2, ""), ("min_voltage_limit", 34, 2, ""),
    ("pwm_limit", 36, 2, ""), ("velocity_limit", 44, 4, ""), ("max_position_limit", 48, 4, ""),
    ("min_position_limit", 52, 4, ""), ("shutdown", 63, 1, ""), ("torque_enable", 64, 1, ""), ("led", 65, 1, ""),
    ("status_return_level", 68, 1, ""), ("registered_instruction", 69, 1, "r"), ("hardware_error_status", 70, 1, "r"),
    ("velocity_i_gain", 76, 2, ""), ("velocity_p_gain", 78, 2, ""), ("position_d_gain", 80, 2, ""),
    ("position_i_gain", 82, 2, ""), ("position_p_gain", 84, 2, ""), ("feedforward_2nd_gain", 88, 2, ""),
    ("feedforward_1st_gain", 90, 2, ""), ("bus_watchdog", 98, 1, "s"), ("goal_pwm", 100, 2, "s"),
    ("goal_velocity", 104, 4, "s"), ("profile_acceleration", 108, 4, ""), ("profile_velocity", 112, 4, ""),
    ("goal_position", 116, 4, "s"), ("realtime_tick", 120, 2, "r"), ("moving", 122, 1, "r"),
    ("moving_status", 123, 1, "r"), ("present_pwm", 124, 2, "sr"), ("present_velocity", 128, 4, "sr"),
    ("present_position", 132, 4, "sr"), ("velocity_trajectory", 136, 4, "sr"), ("position_trajectory", 140, 4, "sr"),
    ("present_input_voltage", 144, 2, "r"), ("present_temperature", 146, 1, "r"),
)  # fmt: skip
_CURRENT = _items(("current_limit", 38, 2, ""), ("goal_current", 102, 2, "s"), ("present_current", 126, 2, "sr"))
_LOAD = _items(("present_load", 126, 2, "sr"))

CONTROL_TABLES: dict[int, dict[str, Item]] = {
    1020: _COMMON | _CURRENT,  # XM430-W350
    1030: _COMMON | _CURRENT,  # XM430-W210
    1060: _COMMON | _LOAD,  # XL430-W250: no current, address 126 is load in 0.1 %
    1200: _COMMON | _CURRENT,  # XL330-M288
}
"""Items of each model by model number."""

FEEDBACK_ADDRESS, FEEDBACK_LENGTH = 126, 10
"""Present current (or load) 126, velocity 128 and position 132 stand side by side: one read brings all three."""

HARDWARE_ERRORS = {0: "input voltage", 2: "overheating", 3: "encoder", 4: "electrical shock", 5: "overload"}
"""Bits of hardware_error_status."""


def hardware_error_text(status: int) -> str:
    """The set bits in words."""
    return ", ".join(text for bit, text in HARDWARE_ERRORS.items() if status >> bit & 1) or "none"
