"""Texts that say when to begin, and times that say something else."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.language.commands import Reading
from mmm_core.language.context import conversation
from mmm_core.language.delays import LONGEST_DELAY_S, delayed


@pytest.mark.parametrize(
    ("text", "rest", "seconds"),
    [
        ("In ten seconds, clap.", "clap", 10), ("raise your left arm after 5 seconds", "raise your left arm", 5),
        ("wait 5 seconds then wave", "wave", 5), ("in 3 secs raise your left arm", "raise your left arm", 3),
        ("please wait for two seconds, and then bow", "please bow", 2), ("in half a minute wave", "wave", 30),
        ("clap in 5 seconds from now", "clap", 5), ("in 2.5 seconds, clap and bow", "clap and bow", 2.5),
    ],
)  # fmt: skip
def test_a_text_may_begin_later(text: str, rest: str, seconds: float) -> None:
    assert delayed(text) == (rest, seconds)


@pytest.mark.parametrize(
    "text",
    [
        "wave every 3 seconds", "wave for 5 seconds", "raise your arm and lower it after 3 seconds", "draw a circle in 3 seconds",
        "bow, wait two seconds, come back up", "wave in one second intervals", "in 2 minutes, wave", "in the end, wave", "wave",
        "after ten seconds of silence, wave", "wave, then after 2 seconds bow", "exactly: wave", "in 0 seconds, wave",
    ],
)  # fmt: skip
def test_other_times_delay_nothing(text: str) -> None:
    assert delayed(text) is None


def test_a_conversation_notes_the_time() -> None:
    (found,) = conversation(["in five seconds, nod twice"])
    assert isinstance(found, Reading) and found.sentences == ("nod twice",) and found.notes == ("begins 5 s later",)


@given(st.text(st.sampled_from("in after wait 0123456789. seconds, minutes then wave "), max_size=50))
def test_any_text_is_judged(text: str) -> None:
    found = delayed(text)
    assert found is None or (found.text and 0 < found.delay_s <= LONGEST_DELAY_S)
