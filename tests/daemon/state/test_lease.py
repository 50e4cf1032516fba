"""A lease's life: every row of its table, and the clock that moves it."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daemon.state.lease import TRANSITIONS, LeaseClock, LeaseEvent, LeaseState

S, E = LeaseState, LeaseEvent
LIVE = (S.WAITING, S.STREAMING, S.SILENT)
ROWS = [
    *((s, E.TARGET, S.STREAMING) for s in LIVE),
    *((s, E.SILENCE, S.SILENT) for s in LIVE),
    *((s, E.LONG_SILENCE, S.OVER) for s in LIVE),
    *((s, E.RELEASE, S.RELEASED) for s in LIVE),
    *((S.RELEASED, e, S.RELEASED) for e in E),
    *((S.OVER, e, S.OVER) for e in E),
]


@pytest.mark.parametrize(("state", "event", "after"), ROWS, ids=lambda x: getattr(x, "value", str(x)))
def test_every_row_of_the_table(state, event, after):
    assert TRANSITIONS[state][event] is after


def test_the_rows_are_the_whole_table():
    assert len(ROWS) == sum(map(len, TRANSITIONS.values())) == len(S) * len(E)


def begun(at_s: float = 10.0) -> LeaseClock:
    clock = LeaseClock(silence_s=0.2, park_s=5.0)
    clock.begin(at_s)
    return clock


@pytest.mark.parametrize(
    ("target_s", "look_s", "state"),
    [
        (None, 10.19, S.WAITING), (None, 10.21, S.SILENT), (None, 14.9, S.SILENT), (None, 15.1, S.OVER),
        (11.0, 11.19, S.STREAMING), (11.0, 11.21, S.SILENT), (11.0, 15.9, S.SILENT), (11.0, 16.1, S.OVER),
        (15.1, 15.1, S.OVER),
    ],
)  # fmt: skip
def test_silence_in_time(target_s, look_s, state):
    clock = begun()
    if target_s is not None:
        clock.target(target_s)
    assert clock.look(look_s) is state


def test_before_it_has_begun_no_silence_counts():
    assert LeaseClock(0.2, 5.0).look(1e9) is S.WAITING


def test_a_silent_lease_resumes_with_the_next_target_but_not_an_ended_one():
    clock = begun()
    assert clock.look(13.0) is S.SILENT and clock.target(13.1) and clock.state is S.STREAMING
    assert not clock.target(18.2) and clock.state is S.OVER


def test_a_released_lease_takes_no_target_and_does_not_fall_silent():
    clock = begun()
    clock.release()
    assert not clock.target(10.1) and clock.look(1e9) is S.RELEASED


def test_parking_never_comes_before_holding():
    clock = LeaseClock(silence_s=2.0, park_s=0.5)
    clock.begin(0.0)
    assert clock.look(1.9) is S.WAITING and clock.look(2.1) is S.OVER


@given(st.lists(st.tuples(st.floats(0, 7), st.sampled_from(["target", "look", "release"])), max_size=30))
def test_it_ends_once_and_streams_only_after_a_fresh_target(steps):
    clock, now_s, last_s, ended = begun(0.0), 0.0, 0.0, False
    for wait_s, what in steps:
        now_s += wait_s
        if what == "target" and clock.target(now_s):
            last_s = now_s
        elif what == "release":
            clock.release()
        state = clock.look(now_s)
        assert not ended or state in (S.RELEASED, S.OVER)
        ended = ended or state in (S.RELEASED, S.OVER)
        if state is S.STREAMING:
            assert now_s - last_s < 0.2
