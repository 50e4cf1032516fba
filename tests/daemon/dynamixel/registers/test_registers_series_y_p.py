"""Control tables of DYNAMIXEL-Y and -P against the pages of the e-manual, transcribed row by row, and what follows from them."""

from __future__ import annotations

import pytest

from daemon.dynamixel.registers.models import MODEL_NUMBERS, MODELS, IndirectWindow
from daemon.dynamixel.registers.registers_series_y_p import ERROR_CODES, HOLDING_ERRORS, P, Y, error_code_text

INT32 = (-(2**31), 2**31 - 1)

Y_ROWS = [  # e-manual, YM070-210-R099-RH, "Control Table Configuration": name, address, size, access, initial, low, high
    ("model_number", 0, 2, "R", None, None, None),
    ("bus_watchdog", 8, 2, "RW ram", 0, 0, 127),
    ("baud_rate", 12, 1, "RW", 1, 0, 9),
    ("return_delay_time", 13, 1, "RW", 250, 0, 254),
    ("status_return_level", 15, 1, "RW ram", 2, 0, 2),
    ("drive_mode", 32, 1, "RW", 0, 0, 77),
    ("operating_mode", 33, 1, "RW", 3, 0, 3),
    ("startup_configuration", 34, 1, "RW", 0, 0, 1),
    ("homing_offset", 52, 4, "RW", 0, *INT32),
    ("inverter_temperature_limit", 56, 1, "RW", 80, 0, 100),
    ("motor_temperature_limit", 57, 1, "RW", 60, 0, 100),
    ("max_voltage_limit", 60, 2, "RW", 320, 240, 400),
    ("min_voltage_limit", 62, 2, "RW", 160, 160, 400),
    ("pwm_limit", 64, 2, "RW", 1000, 0, 1000),
    ("current_limit", 66, 2, "RW", 2080, 0, 2080),
    ("acceleration_limit", 68, 4, "RW", 161, 0, 389090),
    ("velocity_limit", 72, 4, "RW", 2020, 0, 6486),
    ("max_position_limit", 76, 4, "RW", 262144, *INT32),
    ("min_position_limit", 84, 4, "RW", -262144, *INT32),
    ("electronic_gearratio_numerator", 96, 4, "RW", 99, 1, 1045576),
    ("safe_stop_time", 104, 2, "RW", 200, 0, 32767),
    ("controller_state", 152, 1, "R ram", None, None, None),
    ("error_code", 153, 1, "R ram", None, None, None),
    ("error_code_history_16", 169, 1, "R ram", None, None, None),
    ("velocity_p_gain", 216, 4, "RW hybrid", 24778, 0, INT32[1]),
    ("position_d_gain", 224, 4, "RW hybrid", 9090, 0, INT32[1]),
    ("position_p_gain", 232, 4, "RW hybrid", 6283185, 0, INT32[1]),
    ("profile_acceleration", 240, 4, "RW hybrid", 161, 0, 389090),
    ("profile_velocity", 244, 4, "RW hybrid", 2020, 0, 6486),
    ("profile_time", 252, 4, "RW hybrid", 800, 0, 524288),
    ("torque_enable", 512, 1, "RW ram", 0, 0, 1),
    ("goal_pwm", 524, 2, "RW ram", None, -1000, 1000),
    ("goal_position", 532, 4, "RW ram", None, None, None),
    ("moving_status", 541, 1, "R ram", None, None, None),
    ("present_current", 546, 2, "R ram", None, None, None),
    ("present_velocity", 548, 4, "R ram", None, None, None),
    ("present_position", 552, 4, "R ram", None, None, None),
    ("present_input_voltage", 568, 2, "R ram", None, None, None),
    ("present_inverter_temperature", 570, 1, "R ram", None, None, None),
    ("present_motor_temperature", 571, 1, "R ram", None, None, None),
    ("backup_ready", 919, 1, "R ram", None, None, None),
]
P_ROWS = [  # e-manual, PH42-020-S300-R, "Control Table of EEPROM Area" and "... of RAM Area"
    ("baud_rate", 8, 1, "RW", 1, 0, 9),
    ("operating_mode", 11, 1, "RW", 3, 0, 16),
    ("homing_offset", 20, 4, "RW", 0, *INT32),
    ("moving_threshold", 24, 4, "RW", 20, 0, 2920),
    ("temperature_limit", 31, 1, "RW", 80, 0, 100),
    ("max_voltage_limit", 32, 2, "RW", 350, 150, 350),
    ("min_voltage_limit", 34, 2, "RW", 150, 150, 350),
    ("pwm_limit", 36, 2, "RW", 2009, 0, 2009),
    ("current_limit", 38, 2, "RW", 4500, 0, 4500),
    ("acceleration_limit", 40, 4, "RW", 10765, 0, 4306173),
    ("velocity_limit", 44, 4, "RW", 2920, 0, 2920),
    ("max_position_limit", 48, 4, "RW", 303454, -303750, 303750),
    ("min_position_limit", 52, 4, "RW", -303454, -303750, 303750),
    ("external_port_mode_4", 59, 1, "RW", 3, 0, 3),
    ("shutdown", 63, 1, "RW", 58, 0, 255),
    ("torque_enable", 512, 1, "RW ram", 0, 0, 1),
    ("status_return_level", 516, 1, "RW ram", 2, 0, 2),
    ("hardware_error_status", 518, 1, "R ram", 0, None, None),
    ("position_p_gain", 532, 2, "RW ram", None, 0, 32767),
    ("bus_watchdog", 546, 1, "RW ram", None, 0, 127),
    ("goal_pwm", 548, 2, "RW ram", None, -2009, 2009),
    ("profile_acceleration", 556, 4, "RW ram", None, 0, 4306173),
    ("profile_velocity", 560, 4, "RW ram", None, 0, 2920),
    ("goal_position", 564, 4, "RW ram", None, None, None),
    ("present_pwm", 572, 2, "R ram", None, None, None),
    ("present_current", 574, 2, "R ram", None, None, None),
    ("present_velocity", 576, 4, "R ram", None, None, None),
    ("present_position", 580, 4, "R ram", None, None, None),
    ("present_input_voltage", 592, 2, "R ram", None, None, None),
    ("present_temperature", 594, 1, "R ram", None, None, None),
    ("external_port_data_4", 606, 2, "RW ram", 0, 0, 4095),
]
ROWS = [pytest.param(t, r, id=f"{n}-{r[0]}") for n, t, rows in (("Y", Y, Y_ROWS), ("P", P, P_ROWS)) for r in rows]


