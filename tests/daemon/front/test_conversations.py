"""Texts that refer to the last command of their own connection, and never to another's."""

from __future__ import annotations

from functools import partial

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daemon.front import conversations
from daemon.front.conversations import FORGET_S, Conversations
from daemon.state.ledger import Ledger, Route
from daemon.state.replies import NotPlayableError
from daemon.wire.codec import WireError
from daemon.wire.events import Accepted, Cancelled, Rejected
from daemon.wire.requests import Gesture, Say, SceneOf, Story

ANNA, BERT = (b"anna", "127.0.0.1"), (b"bert", "127.0.0.1")
ACCEPTED = partial(
    Accepted, plan_id=1, text="", status="accepted", understood="", reason="", scope_score=1.0, duration_s=1.0, generate_ms=1.0
)  # fmt: skip
ROUTE = Route((b"d",), once=False)


class Desk:
    """A ledger and conversations at a time that is set."""

    def __init__(self) -> None:
        self.time_s = 1000.0
        self.ledger = Ledger(lambda _route, _event: None, lambda _event: None)
        self.talk = Conversations({"wave_left": "wave with your left hand"}.get, lambda: self.time_s)  # type: ignore[arg-type]

    def say(self, request, client=ANNA, *, ends: str = "cancelled"):
        entry = self.ledger.open(request, ROUTE, 0)
        try:
            self.talk.take(entry, client)
        except NotPlayableError as refused:
            self.ledger.emit(entry, refused.event)
            return entry
        if ends != "rejected":
            self._emit(entry, ACCEPTED())
        if ends == "rejected":
            self._emit(entry, Rejected(code="out_of_scope", asked="", found="", allowed="", do=""))
        elif ends:
            self._emit(entry, Cancelled(plan_id=1, by="stop"))
        return entry

    def _emit(self, entry, event):
        self.ledger.emit(entry, event)
        event.t_mono = self.time_s


@pytest.fixture
def desk():
    return Desk()


def code_of(entry) -> str:
    return entry.events[-1].code if isinstance(entry.events[-1], Rejected) else ""


def test_a_text_becomes_what_it_means_and_says_to_what_it_refers(desk):
    first = desk.say(Say(text="wave with your right hand", tempo=1.2, mirror=True, seed=4))
    second = desk.say(Say(text="slower", amplitude=0.9))
    assert second.refers_to == first.id and second.asked.text == "slower"
    assert second.request == Say(text="exactly: wave with your right hand (0.65 times as fast)", tempo=1.2, mirror=True, seed=4,
                                 amplitude=0.9)  # fmt: skip
    third = desk.say(Say(text="with the other hand"))
    assert (
        third.request.text == "exactly: wave with your left hand (0.65 times as fast)"
        and third.request.amplitude == 0.9
    )


def test_a_text_refers_to_what_the_generator_read_in_the_last_one(desk):
    entry = desk.ledger.open(Say(text="tap your imaginary stand twice, and give them a slow three-beat"), ROUTE, 0)
    desk.talk.take(entry, ANNA)
    desk._emit(entry, ACCEPTED(commands=("clap twice", "bow (0.62 times as fast) + nod")))
    assert desk.say(Say(text="again")).request.text == "exactly: clap twice; bow (0.62 times as fast) + nod"


def test_a_continuing_motion_loops_until_a_number_is_named(desk):
    desk.say(Say(text="clap"))
    assert desk.say(Say(text="keep going"), ends="").request.loop
    assert desk.say(Say(text="faster"), ends="").request.loop
    assert not desk.say(Say(text="three more")).request.loop
    desk.say(Say(text="nod, then bow"))
    assert desk.say(Say(text="three more")).request.repeat == 3
    desk.say(Say(text="raise both arms"))
    assert desk.say(Say(text="keep going")).request.hold


def test_a_refused_command_is_passed_over(desk):
    desk.say(Say(text="nod"))
    desk.say(Say(text="do a somersault"), ends="rejected")
    assert desk.say(Say(text="again")).request.text == "exactly: nod"


def test_two_minutes_after_its_end_a_command_is_forgotten(desk):
    desk.say(Say(text="nod"))
    desk.time_s += FORGET_S
    assert not code_of(desk.say(Say(text="again"), ends=""))
    desk.time_s += 10 * FORGET_S
    assert not code_of(desk.say(Say(text="again")))  # it was not over
    desk.time_s += FORGET_S + 1
    assert code_of(desk.say(Say(text="again"))) == "nothing_to_refer_to"


