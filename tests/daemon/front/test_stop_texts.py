"""A client that asks too much is refused, but never when its text means to stop."""

from __future__ import annotations

import pytest

from daemon.front.stop_texts import stops


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
