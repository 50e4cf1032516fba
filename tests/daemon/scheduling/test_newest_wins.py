"""Which command wins: the newest that is accepted. One that is refused ends nothing but itself, whatever was on its way."""

from __future__ import annotations

import itertools
import time

import pytest
import zmq
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from daemon.client.errors import stamp
from daemon.scheduling.turn_taking import YIELD_S
from daemon.wire import codec as wire
from daemon.wire import events as ev
from daemon.wire.requests import Command, Gesture, Say, tag_of
from tests.support.harness import running_daemon
from tests.support.sizes import few_and_long

pytestmark = [pytest.mark.timeout(180), pytest.mark.realtime]
IDS = itertools.count()


@pytest.fixture(scope="module")
def running():
    with running_daemon() as daemon:
        yield daemon


@pytest.fixture
def talk(running):
    context = zmq.Context()
    with running.armed() as client:
        yield Talk(context, running.endpoints.cmd)
        client.stop()
    context.destroy(linger=0)


class Talk:
    """One DEALER: sends commands, gathers what becomes of each."""

    def __init__(self, context: zmq.Context, endpoint: str) -> None:
        self._socket = context.socket(zmq.DEALER)
        self._socket.connect(endpoint)
        self.heard: dict[str, list[ev.Event]] = {}

    def send(self, request: Command) -> str:
        request.id = f"c{next(IDS)}"
        stamp(request)
        self._socket.send(wire.encode(request))
        self.heard[request.id] = []
        return request.id

    def until_ended(self, *commands: str) -> None:
        end_s = time.monotonic() + 60
        while not all(self.heard[c] and self.heard[c][-1].terminal for c in commands):
            self.hear(end_s - time.monotonic())

    def until(self, command: str, kind: type) -> ev.Event:
        while not any(isinstance(e, kind) for e in self.heard[command]):
            self.hear(30)
        return next(e for e in self.heard[command] if isinstance(e, kind))

    def hear(self, timeout_s: float) -> None:
        assert timeout_s > 0 and self._socket.poll(int(1000 * timeout_s)), self.heard
        event = wire.decode_event(self._socket.recv())
        self.heard[event.id].append(event)

    def end(self, command: str) -> str:
        return tag_of(self.heard[command][-1])


REFUSED = {
    "out of scope": lambda: Say(text="do a somersault"),
    "slowly out of scope": lambda: Say(text="do a slow somersault"),
    "unknown": lambda: Gesture(name="nodd"),
    "too late": lambda: Say(text="slow wave", deadline_s=0.05),
}


@pytest.mark.long
@pytest.mark.parametrize("refused", REFUSED)
def test_a_refused_command_leaves_what_waits(talk, refused):
    talk.send(Say(text="wave", seconds=1.5))
    waits = talk.send(Say(text="left wave", seconds=0.6, when="after"))
    talk.until(waits, ev.Accepted)
    no = talk.send(REFUSED[refused]())
    talk.until_ended(no, waits)
    assert (talk.end(no), talk.end(waits)) == ("rejected", "done")


@pytest.mark.parametrize("refused", few_and_long(["slowly out of scope"], REFUSED))
def test_a_refused_command_leaves_what_is_being_made(talk, refused):
    being_made = talk.send(Say(text="slow left wave", seconds=0.6))
    no = talk.send(REFUSED[refused]())
    talk.until_ended(no, being_made)
    assert (talk.end(no), talk.end(being_made)) == ("rejected", "done")


@pytest.mark.long
def test_an_older_one_that_is_made_later_does_not_take_over_from_a_newer(talk):
    older = talk.send(Say(text="slow wave"))
    newer = talk.send(Gesture(name="nod"))  # needs no generator: accepted first
    talk.until_ended(older, newer)
    assert talk.heard[older][-1].by == f"gesture {newer}" and talk.end(newer) == "done"
    assert not any(isinstance(e, ev.Accepted | ev.Progress) for e in talk.heard[older])


