"""Single servos on a bench: a robot of any models, each turning a joint of its own, in virtual time."""

from __future__ import annotations

import math
from pathlib import Path

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec.packet import Packet, PacketDecoder
from daemon.dynamixel.registers.models import MODELS
from retarget.robot.robot import BusSettings, JointSpec, RobotModel, ServoSpec
from retarget.robot.servos import servo_models
from sim.bus import SimBus
from sim.faults import Fault, FaultSchedule
from sim.servos.servo import SimServo
from sim.wire.wire import WireSettings
from sim.world import World


def spec(name: str, servo_id: int = 1, joint: int = 0) -> ServoSpec:
    """A servo of a model, centred."""
    facts = servo_models()[name]
    low, high = facts.tick_range(extended=False)
    return ServoSpec(servo_id, f"joint_{servo_id}", facts, 1, 1.0, facts.zero_tick, ((joint, 1.0),), low, high)


def robot(*names: str, baud: int = 1_000_000, rate_hz: float = 100.0) -> RobotModel:
    """A robot of such servos, ids from 1."""
    specs = tuple(spec(name, i + 1, i) for i, name in enumerate(names))
    joints = tuple(
        JointSpec(s.joint_name, s.joint_name, -2.5, 2.5, s.model.no_load_speed_rad_s, 100.0, 0.0, 0.0) for s in specs
    )
    protocol = MODELS[specs[0].model.model_number].protocol
    nowhere = Path("/nowhere")
    return RobotModel("bench", joints, specs, BusSettings(protocol, baud, rate_hz), nowhere, nowhere, "none")


class Bench:
    """Servos on one wire, and a client that speaks Protocol 2.0 to them."""

    def __init__(
        self, *names: str, faults: tuple[Fault, ...] = (), wire: WireSettings | None = None, **options
    ) -> None:
        baud = options.pop("baud", 1_000_000)
        seed = options.pop("seed", 0)
        self.robot = robot(*(names or ("XM430-W350",)), baud=baud)
        self.world = World(self.robot, FaultSchedule(faults, seed), **options)
        self.bus = SimBus(self.robot, world=self.world, wire=wire)
        self.baud, self.t_s = baud, 0.0
        self.decoder = PacketDecoder()

    @property
    def servo(self) -> SimServo:
        return self.world.all[0]

    def wait(self, seconds: float) -> None:
        self.t_s += seconds
        self.world.advance(self.t_s)

    def send(self, data: bytes) -> bytes:
        """Send, wait until nothing more is under way; the bytes that came back."""
        self.bus.receive(data, self.t_s, self.baud)
        out = b""
        while (ready_s := self.bus.wire.ready_s()) is not None:
            self.t_s = max(self.t_s, ready_s)
            out += self.bus.wire.take(self.t_s)
        return out

    def ask(self, data: bytes) -> list[Packet]:
        """The packets that come back."""
        return self.decoder.feed(self.send(data))

    def write(self, name: str, value: int, servo_id: int = 1) -> int:
        """Write an item; the error of the answer."""
        item = self.servo.items[name]
        answer = self.ask(packet.write(servo_id, item.address, item.encode(value)))
        return answer[0].error

    def read(self, name: str, servo_id: int = 1) -> int:
        """Read an item over the wire."""
        item = self.servo.items[name]
        return item.decode(self.ask(packet.read(servo_id, item.address, item.size))[0].parameters)

    def to(self, degrees: float) -> int:
        return 2048 + round(degrees * 4096 / 360)


TICK_RAD = 2 * math.pi / 4096
