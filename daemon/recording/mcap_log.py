"""Logs in MCAP: what is written, and how it is read again, whole or cut off.

Channels: `v1/cycle` (one JSON message a bus cycle, floats exact) and the topics of the front's publisher
(`v1/event`, `v1/state`, ...), each with the JSON schema of its messages; beside them joint angles, transforms and the log in
Foxglove's schemas (`foxglove.py`), which are for viewers and are not read again. Metadata `mmmd`: format, robot name and
file, versions, the daemon's settings; at the end `mmmd.end`: what could not be recorded. A chunk is ended about every
second, so that a killed recorder loses a second at most. Each chunk has a checksum, and a chunk that fails it is not
played. Opens in Foxglove, PlotJuggler and Rerun.
"""

from __future__ import annotations

import importlib.metadata
import platform
import struct
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

import msgspec
import numpy as np
from mcap.exceptions import EndOfFile
from mcap.records import Channel, Chunk, Header, McapRecord, Message, Metadata
from mcap.stream_reader import StreamReader, breakup_chunk
from mcap.writer import Writer

from daemon.errors import LogError
from daemon.recording.foxglove import LOG_TOPIC, SCHEMAS, FoxgloveMessages, log_line
from daemon.recording.schemas import LOG_LINES, schema_of
from daemon.shared_memory.bus_link import BusState
from retarget.robot.robot import RobotModel

FORMAT = 1
"""Grows when an older reader would misread the log; new channels and fields do not count."""
CYCLE_TOPIC = "v1/cycle"
_EVENT_TOPIC = "v1/event"
CHUNK_BYTES = 256 * 1024
_LARGEST_RECORD_BYTES = 64 * 1024 * 1024
"""A longer record is damage, not data: it is not even allocated."""
_METADATA, _METADATA_AT_END = "mmmd", "mmmd.end"
_MAGIC_START = b"\x89MCAP"
_ARRAYS = (
    "setpoint_rad", "goal_rad", "velocity_rad_s", "goal_tick", "present_tick", "present_velocity_raw",
    "present_current_raw", "error", "valid", "clipped",
)  # fmt: skip
_UNITS = {
    "setpoint_rad": "radians, one for each joint",
    "goal_rad": "radians, one for each joint",
    "velocity_rad_s": "radians per second, one for each joint",
    "goal_tick": "ticks, one for each servo",
    "present_tick": "ticks, one for each servo; /joint_states has them as angles",
    "present_velocity_raw": "the register's unit, one for each servo",
    "present_current_raw": "the register's unit, one for each servo",
    "error": "error byte of each servo",
    "valid": "1 for each servo that answered",
    "clipped": "1 for each joint whose setpoint was changed",
    "t_mono_ns": "nanoseconds of the monotonic clock",
}
"""Units of a cycle's fields; joints and servos are in the order of the metadata."""
_VERSIONS = ("numpy", "pyzmq", "msgspec", "mujoco", "torch")
_SCALARS = ("cycle", "plan_id", "frame", "underrun", "torque", "late_cycles")


@dataclass(frozen=True)
class LoggedCycle:
    """One bus cycle of a log."""

    cycle: int
    t_mono_ns: int
    state: str
    plan_id: int
    torque: bool
    goal_rad: np.ndarray[Any, np.dtype[np.float64]]
    goal_tick: tuple[int, ...]
    present_tick: tuple[int, ...]


class _LoggedEvent(msgspec.Struct):
    """What is read of an event of the front."""

    type: str | None = None
    plan_id: int | None = None
    text: str | None = None


def _cycle_schema() -> bytes:
    number, text = {"type": "number"}, {"type": "string"}
    properties: dict[str, Any] = {name: {"type": "array", "items": number} for name in _ARRAYS}
    properties |= dict.fromkeys((*_SCALARS, "t_mono_ns"), number) | {"state": text}
    properties |= {name: properties[name] | {"description": unit} for name, unit in _UNITS.items()}
    return msgspec.json.encode({"type": "object", "title": "one cycle of the bus process", "properties": properties})


