"""The simulated servos in process, as a `Port`: with the real clock, or in virtual time that never waits."""

from __future__ import annotations

import json
from collections import deque
from pathlib import Path
from urllib.parse import SplitResult, parse_qs

from daemon.bus.open import PortContext
from daemon.clock import Clock
from daemon.errors import CommandError, LinkLostError
from sim.bus import SimBus
from sim.faults import FaultSchedule


class SimPort:
    """A `Port` whose far end is a `SimBus`."""

    def __init__(self, bus: SimBus, clock: Clock, baud: int | None = None, audit_file: Path | None = None) -> None:
        self.name, self.bus = "sim://", bus
        self.baud = baud or bus.robot.bus.baud
        self._clock, self._audit_file = clock, audit_file
        self._start_s = clock.now_s()
        self._arriving: deque[tuple[float, bytes]] = deque()
        self._closed = False

    def write(self, data: bytes) -> None:
        """Hand bytes to the servos; a servo at another baud hears only noise."""
        t_s = self._present()
        if self.baud == self.bus.robot.bus.baud:
            self._arriving += self.bus.receive(data, t_s, self.baud)

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Bytes that have arrived, waiting at most `timeout_s` for the first."""
        t_s = self._present()
        until = t_s + max(0.0, timeout_s)
        if not self._arriving or self._arriving[0][0] > until:
            if timeout_s > 0:
                self._clock.sleep_until(until + self._start_s)
            return b""
        # Wait for everything that comes in time: fewer wake-ups, and the caller asks for whole groups anyway.
        wanted, last_s = 0, t_s
        for at_s, chunk in self._arriving:
            if at_s > until or wanted >= max_bytes:
                break
            wanted, last_s = wanted + len(chunk), at_s
        self._clock.sleep_until(last_s + self._start_s)
        out = b""
        while self._arriving and self._arriving[0][0] <= last_s and len(out) < max_bytes:
            at_s, chunk = self._arriving.popleft()
            room = max_bytes - len(out)
            out += chunk[:room]
            if len(chunk) > room:
                self._arriving.appendleft((at_s, chunk[room:]))
        return out

    def close(self) -> None:
        """Write the audit once."""
        if self._audit_file is not None and not self._closed:
            self._audit_file.write_text(json.dumps(self.bus.audit.report(), indent=1))
        self._closed = True

    def _present(self) -> float:
        """Seconds since the simulator started.

        Raises:
            LinkLostError: unplugged or closed.
        """
        t_s = self._clock.now_s() - self._start_s
        if self._closed or self.bus.faults.active("unplug", t_s):
            raise LinkLostError(f"{self.name}: lost (unplugged); plug it in again")
        return t_s


def open_sim(url: SplitResult, context: PortContext) -> SimPort:
    """`sim://`, with options: audit=FILE, faults=FILE.toml, baud=NUMBER."""
    query = {key: values[0] for key, values in parse_qs(url.query).items()}
    unknown = query.keys() - {"audit", "faults", "baud"}
    if unknown or url.netloc or url.path.strip("/"):
        raise CommandError(f"bus '{url.geturl()}': allowed: sim://?audit=FILE&faults=FILE.toml&baud=NUMBER")
    faults = FaultSchedule.load(Path(query["faults"])) if "faults" in query else None
    baud = query.get("baud", str(context.robot.bus.baud))
    if not baud.isdigit():
        raise CommandError(f"bus '{url.geturl()}': baud '{baud}' is not a number; example: baud=1000000")
    audit = Path(query["audit"]) if "audit" in query else None
    return SimPort(SimBus(context.robot, faults), context.clock, int(baud), audit)
