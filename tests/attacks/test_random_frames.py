"""Random frames on every socket of a whole daemon, seeded: it goes on, the robot keeps its limits, and no stop is lost.

One round in the default suite; `make soak` runs the same for `SOAK_ROUNDS` rounds with other seeds.
"""

from __future__ import annotations

import json
import random
import time
from collections.abc import Callable

import pytest
import zmq

from daemon.client import Client
from daemon.wire.requests import CMD_TYPES, CTL_TYPES, STREAM_TYPES, tag_of
from tests.attacks.zmtp import RawPeer, connected, frame
from tests.support.harness import RunningDaemon, running_daemon
from tests.support.sizes import few_and_long

pytestmark = [pytest.mark.timeout(180), pytest.mark.realtime]
SOAK_ROUNDS = 400
FRAMES = 60
"""Frames of a round on each socket; below what the limit of requests drops."""
STARTS_NOTHING = ("arm", "torque", "reset", "estop", "park")
"""Verbs of `ctl` that a round does not send by themselves: it is to end in a state that this test can tell."""


def value(rng: random.Random, depth: int = 0) -> object:
    """Any JSON value, often an extreme one."""
    kinds: list[Callable[[], object]] = [
        lambda: rng.choice((None, True, False, 0, -1, 1, 2**63, -(2**70), 10**40, 1e308, -0.0, 0.5)),
        lambda: rng.choice(("", "wave", "stop sign", "\0", "ü" * 50, "x" * rng.choice((10, 3000)), "\ud7ff")),
        lambda: rng.uniform(-10, 10),
    ]
    if depth < 4:
        kinds += [
            lambda: [value(rng, depth + 1) for _ in range(rng.randrange(5))],
            lambda: {str(value(rng, 9))[:20]: value(rng, depth + 1) for _ in range(rng.randrange(5))},
        ]
    return rng.choice(kinds)()


def request(rng: random.Random, types: tuple[type, ...]) -> bytes:
    """A request of a known type, with fields that fit or do not; cut, flipped or nested deep at times."""
    kind = rng.choice([t for t in types if tag_of(t) not in STARTS_NOTHING])
    fields = {"type": tag_of(kind), "text": "wave", "name": "nod", "id": f"fuzz {rng.randrange(50)}"}
    fields = {key: fields[key] for key in fields if key == "type" or key in kind.__struct_fields__}
    for name in rng.sample(kind.__struct_fields__, min(3, len(kind.__struct_fields__))):
        fields[name] = value(rng)
    data = bytearray(json.dumps(fields).encode())
    how = rng.randrange(10)
    if how == 0:
        del data[rng.randrange(len(data)) :]
    elif how == 1:
        data[rng.randrange(len(data))] = rng.randrange(256)
    elif how == 2:
        data = bytearray(b'{"type": ' + b"[" * rng.choice((10, 991, 30_000)) + b"}")
    elif how == 3:
        data = bytearray(rng.randbytes(rng.choice((0, 1, 30, 3000))))
    return bytes(data)


def attack(daemon: RunningDaemon, rng: random.Random) -> None:
    """One round: random frames, parts, raw bytes and connections on every socket."""
    ends, context = daemon.endpoints, zmq.Context()
    peers = [
        (ends.cmd, context.socket(zmq.DEALER), CMD_TYPES), (ends.ctl, context.socket(zmq.DEALER), CTL_TYPES),
        (ends.stream, context.socket(zmq.PUB), STREAM_TYPES),
    ]  # fmt: skip
    try:
        for endpoint, socket, _ in peers:
            socket.connect(endpoint)
        for _ in range(FRAMES):
            for _, socket, types in peers:
                parts = [request(rng, types) for _ in range(rng.choice((1, 1, 1, 1, 2, 9)))]
                socket.send_multipart(parts, zmq.DONTWAIT)
        endpoint, kind = rng.choice(
            ((ends.cmd, "DEALER"), (ends.ctl, "REQ"), (ends.pub, "SUB"), (ends.stream, "PUB"), (ends.cmd, "SUB"))
        )
        try:
            with RawPeer(endpoint, kind) as peer:
                for _ in range(20):
                    body = rng.randbytes(rng.choice((0, 1, 70, 300)))
                    peer.send(frame(body, more=rng.random() < 0.5, command=rng.random() < 0.3))
                peer.send(rng.randbytes(500))
            with connected(endpoint) as nobody:
                nobody.sendall(rng.randbytes(rng.choice((1, 64, 5000))))
        except OSError:
            pass  # the daemon may close what is none of its protocol
        deadline_s = time.monotonic() + 0.2
        while time.monotonic() < deadline_s:
            for _, socket, _ in peers[:2]:
                while socket.poll(5):
                    json.loads(socket.recv_multipart()[-1])
    finally:
        context.destroy(linger=0)


def still_obeys(robot: Client) -> None:
    """Whatever came before: stop, e-stop, reset and arm do what they say."""
    assert robot.stop().verb == "stop"
    assert robot.estop().verb == "estop" and robot.wait_for("estop", timeout_s=10)
    assert robot.reset().verb == "reset" and robot.wait_for("limp", timeout_s=10)
    robot.arm()
    robot.wait_for("idle", "holding", timeout_s=20)


def fuzz(seed: int, rounds: int) -> None:
    rng = random.Random(seed)
    with running_daemon(tcp=True) as daemon, daemon.armed() as robot:
        for _ in range(rounds):
            robot.gesture("wave_right", loop=True, wait=False)
            attack(daemon, rng)
            still_obeys(robot)


@pytest.mark.parametrize("rounds", few_and_long([1], [2]))
def test_a_daemon_outlives_random_frames_and_obeys_after_each_round(rounds):
    fuzz(1, rounds)


@pytest.mark.soak
@pytest.mark.timeout(0)
@pytest.mark.parametrize("seed", [2, 3, 4])
def test_a_daemon_outlives_random_frames_for_long(seed):
    fuzz(seed, SOAK_ROUNDS)
