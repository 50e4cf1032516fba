"""Power and protection of a simulated servo: reboot, factory reset, backup, latched errors, the bus watchdog.

ROBOTIS e-manual, "Control Table" of XM430-W350 ("Hardware Error Status", "Shutdown", "Bus Watchdog", "Startup Configuration").
Torque that was latched off stays off until a reboot.
"""

from __future__ import annotations

import math

from daemon.dynamixel.registers.registers import WATCHDOG_TRIPPED
from retarget.robot.robot import ServoSpec
from sim.errors import SimSettingError
from sim.servos.drives import Drives, Mode
from sim.servos.servo_motor import ServoMotor

BOOT_S = 0.2
"""Seconds without answers after a reboot (our estimate)."""
OVERLOAD_BIT, ENCODER_BIT, HEAT_BIT, VOLTAGE_BIT = 1 << 5, 1 << 3, 1 << 2, 1 << 0
OVERLOAD_SHARE = 0.8
"""Filtered share of the stall current that counts as overload (our estimate)."""
RESET_SHARE = 0.75
"""Share of the lowest allowed voltage below which the controller resets (our estimate)."""
GOALS = ("goal_position", "goal_velocity", "goal_pwm", "goal_current")


class ServoPower(ServoMotor):
    """Reactions of a servo to its supply, to its errors and to a silent client.

    Attributes:
        silent_until_s: time until which the servo boots and does not answer.
        powered: whether its supply is there.
        watchdog_stops: whether a tripped bus watchdog stops it.
    """

    def __init__(self, spec: ServoSpec, drives: Drives, index: int, firmware: int | None = None) -> None:
        super().__init__(spec, drives, index, firmware)
        self.silent_until_s = -math.inf
        self.powered = True
        self.watchdog_stops = self.model.watchdog_stops
        self._pending: tuple[int, bytes] | None = None
        self._backup: bytes | None = None
        self._set_up()
        self._power_on(was_on=True)

    def _set_up(self) -> None:
        """Set the registers as for streaming by an experienced user; `restore_factory` undoes this."""
        self._set("return_delay_time", 0)
        self._set("operating_mode", Mode.EXTENDED_POSITION if self.spec.extended else Mode.POSITION)

    def set_baud(self, baud: int) -> None:
        """Set the baud directly, as another tool would have done before.

        Raises:
            SimSettingError: the model has no such baud.
        """
        code = self.model.baud_code(baud)
        if code is None:
            raise SimSettingError(
                f"baud of servo {self.servo_id} ({self.model.name})", str(baud), "what its manual says"
            )
        self._set("baud_rate", code)
        self.baud = baud

    # Power.

    def reboot(self) -> None:
        """Restart: RAM items return to their defaults, torque is off, latched errors and whole turns are gone."""
        for item in self.items.values():
            if not item.eeprom and not item.hybrid:
                self.memory.reset(item)
        self.silent_until_s = self._now_s + BOOT_S
        self._power_on()

    def _power_on(self, *, was_on: bool = False) -> None:
        """Reset RAM; forget whole turns, unless the servo `was_on` all the time."""
        self._pending, self._profile_type = None, 0
        self._set_torque(False)
        startup = self.memory.get("startup_configuration") if "startup_configuration" in self.items else 0
        if startup & 2:
            self._restore(ram_only=True)
        self._turn_tick = 0.0 if was_on else self._whole_turns()
        self._configure()
        self._reset_goals()
        self._configure()
        if startup & 1:
            self._set_torque(True)

    def _reset_goals(self) -> None:
        self._set_if("goal_pwm", self.memory.get("pwm_limit"))
        self._set_if("goal_current", self.memory.get("current_limit") if "current_limit" in self.items else 0)
        self._set_if("goal_velocity", 0)
        self._goal_here()

    def lose_power(self) -> None:
        """Take the supply away: no torque, no answer."""
        if self.powered:
            self.powered = False
            self._set_torque(False)

    def restore_power(self) -> None:
        """Bring the supply back: the servo boots."""
        if not self.powered:
            self.powered = True
            self.reboot()

    def restore_factory(self, keep: tuple[str, ...] = ()) -> None:
        """Set every item to its value from the factory, but those in `keep`."""
        kept = {name: self.memory.get(name) for name in (*keep, "model_number", "firmware_version")}
        for item in self.items.values():
            self.memory.reset(item)
        for name, value in kept.items():
            self._set(name, value)
        self._power_on()

    def store_backup(self) -> None:
        """Keep a copy of the table (instruction "Control Table Backup")."""
        self._backup = bytes(self.memory.bytes)
        self._set_if("backup_ready", 1)

    def restore_backup(self) -> bool:
        """Restore the copy of the table; return False when there is none."""
        return self._restore(ram_only=False)

    def _restore(self, *, ram_only: bool) -> bool:
        if self._backup is None:
            return False
        for item in self.items.values():
            if item.writable and not (ram_only and item.eeprom) and item.name not in ("torque_enable", *GOALS):
                self._set(item.name, item.decode(self._backup[item.address : item.end]))
        self._configure()
        return True

    def clear_turns(self) -> bool:
        """Forget whole turns (instruction "Clear"); return False while the shaft moves."""
        if abs(float(self.drives.velocity_tick_s[self.index])) > 1.0:
            return False
        self._turn_tick = self._whole_turns()
        self._goal_here()
        return True

    def _whole_turns(self) -> float:
        """Ticks of the whole turns that the shaft has made and that the servo forgets without power."""
        raw = float(self.drives.position_tick[self.index])
        return math.floor(raw / self.model.ticks_per_turn) * self.model.ticks_per_turn

    # Protection.

    @property
    def error(self) -> int:
        """The hardware error: bits, or the code of a Y; 0 for none."""
        return self.memory.get(self.model.error_item)

    @property
    def is_faulted(self) -> bool:
        """Whether a latched hardware error has taken the servo's torque."""
        return bool(self.memory.get("hardware_error_status") & self.memory.get("shutdown"))

    def trip(self, hardware_error: int) -> None:
        """Latch a hardware error; torque drops until a reboot where the shutdown mask says so."""
        self._set("hardware_error_status", self.memory.get("hardware_error_status") | hardware_error)
        if self.is_faulted:
            self._set_torque(False)

    def judge(self) -> None:
        """Latch the errors that voltage, temperature and load now call for."""
        if not self.powered:
            return
        live = self.drives.live()[self.index]
        decivolt = round(live[4] * 10)
        if decivolt < RESET_SHARE * self.model.voltage_v[0] * 10:
            return  # too low for the controller to run: the world takes its power away
        if not self.memory.get("min_voltage_limit") <= decivolt <= self.memory.get("max_voltage_limit"):
            self._latch(VOLTAGE_BIT)
        if live[5] > self.memory.get(self.model.thermometers[0].limit):
            self._latch(HEAT_BIT)
        if self.torque and self.drives.load[self.index] > OVERLOAD_SHARE:
            self._latch(OVERLOAD_BIT)

    def _latch(self, bit: int) -> None:
        if not self.memory.get("hardware_error_status") & bit:
            self.trip(bit)

    def fed(self, t_s: float) -> None:
        """Restart the bus watchdog: an instruction packet passed on the bus."""
        self._fed_s = t_s

    def watch(self, t_s: float) -> None:
        """Trip the bus watchdog when no packet came for its time: the shaft stops at once, without a ramp."""
        self._now_s = t_s
        if t_s - self._fed_s <= self._watchdog_s or not self.torque:
            return
        self._set("bus_watchdog", WATCHDOG_TRIPPED)
        self.watchdog_tripped = True
        self._watchdog_s = math.inf
        if not self.watchdog_stops:
            return  # flags the trip but keeps moving: seen on servos of the 330 size
        for name in ("profile_velocity", "profile_acceleration"):
            if not self.items[name].hybrid:
                self._set(name, 0)
        self._configure()
        if self.memory.get("operating_mode") == Mode.EXTENDED_POSITION and self.memory.get("homing_offset"):
            # DynamixelSDK#584: with a homing offset the stop itself moves the joint by it
            self.drives.set_goal(
                self.index, float(self.drives.position_tick[self.index]) + self.memory.get("homing_offset")
            )
            return
        self._goal_here()
        self.drives.goal_tick_s[self.index] = self.drives.goal_a[self.index] = 0.0
        if self.memory.get("operating_mode") == Mode.PWM:
            self.drives.goal_duty[self.index] = 0.0
        self.drives.touch()
