"""Control tables of DYNAMIXEL-Y and -P: addresses, sizes, ranges, units and error codes that differ from X throughout.

ROBOTIS e-manual, "Control Table" of YM070-210-R099-RH, YM080-230-R099-RH and PH42-020-S300-R; addresses and sizes compared
with ROBOTIS' dynamixel_hardware_interface, `param/dxl_model/ym070_210_r099.model` and `ph42_020_s300.model`. Where the two
disagree, or the manual with itself, a comment at the item says which was taken.
"""

from __future__ import annotations

from daemon.dynamixel.registers.registers import table_of

_INT32 = 2**31 - 1
_WORD = 32767
_Y_GAIN = _INT32
INVERTER_ABOVE_MOTOR_C = 20
"""Degrees by which the inverter of a Y may be hotter than its motor: 80 and 60 degrees are the limits from the factory."""
LOW_VOLTS_RAW = 400
"""Present input voltage of a Y: the manual says 0.01 V, `ym080_230_r099.model` 0.1 V. A Y runs on 16 to 40 V (its limits'
range), so a value up to 400 can only be in 0.1 V, and one above only in 0.01 V."""

Y = table_of(
    512,
    ("model_number", 0, 2, "r", None, None, None, ""),
    ("model_information", 2, 4, "r", None, None, None, ""),
    ("firmware_version", 6, 1, "r", None, None, None, ""),
    ("id", 7, 1, "", 0, 252, 1, ""),
    ("bus_watchdog", 8, 2, "sv", 0, 127, 0, "watchdog"),  # the page's table says no unit; its example counts 20 ms
    ("secondary_id", 10, 1, "", 0, 255, 255, ""),  # 0 to 252, says the page, and 255 from the factory
    ("protocol_type", 11, 1, "", 2, 10, 2, ""),
    ("baud_rate", 12, 1, "", 0, 9, 1, ""),
    ("return_delay_time", 13, 1, "", 0, 254, 250, "us"),
    ("status_return_level", 15, 1, "v", 0, 2, 2, ""),
    ("registered_instruction", 16, 1, "rv", 0, 1, 0, ""),
    ("drive_mode", 32, 1, "", 0, 77, 0, ""),
    ("operating_mode", 33, 1, "", 0, 3, 3, ""),
    ("startup_configuration", 34, 1, "", 0, 1, 0, ""),
    ("position_limit_threshold", 38, 2, "", 0, _WORD, 0, "tick"),
    ("in_position_threshold", 40, 4, "", 0, _INT32, 10, "tick"),
    ("following_error_threshold", 44, 4, "", 0, _INT32, 0, "tick"),
    ("moving_threshold", 48, 4, "", 0, _INT32, 10, "5tick/ms"),
    ("homing_offset", 52, 4, "s", -_INT32 - 1, _INT32, 0, "tick"),
    ("inverter_temperature_limit", 56, 1, "", 0, 100, 80, "degC"),
    ("motor_temperature_limit", 57, 1, "", 0, 100, 60, "degC"),
    ("max_voltage_limit", 60, 2, "", 240, 400, 320, "V"),
    ("min_voltage_limit", 62, 2, "", 160, 400, 160, "V"),  # 4 bytes in one state of the page, over the next item: 2
    ("pwm_limit", 64, 2, "", 0, 1000, 1000, "%"),
    ("current_limit", 66, 2, "", 0, 2080, 2080, "10mA"),
    ("acceleration_limit", 68, 4, "", 0, 389090, 161, "10rpm2"),
    ("velocity_limit", 72, 4, "", 0, 6486, 2020, "0.01rpm"),
    ("max_position_limit", 76, 4, "s", -_INT32 - 1, _INT32, 262144, "tick"),
    ("min_position_limit", 84, 4, "s", -_INT32 - 1, _INT32, -262144, "tick"),
    ("electronic_gearratio_numerator", 96, 4, "", 1, 1045576, 99, ""),
    ("electronic_gearratio_denominator", 100, 4, "", 1, 1045576, 1, ""),
    ("safe_stop_time", 104, 2, "", 0, _WORD, 200, "ms"),
    ("brake_delay", 106, 2, "", 0, _WORD, 0, "ms"),
    ("goal_update_delay", 108, 2, "", 0, _WORD, 0, "ms"),
    ("overexcitation_voltage", 110, 1, "", 0, 100, 100, ""),
    ("normal_excitation_voltage", 111, 1, "", 0, 100, 0, ""),
    ("overexcitation_time", 112, 2, "", 0, _WORD, 0, "ms"),
    ("present_velocity_lpf_frequency", 132, 2, "", 0, _WORD, 0, "0.1Hz"),
    ("goal_current_lpf_frequency", 134, 2, "", 0, _WORD, 0, "0.1Hz"),
    ("position_ff_lpf_time", 136, 2, "", 0, 512, 0, "0.2ms"),
    ("velocity_ff_lpf_time", 138, 2, "", 0, 512, 0, "0.2ms"),
    ("controller_state", 152, 1, "rv", None, None, None, ""),
    ("error_code", 153, 1, "rv", None, None, None, ""),
    *((f"error_code_history_{i}", 153 + i, 1, "rv", None, None, None, "") for i in range(1, 17)),
    ("hybrid_save", 170, 1, "v", 0, 2, 0, ""),
    ("velocity_i_gain", 212, 4, "h", 0, _Y_GAIN, 2446559, ""),
    ("velocity_p_gain", 216, 4, "h", 0, _Y_GAIN, 24778, ""),
    ("velocity_ff_gain", 220, 4, "h", 0, _Y_GAIN, 0, ""),
    ("position_d_gain", 224, 4, "h", 0, _Y_GAIN, 9090, ""),
    ("position_i_gain", 228, 4, "h", 0, _Y_GAIN, 0, ""),
    ("position_p_gain", 232, 4, "h", 0, _Y_GAIN, 6283185, ""),
    ("position_ff_gain", 236, 4, "h", 0, _Y_GAIN, 0, ""),
    ("profile_acceleration", 240, 4, "h", 0, 389090, 161, "10rpm2"),
    ("profile_velocity", 244, 4, "h", 0, 6486, 2020, "0.01rpm"),
    ("profile_acceleration_time", 248, 4, "h", 0, 262144, 400, "0.2ms"),
    ("profile_time", 252, 4, "h", 0, 524288, 800, "0.2ms"),
    ("torque_enable", 512, 1, "", 0, 1, 0, ""),
    ("led", 513, 1, "", 0, 1, 0, ""),
    ("pwm_offset", 516, 2, "s", -1000, 1000, 0, "%"),
    ("current_offset", 518, 2, "s", None, None, 0, "10mA"),
    ("velocity_offset", 520, 4, "s", None, None, 0, "0.01rpm"),
    # The page gives 0 for all goals. ROBOTIS' own AI Worker writes no goal but the position, and moves: what the others
    # really begin with is not known here. Arming sets goal_pwm.
    ("goal_pwm", 524, 2, "s", -1000, 1000, None, "%"),
    ("goal_current", 526, 2, "s", None, None, None, "10mA"),
    ("goal_velocity", 528, 4, "s", None, None, None, "0.01rpm"),
    ("goal_position", 532, 4, "s", None, None, None, "tick"),
    ("moving_status", 541, 1, "r", None, None, None, ""),
    ("realtime_tick", 542, 2, "r", 0, _WORD, None, "ms"),
    ("present_pwm", 544, 2, "sr", None, None, None, "%"),
    ("present_current", 546, 2, "sr", None, None, None, "10mA"),
    ("present_velocity", 548, 4, "sr", None, None, None, "0.01rpm"),
    ("present_position", 552, 4, "sr", None, None, None, "tick"),
    ("position_trajectory", 560, 4, "sr", None, None, None, "tick"),
    ("velocity_trajectory", 564, 4, "sr", None, None, None, "tick/s"),
    ("present_input_voltage", 568, 2, "r", None, None, None, "0.01V"),  # see LOW_VOLTS_RAW
    ("present_inverter_temperature", 570, 1, "r", None, None, None, "degC"),
    ("present_motor_temperature", 571, 1, "r", None, None, None, "degC"),
    ("backup_ready", 919, 1, "r", None, None, None, ""),
)  # fmt: skip
"""YM070-210-R099-RH; hybrid items (212 to 255) are kept without power and written at any time."""