@pytest.mark.parametrize(("table", "row"), ROWS)
def test_items_are_those_of_the_page(table, row) -> None:
    name, address, size, access, initial, low, high = row
    item = table[name]
    assert (item.address, item.size, item.initial, item.low, item.high) == (address, size, initial, low, high)
    assert item.writable == access.startswith("RW")
    assert (item.eeprom, item.hybrid) == ("ram" not in access and "hybrid" not in access, "hybrid" in access)


@pytest.mark.parametrize(
    ("name", "item", "scale", "unit"),
    [
        ("YM070-210-R099-RH", "present_velocity", 0.0010471976, "rad/s"),  # 0.01 rev/min
        ("YM070-210-R099-RH", "profile_acceleration", 0.0174532925, "rad/s2"),  # 10 rev/min2
        ("YM070-210-R099-RH", "present_current", 10.0, "mA"),
        ("YM070-210-R099-RH", "goal_pwm", 0.1, "%"),
        ("YM070-210-R099-RH", "bus_watchdog", 20.0, "ms"),
        ("PH42-020-S300-R", "present_velocity", 0.0010471976, "rad/s"),
        ("PH42-020-S300-R", "profile_acceleration", 0.00174532925, "rad/s2"),  # 1 rev/min2
        ("PH42-020-S300-R", "present_current", 1.0, "mA"),
        ("PH42-020-S300-R", "bus_watchdog", 20.0, "ms"),
    ],
)
def test_units(name: str, item: str, scale: float, unit: str) -> None:
    found = MODELS[MODEL_NUMBERS[name]].table[item]
    assert found.scale == pytest.approx(scale, rel=1e-6) and found.unit == unit


