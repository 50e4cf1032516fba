"""Electrical and mechanical constants of each servo model's motor, seen behind the gears.

Rated voltage, no-load speed, stall torque and stall current: ROBOTIS e-manual (`_data/dxl_x_info.yml`, `_data/dxl_mx_info.yml`,
pages XM540 and AX); the stall currents of XM540 and AX are not in the shared facts and should be checked on a servo. DYNAMIXEL-Y
and -P (`_data/dxl_y_info.yml`, `_data/dxl_p_info.yml`, at 24 V): the manual gives no stall; for Y we use its maximum torque and
current (99:1), for P (303.75:1) its continuous torque per ampere at the highest current that its limit allows. All other constants
are our estimates and marked as such.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from sim.errors import SimSettingError

FRICTION_SHARE = 0.007
"""Share of the stall torque that is Coulomb friction of motor and gears; 0.03 N m of an XM430 in ROBOTIS' own OP3 model."""
VISCOUS_SHARE = 0.25
"""Viscous friction as a share of the torque-speed line's slope: ROBOTIS' OP3 model damps an XM430 by 1.08 N m s/rad, of which the
slope (stall torque over no-load speed) is 0.85.
"""
MECHANICAL_TIME_CONSTANT_S = 0.015
"""Seconds in which the unloaded servo reaches 63 % of its speed (our estimate); the inertia at the output follows from it."""
_THERMAL_TIME_CONSTANT_S = 600.0
_STALL_RISE_K = 300.0
"""Kelvin by which a servo warms up if stalled for ever: an XM430 passes 80 degrees after about two minutes, 40 % of stall settles
near 70."""
_STALL_RISE_Y_K = 100.0
"""Kelvin by which a stalled Y warms up: its motor trips at 60 degrees; half of its maximum current is allowed for long."""


@dataclass(frozen=True)
class Motor:
    """Constants of one servo model, seen at its output shaft.

    Attributes:
        rated_v, no_load_rad_s, stall_torque_nm, stall_current_a: from the manual.
        resistance_ohm: of the winding.
        torque_nm_per_a, emf_v_s_per_rad: chosen so that stall torque and no-load speed result after friction.
        friction_nm, damping_nm_s_per_rad: Coulomb and viscous friction.
        inertia_kg_m2: of the rotor, times the gear ratio squared.
        stall_rise_k: temperature rise if stalled for ever.
        heating_k_per_j: temperature rise of the case per joule.
        cooling_per_s: share of the difference to the room given off per second.
    """

    rated_v: float
    no_load_rad_s: float
    stall_torque_nm: float
    stall_current_a: float
    stall_rise_k: float = _STALL_RISE_K

    @property
    def resistance_ohm(self) -> float:
        """Resistance of the winding."""
        return self.rated_v / self.stall_current_a

    @property
    def friction_nm(self) -> float:
        """Coulomb friction of motor and gears."""
        return FRICTION_SHARE * self.stall_torque_nm

    @property
    def damping_nm_s_per_rad(self) -> float:
        """Viscous friction of motor and gears."""
        return VISCOUS_SHARE * self.stall_torque_nm / self.no_load_rad_s

    @property
    def torque_nm_per_a(self) -> float:
        """Torque at the output per ampere, before friction."""
        return (self.stall_torque_nm + self.friction_nm) / self.stall_current_a

    @property
    def emf_v_s_per_rad(self) -> float:
        """Voltage induced per output speed."""
        lost_nm = self.friction_nm + self.damping_nm_s_per_rad * self.no_load_rad_s
        idle_a = lost_nm / self.torque_nm_per_a
        return (self.rated_v - idle_a * self.resistance_ohm) / self.no_load_rad_s

    @property
    def inertia_kg_m2(self) -> float:
        """Rotor inertia times gear ratio squared."""
        slope = self.torque_nm_per_a * self.emf_v_s_per_rad / self.resistance_ohm + self.damping_nm_s_per_rad
        return MECHANICAL_TIME_CONSTANT_S * slope

    @property
    def heating_k_per_j(self) -> float:
        """Temperature rise of the case per joule of loss."""
        return self.stall_rise_k / (_THERMAL_TIME_CONSTANT_S * self.rated_v * self.stall_current_a)

    @property
    def cooling_per_s(self) -> float:
        """Share of the difference to the room given off per second."""
        return 1.0 / _THERMAL_TIME_CONSTANT_S


