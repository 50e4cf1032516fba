"""Recorded cycles of a bus process for tests of the log."""

from pathlib import Path

from daemon.recording.mcap_log import LogWriter


def write(path: Path, run, *, flush_every: int = 50, finish: bool = True) -> Path:
    robot, records = run
    with path.open("wb") as f:
        writer = LogWriter(f, robot)
        for i, record in enumerate(records):
            writer.cycle(record)
            if i % flush_every == flush_every - 1:
                writer.event("v1/event", b'{"type": "progress"}')
                writer.flush()
        if finish:
            writer.finish()
    return path
