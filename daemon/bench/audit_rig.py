"""A simulated robot behind the real bus side in virtual time: plays paths, suffers disturbances, and is repaired as by a person."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from daemon.control.control_loop import ControlLoop
from daemon.control.turns import TURNS_UNKNOWN
from daemon.dynamixel.codec import packet
from daemon.dynamixel.servo_bus import ServoBus
from daemon.shared_memory.bus_link import BusLink, BusRequest, BusState
from retarget.path.paths import JointState
from retarget.robot.robot import RobotModel
from sim.bus import SimBus
from sim.clock import VirtualClock
from sim.faults import Fault, FaultSchedule
from sim.options import world_of
from sim.port import SimPort

Array = NDArray[np.float64]
_QUEUE = 10
_RECORDED = 100
"""Number of setpoints pushed at a time while cycles are recorded: fewer than the rings of shared memory hold."""
_REQUESTS = (BusRequest.STOP, BusRequest.PARK, BusRequest.ESTOP, BusRequest.RESET, BusRequest.ARM)
_COOL_C = 30.0
_REPAIR_CYCLES, _REBOOT_CYCLES = 100, 60
_REPORTED = (
    "goals", "violations", "violations_by_kind", "self_contacts", "inherited_contacts", "measured_contacts", "poses_checked",
    "details", "contact_details",
)  # fmt: skip


class AuditRig:
    """Control loop, safety limiter, servo bus and codec over simulated servos, without waiting.

    Args:
        robot: the robot.
        faults: faults of its servos and its wire.
        seed: seed of the faults' probabilities.
        body: body behind the servos, "plain" or "mujoco" (`sim.options.BODIES`).
    """

    def __init__(
        self, robot: RobotModel, faults: tuple[Fault, ...] = (), seed: int = 0, *, body: str = "plain"
    ) -> None:
        self.robot = robot
        self.repairs = 0
        self._clock = VirtualClock()
        self._bus = SimBus(robot, world=world_of(robot, FaultSchedule(faults, seed), body))
        self._port = SimPort(self._bus, self._clock)
        self._link = BusLink.create(robot.n_joints, robot.n_servos)
        servo_bus = ServoBus.on_port(self._port, robot.servos, self._clock)
        self._streamer = ControlLoop(robot, servo_bus, self._link, self._clock, watch_front=False)
        self._period_s, self._due_s = robot.bus.period_s, 0.0
        self._last: Array = robot.rest_rad
        self._velocity: Array = np.zeros(robot.n_joints)

    def state(self) -> JointState:
        """The last setpoint pushed, with the velocity of its step."""
        return JointState(self._last, self._velocity)

    @property
    def fault(self) -> str:
        """Reason of the robot's fault, "" when it is in none."""
        return self._link.text if self._streamer.state is BusState.FAULT else ""

    def play(self, path: Array, share: float = 1.0, *, stop: bool = False) -> None:
        """Play a share of a path (N, J) at bus rate from `state()` on, then stop if `stop` is true."""
        n = max(1, round(share * len(path)))
        pushed = 0
        while pushed < n:
            some = path[pushed : min(n, pushed + _QUEUE)]
            self._link.setpoints.push(
                some, 1, pushed, self._link.epoch, last=n == len(path) and pushed + len(some) == n
            )
            pushed += len(some)
            self._cycles(len(some))
        before = path[n - 2] if n > 1 else self._last
        self._velocity, self._last = (path[n - 1] - before) / self._period_s, path[n - 1]
        if stop:
            self._request(BusRequest.STOP)
            self._until(BusState.HOLDING)
            self._take_state()

    def recorded(self, path: Array, after_s: float) -> NDArray[np.void]:
        """The bus cycles of playing a path (N, J) at bus rate from `state()` on, and of holding its end for `after_s`.

        A fault ends them; `fault` then has its reason, and `make_ready` repairs it as a person would.
        """
        first, rows = self._link.cycles.count, [self._link.cycles.since(self._link.cycles.count)[0]]
        for k in range(0, len(path), _RECORDED):
            if self.fault:
                break
            part = path[k : k + _RECORDED]
            self._link.setpoints.push(part, 1, k, self._link.epoch, last=k + len(part) == len(path))
            self._cycles(len(part))
            rows.append(self._link.cycles.since(first)[0])
            first += len(rows[-1])
        if not self.fault:
            self._until(BusState.HOLDING, BusState.FAULT)
            self._cycles(round(after_s / self._period_s))
        self._take_state()
        rows.append(self._link.cycles.since(first)[0])
        return np.concatenate(rows)

    def play_disturbed(self, path: Array, draw: np.random.Generator) -> None:
        """Play a path while meaningless requests and frames arrive, and repair any fault."""
        at = 0
        while at < len(path) and self._streamer.state in (BusState.HOLDING, BusState.PLAYING):
            some = np.array(path[at : at + _QUEUE])
            match int(draw.integers(40)):
                case 0:
                    self._request(_REQUESTS[int(draw.integers(len(_REQUESTS)))])
                case 1:
                    some = draw.normal(0.0, 10.0, some.shape)
                case 2:
                    some[draw.integers(len(some)), draw.integers(some.shape[1])] = draw.choice([np.nan, np.inf, 1e300])
                case 3:
                    some = some[::-1]
                case _:
                    pass
            self._link.setpoints.push(some, 1, at, self._link.epoch, last=at + len(some) >= len(path))
            at += len(some)
            self._cycles(len(some))
        self.make_ready()

    def make_ready(self) -> None:
        """Act as a person would until the robot holds: wait, reboot servos with latched errors, reset, arm.

        Raises:
            RuntimeError: the robot does not hold after ten tries.
        """
        for _ in range(10):
            if self._streamer.state is BusState.PLAYING:  # the end of the running path was lost
                self._request(BusRequest.STOP)
            if self._streamer.state in (BusState.FAULT, BusState.ESTOP):
                self.repairs += 1
                self._cycles(_REPAIR_CYCLES)
                self._reboot_latched()
                turns_unknown = TURNS_UNKNOWN in self._link.text
                self._request(BusRequest.RESET)
                if turns_unknown:
                    self._bus.world.lead_by_hand(self.robot.park_rad.tolist())
                    self._cycles(_REBOOT_CYCLES)
            self._settle()
            if self._streamer.state is BusState.LIMP:
                self._request(BusRequest.ARM)
                self._settle()
            if self._streamer.state is BusState.HOLDING:
                self._take_state()
                return
        raise RuntimeError(f"still {self._streamer.state.name} after ten repairs: {self._link.text}")

    def finish(self) -> dict[str, Any]:
        """Park the robot; return the audit's figures."""
        if self._streamer.state is not BusState.HOLDING:
            self.make_ready()
        self._request(BusRequest.PARK)
        self._settle()
        self._link.close()
        report = self._bus.audit.report()
        return {key: report[key] for key in _REPORTED} | {"repairs": self.repairs}

    def _take_state(self) -> None:
        record = self._link.cycles.since(self._link.cycles.count - 1)[0][-1]
        self._last, self._velocity = np.array(record["goal_rad"]), np.zeros(self.robot.n_joints)

    def _reboot_latched(self) -> None:
        for servo in self._bus.servos.values():
            if not servo.model.error_item:  # AX and MX know no reboot: the power is switched
                self._bus.world.drives.temperature_c[servo.index] = _COOL_C
                servo.reboot()
                self._cycles(_REBOOT_CYCLES)
            elif servo.error:
                self._bus.world.drives.temperature_c[servo.index] = _COOL_C  # it had time to cool
                self._bus.receive(packet.reboot(servo.servo_id), self._clock.true_s + 0.001, self._port.baud)
                self._cycles(_REBOOT_CYCLES)

    def _request(self, request: BusRequest) -> None:
        self._link.request(request)
        self._cycles(1)

    def _settle(self) -> None:
        """Run until no setpoint is queued and the robot is limp, holds, is in fault, or waits for the rest of a path."""
        lasting = (BusState.LIMP, BusState.HOLDING, BusState.PLAYING, BusState.FAULT, BusState.ESTOP)
        for _ in range(round(60 / self._period_s)):
            if self._streamer.state in lasting and not self._link.setpoints.queued_frames:
                return
            self._cycles(1)

    def _until(self, *states: BusState) -> None:
        for _ in range(round(60 / self._period_s)):
            if self._streamer.state in states:
                return
            self._cycles(1)
        names = " or ".join(s.name for s in states)
        raise RuntimeError(f"still {self._streamer.state.name} after a minute, not {names}: {self._link.text}")

    def _cycles(self, n: int) -> None:
        for _ in range(n):
            self._streamer.cycle()
            self._due_s = max(self._due_s + self._period_s, self._clock.now_s())
            self._clock.sleep_until(self._due_s)
