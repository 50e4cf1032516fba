"""A bus over simulated servos in virtual time."""

from __future__ import annotations

from dataclasses import dataclass

from daemon.dynamixel.servo_bus import ServoBus
from retarget.robot.loading import load_robot
from retarget.robot.robot import RobotModel
from sim.bus import SimBus
from sim.clock import VirtualClock
from sim.faults import Fault, FaultSchedule
from sim.port import SimPort


@dataclass
class BusRig:
    """The parts, each real."""

    robot: RobotModel
    clock: VirtualClock
    servos: SimBus
    port: SimPort
    bus: ServoBus


def bus_rig(*faults: Fault, name: str = "reference", baud: int | None = None, seed: int = 0) -> BusRig:
    """A robot's servos with faults on a schedule."""
    robot, clock = load_robot(name), VirtualClock()
    servos = SimBus(robot, FaultSchedule(faults, seed))
    port = SimPort(servos, clock, baud)
    return BusRig(robot, clock, servos, port, ServoBus.on_port(port, robot.servos, clock))
