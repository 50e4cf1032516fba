"""The cycle of a bus: goals out and measurements in, one exchange a cycle, each servo judged by itself."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from daemon.dynamixel.chained_adapters import ChainedReads
from daemon.dynamixel.codec.dialect import DIALECTS, Dialect
from daemon.dynamixel.codec.packet import BROADCAST_ID, Packet
from daemon.dynamixel.events import BusEventKind
from daemon.dynamixel.feedback import FastSyncStep, Protocol1Step, Step, is_status, steps_for
from daemon.dynamixel.health_probe import Probing
from daemon.dynamixel.ports.port import Port
from daemon.dynamixel.reading import NEVER_CYCLES, BusReading
from daemon.dynamixel.timing import MARGIN_S
from daemon.host.clock import Clock
from retarget.robot.robot import ServoSpec

_SLEEP_FROM_S, _WAKE_BEFORE_S = 0.0006, 0.0002
"""Through a long answer we sleep, and wake so long before its computed end: one wake-up, not one for every chunk."""


class Cycle(Probing):
    """Exchanges goals and measurements; see `ServoBus`."""

    def __init__(
        self, port: Port, servos: Sequence[ServoSpec], clock: Clock, *, margin_s: float = MARGIN_S, slow_every: int = 0
    ) -> None:
        super().__init__(port, servos, clock, margin_s=margin_s, slow_every=slow_every)
        self._fast = [False] * len(self.ids)
        self._chained = ChainedReads()
        self._broke_at: int | None = None
        self._goal_writes = self._writers("goal_position")
        self._build_steps()
        self._in_flight: tuple[Step, float, int] | None = None
        self._raw = bytearray()

    @property
    def timeouts(self) -> NDArray[np.int64]:
        """(S,) cycles in which each servo did not answer."""
        return self.health.counters.timeouts

    def exchange(self, goal_ticks: NDArray[np.int32] | None) -> BusReading:
        """Write goals (none when None) and read effort, velocity and position of every servo, in one `write()`.

        A servo that does not answer keeps its old values, marked not valid. On a bus of servos that know group reads
        this is one request; others follow one after another.

        Raises:
            LinkLostError: the device is gone.
        """
        self.begin(goal_ticks)
        return self.finish()

    def begin(self, goal_ticks: NDArray[np.int32] | None) -> None:
        """First half of `exchange`: everything is sent that can be before the first answer.

        Raises:
            LinkLostError: the device is gone.
        """
        self._settle()
        goals = b"" if goal_ticks is None else self._goal_packet(goal_ticks)
        if self._steps:
            request = goals + self._steps[0].request
            self._in_flight = (self._steps[0], self._send(request), len(request))
        elif goals:
            self._send(goals)

    def finish(self) -> BusReading:
        """Second half of `exchange`.

        Raises:
            LinkLostError: the device is gone.
        """
        valid = self._valid_of_cycle()
        for i, step in enumerate(self._steps):
            if i > 0:
                self._in_flight = (step, self._send(step.request), len(step.request))
            self._take_in_flight(valid)
        self._finish_cycle(valid)
        return self.reading

    def exchange_ahead(self, goal_ticks: NDArray[np.int32] | None) -> BusReading:
        """Like `exchange`, but sends this cycle's request before it looks at the last cycle's answers.

        The wire is busy while they are parsed; what is returned is one cycle older. For groups that are one request.
        """
        if len(self._steps) != 1:
            return self.exchange(goal_ticks)
        request = (b"" if goal_ticks is None else self._goal_packet(goal_ticks)) + self._steps[0].request
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
            valid = self._valid_of_cycle()
            self._take_in_flight(valid)
            self._judge(valid)

    def _take_in_flight(self, valid: NDArray[np.bool_]) -> None:
        if self._in_flight is not None:
            (step, sent_s, n_bytes), self._in_flight = self._in_flight, None
            self._collect(step, sent_s, n_bytes)
            self._take(step, valid, sent_s)

    def _valid_of_cycle(self) -> NDArray[np.bool_]:
        self.reading.valid[:] = False
        return self.reading.valid

    def show_health(self, table: NDArray[np.void]) -> None:
        """Copy state and counters of each servo into (S,) `daemon.dynamixel.health.HEALTH`."""
        self.health.show(table)

    @property
    def withheld(self) -> NDArray[np.bool_]:
        """(S,) servos that get no goals until `verify`: silent for long, and a goal would switch their torque on."""
        return self.health.withheld

    def _goal_packet(self, goal_ticks: NDArray[np.int32]) -> bytes:
        withheld = self.health.withhold(self.reading.read_s, self.clock.now_s())
        if withheld.any():
            writes = self._writers("goal_position", ~withheld)
            return b"".join(write.frame(goal_ticks[rows]) for rows, write in writes)
        if len(self._goal_writes) == 1:
            return self._goal_writes[0][1].frame(goal_ticks)
        return b"".join(write.frame(goal_ticks[rows]) for rows, write in self._goal_writes)

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
        while len(raw) < need:  # after the deadline what has come meanwhile is still taken
            data = self._read(need - len(raw), max(0.0, deadline_s - now_s))
            raw += data
            now_s = self.clock.now_s()
            if not data or (len(raw) < need and step.ends(raw)):
                break
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
        elif len(self._raw) == step.reply_bytes:
            self.health.counters.crc[rows[~whole]] += 1
        if step.chained:
            silent = len(rows) - int(valid[rows][::-1].argmax()) if valid[rows].any() else 0
            if silent < len(rows) - 1:  # the last one silent takes nobody with it
                self._broke_at = int(rows[silent])
        self.reading.read_s[rows[valid[rows]]] = sent_s

    def _take_bytewise(self, step: Step, valid: NDArray[np.bool_], sent_s: float) -> None:
        """The byte parser over `_raw`; goes on reading when noise has taken the place of answers."""
        decoder = self._decoders[self._dialect(step).version]
        bad_before = decoder.bad_checksums + decoder.skipped_bytes
        deadline_s = sent_s + self.timing.longest_s(len(step.request) + step.reply_bytes, step.answers)
        data = bytes(self._raw)
        noise = (len(data) >= step.reply_bytes or self._echo) and self._in_flight is None  # what comes next is its own
        while True:
            for answer in decoder.feed(data):
                self._take_answer(step, answer, valid)
            missing = step.rows[~valid[step.rows]]
            left_s = deadline_s - self.clock.now_s()
            if not len(missing) or not noise or left_s <= 0 or step.ends(self._raw):
                break
            data = self._read(256, left_s)
            if not data:
                break
            self._raw += data
        self.health.counters.crc[missing] += decoder.bad_checksums + decoder.skipped_bytes > bad_before

    def _take_answer(self, step: Step, answer: Packet, valid: NDArray[np.bool_]) -> None:
        row = self._row.get(answer.servo_id)
        now_s = self.clock.now_s()
        if answer.servo_id == BROADCAST_ID and is_status(answer):
            return  # a fast answer, come late
        if not is_status(answer):
            text = f"instruction {answer.instruction:#04x} to servo {answer.servo_id} that we did not send"
            self.events.add(BusEventKind.FOREIGN_PACKET, now_s, text + ": another controller on the same wire")
        elif row is None or row not in step.rows:
            text = f"an answer of servo {answer.servo_id}, which was not asked; another controller, or a servo too many"
            self.events.add(BusEventKind.FOREIGN_PACKET, now_s, text)
        elif valid[row] and 0 < self.reading.age_cycles[row] < NEVER_CYCLES:
            step.store(row, answer, self.reading)  # the first was the last cycle's, come late
            self.health.came_late(row)
        elif valid[row]:
            text = f"servo {answer.servo_id} answered twice: two servos have this id; change one (mmmd servo id)"
            self.events.add(BusEventKind.DUPLICATE_ID, now_s, text, answer.servo_id)
        elif step.store(row, answer, self.reading):
            valid[row] = True

    def _finish_cycle(self, valid: NDArray[np.bool_]) -> None:
        self._judge(valid)
        if self._ask_beside():
            self._build_steps()

    def _judge(self, valid: NDArray[np.bool_]) -> None:
        """Ages, health, quarantine."""
        reading, now_s = self.reading, self.clock.now_s()
        broke_at, self._broke_at = self._broke_at, None
        if valid.all() and self._chained.at_ease and self.health.all_well(reading.error):
            reading.age_cycles[:] = 0
            return
        reading.age_cycles += 1
        reading.age_cycles[valid] = 0
        silent_before, alerts_before = self.health.asked.copy(), self.health.counters.alerts.copy()
        if self.health.after_cycle(valid, reading.error, now_s):
            for row in np.flatnonzero(silent_before & ~self.health.asked):
                text = (
                    f"servo {self.ids[row]} ({self.servos[row].joint_name}) is silent; asked once a second from now on"
                )
                self.events.add(BusEventKind.QUARANTINED, now_s, text, self.ids[row])
            self._chained.resume()
            self._build_steps()
        elif self._chained.after_cycle(broke_at):
            self._build_steps()
        for row in np.flatnonzero(self.health.counters.alerts > alerts_before):
            text = f"servo {self.ids[row]} ({self.servos[row].joint_name}) reports one"
            self.events.add(BusEventKind.HARDWARE_ERROR, now_s, text, self.ids[row])
        silent = np.flatnonzero(self.health.silent_at_once())
        if len(silent):
            ids = ", ".join(str(self.ids[i]) for i in silent)
            text = f"servos {ids} silent at once: power or a cable near the adapter"
            self.events.add(BusEventKind.BROWN_OUT, now_s, text)

    def _build_steps(self) -> None:
        rows = [i for i in range(len(self.ids)) if self.health.asked[i]]
        pick = [self.ids[i] for i in rows], [self.models[i] for i in rows], [self._fast[i] for i in rows]
        self._steps = steps_for(rows, *pick, chained=self._chained.used)

    def _dialect(self, step: Step) -> Dialect:
        return DIALECTS[1.0 if isinstance(step, Protocol1Step) else 2.0]
