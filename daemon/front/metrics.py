"""Figures for Prometheus, over HTTP on request: text exposition format 0.0.4 at /metrics. In the front's event loop."""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections.abc import Callable, Mapping, Sequence

from daemon.dynamixel.health import Health
from daemon.settings.config import config_error, metrics_address
from daemon.state.machine import RobotState
from daemon.wire.status import ServoHealth, StateEvent

log = logging.getLogger(__name__)

REQUEST_TIMEOUT_S = 2.0
_LONGEST_REQUEST_BYTES = 8192
_SERVO_COUNTERS = {
    "timeouts": "cycles without its answer",
    "crc": "cycles in which its answer was spoilt",
    "late": "answers after the deadline",
    "retries": "questions that were asked again",
    "alerts": "hardware alerts that began",
}
_COUNTERS = (
    "cycles",
    "cycles_lost",
    "underruns",
    "requests_dropped",
    "events_dropped",
    "subscribers_overrun",
    "connections_shut",
)


def exposition(state: StateEvent, events: Mapping[str, int], servos: Sequence[ServoHealth] = ()) -> str:
    """Text of all figures: those of a state event, the number of events of each type, and the health of each servo."""
    label = f'robot="{_escaped(state.robot)}"'
    lines = ["# HELP mmmd_state 1 for the state the robot is in", "# TYPE mmmd_state gauge"]
    lines += [f'mmmd_state{{{label},state="{s.value}"}} {int(s.value == state.state)}' for s in RobotState]
    gauges: dict[str, tuple[str, float]] = {
        "uptime_seconds": ("since the start of the daemon", state.uptime_s),
        "queued_seconds": ("setpoints that the bus process has in hand", state.queued_ms / 1e3),
        "bus_silent_seconds": ("since the newest bus cycle", float(state.bus_info.get("silent_ms", 0.0)) / 1e3),
        "generator_ready": ("1 when texts can be generated", float(state.generator.startswith("ready"))),
        "commands_waiting": ("commands that wait for their turn", float(len(state.waiting))),
        "servos_not_answering": ("", float(len(state.bus_info.get("servos_not_answering", [])))),
        "servos_with_error": ("", float(len(state.bus_info.get("servos_with_error", [])))),
    }
    for name, (text, value) in gauges.items():
        lines += [f"# HELP mmmd_{name} {text or name.replace('_', ' ')}", f"# TYPE mmmd_{name} gauge"]
        lines.append(f"mmmd_{name}{{{label}}} {value:g}")
    for name in _COUNTERS:
        lines += [f"# HELP mmmd_{name}_total {name.replace('_', ' ')}", f"# TYPE mmmd_{name}_total counter"]
        lines.append(f"mmmd_{name}_total{{{label}}} {int(state.bus_info.get(name, 0))}")
    lines += ["# HELP mmmd_events_total events by type", "# TYPE mmmd_events_total counter"]
    lines += [f'mmmd_events_total{{{label},type="{kind}"}} {n}' for kind, n in sorted(events.items())]
    return "\n".join(lines + _servo_lines(label, servos)) + "\n"


def _servo_lines(label: str, servos: Sequence[ServoHealth]) -> list[str]:
    """Lines for each servo: 1 for the state in which the servo is, and its counters."""
    labels = [f'{label},servo="{s.id}",joint="{_escaped(s.joint)}"' for s in servos]
    lines = ["# HELP mmmd_servo_state 1 for the state the servo is in", "# TYPE mmmd_servo_state gauge"]
    lines += [
        f'mmmd_servo_state{{{own},state="{h.name.lower()}"}} {int(h.name.lower() == s.state)}'
        for own, s in zip(labels, servos, strict=True)
        for h in Health
    ]
    for name, text in _SERVO_COUNTERS.items():
        lines += [f"# HELP mmmd_servo_{name}_total {text}", f"# TYPE mmmd_servo_{name}_total counter"]
        lines += [f"mmmd_servo_{name}_total{{{own}}} {getattr(s, name)}" for own, s in zip(labels, servos, strict=True)]
    return lines


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")


class MetricsServer:
    """Answers GET /metrics, and anything else with 404: one answer a connection, to this machine only.

    Raises:
        ConfigError: the address is not one that `metrics_address` allows.
    """

    def __init__(self, address: str, text: Callable[[], str]) -> None:
        (self._host, self._port), self._text = metrics_address(address), text
        self._server: asyncio.Server | None = None

    async def start(self) -> None:
        """Begin to serve.

        Raises:
            ConfigError: the address cannot be bound.
        """
        try:
            self._server = await asyncio.start_server(
                self._answer, self._host, self._port, limit=_LONGEST_REQUEST_BYTES
            )
        except OSError as error:
            raise config_error(
                "metrics", f"{self._host}:{self._port}: {error}", "a free port", "choose another"
            ) from error
        log.info("metrics at http://%s:%d/metrics", self._host, self._port)

    async def close(self) -> None:
        """Serve no more."""
        if self._server is not None:
            self._server.close()
            await self._server.wait_closed()

    async def _answer(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        with contextlib.suppress(
            OSError, TimeoutError, ValueError, asyncio.IncompleteReadError, asyncio.LimitOverrunError
        ):
            async with asyncio.timeout(REQUEST_TIMEOUT_S):
                head = await reader.readuntil(b"\r\n\r\n")
                found = head.split(b"\r\n", 1)[0].split(b" ")[:2] == [b"GET", b"/metrics"]
                body = self._text().encode() if found else b"not here; /metrics is\n"
                status = "200 OK" if found else "404 Not Found"
                lines = (f"HTTP/1.1 {status}", "Content-Type: text/plain; version=0.0.4; charset=utf-8")
                lines += (f"Content-Length: {len(body)}", "Connection: close", "", "")
                writer.write("\r\n".join(lines).encode() + body)
                await writer.drain()
        writer.close()
