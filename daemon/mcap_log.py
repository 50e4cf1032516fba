"""Logs in MCAP: what is written, and how it is read again, whole or cut off.

Channels: `v1/cycle` (one JSON message a bus cycle, floats exact) and the topics of the front's publisher
(`v1/event`, `v1/state`, ...). Metadata `mmmd`: format, robot name and file, versions. Chunks are small, so that a killed
recorder loses a second at most. Opens in Foxglove, PlotJuggler and Rerun.
"""

from __future__ import annotations

import importlib.metadata
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import msgspec
import numpy as np
from mcap.exceptions import EndOfFile, InvalidMagic, McapError
from mcap.records import Channel, Message, Metadata
from mcap.stream_reader import StreamReader
from mcap.writer import Writer

from daemon.errors import LogError
from daemon.shared import BusState
from retarget.robot import RobotModel

FORMAT = 1
CYCLE_TOPIC = "v1/cycle"
CHUNK_BYTES = 64 * 1024
_ARRAYS = ("setpoint_rad", "goal_rad", "velocity_rad_s", "goal_tick", "present_tick", "present_velocity_raw", "present_current_raw", "error", "valid", "clipped")  # fmt: skip
_SCALARS = ("cycle", "plan_id", "frame", "underrun", "torque", "late_cycles")


@dataclass(frozen=True)
class LoggedCycle:
    """One bus cycle of a log."""

    cycle: int
    t_mono_ns: int
    state: str
    torque: bool
    goal_rad: np.ndarray[Any, np.dtype[np.float64]]
    goal_tick: tuple[int, ...]
    present_tick: tuple[int, ...]


def _cycle_schema() -> bytes:
    number, text = {"type": "number"}, {"type": "string"}
    properties: dict[str, Any] = {name: {"type": "array", "items": number} for name in _ARRAYS}
    properties |= {name: number for name in (*_SCALARS, "t_mono_ns")} | {"state": text}
    return msgspec.json.encode({"type": "object", "title": "one cycle of the bus process", "properties": properties})


class LogWriter:
    """Writes one log; finish it, or what was flushed stays readable."""

    def __init__(self, stream: IO[bytes], robot: RobotModel) -> None:
        self._writer = Writer(stream, chunk_size=CHUNK_BYTES)
        self._writer.start(profile="", library=f"mmmd {importlib.metadata.version('mmmd')}")
        metadata = {
            "format": str(FORMAT),
            "robot": robot.name,
            "robot_toml": robot.path.read_text("utf-8"),
            "rate_hz": repr(robot.bus.rate_hz),
            "joints": ",".join(robot.joint_names),
            "servo_ids": ",".join(str(i) for i in robot.servo_ids),
            "mmmd": importlib.metadata.version("mmmd"),
        }
        self._writer.add_metadata("mmmd", metadata)
        schema = self._writer.register_schema("mmmd.Cycle", "jsonschema", _cycle_schema())
        self._cycle_channel = self._writer.register_channel(CYCLE_TOPIC, "json", schema, {"robot": robot.name})
        self._channels: dict[str, int] = {}
        # Wall time of monotonic zero, so that viewers show dates.
        self._wall_ns = time.time_ns() - time.monotonic_ns()

    def cycle(self, record: np.void) -> None:
        """Write one record of the bus process."""
        message: dict[str, Any] = {name: int(record[name]) for name in _SCALARS}
        message["t_mono_ns"] = int(record["t_mono_ns"])
        message["state"] = BusState(int(record["state"])).name.lower()
        message |= {name: record[name].tolist() for name in _ARRAYS}
        self._add(self._cycle_channel, int(record["t_mono_ns"]), msgspec.json.encode(message))

    def event(self, topic: str, payload: bytes) -> None:
        """Write one message of the front, JSON as published."""
        if topic not in self._channels:
            schema = self._writer.register_schema(f"mmmd.{topic}", "jsonschema", b'{"type": "object"}')
            self._channels[topic] = self._writer.register_channel(topic, "json", schema)
        self._add(self._channels[topic], time.monotonic_ns(), payload)

    def finish(self) -> None:
        """Write index and footer."""
        self._writer.finish()

    def _add(self, channel: int, t_mono_ns: int, data: bytes) -> None:
        t_ns = t_mono_ns + self._wall_ns
        self._writer.add_message(channel, log_time=t_ns, publish_time=t_ns, data=data)


@dataclass(frozen=True)
class Log:
    """A log that was read.

    Attributes:
        metadata: of the recorder.
        cycles: bus cycles in order.
        n_events: messages on other topics.
        is_cut: whether the file ends early; everything up to there was read.
    """

    metadata: dict[str, str]
    cycles: list[LoggedCycle]
    n_events: int
    is_cut: bool


def read_log(path: Path) -> Log:
    """Read a whole log, or a cut-off one up to its last whole chunk.

    Raises:
        LogError: no such file, no MCAP, of another format, or without a single cycle.
    """
    metadata: dict[str, str] = {}
    cycles: list[LoggedCycle] = []
    n_events, is_cut = 0, False
    topics: dict[int, str] = {}
    try:
        with path.open("rb") as f:
            for record in _records(f):
                if record is None:
                    is_cut = True
                elif isinstance(record, Metadata) and record.name == "mmmd":
                    metadata = dict(record.metadata)
                    if metadata.get("format") != str(FORMAT):
                        raise LogError(
                            f"{path}: format {metadata.get('format')}; this mmmd reads {FORMAT}; read it with mmmd {metadata.get('mmmd')}"
                        )
                elif isinstance(record, Channel):
                    topics[record.id] = record.topic
                elif isinstance(record, Message):
                    if topics.get(record.channel_id) == CYCLE_TOPIC:
                        cycles.append(_cycle(record.data))
                    else:
                        n_events += 1
    except FileNotFoundError:
        raise LogError(f"{path}: no such file; logs are written by `mmmd run --log FILE`") from None
    except (InvalidMagic, McapError, msgspec.DecodeError, KeyError, OSError) as error:
        raise LogError(f"{path}: not a log of mmmd ({type(error).__name__}: {error})") from error
    if not metadata:
        raise LogError(
            f"{path}: no mmmd metadata found; {'the file is cut off before its first chunk' if is_cut else 'another program wrote it'}"
        )
    if not cycles:
        raise LogError(f"{path}: holds no bus cycles{' and is cut off' if is_cut else ''}; nothing to replay")
    return Log(metadata, cycles, n_events, is_cut)


def _records(f: IO[bytes]) -> Iterator[Any]:
    """Records in order; None once where the file ends early."""
    records = iter(StreamReader(f, record_size_limit=None).records)
    while True:
        try:
            yield next(records)
        except StopIteration:
            return
        except (EndOfFile, ValueError):  # struct and zstd errors of a half-written chunk arrive as these
            yield None
            return


def _cycle(data: bytes) -> LoggedCycle:
    m = msgspec.json.decode(data)
    goal = np.array(m["goal_rad"], np.float64)
    return LoggedCycle(
        m["cycle"], m["t_mono_ns"], m["state"], bool(m["torque"]), goal, tuple(m["goal_tick"]), tuple(m["present_tick"])
    )
