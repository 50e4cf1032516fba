"""Stops and commands that cross on their way: times are compared on one clock only, whoever sent them."""

from __future__ import annotations

import time

import pytest

from daemon.host.clock import clock_id
from daemon.scheduling.command_queue import CLOCKS_KEPT, SHADOW_S, StopOrdering
from daemon.state.ledger import Entry
from daemon.wire.requests import Say, Stop

pytestmark = pytest.mark.realtime

HERE, THERE, ELSEWHERE = "clock of this machine", "clock of another", "clock of a third"
LONG_AGO_S = 10 * SHADOW_S


def said(clock: str | None, t_mono: float | None, *, ago_s: float = 0.0) -> Entry:
    came_ns = time.monotonic_ns() - round(1e9 * ago_s)
    return Entry("a", Say(text="wave", clock=clock, t_mono=t_mono), came_ns, [])


def halted(clock: str | None, sent_s: float | None, *, ago_s: float = 0.0) -> StopOrdering:
    """Stopped by a request that was sent at `sent_s` of `clock` and came `ago_s` ago."""
    halts = StopOrdering(HERE)
    halts.note("stop", Stop(clock=clock, t_mono=sent_s))
    halts.served()
    halts.at_s -= ago_s
    return halts


@pytest.mark.parametrize("ago_s", [0.0, LONG_AGO_S])
def test_on_one_machine_the_clock_says_which_came_first(ago_s):
    halts = halted(HERE, None, ago_s=ago_s)
    before, after = said(HERE, halts.at_s - 1e-4), said(HERE, halts.at_s + 1e-6)
    assert halts.overtook(before) and not halts.spares(before)
    assert halts.spares(after) and not halts.overtook(after)
    assert halts.overtook(said(HERE, halts.at_s - 3600))  # however long it was on its way


@pytest.mark.parametrize("behind_s", [3.0, -3.0, 1e6], ids="{} s behind".format)
def test_the_clock_of_another_machine_is_not_compared_with_ours(behind_s):
    """A board and a PC started within seconds of each other: texts from the PC all ended `cancelled` for 3 s after a stop."""
    for clock in (THERE, None):
        long_after = said(clock, time.monotonic() - behind_s)
        assert not halted(HERE, None, ago_s=LONG_AGO_S).overtook(long_after)
        assert halted(HERE, None).overtook(long_after)  # just after: it was on its way
        assert not halted(HERE, None).spares(long_after)


def test_stops_and_texts_of_another_machine_are_ordered_by_its_own_clock():
    """A text whose packets were lost comes long after the stop that was given after it: it must not be played."""
    late, at_once = halted(THERE, 500.0, ago_s=LONG_AGO_S), halted(THERE, 500.0)
    assert late.overtook(said(THERE, 499.0)) and not late.spares(said(THERE, 499.0))
    assert at_once.spares(said(THERE, 500.1)) and not at_once.overtook(said(THERE, 500.1))
    assert at_once.overtook(said(ELSEWHERE, 500.1)) and not at_once.spares(said(ELSEWHERE, 500.1))


def test_a_later_stop_from_elsewhere_counts_for_all():
    halts = halted(THERE, 500.0)
    halts.note("stop", Stop(clock=HERE, t_mono=time.monotonic()))
    assert halts.overtook(said(THERE, 499.0))
    halts.served()
    assert halts.overtook(said(THERE, 500.1)) and not halts.spares(
        said(THERE, 500.1)
    )  # within the shadow of the second
    halts.at_s -= LONG_AGO_S
    assert not halts.overtook(said(THERE, 500.1))


def test_a_text_received_during_a_stop_is_older_unless_its_clock_denies():
    """Behind a flood of requests that takes longer than the moment after it."""
    halts = halted(HERE, None, ago_s=LONG_AGO_S)
    assert not halts.overtook(said(None, None))
    halts.note("stop", Stop(clock=HERE, t_mono=time.monotonic()))
    halts.at_s -= LONG_AGO_S
    assert halts.overtook(said(None, None)) and not halts.overtook(said(HERE, halts.at_s + 1e-3))
    halts.served()
    assert not halts.overtook(said(None, None))


def test_a_time_that_is_still_to_come_proves_nothing():
    halts = halted(HERE, None)
    assert halts.overtook(said(HERE, time.monotonic() + 3600)) and not halts.spares(said(HERE, time.monotonic() + 3600))


@pytest.mark.parametrize("ahead_s", [1e3, 1e9, 1e300])
def test_a_stop_stamped_far_ahead_cancels_nothing_that_comes_later(ahead_s):
    """One such frame, and every later text of that machine ended in `cancelled`, for as long as the daemon ran."""
    halts = halted(THERE, 500.0 + ahead_s, ago_s=LONG_AGO_S)
    for sent_s in (499.0, 500.1, 900.0):
        assert not halts.overtook(said(THERE, sent_s))
    halts.note("stop", Stop(clock=THERE, t_mono=501.0))  # the next honest one counts again
    halts.served()
    halts.at_s -= LONG_AGO_S
    assert halts.overtook(said(THERE, 500.9)) and not halts.overtook(said(THERE, 501.1))


def test_a_text_stamped_far_ahead_is_not_spared_by_a_later_stop():
    """A text that came before the stop and says that it was sent after it: by a moment it may have been, by an hour not."""
    halts = halted(THERE, 500.0)
    assert halts.spares(said(THERE, 500.5, ago_s=1.0))
    for ahead_s in (3600.0, 1e300):
        assert not halts.spares(said(THERE, 500.0 + ahead_s, ago_s=1.0))
    assert not halts.spares(said(THERE, 500.5, ago_s=60.0))


def test_of_two_stops_that_crossed_on_their_way_the_later_one_counts():
    halts = halted(THERE, 502.0, ago_s=LONG_AGO_S)
    halts.note("stop", Stop(clock=THERE, t_mono=501.0))
    halts.served()
    halts.at_s -= LONG_AGO_S
    assert halts.overtook(said(THERE, 501.5)) and halts.spares(said(THERE, 502.5))


def test_without_a_stop_nothing_is_overtaken():
    assert not any(StopOrdering(HERE).overtook(said(c, t)) for c in (HERE, THERE, None) for t in (None, -1e9, 0.0, 1e9))


def test_clocks_that_are_remembered_are_bounded():
    halts = StopOrdering(HERE)
    for i in range(10 * CLOCKS_KEPT):
        halts.note("stop", Stop(clock=f"c{i}", t_mono=1.0))
    assert len(halts._stamps) == CLOCKS_KEPT and halts.spares(said(f"c{10 * CLOCKS_KEPT - 1}", 2.0))


def test_a_clock_has_one_name_for_all_processes_of_a_start():
    assert clock_id() == clock_id() and len(clock_id()) == 16
