"""The servos on one port: goals out and measurements in, one exchange a cycle, each servo judged by itself."""

from __future__ import annotations

import logging
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from daemon.bus.dialect import DIALECTS, Decoder, Dialect
from daemon.bus.events import BusEventKind, EventLog
from daemon.bus.feedback import FastSyncStep, Protocol1Step, Step, is_status, steps_for
from daemon.bus.group import GroupWrite, GroupWrite1
from daemon.bus.health import HealthTracker
from daemon.bus.models import MODELS, BusModel
from daemon.bus.packet import Packet
from daemon.bus.port import Port, Reopenable
from daemon.bus.rate_plan import RatePlan, plan_of
from daemon.bus.reading import UNKNOWN, BusReading
from daemon.bus.registers import RETURN_DELAY_UNIT_S, WATCHDOG_TRIPPED, Item, hardware_error_text
from daemon.bus.slow import SlowReader
from daemon.bus.timing import MARGIN_S, SETUP_MARGIN_S, Timing
from daemon.clock import Clock
from daemon.errors import (
    BusMismatchError,
    CommandError,
    ConfigError,
    LinkLostError,
    LinkTimeoutError,
    MismatchRow,
    ServoFaultError,
)
from retarget.robot import ServoSpec

log = logging.getLogger(__name__)

_TRIES = 3
_SLEEP_FROM_S, _WAKE_BEFORE_S = 0.0006, 0.0002
"""Through a long answer we sleep, and wake so long before its computed end: one wake-up, not one for every chunk."""
_CAREFUL_CYCLES = 25
"""After a chained read that broke off: so long each servo answers for itself, until the silent one is quarantined."""
_REOPEN_EVERY_S = 0.5
_GAP_BYTES = 12
"""Items no farther apart are read in one question."""
_SLOW_BYTES = 14 + 11 + 7
"""Question and answer of the slow registers of one servo."""
_ECHO_BYTES = 8
"""So many bytes of a request come back only by echo: no answer begins like one."""
_FULL_EFFORT = {"goal_pwm": 885, "torque_limit": 1023}


