"""Takes the requests of `cmd` one by one: each becomes a command for the performer, or is answered at once."""

from __future__ import annotations

import asyncio
import importlib.metadata
from collections.abc import Callable

from daemon.errors import ClipError, GestureExistsError, UnknownGestureError
from daemon.front.conversations import Client, Conversations
from daemon.front.publisher import TOPICS
from daemon.front.stop_texts import asks_to_stop
from daemon.generator.client import GeneratorClient
from daemon.gestures.library import GestureLibrary
from daemon.playback.sources.source_factory import SourceFactory
from daemon.poses.layers import gaze_note
from daemon.scheduling.scheduler import Scheduler
from daemon.settings.config import DaemonConfig
from daemon.state.ledger import Entry, Ledger, Route
from daemon.state.replies import NotPlayableError
from daemon.wire.event_base import Event
from daemon.wire.events import Ack, Rejected
from daemon.wire.requests import (
    CMD_TYPES,
    CTL_TYPES,
    IDLE_STYLES,
    LEAST_AMPLITUDE,
    LEAST_TEMPO,
    LONGEST_PREFIX_S,
    LONGEST_S,
    MOST_AMPLITUDE,
    MOST_REPEATS,
    MOST_TEMPO,
    SHORTEST_S,
    STREAM_TYPES,
    Cancel,
    Capabilities,
    Command,
    Idle,
    Look,
    Record,
    Release,
    Request,
    Status,
    tag_of,
)
from daemon.wire.status import CapabilitiesEvent, JointInfo, StateEvent
from retarget.robot.robot import RobotModel

READ_AHEAD_S = 0.5
"""Seconds after a command, when its motion has been made, until its words are read for texts that may refer to it."""


