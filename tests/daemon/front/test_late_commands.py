"""A request on `cmd` that names an old state of the robot sets nothing going; a text that means to stop stops, however old."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

import pytest

from daemon.front.late_requests import OLDEST_STATE_S
from daemon.wire import codec as wire
from daemon.wire import events as ev
from daemon.wire import requests
from tests.support.cmd_front import COMMANDS, STOPS, CmdFront

LATE_S = OLDEST_STATE_S + 1
SAY = {"type": "say"}


def run(test: Callable[[CmdFront], None]) -> None:
    """Run a test on a front of its own, within an event loop."""

    async def body() -> None:
        test(CmdFront())

    asyncio.run(body())


def code_of(event: ev.Event | None) -> str:
    return event.code if isinstance(event, ev.Rejected) else ""


def test_every_request_that_sets_motion_going_may_name_a_state():
    named = {requests.tag_of(kind) for kind in requests.CMD_TYPES if issubclass(kind, requests.TimelyRequest)}
    assert named == {request["type"] for request in COMMANDS.values()}


@pytest.mark.parametrize("name", COMMANDS)
def test_a_client_that_names_no_state_sends_no_field(name):
    """A daemon of before the field would refuse a request with it."""
    assert b"state_t_mono" not in wire.encode(wire.decode_cmd(CmdFront.frame(COMMANDS[name])))


@pytest.mark.parametrize("name", COMMANDS)
def test_a_late_request_reaches_nothing(name):
    def test(front: CmdFront) -> None:
        refused = front.take(COMMANDS[name], LATE_S, id="pressed")
        assert isinstance(refused, ev.Rejected)
        assert (refused.id, refused.code, refused.asked) == ("pressed", "stale_state", name)
        assert "4.0 s old when it arrived" in refused.found and "not carried out" in refused.do
        assert front.heard == [refused] and not front.reached
        assert (front.layers.idle_style, front.layers.gaze_deg) == ("", None)

    run(test)


@pytest.mark.parametrize("named", ["the newest state", "no state", "null"])
@pytest.mark.parametrize("name", COMMANDS)
def test_a_request_with_a_new_state_or_none_is_carried_out(name, named):
    def test(front: CmdFront) -> None:
        age_s = {"the newest state": OLDEST_STATE_S - 0.1, "no state": None, "null": None}[named]
        answer = front.take(COMMANDS[name], age_s, **({"state_t_mono": None} if named == "null" else {}))
        is_command = name not in ("look", "idle")
        assert is_command or isinstance(answer, ev.Ack)
        assert front.reached == {"idle": [], "look": ["look"]}.get(name, ["play"])
        assert front.layers.idle_style == ("calm" if name == "idle" else "")

    run(test)


@pytest.mark.parametrize("state", ["late", -1e300, 0, 1e300, None])
@pytest.mark.parametrize("name", STOPS)
def test_a_text_that_means_to_stop_is_carried_out_however_old(name, state):
    def test(front: CmdFront) -> None:
        answer = front.take(STOPS[name], 1e6, **({} if state == "late" else {"state_t_mono": state}))
        assert isinstance(answer, ev.Ack) and front.reached == ["stop"]

    run(test)


def test_a_late_text_does_not_count_as_said():
    def test(front: CmdFront) -> None:
        assert code_of(front.take(SAY, LATE_S, text="again")) == "stale_state"
        assert code_of(front.take(SAY, 0, text="again")) == "nothing_to_refer_to"
        front.take(SAY, 0, text="nod")
        assert code_of(front.take(SAY, LATE_S, text="clap")) == "stale_state"
        assert code_of(front.take(SAY, LATE_S, text="slower")) == "stale_state"
        front.take(SAY, 0, text="again")
        assert [entry.request.words for entry in front.played] == ["nod", "exactly: nod"]

    run(test)


def test_an_id_is_judged_when_it_comes_first():
    """A client that sends a request again, after a lost connection, learns what became of it, and it is not done twice."""

    def test(front: CmdFront) -> None:
        for id_, first_s, then_s in (("new, then late", 0, LATE_S), ("late, then new", LATE_S, 0)):
            first = front.take(SAY, first_s, text="nod", id=id_)
            assert front.take(SAY, then_s, text="nod", id=id_) is first
        assert [entry.id for entry in front.played] == ["new, then late"]
        front.take(SAY, 0, text="nod", id="once", state_t_mono=1e9)
        assert code_of(front.take(SAY, None, text="nod", id="once")) == "stale_state", "the same request"

    run(test)