class ServoBus:
    """Drives the servos of a robot over any port. Works in raw register units and knows no joints.

    Args:
        port: where they are.
        servos: who should be there.
        clock: of the waiting.
        margin_s: how long an answer may be late.
        slow_every: read torque, hardware error, voltage and temperature of one servo, in turn, every so many
            exchanges; 0 never.
    """

    def __init__(
        self, port: Port, servos: Sequence[ServoSpec], clock: Clock, *, margin_s: float = MARGIN_S, slow_every: int = 0
    ) -> None:
        self.port, self.servos, self.clock = port, tuple(servos), clock
        self.ids = tuple(s.servo_id for s in servos)
        self.models = tuple(_model(s) for s in servos)
        self.firmware = [0] * len(servos)
        """Of each servo, known after `verify`; 0 before."""
        self.timing = Timing(port.baud, margin_s)
        self.events = EventLog()
        self._row = {servo_id: i for i, servo_id in enumerate(self.ids)}
        n = len(self.ids)
        self.reading = BusReading.of(n)
        self.health = HealthTracker(n)
        self._decoders: dict[float, Decoder] = {m.protocol: DIALECTS[m.protocol].decoder() for m in self.models}
        self._fast = [False] * n
        self._careful = 0
        self._goal_writes = self._writers("goal_position")
        self._build_steps()
        self._slow = SlowReader(self.models)
        self._slow_every, self._cycle = slow_every, 0
        self._torque_expected = False
        self._echo = 0
        self._sent = b""
        self._lost_since_s: float | None = None
        self._reopen_due_s = 0.0
        self._in_flight: tuple[Step, float, int] | None = None
        self._raw = bytearray()

    @property
    def timeouts(self) -> NDArray[np.int64]:
        """(S,) cycles in which each servo did not answer."""
        return self.health.counters.timeouts

    # The cycle.

    def exchange(self, goal_ticks: NDArray[np.int32] | None) -> BusReading:
        """Write goals (none when None) and read effort, velocity and position of every servo, in one `write()`.

        A servo that does not answer keeps its old values, marked not valid. On a bus of servos that know group reads
        this is one request; others follow one after another.

        Raises:
            LinkLostError: the device is gone.
        """
        self._settle()
        valid = self._valid_of_cycle()
        goals = b"" if goal_ticks is None else self._goal_packet(goal_ticks)
        if not self._steps and goals:
            self._send(goals)
        for i, step in enumerate(self._steps):
            sent_s = self._send(goals + step.request if i == 0 else step.request)
            self._collect(step, sent_s, len(step.request) + (len(goals) if i == 0 else 0))
            self._take(step, valid, sent_s)
        self._finish_cycle(valid)
        return self.reading

    def exchange_ahead(self, goal_ticks: NDArray[np.int32] | None) -> BusReading:
        """Like `exchange`, but sends this cycle's request before it looks at the last cycle's answers.

        The wire is busy while they are parsed; what is returned is one cycle older. For groups that are one request.
        """
        if len(self._steps) != 1 or self._careful:
            return self.exchange(goal_ticks)
        goals = b"" if goal_ticks is None else self._goal_packet(goal_ticks)
        request = goals + self._steps[0].request
        before, self._in_flight = self._in_flight, None
        if before is None:
            self._in_flight = (self._steps[0], self._send(request), len(request))
            return self.reading
        step, sent_s, n_bytes = before
        self._collect(step, sent_s, n_bytes)
        whole = len(self._raw) == step.reply_bytes
        self._in_flight = (self._steps[0], self._send(request, drain=not whole), len(request))
        valid = self._valid_of_cycle()
        self._take(step, valid, sent_s)
        self._judge(valid)
        return self.reading

    def _settle(self) -> None:
        """Let what is on the wire come home before anything else is sent."""
        if self._in_flight is not None:
            (step, sent_s, n_bytes), self._in_flight = self._in_flight, None
            self._collect(step, sent_s, n_bytes)
            valid = self._valid_of_cycle()
            self._take(step, valid, sent_s)
            self._judge(valid)

    def _valid_of_cycle(self) -> NDArray[np.bool_]:
        self.reading.valid[:] = False
        return self.reading.valid

    def _goal_packet(self, goal_ticks: NDArray[np.int32]) -> bytes:
        if len(self._goal_writes) == 1:
            return self._goal_writes[0][1].frame(goal_ticks)
        return b"".join(write.frame(goal_ticks[rows]) for rows, write in self._goal_writes)

    def _send(self, data: bytes, *, drain: bool = True) -> float:
        """Write; the time it was written."""
        try:
            if self._lost_since_s is not None:
                self._reopen()
            if drain:
                self._drop_late_answers()
            self._sent = data
            self.port.write(data)
        except LinkLostError as error:
            self._note_loss(error)
            raise
        return self.clock.now_s()

    def _collect(self, step: Step, sent_s: float, sent_bytes: int) -> None:
        """Gather the answers of a step in `_raw`: until all are there, the last servo has answered, or time is up."""
        raw, skip = self._raw, self._echo * sent_bytes
        raw.clear()
        need = step.reply_bytes + skip
        expected_s = sent_s + self.timing.expected_s(sent_bytes + step.reply_bytes, 0)
        deadline_s = sent_s + self.timing.longest_s(sent_bytes + step.reply_bytes, step.answers)
        now_s = sent_s
        if expected_s - now_s > _SLEEP_FROM_S:
            self.clock.sleep_until(expected_s - _WAKE_BEFORE_S)
            now_s = self.clock.now_s()
        try:
            while len(raw) < need and (left_s := deadline_s - now_s) > 0:
                data = self.port.read(need - len(raw), left_s)
                raw += data
                now_s = self.clock.now_s()
                if not data or (len(raw) < need and step.ends(raw)):
                    break
        except LinkLostError as error:
            self._note_loss(error)
            raise
        del raw[:skip]
        if not self._echo and self._is_echo(raw):
            del raw[: len(self._sent)]
        if len(raw) == step.reply_bytes:
            self.timing.measured(sent_bytes + step.reply_bytes, step.answers, now_s - sent_s)

    def _take(self, step: Step, valid: NDArray[np.bool_], sent_s: float) -> None:
        """Keep what the answers in `_raw` say."""
        whole = step.take(self._raw, self.reading)
        rows = step.rows
        if whole.all():
            valid[step.index] = True
            self.reading.read_s[step.index] = sent_s
            return
        valid[rows[whole]] = True
        if not isinstance(step, FastSyncStep):
            self._take_bytewise(step, valid, sent_s)
        elif not whole.all():
            self._careful = _CAREFUL_CYCLES
        self.reading.read_s[rows[valid[rows]]] = sent_s

    def _take_bytewise(self, step: Step, valid: NDArray[np.bool_], sent_s: float) -> None:
        """The byte parser over `_raw`; goes on reading when noise has taken the place of answers."""
        dialect, decoder = self._dialect(step), self._decoders[self._dialect(step).version]
        bad_before = decoder.bad_checksums
        deadline_s = sent_s + self.timing.longest_s(len(step.request) + step.reply_bytes, step.answers)
        data = bytes(self._raw)
        noise = len(data) >= step.reply_bytes or self._echo
        while True:
            for answer in decoder.feed(data):
                self._take_answer(step, answer, valid)
            missing = step.rows[~valid[step.rows]]
            left_s = deadline_s - self.clock.now_s()
            if not len(missing) or not noise or left_s <= 0 or step.ends(self._raw):
                break
            data = self.port.read(256, left_s)
            if not data:
                break
            self._raw += data
        self.health.counters.crc[missing] += decoder.bad_checksums > bad_before
        if len(missing) and len(step.rows) > 1 and dialect.version == 1.0:
            self._careful = _CAREFUL_CYCLES

    def _take_answer(self, step: Step, answer: Packet, valid: NDArray[np.bool_]) -> None:
        row = self._row.get(answer.servo_id)
        now_s = self.clock.now_s()
        if not is_status(answer):
            text = f"instruction {answer.instruction:#04x} to servo {answer.servo_id} that we did not send"
            self.events.add(BusEventKind.FOREIGN_PACKET, now_s, text + ": another controller on the same wire")
        elif row is None or row not in step.rows:
            text = f"an answer of servo {answer.servo_id}, which was not asked; another controller, or a servo too many"
            self.events.add(BusEventKind.FOREIGN_PACKET, now_s, text)
        elif valid[row]:
            text = f"servo {answer.servo_id} answered twice: two servos have this id; change one (mmmd servo id)"
            self.events.add(BusEventKind.DUPLICATE_ID, now_s, text, answer.servo_id)
        elif step.store(row, answer, self.reading):
            valid[row] = True

    def _is_echo(self, data: bytes | bytearray) -> bool:
        """Whether what came begins with what was sent; noted, and skipped from now on."""
        head = self._sent[:_ECHO_BYTES]
        if len(head) < _ECHO_BYTES or not data.startswith(head):
            return False
        self._echo = 1
        text = f"{self.port.name} hears what it sends; it is skipped. Turn the adapter's echo off where it can be"
        self.events.add(BusEventKind.ECHO, self.clock.now_s(), text)
        return True

    def _finish_cycle(self, valid: NDArray[np.bool_]) -> None:
        self._judge(valid)
        self._cycle += 1
        now_s = self.clock.now_s()
        probe = self.health.probe_due(now_s)
        if probe is not None:
            self._probe(probe)
        elif self._slow_every and self._cycle % self._slow_every == 0:
            self._read_slow()

    def _judge(self, valid: NDArray[np.bool_]) -> None:
        """Ages, health, quarantine."""
        reading, now_s = self.reading, self.clock.now_s()
        if valid.all() and self.health.all_well(reading.error) and not self._careful:
            reading.age_cycles[:] = 0
            return
        reading.age_cycles += 1
        reading.age_cycles[valid] = 0
        silent_before = self.health.asked.copy()
        if self.health.after_cycle(valid, reading.error, now_s):
            for row in np.flatnonzero(silent_before & ~self.health.asked):
                text = (
                    f"servo {self.ids[row]} ({self.servos[row].joint_name}) is silent; asked once a second from now on"
                )
                self.events.add(BusEventKind.QUARANTINED, now_s, text, self.ids[row])
            self._build_steps()
        elif self._careful:
            self._careful -= 1
            if self._careful in (0, _CAREFUL_CYCLES - 1):
                self._build_steps()
        missing = self.health.asked & ~valid
        if missing.any() and len(self.ids) > 2 and 2 * missing.sum() >= self.health.asked.sum():
            ids = ", ".join(str(self.ids[i]) for i in np.flatnonzero(missing))
            text = f"servos {ids} silent at once: power or a cable near the adapter"
            self.events.add(BusEventKind.BROWN_OUT, now_s, text)

    def _build_steps(self) -> None:
        rows = [i for i in range(len(self.ids)) if self.health.asked[i]]
        pick = [self.ids[i] for i in rows], [self.models[i] for i in rows], [self._fast[i] for i in rows]
        self._steps = steps_for(rows, *pick, chained=not self._careful)

    def _probe(self, row: int) -> None:
        """Ask a quarantined servo whether it is back, and whether it is what it was."""
        try:
            answer = self._ask_once(self._of(row).ping(self.ids[row]), row, None, self.timing.margin_s)
            back = answer is not None
            if back and self._torque_expected and self.poll_item(self.ids[row], "torque_enable") != 1:
                self._note_reboot(row)
        except ServoFaultError:
            back = True
        self.health.probed(row, answered=back, now_s=self.clock.now_s())
        if back:
            text = f"servo {self.ids[row]} ({self.servos[row].joint_name}) answers again"
            self.events.add(BusEventKind.RETURNED, self.clock.now_s(), text, self.ids[row])
            self._build_steps()

    def _note_reboot(self, row: int) -> None:
        self.health.faulted[row] = True
        name = f"servo {self.ids[row]} ({self.servos[row].joint_name})"
        now_s, n_lost = self.clock.now_s(), int(self.health.faulted.sum())
        text = f"{name} has lost torque and settings; to be armed anew"
        self.events.add(BusEventKind.REBOOTED, now_s, text, self.ids[row])
        if 2 * n_lost >= len(self.ids) > 2:
            text = f"{n_lost} of {len(self.ids)} servos have lost their torque: the supply voltage broke down"
            self.events.add(BusEventKind.BROWN_OUT, now_s, text)

    def _read_slow(self) -> None:
        """Slow registers of the next servo in turn; what they reveal is an event."""
        row = self._slow.next_row(self.health.asked)
        if row is None:
            return
        request, length = self._slow.request(row, self.ids[row])
        asked_s = self.clock.now_s()
        try:
            answer = self._ask_once(request, row, length, self.timing.margin_s)
        except ServoFaultError:
            answer = None
        if answer is None:
            return
        if not self._slow.store(row, answer, self.reading):
            self._note_reboot(row)
            return
        self.reading.slow_read_s[row] = asked_s
        if self._torque_expected and self.reading.torque[row] == 0 and not self.health.faulted[row]:
            self._note_reboot(row)

    # Who is there.

    def ping_all(self) -> dict[int, tuple[int, int]]:
        """Model number and firmware of each servo that answers."""
        found: dict[int, tuple[int, int]] = {}
        for row, servo_id in enumerate(self.ids):
            try:
                found[servo_id] = self._identify(row)
            except LinkTimeoutError:
                pass
            if servo_id == self.ids[3 % len(self.ids)] and not found:
                break  # the first four are silent: wrong baud or no power; do not wait for the rest
        return found

    def _identify(self, row: int) -> tuple[int, int]:
        dialect, servo_id = self._of(row), self.ids[row]
        if dialect.version == 2.0:
            answer = self._ask(dialect.ping(servo_id), row, 3)
            return int.from_bytes(answer.parameters[:2], "little"), answer.parameters[2]
        answer = self._ask(dialect.read(servo_id, 0, 3), row, 3)  # a ping of protocol 1.0 names no model
        return int.from_bytes(answer.parameters[:2], "little"), answer.parameters[2]

    def verify(self) -> None:
        """Compare the bus with the robot file, and find out what this firmware can.

        Raises:
            BusMismatchError: with a table of what was expected and what was found.
        """
        found = self.ping_all()
        rows = [
            MismatchRow(s.servo_id, s.joint_name, s.model.name, _found_text(found.get(s.servo_id)))
            for s in self.servos
            if s.servo_id not in found or found[s.servo_id][0] != s.model.model_number
        ]
        if rows:
            hint = "check ids and cables: a servo keeps its id, a chain is cut behind the last one that answers"
            if not found:
                hint = (
                    f"nothing answers at {self.port.baud} baud on {self.port.name}: check power, and the baud"
                    " (?baud=...; mmmd scan tries all)"
                )
            raise BusMismatchError(rows, hint)
        known, self.firmware = self.firmware, [found[i][1] for i in self.ids]
        if known != self.firmware:  # found out once
            self._measure_turnaround()
            self._find_fast_sync()
        if self._slow_every:
            self._map_windows()
        self.health.cleared()
        self._careful = 0
        self._build_steps()

    def _measure_turnaround(self) -> None:
        """Read each servo's return delay; what the quickest question took beyond it and its bytes is the turnaround."""
        delays: list[int] = []
        took: list[float] = []
        for row, servo_id in enumerate(self.ids):
            start_s = self.clock.now_s()
            delays.append(self.read_item(servo_id, "return_delay_time"))
            dialect = self._of(row)
            n_bytes = len(dialect.read(servo_id, 0, 1)) + dialect.status_bytes + 1
            took.append(self.clock.now_s() - start_s - self.timing.wire_s(n_bytes) - delays[-1] * RETURN_DELAY_UNIT_S)
        self.timing.return_delay_s = max(delays) * RETURN_DELAY_UNIT_S
        self.timing.turnaround_s = max(0.0, min(took))

    def plan(self) -> RatePlan:
        """The budget of a cycle on this bus as it was found."""
        goal_bytes = sum(write.n_bytes for _, write in self._goal_writes)
        extra = _SLOW_BYTES if self._slow_every else 0
        return plan_of(
            self._steps, goal_bytes, len(self.ids), self.port.baud, return_delay_s=self.timing.return_delay_s,
            turnaround_s=self.timing.turnaround_s, extra_bytes=extra,
        )  # fmt: skip

    def _map_windows(self) -> None:
        """Indirect addresses for the slow registers of servos that have lost them, where a servo takes them."""
        for row, (servo_id, firmware) in enumerate(zip(self.ids, self.firmware, strict=True)):
            dialect = self._of(row)

            def write(address: int, data: bytes, row: int = row, servo_id: int = servo_id) -> None:
                self._ask(self._of(row).write(servo_id, address, data), row, 0)

            def read(address: int, length: int, row: int = row, servo_id: int = servo_id) -> bytes:
                return self._ask(self._of(row).read(servo_id, address, length), row, length).parameters

            if dialect.version == 2.0 and self._slow.wants_window(row):
                try:
                    self._slow.map_window(row, firmware, write, read)
                except ServoFaultError as error:
                    self._slow.no_window(row)
                    log.debug("%s; its slow registers are read directly", error)
        log.info("slow registers by indirect address: %d of %d servos", self._slow.n_windows, len(self.ids))

    def _find_fast_sync(self) -> None:
        """Try fast sync reads where the manual says that model and firmware know them; for good, both ways."""
        able = [m.has_fast_sync(f) for m, f in zip(self.models, self.firmware, strict=True)]
        rows = [i for i, can in enumerate(able) if can]
        others = len(rows) < sum(m.protocol == 2.0 for m in self.models)
        # Seven bytes a servo are won, and a second request is needed when others cannot.
        won_s = self.timing.wire_s(7 * len(rows) - (30 if others else 8)) - (self.timing.turnaround_s if others else 0)
        self._fast = [False] * len(self.ids)
        if not rows or won_s <= 0:
            return
        step = FastSyncStep(rows, [self.ids[i] for i in rows])
        for _ in range(_TRIES):
            sent_s = self._send(step.request)
            self._collect(step, sent_s, len(step.request))
            if step.take(self._raw, self.reading).all():
                self._fast = able
                log.info("fast sync read: %d of %d servos", len(rows), len(self.ids))
                return
        text = f"no whole answer of servos {', '.join(str(self.ids[i]) for i in rows)}; plain sync reads from now on"
        self.events.add(BusEventKind.FAST_SYNC_OFF, self.clock.now_s(), text)

    # Single items.

    def read_item(self, servo_id: int, name: str) -> int:
        """Value of one item of one servo."""
        row = self._row_of(servo_id)
        item = self._item(row, name)
        answer = self._ask(self._of(row).read(servo_id, item.address, item.size), row, item.size)
        return item.decode(answer.parameters)

    def read_items(self, servo_id: int, names: Sequence[str]) -> dict[str, int]:
        """Values of those of the named items that a servo has, neighbours in one question."""
        row = self._row_of(servo_id)
        table, values = self.models[row].table, dict[str, int]()
        items = sorted((table[name] for name in names if name in table), key=lambda item: item.address)
        while items:
            span = [items.pop(0)]
            while items and items[0].address - span[-1].end <= _GAP_BYTES:
                span.append(items.pop(0))
            start, length = span[0].address, span[-1].end - span[0].address
            data = self._ask(self._of(row).read(servo_id, start, length), row, length).parameters
            values |= {i.name: i.decode(data[i.address - start : i.end - start]) for i in span}
        return values

    def poll_item(self, servo_id: int, name: str) -> int | None:
        """Value of one item, asked once and within the cycle; None when the servo did not answer in time."""
        row = self._row_of(servo_id)
        item = self._item(row, name)
        request = self._of(row).read(servo_id, item.address, item.size)
        answer = self._ask_once(request, row, item.size, self.timing.margin_s)
        return None if answer is None else item.decode(answer.parameters)

    def write_item(self, servo_id: int, name: str, value: int) -> None:
        """Set one item of one servo and wait for its answer.

        Raises:
            CommandError: the item is read only or the value does not fit.
            ServoFaultError: the servo refused.
            LinkTimeoutError: it did not answer.
        """
        row = self._row_of(servo_id)
        item = self._item(row, name)
        if not item.writable:
            raise CommandError(f"servo {servo_id}: '{name}' is read only")
        try:
            data = item.encode(value)
        except OverflowError:
            raise CommandError(f"servo {servo_id}: '{name}' = {value} does not fit {item.size} bytes") from None
        self._ask(self._of(row).write(servo_id, item.address, data), row, 0)

    def write_all(self, name: str, value: int) -> None:
        """Set one item of every servo, each confirmed; the first refusal is raised."""
        for servo_id in self.ids:
            self.write_item(servo_id, name, value)
        if name == "torque_enable":
            self._expect_torque(on=bool(value))

    def send_all(self, name: str, value: int) -> None:
        """Set one item of every servo that has it, with packets that nobody answers."""
        values = np.full(len(self.ids), value, np.int32)
        self._send(b"".join(write.frame(values[rows]) for rows, write in self._writers(name)))

    # Torque, and what goes with it.

    def send_torque_off(self) -> None:
        """Cut the torque of every servo with packets that nobody has to answer."""
        self._expect_torque(on=False)
        self.send_all("torque_enable", 0)

    def _expect_torque(self, *, on: bool) -> None:
        """From now on torque should be so; what was read before says nothing about it."""
        self._torque_expected = on
        self.reading.torque[:] = UNKNOWN

    def set_effort(self, share: float, *, confirmed: bool = False) -> None:
        """Limit what every servo may exert, as a share of all: goal PWM, or torque limit on protocol 1.0.

        Args:
            share: 0 to 1.
            confirmed: each servo is told by itself and has to answer; else all at once, unanswered.
        """
        for name, full in _FULL_EFFORT.items():
            able = [i for i, m in zip(self.ids, self.models, strict=True) if name in m.table]
            value = round(full * min(1.0, max(0.0, share)))
            if able and not confirmed:
                self.send_all(name, value)
            for servo_id in able if confirmed else ():
                self.write_item(servo_id, name, value)

    def arm_watchdog(self, units: int) -> tuple[int, ...]:
        """Arm the bus watchdog (20 ms units) of every servo that has one; the ids of those without, or of no use.

        Firmware of the 330 size that flags the trip but keeps moving is armed as well, and named here.
        """
        without: list[int] = []
        for servo_id, model, firmware in zip(self.ids, self.models, self.firmware, strict=True):
            if model.has_watchdog(firmware or 255):
                self.write_item(servo_id, "bus_watchdog", units)
            if not (model.has_watchdog(firmware or 255) and model.watchdog_stops):
                without.append(servo_id)
        return tuple(without)

    def clear_watchdog(self) -> None:
        """Clear every bus watchdog; a servo that has tripped loses its torque first.

        Cleared under torque it would go on to the goal it was stopped on the way to.
        """
        for servo_id in self.tripped_watchdogs():
            self.events.add(BusEventKind.WATCHDOG_TRIPPED, self.clock.now_s(), f"servo {servo_id}", servo_id)
            self.write_item(servo_id, "torque_enable", 0)
        for servo_id, model in zip(self.ids, self.models, strict=True):
            if "bus_watchdog" in model.table:
                self.write_item(servo_id, "bus_watchdog", 0)

    def tripped_watchdogs(self) -> list[int]:
        """Ids of the servos that have stopped by their bus watchdog."""
        able = [i for i, m in zip(self.ids, self.models, strict=True) if "bus_watchdog" in m.table]
        return [i for i in able if self.read_item(i, "bus_watchdog") == WATCHDOG_TRIPPED]

    def hardware_error_text(self, servo_id: int) -> str:
        """What a servo with the alert bit set complains of."""
        row = self._row_of(servo_id)
        if "hardware_error_status" in self.models[row].table:
            self.reading.hardware_error[row] = self.read_item(servo_id, "hardware_error_status")
        return hardware_error_text(int(self.reading.hardware_error[row]))

    def reboot(self, servo_id: int) -> None:
        """Restart a servo: a latched error goes, and with it its torque and settings."""
        row = self._row_of(servo_id)
        self._ask(self._of(row).reboot(servo_id), row, 0)
        self.health.faulted[row] = True

    # Asking.

    def _ask(self, request: bytes, row: int, answer_bytes: int) -> Packet:
        """Send one instruction and return the servo's answer; asked again when it stays silent.

        Only instructions that may be repeated are sent this way.
        """
        for i in range(_TRIES):
            self.health.counters.retries[row] += i > 0
            answer = self._ask_once(request, row, answer_bytes, SETUP_MARGIN_S)
            if answer is not None:
                return answer
        text = f"servo {self.ids[row]} did not answer {_TRIES} times on {self.port.name}; check its cable and power"
        raise LinkTimeoutError(text)

    def _ask_once(self, request: bytes, row: int, answer_bytes: int | None, margin_s: float) -> Packet | None:
        """One question; None when nothing came. `answer_bytes` None takes an answer of any length."""
        self._settle()
        dialect, servo_id = self._of(row), self.ids[row]
        decoder = self._decoders[dialect.version]
        sent_s = self._send(request)
        n_bytes = len(request) + dialect.status_bytes + (3 if answer_bytes is None else answer_bytes)
        deadline_s = sent_s + self.timing.longest_s(n_bytes, 1) - self.timing.margin_s + margin_s
        skip = self._echo * len(request)
        while (left_s := deadline_s - self.clock.now_s()) > 0:
            data = self.port.read(256, left_s)
            if not data:
                break
            if not self._echo and self._is_echo(data):
                skip = len(request)
            data, skip = data[skip:], max(0, skip - len(data))
            for p in decoder.feed(data):
                if p.servo_id != servo_id or not is_status(p):
                    continue
                refused = dialect.refusal(p.error)
                if refused:
                    raise ServoFaultError(servo_id, f"instruction {request.hex(' ')}", refused)
                if answer_bytes in (None, len(p.parameters)):  # an answer to something else has another length
                    return p
        return None

    def _drop_late_answers(self) -> None:
        """Throw away what arrived after its deadline, or this cycle would read the last one's answers for ever."""
        while late := self.port.read(4096, 0.0):
            for decoder in self._decoders.values():
                for p in decoder.feed(late):
                    if p.servo_id in self._row:
                        self.health.came_late(self._row[p.servo_id])
        for decoder in self._decoders.values():
            decoder.clear()

    # Loss of the port.

    def _note_loss(self, error: LinkLostError) -> None:
        if self._lost_since_s is None:
            self._lost_since_s = self._reopen_due_s = self.clock.now_s()
            self.events.add(BusEventKind.LOST, self._lost_since_s, str(error))

    def _reopen(self) -> None:
        """Try to open the port again, by its path or where the same adapter is now; at most twice a second.

        Raises:
            LinkLostError: it is not back.
        """
        now_s = self.clock.now_s()
        if isinstance(self.port, Reopenable) and now_s >= self._reopen_due_s:
            self._reopen_due_s = now_s + _REOPEN_EVERY_S
            self.port.reopen()
            text = f"{self.port.name} is back after {now_s - (self._lost_since_s or now_s):.1f} s; nothing moves until armed anew"
            self.events.add(BusEventKind.REPLUGGED, now_s, text)
            self._expect_torque(on=False)
        elif isinstance(self.port, Reopenable):
            raise LinkLostError(f"{self.port.name}: lost; looked for again every {_REOPEN_EVERY_S} s")
        self._lost_since_s = None

    # Details.

    def _writers(self, name: str) -> list[tuple[NDArray[np.intp], GroupWrite | GroupWrite1]]:
        """One group write for each place at which the item stands, of the servos that have it."""
        places: dict[tuple[float, int, int], list[int]] = {}
        for row, model in enumerate(self.models):
            item = model.table.get(name)
            if item is not None:
                places.setdefault((model.protocol, item.address, item.size), []).append(row)
        if not places:
            raise CommandError(f"no servo on {self.port.name} has an item '{name}'")
        return [
            (
                np.array(rows, np.intp),
                (GroupWrite if protocol == 2.0 else GroupWrite1)([self.ids[r] for r in rows], address, size),
            )
            for (protocol, address, size), rows in places.items()
        ]

    def _of(self, row: int) -> Dialect:
        return DIALECTS[self.models[row].protocol]

    def _dialect(self, step: Step) -> Dialect:
        return DIALECTS[1.0 if isinstance(step, Protocol1Step) else 2.0]

    def _row_of(self, servo_id: int) -> int:
        if servo_id not in self._row:
            raise CommandError(f"no servo {servo_id} on this bus; there are {', '.join(map(str, self.ids))}")
        return self._row[servo_id]

    def _item(self, row: int, name: str) -> Item:
        table = self.models[row].table
        if name not in table:
            raise CommandError(f"servo {self.ids[row]} has no item '{name}'; it has: {', '.join(table)}")
        return table[name]


def _model(servo: ServoSpec) -> BusModel:
    number = servo.model.model_number
    if number not in MODELS:
        known = ", ".join(m.name for m in MODELS.values())
        raise ConfigError(
            f"servo {servo.servo_id}: no control table for model {number} ({servo.model.name}); known: {known}"
        )
    return MODELS[number]


def _found_text(found: tuple[int, int] | None) -> str:
    if found is None:
        return "no answer"
    name = MODELS[found[0]].name if found[0] in MODELS else "unknown"
    return f"{name} (model {found[0]}), firmware {found[1]}"
