"""Frames made to break a decoder: each is one named refusal, whose message stays short, on every socket."""

from __future__ import annotations

import numpy as np
import pytest

from daemon.front.target_parsing import TargetParser
from daemon.recording.mcap_reading import read_log
from daemon.recording.rotation import RotatingLog
from daemon.shared_memory.bus_link import BusRequest, cycle_dtype
from daemon.wire import codec as wire
from daemon.wire.events import Ack, ErrorEvent
from retarget.robot.loading import load_robot
from tests.daemon.ctl.test_control import Ctl

DEEP = 991
"""Levels that msgspec still reads and whose repr() exceeds Python's recursion limit."""
MOST_ERROR_BYTES = 4096


def nested(depth: int, kind: str = "dict") -> str:
    return '{"a":' * depth + "1" + "}" * depth if kind == "dict" else "[" * depth + "1" + "]" * depth


HOSTILE = {
    "type of nested objects": f'{{"type": {nested(DEEP)}}}',
    "type of nested lists": f'{{"type": {nested(DEEP, "list")}}}',
    "version of nested objects": f'{{"type": "estop", "v": {nested(DEEP)}}}',
    "id of nested objects": f'{{"type": "estop", "id": {nested(DEEP)}}}',
    "unknown field of nested objects": f'{{"type": "estop", "x": {nested(DEEP)}}}',
    "target of nested lists": f'{{"type": "target", "id": "a", "q_rad": {nested(DEEP, "list")}}}',
    "deeper than msgspec reads": nested(20_000),
    "deeper lists than msgspec reads": nested(30_000, "list"),
    "version of 5,000 digits": f'{{"type": "estop", "v": {"9" * 5000}}}',
    "version of 60,000 digits": f'{{"type": "estop", "v": {"9" * 60_000}}}',
    "sequence of 5,000 digits": f'{{"type": "estop", "seq": {"9" * 5000}}}',
    "time of 5,000 digits": f'{{"type": "estop", "t_mono": {"9" * 5000}}}',
    "a number beyond every float": '{"type": "estop", "t_mono": 1e99999}',
    "type of 60,000 characters": f'{{"type": "{"x" * 60_000}"}}',
    "field of 60,000 characters": f'{{"type": "estop", "{"x" * 60_000}": 1}}',
    "8,000 fields": '{"type": "estop"' + "".join(f', "f{i}": 1' for i in range(4000)) + "}",
    "half of a surrogate pair as id": '{"type": "estop", "id": "\\ud800"}',
    "half of a surrogate pair as type": '{"type": "\\udfff"}',
    "half of a surrogate pair as field": '{"type": "estop", "\\ud800": 1}',
    "a zero byte": "\0",
    "a bare verb of 60,000 characters": "x" * 60_000,
    "a bare verb of control characters": "\x1b[2J\x07" * 5000,
}


@pytest.mark.parametrize("decode", [wire.decode_cmd, wire.decode_ctl, wire.decode_target])
@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_frame_is_refused_and_the_refusal_is_short(decode, name):
    """`{"type": {"a": {"a": ...}}}` nested 991 deep decoded; repr() of it for the message ended the thread that stops the robot."""
    try:
        request = decode(HOSTILE[name].encode())
    except wire.WireError as error:
        answer = wire.encode(wire.error_event(error))
        assert len(answer) < MOST_ERROR_BYTES
    else:  # plain text of `say`, or nothing wrong on this socket
        assert wire.encode(request)


@pytest.mark.parametrize("raised", [MemoryError, RecursionError, ValueError, UnicodeError, SystemError, KeyError])
def test_whatever_a_decoder_raises_is_a_refused_frame(raised, monkeypatch):
    """The border of the daemon is one function: what fails behind it is never the reader's problem."""

    def broken(*_: object, **__: object):
        raise raised("x" * 100_000)

    monkeypatch.setattr(wire, "_decode_json", broken)
    for decode in (wire.decode_cmd, wire.decode_ctl, wire.decode_target):
        with pytest.raises(wire.WireError) as caught:
            decode(b'{"type": "estop"}')
        assert caught.value.code == "bad_json" and len(str(caught.value)) < MOST_ERROR_BYTES


def test_a_hostile_event_is_refused_by_the_client():
    for text in HOSTILE.values():
        with pytest.raises(wire.WireError) as caught:
            wire.decode_event(text.encode())
        assert len(str(caught.value)) < MOST_ERROR_BYTES


def test_no_hostile_frame_ends_the_reader_of_stream():
    inbox = TargetParser(load_robot("reference"))
    for text in HOSTILE.values():
        with pytest.raises(wire.WireError) as caught:
            inbox.read([text.encode()], "lease", "nobody", "a-secret-of-a-lease")
        assert len(str(caught.value)) < MOST_ERROR_BYTES
    assert sum(inbox.bad.values()) == len(HOSTILE)


@pytest.mark.timeout(30)
def test_no_hostile_frame_ends_what_takes_ctl():
    """After all of them an e-stop is still carried out and answered."""
    ctl = Ctl()
    try:
        ctl.ask(*(text.encode() for text in HOSTILE.values()))
        refused = ctl.turn(len(HOSTILE))
        assert all(isinstance(event, ErrorEvent) for event in refused) and len(refused) == len(HOSTILE)
        ctl.ask("estop")
        ctl.turn()
        assert ctl.bus_takes() == [BusRequest.ESTOP]
        ctl.front_answers()
        [answer] = ctl.turn(2)
        assert isinstance(answer, Ack) and answer.carried_out
    finally:
        ctl.close()


def test_no_hostile_frame_ends_the_recorder(tmp_path):
    """Frames of `stream` and `cmd` are recorded as they came, before anything reads them."""
    robot = load_robot("reference")
    with RotatingLog(tmp_path / "run.mcap", robot, 0.0, 0.0, "") as log:
        for text in HOSTILE.values():
            log.event("stream", text.encode())
        log.cycle(np.zeros(1, cycle_dtype(robot.n_joints, robot.n_servos))[0])
    assert read_log(tmp_path / "run.mcap").n_events == len(HOSTILE)
