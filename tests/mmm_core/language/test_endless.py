"""Texts that ask for a motion without end, and those that only sound like it."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.language.context import conversation
from mmm_core.language.endless import WithoutEnd, endless


@pytest.mark.parametrize(
    ("text", "rest"),
    [
        ("keep waving", "wave"), ("Please keep on waving!", "please wave"), ("keep nodding until I say so", "nod"),
        ("continue clapping", "clap"), ("don't stop waving", "wave"), ("wave until I tell you to stop", "wave"),
        ("wave non-stop", "wave"), ("clap your hands over and over again", "clap your hands"), ("wave, and don't stop", "wave"),
        ("nod and keep going until I stop you.", "nod"), ("wave forever", "wave"), ("wave until you are told otherwise", "wave"),
        ("keep turning the crank until further notice", "turn the crank"), ("wave continuously, please", "wave"),
        ("keep clapping while I walk in", "clap while i walk in"),
        ("keep twisting your middle from side to side", "twist your middle from side to side"),
        ("wave and nod until I say stop", "wave and nod"),
    ],
)  # fmt: skip
def test_strokes_go_round(text: str, rest: str) -> None:
    assert endless(text) == (rest, False)


@pytest.mark.parametrize(
    ("text", "rest"),
    [
        ("keep your arms up", "keep your arms up"), ("keep holding your arms out", "hold your arms out"),
        ("raise your right hand and hold it there", "raise your right hand"), ("lean back and stay there", "lean back"),
        ("hold your arm up until I say stop", "hold your arm up"), ("bow and hold it there", "bow"),
        ("salute and stay like that until I say so", "salute"), ("look left until you are told to stop", "look left"),
        ("put your hands on your hips, leave them like that", "put your hands on your hips"),
    ],
)  # fmt: skip
def test_poses_are_held(text: str, rest: str) -> None:
    assert endless(text) == (rest, True)


@pytest.mark.parametrize(
    "text",
    [
        "wave", "keep waving for ten seconds", "keep nodding three times", "keep waving, then bow", "don't wave forever", "stop",
        "wave until I count to five", "bow until your nose touches the floor", "wave until the bus is gone", "wave and hold it",
        "raise your hand", "keep your distance", "keep still", "look left and hold it for five seconds", "never stop",
        "move your hand in a loop", "roll your arms over and over", "wave, go on",
        "keep nodding while you drum", "keep your hands on your hips as you twist to the left", "keep nodding and waving",
        "exactly: keep waving", "", "wave until I say stop, then bow",
    ],
)  # fmt: skip
def test_other_texts_have_an_end(text: str) -> None:
    assert endless(text) is None


def test_a_conversation_has_texts_without_end_and_stops() -> None:
    """`mmmd understand` showed a stop sign for "stop", and one wave for "wave until I say stop"."""
    kept, slower, stopped, again = conversation(["wave until I say stop", "slower", "stop", "again"])
    assert isinstance(kept, WithoutEnd) and not kept.is_pose and kept.reading.sentences == ("wave",)
    assert kept.reading.text == "wave until I say stop" and not kept.reading.denied
    assert not isinstance(stopped, WithoutEnd) and getattr(stopped, "steps", None) == ()
    for found in (slower, again):
        assert getattr(found, "reading").sentences == ("wave (0.65 times as fast)",)  # noqa: B009


@given(st.text(st.sampled_from("keep waving until i say stop, hold it don't raise your arms "), max_size=60))
def test_any_text_is_judged(text: str) -> None:
    found = endless(text)
    assert found is None or found.text