def test_models_differ_in_number_speed_and_modes() -> None:
    """Pages of YM080-230-R099-RH ("Velocity Limit" 0 to 3,591), YM070-210-R099-RH (to 6,486) and PH42-020-S300-R."""
    y70, y80, p = (MODELS[n] for n in (4030, 4150, 2000))
    assert [m.name for m in (y70, y80, p)] == ["YM070-210-R099-RH", "YM080-230-R099-RH", "PH42-020-S300-R"]
    assert [m.table["profile_velocity"].high for m in (y70, y80)] == [6486, 3591]
    assert [m.table["acceleration_limit"].high for m in (y70, y80)] == [389090, 215515]
    assert y70.operating_modes == (0, 1, 3) and p.operating_modes == (0, 1, 3, 4, 16)
    assert [m.ticks_per_turn for m in (y70, y80, p)] == [524288, 524288, 607500]
    assert not any(m.has_fast_sync(255) for m in (y70, y80, p)), "the manual says nothing of it"
    assert all(m.has_watchdog(1) and m.watchdog_stops for m in (y70, y80, p))


def test_feedback_stands_side_by_side_in_one_order() -> None:
    """Current, velocity, position: 546 of Y, 574 of P, as 126 of X."""
    for model in (m for m in MODELS.values() if m.protocol == 2.0):
        at = model.feedback_address
        effort, velocity, position = (
            model.table[n] for n in (model.effort_item, "present_velocity", "present_position")
        )
        assert [(i.address - at, i.size, i.signed) for i in (effort, velocity, position)] == [
            (0, 2, True), (2, 4, True), (6, 4, True),
        ], model.name  # fmt: skip
    assert (MODELS[4030].feedback_address, MODELS[2000].feedback_address) == (546, 574)


def test_indirect_windows_hold_128_bytes_and_are_kept_without_power() -> None:
    """Y: addresses 256 to 510, of anything up to 919. P: 168 to 422, of its RAM alone. Both show at 634 to 761."""
    assert MODELS[4030].indirect_windows(1) == (IndirectWindow(256, 634, 128, True, 0, 919),)
    assert MODELS[2000].indirect_windows(1) == (IndirectWindow(168, 634, 128, True, 512, 1023),)


@pytest.mark.parametrize("number", [4030, 4150, 2000])
@pytest.mark.parametrize(
    ("baud", "code"), [(57600, 1), (4_000_000, 6), (4_500_000, 7), (6_000_000, 8), (10_500_000, 9), (250_000, None)]
)
def test_bauds_of_both_go_up_to_10_5_mbit(number: int, baud: int, code: int | None) -> None:
    """Pages of both, "Baud Rate"; X end at code 7."""
    assert MODELS[number].baud_code(baud) == code
    assert code is None or MODELS[number].baud_of_code(code) == baud
    assert MODELS[1020].baud_of_code(8) is None


def test_errors_of_a_y_are_codes_not_bits() -> None:
    """Page, "Error Code(153)": 5 is overload, not "input voltage, overheating"; 17 to 20 and the battery's 9 keep torque."""
    y, p = MODELS[4030], MODELS[2000]
    assert (y.error_item, p.error_item, MODELS[12].error_item) == ("error_code", "hardware_error_status", "")
    assert y.error_text(5) == "overload" and y.error_text(0) == "none" and error_code_text(99) == "code 99"
    assert p.error_text(0b10) == "motor hall sensor", 'page of P, "Shutdown(63)", bit 1'
    assert set(HOLDING_ERRORS) < set(ERROR_CODES) and ERROR_CODES[18] == "bus watchdog"


@pytest.mark.parametrize(
    ("number", "raw", "decivolt"), [(4030, 2400, 240), (4030, 240, 240), (4030, 1600, 160), (2000, 240, 240)]
)
def test_a_voltage_of_a_y_is_known_in_either_unit(number: int, raw: int, decivolt: int) -> None:
    """Its page says 0.01 V, ROBOTIS' table file 0.1 V: between 16 and 40 V no value fits both."""
    assert MODELS[number].decivolt(raw) == decivolt


def test_of_two_temperatures_the_one_nearer_to_its_limit_is_told() -> None:
    """Motor 60, inverter 80 degrees from the factory."""
    y = MODELS[4030]
    told = [
        y.temperature_c({"present_motor_temperature": motor, "present_inverter_temperature": inverter})
        for motor, inverter in ((40, 50), (40, 70))
    ]
    assert told == [40, 50] and y.temperature_c({}) is None
