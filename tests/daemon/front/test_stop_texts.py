"""A client that asks too much is refused, but never when its text means to stop."""

from __future__ import annotations

import json

import pytest

from daemon.front.stop_texts import stops
from mmm_core.language.stop_words import _STOP_PHRASES, _STOP_WORDS, means_stop
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


@pytest.mark.parametrize("text", [*listed("These stop"), *SAID, *sorted(_STOP_WORDS), *_STOP_PHRASES])
def test_every_text_that_stops_does_so_above_the_rate(text: str) -> None:
    """Five of the page's own texts had none of the words that were looked for first."""
    if means_stop(text):  # some phrases only name what is to stop
        assert stops([text.encode()])
        assert stops([json.dumps({"type": "say", "text": text}).encode()])
    else:
        assert text in _STOP_PHRASES
