"""Settings of the servos against what the robot file needs: found out at the start, corrected only when told to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from daemon.bus.models import BusModel
from daemon.bus.multi import RobotBus
from daemon.bus.registers import EXTENDED_POSITION_MODE, POSITION_MODE, hardware_error_text
from daemon.errors import BusMismatchError, CommandError, MismatchRow
from retarget.robot import RobotModel, ServoSpec
from retarget.ticks import JointServoMap

_MODES = {False: (POSITION_MODE, "position"), True: (EXTENDED_POSITION_MODE, "extended position")}
_REVERSED, _TIME_BASED, _TORQUE_BY_GOAL = 0b0001, 0b0100, 0b1000
"""Of drive_mode. Torque by goal: after a reboot the next goal would switch torque on, wherever the joint hangs by then."""
_TORQUE_AT_POWER_ON = 0b01  # of startup_configuration
_SHUTDOWN_ON = 0b100100  # overheating, overload: the same bits in both protocols
_ITEMS = (
    "return_delay_time", "drive_mode", "operating_mode", "homing_offset", "temperature_limit", "max_position_limit",
    "min_position_limit", "startup_configuration", "shutdown", "status_return_level", "hardware_error_status",
    "present_input_voltage", "present_temperature",
)  # fmt: skip
_HOT_MARGIN_C = 10
NEEDED, ADVISED = "needed", "advised"
"""Severity: without it the robot does not do what it is told, or only less well."""


@dataclass(frozen=True)
class Finding:
    """One setting that is not as it should be.

    Attributes:
        servo_id: of the servo.
        joint_name: it drives.
        item: of the control table.
        found, expected: in words.
        severity: NEEDED or ADVISED.
        remedy: what to do by hand.
        fix: value that `fix` writes; None where a person has to act.
    """

    servo_id: int
    joint_name: str
    item: str
    found: str
    expected: str
    severity: str
    remedy: str
    fix: int | None = None


def check_servos(bus: RobotBus, robot: RobotModel) -> list[Finding]:
    """What is not as it should be, servo by servo; reads only."""
    findings: list[Finding] = []
    ticks = JointServoMap(robot)
    ends = {
        s.servo_id: (int(low), int(high))
        for s, low, high in zip(robot.servos, ticks.position_min_tick, ticks.position_max_tick, strict=True)
    }
    for servo, model, firmware in zip(bus.servos, bus.models, bus.firmware, strict=True):
        values = bus.read_items(servo.servo_id, _ITEMS)
        findings += _of_servo(servo, ends[servo.servo_id], model, firmware, values)
    return findings


def require_needed(findings: Sequence[Finding]) -> None:
    """Refuse servos whose settings would make the robot do something else than it is told.

    Raises:
        BusMismatchError: with a table of them.
    """
    rows = [
        MismatchRow(f.servo_id, f.joint_name, f"{f.item} {f.expected}", f.found)
        for f in findings
        if f.severity == NEEDED
    ]
    if rows:
        raise BusMismatchError(rows, "correct them with torque off: mmmd doctor --fix")


def fix(bus: RobotBus, findings: Sequence[Finding]) -> list[Finding]:
    """Correct what can be, each confirmed by reading it back; what is left.

    Raises:
        CommandError: a servo holds torque: its settings cannot be written, and it must not be let go unasked.
    """
    to_fix = [f for f in findings if f.fix is not None]
    holding = sorted({f.servo_id for f in to_fix if bus.read_item(f.servo_id, "torque_enable")})
    if holding:
        ids = ", ".join(map(str, holding))
        raise CommandError(f"servo {ids}: torque is on; park the robot first (mmmd park), then fix")
    left = [f for f in findings if f.fix is None]
    for f in to_fix:
        assert f.fix is not None
        bus.write_item(f.servo_id, f.item, f.fix)
        if bus.read_item(f.servo_id, f.item) != f.fix:
            left.append(f)
    return left


def _of_servo(
    servo: ServoSpec, ends_tick: tuple[int, int], model: BusModel, firmware: int, values: dict[str, int]
) -> list[Finding]:
    out: list[Finding] = []

    def note(item: str, found: str, expected: str, severity: str, remedy: str, fix: int | None = None) -> None:
        out.append(Finding(servo.servo_id, servo.joint_name, item, found, expected, severity, remedy, fix))

    def set_(item: str, value: int) -> str:
        return f"mmmd servo set {servo.servo_id} {item} {value}"

    v = values
    if v["return_delay_time"]:
        found = f"{2 * v['return_delay_time']} us"
        note("return_delay_time", found, "0 us", ADVISED, set_("return_delay_time", 0), 0)
    if v["status_return_level"] != 2:
        found = str(v["status_return_level"])
        note("status_return_level", found, "2 (answers all)", NEEDED, set_("status_return_level", 2), 2)
    mode, meaning = _MODES[servo.extended]
    if v.get("operating_mode", mode) != mode:
        expected = f"{mode} ({meaning})"
        note("operating_mode", str(v["operating_mode"]), expected, NEEDED, set_("operating_mode", mode), mode)
    offset = v.get("homing_offset", 0)
    if offset and servo.extended and model.has_watchdog(firmware):
        expected = "0 (its bus watchdog stays off: a trip would move the joint by the offset)"
        remedy = f"{set_('homing_offset', 0)}, which moves its zero by {-offset} ticks: then mmmd calibrate --limp"
        note("homing_offset", f"{offset} ticks", expected, ADVISED, remedy)
    drive = v.get("drive_mode", 0)
    right = drive & ~(_REVERSED | _TIME_BASED | _TORQUE_BY_GOAL)
    if drive != right:
        expected = f"{right} (direction is the robot file's, profiles in velocity, no torque by goal)"
        note("drive_mode", str(drive), expected, NEEDED, set_("drive_mode", right), right)
    startup = v.get("startup_configuration", 0)
    if startup & _TORQUE_AT_POWER_ON:
        right = startup & ~_TORQUE_AT_POWER_ON
        expected = f"{right} (no torque at power-on)"
        note("startup_configuration", str(startup), expected, NEEDED, set_("startup_configuration", right), right)
    if v["shutdown"] & _SHUTDOWN_ON != _SHUTDOWN_ON:
        right = v["shutdown"] | _SHUTDOWN_ON
        expected = f"{right} (overheating and overload cut the torque)"
        note("shutdown", str(v["shutdown"]), expected, ADVISED, set_("shutdown", right), right)
    for item, found, needed, outside in () if servo.extended else _limits(ends_tick, v):
        severity = NEEDED if outside else ADVISED
        note(item, str(found), f"{needed} (the joint's limit)", severity, set_(item, needed), needed)
    if v.get("hardware_error_status"):
        text = hardware_error_text(v["hardware_error_status"])
        note("hardware_error_status", text, "none", ADVISED, f"mmmd servo reboot {servo.servo_id}")
    volts, (low, high) = v["present_input_voltage"] / 10, model.voltage_v
    if not low <= volts <= high:
        note("present_input_voltage", f"{volts:.1f} V", f"{low:g} to {high:g} V", ADVISED, "check supply and wiring")
    if v["present_temperature"] > v["temperature_limit"] - _HOT_MARGIN_C:
        found, expected = f"{v['present_temperature']} degC", f"well below {v['temperature_limit']} degC"
        note("present_temperature", found, expected, ADVISED, "let it cool; look for a joint that binds")
    if model.watchdog_firmware is not None and not model.has_watchdog(firmware):
        remedy = "update it with the DYNAMIXEL Wizard"
        note("firmware_version", str(firmware), f"{model.watchdog_firmware} or later (bus watchdog)", ADVISED, remedy)
    return out


def _limits(ends_tick: tuple[int, int], v: dict[str, int]) -> list[tuple[str, int, int, bool]]:
    """Position limits that are not the joint's: (item, found, needed, whether goals would be refused)."""
    (low, high), found_low, found_high = ends_tick, v["min_position_limit"], v["max_position_limit"]
    out: list[tuple[str, int, int, bool]] = []
    if found_low != low:
        out.append(("min_position_limit", found_low, low, found_low > low))
    if found_high != high:
        out.append(("max_position_limit", found_high, high, found_high < high))
    return out
