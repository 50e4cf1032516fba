"""A client that asks too much is refused, but never when its text means to stop."""

from __future__ import annotations

import json

import pytest

from daemon.front.stop_texts import stops, verb_refusal
from daemon.wire.requests import Say
from mmm_core.language.stop_words import _POWER_PHRASES, _STOP_PHRASES, _STOP_WORDS, means_stop
from tests.support.stop_words_page import listed


@pytest.mark.parametrize(
    ("frames", "stop"),
    [
        ([b"stop"], True),
        ([b"STOP MOVING"], True),
        ([b'{"type": "say", "text": "be still"}'], True),
        ([b'{"type": "story", "scenes": [{"text": "nod"}, {"text": "halt"}]}'], True),
        ([b"make a stop sign"], False),
        ([b'{"type": "cancel", "command": ""}'], False),
        ([b'{"type": "gesture", "name": "stop"}'], False),
        ([b"stop", b"stop"], False),
        ([b'{"type": "say", "text": "stop"'], False),
        ([b"wave"], False),
        ([b"stop" + b" " * 700], False),
        ([b"\xffstop"], False),
        ([b'{"text": ' + b"[" * 500], False),
        ([], False),
    ],
)
def test_which_requests_stop(frames: list[bytes], stop: bool) -> None:
    assert stops(frames) is stop


SAID = """
    hold it, STOOOP!, whoa, desist, fermati, stój, cut it out, stay put, no further, hoooold it
""".strip().split(", ")


@pytest.mark.parametrize("text", [*listed("These stop"), *SAID, *sorted(_STOP_WORDS), *_STOP_PHRASES, *_POWER_PHRASES])
def test_every_text_that_stops_does_so_above_the_rate(text: str) -> None:
    """Five of the page's own texts had none of the words that were looked for first."""
    if means_stop(text):  # some phrases only name what is to stop
        assert stops([text.encode()])
        assert stops([json.dumps({"type": "say", "text": text}).encode()])
    else:
        assert text in _STOP_PHRASES


@pytest.mark.parametrize(
    ("text", "do"),
    [("arm", "arm"), ("torque on please!", "arm"), ("park the robot", "park"), ("RESET", "reset")],
)  # fmt: skip
def test_a_verb_of_ctl_is_no_motion(text: str, do: str) -> None:
    """The text "arm" moved an arm."""
    refused = verb_refusal(Say(id="a", text=text))
    assert refused is not None and refused.do == f"`mmmd {do}`"


@pytest.mark.parametrize("text", ["raise your arm", "park your hands on your hips", "arm up", "turn left", "wave"])
def test_other_texts_are_motions(text: str) -> None:
    assert verb_refusal(Say(id="a", text=text)) is None
