"""Two servos with one id, on the simulated wire on which they garble each other."""

from __future__ import annotations

from dataclasses import replace

import pytest

from daemon.dynamixel.events import BusEventKind
from daemon.dynamixel.health import Health
from daemon.dynamixel.servo_bus import ServoBus
from daemon.errors import BusMismatchError, LinkGarbledError
from retarget.robot.loading import load_robot
from sim.bus import SimBus
from sim.clock import VirtualClock
from sim.faults import Fault, FaultSchedule
from sim.port import SimPort
from sim.world import World
from tests.support.sizes import few_and_long

ROBOT, TWIN = load_robot("reference"), 7
ROW = ROBOT.servo_ids.index(TWIN)


PLAIN, FAST = 44, 52
"""Firmware without and with fast sync reads."""


def with_a_twin(
    *faults: Fault, firmware: int = PLAIN, apart_ticks: float = 300.0, **settings: int
) -> tuple[ServoBus, SimBus, VirtualClock]:
    """A bus on which another servo of the same kind has the id of one; so far apart, and set otherwise."""
    clock = VirtualClock()
    extra = replace(ROBOT.servos[ROW], joint_name="stranger")
    world = World(ROBOT, FaultSchedule(faults), extra=(extra,), firmware=dict.fromkeys(ROBOT.servo_ids, firmware))
    world.all[-1].position_tick = world.servos[TWIN].position_tick + apart_ticks
    for name, value in settings.items():
        world.all[-1]._set(name, value)
    servos = SimBus(ROBOT, world=world)
    return ServoBus.on_port(SimPort(servos, clock), ROBOT.servos, clock), servos, clock


@pytest.mark.parametrize("settings", [{}, {"return_delay_time": 10}, {"firmware_version": 43}])
def test_the_robot_does_not_start_with_two_servos_of_one_id(settings: dict[str, int]) -> None:
    """They say the same to a ping, which is heard as one answer: the start saw nothing."""
    bus, _, _ = with_a_twin(**settings)
    with pytest.raises(BusMismatchError, match=f"two servos with id {TWIN}, or noise") as caught:
        bus.verify()
    assert [(r.servo_id, r.found) for r in caught.value.rows] == [(TWIN, "answers collide")]


def test_one_question_says_that_answers_came_garbled_not_that_none_came() -> None:
    bus, _, _ = with_a_twin()
    with pytest.raises(LinkGarbledError, match=r"servo 7: 3 answers came garbled.*mmmd servo id"):
        bus.read_item(TWIN, "present_position")
    assert bus.read_item(TWIN, "led") == 0, "the same bytes at the same time"


@pytest.mark.parametrize("firmware", few_and_long([FAST], [PLAIN, FAST]))
def test_a_twin_that_comes_while_the_robot_runs_is_named_and_its_loss_too(firmware: int) -> None:
    """It was said to be silent, and nothing else; by fast reads what both said at once was taken for a position."""
    bus, servos, clock = with_a_twin(firmware=firmware)
    twin = servos.on_wire.pop()
    bus.verify()
    assert bus.exchange(None).valid.all()
    servos.on_wire.append(twin)
    for _ in range(400):
        assert not bus.exchange(None).valid[ROW]
        clock.sleep_until(clock.now_s() + 0.01)
    told = {e.kind: e for e in bus.take_events()}
    assert bus.chains[0].link.health.state[ROW] == Health.QUARANTINED
    assert told[BusEventKind.DUPLICATE_ID].servo_id == TWIN
    assert "two servos with id 7, or noise" in told[BusEventKind.DUPLICATE_ID].text
    assert BusEventKind.RETURNED not in told, "a ping would have been answered"
    servos.on_wire.remove(twin)
    for _ in range(150):
        bus.exchange(None)
        clock.sleep_until(clock.now_s() + 0.01)
    assert bus.exchange(None).valid.all()
    assert BusEventKind.RETURNED in [e.kind for e in bus.take_events()]


@pytest.mark.parametrize("kind", few_and_long(["silent"], ["silent", "drop"]))
def test_a_servo_that_says_nothing_is_not_taken_for_two(kind: str) -> None:
    bus, servos, clock = with_a_twin(Fault(kind, start_s=0.5, servo_id=TWIN))
    servos.on_wire.pop()
    bus.verify()
    clock.sleep_until(0.5)
    for _ in range(500):
        bus.exchange(None)
        clock.sleep_until(clock.now_s() + 0.01)
    assert [e.kind for e in bus.take_events()] == [BusEventKind.QUARANTINED]
