"""The generator's protocol, its process, and what the front makes of one that misbehaves."""

from __future__ import annotations

import asyncio
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import msgspec
import numpy as np
import pytest
import zmq
import zmq.asyncio
from hypothesis import given
from hypothesis import strategies as st

from daemon.generator import client as client_module
from daemon.generator import messages as generation
from daemon.generator.client import GeneratorClient
from daemon.generator.generated import Generated, GeneratorError, generated_from, generated_message
from daemon.generator.process import MOST_BEGUN, answers
from mmm_core.generate.continuation import continue_motion
from mmm_core.inference.checkpoint import MODEL_FILE
from tests.support.kinematic import KinematicGenerator, KinematicMaker, raised_arm
from tests.support.shipped import shipped_engine

pytestmark = pytest.mark.realtime

needs_model = pytest.mark.skipif(not MODEL_FILE.exists(), reason="no checkpoint in this checkout")


@pytest.fixture
def endpoint():
    with tempfile.TemporaryDirectory(prefix="mmmd-test-") as folder:
        yield f"ipc://{folder}/gen"


def ask(endpoint: str, call):
    """Run `call(client)` with a client of the generator at `endpoint`."""

    async def run():
        context = zmq.asyncio.Context()
        client = GeneratorClient(context, endpoint)
        client.mark_ready("k")
        try:
            return await call(client)
        finally:
            await client.close()
            context.destroy(linger=0)

    return asyncio.run(run())


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


def test_a_draft_comes_before_its_motion(endpoint):
    peer = KinematicGenerator(endpoint)

    async def call(client):
        first, whole = await client.draft("drafted wave", 0, 2.0, 5.0)
        assert client.busy and first.draft_of == 40 and len(first.motion.joints_m) == 20
        motion = (await whole).motion
        assert not client.busy and len(motion.joints_m) == 40
        alone, nothing = await client.draft("wave", 0, 2.0, 5.0)
        assert nothing is None and not alone.draft_of and not client.busy

    try:
        ask(endpoint, call)
    finally:
        peer.close()


def test_the_drafts_of_several_texts_come_before_their_motions(endpoint):
    peer = KinematicGenerator(endpoint)
    came = []

    async def one(client, text):
        first, whole = await client.draft(text, 0, 1.0, 20.0)
        came.append((first.motion.text, "draft"))
        came.append(((await whole).motion.text, "whole"))

    async def call(client):
        await client.draft("slow, so that the others wait together", 0, 1.0, 5.0)
        texts = [f"drafted {i}" for i in range(3)]
        await asyncio.gather(client.generate("slow", 0, 1.0, 5.0), *(one(client, text) for text in texts))
        return texts

    try:
        texts = ask(endpoint, call)
    finally:
        peer.close()
    assert came == [(text, "draft") for text in texts] + [(text, "whole") for text in texts]


def test_many_drafts_do_not_starve_the_motions(endpoint):
    """Of so many texts at once the first motions come before the last drafts."""
    peer = KinematicGenerator(endpoint)
    came = []

    async def one(client, i):
        _, whole = await client.draft(f"drafted {i}", 0, 1.0, 20.0)
        came.append(("draft", i))
        await whole
        came.append(("whole", i))

    async def call(client):
        await asyncio.gather(*(one(client, i) for i in range(MOST_BEGUN + 2)))

    try:
        ask(endpoint, call)
    finally:
        peer.close()
    # Draft 8 is sent with motion 0, half a second before draft 9: asyncio may wake their askers in any order.
    assert came.index(("whole", 0)) < came.index(("draft", MOST_BEGUN + 1))


@pytest.mark.parametrize(
    ("end", "code"),
    [
        (lambda client: None, "generator_error"),
        (lambda client: client.mark_down("ended with status 1"), "generator_down"),
        (lambda client: client.mark_starting(), "generator_down"),
    ],
)
def test_a_motion_that_never_follows_its_draft_is_a_named_failure(endpoint, end, code):
    peer = KinematicGenerator(endpoint)

    async def call(client):
        first, whole = await client.draft(
            "drafted wave, lost" if code == "generator_error" else "drafted wave", 0, 2.0, 5.0
        )
        end(client)
        with pytest.raises(GeneratorError) as caught:
            await whole
        assert first.draft_of and not client.busy
        return caught.value

    try:
        assert ask(endpoint, call).code == code
    finally:
        peer.close()


def test_a_draft_that_nobody_asked_for_is_no_motion():
    reply = generated_message(1, Generated(raised_arm(), "", "", {}, "", draft_of=20))
    with pytest.raises(GeneratorError, match="nobody asked for"):
        generated_from(reply)
    assert generated_from(reply, may_be_draft=True).draft_of == 20


def test_a_generator_that_is_silent_is_a_named_failure(endpoint):
    async def call(client):
        with pytest.raises(GeneratorError) as caught:
            await client.generate("wave", 0, None, 0.1)
        assert client.timeouts == 1 and not client.busy
        return caught.value

    assert ask(endpoint, call).code == "generator_timeout"


