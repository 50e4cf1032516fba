"""Takes the frames of the `stream` socket one by one: each is a target for the lease that is held, or counts as a bad message."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable

from daemon.front.target_parsing import TargetParser
from daemon.scheduling.scheduler import Scheduler
from daemon.state.ledger import Ledger
from daemon.wire.codec import WireError, error_event
from daemon.wire.event_base import Event
from daemon.wire.events import Progress
from daemon.wire.requests import Lease
from daemon.wire.status import LeaseInfo, StreamInfo
from retarget.robot.robot import RobotModel

log = logging.getLogger(__name__)


class TargetHandler:
    """Hands targets to the scheduler.

    Args:
        robot: the robot.
        performer: scheduler that plays the targets.
        ledger: sends the holder events about its bad messages.
        publish: publishes events about bad messages that belong to no lease.
    """

    def __init__(
        self, robot: RobotModel, performer: Scheduler, ledger: Ledger, publish: Callable[[Event], None]
    ) -> None:
        self._performer, self._ledger, self._publish = performer, ledger, publish
        self._inbox = TargetParser(robot)

    @property
    def secret(self) -> str:
        """Secret of the lease that is held; empty for none."""
        lease = self._performer.lease
        return lease.request.secret if lease is not None and isinstance(lease.request, Lease) else ""

    def take(self, parts: list[bytes]) -> None:
        """Read a message; a bad message moves nothing and does not count as a sign of life."""
        lease, lease_id, holder = self._performer.lease, "", ""
        if lease is not None:
            lease_id, holder = lease.id, lease.request.words
        try:
            q_rad = self._inbox.read(parts, lease_id, holder, self.secret)
        except WireError as error:
            self._tell(error)
            return
        try:
            self._performer.target(q_rad)
        except Exception:  # one target must not end the daemon
            log.exception("a target failed")

    def info(self, endpoint: str) -> StreamInfo:
        """The state of the stream and its lease for `status`."""
        return StreamInfo(endpoint, self._lease_info(), dict(self._inbox.bad))

    def _lease_info(self) -> LeaseInfo | None:
        lease, score = self._performer.lease, self._performer.stream
        if lease is None or not isinstance(lease.request, Lease):
            return None
        if score is None or not score.begun:
            return LeaseInfo(lease.id, lease.request.holder, "accepted")
        return LeaseInfo(
            lease.id, lease.request.holder, score.clock.state.value, score.held_by, score.clock.silence_s,
            round(max(0.0, time.monotonic() - score.clock.last_s), 3), score.targets, score.clipped,
        )  # fmt: skip

    def _tell(self, error: WireError) -> None:
        n = self._inbox.due(error.code, time.monotonic())
        if not n:
            return
        log.warning("stream: %d bad, %s: %s", n, error.code, error)
        lease = self._performer.lease
        if lease is not None and error.request_id == lease.id:
            self._ledger.emit(
                lease, Progress(plan_id=0, stage="bad_target", status=error.code, reason=f"{n}: {error}"[:500])
            )
            return
        self._publish(self._ledger.stamp(error_event(error)))