class LogWriter:
    """Writes one log; finish it, or what was flushed stays readable.

    Args:
        stream: to write to.
        robot: whose log it is.
        settings: of the daemon, as a JSON object; empty when nobody says.
    """

    def __init__(self, stream: IO[bytes], robot: RobotModel, settings: str = "") -> None:
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
            "python": platform.python_version(),
            **{name: _version(name) for name in _VERSIONS},
            "settings": settings,
            "machine": f"{platform.system()} {platform.machine()}",
            "started_utc": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()),
        }
        self._writer.add_metadata(_METADATA, metadata)
        schema = self._writer.register_schema("mmmd.Cycle", "jsonschema", _cycle_schema())
        self._cycle_channel = self._writer.register_channel(CYCLE_TOPIC, "json", schema, {"robot": robot.name})
        self._channels: dict[str, int] = {}
        self._foxglove = FoxgloveMessages(robot)
        for topic, its_schema in SCHEMAS.items():
            schema = self._writer.register_schema(its_schema["title"], "jsonschema", msgspec.json.encode(its_schema))
            self._channels[topic] = self._writer.register_channel(topic, "json", schema)
        # Wall time of monotonic zero, so that viewers show dates.
        self._wall_ns = time.time_ns() - time.monotonic_ns()

    def cycle(self, record: np.void) -> None:
        """Write one record of the bus process."""
        message: dict[str, Any] = {name: int(record[name]) for name in _SCALARS}
        message["t_mono_ns"] = int(record["t_mono_ns"])
        message["state"] = BusState(int(record["state"])).name.lower()
        message |= {name: record[name].tolist() for name in _ARRAYS}
        t_mono_ns = int(record["t_mono_ns"])
        self._add(self._cycle_channel, t_mono_ns, msgspec.json.encode(message))
        for topic, data in self._foxglove.of_cycle(record, t_mono_ns + self._wall_ns):
            self._add(self._channels[topic], t_mono_ns, data)

    def event(self, topic: str, payload: bytes) -> None:
        """Write one message of the front, JSON as published; what is no JSON (a plain text for `say`) as a string."""
        try:
            msgspec.json.decode(payload)
        except Exception:  # RecursionError of a deep one among them: a frame of `stream` is written as it came
            payload = msgspec.json.encode({"text": payload.decode("utf-8", "replace")})
        if topic not in self._channels:
            schema = self._writer.register_schema(f"mmmd.{topic}", "jsonschema", schema_of(topic))
            self._channels[topic] = self._writer.register_channel(topic, "json", schema)
        t_mono_ns = time.monotonic_ns()
        self._add(self._channels[topic], t_mono_ns, payload)
        if topic == LOG_LINES:
            self._add(self._channels[LOG_TOPIC], t_mono_ns, log_line(payload, t_mono_ns + self._wall_ns))

    def flush(self) -> None:
        """End the chunk: what was written so far survives a kill."""
        self._writer.flush()

    def finish(self, cycles_dropped: int = 0, messages_dropped: int = 0) -> None:
        """Write how much could not be recorded since the recorder began, index and footer."""
        counts = {"cycles_dropped": str(cycles_dropped), "messages_dropped": str(messages_dropped)}
        self._writer.add_metadata(_METADATA_AT_END, counts)
        self._writer.finish()

    def _add(self, channel: int, t_mono_ns: int, data: bytes) -> None:
        t_ns = t_mono_ns + self._wall_ns
        self._writer.add_message(channel, log_time=t_ns, publish_time=t_ns, data=data)


def _version(package: str) -> str:
    """Version of a package; empty where it is not installed."""
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return ""


@dataclass
class Log:
    """A log that was read.

    Attributes:
        metadata: of the recorder; with `cycles_dropped` and `messages_dropped` when it came to the end.
        cycles: bus cycles in order.
        n_events: messages on other topics.
        plan_texts: text of each plan, by the id that its cycles carry.
        problem: what is wrong with the file and how far it was read; empty for a whole one.
    """

    metadata: dict[str, str] = field(default_factory=dict[str, str])
    cycles: list[LoggedCycle] = field(default_factory=list[LoggedCycle])
    n_events: int = 0
    plan_texts: dict[int, str] = field(default_factory=dict[int, str])
    problem: str = ""

    @property
    def is_cut(self) -> bool:
        """Whether the file ends early or is damaged; everything up to there was read."""
        return bool(self.problem)


