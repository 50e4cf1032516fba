"""The front's handler of `cmd` among stand-ins: no sockets, no robot, no generator; what reaches the scheduler is kept."""

from __future__ import annotations

import json
import time
from types import SimpleNamespace

from daemon.front.request_handler import RequestHandler
from daemon.state.ledger import Entry, Ledger, Route
from daemon.state.machine import StateMachine
from daemon.wire.codec import decode_cmd
from daemon.wire.event_base import Event
from daemon.wire.events import Ack

COMMANDS: dict[str, dict[str, object]] = {
    "say 'wave'": {"type": "say", "text": "wave"},
    "say 'nod'": {"type": "say", "text": "nod", "when": "after", "context": False},
    "story 'wave; bow'": {"type": "story", "scenes": [{"text": "wave"}, {"text": "bow"}]},
    "inbetween '1 poses'": {"type": "inbetween", "poses": [{"at_s": 1, "gesture": "bow"}]},
    "edit 'wave'": {"type": "edit", "text": "wave", "plan": 3},
    "replay 'a.npz'": {"type": "replay", "file": "a.npz"},
    "gesture 'bow'": {"type": "gesture", "name": "bow"},
    "lease 'stream of tracker'": {"type": "lease", "secret": 16 * "s", "holder": "tracker"},
    "look": {"type": "look", "yaw_deg": 30.0},
    "idle": {"type": "idle", "on": True},
}
"""A request of each kind that sets motion going, by its name in a refusal."""
STOPS: dict[str, dict[str, object]] = {
    "say": {"type": "say", "text": "Stop!!!"},
    "say after": {"type": "say", "text": "don't move", "when": "after"},
    "story": {"type": "story", "scenes": [{"text": "wave"}, {"text": "emergency stop"}]},
    "inbetween": {"type": "inbetween", "text": "please stop", "poses": [{"at_s": 1, "gesture": "bow"}]},
    "edit": {"type": "edit", "text": "halt", "gesture": "wave_left"},
}
"""Requests whose text means to stop."""
CLIENT = (b"page", "127.0.0.1")


class CmdFront:
    """A handler of `cmd` among stand-ins.

    Attributes:
        reached: names of what reached the scheduler, in order.
        played: commands among them that are to be played.
        heard: events that the sender received.
    """

    def __init__(self) -> None:
        self.reached: list[str] = []
        self.played: list[Entry] = []
        self.heard: list[Event] = []
        self._ledger = Ledger(lambda _route, event: self.heard.append(event), lambda _event: None)
        self.layers = SimpleNamespace(idle_style="", gaze_deg=None)
        performer = SimpleNamespace(
            machine=StateMachine(),
            layers=self.layers,
            play=self._play,
            stop_for=self._stop_for,
            look_again=lambda: self.reached.append("look"),
        )
        sources = SimpleNamespace(library=SimpleNamespace(get=lambda name: SimpleNamespace(text=name)))
        robot = SimpleNamespace(joint_with_role=lambda _role: None)
        self.desk = RequestHandler(None, robot, performer, sources, self._ledger, None, lambda: None)
        self._state_s = time.monotonic()

    def take(self, request: dict[str, object], age_s: float | None, **more: object) -> Event | None:
        """Give the desk a request that names a state of that age when it arrives; returns what its sender hears, if anything.

        Args:
            request: its fields.
            age_s: seconds; None for a request that names no state.
            more: further fields.
        """
        heard = len(self.heard)
        state = {} if age_s is None else {"state_t_mono": self._state_s}
        received_s = self._state_s + (age_s or 0.0)
        self.desk.take(
            decode_cmd(self.frame(state | request | more)),
            Route((b"page",), once=False),
            round(received_s * 1e9),
            CLIENT,
        )
        return self.heard[-1] if len(self.heard) > heard else None

    @staticmethod
    def frame(request: dict[str, object]) -> bytes:
        """A request on the wire."""
        return json.dumps(request).encode()

    def _play(self, entry: Entry) -> None:
        self.reached.append("play")
        self.played.append(entry)

    def _stop_for(self, entry: Entry) -> None:
        self.reached.append("stop")
        self._ledger.emit(entry, Ack(verb="stop", state="moving"))
