"""Reads logs in MCAP, whole or cut off; `mcap_log` describes their content."""

from __future__ import annotations

import importlib.metadata
import struct
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

import msgspec
import numpy as np
from mcap.exceptions import EndOfFile
from mcap.records import Channel, Chunk, Header, McapRecord, Message, Metadata
from mcap.stream_reader import StreamReader, breakup_chunk

from daemon.errors import LogError
from daemon.recording.foxglove import SCHEMAS
from daemon.recording.mcap_log import CYCLE_TOPIC, EVENT_TOPIC, FORMAT, METADATA, METADATA_AT_END

_LARGEST_RECORD_BYTES = 64 * 1024 * 1024
"""Bytes of a record at most: a longer one is damage, and is not even allocated."""


_MAGIC_START = b"\x89MCAP"


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
    """The fields of a front's event that a reader of logs needs."""

    type: str | None = None
    plan_id: int | None = None
    text: str | None = None


@dataclass
class Log:
    """Content of a log.

    Attributes:
        metadata: metadata of the recorder; with `cycles_dropped` and `messages_dropped` when the log is finished.
        cycles: bus cycles in order.
        n_events: number of messages on other topics, Foxglove's left out.
        plan_texts: text of each plan, by the id that its cycles carry.
        problem: damage of the file, and how far it was read; empty for a whole file.
    """

    metadata: dict[str, str] = field(default_factory=dict[str, str])
    cycles: list[LoggedCycle] = field(default_factory=list[LoggedCycle])
    n_events: int = 0
    plan_texts: dict[int, str] = field(default_factory=dict[int, str])
    problem: str = ""

    @property
    def is_cut(self) -> bool:
        """Whether the file ends early or is damaged; everything before that was read."""
        return bool(self.problem)


def read_log(path: Path) -> Log:
    """Read a whole log, or a cut-off one up to its last whole chunk.

    Raises:
        LogError: the file is missing, no MCAP, of another format, or without a single cycle.
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
                except Exception as error:  # a damaged file can lead to any error
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
    """Add the records of one chunk to the log, all of them or none."""
    cycles: list[LoggedCycle] = []
    n_events, texts = 0, dict[int, str]()
    for record in records:
        if isinstance(record, Metadata) and record.name == METADATA_AT_END:
            log.metadata |= record.metadata
        elif isinstance(record, Metadata) and record.name == METADATA:
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
                if topics[record.channel_id] == EVENT_TOPIC:
                    texts |= _plan_text(record.data)
    log.cycles += cycles
    log.n_events += n_events
    log.plan_texts |= texts


def _plan_text(data: bytes) -> dict[int, str]:
    """The text of the plan that an `accepted` event names, by the plan's id; empty for other events."""
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
