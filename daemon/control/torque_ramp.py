"""The torque ramp after arming: the servos' effort limit rises from a share to the whole. A tripped servo gets no write.

On protocol 1.0 the ramp writes `torque_limit`, which also clears an alarm, and a goal switches torque on: a servo that
trips unseen between its last answer and the next step would come back with the next goal. So while the ramp lasts these
servos get no goals (they hold their pinned ones), and at its end each must report that it still has its torque.
"""

from __future__ import annotations

from daemon.dynamixel.codec.packet import ALERT_BIT
from daemon.dynamixel.servo_bus import ServoBus
from daemon.errors import ServoFaultError

EFFORT_START = 250 / 885
"""Share of full effort when torque comes on (of goal PWM; on protocol 1.0 of the torque limit)."""
RAMP_S = 0.6
"""Seconds until the effort limit is full."""
STEP_CYCLES = 5
"""Bus cycles from one step of the ramp to the next."""


class TorqueRamp:
    """Raises the effort of all servos in steps, one call a cycle.

    Args:
        bus: the servos.
        period_s: seconds between two calls.
    """

    def __init__(self, bus: ServoBus, period_s: float) -> None:
        self._bus = bus
        self._rise = (1.0 - EFFORT_START) * STEP_CYCLES * period_s / RAMP_S
        self._by_torque_limit = [i for i, m in zip(bus.ids, bus.models, strict=True) if m.protocol == 1.0]
        self._share, self._cycle = 1.0, 0
        self._proved = True

    @property
    def holds_goals(self) -> bool:
        """Whether no goal may be sent yet: it could give a servo of protocol 1.0 its torque back."""
        return not self._proved

    def begin(self) -> None:
        """Start the ramp at `EFFORT_START`; torque has just come on."""
        self._share, self._cycle = EFFORT_START, 0
        self._proved = not self._by_torque_limit

    def step(self) -> None:
        """Run one cycle of the ramp; does nothing once the ramp is over, and nothing while an answer carries an alarm.

        Raises:
            ServoFaultError: a servo has lost its torque during the ramp.
            LinkError: a servo does not say whether it has torque, or the port is gone.
        """
        self._cycle += 1
        if self._cycle % STEP_CYCLES or (self._bus.reading.error & ALERT_BIT).any():
            return
        if self._share < 1.0:
            self._share = min(1.0, self._share + self._rise)
            self._bus.set_effort(self._share)
        elif not self._proved:
            self._prove()

    def _prove(self) -> None:
        for servo_id in self._by_torque_limit:
            found = self._bus.read_items(servo_id, ("torque_enable", "torque_limit"))
            if not all(found.values()):
                text = ", ".join(f"{name} {value}" for name, value in found.items())
                raise ServoFaultError(servo_id, "to keep its torque while it was ramped up", f"{text}: it has tripped")
        self._proved = True
