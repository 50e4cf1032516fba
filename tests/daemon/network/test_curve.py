"""A daemon behind CURVE: an allowed client does everything, a stranger learns nothing, keys come and go while it runs."""

from __future__ import annotations

import time

import pytest
import zmq
import zmq.utils.z85

from daemon.client import Client, NoAnswerError
from daemon.demo.main_job import free_endpoints
from daemon.network.keys import ZAP, Doorkeeper, KeyFolder
from daemon.settings.config import Endpoints
from tests.support.harness import RunningDaemon
from tests.support.keys import pair_of_folders
from tests.support.sizes import few_and_long

pytestmark = pytest.mark.realtime


@pytest.fixture(scope="module")
def secured(tmp_path_factory):
    """A daemon behind CURVE, and its client's keys."""
    folder = tmp_path_factory.mktemp("keys")
    robot, laptop = pair_of_folders(folder)
    ends = free_endpoints()
    daemon = RunningDaemon(
        "--keys", str(robot.path), "--cmd", ends.cmd, "--ctl", ends.ctl, "--pub", ends.pub, "--stream", ends.stream
    )  # fmt: skip
    daemon.endpoints = Endpoints(ends.cmd, ends.ctl, ends.pub, laptop.path, ends.stream)
    try:
        yield daemon.until_ready(), robot, laptop
        assert daemon.terminate() == 0
    finally:
        daemon.close()


def test_an_allowed_client_does_everything(secured):
    daemon, _, _ = secured
    with daemon.client() as client:
        assert client.say("wave", seconds=0.8).done
        assert next(client.watch("v1/state"))[0] == "v1/state"
        client.stop()
        with client.stream("allowed") as stream:
            for _ in range(20):
                stream.send(client.status().goal_rad)
                time.sleep(0.02)
            assert client.status().stream.lease.targets > 0


@pytest.mark.parametrize("who", few_and_long(["a key that is not allowed"], ["no key", "the wrong daemon's key"]))
def test_a_stranger_gets_nothing_on_any_socket(secured, tmp_path, who):
    daemon, robot, _ = secured
    stranger = KeyFolder(tmp_path / "stranger")
    stranger.new()
    stranger.trust("daemon", (zmq.curve_keypair()[0] if "wrong" in who else robot.own().public).decode())
    ends = daemon.endpoints
    context = zmq.Context()
    try:
        for endpoint, kind in (
            (ends.cmd, zmq.DEALER), (ends.ctl, zmq.DEALER), (ends.pub, zmq.SUB), (ends.stream, zmq.PUB)
        ):  # fmt: skip
            socket = context.socket(kind)
            if who != "no key":
                from daemon.network.keys import connect_curve

                connect_curve(socket, stranger, "daemon")
            monitor = socket.get_monitor_socket(zmq.EVENT_HANDSHAKE_FAILED_AUTH)
            socket.connect(endpoint)
            if kind == zmq.SUB:
                socket.subscribe(b"")
            else:
                socket.send(b'{"type": "status"}')
            assert not socket.poll(600)
            assert not monitor.poll(0), "the daemon said that the key was refused"
            socket.disable_monitor()
            monitor.close(0)
            socket.close(0)
    finally:
        context.destroy(linger=0)
    with daemon.client() as client:
        now = client.status()
        assert now.state in ("limp", "idle", "holding")
        assert now.stream.bad == {}, "a stranger's frame has come in at `stream`"


@pytest.mark.long
def test_a_key_can_be_allowed_and_taken_back_while_it_runs(secured, tmp_path):
    daemon, robot, _ = secured
    guest = KeyFolder(tmp_path / "guest")
    public = guest.new().public.decode()
    guest.trust("daemon", robot.own().public.decode())
    ends = Endpoints(daemon.endpoints.cmd, daemon.endpoints.ctl, daemon.endpoints.pub, guest.path)
    with Client(ends, timeout_s=0.5) as client, pytest.raises(NoAnswerError):
        client.status()
    robot.allow("guest", public)
    with Client(ends) as client:
        assert client.status().robot == "reference"
    (robot.path / "allowed" / "guest.pub").unlink()
    with Client(ends, timeout_s=0.5) as client, pytest.raises(NoAnswerError):
        client.status()


def test_an_unreadable_folder_keeps_clients_out_and_the_door_goes_on(tmp_path):
    class Damaged(KeyFolder):
        broken = True

        def allowed(self):
            if self.broken:
                raise RuntimeError("whatever may go wrong")
            return super().allowed()

    context = zmq.Context()
    folder = Damaged(tmp_path)
    client = folder.new().public
    folder.allow("client", client.decode())
    doorkeeper = Doorkeeper(context, folder)
    asker = context.socket(zmq.REQ)
    asker.setsockopt(zmq.RCVTIMEO, 10_000)
    asker.connect(ZAP)

    def status(*question: bytes) -> bytes:
        asker.send_multipart(question)
        return asker.recv_multipart()[2]

    asked = (b"1.0", b"1", b"mmmd", b"127.0.0.1", b"", b"CURVE", zmq.utils.z85.decode(client))
    try:
        assert status(*asked) == b"300"
        assert status(b"nonsense") == b"300"
        folder.broken = False
        assert status(*asked) == b"200"
    finally:
        doorkeeper.close()
        context.destroy(linger=0)
