"""Control tables: address, size, access, range and unit of each item.

ROBOTIS e-manual, "Control Table" of XM430-W350, XH430-W350, XL430-W250, XL330-M288, XC330-T288, MX-64(2.0), MX-64 and
AX-12A; addresses of the other models checked against ROBOTIS' table files (`servos/README.md` of the shared facts).
EEPROM items are kept without power and can be written only while torque is off. DYNAMIXEL-Y and -P: `registers_yp.py`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

EEPROM_END = 64
"""Address of the first RAM byte of X and MX (2.0) servos; `Item.eeprom` says the same for every table."""
VELOCITY_UNIT_RAD_S = 0.02398082392  # 0.229 rev/min
WATCHDOG_UNIT_S = 0.02
WATCHDOG_TRIPPED = -1
RETURN_DELAY_UNIT_S = 2e-6
POSITION_MODE, EXTENDED_POSITION_MODE = 3, 4
"""Values of operating_mode in which joints are driven."""

UNITS: dict[str, tuple[float, str]] = {
    "": (1.0, ""),
    "us": (2.0, "us"),
    "tick": (1.0, "tick"),
    "rpm": (VELOCITY_UNIT_RAD_S, "rad/s"),
    "acc": (0.3745075149, "rad/s2"),
    "degC": (1.0, "degC"),
    "V": (0.1, "V"),
    "pwm": (0.113, "%"),
    "mA": (2.69, "mA"),
    "%": (0.1, "%"),
    "ms": (1.0, "ms"),
    "watchdog": (20.0, "ms"),
    "rpm_mx": (0.01193805208, "rad/s"),
    "rpm_ax": (0.01162389282, "rad/s"),
    "acc_mx": (0.1498016097, "rad/s2"),
    "4.5mA": (4.5, "mA"),
    "0.01rpm": (0.001047197551, "rad/s"),
    "rpm2": (0.001745329252, "rad/s2"),
    "10rpm2": (0.01745329252, "rad/s2"),
    "pwm_p": (0.0498, "%"),
    "1mA": (1.0, "mA"),
    "10mA": (10.0, "mA"),
    "0.01V": (0.01, "V"),
    "0.2ms": (0.2, "ms"),
    "0.1Hz": (0.1, "Hz"),
    "5tick/ms": (5.0, "tick/ms"),
    "tick/s": (1.0, "tick/s"),
}
"""Scale and unit: value * scale is in that unit. Where a model differs (mA) its own table says so."""


@dataclass(frozen=True)
class Item:
    """One item of a control table.

    Attributes:
        name: name as in ROBOTIS' tables, in lower case with underscores.
        address, size: first byte and number of bytes.
        signed: two's complement.
        writable: whether the item can be written; else it is read only.
        eeprom: whether the item is kept without power, and written only while torque is off.
        low, high: allowed range; None where the manual gives none (or another item bounds the value).
        initial: value from the factory; None where it depends.
        scale, unit: value * scale is in `unit`.
        sign_bit: protocol 1.0 speeds and loads carry their sign in this bit instead.
        hybrid: whether the item (of DYNAMIXEL-Y) is kept without power and still writable under torque.
    """

    name: str
    address: int
    size: int
    signed: bool = False
    writable: bool = True
    eeprom: bool = False
    low: int | None = None
    high: int | None = None
    initial: int | None = None
    scale: float = 1.0
    unit: str = ""
    sign_bit: int | None = None
    hybrid: bool = False

    @property
    def end(self) -> int:
        """Address after the last byte."""
        return self.address + self.size

    def decode(self, data: bytes) -> int:
        """Value of `size` little-endian bytes."""
        value = int.from_bytes(data, "little", signed=self.signed)
        if self.sign_bit is not None:
            size = value & ((1 << self.sign_bit) - 1)
            return -size if value >> self.sign_bit & 1 else size
        return value

    def encode(self, value: int) -> bytes:
        """Little-endian bytes; negative values and their unsigned equivalents are both accepted.

        Raises:
            OverflowError: the value does not fit.
        """
        if self.sign_bit is not None and value < 0:
            if -value >> self.sign_bit:
                raise OverflowError(f"{value} has more than {self.sign_bit} bits")
            value = -value | 1 << self.sign_bit
        return value.to_bytes(self.size, "little", signed=value < 0)

    def holds(self, data: bytes) -> bool:
        """Whether these bytes are a valid value: the bits above a sign bit are zero."""
        return self.sign_bit is None or not int.from_bytes(data, "little") >> self.sign_bit + 1

    def takes(self, value: int) -> bool:
        """Whether the manual's range allows the value."""
        return (self.low is None or value >= self.low) and (self.high is None or value <= self.high)


