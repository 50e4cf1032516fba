"""Keys: who is let in, that a stranger learns nothing, and a generator on the other side of a network."""

from __future__ import annotations

import contextlib
import io
import os
import shutil
import subprocess
import time

import pytest
import zmq
import zmq.utils.z85
from hypothesis import given
from hypothesis import strategies as st

from daemon.cli import main
from daemon.client import Client, NoAnswerError, RefusedError
from daemon.demo.main_job import free_endpoints
from daemon.errors import ConfigError
from daemon.front.rate_limits import BURST, PEER_BURST, PEER_RATE_HZ, RATE_HZ, Rates, RequestLimits
from daemon.generator.generated import Generated
from daemon.network.keys import ZAP, Doorkeeper, KeyFolder, as_hex, checked_key
from daemon.settings.config import Endpoints
from tests.support.harness import MMMD, RunningDaemon, mmmd
from tests.support.kinematic import KinematicGenerator, generate

pytestmark = pytest.mark.realtime


def pair_of_folders(tmp_path) -> tuple[KeyFolder, KeyFolder]:
    """A daemon's keys and a client's, who know each other."""
    robot, laptop = KeyFolder(tmp_path / "robot"), KeyFolder(tmp_path / "laptop")
    robot.allow("laptop", laptop.new().public.decode())
    laptop.trust("daemon", robot.new().public.decode())
    return robot, laptop


def test_a_key_is_made_once_and_is_ones_own(tmp_path):
    folder = KeyFolder(tmp_path / "keys")
    pair = folder.new()
    assert folder.own() == pair and len(pair.public) == len(pair.secret) == 40
    assert (tmp_path / "keys" / "own.key").stat().st_mode & 0o777 == 0o600
    with pytest.raises(ConfigError, match="already"):
        folder.new()
    os.chmod(tmp_path / "keys" / "own.key", 0o644)
    with pytest.raises(ConfigError, match="chmod 600"):
        folder.own()


NO_KEYS = {"a quote": '"' * 40, "a comma": "a" * 39 + ",", "a backslash": "\\" * 40, "too large a number": "#" * 40}


@pytest.mark.parametrize("text", ["", "short", "x" * 41, "ü" * 40, *NO_KEYS.values()])
def test_what_is_no_key_is_named(tmp_path, text):
    with pytest.raises(ConfigError, match="Z85"):
        checked_key(text)
    with pytest.raises(ConfigError):
        KeyFolder(tmp_path).allow("a", text)


@pytest.mark.parametrize("name", ["../x", "", "a/b", "n" * 65])
def test_names_stay_in_the_folder(tmp_path, name):
    with pytest.raises(ConfigError, match="letters"):
        KeyFolder(tmp_path).allow(name, zmq.curve_keypair()[0].decode())


def test_damaged_keys_are_named_and_left_out(tmp_path):
    folder = KeyFolder(tmp_path)
    with pytest.raises(ConfigError, match="mmmd keys new"):
        folder.own()
    with pytest.raises(ConfigError, match="keys trust daemon"):
        folder.server_of("daemon")
    (tmp_path / "own.key").write_text("nonsense")
    os.chmod(tmp_path / "own.key", 0o600)
    with pytest.raises(ConfigError, match="no key pair"):
        folder.own()
    folder.allow("good", zmq.curve_keypair()[0].decode())
    for name, text in {"short": "short", **NO_KEYS}.items():
        (tmp_path / "allowed" / f"{name}.pub").write_text(text)
    assert list(folder.allowed()) == ["good"]


@given(st.text(st.characters(codec="ascii"), min_size=40, max_size=40))
def test_every_key_that_is_taken_can_be_decoded(text):
    """Text that was taken for a key ended the doorkeeper, and with it every new connection."""
    try:
        key = checked_key(text)
    except ConfigError:
        return
    assert zmq.utils.z85.encode(zmq.utils.z85.decode(key)) == key


def test_addresses_that_others_can_reach_need_keys(tmp_path):
    with pytest.raises(ConfigError, match="--keys"):
        Endpoints(cmd="tcp://0.0.0.0:5871")
    assert Endpoints(cmd="tcp://0.0.0.0:5871", keys=tmp_path).keys == tmp_path


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


@pytest.mark.parametrize("who", ["no key", "a key that is not allowed", "the wrong daemon's key"])
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


def test_keys_by_command(tmp_path):
    folder = tmp_path / "k"
    made = mmmd("keys", "new", "--keys", str(folder))
    assert made.returncode == 0 and len(made.stdout.strip()) == 64
    other = as_hex(zmq.curve_keypair()[0])
    assert keys_here("allow", "laptop", other, folder)[2] == 0
    assert keys_here("trust", "generator", other, folder)[2] == 0
    listed = keys_here("list", folder)[0]
    assert made.stdout.strip() in listed and listed.count(other) == 2 and "laptop" in listed
    assert keys_here("new", folder)[2] == 2
    assert keys_here("allow", "laptop", folder)[2] == 2
    assert keys_here("trust", "cat", other, folder)[2] == 2


