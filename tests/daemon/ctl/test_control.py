"""What takes `ctl`, over real sockets and real shared memory: a stop reaches the bus process first, whatever else is asked.

The test is the front at the other end of the channel, and the bus process at the other end of the words.
"""

from __future__ import annotations

import time

import pytest
import zmq

from daemon.ctl.channel import Answered, Channel, Handed, Told, pair
from daemon.ctl.taker import AT_ONCE, FRONT_ANSWERS_S, HALT_REPLY_S, Taker
from daemon.network.connections import ConnectionGuard
from daemon.shared_memory.bus_link import BusLink, BusRequest
from daemon.shared_memory.request_words import Asker
from daemon.wire import codec as wire
from daemon.wire import events as ev

pytestmark = pytest.mark.timeout(30)


class Ctl:
    """A taker and its neighbours; nothing happens but in `turn`."""

    def __init__(self, *, holds: bool = False) -> None:
        self._context, self.now_s = zmq.Context(), 0.0
        self.front_link = BusLink.create(2)
        self.front_link.set_estop_holds(holds)
        self.bus_link = BusLink.attach(self.front_link.path, 2)
        self.link = BusLink.attach(self.front_link.path, 2, asker=Asker.CTL)
        self.server, self.client = self._context.socket(zmq.ROUTER), self._context.socket(zmq.DEALER)
        self.server.bind("inproc://ctl")
        self.client.connect("inproc://ctl")
        ours, theirs = pair()
        self.front, self._channel = Channel(ours), Channel(theirs)
        self.taker = Taker(self.server, self.link, self._channel, ConnectionGuard({}), lambda: self.now_s)
        self.handed: list[Handed] = []
        self.told: list[ev.AnyEvent] = []
        self.others: list[zmq.Socket[bytes]] = []

    def another_client(self) -> zmq.Socket[bytes]:
        """A connection of somebody else."""
        self.others.append(self._context.socket(zmq.DEALER))
        self.others[-1].connect("inproc://ctl")
        return self.others[-1]

    def ask(self, *frames: str | bytes) -> None:
        """Send requests; a bare verb has itself as its id."""
        for frame in frames:
            text = frame if isinstance(frame, bytes) else f'{{"type": "{frame}", "id": "{frame}"}}'.encode()
            self.client.send(text)

    def turn(self, n: int = 1, seconds: float = 0.0) -> list[ev.AnyEvent]:
        """So many turns; the replies of them all."""
        replies = []
        for _ in range(n):
            self.now_s += seconds
            self.taker.turn()
            while self.client.poll(0):
                replies.append(wire.decode_event(self.client.recv()))
            while (message := self.front.receive()) is not None:
                if isinstance(message, Handed):
                    self.handed.append(message)
                elif isinstance(message, Told):
                    self.told.append(wire.decode_event(message.event))
        return replies

    def verbs_handed(self) -> list[str]:
        return [type(wire.decode_ctl(handed.frame)).__struct_config__.tag for handed in self.handed]

    def bus_takes(self) -> list[BusRequest]:
        """What the bus process carries out now."""
        taken = []
        while (asked := self.bus_link.take_request()) is not None:
            taken.append(asked.kind)
            self.bus_link.done(asked)
        return taken

    def front_answers(self, event: ev.Event | None = None) -> None:
        for handed in self.handed:
            self.front.send(Answered(handed.number, b"" if event is None else wire.encode(event)))

    def close(self) -> None:
        self.front.close()
        self._channel.close()
        self._context.destroy(linger=0)
        self.front_link.close()


@pytest.fixture
def ctl():
    made = Ctl()
    yield made
    made.close()


def test_an_estop_goes_before_what_waits(ctl):
    ctl.ask("stop", "status", "estop", "status")
    ctl.turn()
    assert ctl.bus_takes() == [BusRequest.ESTOP, BusRequest.STOP]
    ctl.turn()
    assert ctl.verbs_handed() == ["estop", "stop", "status", "status"]


def test_an_estop_does_not_wait_until_a_flood_is_read(ctl):
    """The whole flood, up to 4,096 requests, was read and decoded before the e-stop was served."""
    flood = ctl.another_client()
    for _ in range(900):
        flood.send(b'{"type": "status"}')
    ctl.ask("estop")
    ctl.turn()
    assert ctl.bus_takes() == [BusRequest.ESTOP] and ctl.verbs_handed()[0] == "estop"
    assert ctl.server.poll(0), "the flood was read first"


def test_what_came_before_an_estop_does_not_undo_it(ctl):
    """Served after the e-stop that overtook them, a reset and an arm would switch the torque on again."""
    ctl.ask("stop", "reset", "arm", "park", "estop")
    replies = ctl.turn(5)
    assert ctl.verbs_handed() == ["estop", "stop"]
    assert {r.id: r.code for r in replies} == dict.fromkeys(("reset", "arm", "park"), "overtaken")


def test_a_reset_received_before_the_estop_is_void_at_the_bus_process(ctl):
    """It was handed over, and the front hands it on after the e-stop was carried out."""
    ctl.ask("reset", "arm")
    ctl.turn(2)
    ctl.ask("estop")
    ctl.turn()
    assert ctl.bus_takes() == [BusRequest.ESTOP]
    for handed, kind in zip(ctl.handed, (BusRequest.RESET, BusRequest.ARM), strict=False):
        ctl.front_link.request(kind, number=handed.number)
    assert ctl.bus_takes() == []


def test_what_comes_after_an_estop_is_handed_over(ctl):
    ctl.ask("estop", "reset", "arm")
    ctl.turn(3)
    assert ctl.bus_takes() == [BusRequest.ESTOP] and ctl.verbs_handed() == ["estop", "reset", "arm"]


