"""Arming, from limp to torque: verify the servos, wait until the joints stand still, pin the goals to their positions, torque on.

`arm_in_steps` is a generator that returns control to the bus cycle between its steps. Records continue meanwhile, and an e-stop, a
stop or a dead front takes effect at once, however long a bad wire or a swinging arm delays arming. Only the last step switches
torque on, servo by servo; an e-stop requested during that step ends it.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Generator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daemon.control.derating import ServoLimits, read_limits
from daemon.control.pinning import pin_where_they_stand, reading_at_rest, refuse_hardware_errors
from daemon.control.turns import TurnWatch
from daemon.dynamixel.servo_bus import ServoBus
from daemon.dynamixel.setup.checks import check_servos, require_needed
from daemon.errors import LinkTimeoutError
from daemon.host.clock import Clock
from retarget.robot.robot import RobotModel

log = logging.getLogger(__name__)

WATCHDOG_UNITS = 10
"""Servo bus watchdog in units of 20 ms: after 200 ms without any packet on the bus the servos stop by themselves."""


@dataclass(frozen=True)
class Armed:
    """A robot that has just got torque.

    Attributes:
        goal_tick: (S,) goals that the servos hold.
        limits: limits in the servos' registers.
    """

    goal_tick: NDArray[np.int32]
    limits: ServoLimits


def arm_in_steps(
    robot: RobotModel, bus: ServoBus, clock: Clock, effort: float, turns: TurnWatch, estop_asked: Callable[[], bool]
) -> Generator[None, None, Armed]:
    """Arm a limp robot. A caller that breaks off or catches an error must cut torque.

    Each servo is addressed by itself and answers, which takes tens of milliseconds for all of them. Without `estop_asked` a robot
    of sixteen servos kept its torque for up to 85 ms after an e-stop during this step.

    Args:
        robot: the robot.
        bus: its servos.
        clock: time of the cycles.
        effort: share of full torque at the start, 0 to 1.
        turns: says whether the servos' whole turns are known.
        estop_asked: returns whether an e-stop waits for the next cycle; called before each servo gets torque.

    Raises:
        BusMismatchError: servos or their settings differ from the robot file; they may have been changed since the start.
        ServoFaultError: a servo reports an error, moves, refuses its goal, or may stand elsewhere than it reports.
        LinkError: a servo does not answer, or the port is lost.
    """
    bus.verify()
    yield
    bus.clear_watchdog()
    yield
    without = bus.arm_watchdog(WATCHDOG_UNITS)
    yield
    require_needed(check_servos(bus, robot))
    yield
    limits = read_limits(bus)
    yield
    reading = yield from reading_at_rest(bus, clock)
    if not reading.valid.all():
        silent = ", ".join(str(i) for i, ok in zip(bus.ids, reading.valid, strict=True) if not ok)
        raise LinkTimeoutError(f"no fresh position of servo {silent}; check cable and power")
    refuse_hardware_errors(bus, reading)
    turns.update(reading, clock.now_s())
    turns.require_one_pose(reading.position_tick)
    present = yield from pin_where_they_stand(bus, clock, reading, effort)
    while not bus.write_all("torque_enable", 1, unless=estop_asked):
        yield
    if without:
        log.warning("no bus watchdog to rely on: servo %s", ", ".join(map(str, without)))
    return Armed(present, limits)