def test_keys_are_exchanged_by_pasting_what_is_printed(tmp_path):
    """Z85 keys hold `<>*?$(){}!#&`: of three that were pasted as the page showed, bash took none."""
    robot, laptop = tmp_path / "robot", tmp_path / "laptop"
    for _ in range(3):  # each pair of Z85 keys holds one of them in 99 of 100 cases
        for folder in (robot, laptop):
            shutil.rmtree(folder, ignore_errors=True)
        printed = {f: keys_here("new", f) for f in (robot, laptop)}
        for here, other, part in ((robot, laptop, "client"), (laptop, robot, "daemon")):
            line = next(row for row in printed[other][1].splitlines() if part in row).partition("mmmd keys ")[2]
            typed = subprocess.run(["bash", "-c", f"printf '%s\\n' {line}"], capture_output=True, text=True, check=True)
            assert keys_here(*typed.stdout.split("\n")[:-1], here)[2] == 0
        assert list(KeyFolder(robot).allowed().values()) == [KeyFolder(laptop).own().public]
        assert KeyFolder(laptop).server_of("daemon") == KeyFolder(robot).own().public


def keys_here(*arguments: object) -> tuple[str, str, int]:
    """`mmmd keys` with a folder (the last argument) in this process: what it printed, and its status."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = main(["keys", *map(str, arguments[:-1]), "--keys", str(arguments[-1])])
    return out.getvalue(), err.getvalue(), status


def test_a_key_may_be_given_in_hexadecimal_or_in_z85():
    public = zmq.curve_keypair()[0]
    assert checked_key(as_hex(public)) == checked_key(as_hex(public).upper()) == checked_key(public.decode()) == public
    for bad in ("", "0" * 63, "g" * 64, "0" * 41):
        with pytest.raises(ConfigError, match="64 hexadecimal digits"):
            checked_key(bad)


@pytest.mark.long
def test_a_daemon_without_torch_uses_a_remote_generator_over_curve(tmp_path):
    """As on a small board: torch cannot be imported; the generator is another process, behind keys."""
    without = tmp_path / "without_torch"
    without.mkdir()
    (without / "torch.py").write_text("raise ImportError('torch is not installed here')")
    board, server = KeyFolder(tmp_path / "board"), KeyFolder(tmp_path / "server")
    server.allow("board", board.new().public.decode())
    board.trust("generator", server.new().public.decode())
    address = free_endpoints().cmd
    generator = subprocess.Popen([*MMMD, "generator", "--bind", address, "--keys", str(server.path)])
    another: KinematicGenerator | None = None
    paths = os.environ.get("PYTHONPATH", "")
    os.environ["PYTHONPATH"] = f"{without}{os.pathsep}{paths}"
    try:
        daemon = RunningDaemon("--generator", address, "--keys", str(board.path), model=True)
    finally:
        os.environ["PYTHONPATH"] = paths
    try:
        daemon.until_ready()
        with daemon.client() as client:
            assert client.say("wave with your right hand").done
            client.say("clap your hands", loop=True, wait=False)
            client.wait_for("moving", timeout_s=60)
            generator.kill()
            generator.wait(5)
            end_s = time.monotonic() + 60
            while client.status().generator.startswith("ready"):
                assert time.monotonic() < end_s
                time.sleep(0.05)
            assert client.status().state == "moving"  # what is played goes on
            another = KinematicGenerator(address, keys=server)
            end_s = time.monotonic() + 60
            while not client.status().generator.startswith("ready"):
                assert time.monotonic() < end_s
                time.sleep(0.05)
            assert client.say("nod twice").done
        assert daemon.terminate() == 0
    finally:
        daemon.close()
        generator.kill()
        generator.wait(5)
        if another is not None:
            another.close()


def test_another_checkpoint_than_agreed_is_not_used():
    """A text is refused by name and moves nothing; the generator is not even asked. What needs none goes on."""
    asked: list[str] = []

    def answer(text: str, seed: int, seconds: float | None) -> Generated:
        asked.append(text)
        return generate(text, seed, seconds)

    daemon = RunningDaemon("--model-hash", "0123", answer=answer)
    try:
        end_s = time.monotonic() + 40
        while "ready: robot" not in daemon.said:
            assert time.monotonic() < end_s, daemon.said
            time.sleep(0.05)
        with daemon.client() as client:
            for _ in range(2):  # while it starts, and afterwards
                with pytest.raises(RefusedError) as caught:
                    client.say("wave", timeout_s=40)
                assert caught.value.code == "generator_down" and "checkpoint 0123" in str(caught.value)
            with pytest.raises(RefusedError, match="checkpoint 0123"):
                client.story(["wave", "left"])
            status = client.status()
            assert status.state == "limp" and status.generator.startswith("down") and status.command is None
            assert not asked
            assert client.gesture("nod").done
        assert daemon.terminate() == 0
    finally:
        daemon.close()


def test_ever_new_clients_of_one_peer_share_its_limit():
    """The limit was that of each name, and a client that connects anew has a new one."""
    limits = RequestLimits()
    allowed = sum(limits.allows(b"%d" % n, "laptop", 0.0) for n in range(2 * PEER_BURST))
    assert allowed == PEER_BURST and limits.refused == PEER_BURST
    assert limits.allows(b"1", "another machine", 0.0)
    assert sum(limits.allows(b"new %d" % n, "laptop", 1.0) for n in range(5000)) == PEER_RATE_HZ


def test_rates_bound_each_client_apart():
    rates = Rates()
    assert sum(rates.allows(b"a", 0.0) for _ in range(2 * BURST)) == BURST
    assert rates.allows(b"b", 0.0) and rates.refused == BURST
    assert sum(rates.allows(b"a", 1.0) for _ in range(1000)) == RATE_HZ
