"""The cycle of the servos on a link: goals out and measurements in, one exchange a cycle, each servo judged by itself."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daemon.dynamixel.chained_adapters import ChainedReads
from daemon.dynamixel.codec.dialect import DIALECTS, Dialect
from daemon.dynamixel.codec.packet import BROADCAST_ID, Packet
from daemon.dynamixel.events import BusEventKind
from daemon.dynamixel.feedback import FastSyncStep, Protocol1Step, Step, is_status, steps_for
from daemon.dynamixel.health_probe import HealthProbe
from daemon.dynamixel.register_access import RegisterAccess
from daemon.dynamixel.servo_link import ServoLink

TWICE_CYCLES = 3
"""Cycles in a row with two answers after which two servos are assumed to have the id. An occasional second answer is a late one of
an earlier cycle; two servos both answer every time.
"""


class FeedbackCycle:
    """Sends goals to the servos on a link and receives their measurements.

    Attributes:
        fast: (S,) whether a servo is read by fast sync reads, once `build_steps` was called.
        steps: the requests of a cycle.
    """

    def __init__(self, link: ServoLink, registers: RegisterAccess, probe: HealthProbe) -> None:
        self._link, self._registers, self._probe = link, registers, probe
        self.fast = [False] * len(link.ids)
        self._chained = ChainedReads()
        self._broke_at: int | None = None
        self._goal_writes = registers.writers("goal_position")
        self.steps: list[Step] = []
        self._begun: tuple[float, int] | None = None
        self._raw = bytearray()
        self._twice: set[int] = set()
        self._cycles_twice: dict[int, int] = {}
        self.build_steps()

    def begin(self, goal_ticks: NDArray[np.int32] | None) -> None:
        """Send goals (S,), none when None, and the first request, in one `write()`.

        Raises:
            LinkLostError: the device is gone.
        """
        goals = b"" if goal_ticks is None else self._goal_packet(goal_ticks)
        request = goals + self.steps[0].request if self.steps else goals
        self._begun = (self._link.send(request), len(request)) if request else None

    def finish(self) -> None:
        """Receive effort, velocity and position of every servo into the link's reading; judge each servo by itself.

        A servo that does not answer keeps its old values, marked not valid.

        Raises:
            LinkLostError: the device is gone.
        """
        valid = self._link.reading.valid
        valid[:] = False
        for i, step in enumerate(self.steps):
            if i > 0:
                self._begun = (self._link.send(step.request), len(step.request))
            assert self._begun is not None, "begin() comes before finish()"
            sent_s, n_bytes = self._begun
            self._link.collect(step, sent_s, n_bytes, self._raw)
            self._take(step, valid, sent_s)
        self._judge(valid)
        if self._probe.ask_beside():
            self.build_steps()

    @property
    def goal_bytes(self) -> int:
        """Number of bytes in the packets with the goals of all servos."""
        return sum(write.n_bytes for _, write in self._goal_writes)

    def resume(self) -> None:
        """Let all servos take part again: build the requests anew, chained reads included."""
        self._chained.resume()
        self.build_steps()

    def _goal_packet(self, goal_ticks: NDArray[np.int32]) -> bytes:
        withheld = self._link.health.withhold(self._link.reading.read_s, self._link.clock.now_s())
        if withheld.any():
            writes = self._registers.writers("goal_position", ~withheld)
            return b"".join(write.frame(goal_ticks[rows]) for rows, write in writes)
        if len(self._goal_writes) == 1:
            return self._goal_writes[0][1].frame(goal_ticks)
        return b"".join(write.frame(goal_ticks[rows]) for rows, write in self._goal_writes)

    def _take(self, step: Step, valid: NDArray[np.bool_], sent_s: float) -> None:
        """Store the answers in `_raw`."""
        whole = step.take(self._raw, self._link.reading)
        rows = step.rows
        if whole.all():
            valid[step.index] = True
            self._link.reading.read_s[step.index] = sent_s
            return
        valid[rows[whole]] = True
        if not isinstance(step, FastSyncStep):
            self._take_bytewise(step, valid, sent_s)
        elif len(self._raw) == step.reply_bytes:
            self._link.health.counters.crc[rows[~whole]] += 1
        if step.chained:
            silent = len(rows) - int(valid[rows][::-1].argmax()) if valid[rows].any() else 0
            if silent < len(rows) - 1:  # the last servo's silence silences no other
                self._broke_at = int(rows[silent])
        self._link.reading.read_s[rows[valid[rows]]] = sent_s

    def _take_bytewise(self, step: Step, valid: NDArray[np.bool_], sent_s: float) -> None:
        """Parse `_raw` byte by byte; read on when noise has replaced answers."""
        decoder = self._link.decoders[self._dialect(step).version]
        bad_before = decoder.bad_checksums + decoder.skipped_bytes
        deadline_s = sent_s + self._link.timing.longest_s(len(step.request) + step.reply_bytes, step.answers)
        data = bytes(self._raw)
        noise = len(data) >= step.reply_bytes or self._link.echoes
        while True:
            for answer in decoder.feed(data):
                self._take_answer(step, answer, valid)
            missing = step.rows[~valid[step.rows]]
            left_s = deadline_s - self._link.clock.now_s()
            if not len(missing) or not noise or left_s <= 0 or step.ends(self._raw):
                break
            data = self._link.read(256, left_s)
            if not data:
                break
            self._raw += data
        self._link.health.counters.crc[missing] += decoder.bad_checksums + decoder.skipped_bytes > bad_before

    def _take_answer(self, step: Step, answer: Packet, valid: NDArray[np.bool_]) -> None:
        row = self._link.row_by_id.get(answer.servo_id)
        now_s = self._link.clock.now_s()
        if answer.servo_id == BROADCAST_ID and is_status(answer):
            return  # a late answer to a fast read
        if not is_status(answer):
            text = f"instruction {answer.instruction:#04x} to servo {answer.servo_id} that we did not send"
            self._link.events.add(BusEventKind.FOREIGN_PACKET, now_s, text + ": another controller on the same wire")
        elif row is None or row not in step.rows:
            text = f"an answer of servo {answer.servo_id}, which was not asked; another controller, or a servo too many"
            self._link.events.add(BusEventKind.FOREIGN_PACKET, now_s, text)
        elif valid[row]:
            step.store(row, answer, self._link.reading)  # the first one was a late answer of an earlier cycle
            self._link.health.came_late(row)
            self._twice.add(row)
        elif step.store(row, answer, self._link.reading):
            valid[row] = True

    def _name_duplicates(self) -> None:
        """Report servos that have answered twice in each of the last cycles."""
        self._cycles_twice = {row: self._cycles_twice.get(row, 0) + 1 for row in sorted(self._twice)}
        self._twice.clear()
        for row in (row for row, n in self._cycles_twice.items() if n == TWICE_CYCLES):
            servo_id = self._link.ids[row]
            text = f"servo {servo_id} answers twice: two servos have this id; change one (mmmd servo id)"
            self._link.events.add(BusEventKind.DUPLICATE_ID, self._link.clock.now_s(), text, servo_id)

    def _judge(self, valid: NDArray[np.bool_]) -> None:
        """Update ages, health and quarantine, and find servos with the same id."""
        if self._twice or self._cycles_twice:
            self._name_duplicates()
        link, reading = self._link, self._link.reading
        health, now_s = link.health, link.clock.now_s()
        broke_at, self._broke_at = self._broke_at, None
        if valid.all() and self._chained.at_ease and health.all_well(reading.error):
            reading.age_cycles[:] = 0
            return
        reading.age_cycles += 1
        reading.age_cycles[valid] = 0
        silent_before, alerts_before = health.asked.copy(), health.counters.alerts.copy()
        if health.after_cycle(valid, reading.error, now_s):
            for row in np.flatnonzero(silent_before & ~health.asked):
                text = (
                    f"servo {link.ids[row]} ({link.servos[row].joint_name}) is silent; asked once a second from now on"
                )
                link.events.add(BusEventKind.QUARANTINED, now_s, text, link.ids[row])
            self._chained.resume()
            self.build_steps()
        elif self._chained.after_cycle(broke_at):
            self.build_steps()
        for row in np.flatnonzero(health.counters.alerts > alerts_before):
            text = f"servo {link.ids[row]} ({link.servos[row].joint_name}) reports one"
            link.events.add(BusEventKind.HARDWARE_ERROR, now_s, text, link.ids[row])
        silent = np.flatnonzero(health.silent_at_once())
        if len(silent):
            ids = ", ".join(str(link.ids[i]) for i in silent)
            text = f"servos {ids} silent at once: power or a cable near the adapter"
            link.events.add(BusEventKind.BROWN_OUT, now_s, text)

    def build_steps(self) -> None:
        """Build the requests of a cycle from the servos that take part in it."""
        rows = [i for i in range(len(self._link.ids)) if self._link.health.asked[i]]
        pick = [self._link.ids[i] for i in rows], [self._link.models[i] for i in rows], [self.fast[i] for i in rows]
        self.steps = steps_for(rows, *pick, chained=self._chained.used)

    def _dialect(self, step: Step) -> Dialect:
        return DIALECTS[1.0 if isinstance(step, Protocol1Step) else 2.0]
