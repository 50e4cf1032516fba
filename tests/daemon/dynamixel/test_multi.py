"""Several ports as one bus: found out, exchanged at the same time, lost one by one."""

from __future__ import annotations

import numpy as np
import pytest

from daemon.control.control_loop import ControlLoop
from daemon.dynamixel.bus_opening import bus_on, open_bus
from daemon.dynamixel.registers.models import MODELS
from daemon.dynamixel.servo_bus import ServoBus
from daemon.dynamixel.setup.checks import check_servos
from daemon.errors import BusMismatchError, CommandError, LinkLostError, LinkTimeoutError
from daemon.shared_memory.bus_link import BusLink, BusRequest, BusState
from retarget.robot.ticks import JointServoMap
from sim.clock import VirtualClock
from tests.support.rig import swing
from tests.support.robots import packaged
from tests.support.servo_emulator import FakePort, FakeServo

ROBOT = packaged("reference")


def two_ports(*extra_on_b: int, missing: tuple[int, ...] = ()) -> tuple[list[FakePort], VirtualClock]:
    """Even ids on one port, odd ones on the other."""
    clock = VirtualClock()
    servos = [FakeServo(MODELS[s.model.model_number], s.servo_id) for s in ROBOT.servos if s.servo_id not in missing]
    more = [FakeServo(MODELS[s.model.model_number], s.servo_id) for s in ROBOT.servos if s.servo_id in extra_on_b]
    a, b = [s for s in servos if s.servo_id % 2 == 0], [s for s in servos if s.servo_id % 2] + more
    return [FakePort(clock, a, ROBOT.bus.baud), FakePort(clock, b, ROBOT.bus.baud)], clock


def joined(ports: list[FakePort], clock: VirtualClock) -> ServoBus:
    bus = bus_on(ports, ROBOT, clock)
    bus.verify()
    return bus


def test_servos_are_found_on_their_ports_and_read_in_the_robots_order() -> None:
    ports, clock = two_ports()
    bus = joined(ports, clock)
    assert len(bus.chains) == 2 and bus.ids == ROBOT.servo_ids
    for port in ports:
        for i, s in port.servos.items():
            s.set("present_position", 1000 + i)
    goals = np.arange(16, dtype=np.int32) + 2000
    reading = bus.exchange(goals)
    assert reading.valid.all()
    assert reading.position_tick.tolist() == [1000 + i for i in bus.ids]
    at = ports[0].servos | ports[1].servos
    assert [at[i].get("goal_position") for i in bus.ids] == goals.tolist()
    assert bus.firmware == [52] * 16 and bus.timeouts.tolist() == [0] * 16
    assert check_servos(bus, ROBOT), "the checks take several ports as one"


def test_two_wires_are_busy_at_the_same_time() -> None:
    ports, clock = two_ports()
    bus = joined(ports, clock)
    single = [FakePort(clock, [s for p in ports for s in p.servos.values()], ROBOT.bus.baud)]
    one = bus_on(single, ROBOT, clock)
    assert isinstance(one, ServoBus)
    one.verify()
    took: list[float] = []
    for each in (bus, one):
        start_s = clock.now_s()
        for _ in range(20):
            assert each.exchange(np.full(16, 2048, np.int32)).valid.all()
        took.append(clock.now_s() - start_s)
    assert took[0] < 0.6 * took[1]
    assert bus.plan().cycle_s < 0.6 * one.plan().cycle_s


def test_torque_watchdog_and_items_reach_every_port() -> None:
    ports, clock = two_ports()
    bus = joined(ports, clock)
    at = ports[0].servos | ports[1].servos
    bus.set_effort(0.5, confirmed=True)
    bus.write_all("torque_enable", 1)
    assert set(bus.arm_watchdog(10)) == {i for i in bus.ids if at[i].model.family == "x330"}
    assert {s.get("torque_enable") for s in at.values()} == {1} and {s.get("bus_watchdog") for s in at.values()} == {10}
    at[3].set("bus_watchdog", -1)
    assert bus.tripped_watchdogs() == [3]
    bus.clear_watchdog()
    assert at[3].get("torque_enable") == 0 and at[4].get("torque_enable") == 1
    bus.send_torque_off()
    assert {s.get("torque_enable") for s in at.values()} == {0}
    bus.write_item(5, "led", 1)
    assert (bus.read_item(5, "led"), bus.poll_item(4, "led"), bus.read_items(5, ["led"])) == (1, 0, {"led": 1})
    assert bus.hardware_error_text(5) == "none"
    with pytest.raises(CommandError, match="no servo 99 on this bus"):
        bus.read_item(99, "led")


