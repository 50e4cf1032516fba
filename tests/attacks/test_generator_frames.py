"""Frames on the generator's socket that are no requests: dropped, and the next request is answered. Killed, it starts again."""

from __future__ import annotations

import os
import signal
import subprocess
import threading
import time
from pathlib import Path

import msgspec
import pytest
import zmq

from daemon.generator import messages
from daemon.generator.process import serve
from tests.attacks.zmtp import RawPeer, frame
from tests.support.harness import MMMD, RunningDaemon
from tests.support.kinematic import KinematicMaker
from tests.support.sizes import few_and_long

pytestmark = [pytest.mark.timeout(180), pytest.mark.realtime]


def request(**fields) -> bytes:
    return msgspec.msgpack.encode({"type": "generate", "id": 1, "text": "wave", **fields})


HOSTILE = {
    "300 kB of arrays": b"\x91" * 300_000,
    "300 kB of objects": b"\x81\xa1a" * 100_000,
    "a field of deep arrays": request()[:1].replace(b"\x83", b"\x84") + request()[1:] + b"\xa1x" + b"\x91" * 200_000,
    "nothing": b"",
    "not UTF-8": b"\x81\xa4type\xa8\xff\xff\xff\xff\xff\xff\xff\xff",
    "an array of four thousand million": b"\xdd\xff\xff\xff\xff",
    "a text of 500 kB": request(text="x" * 500_000),
    "a million seconds": request(seconds=1e6),
    "no number of seconds": request(seconds=float("nan")),
    "an edit of a motion of a million frames": msgspec.msgpack.encode(
        {"type": "edit", "id": 1, "text": "wave", "motion": {
            "n_frames": 10**6, "joints_m": b"", "fps": 20.0, "head_quat_wxyz": b"", "forearm_twist_rad": b"", "features": b"",
            "tokens": b"", "text": "", "seed": 0, "status": "accepted", "scope_score": 1.0}}
    ),
    "a hundred thousand poses": msgspec.msgpack.encode({"type": "between", "id": 1, "poses": {}, "at_s": [0.0] * 50_000}),
}  # fmt: skip


def test_no_frame_ends_a_generator(tmp_path):
    """A 300 kB frame of nested arrays made the decoder raise RecursionError, which nobody caught."""
    context, over = zmq.Context(), threading.Event()
    socket = context.socket(zmq.ROUTER)
    socket.bind(f"ipc://{tmp_path}/generator")
    serving = threading.Thread(target=serve, args=(socket, KinematicMaker(), "hash", lambda: not over.is_set()))
    serving.start()
    peer = context.socket(zmq.DEALER)
    peer.setsockopt(zmq.RCVTIMEO, 20_000)
    peer.connect(f"ipc://{tmp_path}/generator")
    try:
        for name, data in HOSTILE.items():
            peer.send(data)
            peer.send_multipart([b"x", b"y", data])
            peer.send(messages.encode(messages.PingMessage(id=77)))
            while not isinstance(reply := messages.decode_reply(peer.recv_multipart()[-1]), messages.PongMessage):
                assert isinstance(reply, messages.FailureMessage | messages.GeneratedMessage), name
                assert not isinstance(reply, messages.FailureMessage) or len(reply.found) < 1000
            assert reply.id == 77 and serving.is_alive(), name
    finally:
        over.set()
        serving.join(10)
        context.destroy(linger=0)


@pytest.mark.parametrize("names", few_and_long([list(HOSTILE)[:2]], [list(HOSTILE)[2:]]), ids=["some", "others"])
def test_no_answer_ends_the_front(names):
    """The other way round: a generator on another machine that sends what is no answer."""
    daemon = RunningDaemon()
    context = zmq.Context()
    try:
        with daemon.until_ready().armed() as robot:
            assert daemon.peer is not None
            daemon.peer.close()
            liar = context.socket(zmq.ROUTER)
            liar.bind(f"ipc://{daemon.folder}/gen")
            end_s = time.monotonic() + 20
            for data in (HOSTILE[name] for name in names):
                while not liar.poll(100):
                    robot.status()
                    assert time.monotonic() < end_s + 20
                peer_id = liar.recv_multipart()[0]
                liar.send_multipart([peer_id, data])
            assert robot.status().state in ("idle", "holding")
        assert daemon.terminate() == 0 and "Traceback" not in daemon.said
    finally:
        context.destroy(linger=0)
        daemon.close()


def children_of(pid: int) -> list[int]:
    return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def wait_until_gone(pid: int) -> None:
    end_s = time.monotonic() + 20
    while Path(f"/proc/{pid}/cmdline").exists() and Path(f"/proc/{pid}/cmdline").read_bytes():
        assert time.monotonic() < end_s, "the generator outlives its keeper"
        time.sleep(0.05)


@pytest.mark.long
def test_a_killed_shared_generator_restarts_and_ends_with_its_keeper(tmp_path):
    """`mmmd generator` was one process: whatever ended it left every robot without texts."""
    endpoint = f"ipc://{tmp_path}/generator"
    keeper = subprocess.Popen([*MMMD, "generator", "--bind", endpoint], stderr=subprocess.DEVNULL)
    context = zmq.Context()

    def answers() -> bool:
        peer = context.socket(zmq.DEALER)
        peer.connect(endpoint)
        peer.send(messages.encode(messages.PingMessage(id=1)))
        answered = bool(peer.poll(60_000))
        peer.close(0)
        return answered

    try:
        assert answers()
        (first,) = children_of(keeper.pid)
        with RawPeer(endpoint, "DEALER") as peer:
            assert peer.send(frame(b"\x91" * 300_000))
        assert answers() and children_of(keeper.pid) == [first]
        os.kill(first, signal.SIGKILL)
        while children_of(keeper.pid) in ([], [first]):
            time.sleep(0.05)
        (second,) = children_of(keeper.pid)
        assert answers()
        keeper.kill()
        keeper.wait(10)
        wait_until_gone(second)
    finally:
        keeper.kill()
        keeper.wait(10)
        context.destroy(linger=0)


def test_a_shared_generator_that_is_terminated_ends_at_once(tmp_path):
    """On SIGTERM `mmmd generator` waited for its child, which waited for it to end."""
    keeper = subprocess.Popen([*MMMD, "generator", "--bind", f"ipc://{tmp_path}/generator"], stderr=subprocess.DEVNULL)
    try:
        while not (children := children_of(keeper.pid)):
            assert keeper.poll() is None
            time.sleep(0.05)
        keeper.terminate()
        keeper.wait(60)
        wait_until_gone(children[0])
    finally:
        keeper.kill()
        keeper.wait(10)
