"""Frames of the `stream` socket: what is a target, and the name of everything else."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daemon.front.target_parsing import NAMED_EVERY_S, TargetParser
from daemon.wire.codec import WireError
from tests.support.robots import packaged

ROBOT = packaged("reference")
SECRET = "of-the-holder-alone"
N, NAMES = ROBOT.n_joints, ROBOT.joint_names


def target(**fields) -> bytes:
    return json.dumps({"type": "target", "id": "L", "secret": SECRET, **fields}).encode()


def read(frame: bytes, inbox: TargetParser | None = None) -> np.ndarray:
    return (inbox or TargetParser(ROBOT)).read([frame], "L", "stream of me", SECRET)


def test_all_joints_in_order_or_some_by_name():
    assert read(target(q_rad=list(range(N)))).tolist() == list(range(N))
    some = read(target(q_rad={NAMES[2]: 0.5, NAMES[0]: -1}, seq=3, t_mono=1.5))
    assert some[2] == 0.5 and some[0] == -1 and np.isnan(some).sum() == N - 2


@pytest.mark.parametrize(
    ("frame", "code"),
    [
        (target(q_rad=[0.0] * (N - 1)), "wrong_number"),
        (target(q_rad=[0.0] * (N + 1)), "wrong_number"),
        (target(q_rad=[0.0] * 300), "bad_value"),
        (target(q_rad=[]), "bad_value"),
        (target(q_rad={}), "unknown_joint"),
        (target(q_rad={"tail": 0.1}), "unknown_joint"),
        (target(q_rad={NAMES[0]: 2000.0}), "not_finite"),
        (target(q_rad=[1e300] * N), "not_finite"),
        (target(q_rad=["0"] * N), "bad_value"),
        (target(q_rad=[None] * N), "bad_value"),
        (target(q_rad=0.5), "bad_value"),
        (target(), "bad_value"),
        (target(q_rad=[0.0] * N, speed=9), "unknown_field"),
        (target(q_rad=[0.0] * N, v=2), "version"),
        (target(q_rad=[0.0] * N).replace(b'"L"', b'"other"'), "no_lease"),
        (target(q_rad=[0.0] * N, secret="another-secret-1"), "wrong_secret"),
        (target(q_rad=[0.0] * N, secret="L"), "bad_value"),
        (target(q_rad=[0.0] * N, secret=""), "bad_value"),
        (json.dumps({"type": "target", "id": "L", "q_rad": [0.0] * N}).encode(), "bad_value"),
        (b'{"type": "target", "q_rad": [0]}', "bad_value"),
        (b'{"type": "say", "id": "L", "text": "wave"}', "unknown_type"),
        (b'{"type": "target", "id": "L", "q_rad": [NaN]}', "bad_json"),
        (b'{"type": "target", "id": "L", "q_rad": [1e999]}', "bad_json"),
        (b"wave", "bad_json"),
        (b"", "bad_json"),
        (b"\xff\x00", "not_utf8"),
        (b"a" * 100_000, "too_large"),
    ],
)
def test_what_is_wrong_has_a_name_and_is_counted(frame, code):
    inbox = TargetParser(ROBOT)
    with pytest.raises(WireError) as caught:
        read(frame, inbox)
    assert caught.value.code == code and inbox.bad == {code: 1}
    assert caught.value.found and caught.value.allowed and caught.value.do


def test_a_stranger_is_told_who_holds_the_lease_or_that_nobody_does():
    inbox = TargetParser(ROBOT)
    with pytest.raises(WireError, match="stream of me holds lease 'L'"):
        inbox.read([target(q_rad=[0.0] * N).replace(b'"L"', b'"X"')], "L", "stream of me", SECRET)
    with pytest.raises(WireError, match="nobody holds a lease"):
        inbox.read([target(q_rad=[0.0] * N)], "", "", "")


def test_a_flood_of_bad_messages_is_named_once_a_second_with_its_number():
    inbox, told = TargetParser(ROBOT), []
    for k in range(3000):
        with pytest.raises(WireError):
            read(b"{", inbox)
        if n := inbox.due("bad_json", k * 1e-3):
            told.append(n)
    assert len(told) == round(3 / NAMED_EVERY_S) and told[0] == 1 and sum(told) == 1 + 2 * 1000


@given(
    st.binary(max_size=200) | st.builds(lambda q: target(q_rad=q), st.lists(st.floats(allow_nan=False), max_size=20))
)
def test_any_bytes_are_finite_angles_or_one_named_error(frame):
    try:
        q_rad = read(frame)
    except WireError as error:
        assert error.code
    else:
        assert q_rad.shape == (N,) and np.isfinite(q_rad[~np.isnan(q_rad)]).all() and not np.isnan(q_rad).all()