Table = Mapping[str, Item]
Row = tuple[str, int, int, str, int | None, int | None, int | None, str]


def table_of(ram_start: int, *rows: Row) -> dict[str, Item]:
    """Rows (name, address, size, flags, low, high, initial, unit) as a table.

    Flags: s signed, r read only, m sign in bit 10, v RAM below `ram_start`, h hybrid.
    """
    return {
        name: Item(
            name, address, size, "s" in flags, "r" not in flags, address < ram_start and not set(flags) & set("vh"),
            low, high, initial, *UNITS[unit], 10 if "m" in flags else None, "h" in flags,
        )
        for name, address, size, flags, low, high, initial, unit in rows
    }  # fmt: skip


_GAIN = 16383
_OFFSET = 1044479
_PROFILE = 32767

_X = table_of(
    64,
    ("model_number", 0, 2, "r", None, None, None, ""),
    ("model_information", 2, 4, "r", None, None, None, ""),
    ("firmware_version", 6, 1, "r", None, None, None, ""),
    ("id", 7, 1, "", 0, 252, 1, ""),
    ("baud_rate", 8, 1, "", 0, 7, 1, ""),
    ("return_delay_time", 9, 1, "", 0, 254, 250, "us"),
    ("drive_mode", 10, 1, "", 0, 13, 0, ""),
    ("operating_mode", 11, 1, "", 0, 16, 3, ""),
    ("secondary_id", 12, 1, "", 0, 255, 255, ""),
    ("protocol_type", 13, 1, "", 1, 22, 2, ""),
    ("homing_offset", 20, 4, "s", -_OFFSET, _OFFSET, 0, "tick"),
    ("moving_threshold", 24, 4, "", 0, 1023, 10, "rpm"),
    ("temperature_limit", 31, 1, "", 0, 100, 80, "degC"),
    ("max_voltage_limit", 32, 2, "", 95, 160, 160, "V"),
    ("min_voltage_limit", 34, 2, "", 95, 160, 95, "V"),
    ("pwm_limit", 36, 2, "", 0, 885, 885, "pwm"),
    ("velocity_limit", 44, 4, "", 0, 1023, 200, "rpm"),
    ("max_position_limit", 48, 4, "", 0, 4095, 4095, "tick"),
    ("min_position_limit", 52, 4, "", 0, 4095, 0, "tick"),
    ("startup_configuration", 60, 1, "", 0, 3, 0, ""),
    ("shutdown", 63, 1, "", 0, 63, 52, ""),
    ("torque_enable", 64, 1, "", 0, 1, 0, ""),
    ("led", 65, 1, "", 0, 1, 0, ""),
    ("status_return_level", 68, 1, "", 0, 2, 2, ""),
    ("registered_instruction", 69, 1, "r", 0, 1, 0, ""),
    ("hardware_error_status", 70, 1, "r", None, None, 0, ""),
    ("velocity_i_gain", 76, 2, "", 0, _GAIN, 1920, ""),
    ("velocity_p_gain", 78, 2, "", 0, _GAIN, 100, ""),
    ("position_d_gain", 80, 2, "", 0, _GAIN, 0, ""),
    ("position_i_gain", 82, 2, "", 0, _GAIN, 0, ""),
    ("position_p_gain", 84, 2, "", 0, _GAIN, 800, ""),
    ("feedforward_2nd_gain", 88, 2, "", 0, _GAIN, 0, ""),
    ("feedforward_1st_gain", 90, 2, "", 0, _GAIN, 0, ""),
    ("bus_watchdog", 98, 1, "s", 0, 127, 0, "watchdog"),
    ("goal_pwm", 100, 2, "s", -885, 885, None, "pwm"),
    ("goal_velocity", 104, 4, "s", None, None, None, "rpm"),
    ("profile_acceleration", 108, 4, "", 0, _PROFILE, 0, "acc"),
    ("profile_velocity", 112, 4, "", 0, _PROFILE, 0, "rpm"),
    ("goal_position", 116, 4, "s", None, None, None, "tick"),
    ("realtime_tick", 120, 2, "r", 0, _PROFILE, None, "ms"),
    ("moving", 122, 1, "r", 0, 1, 0, ""),
    ("moving_status", 123, 1, "r", None, None, 0, ""),
    ("present_pwm", 124, 2, "sr", None, None, None, "pwm"),
    ("present_velocity", 128, 4, "sr", None, None, None, "rpm"),
    ("present_position", 132, 4, "sr", None, None, None, "tick"),
    ("velocity_trajectory", 136, 4, "sr", None, None, None, "rpm"),
    ("position_trajectory", 140, 4, "sr", None, None, None, "tick"),
    ("present_input_voltage", 144, 2, "r", None, None, None, "V"),
    ("present_temperature", 146, 1, "r", None, None, None, "degC"),
    ("backup_ready", 147, 1, "r", 0, 1, 0, ""),
)  # fmt: skip
_CURRENT = table_of(
    64,
    ("current_limit", 38, 2, "", 0, 1193, 1193, "mA"),
    ("goal_current", 102, 2, "s", None, None, None, "mA"),
    ("present_current", 126, 2, "sr", None, None, None, "mA"),
)  # fmt: skip
_LOAD = table_of(64, ("present_load", 126, 2, "sr", -1000, 1000, None, "%"))
_PWM_SLOPE = table_of(64, ("pwm_slope", 62, 1, "", 1, 255, 140, ""))
_ACCELERATION_LIMIT = table_of(64, ("acceleration_limit", 40, 4, "", 0, 32767, 32767, "acc"))

