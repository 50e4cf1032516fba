"""The link to the servos on a port: requests and answers, echo, late answers, and the loss of the port."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from daemon.dynamixel.codec.decoder import StreamDecoder
from daemon.dynamixel.codec.dialect import DIALECTS, Dialect
from daemon.dynamixel.codec.packet import Packet
from daemon.dynamixel.events import BusEventKind, EventLog
from daemon.dynamixel.feedback import Step, is_status
from daemon.dynamixel.health import HealthTracker
from daemon.dynamixel.ports.port import Port, Reopenable
from daemon.dynamixel.reading import UNKNOWN, BusReading
from daemon.dynamixel.registers.models import MODELS, BusModel
from daemon.dynamixel.timing import MARGIN_S, SETUP_MARGIN_S, Timing
from daemon.errors import CommandError, ConfigError, LinkGarbledError, LinkLostError, LinkTimeoutError, ServoFaultError
from daemon.host.clock import Clock
from retarget.robot.robot import ServoSpec

TRIES = 3
_REOPEN_EVERY_S = 0.5
_SLEEP_FROM_S, _WAKE_BEFORE_S = 0.0006, 0.0002
"""Seconds that an answer must take for the wait to sleep, and seconds before its computed end at which the sleep ends: one wake-up
instead of one for every chunk.
"""
_ECHO_BYTES = 8
"""Number of a request's first bytes whose return marks an echo: no answer begins like a request."""