def test_a_lost_port_is_said_and_the_other_still_served() -> None:
    ports, clock = two_ports()
    bus = joined(ports, clock)
    bus.write_all("torque_enable", 1)
    ports[0].unplugged = True
    with pytest.raises(LinkLostError):
        bus.exchange(None)
    assert [bool(v) for v in bus.reading.valid] == [i % 2 == 1 for i in bus.ids]
    with pytest.raises(LinkLostError):
        bus.send_torque_off()
    assert all(s.get("torque_enable") == 0 for s in ports[1].servos.values())
    ports[0].unplugged = False
    clock.sleep_until(clock.now_s() + 1.0)
    assert bus.exchange(None).valid.all()
    assert [e.kind.value for e in bus.take_events()] == ["lost", "replugged"]


def test_a_servo_on_two_ports_on_none_and_a_port_without_servos_are_named() -> None:
    ports, clock = two_ports(2)
    with pytest.raises(BusMismatchError, match=r"on fake:// and fake://[\s\S]*another id"):
        bus_on(ports, ROBOT, clock)
    ports, clock = two_ports(missing=(4, 5))
    bus = bus_on(ports, ROBOT, clock)
    with pytest.raises(BusMismatchError) as caught:
        bus.verify()
    assert [r.servo_id for r in caught.value.rows] == [4, 5]
    ports, clock = two_ports()
    with pytest.raises(LinkTimeoutError, match="leave it out"):
        bus_on([*ports, FakePort(clock, [])], ROBOT, clock)


def test_urls_with_commas_are_several_ports() -> None:
    clock = VirtualClock()
    one = open_bus("sim://", ROBOT, clock)
    assert isinstance(one, ServoBus)
    one.close()
    with pytest.raises(CommandError, match="unknown scheme"):
        open_bus("sim://,usb://x", ROBOT, clock)


def test_when_a_port_is_lost_the_other_ports_servos_rest_within_limits() -> None:
    ports, clock = two_ports()
    link = BusLink.create(ROBOT.n_joints, ROBOT.n_servos)
    try:
        for port in ports:
            for i, servo in port.servos.items():
                servo.set(
                    "present_position", int(JointServoMap(ROBOT).rad_to_tick(ROBOT.park_rad)[ROBOT.servo_ids.index(i)])
                )
        streamer = ControlLoop(ROBOT, joined(ports, clock), link, clock, watch_front=False)
        link.request(BusRequest.ARM)
        goals: list[list[int]] = []

        def cycle() -> None:
            due_s = clock.now_s() + ROBOT.bus.period_s
            streamer.cycle()
            clock.sleep_until(due_s)
            goals.append([s.get("goal_position") for s in ports[1].servos.values()])

        for _ in range(2000):
            cycle()
            if streamer.state is BusState.HOLDING:
                break
        assert streamer.state is BusState.HOLDING, link.text
        link.setpoints.push(swing(ROBOT, 2.0), 1, 0, link.epoch, last=True)
        for _ in range(60):
            cycle()
        ports[0].unplugged = True
        n = len(goals)
        for _ in range(60):
            cycle()
        assert streamer.state is BusState.FAULT
        path = np.array(goals[n - 4 :])
        assert np.abs(np.diff(path, axis=0))[:4].max() > 3, "it moved when the port went"
        most = ROBOT.acceleration_limit_rad_s2.max() * ROBOT.bus.period_s**2 / (2 * np.pi / 4096) + 2
        assert np.abs(np.diff(path, n=2, axis=0)).max() <= most, "no goal stands still all at once"
        assert (path[-20:] == path[-1]).all(), "at rest"
        ports[0].unplugged = False
        before = [s.get("goal_position") for s in ports[0].servos.values()]
        for _ in range(100):
            cycle()
        assert [s.get("goal_position") for s in ports[0].servos.values()] == before, "no goal until it is armed anew"
    finally:
        link.close()
