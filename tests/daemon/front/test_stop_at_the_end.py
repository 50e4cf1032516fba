"""A robot that is stopped while it parks at the daemon's end holds for a while before it parks again."""

from __future__ import annotations

import signal
import time

import pytest

from daemon.front.parking import HELD_S
from tests.support.harness import running_daemon

pytestmark = pytest.mark.realtime


def test_a_stop_during_the_park_at_the_end_is_kept() -> None:
    """The park was asked for again after a second at most."""
    with running_daemon() as daemon:
        with daemon.client() as client:
            client.arm()
            client.wait_for("idle", timeout_s=20)
            client.say("raise both arms", seconds=1.5)
            daemon.process.send_signal(signal.SIGTERM)
            client.wait_for("parking", timeout_s=5)
            stopped_s = time.monotonic()
            assert client.stop().state == "parking"
            client.wait_for("holding", timeout_s=2)
            while time.monotonic() - stopped_s < HELD_S - 0.5:
                assert client.status().state == "holding"
                time.sleep(0.2)
        assert daemon.ended() == 0
        said = daemon.said
        assert "the robot holds for 5 s, then parks again" in said and said.count("parking -> limp") == 1, said
