"""Required register values of one servo for a robot: each rule with the reason, the severity and the remedy."""

from __future__ import annotations

from dataclasses import dataclass, field

from daemon.dynamixel.registers.models import BusModel
from daemon.dynamixel.registers.registers import EXTENDED_POSITION_MODE, POSITION_MODE
from retarget.robot.robot import ServoSpec

ITEMS = (
    "return_delay_time", "drive_mode", "operating_mode", "homing_offset", "temperature_limit", "max_position_limit",
    "min_position_limit", "startup_configuration", "shutdown", "status_return_level", "hardware_error_status",
    "pwm_limit", "max_torque", "present_input_voltage", "present_temperature",
    "error_code", "electronic_gearratio_numerator", "electronic_gearratio_denominator", "motor_temperature_limit",
    "inverter_temperature_limit", "present_motor_temperature", "present_inverter_temperature",
)  # fmt: skip
"""Names of the items that the rules read, in every servo that has them."""
NEEDED, ADVISED = "needed", "advised"
"""Severities: a finding that keeps the robot from doing as commanded, or one that only makes it worse at it."""
_MODES = {False: (POSITION_MODE, "position"), True: (EXTENDED_POSITION_MODE, "extended position")}
_REVERSED, _TIME_BASED, _TORQUE_BY_GOAL = 0b0001, 0b0100, 0b1000
"""Bits of drive_mode. Torque by goal: after a reboot the next goal would switch torque on, wherever the joint hangs by then."""
_TORQUE_AT_POWER_ON = 0b01  # of startup_configuration
_SHUTDOWN_ON = 0b100100  # overheating, overload: the same bits in both protocols
_HOT_MARGIN_C = 10


