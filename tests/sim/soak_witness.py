"""What the daemon said of each fault of a soak, against a table of what it has to say.

Its own log is listened to, never the simulator's. A fault that other ones overlap may be named as theirs; one without a
consequence may pass unnoticed, and `EXPECTED` says which that are.
"""

from __future__ import annotations

import logging
import re
from collections import Counter, deque
from collections.abc import Sequence
from dataclasses import dataclass

from daemon.dynamixel.registers.registers import WATCHDOG_TRIPPED
from daemon.shared_memory.bus_link import BusState
from sim.faults import PACKET_KINDS, Fault
from tests.support.rig import Rig

NAMED_WITHIN_S = 3.0
"""After a fault's end; each of sixteen servos is asked for its torque once in 0.8 s, a silent one once in a second."""
TOLD_AGAIN_S = 5.0
"""What was said within so long before is not repeated (`EventLog.QUIET_S`)."""
STRUCK_OFTEN = 20
"""Packets after which the counters have to show it; a few may have hit answers that are asked for only now and then."""
STOPPED_S = 5.0
"""No servo stands limp or stopped for so long, and answers, while the robot is said to hold or play."""
_KEPT, _MAX_DETAILS = 5000, 20
_WELL = (BusState.HOLDING, BusState.PLAYING)

SILENT = r"silent|did not answer|no answer|no fresh position|lost (its )?torque|not those of the robot file"
COUNTED = ""
"""Seen in the counters of servos and events."""
UNNOTICED = None


@dataclass(frozen=True)
class Expected:
    """What the daemon says of a kind of fault.

    Attributes:
        words: a pattern that a warning or error of its log has to match; COUNTED, or UNNOTICED for nothing at all.
        of_servo: whether the same line names the servo, if it is a fault of one.
        why: may it pass unnoticed, the reason.
    """

    words: str | None
    of_servo: bool = True
    why: str = ""


_FEW = f"a fault that struck fewer than {STRUCK_OFTEN} packets may have hit answers that are asked for now and then"
EXPECTED: dict[str, Expected] = {
    "unplug": Expected(r"lost", of_servo=False),
    "brown_out": Expected(SILENT + r"|brown-out", of_servo=False, why="a dip shorter than servos need to notice resets none"),
    "silent": Expected(SILENT),
    "reboot": Expected(SILENT),
    "overload": Expected(r"hardware error|overload"),
    "encoder": Expected(r"hardware error|encoder"),
    "hot": Expected(r"hardware error|overheating|temperature"),
    "stuck": Expected(r"hardware error|overload", why="blocked where it stands, or freed before it overloads, it trips nothing"),
    "slip": Expected(UNNOTICED, why="a gear that slips by a few ticks is pulled back by the servo itself"),
    "drop": Expected(COUNTED, why=_FEW),
    "corrupt": Expected(COUNTED, why=_FEW),
    "truncate": Expected(COUNTED, why=_FEW),
    "collision": Expected(COUNTED, why=_FEW),
    "wrong_id": Expected(COUNTED, why=_FEW),
    "foreign": Expected(COUNTED, why=_FEW),
    "deaf": Expected(COUNTED, why=_FEW),
    "delay": Expected(UNNOTICED, why="half a period late is in time where the cycle is short"),
    "duplicate": Expected(UNNOTICED, why="the second answer is the first one over again"),
    "split": Expected(UNNOTICED, why="an answer in two pieces is an answer"),
    "noise": Expected(UNNOTICED, why="bytes before an answer are passed over"),
}  # fmt: skip

WHOLLY_DEAF = Expected(SILENT)
"""Deaf to every packet, and for longer than it takes to be missed."""


def expected_of(fault: Fault) -> Expected:
    """What the daemon has to say of a fault."""
    return WHOLLY_DEAF if fault.kind == "deaf" and fault.probability == 1.0 else EXPECTED[fault.kind]


@dataclass(frozen=True)
class _Case:
    """A fault that has begun, and what was before."""

    fault: Fault
    due_s: float
    state: str
    counted: int
    struck: int


