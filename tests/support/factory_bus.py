"""The servos of a robot as the factory made them, on an emulated bus."""

from __future__ import annotations

from daemon.dynamixel.registers.models import MODELS
from daemon.dynamixel.servo_bus import ServoBus
from retarget.robot.robot import RobotModel
from sim.clock import VirtualClock
from tests.support.robots import packaged
from tests.support.servo_emulator import FakePort, FakeServo

ROBOT = packaged("reference")


def wired(robot: RobotModel = ROBOT) -> tuple[ServoBus, FakePort, VirtualClock]:
    """A robot's servos as the factory made them, on a bus."""
    clock = VirtualClock()
    servos = [FakeServo(MODELS[s.model.model_number], s.servo_id) for s in robot.servos]
    for s in servos:
        s.set("present_input_voltage", 50 if s.model.name.startswith("XL330") else 120)
        s.set("present_temperature", 30)
        s.set("present_position", 2048)
    port = FakePort(clock, servos, robot.bus.baud)
    bus = ServoBus.on_port(port, robot.servos, clock)
    bus.verify()
    return bus, port, clock
