"""The simulated servos in the same process, as a `Port`: with the real clock, or in virtual time without waiting."""

from __future__ import annotations

import json
from pathlib import Path
from urllib.parse import SplitResult, parse_qs

from daemon.dynamixel.ports.opening import PortContext
from daemon.errors import CommandError, LinkLostError
from daemon.host.clock import Clock
from sim.bus import SimBus
from sim.clock import TrueTime, VirtualClock
from sim.errors import FaultFileError
from sim.faults import FaultSchedule
from sim.options import wire_settings, world_of
from sim.steal_time import machine_time


class SimPort:
    """A `Port` whose far end is a `SimBus`."""

    def __init__(self, bus: SimBus, clock: Clock, baud: int | None = None, audit_file: Path | None = None) -> None:
        self.name, self.bus = "sim://", bus
        self.baud = baud or bus.robot.bus.baud
        self._audit_file = audit_file
        self._time = TrueTime(clock) if isinstance(clock, VirtualClock) else machine_time()
        self._start_s = self._time.now_s()
        self._closed = False
        if isinstance(clock, VirtualClock):
            bus.world.on_clock_jump = clock.jump
        elif any(f.kind == "clock_jump" for f in bus.faults.faults):
            raise FaultFileError("fault schedule", "kind", "clock_jump with the real clock", "virtual time")

    def write(self, data: bytes) -> None:
        """Send bytes to the servos; a servo at another baud receives only noise."""
        self.bus.receive(data, self._present(), self.baud)

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Bytes that have arrived; waits at most `timeout_s` for the first.

        The call also waits for the rest of a burst that ends in time, for fewer wake-ups: callers request whole groups.
        """
        t_s = self._present()
        until_s = t_s + max(0.0, timeout_s)
        wire = self.bus.wire
        ready_s = wire.ready_s(max_bytes, until_s)
        if ready_s is None or ready_s > until_s:
            if timeout_s <= 0:
                return b""
            self._time.sleep_until(until_s + self._start_s)
            t_s = until_s
        else:
            self._time.sleep_until(ready_s + self._start_s)
            t_s = max(t_s, ready_s)
        return wire.take(t_s, max_bytes)

    def close(self) -> None:
        """Write the audit's report, at the first call only."""
        if self._audit_file is not None and not self._closed:
            self._audit_file.write_text(json.dumps(self.bus.audit.report(), indent=1))
        self._closed = True

    def _present(self) -> float:
        """Seconds since the simulator started.

        Raises:
            LinkLostError: the port is unplugged or closed.
        """
        t_s = self._time.now_s() - self._start_s
        if self.bus.faults.faults:
            with self.bus.world.lock:
                self.bus.world.advance(t_s)
        if self._closed or self.bus.faults.active("unplug", t_s):
            self.bus.wire.clear()
            raise LinkLostError(f"{self.name}: lost (unplugged); plug it in again")
        return t_s


_OPTIONS = (
    "audit=FILE, faults=FILE.toml, baud=NUMBER, body=plain|mujoco, latency_ms=NUMBER, pieces=LEAST-MOST, factory=1"
)


def open_sim(url: SplitResult, context: PortContext) -> SimPort:
    """`sim://`, with options: audit, faults, baud, body, latency_ms, pieces, factory (docs/simulator.md).

    Raises:
        CommandError: an unknown option or a value it cannot have.
    """
    query = {key: values[0] for key, values in parse_qs(url.query).items()}
    allowed = {part.strip().partition("=")[0] for part in _OPTIONS.split(",")}
    if query.keys() - allowed or url.netloc or url.path.strip("/"):
        raise CommandError(f"bus '{url.geturl()}': allowed: sim://?{_OPTIONS.replace(', ', '&')}")
    faults = FaultSchedule.load(Path(query["faults"])) if "faults" in query else None
    baud = query.get("baud", str(context.robot.bus.baud))
    if not baud.isdigit():
        raise CommandError(f"bus '{url.geturl()}': baud '{baud}' is not a number; example: baud=1000000")
    audit = Path(query["audit"]) if "audit" in query else None
    world = world_of(context.robot, faults, query.get("body", "plain"), factory=query.get("factory") == "1")
    wire = wire_settings(query.get("latency_ms", "0"), query.get("pieces", ""))
    return SimPort(SimBus(context.robot, world=world, wire=wire), context.clock, int(baud), audit)
