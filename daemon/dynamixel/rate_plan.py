"""The time budget of a bus cycle, and the rate that it allows: bytes on the wire, return delays, turnarounds.

    cycle = bytes * 10 / baud + answers * return delay + requests * turnaround

A rate is refused when wire and return delays alone do not fit its period; measured turnarounds may make it tight.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from daemon.dynamixel.codec.group import GroupWrite, GroupWrite1
from daemon.dynamixel.feedback import Step, steps_for
from daemon.dynamixel.registers.models import BusModel
from daemon.dynamixel.timing import BITS_PER_BYTE
from daemon.errors import ConfigError

_BAUDS = (57_600, 115_200, 1_000_000, 2_000_000, 3_000_000, 4_000_000)


@dataclass(frozen=True)
class RatePlan:
    """Times and bytes of one cycle, in the order in which they are spent.

    Attributes:
        baud: bits per second.
        servos: number of servos on this bus.
        goal_bytes: bytes that set all goals.
        request_bytes: bytes that request feedback.
        reply_bytes: bytes of the answers.
        extra_bytes: bytes, in both directions, of the single request besides the exchange in some cycles (slow registers).
        answers: number of status packets; each is sent after the return delay.
        requests: number of requests; the bus turns round after each.
        return_delay_s: longest return delay of the servos.
        turnaround_s: measured, from the last byte of a request to the first of its answer and from the last of that to
            the next request; adapter latency included.
    """

    baud: int
    servos: int
    goal_bytes: int
    request_bytes: int
    reply_bytes: int
    extra_bytes: int
    answers: int
    requests: int
    return_delay_s: float
    turnaround_s: float

    @property
    def wire_s(self) -> float:
        """Seconds of the bytes on the wire."""
        n_bytes = self.goal_bytes + self.request_bytes + self.reply_bytes + self.extra_bytes
        return n_bytes * BITS_PER_BYTE / self.baud

    @property
    def delay_s(self) -> float:
        """Seconds of the return delays of all answers."""
        return self.answers * self.return_delay_s

    @property
    def certain_s(self) -> float:
        """Shortest time of a cycle in seconds, with any machine and adapter."""
        return self.wire_s + self.delay_s

    @property
    def cycle_s(self) -> float:
        """Expected time of a cycle in seconds."""
        return self.certain_s + self.requests * self.turnaround_s

    @property
    def highest_hz(self) -> float:
        """Highest rate that the wire and the return delays allow."""
        return 1.0 / self.certain_s

    @property
    def expected_hz(self) -> float:
        """Rate that the measured turnaround allows."""
        return 1.0 / self.cycle_s

    def lines(self, rate_hz: float) -> list[str]:
        """The budget in words, a line each."""
        byte_us = BITS_PER_BYTE / self.baud * 1e6
        rows = [
            (f"goals of {self.servos} servos", f"{self.goal_bytes} bytes", self.goal_bytes * byte_us),
            ("asking for feedback", f"{self.request_bytes} bytes", self.request_bytes * byte_us),
            (f"answers of {self.servos} servos", f"{self.reply_bytes} bytes", self.reply_bytes * byte_us),
            ("slow registers of one servo", f"{self.extra_bytes} bytes", self.extra_bytes * byte_us),
            ("return delay", f"{self.answers} x {self.return_delay_s * 1e6:.0f} us", self.delay_s * 1e6),
            ("turnaround, measured", f"{self.requests} x {self.turnaround_s * 1e6:.0f} us",
             self.requests * self.turnaround_s * 1e6),
        ]  # fmt: skip
        out = [f"{what:<28}{size:>16}{us:>10.0f} us" for what, size, us in rows if us > 0]
        out.append(f"{f'cycle at {self.baud} baud':<44}{self.cycle_s * 1e6:>10.0f} us, {self.expected_hz:.0f} Hz")
        share = self.cycle_s * rate_hz
        out.append(f"{f'period at {rate_hz:g} Hz':<44}{1e6 / rate_hz:>10.0f} us, {share:.0%} of it used")
        return out

    def require(self, rate_hz: float) -> bool:
        """Whether the rate also leaves room for the measured turnarounds.

        Raises:
            ConfigError: the rate is impossible; the error has the arithmetic, the nearest possible rate and remedies.
        """
        if self.certain_s > 1.0 / rate_hz:
            budget = "\n".join(f"  {line}" for line in self.lines(rate_hz))
            help_ = (
                "\n".join(f"  {line}" for line in self.remedies(rate_hz)) or "  nothing but fewer servos on this port"
            )
            raise ConfigError(
                f"bus.rate_hz {rate_hz:g} is impossible at {self.baud} baud with {self.servos} servos:\n{budget}\n"
                f"nearest possible: {int(self.highest_hz)} Hz; what makes {rate_hz:g} Hz possible:\n{help_}"
            )
        return self.cycle_s <= 1.0 / rate_hz

    def remedies(self, rate_hz: float) -> list[str]:
        """Single changes, or two together, that would make the rate possible."""
        out: list[str] = []
        no_delay = replace(self, return_delay_s=0.0)
        if self.return_delay_s and no_delay.certain_s <= 1.0 / rate_hz:
            out.append(f"return delay 0 (mmmd doctor --fix): {no_delay.highest_hz:.0f} Hz")
        for plan, also in ((self, ""), (no_delay, " and return delay 0")):
            faster = [b for b in _BAUDS if b > self.baud and replace(plan, baud=b).certain_s <= 1.0 / rate_hz]
            if faster:
                hz = replace(plan, baud=faster[0]).highest_hz
                out.append(f"{faster[0]} baud{also} (mmmd servo baud, on every servo): {hz:.0f} Hz")
                break
        return out


def plan_of(
    steps: Sequence[Step], goal_bytes: int, servos: int, baud: int, *,
    return_delay_s: float = 0.0, turnaround_s: float = 0.0, extra_bytes: int = 0,
) -> RatePlan:  # fmt: skip
    """The plan of these steps, with goals written in the first of them."""
    return RatePlan(
        baud, servos, goal_bytes, sum(len(s.request) for s in steps), sum(s.reply_bytes for s in steps), extra_bytes,
        sum(s.answers for s in steps), len(steps), return_delay_s, turnaround_s,
    )  # fmt: skip


def plan_for(
    models: Sequence[BusModel], baud: int, *, fast: bool = False, return_delay_s: float = 0.0, turnaround_s: float = 0.0
) -> RatePlan:
    """The plan for such servos before a bus is opened, from the robot file.

    Args:
        models: models of the servos.
        baud: bits per second.
        fast: whether the servos' firmware has fast sync reads, where the model can have them.
        return_delay_s: return delay of each answer, seconds.
        turnaround_s: turnaround of each request, seconds.
    """
    ids = list(range(1, len(models) + 1))
    able = [fast and m.fast_sync_firmware is not None for m in models]
    steps = steps_for(list(range(len(models))), ids, models, able, chained=True)
    places: dict[tuple[float, int, int], list[int]] = {}
    for servo_id, model in zip(ids, models, strict=True):
        goal = model.table["goal_position"]
        places.setdefault((model.protocol, goal.address, goal.size), []).append(servo_id)
    goal_bytes = sum(
        (GroupWrite if protocol == 2.0 else GroupWrite1)(group, address, size).n_bytes
        for (protocol, address, size), group in places.items()
    )
    return plan_of(
        steps, goal_bytes, len(models), baud, return_delay_s=return_delay_s, turnaround_s=turnaround_s
    )  # fmt: skip
