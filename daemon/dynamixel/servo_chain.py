"""The servos on one port: their identities and abilities."""

from __future__ import annotations

import contextlib
import logging
from collections.abc import Sequence

from daemon.dynamixel.events import BusEventKind
from daemon.dynamixel.feedback import FastSyncStep
from daemon.dynamixel.feedback_cycle import FeedbackCycle
from daemon.dynamixel.health_probe import HealthProbe
from daemon.dynamixel.identity import MUTE_TEXT, PINGS_ONLY, Identity, identity_text, mismatch_hint, silence_text
from daemon.dynamixel.ports.port import Port
from daemon.dynamixel.rate_plan import RatePlan, plan_of
from daemon.dynamixel.register_access import RegisterAccess
from daemon.dynamixel.registers.registers import RETURN_DELAY_UNIT_S
from daemon.dynamixel.scan import Found, answering
from daemon.dynamixel.servo_link import TRIES, ServoLink
from daemon.dynamixel.timing import MARGIN_S, SETUP_MARGIN_S
from daemon.errors import BusMismatchError, LinkTimeoutError, MismatchRow, ServoFaultError, two_of
from daemon.host.clock import Clock
from retarget.robot.robot import ServoSpec

log = logging.getLogger(__name__)

_SILENT_ENOUGH = 4
"""Number of servos, the first of the chain, whose silence makes further pings useless."""
_SLOW_BYTES = 14 + 11 + 7
"""Bytes of request and answer for the slow registers of one servo."""


