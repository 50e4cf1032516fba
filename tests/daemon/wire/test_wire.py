"""Frames to requests and back; every bad frame gives one error that says what was asked, found, allowed and to do."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daemon.playback.sources.source_factory import PREFIX_FRAMES
from daemon.wire import codec as wire
from daemon.wire import events, requests
from docs.tools.wire_schemas import schemas, text_of
from mmm_core.generate.continuation import LONGEST_PREFIX_TOKENS
from mmm_core.model.tokens import FRAMES_PER_TOKEN, MAX_TOKENS
from mmm_core.motion.motion import FPS

DOCS = Path(__file__).parents[3] / "docs" / "wire"

GOOD_CMD = [
    ("plain text", b"wave with your right hand", requests.Say(text="wave with your right hand")),
    ("plain text, spaces around", b"  nod twice \n", requests.Say(text="nod twice")),
    ("plain text, not ASCII", "grüße".encode(), requests.Say(text="grüße")),
    ("plain text that is JSON, but no object", b"42", requests.Say(text="42")),
    ("least JSON", b'{"type": "say", "text": "bow"}', requests.Say(text="bow")),
    (
        "all fields",
        b'{"v": 1, "id": "a", "seq": 3, "t_mono": 1.5, "type": "say", "text": "bow", "seed": 7, "seconds": 2}',
        requests.Say(v=1, id="a", seq=3, t_mono=1.5, text="bow", seed=7, seconds=2.0),
    ),
    (
        "story",
        b'{"type": "story", "scenes": [{"text": "wave"}, {"text": "bow", "seconds": 2}], "seed": 3, "loop": true}',
        requests.Story(
            scenes=[requests.SceneOf(text="wave"), requests.SceneOf(text="bow", seconds=2)], seed=3, loop=True
        ),
    ),
    (
        "inbetween",
        b'{"type": "inbetween", "poses": [{"at_s": 1, "gesture": "bow"}, {"at_s": 2.5, "standing": true}]}',
        requests.Inbetween(
            poses=[requests.KeyPoseOf(at_s=1, gesture="bow"), requests.KeyPoseOf(at_s=2.5, standing=True)]
        ),
    ),
    (
        "edit",
        b'{"type": "edit", "text": "wave", "plan": 3, "parts": ["upper"], "start_s": 1, "end_s": 2}',
        requests.Edit(text="wave", plan=3, parts=["upper"], start_s=1, end_s=2),
    ),
    ("replay", b'{"type": "replay", "file": "a.npz"}', requests.Replay(file="a.npz")),
    ("status", b'{"type":"status","id":"s"}', requests.Status(id="s")),
    ("cancel", b'{"type":"cancel","command":"a"}', requests.Cancel(command="a")),
]

BAD_CMD = [
    ("empty frame", b"", "empty_text", ["1 to 2000"]),
    ("only spaces", b" \n\t", "empty_text", ["1 to 2000"]),
    ("10,000 characters", b"a" * 10_000, "text_too_long", ["10000", "2000"]),
    ("too many bytes", b"a" * 70_000, "too_large", ["70000", "65536"]),
    ("not UTF-8", b"wave \xff\xfe", "not_utf8", ["0xff", "position 5"]),
    ("cut off JSON", b'{"type": "say", "text": "wa', "bad_json", ["JSON"]),
    ("a JSON list", b'["say", "wave"]', "bad_json", ["list"]),
    ("deep nesting", b"[" * 60_000, "bad_json", ["nested"]),
    ("no type", b'{"text": "wave"}', "unknown_type", ["no 'type'", "say"]),
    ("unknown type", b'{"type": "dance", "id": "x"}', "unknown_type", ["'dance'", "say, story", "cancel, status"]),
    ("type of another kind", b'{"type": 5}', "unknown_type", ["5"]),
    ("a ctl verb on cmd", b'{"type": "stop"}', "unknown_type", ["ctl socket"]),
    ("unknown field", b'{"type": "say", "text": "wave", "speed": 3}', "unknown_field", ["'speed'", "seconds"]),
    ("empty text", b'{"type": "say", "text": ""}', "empty_text", ["1 to 2000"]),
    ("long text", b'{"type": "say", "text": "' + b"a" * 10_000 + b'"}', "text_too_long", ["10000"]),
    ("no text", b'{"type": "say"}', "bad_value", ["text"]),
    ("text of another kind", b'{"type": "say", "text": 5}', "bad_value", ["found text 5;", "allowed: text of 1 to 2000"]),
    ("seed below 0", b'{"type": "say", "text": "wave", "seed": -1}', "bad_value", ["seed"]),
    ("seconds too many", b'{"type": "say", "text": "wave", "seconds": 100}', "bad_value", ["found seconds 100;", "0.2 to 9.8"]),
    ("a prefix too long", b'{"type": "say", "text": "wave", "prefix_s": 2}', "bad_value", ["prefix_s", "1.6"]),
    ("a prefix too short", b'{"type": "say", "text": "wave", "prefix_s": 0.1}', "bad_value", ["`prefix_s`", "0.2 to 1.6"]),
    ("a prefix of later", b'{"type": "say", "text": "wave", "prefix_s": 0.4, "when": "after"}', "bad_value", ["`when`", "now"]),
    ("seconds NaN", b'{"type": "say", "text": "wave", "seconds": NaN}', "bad_json", ["JSON"]),
    ("another version", b'{"v": 2, "type": "say", "text": "wave", "id": "x"}', "version", ["version 2", "version 1"]),
    ("a version that is text", b'{"v": "1.0", "type": "say", "text": "wave"}', "version", ["'1.0'", "version 1"]),
    ("a version that is true", b'{"v": true, "type": "say", "text": "wave"}', "version", ["True"]),
    ("a story of nothing", b'{"type": "story", "scenes": []}', "bad_value", ["found scenes an array of 0;", "1 to 1000"]),
    ("a story of 1001", b'{"type": "story", "scenes": [' + b'{"text": "a"},' * 1000 + b'{"text": "a"}]}', "bad_value", ["1000"]),
    ("a scene without words", b'{"type": "story", "scenes": [{"text": "a"}, {"text": " "}]}', "bad_value", ["scene 2"]),
    ("a scene too long", b'{"type": "story", "scenes": [{"text": "a", "seconds": 99}]}', "bad_value", ["9.8"]),
    ("a scene with more", b'{"type": "story", "scenes": [{"text": "a", "x": 1}]}', "bad_value", ["`x`"]),
    ("a story that holds", b'{"type": "story", "scenes": [{"text": "a"}], "hold": true}', "bad_value", ["`hold`"]),
    ("no pose", b'{"type": "inbetween", "poses": []}', "bad_value", ["poses"]),
    ("a pose of nothing", b'{"type": "inbetween", "poses": [{"at_s": 1}]}', "bad_value", ["pose 1", "`gesture`"]),
    ("a pose of two", b'{"type": "inbetween", "poses": [{"at_s": 1, "gesture": "a", "standing": true}]}', "bad_value", ["one of"]),
    ("poses too near", b'{"type": "inbetween", "poses": [{"at_s": 1, "gesture": "a"}, {"at_s": 1.1, "gesture": "b"}]}',
     "bad_value", ["pose 2", "0.2 s"]),
    ("poses out of order", b'{"type": "inbetween", "poses": [{"at_s": 2, "gesture": "a"}, {"at_s": 1, "gesture": "b"}]}',
     "bad_value", ["pose 2"]),
    ("poses that end at once", b'{"type": "inbetween", "poses": [{"at_s": 0, "gesture": "a"}]}', "bad_value", ["last pose"]),
    ("an edit of nothing", b'{"type": "edit", "text": "wave"}', "bad_value", ["`gesture`, `command`, `plan` and `file`"]),
    ("an edit of two", b'{"type": "edit", "text": "wave", "plan": 1, "gesture": "a"}', "bad_value", ["one of"]),
    ("an edit that ends first", b'{"type": "edit", "text": "a", "plan": 1, "start_s": 2, "end_s": 1}', "bad_value", ["`end_s` 1"]),
    ("an edit without words", b'{"type": "edit", "text": " ", "plan": 1}', "bad_value", ["`text`"]),
    ("a replay of nothing", b'{"type": "replay"}', "bad_value", ["`command`, `plan` and `file`"]),
    ("an id too long", b'{"type": "status", "id": "' + b"i" * 200 + b'"}', "bad_value", ["128"]),
]  # fmt: skip


@pytest.mark.parametrize(("frame", "request_"), [row[1:] for row in GOOD_CMD], ids=[row[0] for row in GOOD_CMD])
def test_good_frames(frame, request_):
    assert wire.decode_cmd(frame) == request_
    assert wire.decode_cmd(wire.encode(request_)) == request_


@pytest.mark.parametrize(("frame", "code", "says"), [row[1:] for row in BAD_CMD], ids=[row[0] for row in BAD_CMD])
def test_bad_frames_give_one_error_that_helps(frame, code, says):
    with pytest.raises(wire.WireError) as caught:
        wire.decode_cmd(frame)
    error = caught.value
    assert error.code == code
    assert all(part in str(error) for part in says), str(error)
    event = wire.error_event(error)
    assert event.asked and event.found and event.allowed and event.do
    assert wire.decode_event(wire.encode(event)) == event


def test_an_error_carries_the_id_of_its_request():
    with pytest.raises(wire.WireError) as caught:
        wire.decode_cmd(b'{"v": 2, "type": "say", "text": "wave", "id": "mine"}')
    assert wire.error_event(caught.value).id == "mine"


@pytest.mark.parametrize("kind", [k for k in requests.CTL_TYPES if k is not requests.Torque])
def test_ctl_takes_json_and_bare_verbs(kind):
    verb = kind.__struct_config__.tag
    assert wire.decode_ctl(verb.encode()) == kind()
    assert wire.decode_ctl(json.dumps({"type": verb, "id": "i"}).encode()) == kind(id="i")


def test_torque_has_to_say_which():
    assert wire.decode_ctl(b'{"type": "torque", "on": false, "id": "i"}') == requests.Torque(id="i", on=False)
    for frame in (b"torque", b'{"type": "torque"}', b'{"type": "torque", "on": 0}'):
        with pytest.raises(wire.WireError, match="torque") as caught:
            wire.decode_ctl(frame)
        assert caught.value.code == "bad_value"


@pytest.mark.parametrize("frame", [b"", b"wave", b'{"type": "say", "text": "wave"}', b'{"type": "stop", "now": true}'])
def test_ctl_refuses_everything_else(frame):
    with pytest.raises(wire.WireError):
        wire.decode_ctl(frame)


@given(st.binary(max_size=300))
def test_any_bytes_either_decode_or_raise_wire_error(frame):
    for decode in (wire.decode_cmd, wire.decode_ctl, wire.decode_event):
        try:
            decode(frame)
        except wire.WireError as error:
            assert error.do


FIELDS = st.sampled_from(["type", "v", "id", "text", "seed", "seconds", "x"])
VALUES = st.sampled_from(["say", "status", "cancel", "", "a", " ", None, True, 0, 1, 2, -1, 0.5, 1e300, 2**70, [], {}])


@given(st.dictionaries(FIELDS, VALUES))
def test_any_object_either_decodes_or_raises_wire_error(fields):
    try:
        request = wire.decode_cmd(json.dumps(fields).encode())
    except wire.WireError:
        return
    assert request.v == requests.PROTOCOL_VERSION


def test_an_event_of_a_later_minor_version_is_still_read():
    event = events.Cancelled(plan_id=3, by="stop", id="a")
    frame = wire.encode(event)[:-1] + b', "more": [1, 2]}'
    assert wire.decode_event(frame) == event


def test_published_schemas_are_those_of_the_code():
    """`python -m docs.tools.wire_schemas docs/wire` writes them."""
    expected = {name: text_of(schema) for name, schema in schemas().items()}
    found = {path.name: path.read_text("utf-8") for path in DOCS.glob("*.schema.json")}
    assert found == expected


def test_lengths_that_may_be_asked_for_are_those_the_model_has():
    """The wire states them itself: a client loads no model."""
    token_s = FRAMES_PER_TOKEN / FPS
    assert (requests.SHORTEST_S, requests.LONGEST_S) == pytest.approx((token_s, MAX_TOKENS * token_s))
    longest_s = LONGEST_PREFIX_TOKENS * token_s
    assert (requests.SHORTEST_PREFIX_S, requests.LONGEST_PREFIX_S) == pytest.approx((token_s, longest_s))
    assert PREFIX_FRAMES >= LONGEST_PREFIX_TOKENS * FRAMES_PER_TOKEN, (
        "the generator is shown all that it may go on from"
    )
