"""Faults on a schedule: what goes wrong on the wire, when, by time and by probability with a seed."""

from __future__ import annotations

import random
import tomllib
from dataclasses import dataclass
from pathlib import Path

import msgspec

from daemon.errors import ConfigError


class Fault(msgspec.Struct, forbid_unknown_fields=True):
    """One fault.

    Attributes:
        kind: drop (a reply is lost), corrupt (one byte of a reply is wrong), silent (a servo does not answer), trip (a
            servo latches an overload), unplug (the device is gone).
        start_s, end_s: from when to when, seconds after the simulator started.
        probability: for drop and corrupt, of each reply.
        servo_id: only this servo; None for all.
    """

    kind: str
    start_s: float = 0.0
    end_s: float = float("inf")
    probability: float = 1.0
    servo_id: int | None = None


_KINDS = ("drop", "corrupt", "silent", "trip", "unplug")


class _Table(msgspec.Struct, forbid_unknown_fields=True):
    fault: list[Fault]
    seed: int = 0


@dataclass
class FaultSchedule:
    """The faults in force at a time. Same seed, same faults."""

    faults: tuple[Fault, ...] = ()
    seed: int = 0

    def __post_init__(self) -> None:
        """Check the kinds and start the random numbers."""
        for fault in self.faults:
            if fault.kind not in _KINDS:
                raise ConfigError(f"fault kind '{fault.kind}'; allowed: {', '.join(_KINDS)}")
        self._random = random.Random(self.seed)

    @classmethod
    def load(cls, path: Path) -> FaultSchedule:
        """Read a TOML file of [[fault]] tables.

        Raises:
            ConfigError: the file is missing or has a wrong key or kind.
        """
        try:
            table = msgspec.convert(tomllib.loads(path.read_text("utf-8")), _Table)
        except FileNotFoundError:
            raise ConfigError(f"{path}: no such file; a fault schedule is TOML with [[fault]] tables") from None
        except (tomllib.TOMLDecodeError, msgspec.ValidationError, UnicodeDecodeError) as error:
            raise ConfigError(
                f"{path}: {error}; keys of a [[fault]]: kind, start_s, end_s, probability, servo_id"
            ) from error
        return cls(tuple(table.fault), table.seed)

    def active(self, kind: str, t_s: float, servo_id: int | None = None) -> bool:
        """Whether a fault of this kind strikes now (drawn anew at each call)."""
        for fault in self.faults:
            mine = fault.servo_id is None or fault.servo_id == servo_id
            if fault.kind == kind and fault.start_s <= t_s < fault.end_s and mine:
                if fault.probability >= 1 or self._random.random() < fault.probability:
                    return True
        return False

    def spoil(self, reply: bytes, t_s: float, servo_id: int) -> bytes:
        """The reply as it arrives: whole, empty or with a wrong byte."""
        if self.active("silent", t_s, servo_id) or self.active("drop", t_s, servo_id):
            return b""
        if reply and self.active("corrupt", t_s, servo_id):
            at = self._random.randrange(len(reply))
            return reply[:at] + bytes([reply[at] ^ (1 << self._random.randrange(8))]) + reply[at + 1 :]
        return reply
