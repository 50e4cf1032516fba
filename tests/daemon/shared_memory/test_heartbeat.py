"""A process that has stopped to beat is lost after so many of one's own steps; one's own pause costs it nothing."""

from __future__ import annotations

import pytest

from daemon.control.bus_state_machine import CTL_LOST_S
from daemon.shared_memory.bus_link import BusRequest, BusState
from daemon.shared_memory.heartbeat import HeartbeatWatch
from tests.support.rig import lead_to, rig
from tests.support.sizes import few_and_long


def test_a_still_heartbeat_is_lost_after_the_limit_and_back_with_the_next():
    silence = HeartbeatWatch(0.18, 0.01)
    assert not any(silence.lasts(7) for _ in range(18))
    assert silence.lasts(7) and silence.lasts(7)
    assert not silence.lasts(8)


def test_who_has_not_begun_is_waited_for():
    silence = HeartbeatWatch(0.18, 0.01)
    assert not any(silence.lasts(0) for _ in range(1000))


@pytest.mark.parametrize("state", few_and_long(["playing"], ["limp", "holding", "stopping", "parking"]))
@pytest.mark.parametrize("holds", [False, True])
def test_a_lost_heartbeat_is_an_estop_in_0_2_s_until_it_is_back(state, holds):
    with rig() as r:
        r.link.set_estop_holds(holds)
        r.link.ctl_beats()
        if state != "limp":
            lead_to_with_beats(r, state)
        for _ in range(round(0.2 / r.robot.bus.period_s)):
            r.cycle()
        assert r.state is BusState.ESTOP and "nobody took e-stops" in r.link.text
        assert any(r.torque) == (holds and state != "limp")
        r.link.request(BusRequest.RESET)
        r.link.request(BusRequest.ARM)
        r.cycle(20)
        assert r.state is BusState.ESTOP and not any(r.torque)
        r.link.ctl_beats()
        r.cycle()
        r.link.request(BusRequest.RESET)
        r.cycle()
        assert r.state is BusState.LIMP
        assert CTL_LOST_S < 0.2


def lead_to_with_beats(r, state) -> None:
    """To a state, with a beat before each cycle."""
    inner = r.streamer.cycle

    def cycle() -> None:
        r.link.ctl_beats()
        inner()

    r.streamer.cycle = cycle
    lead_to(r, state)
    r.streamer.cycle = inner