class Witness(logging.Handler):
    """Listens to the daemon while faults come and go; `look` once in every cycle.

    Attributes:
        named: faults the daemon named, by kind.
        unnoticed: faults that it could pass over, and did.
        overlapped: faults that it did not name while another was there.
        unnamed: faults that it should have named, in words.
        stopped: servos limp or stopped by their watchdog in a robot that is said to be well, in words.
    """

    def __init__(self, r: Rig, faults: Sequence[Fault]) -> None:
        super().__init__(logging.WARNING)
        self._r, self._faults = r, faults
        self._waiting = deque(sorted(faults, key=lambda f: f.start_s))
        self._open: list[_Case] = []
        self._said: deque[tuple[float, str]] = deque(maxlen=_KEPT)
        self._stands_since_s: dict[tuple[int, str], float] = {}
        self._state = r.state.name
        self.named, self.unnoticed, self.overlapped = Counter[str](), Counter[str](), Counter[str]()
        self.unnamed: list[str] = []
        self.stopped: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        """Keep what was said, and when."""
        self._said.append((self._r.clock.true_s, record.getMessage()))

    def look(self) -> None:
        """See which faults have begun and which should have been named by now."""
        now_s = self._r.clock.true_s
        while self._waiting and self._waiting[0].start_s <= now_s:
            fault = self._waiting.popleft()
            due_s = (fault.start_s if fault.end_s == float("inf") else fault.end_s) + NAMED_WITHIN_S
            self._open.append(_Case(fault, due_s, self._state, self._counted(), self._struck(fault)))
        for case in [case for case in self._open if case.due_s <= now_s]:
            self._open.remove(case)
            self._judge(case)
        self._state = self._r.state.name
        self._look_for_stopped(now_s)

    def _judge(self, case: _Case) -> None:
        fault, expected = case.fault, expected_of(case.fault)
        if expected.words == COUNTED:
            struck = self._struck(fault) - case.struck
            seen, must = self._counted() > case.counted, struck >= STRUCK_OFTEN
        else:
            struck, seen = self._latched(fault), self._was_said(case, expected)
            must = expected.words is not UNNOTICED and (struck or not expected.why)
        if seen:
            self.named[fault.kind] += 1
        elif not must:
            self.unnoticed[fault.kind] += 1
        elif self._is_overlapped(case):
            self.overlapped[fault.kind] += 1
        else:
            self.unnamed.append(f"{fault} in {case.state}: not named; {struck=}")

    def _was_said(self, case: _Case, expected: Expected) -> bool:
        words = expected.words
        if words is None:
            return False
        of_servo = expected.of_servo and case.fault.servo_id is not None
        servo = rf"servos? [^;:]*?\b{case.fault.servo_id}\b|^\s+{case.fault.servo_id}\s"
        return any(
            re.search(words, text) and (not of_servo or re.search(servo, text, re.MULTILINE))
            for t_s, text in self._said
            if case.fault.start_s - TOLD_AGAIN_S <= t_s <= case.due_s
        )

    def _is_overlapped(self, case: _Case) -> bool:
        """Whether another fault, or the time that it takes to be over it, lies in the time of this one."""
        for other in self._faults:
            ends_s = (other.start_s if other.end_s == float("inf") else other.end_s) + NAMED_WITHIN_S
            if other is not case.fault and other.start_s < case.due_s and case.fault.start_s < ends_s:
                return True
        return False

    def _latched(self, fault: Fault) -> bool:
        """Whether a fault that may trip a servo, or dip its supply, has done so, in truth."""
        meant = [s for s in self._r.sim.world.all if fault.servo_id in (None, s.spec.servo_id)]
        return any(s.alert() or s.silent_until_s > fault.start_s for s in meant)

    def _struck(self, fault: Fault) -> int:
        return self._r.sim.faults.struck[fault.kind] if fault.kind in PACKET_KINDS else 0

    def _counted(self) -> int:
        c = self._r.bus.chains[0].link.health.counters
        servos = sum(int(n.sum()) for n in (c.timeouts, c.crc, c.late, c.retries, c.alerts))
        return servos + sum(self._r.bus.chains[0].link.events.counts.values())

    def _look_for_stopped(self, now_s: float) -> None:
        """Servos that stand limp, or stopped by their own watchdog, in a robot that holds or plays."""
        for row, servo in enumerate(self._r.sim.servos.values()):
            tripped = "bus_watchdog" in servo.items and servo.memory.get("bus_watchdog") == WATCHDOG_TRIPPED
            for what, is_so in (("limp", not servo.torque), ("stopped by its watchdog", tripped)):
                key = (servo.spec.servo_id, what)
                if not (is_so and self._r.state in _WELL and self._r.bus.reading.valid[row]):
                    self._stands_since_s.pop(key, None)
                elif (
                    now_s - self._stands_since_s.setdefault(key, now_s) > STOPPED_S and len(self.stopped) < _MAX_DETAILS
                ):
                    self.stopped.append(
                        f"{now_s:.2f} s: servo {key[0]} {what} for {STOPPED_S:g} s in {self._r.state.name}"
                    )
                    self._stands_since_s[key] = now_s