def test_without_context_a_text_is_read_by_itself(desk):
    desk.say(Say(text="nod"))
    alone = desk.say(Say(text="again", context=False))
    assert alone.request.text == "again" and not alone.refers_to


def test_a_gesture_is_referred_to_by_its_words_and_a_story_is_not(desk):
    desk.say(Gesture(name="wave_left", tempo=0.8))
    again = desk.say(Say(text="with the other hand"))
    assert again.request.text == "exactly: wave with your right hand" and again.request.tempo == 0.8
    desk.say(Story(scenes=[SceneOf(text="nod")]))
    refused = desk.say(Say(text="again"))
    assert code_of(refused) == "nothing_to_refer_to" and "story" in refused.events[-1].found and refused.events[-1].do


def test_the_same_id_is_the_same_command_whatever_it_has_come_to_mean(desk):
    desk.say(Say(text="nod"))
    desk.say(Say(id="a", text="again"))
    assert desk.ledger.open(Say(id="a", text="again"), ROUTE, 0) is None
    with pytest.raises(WireError, match="stands for 'again'"):
        desk.ledger.open(Say(id="a", text="exactly: nod"), ROUTE, 0)


def test_a_command_that_would_become_too_long_is_refused(desk):
    desk.say(Say(text="wave " * 399))
    assert code_of(desk.say(Say(text="slower"))) == "nothing_to_refer_to"


def test_only_so_many_clients_are_remembered(desk, monkeypatch):
    monkeypatch.setattr(conversations, "KEPT", 3)
    for i in range(5):
        desk.say(Say(text="nod"), (b"%d" % i, ""))
    assert code_of(desk.say(Say(text="again"), (b"0", ""))) and not code_of(desk.say(Say(text="again"), (b"4", "")))


SAID = st.tuples(
    st.sampled_from([ANNA, BERT, (b"anna", "10.0.0.9")]), st.sampled_from(["nod", "clap", "bow", "again", "slower"])
)


@given(st.lists(SAID, max_size=12))
def test_nobody_refers_to_what_another_has_said(said):
    desk, last = Desk(), dict[tuple[bytes, str], str]()
    for client, text in said:
        entry = desk.say(Say(text=text), client)
        if text in ("again", "slower") and client not in last:
            assert code_of(entry) == "nothing_to_refer_to"
        elif text in ("again", "slower"):
            assert entry.request.text.split()[1] == last[client] and entry.refers_to
        else:
            assert entry.request.text == text and not entry.refers_to
            last[client] = text


@pytest.mark.parametrize(
    ("text", "becomes"),
    [
        ("keep waving", ("wave", True, False)), ("wave until I say stop", ("wave", True, False)),
        ("keep your arms up", ("keep your arms up", False, True)), ("wave", ("wave", False, False)),
    ],
)  # fmt: skip
def test_a_text_may_ask_for_no_end(desk, text, becomes):
    """A wave until somebody says stop was two waves."""
    said = desk.say(Say(id="a", text=text)).request
    assert (said.text, said.loop, said.hold) == becomes


@pytest.mark.parametrize("option", [{"repeat": 2}, {"loop": True}, {"hold": True}, {"context": False}], ids=str)
def test_options_say_how_often_before_the_text_does(desk, option):
    asked = Say(id="a", text="keep waving", **option)
    assert desk.say(asked).request == asked


def test_what_follows_a_motion_without_end_goes_on_as_well(desk):
    desk.say(Say(id="a", text="keep waving"), ends="")
    slower = desk.say(Say(id="b", text="slower")).request
    assert slower.loop and slower.text == "exactly: wave (0.65 times as fast)"
    assert not desk.say(Say(id="c", text="clap")).request.loop


def test_a_text_may_say_when_to_begin(desk):
    """Clapping in ten seconds was clapping at once, and faster."""
    said = desk.say(Say(id="a", text="in ten seconds, keep clapping")).request
    assert (said.text, said.when, said.at_s, said.loop) == ("clap", "at", desk.time_s + 10, True)
    timed = Say(id="b", text="in ten seconds, clap", when="after")
    assert desk.say(timed).request == timed
