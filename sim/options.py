"""Makes simulators from text settings: the options of `mmmd sim` and of `sim://` URLs."""

from __future__ import annotations

from collections.abc import Sequence

from retarget.robot.robot import RobotModel
from sim.errors import SimSettingError
from sim.faults import FaultSchedule
from sim.wire.wire import WireSettings
from sim.world import World

BODIES = ("plain", "mujoco")


def wire_settings(latency_ms: str = "0", pieces: str = "", *, turnaround_us: float = 0.0) -> WireSettings:
    """Settings of wire and adapter from text.

    Raises:
        SimSettingError: a value is no number, or one that no wire can have.
    """
    try:
        latency_s = float(latency_ms) * 1e-3
    except ValueError:
        raise SimSettingError("latency_ms", repr(latency_ms), "milliseconds, such as 0, 1 or 16") from None
    piece_bytes = None
    if pieces:
        least, _, most = pieces.partition("-")
        if not (least.isdigit() and (most or least).isdigit()):
            raise SimSettingError("pieces", repr(pieces), "LEAST-MOST bytes, such as 1-16")
        piece_bytes = (int(least), int(most or least))
    return WireSettings(turnaround_s=turnaround_us * 1e-6, latency_s=latency_s, piece_bytes=piece_bytes)


def world_of(
    robot: RobotModel,
    faults: FaultSchedule | None = None,
    body: str = "plain",
    *,
    factory: bool = False,
    start_rad: Sequence[float] | None = None,
) -> World:
    """The simulated world of a robot.

    Args:
        robot: the robot.
        faults: the fault schedule; None for no faults.
        body: "plain" or "mujoco".
        factory: servos as from the box (57,600 baud, 500 us return delay) but for their ids.
        start_rad: (J,) pose to begin in; the park pose when None.

    Raises:
        SimSettingError: `body` is neither of these.
    """
    if body not in BODIES:
        raise SimSettingError("body", f"'{body}'", ", ".join(BODIES))
    maker = None
    if body == "mujoco":
        from sim.bodies.mujoco_body import MujocoBody

        maker = MujocoBody
    world = World(robot, faults, start_rad, body=maker)
    if factory:
        for servo in world.all:
            servo.restore_factory(keep=("id",))
    return world


def servo_ids_of(text: str, robot: RobotModel) -> list[int]:
    """Servo ids from a text such as "1-4,7".

    Raises:
        SimSettingError: the text has no ids, or one that the robot does not have.
    """
    ids: list[int] = []
    for part in text.split(","):
        first, _, last = part.partition("-")
        if not (first.isdigit() and (last or first).isdigit()):
            raise SimSettingError("servo ids", repr(text), "such as 1-4,7")
        ids += range(int(first), int(last or first) + 1)
    if unknown := set(ids) - set(robot.servo_ids):
        raise SimSettingError("servo ids", ", ".join(map(str, sorted(unknown))), ", ".join(map(str, robot.servo_ids)))
    return ids
