"""Faults on a schedule: the kind, the time, the place and the repetition of each; drawn from a seed, so that they can be repeated.

A TOML file of [[fault]] tables. By time (`start_s`, `end_s`), by packet (`first_packet`, `last_packet`: status packets
counted from 1), by servo (`servo_id`), by probability (of each packet, from `seed`). Kinds that happen at an instant happen
at `start_s`, and again every `every_s` when that is given.
"""

from __future__ import annotations

import logging
import math
import random
import tomllib
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import msgspec

from sim.errors import FaultFileError

log = logging.getLogger(__name__)

PACKET_KINDS = {
    "drop": "a status packet is lost",
    "corrupt": "one bit of a status packet is wrong",
    "delay": "a status packet comes `amount` seconds late (default 0.005)",
    "duplicate": "a status packet comes twice",
    "truncate": "a status packet ends early; `amount` bytes are left (default: half)",
    "split": "a status packet comes in two pieces, `amount` seconds apart (default 0.001)",
    "wrong_id": "a status packet carries another id",
    "noise": "`amount` random bytes before a status packet (default 8)",
    "collision": "somebody else talks while a status packet is sent: its bytes are garbled",
    "foreign": "a whole packet of a servo that nobody asked comes first",
    "deaf": "a servo does not hear an instruction",
}
STATE_KINDS = {
    "silent": "a servo does not answer",
    "unplug": "the adapter is gone; back at `end_s`, as `path` when that is given",
    "brown_out": "the supply, or one servo's plug, gives `amount` of its voltage (default 0.3): too little resets servos",
    "stuck": "a shaft is blocked",
    "push": "an external torque of `amount` N m on a shaft",
    "echo": "the adapter hears what it sends",
}
INSTANT_KINDS = {
    "overload": "a servo latches an overload",
    "trip": "the same",
    "encoder": "a servo latches an encoder error",
    "hot": "a servo is at `amount` degrees C at once (default 90)",
    "reboot": "a servo restarts by itself",
    "slip": "a gear slips by `amount` ticks (default 100)",
    "clock_jump": "the client's clock jumps by `amount` seconds (default 1.0); in virtual time only",
}
KINDS = PACKET_KINDS | STATE_KINDS | INSTANT_KINDS
_OF_THE_WIRE = ("unplug", "echo", "clock_jump")
_SIGNED = ("push", "slip", "clock_jump", "hot")
_BY_PACKET = (*PACKET_KINDS, "silent")
_ONLY_FOR = {
    "probability": tuple(PACKET_KINDS),
    "servo_id": tuple(kind for kind in KINDS if kind not in _OF_THE_WIRE),
    "first_packet": _BY_PACKET,
    "last_packet": _BY_PACKET,
    "amount": ("delay", "truncate", "split", "noise", "brown_out", *_SIGNED),
    "every_s": tuple(INSTANT_KINDS),
    "path": ("unplug",),
}
"""For each key the kinds of faults that it applies to; with another kind the key is refused, as it would have no effect."""


class Fault(msgspec.Struct, forbid_unknown_fields=True):
    """One fault.

    Attributes:
        kind: one of `KINDS`.
        start_s, end_s: seconds after the simulator's start at which the fault begins and ends.
        probability: probability for each packet, 0 to 1, for kinds that strike packets.
        servo_id: only this servo; None for all.
        first_packet, last_packet: only these status packets, counted from 1.
        amount: size of the fault in the unit of its kind; None for the kind's default.
        every_s: seconds after which an instant fault repeats, until `end_s`.
        path: link under which the tty comes back after an unplug.
    """

    kind: str
    start_s: float = 0.0
    end_s: float = float("inf")
    probability: float = 1.0
    servo_id: int | None = None
    first_packet: int = 1
    last_packet: int | None = None
    amount: float | None = None
    every_s: float | None = None
    path: str | None = None

    def strikes_packet(self, number: int) -> bool:
        """Whether the fault applies to status packet `number`."""
        return self.first_packet <= number and (self.last_packet is None or number <= self.last_packet)


_PLAIN = Fault("drop")


class _Table(msgspec.Struct, forbid_unknown_fields=True):
    fault: list[Fault]
    seed: int = 0


def _problem(fault: Fault) -> tuple[str, str, str] | None:
    """(key, found, allowed) of the first wrong value of a fault; None when all are valid."""
    for key in ("start_s", "end_s", "probability", "amount", "every_s"):
        value = getattr(fault, key)
        if value is not None and math.isnan(value):
            return key, "nan", "a number"
    if fault.kind not in KINDS:
        return "kind", f"'{fault.kind}'", ", ".join(KINDS)
    if fault.start_s < 0:
        return "start_s", f"{fault.start_s:g}", "0 or more"
    if fault.end_s <= fault.start_s:
        return "end_s", f"{fault.end_s:g}", f"more than start_s = {fault.start_s:g}"
    if not 0 <= fault.probability <= 1:
        return "probability", f"{fault.probability:g}", "0 to 1"
    if fault.servo_id is not None and not 0 <= fault.servo_id <= 252:
        return "servo_id", str(fault.servo_id), "0 to 252"
    if fault.first_packet < 1 or (fault.last_packet is not None and fault.last_packet < fault.first_packet):
        return "first_packet", f"{fault.first_packet} to {fault.last_packet}", "1 or more, and not after last_packet"
    if fault.every_s is not None and fault.every_s <= 0:
        return "every_s", f"{fault.every_s:g}", "more than 0"
    if fault.amount is not None and fault.kind not in _SIGNED and fault.amount < 0:
        return "amount", f"{fault.amount:g} for '{fault.kind}'", "0 or more"
    for key, kinds in _ONLY_FOR.items():
        value = getattr(fault, key)
        if value != getattr(_PLAIN, key) and fault.kind not in kinds:
            found = repr(value) if isinstance(value, str) else f"{value:g}"
            return key, f"{found} for '{fault.kind}'", f"only for {', '.join(kinds)}"
    return None