class ServoChain:
    """The servos in a daisy chain on one port: their identities, their abilities, and access to them.

    Args:
        port: the port.
        servos: the expected servos.
        clock: clock of the waiting.
        margin_s: seconds by which an answer may be late.
        slow_every: read torque, hardware error, voltage and temperature of one servo, in turn, every so many
            exchanges; 0 never.

    Attributes:
        link: requests and answers.
        registers: access to items of the control tables.
        probe: requests to single servos within a cycle.
        cycle: exchange of goals and measurements.
    """

    def __init__(
        self, port: Port, servos: Sequence[ServoSpec], clock: Clock, *, margin_s: float = MARGIN_S, slow_every: int = 0
    ) -> None:
        self.link = link = ServoLink(port, servos, clock, margin_s=margin_s)
        self.registers = RegisterAccess(link)
        self.probe = HealthProbe(link, self.registers, slow_every)
        self.cycle = FeedbackCycle(link, self.registers, self.probe)

    def ping_all(self, *, patient: bool = False) -> dict[int, Identity]:
        """Model number and firmware of each servo that answers; with `patient` every servo gets a request, however silent all are.

        A few silent servos among others get a second request: a machine or a wire may be held up for longer than the margin.
        """
        found: dict[int, Identity] = {}
        for row in range(len(self.link.ids)):
            self._take_identity(row, found)
            if not patient and row == _SILENT_ENOUGH - 1 and not found:
                return found  # wrong baud or no power: the other servos are not asked
        silent = [row for row, servo_id in enumerate(self.link.ids) if servo_id not in found]
        if found and len(silent) < _SILENT_ENOUGH:
            for row in silent:
                self._take_identity(row, found)
        return found

    def _take_identity(self, row: int, found: dict[int, Identity]) -> None:
        with contextlib.suppress(LinkTimeoutError):
            found[self.link.ids[row]] = self._identify(row)

    def _identify(self, row: int) -> Identity:
        dialect, servo_id = self.link.dialect(row), self.link.ids[row]
        if dialect.version == 2.0:
            answer = self.link.ask(dialect.ping(servo_id), row, 3)
            return int.from_bytes(answer.parameters[:2], "little"), answer.parameters[2]
        try:
            answer = self.link.ask(dialect.read(servo_id, 0, 3), row, 3)  # a ping of protocol 1.0 names no model
        except LinkTimeoutError:
            if self._answers_ping(row):
                return PINGS_ONLY
            raise
        return int.from_bytes(answer.parameters[:2], "little"), answer.parameters[2]

    def _answers_ping(self, row: int) -> bool:
        """Whether a servo that answers no other request answers a ping."""
        return (
            self.link.ask_once(self.link.dialect(row).ping(self.link.ids[row]), row, None, SETUP_MARGIN_S) is not None
        )

    def verify(self) -> None:
        """Compare the bus with the robot file, and find out the abilities of the servos' firmware.

        Raises:
            BusMismatchError: servos differ from the robot file; the error has a table of those expected and found.
        """
        found = self.ping_all()
        garbled = self.probe.look_for_collisions(list(found))
        rows = [
            self._mismatch(row, found.get(s.servo_id), nothing=not found, garbled=s.servo_id in garbled)
            for row, s in enumerate(self.link.servos)
            if s.servo_id not in found or found[s.servo_id][0] != s.model.model_number or s.servo_id in garbled
        ]
        if garbled:
            raise BusMismatchError(rows, two_of(garbled[0]))
        rows = rows or self._read_effort_limits()
        if rows:
            hint = mismatch_hint(self.link.port, [r.found for r in rows], any_answers=bool(found))
            raise BusMismatchError(rows, hint)
        known, self.link.firmware = self.link.firmware, [found[i][1] for i in self.link.ids]
        if known != self.link.firmware:  # determined once
            self._measure_turnaround()
            self._find_fast_sync()
        if self.probe.slow_every:
            self._map_windows()
        self.link.health.cleared()
        self.cycle.resume()

    def _mismatch(self, row: int, identity: Identity | None, *, nothing: bool, garbled: bool) -> MismatchRow:
        """The row for a servo that is not as expected; silent servos are asked in the other protocol, at most the first few."""
        s = self.link.servos[row]
        if garbled:
            text = "answers collide"
        elif identity is not None:
            text = identity_text(identity)
        elif nothing and row >= _SILENT_ENOUGH:
            text = "no answer"
        else:
            text = silence_text(self.link.port, self.link.clock, s.servo_id, self.link.dialect(row).version)
        return MismatchRow(s.servo_id, s.joint_name, s.model.name, text)

    def _read_effort_limits(self) -> list[MismatchRow]:
        """Read each servo's effort limit; return rows for servos that answered a ping but not this request."""
        mute: list[MismatchRow] = []
        for row, s in enumerate(self.link.servos):
            try:
                self.registers.read_effort_limit(s.servo_id)
            except LinkTimeoutError:
                if not self._answers_ping(row):
                    raise
                mute.append(MismatchRow(s.servo_id, s.joint_name, s.model.name, MUTE_TEXT))
        return mute

    def let_answer(self) -> None:
        """Set status return level 2 on servos that answer pings only. They answer no other request before."""
        for row, servo_id in enumerate(self.link.ids):
            try:
                self.registers.read_item(servo_id, "status_return_level")
            except LinkTimeoutError:
                if self._answers_ping(row):
                    with contextlib.suppress(LinkTimeoutError):  # `verify` reports the servos that still do not answer
                        self.registers.write_item(servo_id, "status_return_level", 2)

    def strangers(self) -> list[Found]:
        """Servos of Protocol 2.0 that answer a broadcast ping and do not belong to this bus; takes about 0.2 s."""
        return [f for f in answering(self.link.port, self.link.clock) if f.servo_id not in self.link.ids]

    def _measure_turnaround(self) -> None:
        """Read each servo's return delay; the turnaround is the shortest answer time without this delay and the bytes' time."""
        delays: list[int] = []
        took: list[float] = []
        for row, servo_id in enumerate(self.link.ids):
            start_s = self.link.clock.now_s()
            delays.append(self.registers.read_item(servo_id, "return_delay_time"))
            dialect = self.link.dialect(row)
            n_bytes = len(dialect.read(servo_id, 0, 1)) + dialect.status_bytes + 1
            took.append(
                self.link.clock.now_s() - start_s - self.link.timing.wire_s(n_bytes) - delays[-1] * RETURN_DELAY_UNIT_S
            )
        self.link.timing.return_delay_s = max(delays) * RETURN_DELAY_UNIT_S
        self.link.timing.turnaround_s = max(0.0, min(took))

    def plan(self) -> RatePlan:
        """The time budget of a cycle on this port, from measurements."""
        link, extra = self.link, _SLOW_BYTES if self.probe.slow_every else 0
        return plan_of(
            self.cycle.steps, self.cycle.goal_bytes, len(link.ids), link.port.baud,
            return_delay_s=link.timing.return_delay_s, turnaround_s=link.timing.turnaround_s, extra_bytes=extra,
        )  # fmt: skip

    def _map_windows(self) -> None:
        """Map indirect addresses to the slow registers on servos that have lost the mapping and support it."""
        for row, (servo_id, firmware) in enumerate(zip(self.link.ids, self.link.firmware, strict=True)):
            dialect = self.link.dialect(row)

            def write(address: int, data: bytes, row: int = row, servo_id: int = servo_id) -> None:
                self.link.ask(self.link.dialect(row).write(servo_id, address, data), row, 0)

            def read(address: int, length: int, row: int = row, servo_id: int = servo_id) -> bytes:
                return self.link.ask(self.link.dialect(row).read(servo_id, address, length), row, length).parameters

            if dialect.version == 2.0 and self.probe.slow.wants_window(row):
                try:
                    self.probe.slow.map_window(row, firmware, write, read)
                except ServoFaultError as error:
                    self.probe.slow.no_window(row)
                    log.debug("%s; its slow registers are read directly", error)
        log.info("slow registers by indirect address: %d of %d servos", self.probe.slow.n_windows, len(self.link.ids))

    def _find_fast_sync(self) -> None:
        """Try fast sync reads where model and firmware have them by the manual; the result holds from then on."""
        able = [m.has_fast_sync(f) for m, f in zip(self.link.models, self.link.firmware, strict=True)]
        rows = [i for i, can in enumerate(able) if can]
        others = len(rows) < sum(m.protocol == 2.0 for m in self.link.models)
        # A fast read saves seven bytes a servo, but costs a second request when other servos cannot take part.
        won_s = self.link.timing.wire_s(7 * len(rows) - (30 if others else 8)) - (
            self.link.timing.turnaround_s if others else 0
        )
        self.cycle.fast = [False] * len(self.link.ids)
        if not rows or won_s <= 0:
            return
        step, raw = FastSyncStep(rows, [self.link.ids[i] for i in rows]), bytearray()
        for _ in range(TRIES):
            sent_s = self.link.send(step.request)
            self.link.collect(step, sent_s, len(step.request), raw)
            if step.take(raw, self.link.reading).all():
                self.cycle.fast = able
                log.info("fast sync read: %d of %d servos", len(rows), len(self.link.ids))
                return
        text = (
            f"no whole answer of servos {', '.join(str(self.link.ids[i]) for i in rows)}; plain sync reads from now on"
        )
        self.link.events.add(BusEventKind.FAST_SYNC_OFF, self.link.clock.now_s(), text)
