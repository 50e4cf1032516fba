"""Every command ends once; a REQ peer hears once; the same id is the same command."""

from __future__ import annotations

import pytest

from daemon.state.ledger import KEPT, KEPT_SCENES, Ledger, Route, split_route
from daemon.wire.codec import WireError
from daemon.wire.events import Accepted, Cancelled, Done, Progress
from daemon.wire.requests import Say, SceneOf, Story

DEALER, REQ = Route((b"d",), once=False), Route((b"r", b""), once=True)


@pytest.fixture
def heard():
    return []


@pytest.fixture
def ledger(heard):
    return Ledger(lambda route, event: heard.append((route, event)), lambda _event: None)


def accepted(plan_id=1):
    return Accepted(plan_id=plan_id, text="", status="accepted", understood="", reason="", scope_score=1, duration_s=1,
                    generate_ms=1)  # fmt: skip


def done():
    zeros = dict.fromkeys(("first_motion_ms", "duration_s", "peak_speed_share", "peak_speed_rad_s", "peak_speed_limit_rad_s",
                           "direction_error_deg"), 0.0)  # fmt: skip
    counts = dict.fromkeys(("frames", "clipped_frames", "gate_clipped_frames", "underruns"), 0)
    return Done(plan_id=1, peak_speed_joint="", **zeros, **counts)


def test_frames_of_dealer_and_req():
    assert split_route([b"d", b"text"]) == (DEALER, [b"text"])
    assert split_route([b"r", b"", b"text"]) == (REQ, [b"text"])
    assert split_route([b"d", b""]) == (DEALER, [b""])  # an empty text is a text


def test_nothing_follows_the_end(ledger, heard):
    entry = ledger.open(Say(text="wave"), DEALER, 0)
    for event in (accepted(), Cancelled(plan_id=1, by="stop"), done(), Cancelled(plan_id=1, by="again")):
        ledger.emit(entry, event)
    assert [type(e).__name__ for _, e in heard] == ["Accepted", "Cancelled"]
    assert all(e.id == entry.id for _, e in heard)
    assert heard[0][1].seq < heard[1][1].seq


def test_a_req_peer_hears_the_first_event_only(ledger, heard):
    entry = ledger.open(Say(text="wave"), REQ, 0)
    ledger.emit(entry, accepted())
    ledger.emit(entry, done())
    assert [type(e).__name__ for _, e in heard] == ["Accepted"]


def test_the_same_id_is_one_command_and_hears_what_it_missed(ledger, heard):
    entry = ledger.open(Say(id="a", text="wave"), DEALER, 0)
    ledger.emit(entry, accepted())
    other = Route((b"other",), once=False)
    assert ledger.open(Say(id="a", text="wave"), other, 0) is None
    assert ledger.open(Say(id="a", text="wave"), REQ, 0) is None
    ledger.emit(entry, done())
    by_route = {r: [type(e).__name__ for route, e in heard if route == r] for r in (DEALER, other, REQ)}
    assert by_route == {DEALER: ["Accepted", "Done"], other: ["Accepted", "Done"], REQ: ["Accepted"]}


def test_the_same_id_from_the_same_peer_is_not_answered_twice(ledger, heard):
    entry = ledger.open(Say(id="a", text="wave"), DEALER, 0)
    assert ledger.open(Say(id="a", text="wave"), DEALER, 0) is None
    ledger.emit(entry, accepted())
    assert len(heard) == 1


def test_the_same_id_for_another_text_is_an_error(ledger):
    ledger.open(Say(id="a", text="wave"), DEALER, 0)
    with pytest.raises(WireError, match="new id"):
        ledger.open(Say(id="a", text="bow"), DEALER, 0)


def test_one_that_does_not_end_keeps_no_others(ledger):
    """A lease for days, or a command with a time far away: everything that came after it was remembered."""
    lasting = ledger.open(Say(id="lasting", text="wave", when="at", at_s=1e9), DEALER, 0)
    for i in range(3000):
        ledger.emit(ledger.open(Say(id=str(i), text="wave"), DEALER, 0), done())
    assert len(ledger._entries) <= KEPT + 1 and len(ledger._ended) <= KEPT + 1
    assert ledger.open(lasting.request, DEALER, 0) is None  # still the same command
    assert ledger.open(Say(id="2999", text="wave"), DEALER, 0) is None
    assert ledger.open(Say(id="0", text="wave"), DEALER, 0) is not None  # forgotten


def test_memory_is_bounded(ledger):
    for i in range(3000):
        ledger.emit(ledger.open(Say(id=str(i), text="wave"), DEALER, 0), done())
    assert len(ledger._entries) <= 1025


def test_a_story_without_end_fills_no_memory(ledger, heard):
    """Every scene is told as it comes; who asks later hears the first word and the newest scenes."""
    entry = ledger.open(Story(id="s", scenes=[SceneOf(text="nod")], loop=True), DEALER, 0)
    ledger.emit(entry, accepted())
    for n in range(1000):
        ledger.emit(entry, Progress(plan_id=1, stage="scene", scene=1, text=f"nod {n}", status="accepted"))
    assert len(heard) == 1001 and len(entry.events) == 1 + KEPT_SCENES
    assert isinstance(entry.events[0], Accepted) and entry.events[-1].text == "nod 999"
