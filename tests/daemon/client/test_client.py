"""The client against endpoints that do not answer, answer nonsense, or answer late: named errors, never a hang."""

from __future__ import annotations

import asyncio
import contextlib
import threading
import time

import msgspec
import pytest
import zmq

from daemon.cli.client.control import _tell
from daemon.cli.connection import Connection as ShellConnection
from daemon.client import AsyncClient, Client, NoAnswerError, RefusedError
from daemon.client.errors import ConnectionLostError, NobodyListensError
from daemon.errors import ConfigError
from daemon.settings.config import Endpoints
from daemon.settings.sources import config_of, resolve
from daemon.wire import codec as wire
from daemon.wire import events, requests
from tests.daemon.state.test_health import STATE


class Peer:
    """A ROUTER that answers each request with what `answer` gives, if anything."""

    def __init__(self, endpoint, answer):
        self._context = zmq.Context()
        self._socket = self._context.socket(zmq.ROUTER)
        self._socket.bind(endpoint)
        self._stopping = threading.Event()
        self._answer = answer
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def _run(self):
        while not self._stopping.is_set():
            if self._socket.poll(20):
                who, frame = self._socket.recv_multipart()
                for reply in self._answer(frame):
                    self._socket.send_multipart([who, reply])

    def close(self):
        self._stopping.set()
        self._thread.join(5)
        self._context.destroy(linger=0)


@pytest.fixture
def endpoints(tmp_path):
    return Endpoints(*(f"ipc://{tmp_path}/{name}" for name in ("cmd", "ctl", "pub")))


@contextlib.contextmanager
def talking(endpoint, answer):
    peer = Peer(endpoint, answer)
    try:
        yield
    finally:
        peer.close()


def test_nobody_there_is_said_at_once(endpoints):
    began_s = time.monotonic()
    with Client(endpoints) as client, pytest.raises(NoAnswerError, match="mmmd run") as caught:
        client.stop()
    assert time.monotonic() - began_s < 1 and isinstance(caught.value, TimeoutError)


def test_a_silent_peer_is_a_time_out(endpoints):
    with talking(endpoints.ctl, lambda _frame: []), Client(endpoints, timeout_s=0.2) as client:
        began_s = time.monotonic()
        with pytest.raises(NoAnswerError):
            client.status()
        assert 0.15 < time.monotonic() - began_s < 2


def test_a_peer_that_is_no_daemon_is_named(endpoints):
    with talking(endpoints.ctl, lambda _frame: [b"HTTP/1.1 400 Bad Request"]), Client(endpoints) as client:
        with pytest.raises(wire.WireError, match="mmmd's port"):
            client.status()


def test_answers_to_older_requests_are_passed_over(endpoints):
    def answer(frame):
        request = wire.decode_ctl(frame)
        return [wire.encode(events.Ack(id=i, verb="stop", state="idle")) for i in ("older", request.id)]

    with talking(endpoints.ctl, answer), Client(endpoints) as client:
        assert client.stop(wait=False).id != "older"


def test_a_refusal_is_an_error_with_its_event(endpoints):
    def answer(frame):
        return [wire.encode(events.Rejected(id=wire.decode_ctl(frame).id, code="wrong_state", asked="arm", found="in estop",
                                          allowed="reset", do="reset first"))]  # fmt: skip

    with talking(endpoints.ctl, answer), Client(endpoints) as client:
        with pytest.raises(RefusedError, match="reset first") as caught:
            client.arm()
    assert caught.value.code == "wrong_state"


@pytest.mark.parametrize(
    "states",
    [
        ["limp", "limp", "arming", "arming", "idle"],
        ["limp", "arming", "limp"],  # a stop, or a front that was held up, broke it off
        ["limp", "moving"],  # it was over between two looks
        ["arming", "fault"],
    ],
)
def test_arming_is_waited_for_to_its_end_whatever_that_is(endpoints, states):
    left = list(states)

    def answer(frame):
        request = wire.decode_ctl(frame)
        if isinstance(request, requests.Arm):
            return [wire.encode(events.Ack(id=request.id, verb="arm", state="limp"))]
        return [wire.encode(msgspec.structs.replace(STATE, id=request.id, state=left.pop(0)))]

    async def arm():
        async with AsyncClient(endpoints) as robot:
            await robot.arm(timeout_s=5)

    with talking(endpoints.ctl, answer):
        with Client(endpoints) as robot:
            robot.arm(timeout_s=5)
        assert not left
        left += states
        asyncio.run(arm())
        assert not left


@pytest.mark.parametrize(("state", "status"), [("idle", 0), ("limp", 1), ("fault", 3)])
def test_the_command_says_by_its_exit_status_whether_the_robot_is_armed(endpoints, capsys, state, status):
    def answer(frame):
        return [wire.encode(msgspec.structs.replace(STATE, id=wire.decode_ctl(frame).id, state=state))]

    with talking(endpoints.ctl, answer), Client(endpoints) as robot:
        assert _tell(robot, events.Ack(verb="arm", state="limp"), json=False) == status
    assert ("broken off" in capsys.readouterr().out) == (state == "limp")


def test_watching_a_silent_publisher_is_a_time_out(endpoints):
    with Client(endpoints) as client, pytest.raises(NoAnswerError):
        next(client.watch(timeout_s=0.1))


@pytest.mark.parametrize(
    "cmd", ["tcp://0.0.0.0:1", "tcp://*:1", "tcp://10.1.1.1:5", "udp://x", "tcp://localhost", "", "ipc://"]
)
def test_endpoints_that_others_could_reach_or_that_are_none(cmd):
    with pytest.raises(ConfigError, match="allowed"):
        Endpoints(cmd=cmd)


