"""More messages than anybody needs: what is played goes on, and a stop is not lost among them."""

from __future__ import annotations

import contextlib
import threading
import time

import pytest
import zmq

from daemon.client import CancelledByError
from daemon.wire.requests import Gesture
from tests.support.harness import running_daemon
from tests.support.sizes import few_and_long

pytestmark = [pytest.mark.timeout(120), pytest.mark.realtime]
CLIENTS = 4
"""So that each stays below the burst that one client may send, and every message is served."""
FRAMES = (b'{"type": "status"}', b'{"type": "capabilities"}', b"{", b'{"type": "cancel", "command": "nobody"}')


class Flood:
    """Sends all its frames as fast as the sockets take them, from a thread, and counts the answers.

    Attributes:
        begun: set once a tenth has been answered.
        over: set once all have been.
    """

    def __init__(self, endpoint: str, messages: int) -> None:
        self.begun, self.over = threading.Event(), threading.Event()
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(endpoint, messages))
        self._thread.start()

    def _run(self, endpoint: str, messages: int) -> None:
        context, poller = zmq.Context(), zmq.Poller()
        sockets: list[zmq.Socket[bytes]] = []
        for _ in range(CLIENTS):
            socket = context.socket(zmq.DEALER)
            socket.setsockopt(zmq.RCVHWM, 0)
            socket.setsockopt(zmq.SNDHWM, 0)
            socket.connect(endpoint)
            poller.register(socket, zmq.POLLIN)
            sockets.append(socket)
        for k in range(messages):
            sockets[k % CLIENTS].send(FRAMES[k // CLIENTS % len(FRAMES)])
        answered = 0
        while answered < messages and not self._closing.is_set():
            for socket, _ in poller.poll(100):
                socket.recv()
                answered += 1
            if answered >= messages // 10:
                self.begun.set()
        if answered == messages:
            self.over.set()
        context.destroy(linger=0)

    def close(self) -> None:
        self._closing.set()
        self._thread.join(30)


@pytest.mark.parametrize(("messages", "robot"), few_and_long([(1_000, None)], [(2_500, None), (13_000, "reference")]))
def test_a_flood_of_messages_ends_no_motion_and_hides_no_stop(messages, robot):
    """The front served all of them before anything else: the robot ran dry, was held as if the front were gone, parked.

    A frame that comes late is played late, none is lost; a machine that other tests keep busy makes some late.
    """
    with contextlib.ExitStack() as floods, running_daemon(robot=robot) as daemon, daemon.client() as client:
        client.arm()
        playing = Gesture(id="playing", name="wave_right", loop=True)
        client.play(playing, wait=False)
        before = client.wait_for("moving", timeout_s=5)

        first = floods.enter_context(contextlib.closing(Flood(daemon.endpoints.cmd, messages)))
        assert first.over.wait(60), "not every message was answered"
        seen = client.status().bus_info["cycles"]
        while (after := client.status()).bus_info["cycles"] < seen + 50:  # what happened meanwhile is counted by then
            time.sleep(0.02)
        assert after.state == "moving" and after.command is not None and after.command.id == "playing"
        n_late, n_cycles = (after.bus_info[key] - before.bus_info[key] for key in ("underruns", "cycles"))
        assert 4 * n_late <= n_cycles
        assert after.bus_info["requests_dropped"] == 0 and "front silent" not in daemon.said

        second = floods.enter_context(contextlib.closing(Flood(daemon.endpoints.cmd, messages // 2)))
        assert second.begun.wait(60)
        client.stop()
        with pytest.raises(CancelledByError, match="stop"):
            client.play(playing, timeout_s=30)
        assert client.status().state == "holding"
        assert second.over.wait(60), "not every message was answered"
        assert client.status().state == "holding" and "front silent" not in daemon.said
        assert client.say("wave", seconds=0.8, timeout_s=30).done
