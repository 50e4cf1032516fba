"""Health and counters of each servo, from the bus process to the front, its clients and Prometheus."""

from __future__ import annotations

import contextlib
import urllib.request

import numpy as np
import pytest

from daemon.cli.client.status import _servo
from daemon.demo.main_job import free_endpoints
from daemon.dynamixel.bus_opening import bus_on
from daemon.dynamixel.health import COUNTERS, HEALTH, Health
from daemon.front.metrics import exposition
from daemon.shared_memory.bus_link import BusLink
from daemon.state.bus_view import BusView
from daemon.wire.status import ServoHealth, StateEvent
from sim.bus import SimBus
from sim.clock import VirtualClock
from sim.faults import Fault, FaultSchedule
from sim.port import SimPort
from sim.world import World
from tests.support.harness import RunningDaemon
from tests.support.rig import rig
from tests.support.robots import packaged

ROBOT = packaged("reference")


def test_what_the_bus_finds_of_a_servo_stands_in_the_shared_memory() -> None:
    with rig("reference", Fault("silent", start_s=0.5, end_s=2.0, servo_id=15), Fault("drop", 3.0, 3.05)) as r:
        front = BusView(BusLink.attach(r.link.path, ROBOT.n_joints, ROBOT.n_servos), ROBOT)
        assert front.health() == [], "nothing is known before the first cycle"
        r.cycle(20)
        assert {s.state for s in front.health()} == {"ok"}
        r.cycle(100)
        (gone,) = [s for s in front.health() if s.state != "ok"]
        assert (gone.id, gone.state, gone.timeouts) == (15, "quarantined", 10)
        assert gone.joint == ROBOT.servos[ROBOT.servo_ids.index(15)].joint_name
        r.cycle(150)
        assert {s.state for s in front.health()} == {"ok"}
        r.cycle(100)
        for name in COUNTERS:
            assert r.link.health[name].tolist() == getattr(r.bus.chains[0].link.health.counters, name).tolist()
        assert (r.link.health["timeouts"] > 0).all()


def test_while_the_port_is_gone_no_servo_is_said_to_be_well() -> None:
    with rig("reference", Fault("unplug", start_s=0.5)) as r:
        r.cycle(100)
        view = BusView(r.link, ROBOT)
        view.update()
        assert {s.state for s in view.health()} == {"missing"}
        assert view.counters()["servos_not_answering"] == list(ROBOT.servo_ids)


def test_a_front_that_was_held_up_does_not_take_its_own_pause_for_silence() -> None:
    """It was frozen between looking and judging: the bus process was said to be lost, and was there: an e-stop."""
    clock = VirtualClock()
    with rig("reference") as r:
        view = BusView(r.link, ROBOT, clock)
        r.cycle()
        view.update()
        clock.sleep_until(1.2)
        assert view.silent_s == 0.0
        r.cycle()
        view.update()
        assert view.silent_s == 0.0
        clock.sleep_until(2.0)
        view.update()
        assert view.silent_s == pytest.approx(0.8)


def test_servos_on_several_ports_stand_in_the_robots_order() -> None:
    clock = VirtualClock()
    world = World(ROBOT, FaultSchedule((Fault("silent", start_s=5.0, servo_id=16),)))
    halves = [[i for i in ROBOT.servo_ids if i % 2 == odd] for odd in (0, 1)]
    ports = [SimPort(SimBus(ROBOT, world=world, servo_ids=half), clock) for half in halves]
    bus = bus_on(ports, ROBOT, clock)
    bus.verify()
    clock.sleep_until(5.0)
    for _ in range(3):
        bus.exchange(None)
    table = np.zeros(ROBOT.n_servos, HEALTH)
    bus.show_health(table)
    row = ROBOT.servo_ids.index(16)
    assert table["state"].tolist() == [Health.MISSING if i == row else Health.OK for i in range(ROBOT.n_servos)]
    assert table["timeouts"].tolist() == [3 if i == row else 0 for i in range(ROBOT.n_servos)]


STATE = StateEvent(
    robot='a "b"', bus="sim://", state="idle", must_arm=False, reason="", command=None, generator="ready", joint_names=[],
    goal_rad=[], present_rad=[], queued_ms=0.0, bus_info={}, recording="", uptime_s=1.0,
)  # fmt: skip


def test_prometheus_hears_of_every_servo() -> None:
    servos = [ServoHealth(1, "neck", "ok"), ServoHealth(7, "elbow", "quarantined", timeouts=10, crc=2)]
    lines = exposition(STATE, {}, servos).splitlines()
    assert r'mmmd_servo_state{robot="a \"b\"",servo="7",joint="elbow",state="quarantined"} 1' in lines
    assert r'mmmd_servo_state{robot="a \"b\"",servo="7",joint="elbow",state="ok"} 0' in lines
    assert r'mmmd_servo_timeouts_total{robot="a \"b\"",servo="7",joint="elbow"} 10' in lines
    assert sum(line.startswith("mmmd_servo_state{") for line in lines) == 2 * len(Health)
    samples = [line.rsplit(" ", 1)[0] for line in lines if line[0] != "#"]
    assert len(set(samples)) == len(samples), "each once"


def test_status_says_what_is_wrong_with_a_servo_in_one_line() -> None:
    assert _servo(ServoHealth(7, "elbow", "quarantined", timeouts=10, alerts=1)) == (
        "7 (elbow) quarantined: 10 time-outs, 1 alerts"
    )
    assert _servo(ServoHealth(7, "elbow", "faulted")) == "7 (elbow) faulted"


@pytest.mark.long
@pytest.mark.timeout(90)
def test_a_daemon_tells_its_clients_of_a_servo_that_went_silent(tmp_path) -> None:
    faults = tmp_path / "faults.toml"
    faults.write_text('[[fault]]\nkind = "silent"\nstart_s = 1.0\nservo_id = 15\n')
    port = int(free_endpoints().cmd.rsplit(":", 1)[1])
    daemon = RunningDaemon("--metrics", f"127.0.0.1:{port}", bus=f"sim://?faults={faults}")
    try:
        daemon.until_ready()
        with daemon.client() as client, contextlib.closing(client.watch("v1/health")) as told:
            found = next(event for topic, event in told if any(s.state == "quarantined" for s in event.servos))
            assert [s.id for s in found.servos] == list(ROBOT.servo_ids)
            assert [s.id for s in found.servos if s.state == "quarantined"] == [15]
            assert [(s.id, s.state) for s in client.status().servos_not_ok] == [(15, "quarantined")]
        said = daemon.mmmd("status")
        assert "quarantined: 10 time-outs" in said.stdout
        text = urllib.request.urlopen(f"http://127.0.0.1:{port}/metrics", timeout=5).read().decode()
        assert any('servo="15"' in line and 'state="quarantined"} 1' in line for line in text.splitlines())
    finally:
        daemon.close()