X_CURRENT, X_LOAD, X330 = _X | _CURRENT, _X | _LOAD, _X | _CURRENT | _PWM_SLOPE
_MX2 = {k: v for k, v in _X.items() if k not in ("startup_configuration", "backup_ready")} | _ACCELERATION_LIMIT
MX2_CURRENT, MX2_LOAD = _MX2 | _CURRENT, _MX2 | _LOAD

_PROTOCOL_1 = table_of(
    24,
    ("model_number", 0, 2, "r", None, None, None, ""),
    ("firmware_version", 2, 1, "r", None, None, None, ""),
    ("id", 3, 1, "", 0, 252, 1, ""),
    ("baud_rate", 4, 1, "", 0, 254, 1, ""),
    ("return_delay_time", 5, 1, "", 0, 254, 250, "us"),
    ("min_position_limit", 6, 2, "", 0, 1023, 0, "tick"),
    ("max_position_limit", 8, 2, "", 0, 1023, 1023, "tick"),
    ("temperature_limit", 11, 1, "", 0, 100, 70, "degC"),
    ("min_voltage_limit", 12, 1, "", 50, 250, 60, "V"),
    ("max_voltage_limit", 13, 1, "", 50, 250, 140, "V"),
    ("max_torque", 14, 2, "", 0, 1023, 1023, "%"),
    ("status_return_level", 16, 1, "", 0, 2, 2, ""),
    ("alarm_led", 17, 1, "", 0, 127, 36, ""),
    ("shutdown", 18, 1, "", 0, 127, 36, ""),
    ("torque_enable", 24, 1, "", 0, 1, 0, ""),
    ("led", 25, 1, "", 0, 1, 0, ""),
    ("goal_position", 30, 2, "", 0, 1023, None, "tick"),
    ("moving_speed", 32, 2, "m", -1023, 1023, None, "rpm_ax"),
    ("torque_limit", 34, 2, "", 0, 1023, None, "%"),
    ("present_position", 36, 2, "r", None, None, None, "tick"),
    ("present_speed", 38, 2, "rm", None, None, None, "rpm_ax"),
    ("present_load", 40, 2, "rm", None, None, None, "%"),
    ("present_input_voltage", 42, 1, "r", None, None, None, "V"),
    ("present_temperature", 43, 1, "r", None, None, None, "degC"),
    ("registered_instruction", 44, 1, "r", 0, 1, 0, ""),
    ("moving", 46, 1, "r", 0, 1, 0, ""),
    ("lock", 47, 1, "", 0, 1, 0, ""),
    ("punch", 48, 2, "", 0, 1023, 32, ""),
)  # fmt: skip
AX = _PROTOCOL_1 | table_of(
    24,
    ("cw_compliance_margin", 26, 1, "", 0, 255, 1, "tick"),
    ("ccw_compliance_margin", 27, 1, "", 0, 255, 1, "tick"),
    ("cw_compliance_slope", 28, 1, "", 0, 254, 32, ""),
    ("ccw_compliance_slope", 29, 1, "", 0, 254, 32, ""),
)  # fmt: skip
MX1 = (
    _PROTOCOL_1
    | table_of(
        24,
        ("baud_rate", 4, 1, "", 0, 254, 34, ""),
        ("min_position_limit", 6, 2, "", 0, 4095, 0, "tick"),
        ("max_position_limit", 8, 2, "", 0, 4095, 4095, "tick"),
        ("temperature_limit", 11, 1, "", 0, 100, 80, "degC"),
        ("max_voltage_limit", 13, 1, "", 50, 250, 240, "V"),
        ("multi_turn_offset", 20, 2, "s", -24576, 24576, 0, "tick"),
        ("resolution_divider", 22, 1, "", 1, 4, 1, ""),
        ("position_d_gain", 26, 1, "", 0, 254, 0, ""),
        ("position_i_gain", 27, 1, "", 0, 254, 0, ""),
        ("position_p_gain", 28, 1, "", 0, 254, 32, ""),
        ("goal_position", 30, 2, "s", -28672, 28672, None, "tick"),
        ("moving_speed", 32, 2, "m", -1023, 1023, None, "rpm_mx"),
        ("present_position", 36, 2, "sr", None, None, None, "tick"),
        ("present_speed", 38, 2, "rm", None, None, None, "rpm_mx"),
        ("punch", 48, 2, "", 0, 1023, 0, ""),
        ("realtime_tick", 50, 2, "r", None, None, 0, "ms"),
        ("goal_acceleration", 73, 1, "", 0, 254, 0, "acc_mx"),
    )
)  # fmt: skip
MX1_CURRENT = MX1 | table_of(
    24,
    ("present_current", 68, 2, "r", 0, 4095, 2048, "4.5mA"),
    ("torque_control_mode", 70, 1, "", 0, 1, 0, ""),
    ("goal_torque", 71, 2, "m", -1023, 1023, 0, "4.5mA"),
)  # fmt: skip


def with_values(table: Table, **values: tuple[int | None, int | None, int | None]) -> dict[str, Item]:
    """A table with other (low, high, initial) values of the named items."""
    return dict(table) | {
        name: replace(table[name], low=low, high=high, initial=initial) for name, (low, high, initial) in values.items()
    }


HARDWARE_ERRORS = {
    0: "input voltage", 1: "motor hall sensor", 2: "overheating", 3: "encoder", 4: "electrical shock", 5: "overload",
}  # fmt: skip
"""Bits of hardware_error_status and of shutdown (X, MX 2.0, P; the hall sensor's of P alone)."""


def hardware_error_text(status: int) -> str:
    """The set bits of hardware_error_status in words."""
    return ", ".join(text for bit, text in HARDWARE_ERRORS.items() if status >> bit & 1) or "none"


FEEDBACK_LENGTH = 10
"""Present current (or load), velocity and position stand side by side on every protocol 2.0 servo (X: 126, 128, 132; Y: 546;
P: 574): one read brings all."""