def read_log(path: Path) -> Log:
    """Read a whole log, or a cut-off one up to its last whole chunk.

    Raises:
        LogError: no such file, no MCAP, of another format, or without a single cycle.
    """
    log, library = Log(), ""
    topics: dict[int, str] = {}
    try:
        with path.open("rb") as f:
            _check_magic(path, f)
            records = StreamReader(f, emit_chunks=True, record_size_limit=_LARGEST_RECORD_BYTES).records
            while not log.problem:
                try:
                    record = next(records, None)
                    if record is None:
                        break
                    inner = breakup_chunk(record, validate_crc=True) if isinstance(record, Chunk) else [record]
                    if isinstance(record, Header):
                        library = record.library
                    _take(path, inner, topics, log)
                except (EndOfFile, struct.error):
                    log.problem = "is cut off (recorder killed or disk full)"
                except (LogError, OSError):
                    raise
                except Exception as error:  # whatever a damaged file can lead to
                    log.problem = f"is damaged before byte {f.tell()} ({type(error).__name__}: {error})"
    except FileNotFoundError:
        raise LogError(f"{path}: no such file; logs are written by `mmmd run --log FILE`") from None
    except OSError as error:
        raise LogError(f"{path}: cannot be read: {error.strerror}; give a file of `mmmd run --log FILE`") from error
    if not log.metadata and library.startswith("mmmd"):
        raise LogError(f"{path}: {log.problem or 'names no robot'}; nothing can be recovered from it")
    if not log.metadata:
        problem = f"; it {log.problem}" if log.problem else ""
        raise LogError(f"{path}: not a log of mmmd, but of {library or 'an unknown program'}{problem}")
    problem = f" and {log.problem}" if log.problem else ""
    if not log.cycles:
        raise LogError(f"{path}: holds no bus cycles{problem}; nothing can be recovered from it")
    if log.problem:
        seconds = (log.cycles[-1].t_mono_ns - log.cycles[0].t_mono_ns) * 1e-9
        read = f"{len(log.cycles)} cycles ({seconds:.2f} s) and {log.n_events} events could be read"
        log.problem = f"{path}: {log.problem}; {read}"
    return log


def _check_magic(path: Path, f: IO[bytes]) -> None:
    head = f.read(8)
    f.seek(0)
    if not head.startswith(_MAGIC_START):
        found = f"it starts with {head!r}" if head else "it is empty"
        raise LogError(f"{path}: not an MCAP file ({found}); give a file of `mmmd run --log FILE`")
    if head[5:6] not in (b"0", b""):
        raise LogError(f"{path}: MCAP version {head[5:6].decode('latin-1')}; this mmmd reads 0; update mmmd")


def _take(path: Path, records: list[McapRecord], topics: dict[int, str], log: Log) -> None:
    """Add the records of one chunk, all of them or none."""
    cycles: list[LoggedCycle] = []
    n_events, texts = 0, dict[int, str]()
    for record in records:
        if isinstance(record, Metadata) and record.name == _METADATA_AT_END:
            log.metadata |= record.metadata
        elif isinstance(record, Metadata) and record.name == _METADATA:
            log.metadata = dict(record.metadata)
            found = log.metadata.get("format", "none")
            if found != str(FORMAT):
                by = f"written by mmmd {log.metadata.get('mmmd', 'unknown')}"
                mine = importlib.metadata.version("mmmd")
                raise LogError(f"{path}: log format {found}, {by}; this mmmd {mine} reads format {FORMAT}; update mmmd")
        elif isinstance(record, Channel):
            topics[record.id] = record.topic
        elif isinstance(record, Message):
            if topics[record.channel_id] == CYCLE_TOPIC:
                cycles.append(_cycle(record.data))
            elif topics[record.channel_id] not in SCHEMAS:
                n_events += 1
                if topics[record.channel_id] == _EVENT_TOPIC:
                    texts |= _plan_text(record.data)
    log.cycles += cycles
    log.n_events += n_events
    log.plan_texts |= texts


def _plan_text(data: bytes) -> dict[int, str]:
    """The text of a plan that an event names, by the plan's id; nothing where it names none."""
    event = msgspec.json.decode(data, type=_LoggedEvent)
    return {event.plan_id: event.text} if event.type == "accepted" and event.plan_id and event.text else {}


def _cycle(data: bytes) -> LoggedCycle:
    m = msgspec.json.decode(data)
    goal = np.array(m["goal_rad"], np.float64)
    return LoggedCycle(
        m["cycle"],
        m["t_mono_ns"],
        m["state"],
        m["plan_id"],
        bool(m["torque"]),
        goal,
        tuple(m["goal_tick"]),
        tuple(m["present_tick"]),
    )
