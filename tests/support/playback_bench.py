"""Front half and bus half of the daemon on one virtual clock."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from daemon.control.control_loop import ControlLoop
from daemon.dynamixel.servo_bus import ServoBus
from daemon.playback.chunk_maker import ChunkMaker
from daemon.playback.setpoint_buffer import SetpointBuffer
from daemon.playback.splicer import Splice, Splicer
from daemon.playback.trajectory import Chunk, PathTrajectory
from daemon.poses.layers import Layers
from daemon.poses.pose_sequence import posture_of
from daemon.shared_memory.bus_link import BusLink, BusRequest, BusState
from daemon.state.bus_view import BusView
from retarget.path.limits import JointLimits
from sim.bus import SimBus
from sim.clock import VirtualClock
from sim.port import SimPort
from tests.support.kinematic import raised_arm
from tests.support.robots import packaged

ROBOT = packaged("reference")
RIGHT = raised_arm("right", 1.0, 1.0, "right")
LEFT = raised_arm("left", 0.8, 0.9, "left")
LEFT_POSTURE = posture_of(LEFT)
PERIOD_S = ROBOT.bus.period_s


class Bench:
    """Front half and bus half of the daemon on one virtual clock."""

    def __init__(self, queue_s: float = 0.1) -> None:
        self.clock = VirtualClock()
        self.sim = SimBus(ROBOT)
        port = SimPort(self.sim, self.clock)
        self.link = BusLink.create(ROBOT.n_joints)
        self.streamer = ControlLoop(
            ROBOT, ServoBus.on_port(port, ROBOT.servos, self.clock), self.link, self.clock, watch_front=False
        )
        self.view = BusView(self.link, ROBOT, self.clock)
        self.buffer = SetpointBuffer(ROBOT, self.link, self.view, queue_s, clock=self.clock)
        self.splicer, self.maker = Splicer(self.buffer, self.clock), ChunkMaker(ROBOT, Layers("off"))
        self.records: list[np.ndarray] = []

    def cycle(self, n: int = 1, pump: bool = True) -> None:
        for _ in range(n):
            due_s = self.clock.now_s() + PERIOD_S
            self.streamer.cycle()
            self.clock.sleep_until(due_s)
            before = self.view.index
            self.buffer.read_cycles()
            self.records += list(self.link.cycles.since(before)[0])
            if pump:
                self.buffer.pump()

    def arm(self) -> None:
        self.link.request(BusRequest.ARM)
        for _ in range(2000):
            self.cycle()
            if self.view.state is BusState.HOLDING:
                return
        raise AssertionError(f"not armed: {self.view.state}, {self.link.text}")

    def play(self, motion, plan_name: str = "c", retarget_cycles: int = 2) -> PathTrajectory:
        """Take over as a `MotionPlayer` does; retargeting takes some bus cycles meanwhile."""
        posture, late_s = posture_of(motion), 0.0
        while True:
            with self.splicer.splice(late_s=late_s) as splice:
                chunks = list(self.chunks(posture, splice))
                self.cycle(retarget_cycles)
                if not self.splicer.missed(splice):
                    return self.place(splice, chunks, plan_name)
            late_s += PERIOD_S * (retarget_cycles + 1)

    def chunks(self, posture, splice: Splice) -> Iterator[Chunk]:
        return self.maker.chunks(posture, splice.state, None, complete=True)

    def place(self, splice: Splice, chunks: list[Chunk], plan_name: str = "c") -> PathTrajectory:
        statistics = self.buffer.statistics(plan_id := self.buffer.new_plan_id(), 0)
        plan = PathTrajectory(plan_id, plan_name, self.buffer.epoch, ROBOT.bus.rate_hz, statistics)
        plan.append(chunks[0])
        self.splicer.follow_with(splice, plan)
        for chunk in chunks[1:]:
            plan.append(chunk)
        return plan

    def finish(self) -> None:
        for _ in range(1500):
            self.cycle()
            if self.view.state is BusState.HOLDING:
                return
        raise AssertionError(f"still {self.view.state}")

    def goals(self) -> np.ndarray:
        return np.array([r["goal_rad"] for r in self.records])

    def close(self) -> None:
        self.link.close()


def assert_within_limits(bench: Bench) -> None:
    limits = JointLimits.of(ROBOT)
    goals = bench.goals()[-1500:]
    speed = np.abs(np.diff(goals, axis=0)) / PERIOD_S
    acceleration = np.abs(np.diff(goals, n=2, axis=0)) / PERIOD_S**2
    assert (speed <= limits.velocity_rad_s * (1 + 1e-6)).all()
    assert (acceleration <= limits.acceleration_rad_s2 * (1 + 1e-6)).all()
    report = bench.sim.audit.report()
    assert report["violations"] == 0, report
