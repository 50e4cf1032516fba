"""The torque ramp after arming: a servo that trips meanwhile is never given its torque back."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from daemon.shared_memory.bus_link import BusRequest, BusState
from sim.faults import Fault
from sim.servos.servo_protocol1 import OVERLOAD_ERROR, SimServo1
from tests.support.rig import rig
from tests.support.sizes import few_and_long

SERVOS = {"poppy_torso": 41, "op2": 5, "reachy_2021": 13, "op3": 5, "toddlerbot": 16}
RAMP_S = 0.65


@cache
def torque_on_s(name: str) -> float:
    """When the last servo of a robot gets its torque in a run that is the same each time."""
    with rig(name) as r:
        r.link.request(BusRequest.ARM)
        while not all(r.torque):
            r.cycle()
        return r.clock.now_s()


@pytest.mark.parametrize(
    ("name", "share"),
    [
        pytest.param(name, share, marks=pytest.mark.long if k % 3 == 0 else pytest.mark.soak)
        for name in ("poppy_torso", "op2")
        for k, share in enumerate(np.linspace(0.0, 1.0, 10).round(3).tolist())
    ]
    + few_and_long(
        [("poppy_torso", 0.5), ("op2", 0.1)],
        [(name, share) for name in ("reachy_2021", "op3", "toddlerbot") for share in (0.1, 0.5)],
    ),
)
def test_a_servo_that_trips_anywhere_in_the_ramp_stays_limp_and_is_named(name: str, share: float) -> None:
    """Writing torque_limit clears the alarm of a protocol 1.0 servo, and the next goal switched its torque on again."""
    tripped_s = torque_on_s(name) - 0.002 + share * RAMP_S
    servo_id = SERVOS[name]
    with rig(name, Fault("overload", start_s=tripped_s, servo_id=servo_id)) as r:
        servo = r.sim.servos[servo_id]
        r.link.request(BusRequest.ARM)
        while r.clock.now_s() < tripped_s or r.state is BusState.ARMING:
            r.cycle()
            if r.clock.now_s() > tripped_s + 0.001:
                break
        goals: list[float] = []
        r.sim.on_goal = lambda _t_s, to_id, tick: goals.append(tick) if to_id == servo_id else None
        stood_tick = servo.position_tick
        for _ in range(int(1.5 * r.robot.bus.rate_hz)):
            r.cycle()
            assert not servo.torque, f"torque again {r.clock.now_s() - tripped_s:.3f} s after the trip"
        assert r.state is BusState.FAULT and f"servo {servo_id}" in r.link.text, r.link.text
        assert "overload" in r.link.text or "its torque" in r.link.text, r.link.text
        assert abs(servo.position_tick - stood_tick) * 360 / servo.model.ticks_per_turn < 0.5
        assert not goals or r.bus.models[0].protocol == 2.0, "which needs a reboot before a goal can wake it"
        assert r.sim.audit.report()["violations"] == 0, r.sim.audit.report()["details"]


@pytest.mark.parametrize("name", few_and_long(["op2", "poppy_torso"], SERVOS))
def test_in_a_fault_and_a_held_e_stop_the_ramp_stands_still(name: str) -> None:
    """Effort rises in the armed states alone: whoever holds in a fault holds with what he had."""
    for request in (BusRequest.ESTOP_HOLD, None):
        with rig(name) as r:
            r.link.request(BusRequest.ARM)
            while not all(r.torque):
                r.cycle()
            r.cycle(10)
            if request is not None:
                r.link.request(request)
            else:
                r.streamer._states.fault("made up")
            r.cycle(2)
            item = "torque_limit" if r.bus.models[0].protocol == 1.0 else "goal_pwm"
            before = {i: s.get(item) for i, s in r.sim.servos.items()}
            r.cycle(100)
            assert {i: s.get(item) for i, s in r.sim.servos.items()} == before
            assert all(r.torque) and r.sim.audit.report()["violations"] == 0


@pytest.mark.parametrize("name", few_and_long(["reachy_2021"], ["poppy_torso", "reachy_2021"]))
def test_a_tripped_servo_of_protocol_1_gets_no_goal_in_the_fault(name: str) -> None:
    """A goal switches torque on by itself: were the alarm over by then, the servo would come back in a latched fault."""
    with rig(name) as r:
        r.arm()
        servo_id = SERVOS[name]
        servo = r.sim.servos[servo_id]
        assert isinstance(servo, SimServo1)
        servo.trip(OVERLOAD_ERROR)
        r.cycle()
        goals: list[int] = []
        r.sim.on_goal = lambda _t_s, to_id, _tick: goals.append(to_id)
        servo._alarm = 0  # it has cooled
        r.cycle(50)
        assert r.state is BusState.FAULT and "overload" in r.link.text
        assert servo_id not in goals and set(goals) == set(r.robot.servo_ids) - {servo_id}
        assert not servo.torque and r.sim.audit.report()["violations"] == 0


def test_a_stop_a_park_and_a_torque_off_during_the_ramp_are_obeyed() -> None:
    for request, state in (
        (BusRequest.STOP, BusState.HOLDING),
        (BusRequest.PARK, BusState.LIMP),
        (BusRequest.TORQUE_OFF, BusState.LIMP),
    ):
        with rig("poppy_torso") as r:
            r.link.request(BusRequest.ARM)
            while not all(r.torque):
                r.cycle()
            r.cycle(5)
            r.link.request(request)
            r.cycle()
            r.until(state)
            r.cycle(100)
            assert r.state is state and r.sim.audit.report()["violations"] == 0
            if request is BusRequest.TORQUE_OFF:
                assert not any(r.torque)