P = table_of(
    512,
    ("model_number", 0, 2, "r", None, None, None, ""),
    ("model_information", 2, 4, "r", None, None, None, ""),
    ("firmware_version", 6, 1, "r", None, None, None, ""),
    ("id", 7, 1, "", 0, 252, 1, ""),
    ("baud_rate", 8, 1, "", 0, 9, 1, ""),
    ("return_delay_time", 9, 1, "", 0, 254, 250, "us"),
    ("drive_mode", 10, 1, "", 0, 13, 0, ""),  # 0 or 1 in the page's table; its description has bits 0, 2 and 3
    ("operating_mode", 11, 1, "", 0, 16, 3, ""),
    ("secondary_id", 12, 1, "", 0, 255, 255, ""),
    ("protocol_type", 13, 1, "", 2, 10, 2, ""),
    ("homing_offset", 20, 4, "s", -_INT32 - 1, _INT32, 0, "tick"),
    ("moving_threshold", 24, 4, "", 0, 2920, 20, "0.01rpm"),
    ("temperature_limit", 31, 1, "", 0, 100, 80, "degC"),
    ("max_voltage_limit", 32, 2, "", 150, 350, 350, "V"),
    ("min_voltage_limit", 34, 2, "", 150, 350, 150, "V"),
    ("pwm_limit", 36, 2, "", 0, 2009, 2009, "pwm_p"),  # 0.498 % in the table, 0.0498 % in the description: 2009 is all
    ("current_limit", 38, 2, "", 0, 4500, 4500, "1mA"),
    ("acceleration_limit", 40, 4, "", 0, 4306173, 10765, "rpm2"),
    ("velocity_limit", 44, 4, "", 0, 2920, 2920, "0.01rpm"),
    ("max_position_limit", 48, 4, "s", -303750, 303750, 303454, "tick"),
    ("min_position_limit", 52, 4, "s", -303750, 303750, -303454, "tick"),
    *((f"external_port_mode_{i}", 55 + i, 1, "", 0, 3, 3, "") for i in range(1, 5)),
    ("shutdown", 63, 1, "", 0, 255, 58, ""),
    ("torque_enable", 512, 1, "", 0, 1, 0, ""),
    ("led_red", 513, 1, "", 0, 255, 0, ""),
    ("led_green", 514, 1, "", 0, 255, 0, ""),
    ("led_blue", 515, 1, "", 0, 255, 0, ""),
    ("status_return_level", 516, 1, "", 0, 2, 2, ""),
    ("registered_instruction", 517, 1, "r", None, None, 0, ""),
    ("hardware_error_status", 518, 1, "r", None, None, 0, ""),
    # The page does not give the values of gains, watchdog, goals and profile after power-on.
    ("velocity_i_gain", 524, 2, "", 0, _WORD, None, ""),
    ("velocity_p_gain", 526, 2, "", 0, _WORD, None, ""),
    ("position_d_gain", 528, 2, "", 0, _WORD, None, ""),
    ("position_i_gain", 530, 2, "", 0, _WORD, None, ""),
    ("position_p_gain", 532, 2, "", 0, _WORD, None, ""),
    ("feedforward_2nd_gain", 536, 2, "", 0, _WORD, None, ""),
    ("feedforward_1st_gain", 538, 2, "", 0, _WORD, None, ""),
    ("bus_watchdog", 546, 1, "s", 0, 127, None, "watchdog"),
    ("goal_pwm", 548, 2, "s", -2009, 2009, None, "pwm_p"),
    ("goal_current", 550, 2, "s", None, None, None, "1mA"),
    ("goal_velocity", 552, 4, "s", None, None, None, "0.01rpm"),
    ("profile_acceleration", 556, 4, "", 0, 4306173, None, "rpm2"),
    ("profile_velocity", 560, 4, "", 0, 2920, None, "0.01rpm"),
    ("goal_position", 564, 4, "s", None, None, None, "tick"),
    ("realtime_tick", 568, 2, "r", 0, _WORD, None, "ms"),
    ("moving", 570, 1, "r", None, None, None, ""),
    ("moving_status", 571, 1, "r", None, None, None, ""),
    ("present_pwm", 572, 2, "sr", None, None, None, "pwm_p"),
    ("present_current", 574, 2, "sr", None, None, None, "1mA"),
    ("present_velocity", 576, 4, "sr", None, None, None, "0.01rpm"),
    ("present_position", 580, 4, "sr", None, None, None, "tick"),
    ("velocity_trajectory", 584, 4, "sr", None, None, None, "0.01rpm"),
    ("position_trajectory", 588, 4, "sr", None, None, None, "tick"),
    ("present_input_voltage", 592, 2, "r", None, None, None, "V"),
    ("present_temperature", 594, 1, "r", None, None, None, "degC"),
    *((f"external_port_data_{i}", 598 + 2 * i, 2, "", 0, 4095, 0, "") for i in range(1, 5)),
    ("backup_ready", 878, 1, "r", None, None, None, ""),  # from the table file; the page has none
)  # fmt: skip
"""PH42-020-S300-R."""

ERROR_CODES = {
    1: "over voltage", 2: "low voltage", 3: "inverter overheating", 4: "motor overheating", 5: "overload", 7: "inverter",
    9: "multi-turn battery is low", 10: "multi-turn battery", 11: "multi-turn position is lost", 12: "multi-turn",
    13: "encoder", 14: "hall sensor", 15: "calibration", 17: "following error", 18: "bus watchdog", 19: "over speed",
    20: "position limit reached",
}  # fmt: skip
"""Values of error_code (Y): one at a time, not bits (manual, "Error Code")."""
HOLDING_ERRORS = (9, 17, 18, 19, 20)
"""Error codes that leave torque on; all but the battery's make the servo stop and refuse goals until they are cleared."""


def error_code_text(code: int) -> str:
    """An error code in words."""
    return ERROR_CODES.get(code, f"code {code}") if code else "none"