class ServoLink:
    """Sends to the servos on a port, one request at a time, and receives their answers.

    Attributes:
        port: the port.
        servos, ids, models: the servos on the link; rows of every array follow them.
        firmware: firmware version of each servo, 0 before it was verified.
        timing: computes the allowed time of an exchange.
        reading: the servos' last values.
        health: state and counters of each servo.
        events: events of the port besides the exchange.
        row_by_id: servo id -> row.
        decoders: protocol -> its byte parser.
        torque_expected: whether torque was last switched on.
        garbled: whether the last request brought bytes but no packet.
        garbled_rows: (S,) whether every attempt of a servo's last request brought bytes but no packet.
    """

    def __init__(self, port: Port, servos: Sequence[ServoSpec], clock: Clock, *, margin_s: float = MARGIN_S) -> None:
        self.port, self.servos, self.clock = port, tuple(servos), clock
        self.ids = tuple(s.servo_id for s in servos)
        self.models = tuple(_model(s) for s in servos)
        self.firmware = [0] * len(servos)
        self.timing = Timing(port.baud, margin_s)
        self.events = EventLog()
        self.reading = BusReading.of(len(self.ids))
        self.health = HealthTracker(len(self.ids), np.array([m.protocol == 1.0 for m in self.models], bool))
        self.row_by_id = {servo_id: i for i, servo_id in enumerate(self.ids)}
        self.decoders: dict[float, StreamDecoder[Packet]] = {
            m.protocol: DIALECTS[m.protocol].decoder() for m in self.models
        }
        self.torque_expected = False
        self._echo = 0
        self._sent = b""
        self.garbled = False
        self.garbled_rows = np.zeros(len(self.ids), bool)
        self._lost_since_s: float | None = None
        self._reopen_due_s = 0.0

    def ask(self, request: bytes, row: int, answer_bytes: int) -> Packet:
        """Send one instruction and return the servo's answer; the instruction is repeated when the servo stays silent.

        Only instructions that may be repeated are sent this way.

        Raises:
            LinkTimeoutError: the servo stayed silent.
            LinkGarbledError: every attempt brought bytes but no answer.
        """
        n_garbled, self.garbled_rows[row] = 0, False
        for i in range(TRIES):
            self.health.counters.retries[row] += i > 0
            answer = self.ask_once(request, row, answer_bytes, SETUP_MARGIN_S)
            if answer is not None:
                return answer
            n_garbled += self.garbled
        self.garbled_rows[row] = n_garbled == TRIES
        if self.garbled_rows[row]:
            raise LinkGarbledError(self.ids[row], self.port.name, TRIES)
        text = f"servo {self.ids[row]} did not answer {TRIES} times on {self.port.name}; check its cable and power"
        raise LinkTimeoutError(text)

    def ask_once(self, request: bytes, row: int, answer_bytes: int | None, margin_s: float) -> Packet | None:
        """Send one request; return None when no answer came. With `answer_bytes` None an answer may have any length.

        `garbled` is set when bytes came that made no packet at all.
        """
        dialect, servo_id = self.dialect(row), self.ids[row]
        decoder = self.decoders[dialect.version]
        sent_s = self.send(request)
        n_bytes = len(request) + dialect.status_bytes + (3 if answer_bytes is None else answer_bytes)
        deadline_s = sent_s + self.timing.longest_s(n_bytes, 1) - self.timing.margin_s + margin_s
        skip = self._echo * len(request)
        heard = understood = False
        self.garbled = False
        while (left_s := deadline_s - self.clock.now_s()) > 0:
            data = self.read(256, left_s)
            if not data:
                break
            if not self._echo and self._is_echo(data):
                skip = len(request)
            data, skip = data[skip:], max(0, skip - len(data))
            heard |= bool(data)
            for p in decoder.feed(data):
                understood = True
                if p.servo_id != servo_id or not is_status(p):
                    continue
                refused = dialect.refusal(p.error)
                if refused:
                    raise ServoFaultError(servo_id, f"instruction {request.hex(' ')}", refused)
                if answer_bytes in (None, len(p.parameters)):  # an answer to another request has another length
                    return p
        self.garbled = heard and not understood
        return None

    def close(self) -> None:
        """Release the port."""
        self.port.close()

    def send(self, data: bytes) -> float:
        """Discard late answers, then write bytes; return the clock time of the write.

        Raises:
            LinkLostError: the device is gone and could not be reopened.
        """
        try:
            if self._lost_since_s is not None:
                self._reopen()
            self._drop_late_answers()
            self._sent = data
            self.port.write(data)
        except LinkLostError as error:
            self._note_loss(error)
            raise
        return self.clock.now_s()

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Bytes that have arrived; a loss of the port is recorded.

        Raises:
            LinkLostError: the device is gone.
        """
        try:
            return self.port.read(max_bytes, timeout_s)
        except LinkLostError as error:
            self._note_loss(error)
            raise

    def collect(self, step: Step, sent_s: float, sent_bytes: int, raw: bytearray) -> None:
        """Collect the answers of a step in `raw`, until all are complete, the last servo has answered, or the time is over.

        Args:
            step: the step whose request was sent last.
            sent_s: clock time of the request.
            sent_bytes: bytes that were sent with it, goals included.
            raw: cleared, then filled; an adapter's echo is left out.

        Raises:
            LinkLostError: the device is gone.
        """
        skip = self._echo * sent_bytes
        raw.clear()
        need = step.reply_bytes + skip
        expected_s = sent_s + self.timing.expected_s(sent_bytes + step.reply_bytes, 0)
        deadline_s = sent_s + self.timing.longest_s(sent_bytes + step.reply_bytes, step.answers)
        now_s = sent_s
        if expected_s - now_s > _SLEEP_FROM_S:
            self.clock.sleep_until(expected_s - _WAKE_BEFORE_S)
            now_s = self.clock.now_s()
        while len(raw) < need:  # after the deadline bytes that have already arrived are still read
            data = self.read(need - len(raw), max(0.0, deadline_s - now_s))
            raw += data
            now_s = self.clock.now_s()
            if not data or (len(raw) < need and step.ends(raw)):
                break
        del raw[:skip]
        if not self._echo and self._is_echo(raw):
            del raw[: len(self._sent)]
        if len(raw) == step.reply_bytes:
            self.timing.measured(sent_bytes + step.reply_bytes, step.answers, now_s - sent_s)

    @property
    def echoes(self) -> bool:
        """Whether the adapter echoes the bytes that are written."""
        return bool(self._echo)

    def _drop_late_answers(self) -> None:
        """Discard answers that arrived after their deadline, so that no cycle reads those of an earlier one."""
        while late := self.port.read(4096, 0.0):
            for decoder in self.decoders.values():
                for p in decoder.feed(late):
                    if p.servo_id in self.row_by_id:
                        self.health.came_late(self.row_by_id[p.servo_id])
        for decoder in self.decoders.values():
            decoder.clear()

    def _is_echo(self, data: bytes | bytearray) -> bool:
        """Whether the received bytes begin with the sent ones; an echo is recorded, and skipped from then on."""
        head = self._sent[:_ECHO_BYTES]
        if len(head) < _ECHO_BYTES or not data.startswith(head):
            return False
        self._echo = 1
        text = f"{self.port.name} hears what it sends; it is skipped. Turn the adapter's echo off where it can be"
        self.events.add(BusEventKind.ECHO, self.clock.now_s(), text)
        return True

    def _note_loss(self, error: LinkLostError) -> None:
        """Record the loss of the port: no answers of this cycle will arrive."""
        self.reading.valid[:] = False
        self.reading.age_cycles += 1
        self.health.port_lost()
        if self._lost_since_s is None:
            self._lost_since_s = self._reopen_due_s = self.clock.now_s()
            self.health.withhold_all()
            self.events.add(BusEventKind.LOST, self._lost_since_s, str(error))

    def look_again(self) -> None:
        """Reopen a lost port at the next write, however recently this was tried: a caller says that it is back."""
        self._reopen_due_s = 0.0

    def _reopen(self) -> None:
        """Try to open the port again, by its path or where the same adapter is now; at most twice a second.

        Raises:
            LinkLostError: the port could not be opened.
        """
        now_s = self.clock.now_s()
        if isinstance(self.port, Reopenable) and now_s >= self._reopen_due_s:
            self._reopen_due_s = now_s + _REOPEN_EVERY_S
            self.port.reopen()
            text = f"{self.port.name} is back after {now_s - (self._lost_since_s or now_s):.1f} s; nothing moves until armed anew"
            self.events.add(BusEventKind.REPLUGGED, now_s, text)
            self.expect_torque(on=False)
        elif isinstance(self.port, Reopenable):
            raise LinkLostError(f"{self.port.name}: lost; looked for again every {_REOPEN_EVERY_S} s")
        self._lost_since_s = None

    def expect_torque(self, *, on: bool) -> None:
        """Expect torque to be on or off from now on; earlier readings of it do not count."""
        self.torque_expected = on
        self.reading.torque[:] = UNKNOWN

    def dialect(self, row: int) -> Dialect:
        return DIALECTS[self.models[row].protocol]

    def row_of(self, servo_id: int) -> int:
        if servo_id not in self.row_by_id:
            raise CommandError(f"no servo {servo_id} on this bus; there are {', '.join(map(str, self.ids))}")
        return self.row_by_id[servo_id]


def _model(servo: ServoSpec) -> BusModel:
    number = servo.model.model_number
    if number not in MODELS:
        known = ", ".join(m.name for m in MODELS.values())
        raise ConfigError(
            f"servo {servo.servo_id}: no control table for model {number} ({servo.model.name}); known: {known}"
        )
    return MODELS[number]
