"""One simulated servo of Protocol 2.0 (X and MX): what each register does, and the error each mistake earns.

ROBOTIS e-manual, "Control Table" of XM430-W350, XL430-W250 and XL330-M288. Time is handed in, never read. Where the
manual is silent we chose, and say so in docs/simulator.md: a write with one bad item writes nothing; an address without
an item reads as zero; torque that was latched off stays off until a reboot.
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass

from daemon.bus.models import MODELS
from daemon.bus.packet import ALERT_BIT, ErrorCode
from daemon.bus.registers import VELOCITY_UNIT_RAD_S, WATCHDOG_TRIPPED, WATCHDOG_UNIT_S, Item
from retarget.robot import ServoSpec
from sim.drive import STEP_S, Drives, Mode
from sim.errors import SimSettingError
from sim.memory import INDIRECT, Memory

_FIRMWARE = {"x330": 52, "mx1": 41, "ax": 24}
_FIRMWARE_X = 45
BOOT_S = 0.2
"""Silence after a reboot (our estimate)."""
OVERLOAD_BIT, ENCODER_BIT, HEAT_BIT, VOLTAGE_BIT = 1 << 5, 1 << 3, 1 << 2, 1 << 0
OVERLOAD_SHARE = 0.8
"""Filtered share of the stall current that counts as overload (our estimate)."""
RESET_SHARE = 0.75
"""Share of the lowest allowed voltage below which the controller resets (our estimate)."""
_PWM_FULL = 885


@dataclass(frozen=True)
class Errors:
    """What a servo answers to mistakes that are made before a register is reached."""

    instruction: int
    length: int
    access: int


_GOALS = ("goal_position", "goal_velocity", "goal_pwm", "goal_current")
_POSITION_RANGE: dict[int, int] = {Mode.EXTENDED_POSITION: 1048575, Mode.CURRENT_POSITION: 1048575}
_LIMIT_OF = {"goal_velocity": "velocity_limit", "goal_current": "current_limit", "goal_pwm": "pwm_limit"}
_SINGLE_TURN = (Mode.POSITION,)
_LIVE_AT = range(120, 147)
_LIVE = struct.Struct("<HBBhhiiiiHB")  # realtime tick 120 ... temperature 146, side by side
_MS_PER_S, _TICK_WRAP_MS = 1000, 32768


class SimServo:
    """Registers of one servo, and what they make its motor do.

    Attributes:
        asked: names of the items that the last write was about, whether it was taken or not.
        baud: bits per second it listens at; None for a code without one.
    """

    errors = Errors(ErrorCode.INSTRUCTION, ErrorCode.DATA_LENGTH, ErrorCode.ACCESS)
    _measured_at = _LIVE_AT

    def __init__(self, spec: ServoSpec, drives: Drives, index: int, firmware: int | None = None) -> None:
        number = spec.model.model_number
        if number not in MODELS:
            raise SimSettingError(f"servo {spec.servo_id}: model number", str(number), ", ".join(map(str, MODELS)))
        self.spec, self.model, self.index = spec, MODELS[number], index
        self.drives = drives
        self.firmware = firmware if firmware is not None else _FIRMWARE.get(self.model.family, _FIRMWARE_X)
        self.memory = Memory(self.model, self.firmware, self._measured_at)
        self.rad_per_tick = float(drives.rad_per_tick[index])
        self._tick_s_per_unit = self._speed_unit_rad_s() / self.rad_per_tick
        self.watchdog_stops = self.model.watchdog_stops
        self.silent_until_s = -math.inf
        self.powered = True
        self.asked: list[str] = []
        self.baud: int | None = None
        self._torque = False
        self._fed_s = 0.0
        self._watchdog_s = math.inf
        self._turn_tick = 0.0
        self._sign, self._homing_tick, self._threshold_tick_s = 1, 0, 0.0
        self._pending: tuple[int, bytes] | None = None
        self._backup: bytes | None = None
        self._now_s = 0.0
        self._set("model_number", number)
        self._set("firmware_version", self.firmware)
        self._set("id", spec.servo_id)
        self._set_up()
        self._power_on(was_on=True)

    def _speed_unit_rad_s(self) -> float:
        return VELOCITY_UNIT_RAD_S

    # State.

    @property
    def servo_id(self) -> int:
        """Bus id."""
        return self.memory.get("id")

    @property
    def items(self) -> dict[str, Item]:
        """Items of the control table."""
        return self.memory.items

    @property
    def torque(self) -> bool:
        """Whether torque is on."""
        return self._torque

    @property
    def position_tick(self) -> float:
        """True position, finer than a tick, as the register counts."""
        return self._to_register(float(self.drives.position_tick[self.index]))

    @position_tick.setter
    def position_tick(self, tick: float) -> None:
        self.drives.place(self.index, self._to_shaft(tick))

    @property
    def is_faulted(self) -> bool:
        """Whether a hardware error is latched that took its torque."""
        return bool(self.memory.get("hardware_error_status") & self.memory.get("shutdown"))

    def get(self, name: str) -> int:
        """Value of an item, live ones refreshed."""
        if name.startswith(("present_", "moving", "realtime", "velocity_traj", "position_traj")):
            self._refresh()
        return self.memory.get(name)

    def _set(self, name: str, value: int) -> None:
        self.memory.set(name, value)

    def _set_up(self) -> None:
        """How somebody who knows sets a servo up for streaming; `restore_factory` undoes it."""
        self._set("return_delay_time", 0)
        self._set("operating_mode", Mode.EXTENDED_POSITION if self.spec.extended else Mode.POSITION)

    def set_baud(self, baud: int) -> None:
        """Set the baud as a tool would have.

        Raises:
            SimSettingError: the model cannot.
        """
        code = self.model.baud_code(baud)
        if code is None:
            raise SimSettingError(
                f"baud of servo {self.servo_id} ({self.model.name})", str(baud), "what its manual says"
            )
        self._set("baud_rate", code)
        self.baud = baud

    # Power.

    def trip(self, hardware_error: int) -> None:
        """Latch a hardware error; torque drops until a reboot where the shutdown mask says so."""
        self._set("hardware_error_status", self.memory.get("hardware_error_status") | hardware_error)
        if self.is_faulted:
            self._set_torque(False)

    def reboot(self) -> None:
        """Restart: RAM items return to their defaults, torque is off, latched errors and whole turns are gone."""
        for item in self.items.values():
            if not item.eeprom:
                self.memory.reset(item)
        self.silent_until_s = self._now_s + BOOT_S
        self._power_on()

    def _power_on(self, *, was_on: bool = False) -> None:
        """RAM is fresh; whole turns are forgotten, unless power `was_on` all the time."""
        self._pending = None
        self._set_torque(False)
        startup = self.memory.get("startup_configuration") if "startup_configuration" in self.items else 0
        if startup & 2:
            self._restore(ram_only=True)
        raw = float(self.drives.position_tick[self.index])
        turn = self.model.ticks_per_turn
        self._turn_tick = 0.0 if was_on else math.floor(raw / turn) * turn
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

    def _set_if(self, name: str, value: int) -> None:
        if name in self.items:
            self._set(name, value)

    def _goal_here(self) -> None:
        tick = round(self.position_tick)
        self._set("goal_position", tick)
        self.drives.set_goal(self.index, self._to_shaft(tick))

    def lose_power(self) -> None:
        """The supply is gone: no torque, no answer."""
        if self.powered:
            self.powered = False
            self._set_torque(False)

    def restore_power(self) -> None:
        """The supply is back: it starts anew."""
        if not self.powered:
            self.powered = True
            self.reboot()

    def restore_factory(self, keep: tuple[str, ...] = ()) -> None:
        """Every item as from the factory, but those in `keep`."""
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
        """Return to the copy; False when there is none."""
        return self._restore(ram_only=False)

    def _restore(self, *, ram_only: bool) -> bool:
        if self._backup is None:
            return False
        for item in self.items.values():
            if item.writable and not (ram_only and item.eeprom) and item.name not in ("torque_enable", *_GOALS):
                self._set(item.name, item.decode(self._backup[item.address : item.end]))
        self._configure()
        return True

    def clear_turns(self) -> bool:
        """Forget whole turns (instruction "Clear"); False while it moves."""
        if abs(float(self.drives.velocity_tick_s[self.index])) > 1.0:
            return False
        raw = float(self.drives.position_tick[self.index])
        self._turn_tick = math.floor(raw / self.model.ticks_per_turn) * self.model.ticks_per_turn
        self._goal_here()
        return True

    # Registers.

    def alert(self) -> int:
        """The alert bit for a status packet."""
        return ALERT_BIT if self.memory.get("hardware_error_status") else 0

    def read(self, address: int, length: int) -> tuple[int, bytes]:
        """Error code and `length` bytes at `address`."""
        self._refresh()
        data = self.memory.read(address, length)
        return (self.errors.access, b"") if data is None else (ErrorCode.NONE, data)

    def write(self, address: int, data: bytes) -> int:
        """Write whole items; the error code of the first that refuses, nothing written then."""
        accepted: list[tuple[Item, int]] = []
        self.asked = []
        for start, part in self.memory.runs(address, data):
            span = self.memory.span(start, len(part))
            if span.problem:
                return self.errors.length if span.problem == "short" else self.errors.access
            for item, at in span.items:
                value = item.decode(part[at : at + item.size])
                self.asked.append(item.name)
                error = self._refusal(item, value)
                if error:
                    return error
                accepted.append((item, value))
        if not accepted:
            return self.errors.length
        for item, value in accepted:
            self._accept(item, value)
        return ErrorCode.NONE

    def register(self, address: int, data: bytes) -> int:
        """Keep a write for `act` (instruction "Reg Write")."""
        self._pending = (address, data)
        self._set("registered_instruction", 1)
        return ErrorCode.NONE

    def act(self) -> tuple[int, bytes] | None:
        """The write that was kept, to be carried out now; None when there is none."""
        pending, self._pending = self._pending, None
        self._set("registered_instruction", 0)
        return pending

    def _refusal(self, item: Item, value: int) -> int:
        name = item.name
        if item.eeprom and self.torque:
            return ErrorCode.ACCESS
        if name in _GOALS and self.memory.get("bus_watchdog") == WATCHDOG_TRIPPED:
            return ErrorCode.DATA_RANGE
        if not item.takes(value):
            return ErrorCode.DATA_RANGE
        if name == "torque_enable" and value and self.is_faulted:
            return ErrorCode.RESULT_FAIL
        if name == "operating_mode" and value not in self.model.operating_modes:
            return ErrorCode.DATA_RANGE
        if name == "baud_rate" and self.model.baud_of_code(value) is None:
            return ErrorCode.DATA_RANGE
        low, high = self._limits(name)
        return ErrorCode.NONE if low <= value <= high else ErrorCode.DATA_LIMIT

    def _limits(self, name: str) -> tuple[float, float]:
        """What other items allow."""
        if name == "goal_position":
            mode = self.memory.get("operating_mode")
            if mode == Mode.POSITION:
                return self.memory.get("min_position_limit"), self.memory.get("max_position_limit")
            far = _POSITION_RANGE.get(mode, math.inf)
            return -far, far
        limit = _LIMIT_OF.get(name)
        most = math.inf if limit is None else self.memory.get(limit)
        return -most, most

    def _accept(self, item: Item, value: int) -> None:
        name = item.name
        if name == "goal_position":
            self._set(name, value)
            self.drives.set_goal(self.index, self._to_shaft(value))
            drive_mode = self.memory.get("drive_mode")
            if drive_mode & 8 and not self.torque and not self.is_faulted:
                self._set_torque(True)  # drive mode bit 3: torque on by goal update
            if drive_mode & 4:
                self._configure()  # a profile in time depends on the way to go
        elif name == "torque_enable":
            self._set_torque(bool(value))
        else:
            self._set(name, value)
            if name == "operating_mode":
                self._change_mode()
            if name == "bus_watchdog":
                self.fed(self._now_s)
            if not name.startswith(INDIRECT):
                self._configure()

    def _change_mode(self) -> None:
        """A new operating mode starts with its own defaults (e-manual, "Operating Mode", note)."""
        for name in ("position_p_gain", "position_i_gain", "position_d_gain", "velocity_p_gain", "velocity_i_gain",
                     "feedforward_1st_gain", "feedforward_2nd_gain", "profile_velocity", "profile_acceleration"):  # fmt: skip
            self.memory.reset(self.items[name])
        if self.memory.get("operating_mode") in _SINGLE_TURN:
            raw = float(self.drives.position_tick[self.index])
            self._turn_tick = math.floor(raw / self.model.ticks_per_turn) * self.model.ticks_per_turn
        self._reset_goals()

    def _set_torque(self, on: bool) -> None:
        self._set("torque_enable", int(on))
        if on and not self.torque:
            self.drives.start(self.index)
            self.fed(self._now_s)
        self._torque = self.drives.torque[self.index] = on
        self.drives.touch()

    def _configure(self) -> None:
        """Hand what the registers say to the drive."""
        get, i, d = self.memory.get, self.index, self.drives
        self._sign = -1 if get("drive_mode") & 1 else 1
        self._homing_tick = get("homing_offset")
        self._threshold_tick_s = get("moving_threshold") * self._tick_s_per_unit
        units = 1.0 / _PWM_FULL
        mode = get("operating_mode")
        d.mode[i] = mode
        pwm = get("goal_pwm")
        d.goal_duty[i] = self._sign * pwm * units
        d.limit_duty[i] = (get("pwm_limit") if mode == Mode.PWM else min(abs(pwm), get("pwm_limit"))) * units
        if "goal_current" in self.items:
            ampere = self.items["goal_current"].scale * 1e-3
            goal = get("goal_current")
            most = min(abs(goal), get("current_limit")) if mode == Mode.CURRENT_POSITION else get("current_limit")
            d.goal_a[i], d.limit_a[i] = self._sign * goal * ampere, most * ampere
        d.goal_tick_s[i] = self._sign * get("goal_velocity") * self._tick_s_per_unit
        d.p_gain[i] = get("position_p_gain") / 128 * units
        d.i_gain[i] = get("position_i_gain") / 65536 * units * _MS_PER_S
        d.d_gain[i] = get("position_d_gain") / 16 * units / _MS_PER_S
        d.velocity_p_gain[i] = get("velocity_p_gain") / 128 * units / self._tick_s_per_unit
        d.velocity_i_gain[i] = get("velocity_i_gain") / 65536 * units * _MS_PER_S / self._tick_s_per_unit
        d.feedforward_1[i] = get("feedforward_1st_gain") / 4 * units / self._tick_s_per_unit
        d.feedforward_2[i] = get("feedforward_2nd_gain") / 4 * units / self._tick_s2_per_unit
        d.profile_tick_s[i], d.profile_tick_s2[i] = self._profile()
        self.baud = self.model.baud_of_code(get("baud_rate"))
        watchdog = get("bus_watchdog")
        has = watchdog > 0 and self.model.has_watchdog(self.firmware)
        self._watchdog_s = watchdog * WATCHDOG_UNIT_S if has else math.inf
        d.touch()

    def _profile(self) -> tuple[float, float]:
        """Top speed and acceleration of the profile in ticks; inf for none."""
        velocity, acceleration = self.memory.get("profile_velocity"), self.memory.get("profile_acceleration")
        if not self.memory.get("drive_mode") & 4:
            top = min(velocity, self.memory.get("velocity_limit")) * self._tick_s_per_unit if velocity else math.inf
            return top, acceleration * self._tick_s2_per_unit if acceleration else math.inf
        if not velocity:
            return math.inf, math.inf
        whole_s = velocity / _MS_PER_S  # time-based profile: milliseconds from start to end, and of speeding up
        ramp_s = min(acceleration / _MS_PER_S, whole_s / 2)
        way = abs(float(self.drives.goal_tick[self.index] - self.drives.path_tick[self.index]))
        top = max(way, 1e-3) / max(whole_s - ramp_s, STEP_S)
        return top, top / ramp_s if ramp_s else math.inf

    # Frames and units.

    @property
    def _tick_s2_per_unit(self) -> float:
        return self.items["profile_acceleration"].scale / self.rad_per_tick

    def _to_register(self, shaft_tick: float) -> float:
        tick = shaft_tick - self._turn_tick
        if self._sign < 0:
            tick = self.model.ticks_per_turn - tick
        return tick + self._homing_tick

    def _to_shaft(self, register_tick: float) -> float:
        tick = register_tick - self._homing_tick
        if self._sign < 0:
            tick = self.model.ticks_per_turn - tick
        return tick + self._turn_tick

    # Time.

    def fed(self, t_s: float) -> None:
        """An instruction packet passed on the bus: the watchdog starts anew."""
        self._fed_s = t_s

    def watch(self, t_s: float) -> None:
        """The bus watchdog: stop where it stands, without a ramp, when nothing was heard for too long."""
        self._now_s = t_s
        if t_s - self._fed_s <= self._watchdog_s or not self.torque:
            return
        self._set("bus_watchdog", WATCHDOG_TRIPPED)
        self._watchdog_s = math.inf
        if not self.watchdog_stops:
            return  # flags the trip but keeps moving: seen on servos of the 330 size
        for name in ("profile_velocity", "profile_acceleration"):
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

    def judge(self) -> None:
        """Latch what voltage, temperature and load have come to."""
        if not self.powered:
            return
        live = self.drives.live()[self.index]
        decivolt = round(live[4] * 10)
        if decivolt < RESET_SHARE * self.model.voltage_v[0] * 10:
            return  # too low even to notice: the world takes its power away
        if not self.memory.get("min_voltage_limit") <= decivolt <= self.memory.get("max_voltage_limit"):
            self._latch(VOLTAGE_BIT)
        if live[5] > self.memory.get("temperature_limit"):
            self._latch(HEAT_BIT)
        if self.torque and self.drives.load[self.index] > OVERLOAD_SHARE:
            self._latch(OVERLOAD_BIT)

    def _latch(self, bit: int) -> None:
        if not self.memory.get("hardware_error_status") & bit:
            self.trip(bit)

    def _refresh(self) -> None:
        """Write what is measured into the table."""
        position, velocity, current, duty, voltage, temperature, path, path_speed = self.drives.live()[self.index]
        sign, per_unit = self._sign, self._tick_s_per_unit
        moving = abs(velocity) > self._threshold_tick_s
        here = self._to_register(position)
        arrived = abs(self.memory.get("goal_position") - here) < 10
        if self.model.has_current:
            effort = sign * current / (self.items["present_current"].scale * 1e-3)
        else:
            effort = sign * duty * 1000
        self.memory.measure(
            _LIVE, int(self._now_s * _MS_PER_S) % _TICK_WRAP_MS, int(moving), int(arrived) | int(path_speed != 0) << 1,
            round(sign * duty * _PWM_FULL), round(effort), round(sign * velocity / per_unit), round(here),
            round(sign * path_speed / per_unit), round(self._to_register(path)),
            max(0, round(voltage * 10)), max(0, min(255, round(temperature))),
        )  # fmt: skip
