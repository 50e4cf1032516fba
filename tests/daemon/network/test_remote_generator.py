"""A generator on another machine: behind keys, and refused when it has another checkpoint than agreed."""

from __future__ import annotations

import os
import subprocess
import time

import pytest

from daemon.client import RefusedError
from daemon.demo.main_job import free_endpoints
from daemon.generator.generated import Generated
from daemon.network.keys import KeyFolder
from tests.support.harness import MMMD, RunningDaemon
from tests.support.kinematic import KinematicGenerator, generate

pytestmark = pytest.mark.realtime


@pytest.mark.long
def test_a_daemon_without_torch_uses_a_remote_generator_over_curve(tmp_path):
    """The daemon runs as on a small board: it cannot import torch, and the generator is another process, behind keys."""
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
