"""The generator's protocol: a motion survives the wire, and frames that hold none are named."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daemon.generator import messages as generation
from daemon.generator.generated import Generated, GeneratorError, generated_from, generated_message
from daemon.generator.process import answers
from tests.support.generator_client import ask
from tests.support.kinematic import KinematicGenerator, KinematicMaker, raised_arm


def test_a_motion_survives_the_wire_bit_for_bit():
    motion = raised_arm()
    sent = Generated(motion, "raise", "why", {"decode": 1.5}, "hash")
    message = generated_message(4, sent)
    received = generated_from(msgspec.msgpack.decode(generation.encode(message), type=generation.GeneratedMessage))
    for field in ("joints_m", "head_quat_wxyz", "forearm_twist_rad", "features", "tokens"):
        assert np.array_equal(getattr(received.motion, field), getattr(motion, field))
    assert (received.understood, received.reason, received.timings_ms) == ("raise", "why", {"decode": 1.5})


@pytest.mark.parametrize(
    ("change", "found"),
    [
        ({"joints_m": np.full((20, 22, 3), np.nan, "<f4").tobytes()}, "NaN"),
        ({"joints_m": b"123"}, "reshape|buffer"),
        ({"n_frames": 19}, "reshape"),
        ({"status": "wonderful"}, "wonderful"),
        ({"fps": 0.0}, "fps"),
    ],
)
def test_what_is_no_motion_is_a_named_failure(change, found):
    message = generated_message(1, Generated(raised_arm(), "", "", {}, ""))
    for key, value in change.items():
        setattr(message, key, value)
    with pytest.raises(GeneratorError, match=found) as caught:
        generated_from(message)
    assert caught.value.code == "bad_motion"


def test_one_frame_is_too_few(endpoint):
    peer = KinematicGenerator(endpoint)
    try:
        with pytest.raises(GeneratorError, match="1 frames"):
            ask(endpoint, lambda client: client.generate("short", 0, None, 5.0))
    finally:
        peer.close()


@given(st.binary(max_size=100))
def test_any_bytes_either_decode_or_are_refused(frame):
    try:
        generation.decode_request(frame)
    except (msgspec.MsgspecError, UnicodeDecodeError):
        pass


def test_an_error_of_the_model_is_answered():
    (reply,) = answers(generation.GenerateMessage(id=3, text="broken"), KinematicMaker(), "k")
    assert isinstance(reply, generation.FailureMessage) and reply.id == 3 and "broke" in reply.found