def test_a_restarted_generator_is_not_blamed_for_its_predecessor(endpoint):
    """It was killed right after its start: the supervisor restarts a generator that leaves a text unanswered."""

    async def call(client):
        asking = asyncio.create_task(client.generate("wave", 0, None, 0.2))
        await asyncio.sleep(0.05)
        client.mark_starting()
        client.mark_ready("k")
        with pytest.raises(GeneratorError):
            await asking
        return client.timeouts

    assert ask(endpoint, call) == 0


@pytest.mark.parametrize("lose", [lambda c: c.mark_down("ended with status -9"), lambda c: c.mark_starting()])
def test_an_open_request_fails_at_once_when_its_generator_ends(endpoint, lose):
    """It waited for its whole time-out, some seconds in which the robot stood still and nobody was told why."""

    async def call(client):
        asking = asyncio.create_task(client.generate("wave", 0, None, 60.0))
        async with asyncio.timeout(10.0):
            while not client.busy:
                await asyncio.sleep(0)
            lose(client)
            with pytest.raises(GeneratorError) as caught:
                await asking
        assert client.timeouts == 0 and not client.busy
        return caught.value

    assert ask(endpoint, call).code == "generator_down"


def test_a_silent_generator_elsewhere_may_still_answer_what_is_open(endpoint):
    peer = KinematicGenerator(endpoint)

    async def call(client):
        asking = asyncio.create_task(client.generate("wave", 0, None, 20.0))
        async with asyncio.timeout(10.0):
            while not client.busy:
                await asyncio.sleep(0)
        client.mark_down("no answer", ended=False)
        return await asking

    try:
        assert len(ask(endpoint, call).motion.joints_m)
    finally:
        peer.close()


def test_a_generator_that_is_down_fails_at_once(endpoint):
    async def call(client):
        client.mark_down("ended with status 1")
        with pytest.raises(GeneratorError, match="ended with status 1") as caught:
            await client.generate("wave", 0, None, 5.0)
        return caught.value

    assert ask(endpoint, call).code == "generator_down"


def test_a_text_that_comes_while_the_model_loads_is_told_to_come_again(endpoint, monkeypatch):
    """The refusal said that the generator is "starting" and named the daemon's output, where nothing is wrong."""
    monkeypatch.setattr(client_module, "START_TIMEOUT_S", 0.2)

    async def call(client):
        client.mark_starting()
        with pytest.raises(GeneratorError) as caught:
            await client.generate("wave", 0, None, 5.0)
        return caught.value

    error = ask(endpoint, call)
    assert error.code == "generator_down"
    assert "has been loading for 0 s" in error.found and error.do.startswith("send it again in some seconds")


def test_answers_reach_the_right_asker_in_any_order(endpoint):
    peer = KinematicGenerator(endpoint)

    async def call(client):
        return await asyncio.gather(
            *(client.generate(t, 0, None, 5.0) for t in ("wave", "slow left", "left", "wave 2"))
        )

    try:
        assert [g.motion.text for g in ask(endpoint, call)] == ["wave", "slow left", "left", "wave 2"]
    finally:
        peer.close()


@pytest.mark.long
def test_the_process_refuses_a_checkpoint_that_is_none(endpoint, tmp_path):
    """One message, no traceback."""
    broken = tmp_path / "model.safetensors"
    broken.write_bytes(b"no weights")
    result = subprocess.run(
        [sys.executable, "-m", "daemon.generator.process", "--bind", endpoint, "--model", str(broken)],
        capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert result.returncode == 1
    assert str(broken) in result.stderr and "Traceback" not in result.stderr


def test_the_front_holds_no_torch():
    code = "import sys, daemon.supervisor.supervisor, daemon.client.client, daemon.cli; print('torch' in sys.modules)"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    assert result.stdout.strip() == "False"


@needs_model
def test_the_process_serves_the_shipped_model_and_ends_with_its_parent(endpoint):
    process = subprocess.Popen(
        [sys.executable, "-m", "daemon.generator.process", "--bind", endpoint, "--parent-pid", str(os.getpid())],
        stderr=subprocess.DEVNULL,
    )
    try:
        motion = ask(endpoint, lambda client: client.generate("wave with your right hand", 7, 2.0, 60.0)).motion
        assert len(motion.joints_m) == 40 and motion.status == "accepted"

        def on(client, **how):
            return client.generate("raise both arms", 4, 2.0, 60.0, **how)

        alone = ask(endpoint, on).motion
        after = ask(endpoint, lambda client: on(client, before=motion, prefix_s=0.8)).motion
        other = ask(endpoint, lambda client: on(client, before=motion, prefix_s=0.2)).motion
        expected = continue_motion(shipped_engine(), motion, 0.8, "raise both arms", seed=4, seconds=2.0).motion
        np.testing.assert_allclose(after.joints_m, expected.joints_m, atol=1e-3)
        for different in (alone, other):
            assert np.abs(after.joints_m - different.joints_m).max() > 0.01
    finally:
        process.kill()
        process.wait(10)
    assert not Path(endpoint.removeprefix("ipc://")).is_dir()