@pytest.mark.parametrize(("holds", "kind"), [(False, BusRequest.ESTOP), (True, BusRequest.ESTOP_HOLD)])
def test_an_estop_cuts_or_holds_as_the_daemon_is_set(holds, kind):
    ctl = Ctl(holds=holds)
    try:
        ctl.ask("estop")
        ctl.turn()
        assert ctl.bus_takes() == [kind]
    finally:
        ctl.close()


@pytest.mark.parametrize("state_s", ["-1e300", "1e300", "null", '"old"', "true", '{"a": [1]}', "[" * 900 + "]" * 900])
@pytest.mark.parametrize("verb", ["stop", "estop"])
def test_a_stop_is_carried_out_whatever_state_it_names(ctl, verb, state_s):
    """`arm`, `reset`, `park` and `torque` are refused with an old state; the field must never cost a stop."""
    ctl.ask(f'{{"type": "{verb}", "id": "now", "state_t_mono": {state_s}}}'.encode())
    ctl.turn()
    assert ctl.bus_takes() == [BusRequest[verb.upper()]]
    ctl.front_answers()
    [ack] = ctl.turn(2)
    assert isinstance(ack, ev.Ack) and (ack.id, ack.verb, ack.carried_out) == ("now", verb, True)


def test_the_reply_says_that_it_is_carried_out(ctl):
    ctl.ask("estop")
    assert ctl.turn() == [], "neither the bus process nor the front has said anything"
    ctl.bus_takes()
    ctl.front_answers()
    [ack] = ctl.turn(2)
    assert isinstance(ack, ev.Ack) and ack.carried_out and ack.verb == "estop"
    ctl.turn()
    assert [type(event) for event in ctl.told] == [ev.Ack], "whoever watches hears of it by way of the front"


@pytest.mark.parametrize("verb", ["stop", "estop"])
def test_a_reply_says_when_no_cycle_has_carried_the_request_out_yet(ctl, verb):
    """Four of four e-stops given within a second of the death of the bus process were acknowledged, and lost."""
    ctl.ask(verb)
    ctl.turn()
    ctl.front_answers()
    assert ctl.turn(10) == []
    [ack] = ctl.turn(seconds=2 * HALT_REPLY_S)
    assert isinstance(ack, ev.Ack) and ack.carried_out is False
    assert ctl.turn(20, seconds=1.0) == [], "it stays asked for"
    assert ctl.bus_takes() == [BusRequest[verb.upper()]]
    [done] = ctl.turn()
    assert isinstance(done, ev.CarriedOut) and done.id == ack.id and done.verb == verb


def test_a_frozen_front_keeps_no_stop_from_the_bus_process(ctl):
    ctl.ask("arm", "status", "stop")
    ctl.turn(3)
    assert ctl.bus_takes() == [BusRequest.STOP]
    [ack] = ctl.turn(seconds=2 * HALT_REPLY_S)
    assert isinstance(ack, ev.Ack) and ack.carried_out
    [refused] = ctl.turn(seconds=FRONT_ANSWERS_S)
    assert (refused.id, refused.code) == ("arm", "front_silent")


def test_a_dead_front_keeps_no_stop_from_the_bus_process(ctl):
    ctl.front.close()
    for verb in ("stop", "estop"):
        ctl.ask(verb)
        ctl.taker.turn()
        assert ctl.bus_takes() == [BusRequest[verb.upper()]]


def test_a_dead_front_holds_up_no_reply_to_an_estop(ctl):
    """The bus process ends once it has carried it out and nobody else is there; ctl then ended before its reply was due."""
    ctl.front.close()
    ctl.ask("estop")
    while not ctl.bus_takes():
        ctl.taker.turn()
    (reply,) = ctl.turn(3)
    assert isinstance(reply, ev.Ack) and reply.carried_out


def test_a_front_that_takes_nothing_costs_bounded_memory_and_no_stop(monkeypatch):
    monkeypatch.setattr("daemon.ctl.taker.MOST_OPEN", 300)
    ctl = Ctl()
    try:
        ctl.ask(*["status"] * 1000)
        for _ in range(1000):
            ctl.taker.turn()
        ctl.ask("estop")
        ctl.taker.turn()
        assert ctl.bus_takes() == [BusRequest.ESTOP]
        assert len(ctl.taker._due) <= 300 + 1 and len(ctl.taker._to_front) <= 300
    finally:
        ctl.close()


@pytest.mark.parametrize(
    "frame", [b"dance", b"{", b"\xff", b'{"type": "stop", "v": ' + b"[" * 991 + b"]" * 991 + b"}", b"x" * 70_000]
)
def test_a_bad_frame_is_answered_and_ends_nothing(ctl, frame):
    ctl.ask("stop", frame, "estop")
    replies = ctl.turn(3)
    assert any(isinstance(r, ev.ErrorEvent) for r in replies)
    assert ctl.bus_takes() == [BusRequest.ESTOP, BusRequest.STOP] and ctl.verbs_handed() == ["estop", "stop"]


def test_of_a_message_of_endlessly_many_parts_nothing_is_kept(ctl):
    ctl.client.send_multipart([b"estop"] * 100_000)
    ctl.ask("stop")
    replies = ctl.turn(2)
    assert any(isinstance(r, ev.ErrorEvent) and r.code == "frames" for r in replies)
    assert ctl.bus_takes() == [BusRequest.STOP]


def test_it_beats_however_much_there_is_to_read(ctl, monkeypatch):
    beats = []
    monkeypatch.setattr(ctl.link, "ctl_beats", lambda: beats.append(time.monotonic()))
    ctl.ask(*["status"] * 300)
    for n in range(1, 4):
        ctl.taker.turn()
        assert len(beats) >= 2 * n * AT_ONCE
