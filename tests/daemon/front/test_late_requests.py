"""A request that names an old state of the robot is refused, and nothing else is; a stop is carried out whatever it names."""

from __future__ import annotations

import json
import time

import numpy as np
import pytest

from daemon.front.late_requests import OLDEST_STATE_S, refused_as_late
from daemon.shared_memory.bus_link import BusRequest
from daemon.state.machine import RobotState
from daemon.wire import codec as wire
from daemon.wire import events as ev
from daemon.wire import requests
from tests.support.cmd_front import COMMANDS
from tests.support.ctl_front import Front, run, soon

STARTED_S, NOW_S = 1000.0, 5000.0
VERBS = {
    "arm": ({"type": "arm"}, RobotState.LIMP, BusRequest.ARM),
    "reset": ({"type": "reset"}, RobotState.ESTOP, BusRequest.RESET),
    "park": ({"type": "park"}, RobotState.IDLE, BusRequest.PARK),
    "torque on": ({"type": "torque", "on": True}, RobotState.LIMP, BusRequest.ARM),
    "torque off": ({"type": "torque", "on": False}, RobotState.IDLE, BusRequest.TORQUE_OFF),
}
"""What is asked, in a state that allows it, and the request that the bus process receives for it."""
SILLY = [-1e300, 0, 1e300, None, "yesterday", True, [[[]]], {"t_mono": 1}]


def asked(request: dict, state_s: object) -> str:
    return json.dumps(request | {"id": "pressed", "state_t_mono": state_s})


@pytest.mark.parametrize("name", [*VERBS, *COMMANDS])
@pytest.mark.parametrize(
    ("state_s", "found"),
    [
        (NOW_S, ""),
        (NOW_S - 0.04, ""),
        (NOW_S - OLDEST_STATE_S, ""),
        (None, ""),
        (NOW_S - OLDEST_STATE_S - 0.125, "3.1 s old"),
        (NOW_S - 60, "60.0 s old"),
        (STARTED_S, "4000.0 s old"),
        (STARTED_S - 0.01, "before this daemon's start"),
        (0.0, "before this daemon's start"),
        (-1e300, "before this daemon's start"),
        (NOW_S + 0.01, "still to come"),
        (1e300, "still to come"),
    ],
)
def test_a_request_on_an_old_or_foreign_state_is_refused(name, state_s, found):
    frame = asked(VERBS[name][0] if name in VERBS else COMMANDS[name], state_s).encode()
    request = wire.decode_ctl(frame) if name in VERBS else wire.decode_cmd(frame)
    refused = refused_as_late(request, NOW_S, STARTED_S)
    if not found:
        assert refused is None
        return
    assert refused is not None and (refused.id, refused.code, refused.asked) == ("pressed", "stale_state", name)
    assert found in refused.found and "3 s" in refused.allowed
    assert "not carried out" in refused.do and ("`estop`" in refused.do) == (name == "torque off")


def test_a_state_of_before_a_restart_is_refused_though_it_is_new():
    request = wire.decode_ctl(asked({"type": "arm"}, NOW_S - 1).encode())
    assert refused_as_late(request, NOW_S, NOW_S - 0.5) is not None


@pytest.mark.parametrize("state_s", SILLY)
@pytest.mark.parametrize("verb", ["stop", "estop"])
def test_a_stop_is_not_judged(verb, state_s):
    assert refused_as_late(wire.decode_ctl(asked({"type": verb}, state_s).encode()), NOW_S, STARTED_S) is None


@pytest.mark.parametrize("kind", [k for k in requests.CTL_TYPES if k is not requests.Torque])
def test_a_client_that_names_no_state_sends_no_field(kind):
    """A daemon of before the field would refuse a `stop` with it."""
    assert b"state_t_mono" not in wire.encode(kind())


@pytest.mark.parametrize("verb", VERBS)
def test_a_late_verb_reaches_no_bus_process_and_ends_no_command(verb):
    request, state, _ = VERBS[verb]

    async def test(front: Front) -> None:
        before = front.machine.must_arm
        front.handed(asked(request, time.monotonic() - OLDEST_STATE_S - 1), front.ctl.new_number())
        front.desk.take_waiting()
        await soon()
        answer = front.answer()
        assert answer is not None
        refused = wire.decode_event(answer.event)
        assert isinstance(refused, ev.Rejected) and (refused.id, refused.code) == ("pressed", "stale_state")
        assert front.ctl.take_request() is None and not front.ended
        assert (front.machine.state, front.machine.must_arm) == (state, before)
        assert [type(event) for event in front.published] == [ev.Rejected]

    run(test, state)


@pytest.mark.parametrize("named", ["the newest state", "no state", "null"])
@pytest.mark.parametrize("verb", VERBS)
def test_a_verb_with_a_new_state_or_none_is_carried_out(verb, named):
    request, state, kind = VERBS[verb]

    async def test(front: Front) -> None:
        number, shown_s = front.ctl.new_number(), {"the newest state": time.monotonic(), "null": None}
        front.handed(asked(request, shown_s[named]) if named in shown_s else json.dumps(request), number)
        front.desk.take_waiting()
        await soon()
        answer = front.answer()
        assert answer is not None and isinstance(wire.decode_event(answer.event), ev.Ack)
        taken = front.ctl.take_request()
        assert taken is not None and (taken.kind, taken.number) == (kind, number)

    run(test, state)


@pytest.mark.parametrize("state_s", SILLY)
@pytest.mark.parametrize("verb", ["stop", "estop"])
def test_a_stop_ends_commands_whatever_state_it_names(verb, state_s):
    async def test(front: Front) -> None:
        front.link.setpoints.push(np.zeros((3, 2)), 1, 0, front.link.epoch, last=True)
        number = front.halted(verb, told=False)
        front.handed(asked({"type": verb}, state_s), number)
        front.desk.take_waiting()
        await soon()
        assert front.ended == [verb] and front.ctl.take_setpoint() is None
        taken = front.ctl.take_request()
        assert taken is not None and taken.kind is BusRequest[verb.upper()]

    run(test)
