"""The bus process in virtual time: real streamer, gate and bus, simulated servos; a cycle is a call."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from daemon.control.control_loop import ControlLoop
from daemon.dynamixel.servo_bus import ServoBus
from daemon.shared_memory.bus_link import BusLink, BusRequest, BusState
from retarget.robot.loading import load_robot
from retarget.robot.robot import RobotModel
from sim.bus import SimBus
from sim.clock import VirtualClock
from sim.faults import Fault, FaultSchedule
from sim.port import SimPort
from tests.support.robots import packaged, slow


class Rig:
    """One robot on a simulated bus, with the front's end of the shared memory in `link`."""

    def __init__(
        self,
        robot: RobotModel,
        link: BusLink,
        *faults: Fault,
        start_rad: np.ndarray | None = None,
        watch_front=False,
        slow_every=0,
    ) -> None:
        self.robot, self.link = robot, link
        self.clock = VirtualClock()
        start = None if start_rad is None else start_rad.tolist()
        self.sim = SimBus(robot, FaultSchedule(tuple(faults)), start)
        self.port = SimPort(self.sim, self.clock)
        self.bus = ServoBus.on_port(self.port, robot.servos, self.clock, slow_every=slow_every)
        self.streamer = ControlLoop(robot, self.bus, link, self.clock, watch_front=watch_front)
        self.records: list[np.void] = []
        self._due_s = 0.0
        self._index = 0

    @property
    def state(self) -> BusState:
        return self.streamer.state

    @property
    def torque(self) -> list[bool]:
        """Truth at the servos."""
        return [s.torque for s in self.sim.servos.values()]

    def cycle(self, n: int = 1) -> np.void:
        """Run bus periods; the last record."""
        for _ in range(n):
            self.streamer.cycle()
            self._due_s = max(self._due_s + self.robot.bus.period_s, self.clock.now_s())
            self.clock.sleep_until(self._due_s)
            rows, self._index, lost = self.link.cycles.since(self._index)
            assert lost == 0 and len(rows) == 1
            self.records.append(rows[0])
        return self.records[-1]

    def until(self, *states: BusState, within_s: float = 20.0) -> None:
        """Cycle until the streamer is in one of `states`."""
        for _ in range(int(within_s * self.robot.bus.rate_hz)):
            if self.state in states:
                return
            self.cycle()
        raise AssertionError(f"{self.state.name} after {within_s} s: {self.link.text}")

    def arm(self) -> None:
        """From limp to holding."""
        self.link.request(BusRequest.ARM)
        self.cycle()
        self.until(BusState.HOLDING, BusState.FAULT)
        assert self.state is BusState.HOLDING, self.link.text

    def push(self, q_rad: np.ndarray, plan_id: int = 1, *, last: bool = True) -> None:
        """Hand setpoints (N, J) to the streamer."""
        assert self.link.setpoints.push(q_rad, plan_id, 0, self.link.epoch, last=last) == len(q_rad)

    def goals_rad(self) -> np.ndarray:
        """(T, J) goals of the cycles with torque."""
        return np.array([r["goal_rad"] for r in self.records if r["torque"]])

    def assert_limits_kept(self) -> None:
        """By the simulator's audit, apart from the gate."""
        report = self.sim.audit.report()
        assert report["goals"] > 0
        assert report["violations"] == 0, report["details"]


@contextmanager
def rig(name: str = "reference", *faults: Fault, slowed=True, **options) -> Iterator[Rig]:
    """A rig whose shared memory is removed at the end; `reference` at half its rate where it may be slowed."""
    robot = load_robot(name) if "/" in name else slow() if name == "reference" and slowed else packaged(name)
    link = BusLink.create(robot.n_joints, robot.n_servos)
    try:
        yield Rig(robot, link, *faults, **options)
    finally:
        link.close()


def with_known_turns(robot: RobotModel, q_rad: np.ndarray) -> np.ndarray:
    """(..., J) poses with ToddlerBot's waist turned no further than that its servos' whole turns are known at the start."""
    q_rad = q_rad.copy()
    if robot.name == "toddlerbot":
        yaw = robot.joint_names.index("waist_yaw")
        q_rad[..., yaw] = np.clip(q_rad[..., yaw], -0.5, 0.5)
    return q_rad


def swing(robot: RobotModel, seconds: float, share: float = 0.4) -> np.ndarray:
    """(T, J) a smooth motion about rest inside every limit, from rest and back."""
    t = np.arange(int(seconds * robot.bus.rate_hz)) / len(np.arange(int(seconds * robot.bus.rate_hz)))
    room = np.minimum(robot.position_max_rad - robot.rest_rad, robot.rest_rad - robot.position_min_rad)
    # (1 - cos)/2 over `seconds`: peak velocity A pi/T, peak acceleration 2 A (pi/T)^2.
    w = np.pi / seconds
    most = np.minimum(robot.velocity_limit_rad_s / w, robot.acceleration_limit_rad_s2 / (2 * w * w))
    amplitude = share * np.minimum(np.maximum(room, 0.0), most)
    return robot.rest_rad + np.outer((1 - np.cos(2 * np.pi * t)) / 2, amplitude)


def assert_brakes_within_limits(records, robot) -> None:
    """From the first record on the joints come to rest as fast as the acceleration allows, and no faster."""
    velocity = np.array([r["velocity_rad_s"] for r in records])
    change = np.abs(np.diff(velocity, axis=0))
    assert (change <= robot.acceleration_limit_rad_s2 * robot.bus.period_s * (1 + 1e-6)).all()
    assert (np.abs(velocity[1:]) <= np.abs(velocity[:-1]) + 1e-9).all()
    longest_s = (robot.velocity_limit_rad_s / robot.acceleration_limit_rad_s2).max()
    assert not velocity[int(longest_s * robot.bus.rate_hz) + 2 :].any()


def lead_to(r: Rig, state: str, parking_cycles: int = 1) -> None:
    """From limp to holding, playing, stopping or parking; the last two out of a motion."""
    r.arm()
    if state != "holding":
        r.push(swing(r.robot, 2.0))
        r.cycle(round(0.6 * r.robot.bus.rate_hz))
    if state in ("stopping", "parking"):
        r.link.request(BusRequest.STOP if state == "stopping" else BusRequest.PARK)
        r.cycle(1 if state == "stopping" else parking_cycles)