class RequestHandler:
    """Answers requests.

    Args:
        state: makes the state event.
    """

    def __init__(
        self,
        config: DaemonConfig,
        robot: RobotModel,
        performer: Scheduler,
        sources: SourceFactory,
        ledger: Ledger,
        generator: GeneratorClient,
        state: Callable[[], StateEvent],
    ) -> None:
        self._config, self._robot = config, robot
        self._performer, self._sources = performer, sources
        self._ledger, self._generator, self._state = ledger, generator, state
        self._conversations = Conversations(self._words_of)

    @property
    def library(self) -> GestureLibrary:
        """The gestures."""
        return self._sources.library

    def take(self, request: Request, route: Route, t_received_ns: int, client: Client) -> None:
        """Carry out a request of a client and answer it.

        Raises:
            WireError: its id stands for something else.
        """
        if isinstance(request, Command):
            entry = self._ledger.open(request, route, t_received_ns)
            if entry is not None and asks_to_stop(request):
                self._performer.stop_for(entry)
            elif entry is not None:
                self._play(entry, client)
            return
        event = self._answer(request)
        event.id = request.id
        self._ledger.reply(route, event)

    def _play(self, entry: Entry, client: Client) -> None:
        try:
            self._conversations.take(entry, client)
        except NotPlayableError as error:
            self._ledger.emit(entry, error.event)
            return
        self._performer.play(entry)
        asyncio.get_running_loop().call_later(READ_AHEAD_S, self._conversations.read_ahead, entry)

    def _words_of(self, gesture: str) -> str:
        try:
            return self.library.get(gesture).text
        except (UnknownGestureError, ClipError):
            return ""

    def _answer(self, request: Request) -> Event:
        if isinstance(request, Status):
            return self._state()
        if isinstance(request, Cancel):
            return self._cancel(request)
        if isinstance(request, Release):
            return self._release(request)
        if isinstance(request, Look):
            return self._look(request)
        if isinstance(request, Idle):
            self._performer.layers.idle_style = request.style if request.on else ""
            return self._ack(request)
        if isinstance(request, Record):
            return self._record(request)
        if isinstance(request, Capabilities):
            return self._capabilities()
        raise TypeError(f"no answer to {type(request).__name__}")

    def _ack(self, request: Request, note: str = "") -> Ack:
        return Ack(verb=tag_of(request), state=self._performer.machine.state.value, note=note)

    def _cancel(self, request: Cancel) -> Event:
        running = self._performer.running_ids()
        if not running or request.command not in ("", *running):
            found = f"running: {', '.join(running)}" if running else "nothing is running"
            asked, allowed = f"cancel {request.command!r}", "the id of a running command, or an empty one"
            return Rejected(code="not_running", asked=asked, found=found, allowed=allowed, do="see `mmmd status`")
        ack = self._ack(request)
        self._performer.cancel(request.command)
        return ack

    def _release(self, request: Release) -> Event:
        lease = self._performer.lease
        if lease is None or request.lease not in ("", lease.id):
            found = "nobody holds a lease" if lease is None else f"the lease that is held is {lease.id!r}"
            return Rejected(
                code="no_lease", asked=f"release {request.lease!r}", found=found, allowed="the lease that is held",
                do="see `mmmd status`",
            )  # fmt: skip
        ack = self._ack(request)
        self._performer.release()
        return ack

    def _look(self, request: Look) -> Event:
        note = ""
        if request.yaw_deg is None and request.pitch_deg is None:
            self._performer.layers.gaze_deg = None
        else:
            gaze = (request.yaw_deg or 0.0, request.pitch_deg or 0.0)
            self._performer.layers.gaze_deg = gaze
            note = gaze_note(self._robot, *gaze)
        if self._performer.machine.state.value == "limp":
            note = "; ".join(filter(None, [note, "the robot is limp: it looks there once it moves"]))
        self._performer.look_again()
        return self._ack(request, note)

    def _record(self, request: Record) -> Event:
        try:
            text = self._sources.keep(request.name, request.command, replace=request.replace)
        except GestureExistsError as error:
            return Rejected(
                code="gesture_exists", asked=f"record {request.name!r}",
                found="one of your own has that name" if error.own else "a gesture that ships has that name",
                allowed="a new name", do="choose another name, or set `replace` (`mmmd gesture record NAME --replace`)",
            )  # fmt: skip
        except ClipError as error:
            return Rejected(
                code="bad_gesture", asked=f"record {request.name!r}", found=str(error), allowed="a motion that was played",
                do="`mmmd say` it, then record",
            )  # fmt: skip
        return self._ack(request, f"{request.name}: {text}")

    def _capabilities(self) -> CapabilitiesEvent:
        robot, config = self._robot, self._config
        joints = [
            JointInfo(
                j.name, j.role, j.position_min_rad, j.position_max_rad, j.velocity_limit_rad_s, j.acceleration_limit_rad_s2
            )
            for j in robot.joints
        ]  # fmt: skip
        return CapabilitiesEvent(
            version=importlib.metadata.version("mmmd"),
            robot=robot.name,
            rate_hz=robot.bus.rate_hz,
            joints=joints,
            generator=self._generator.state,
            checkpoint_hash=self._generator.checkpoint_hash,
            requests={
                "cmd": [tag_of(t) for t in CMD_TYPES],
                "ctl": [tag_of(t) for t in CTL_TYPES],
                "stream": [tag_of(t) for t in STREAM_TYPES],
            },
            topics=TOPICS,
            options={
                "tempo": [LEAST_TEMPO, MOST_TEMPO],
                "amplitude": [LEAST_AMPLITUDE, MOST_AMPLITUDE],
                "repeat": [1, MOST_REPEATS],
                "seconds": [SHORTEST_S, LONGEST_S],
                "prefix_s": [0.0, LONGEST_PREFIX_S],
            },
            gestures=self.library.infos(),
            idle_styles=list(IDLE_STYLES),
            stream=config.endpoints.stream,
            lease={"silence_s": config.lease_s, "park_s": config.lease_park_s, "limp_s": config.lease_limp_s},
        )