def test_an_older_one_does_not_set_out_while_a_newer_is_about_to(talk):
    """Unless the machine is busy, both are made within the time that a motion that is ready waits."""
    older, newer = (talk.send(Say(text=text, seconds=0.8)) for text in ("wave", "left wave"))
    talk.until_ended(older, newer)
    assert talk.heard[older][-1].by == f"say {newer}" and talk.end(newer) == "done"
    set_out_s = [e.t_mono for e in talk.heard[older] if isinstance(e, ev.Progress)]
    accepted_s = [e.t_mono for e in talk.heard[older] if isinstance(e, ev.Accepted)]
    assert not set_out_s or set_out_s[0] - accepted_s[0] >= YIELD_S


def test_a_due_command_ends_those_before_it_and_yields_to_a_newer(talk):
    timed = talk.send(Say(text="wave", seconds=3.0, when="at", at_s=time.monotonic() + 0.6))
    before = talk.send(Say(text="left wave", seconds=4.0))
    waits = talk.send(Say(text="wave", when="after"))
    talk.until_ended(before, waits)
    assert [talk.heard[c][-1].by for c in (before, waits)] == [f"say {timed}"] * 2
    newer = talk.send(Say(text="left wave", seconds=0.6))
    talk.until_ended(timed, newer)
    assert talk.heard[timed][-1].by == f"say {newer}" and talk.end(newer) == "done"


@pytest.mark.long
def test_beyond_what_may_wait_the_newest_is_still_let_in(talk):
    """Sixty-four that are being made: the oldest of them gives way, none is refused."""
    all_ = [talk.send(Say(text="slow wave")) for _ in range(66)]
    last = talk.send(Gesture(name="nod"))
    talk.until_ended(*all_, last)
    assert {talk.end(c) for c in all_} == {"cancelled"} and talk.end(last) == "done"


AT_MOST = 8
COMMANDS = st.lists(
    st.tuples(
        st.sampled_from(["wave", "slow wave", "do a somersault", "do a slow somersault", "broken", "nod", "nodd"]),
        st.sampled_from(["now", "now", "after", "at"]),
        st.sampled_from([None, None, 0.2, 5.0]),
        st.sampled_from([0.0, 0.0, 0.02, 0.3]),
    ),
    min_size=2,
    max_size=AT_MOST,
)


@pytest.mark.long
@settings(max_examples=4, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(COMMANDS)
def test_each_ends_once_and_only_by_what_was_accepted_and_is_newer(talk, wanted):
    asked: dict[str, Command] = {}
    for words, when, deadline_s, pause_s in wanted:
        options = {"when": when, "deadline_s": deadline_s, "tempo": 2.0}
        if when == "at":
            options["at_s"] = time.monotonic() + 0.4
        request = Gesture(name=words, **options) if words.startswith("nod") else Say(text=words, seconds=0.6, **options)
        asked[talk.send(request)] = request
        time.sleep(pause_s)
    talk.until_ended(*asked)
    talk.send(last := Gesture(name="nod", when="after"))
    talk.until_ended(last.id)  # nothing follows an end
    order = list(asked)
    for command, request in asked.items():
        kinds = [tag_of(e) for e in talk.heard[command]]
        assert sum(e.terminal for e in talk.heard[command]) == 1 and kinds.count("accepted") <= 1
        assert kinds.count("done") <= ("accepted" in kinds)
        stages = [e.stage for e in talk.heard[command] if isinstance(e, ev.Progress)]
        assert stages.count("moving") <= 1, "played twice"
        last_event = talk.heard[command][-1]
        assert not isinstance(last_event, ev.Rejected) or "accepted" not in kinds
        if isinstance(last_event, ev.Cancelled):
            by = last_event.by.split()[-1]
            accepted = [e.seq for e in talk.heard[by] if isinstance(e, ev.Accepted)]
            assert accepted and accepted[0] < last_event.seq, "ended by one that was not accepted"
            assert "at" in (asked[by].when, request.when) or order.index(by) > order.index(command)
            assert asked[by].when != "after", "it waits for its turn"
