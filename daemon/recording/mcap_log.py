"""Writes logs in MCAP.

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
import time
from typing import IO, Any

import msgspec
import numpy as np
from mcap.writer import Writer

from daemon.recording.foxglove import LOG_TOPIC, SCHEMAS, FoxgloveMessages, log_line
from daemon.recording.schemas import LOG_LINES, schema_of
from daemon.shared_memory.bus_link import BusState
from retarget.robot.robot import RobotModel

FORMAT = 1
"""Version of the log; raised when an older reader would misread it. New channels and fields do not raise it."""
CYCLE_TOPIC = "v1/cycle"
EVENT_TOPIC = "v1/event"
CHUNK_BYTES = 256 * 1024
METADATA, METADATA_AT_END = "mmmd", "mmmd.end"
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


def _cycle_schema() -> bytes:
    number, text = {"type": "number"}, {"type": "string"}
    properties: dict[str, Any] = {name: {"type": "array", "items": number} for name in _ARRAYS}
    properties |= dict.fromkeys((*_SCALARS, "t_mono_ns"), number) | {"state": text}
    properties |= {name: properties[name] | {"description": unit} for name, unit in _UNITS.items()}
    return msgspec.json.encode({"type": "object", "title": "one cycle of the bus process", "properties": properties})


class LogWriter:
    """Writes one log; without `finish`, the part that was flushed stays readable.

    Args:
        stream: stream to write to.
        robot: the robot of the log.
        settings: settings of the daemon, as a JSON object; empty when unknown.
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
        self._writer.add_metadata(METADATA, metadata)
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
        """Write one message of the front, JSON as published; a message that is no JSON (a plain text for `say`) as a string."""
        try:
            msgspec.json.decode(payload)
        except Exception:  # RecursionError of deep JSON among them: a frame of `stream` is written as received
            payload = msgspec.json.encode({"text": payload.decode("utf-8", "replace")})
        if topic not in self._channels:
            schema = self._writer.register_schema(f"mmmd.{topic}", "jsonschema", schema_of(topic))
            self._channels[topic] = self._writer.register_channel(topic, "json", schema)
        t_mono_ns = time.monotonic_ns()
        self._add(self._channels[topic], t_mono_ns, payload)
        if topic == LOG_LINES:
            self._add(self._channels[LOG_TOPIC], t_mono_ns, log_line(payload, t_mono_ns + self._wall_ns))

    def flush(self) -> None:
        """End the chunk: everything written so far then survives a kill."""
        self._writer.flush()

    def finish(self, cycles_dropped: int = 0, messages_dropped: int = 0) -> None:
        """Write how many cycles and messages were lost since the recorder began, index and footer."""
        counts = {"cycles_dropped": str(cycles_dropped), "messages_dropped": str(messages_dropped)}
        self._writer.add_metadata(METADATA_AT_END, counts)
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