@dataclass
class FaultSchedule:
    """The faults in force at a time. Same seed, same faults.

    Attributes:
        struck: number of times that each kind has struck so far.
    """

    faults: tuple[Fault, ...] = ()
    seed: int = 0
    struck: Counter[str] = field(default_factory=Counter[str])

    def __post_init__(self) -> None:
        """Check every fault, start the random numbers, sort by time."""
        for i, fault in enumerate(self.faults, 1):
            if problem := _problem(fault):
                raise FaultFileError("fault schedule", f"fault {i}: {problem[0]}", problem[1], problem[2])
        self.random = random.Random(self.seed)
        self.packet = 0
        self.strikes_packets = False
        """Whether any fault of the wire is in force; without one no packet has to be examined."""
        self._waiting = sorted(self.faults, key=lambda f: f.start_s, reverse=True)
        self._now: dict[str, list[Fault]] = {}
        self._repeats: list[tuple[float, Fault]] = []
        self._ends_s = math.inf
        self._next_s = self._waiting[-1].start_s if self._waiting else math.inf

    @classmethod
    def load(cls, path: Path) -> FaultSchedule:
        """Read a TOML file of [[fault]] tables.

        Raises:
            FaultFileError: the file is missing, or a key or value is wrong.
        """
        keys = f"seed, and [[fault]] with {', '.join(Fault.__struct_fields__)}"
        try:
            table = msgspec.convert(tomllib.loads(path.read_text("utf-8")), _Table)
        except OSError as error:
            raise FaultFileError(path, "file", error.strerror or str(error), "TOML with [[fault]] tables") from None
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise FaultFileError(path, "file", f"not TOML ({error})", keys) from error
        except msgspec.ValidationError as error:
            message, _, where = str(error).partition(" - at `$")
            raise FaultFileError(path, where.strip("`.") or "file", message, keys) from error
        try:
            return cls(tuple(table.fault), table.seed)
        except FaultFileError as error:
            raise FaultFileError(path, error.where, error.found, error.allowed) from None

    def check_servos(self, known: Collection[int]) -> None:
        """Refuse faults of servos that do not exist: they would never strike.

        Raises:
            FaultFileError: a `servo_id` that is not among the `known` ones.
        """
        for i, fault in enumerate(self.faults, 1):
            if fault.servo_id is not None and fault.servo_id not in known:
                allowed = ", ".join(map(str, sorted(known)))
                raise FaultFileError("fault schedule", f"fault {i}: servo_id", str(fault.servo_id), allowed)

    def begin(self, t_s: float) -> list[Fault]:
        """Faults that begin by `t_s` and were not returned before; an instant fault again each time that it repeats."""
        if t_s < self._next_s and t_s < self._ends_s:
            return []
        begun: list[Fault] = []
        while self._waiting and self._waiting[-1].start_s <= t_s:
            fault = self._waiting.pop()
            log.info("%.3f s: %s", fault.start_s, describe(fault))
            begun.append(fault)
            if fault.kind in INSTANT_KINDS:
                self.struck[fault.kind] += 1
                if fault.every_s is not None:
                    self._repeats.append((fault.start_s + fault.every_s, fault))
            else:
                self._now.setdefault(fault.kind, []).append(fault)
                if fault.kind in STATE_KINDS:
                    self.struck[fault.kind] += 1
        for i, (due_s, fault) in enumerate(self._repeats):
            if due_s <= t_s and fault.every_s is not None:
                self._repeats[i] = (due_s + fault.every_s, fault)
                self.struck[fault.kind] += 1
                begun.append(fault)
        self._repeats = [(due_s, f) for due_s, f in self._repeats if due_s < f.end_s]
        for kind, active in list(self._now.items()):
            self._now[kind] = [f for f in active if f.end_s > t_s]
        self.strikes_packets = any(self._now.get(kind) for kind in (*PACKET_KINDS, "silent"))
        self._ends_s = min((f.end_s for active in self._now.values() for f in active), default=math.inf)
        starts = [self._waiting[-1].start_s] if self._waiting else []
        self._next_s = min(starts + [due_s for due_s, _ in self._repeats], default=math.inf)
        return begun

    def active(self, kind: str, t_s: float, servo_id: int | None = None) -> Fault | None:
        """The fault of this kind that strikes now, or None; a fault with a probability is drawn again at each call."""
        for fault in self._now.get(kind, ()):
            mine = fault.servo_id is None or fault.servo_id == servo_id
            if mine and fault.start_s <= t_s < fault.end_s and fault.strikes_packet(max(1, self.packet)):
                if fault.probability >= 1 or self.random.random() < fault.probability:
                    if kind in PACKET_KINDS:
                        self.struck[kind] += 1
                    return fault
        return None

    def in_force(self, kind: str) -> Sequence[Fault]:
        """Faults of a lasting kind that were in force at the last `begin`."""
        return self._now.get(kind, ())


def describe(fault: Fault) -> str:
    """A fault in words, for logs."""
    whom = "" if fault.servo_id is None else f" servo {fault.servo_id}"
    how_much = "" if fault.amount is None else f" {fault.amount:g}"
    often = "" if fault.probability >= 1 else f" with probability {fault.probability:g}"
    until = "" if math.isinf(fault.end_s) else f" until {fault.end_s:g} s"
    return f"fault {fault.kind}{whom}{how_much}{often}{until}"
