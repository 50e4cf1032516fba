"""What is asked of single servos beside the exchange: slow registers in turn, and whether one that was left out is back."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from daemon.dynamixel.events import BusEventKind
from daemon.dynamixel.ports.port import Port
from daemon.dynamixel.register_access import Items
from daemon.dynamixel.registers.models import BusModel
from daemon.dynamixel.servo_link import TRIES
from daemon.dynamixel.slow_registers import SlowReader, Span
from daemon.dynamixel.timing import MARGIN_S
from daemon.errors import LinkTimeoutError, ServoFaultError, two_of
from daemon.host.clock import Clock
from retarget.robot.robot import ServoSpec


class Probing(Items):
    """Single questions of a cycle; see `ServoBus`."""

    def __init__(
        self, port: Port, servos: Sequence[ServoSpec], clock: Clock, *, margin_s: float = MARGIN_S, slow_every: int = 0
    ) -> None:
        super().__init__(port, servos, clock, margin_s=margin_s)
        self._slow = SlowReader(self.models)
        self._slow_every, self._cycle = slow_every, 0
        self._garbled_probes = np.zeros(len(self.ids), np.int32)
        self._own = [_own_values(m) for m in self.models]

    def look_for_collisions(self, servo_ids: Sequence[int]) -> list[int]:
        """Those of these ids whose answers come garbled each time they are asked: two servos have them, or there is noise.

        Two servos of a kind say the same to a ping, and the same bytes at the same time are heard as one; what they
        measure differs.
        """
        for servo_id in servo_ids:
            row = self._row_of(servo_id)
            own = self._own[row]
            try:
                self._ask(self._of(row).read(servo_id, own.address, own.length), row, own.length)
            except (LinkTimeoutError, ServoFaultError):
                continue
        return [i for i in self.ids if self._garbled_rows[self._row[i]]]

    def _ask_beside(self) -> bool:
        """The single question of this cycle, if any; True when a servo takes part again."""
        self._cycle += 1
        now_s = self.clock.now_s()
        row = self.health.probe_due(now_s)
        if row is not None:
            return self._probe(row)
        if self._slow_every and self._cycle % self._slow_every == 0:
            self._read_slow()
        return False

    def _probe(self, row: int) -> bool:
        """Ask a quarantined servo whether it is back, and whether it is what it was; True when it takes part again."""
        servo_id, own = self.ids[row], self._own[row]
        name = f"servo {servo_id} ({self.servos[row].joint_name})"
        try:
            request = self._of(row).read(servo_id, own.address, own.length)
            back = self._ask_once(request, row, own.length, self.timing.margin_s) is not None
            self._note_garbled(row, name)
            if back and self._torque_expected and self.poll_item(servo_id, "torque_enable") != 1:
                self._note_reboot(row)
        except ServoFaultError:
            back = True
        self.health.probed(row, answered=back, now_s=self.clock.now_s())
        if back:
            self.events.add(BusEventKind.RETURNED, self.clock.now_s(), f"{name} answers again", servo_id)
        return back

    def _note_garbled(self, row: int, name: str) -> None:
        """Bytes, again and again, and no answer, where one servo should speak and the others are understood."""
        alone = self._garbled and (len(self.ids) == 1 or bool(self.reading.valid.any()))
        self._garbled_probes[row] = self._garbled_probes[row] + 1 if alone else 0
        if self._garbled_probes[row] >= TRIES:
            text = f"{name}: its answers collide: {two_of(self.ids[row])}"
            self.events.add(BusEventKind.DUPLICATE_ID, self.clock.now_s(), text, self.ids[row])

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


def _own_values(model: BusModel) -> Span:
    """What no two servos measure alike: position, voltage, temperature."""
    temperatures = (t.present for t in model.thermometers)
    return Span.of(model.table, "present_position", "present_input_voltage", *temperatures)