@dataclass(frozen=True)
class Finding:
    """One setting that differs from the required one.

    Attributes:
        servo_id: id of the servo.
        joint_name: joint that the servo drives.
        item: item of the control table.
        found, expected: value found and value expected, in words.
        severity: NEEDED or ADVISED.
        remedy: correction by hand.
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


def items_of(model: BusModel) -> tuple[str, ...]:
    """Names of the items that the rules read in a servo of this model."""
    return (*ITEMS, "profile_velocity") if _may_have_profile(model) else ITEMS


def _may_have_profile(model: BusModel) -> bool:
    """Whether the servo may have a motion profile that no user has set.

    Series Y has a profile from the factory, slower than a path may be; for series P the manual leaves the profile after power-on
    open. X and MX start without a profile.
    """
    return "profile_velocity" in model.table and model.table["profile_velocity"].initial != 0


def findings_of(
    servo: ServoSpec, ends_tick: tuple[int, int], model: BusModel, firmware: int, values: dict[str, int]
) -> list[Finding]:
    """Settings of one servo that differ from the required ones.

    Args:
        servo: the servo as in the robot file.
        ends_tick: lowest and highest goal that its joint may get.
        model: model of the servo.
        firmware: firmware version that the servo reported.
        values: values of the items in `items_of` that the servo has.
    """
    rules = _Rules(servo, model, firmware, values)
    rules.answers()
    rules.motion(ends_tick)
    rules.torque()
    rules.condition()
    return rules.findings


@dataclass
class _Rules:
    """The rules, over the values of one servo."""

    servo: ServoSpec
    model: BusModel
    firmware: int
    values: dict[str, int]
    findings: list[Finding] = field(default_factory=list[Finding])

    def answers(self) -> None:
        """Check the settings of answers."""
        delay, level = self.values["return_delay_time"], self.values["status_return_level"]
        if delay:
            self._set("return_delay_time", f"{2 * delay} us", 0, "0 us", ADVISED)
        if level != 2:
            self._set("status_return_level", str(level), 2, "2 (answers all)", NEEDED)

    def motion(self, ends_tick: tuple[int, int]) -> None:
        """Check the settings that change the meaning of a goal."""
        v, extended = self.values, self.servo.extended
        mode, meaning = _MODES[extended]
        if v.get("operating_mode", mode) != mode:
            self._set("operating_mode", str(v["operating_mode"]), mode, f"{mode} ({meaning})", NEEDED)
        offset = v.get("homing_offset", 0)
        if offset and extended and self.model.has_watchdog(self.firmware):
            expected = "0 (its bus watchdog stays off: a trip would move the joint by the offset)"
            remedy = f"{self._command('homing_offset', 0)}, which moves its zero by {-offset} ticks: then mmmd calibrate --limp"
            self._note("homing_offset", f"{offset} ticks", expected, ADVISED, remedy)
        drive = v.get("drive_mode", 0)
        right = drive & ~(_REVERSED | _TIME_BASED | _TORQUE_BY_GOAL)
        if drive != right:
            expected = f"{right} (direction is the robot file's, profiles in velocity, no torque by goal)"
            self._set("drive_mode", str(drive), right, expected, NEEDED)
        for item in ("electronic_gearratio_numerator", "electronic_gearratio_denominator"):
            right = self.model.table[item].initial if item in v else None
            if right is not None and v[item] != right:
                self._set(item, str(v[item]), right, f"{right} (with another a tick is another angle)", NEEDED)
        self._profile()
        if not extended:
            low, high = ends_tick
            self._limit("min_position_limit", low, refuses=v["min_position_limit"] > low)
            self._limit("max_position_limit", high, refuses=v["max_position_limit"] < high)

    def _profile(self) -> None:
        """Check for a profile on top of the path; only advised for P, which forgets its profile, so that no fix would last."""
        if _may_have_profile(self.model) and self.values["profile_velocity"]:
            item, found = self.model.table["profile_velocity"], str(self.values["profile_velocity"])
            expected = "0 (no profile: it would not follow its path)"
            self._set(item.name, found, 0, expected, NEEDED if item.hybrid else ADVISED)

    def torque(self) -> None:
        """Check the settings by which torque goes on or off without a request, and the effort limits."""
        startup = self.values.get("startup_configuration", 0)
        shutdown = self.values.get("shutdown", _SHUTDOWN_ON)  # Y has none: every such error cuts the torque
        if startup & _TORQUE_AT_POWER_ON:
            right = startup & ~_TORQUE_AT_POWER_ON
            self._set("startup_configuration", str(startup), right, f"{right} (no torque at power-on)", NEEDED)
        if shutdown & _SHUTDOWN_ON != _SHUTDOWN_ON:
            right = shutdown | _SHUTDOWN_ON
            expected = f"{right} (overheating and overload cut the torque)"
            self._set("shutdown", str(shutdown), right, expected, ADVISED)
        for item in ("pwm_limit", "max_torque"):
            if self.values.get(item) == 0:
                remedy = f"{self._command(item, self.model.table[item].high or 0)} or less"
                self._note(item, "0", "above 0 (it exerts nothing)", NEEDED, remedy)

    def condition(self) -> None:
        """Check errors, supply, temperature and firmware."""
        v = self.values
        item = self.model.error_item
        if v.get(item):
            text = self.model.error_text(v[item])
            self._note(item, text, "none", ADVISED, f"mmmd servo reboot {self.servo.servo_id}")
        volts, (low, high) = self.model.decivolt(v["present_input_voltage"]) / 10, self.model.voltage_v
        if not low <= volts <= high:
            expected = f"{low:g} to {high:g} V"
            self._note("present_input_voltage", f"{volts:.1f} V", expected, ADVISED, "check supply and wiring")
        for t in self.model.thermometers:
            if v[t.present] > v[t.limit] - _HOT_MARGIN_C:
                found, expected = f"{v[t.present]} degC", f"well below {v[t.limit]} degC"
                self._note(t.present, found, expected, ADVISED, "let it cool; look for a joint that binds")
        since = self.model.watchdog_firmware
        if since is not None and self.firmware < since:
            expected = f"{since} or later (bus watchdog)"
            remedy = "update it with the DYNAMIXEL Wizard"
            self._note("firmware_version", str(self.firmware), expected, ADVISED, remedy)

    def _limit(self, item: str, needed: int, *, refuses: bool) -> None:
        """Check that a position limit equals the joint's; `refuses`: whether a wrong limit refuses goals in the joint's range."""
        found = self.values[item]
        if found != needed:
            self._set(item, str(found), needed, f"{needed} (the joint's limit)", NEEDED if refuses else ADVISED)

    def _set(self, item: str, found: str, right: int, expected: str, severity: str) -> None:
        """Add a finding that `fix` can correct."""
        self._note(item, found, expected, severity, self._command(item, right), right)

    def _command(self, item: str, value: int) -> str:
        return f"mmmd servo set {self.servo.servo_id} {item} {value}"

    def _note(self, item: str, found: str, expected: str, severity: str, remedy: str, fix: int | None = None) -> None:
        s = self.servo
        self.findings.append(Finding(s.servo_id, s.joint_name, item, found, expected, severity, remedy, fix))
