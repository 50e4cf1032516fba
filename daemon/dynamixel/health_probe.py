"""Requests to single servos beside the exchange: slow registers in turn, and whether a quarantined servo is back."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from daemon.dynamixel.events import BusEventKind
from daemon.dynamixel.register_access import RegisterAccess
from daemon.dynamixel.registers.models import BusModel
from daemon.dynamixel.servo_link import TRIES, ServoLink
from daemon.dynamixel.slow_registers import SlowReader, Span
from daemon.errors import LinkTimeoutError, ServoFaultError, two_of


class HealthProbe:
    """Requests to single servos within a cycle.

    Args:
        link: link to the servos.
        registers: access to the items of these servos.
        slow_every: read torque, hardware error, voltage and temperature of one servo, in turn, every so many cycles; 0 never.

    Attributes:
        slow: reader of the slow registers.
        slow_every: see above.
    """

    def __init__(self, link: ServoLink, registers: RegisterAccess, slow_every: int = 0) -> None:
        self._link, self._registers = link, registers
        self.slow, self.slow_every = SlowReader(link.models), slow_every
        self._cycle = 0
        self._garbled_probes = np.zeros(len(link.ids), np.int32)
        self._own = [_own_values(m) for m in link.models]

    def look_for_collisions(self, servo_ids: Sequence[int]) -> list[int]:
        """The ids whose answers are corrupted in every attempt: two servos have the id, or there is noise.

        Two servos of a kind answer a ping with the same bytes, and the same bytes at the same time are received as one answer;
        their measured values differ.
        """
        for servo_id in servo_ids:
            row = self._link.row_of(servo_id)
            own = self._own[row]
            try:
                self._link.ask(self._link.dialect(row).read(servo_id, own.address, own.length), row, own.length)
            except (LinkTimeoutError, ServoFaultError):
                continue
        return [i for i in self._link.ids if self._link.garbled_rows[self._link.row_by_id[i]]]

    def ask_beside(self) -> bool:
        """Send the single request of this cycle, if any; return whether a servo takes part again."""
        self._cycle += 1
        now_s = self._link.clock.now_s()
        row = self._link.health.probe_due(now_s)
        if row is not None:
            return self._probe(row)
        if self.slow_every and self._cycle % self.slow_every == 0:
            self._read_slow()
        return False

    def _probe(self, row: int) -> bool:
        """Ask a quarantined servo whether it is back with its old identity; return whether it takes part again."""
        servo_id, own = self._link.ids[row], self._own[row]
        name = f"servo {servo_id} ({self._link.servos[row].joint_name})"
        try:
            request = self._link.dialect(row).read(servo_id, own.address, own.length)
            back = self._link.ask_once(request, row, own.length, self._link.timing.margin_s) is not None
            self._note_garbled(row, name)
            if back and self._link.torque_expected and self._registers.poll_item(servo_id, "torque_enable") != 1:
                self._note_reboot(row)
        except ServoFaultError:
            back = True
        self._link.health.probed(row, answered=back, now_s=self._link.clock.now_s())
        if back:
            self._link.events.add(BusEventKind.RETURNED, self._link.clock.now_s(), f"{name} answers again", servo_id)
        return back

    def _note_garbled(self, row: int, name: str) -> None:
        """Report repeated bytes without a valid answer from one servo, when the others are understood."""
        alone = self._link.garbled and (len(self._link.ids) == 1 or bool(self._link.reading.valid.any()))
        self._garbled_probes[row] = self._garbled_probes[row] + 1 if alone else 0
        if self._garbled_probes[row] >= TRIES:
            text = f"{name}: its answers collide: {two_of(self._link.ids[row])}"
            self._link.events.add(BusEventKind.DUPLICATE_ID, self._link.clock.now_s(), text, self._link.ids[row])

    def _note_reboot(self, row: int) -> None:
        self._link.health.faulted[row] = True
        name = f"servo {self._link.ids[row]} ({self._link.servos[row].joint_name})"
        now_s, n_lost = self._link.clock.now_s(), int(self._link.health.faulted.sum())
        text = f"{name} has lost torque and settings; to be armed anew"
        self._link.events.add(BusEventKind.REBOOTED, now_s, text, self._link.ids[row])
        if 2 * n_lost >= len(self._link.ids) > 2:
            text = f"{n_lost} of {len(self._link.ids)} servos have lost their torque: the supply voltage broke down"
            self._link.events.add(BusEventKind.BROWN_OUT, now_s, text)

    def _read_slow(self) -> None:
        """Read the slow registers of the next servo in turn, and report events that they show."""
        row = self.slow.next_row(self._link.health.asked)
        if row is None:
            return
        request, length = self.slow.request(row, self._link.ids[row])
        asked_s = self._link.clock.now_s()
        try:
            answer = self._link.ask_once(request, row, length, self._link.timing.margin_s)
        except ServoFaultError:
            answer = None
        if answer is None:
            return
        if not self.slow.store(row, answer, self._link.reading):
            self._note_reboot(row)
            return
        self._link.reading.slow_read_s[row] = asked_s
        if self._link.torque_expected and self._link.reading.torque[row] == 0 and not self._link.health.faulted[row]:
            self._note_reboot(row)


def _own_values(model: BusModel) -> Span:
    """The registers whose values differ between two servos: position, voltage, temperature."""
    temperatures = (t.present for t in model.thermometers)
    return Span.of(model.table, "present_position", "present_input_voltage", *temperatures)