@pytest.mark.parametrize(
    "cmd", ["tcp://127.0.0.1:1", "tcp://localhost:1", "tcp://[::1]:1", "tcp://127.5.5.5:1", "ipc:///tmp/x"]
)
def test_local_endpoints(cmd):
    assert Endpoints(cmd=cmd).cmd == cmd


@pytest.mark.parametrize(
    "address",
    ["0.0.0.0:9109", "10.1.1.1:9109", "robot:9109", "[::]:9109", ":9109", "9109", "127.0.0.1:x", "[::1]:70000"],
)
def test_metrics_that_others_could_read_or_that_are_no_address(address):
    with pytest.raises(ConfigError, match="loopback"):
        config_of(resolve({"metrics": address}, environment={}))


@pytest.mark.parametrize("address", ["127.0.0.1:9109", "localhost:9109", "[::1]:9109", ""])
def test_local_metrics(address):
    assert config_of(resolve({"metrics": address}, environment={})).metrics == address


def test_two_sockets_at_one_place():
    with pytest.raises(ConfigError, match="different"):
        Endpoints(cmd="tcp://127.0.0.1:5872")


@pytest.mark.parametrize(
    ("cmd", "stream"),
    [
        ("tcp://127.0.0.1:5871", "tcp://127.0.0.1:5875"),
        ("tcp://127.0.0.1:5868", "tcp://127.0.0.1:5874"),  # 5872 and 5873 are ctl's and pub's
        ("tcp://127.0.0.1:65535", "tcp://127.0.0.1:65531"),
        ("ipc:///run/mmmd/cmd", "ipc:///run/mmmd/cmd.stream"),
    ],
)
def test_daemon_and_client_find_the_stream_beside_cmd(cmd, stream):
    assert Endpoints(cmd=cmd).stream == stream


@pytest.mark.parametrize(
    "stream", ["tcp://0.0.0.0:5875", "tcp://127.0.0.1", "udp://127.0.0.1:5", "tcp://127.0.0.1:5872"]
)
def test_a_stream_that_machines_could_reach_or_that_is_taken_is_refused(stream):
    with pytest.raises(ConfigError, match="stream"):
        Endpoints(stream=stream)


def test_settings_of_leases_have_ranges_and_sources():
    found = resolve({"cmd": "ipc:///tmp/x", "lease_s": 0.5}, environment={"MMMD_LEASE_PARK_S": "9"})
    assert (found["stream"].value, found["stream"].source) == ("ipc:///tmp/x.stream", "beside cmd")
    config = config_of(found)
    assert (config.lease_s, config.lease_park_s, config.endpoints.stream) == (0.5, 9.0, "ipc:///tmp/x.stream")
    for key, value in (("lease_s", 3.0), ("lease_park_s", 0.1), ("lease_limp_s", -1.0), ("stream_queue_s", 1.0)):
        with pytest.raises(ConfigError, match=key):
            config_of(resolve({key: value}, environment={}))


def takes_it(frame: bytes) -> list[bytes]:
    """The answer of a daemon that takes a text and then says nothing more."""
    return [wire.encode(events.Progress(id=msgspec.json.decode(frame)["id"], plan_id=1, stage="arming"))]


@pytest.mark.parametrize("loop", [False, True])
def test_a_daemon_that_ends_ends_the_wait_for_a_motion(endpoints, loop):
    """The client waited a minute for an answer that could not come, and for ever with `loop`."""
    with contextlib.ExitStack() as stack:
        peer = Peer(endpoints.cmd, takes_it)
        client = stack.enter_context(Client(endpoints))
        events_of = client.events_of(requests.Say(id="a", text="wave", loop=loop))
        assert isinstance(next(events_of), events.Progress)
        peer.close()
        began_s = time.monotonic()
        with pytest.raises(ConnectionLostError, match="the daemon ended"):
            next(events_of)
        assert time.monotonic() - began_s < 10


def test_a_daemon_that_ends_ends_the_wait_of_the_asyncio_client(endpoints):
    async def wait() -> None:
        peer = Peer(endpoints.cmd, takes_it)
        async with AsyncClient(endpoints) as client:
            heard = client.events_of(requests.Say(id="a", text="wave", loop=True))
            assert isinstance(await anext(heard), events.Progress)
            await asyncio.to_thread(peer.close)
            with pytest.raises(ConnectionLostError, match="the daemon ended"):
                await anext(heard)
            await heard.aclose()

    asyncio.run(asyncio.wait_for(wait(), 20))


def test_a_client_finds_the_daemon_that_the_environment_names(monkeypatch: pytest.MonkeyPatch) -> None:
    """`mmmd run` heeded `MMMD_CMD` and its like, and the clients did not."""
    named = {key: f"ipc:///tmp/mmmd-nobody/{key}" for key in ("cmd", "ctl", "pub")}
    for key, endpoint in named.items():
        monkeypatch.setenv(f"MMMD_{key.upper()}", endpoint)
    with Client() as robot:
        assert robot.endpoints == Endpoints(**named)
        with pytest.raises(NobodyListensError, match="nothing listens at ipc:///tmp/mmmd-nobody/ctl"):
            robot.status()
    shell = ShellConnection()
    assert (shell.cmd, shell.ctl, shell.pub) == tuple(named.values())
    assert shell.endpoints == Endpoints(**named)