def _motor(
    rated_v: float, no_load_rpm: float, stall_torque_nm: float, stall_current_a: float, rise_k: float = _STALL_RISE_K
) -> Motor:
    return Motor(rated_v, no_load_rpm * 2 * math.pi / 60, stall_torque_nm, stall_current_a, rise_k)


MOTORS: dict[int, Motor] = {
    1190: _motor(5.0, 383, 0.215, 1.47),  # XL330-M077
    1200: _motor(5.0, 103, 0.52, 1.47),  # XL330-M288
    1230: _motor(5.0, 129, 0.60, 1.80),  # XC330-M181
    1240: _motor(5.0, 81, 0.93, 1.80),  # XC330-M288
    1210: _motor(11.1, 104, 0.76, 0.80),  # XC330-T181
    1220: _motor(11.1, 65, 0.92, 0.80),  # XC330-T288
    1060: _motor(11.1, 57, 1.4, 1.3),  # XL430-W250
    1090: _motor(11.1, 57, 1.4, 1.3),  # 2XL430-W250
    1070: _motor(12.0, 106, 1.6, 1.4),  # XC430-W150
    1080: _motor(12.0, 70, 1.9, 1.4),  # XC430-W240
    1160: _motor(12.0, 64, 1.8, 1.4),  # 2XC430-W250
    1030: _motor(12.0, 77, 3.0, 2.3),  # XM430-W210
    1020: _motor(12.0, 46, 4.1, 2.3),  # XM430-W350
    1010: _motor(12.0, 50, 2.5, 1.3),  # XH430-W210
    1000: _motor(12.0, 30, 3.4, 1.3),  # XH430-W350
    1130: _motor(12.0, 53, 7.3, 4.4),  # XM540-W150
    1120: _motor(12.0, 30, 10.6, 4.4),  # XM540-W270
    30: _motor(12.0, 55, 2.5, 1.4),  # MX-28(2.0)
    311: _motor(12.0, 63, 6.0, 4.1),  # MX-64(2.0)
    321: _motor(12.0, 45, 8.4, 5.2),  # MX-106(2.0)
    29: _motor(12.0, 55, 2.5, 1.4),  # MX-28
    310: _motor(12.0, 63, 6.0, 4.1),  # MX-64
    320: _motor(12.0, 45, 8.4, 5.2),  # MX-106
    12: _motor(12.0, 59, 1.5, 1.5),  # AX-12A
    18: _motor(12.0, 97, 1.8, 2.2),  # AX-18A
    4030: _motor(24.0, 57.3, 31.7, 20.8, _STALL_RISE_Y_K),  # YM070-210-R099-RH; continuous 14.6 N m at 11.0 A
    4150: _motor(24.0, 32.2, 61.4, 22.4, _STALL_RISE_Y_K),  # YM080-230-R099-RH; continuous 26.0 N m at 10.7 A
    2000: _motor(24.0, 32.7, 15.3, 4.5),  # PH42-020-S300-R; continuous 5.1 N m at 1.5 A
}
"""Motor constants by model number."""


def motor_of(model_number: int) -> Motor:
    """Constants of a model.

    Raises:
        SimSettingError: the simulator does not know the model.
    """
    if model_number not in MOTORS:
        raise SimSettingError("servo model number", str(model_number), ", ".join(str(n) for n in MOTORS))
    return MOTORS[model_number]
