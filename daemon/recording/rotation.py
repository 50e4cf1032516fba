"""A log in files of bounded size: a full file is followed by the next, and the oldest are removed when all are too large."""

from __future__ import annotations

import logging
from pathlib import Path
from types import TracebackType
from typing import IO, Self

import numpy as np

from daemon.recording.mcap_log import LogWriter
from retarget.robot.robot import RobotModel

log = logging.getLogger(__name__)

_MB = 1e6


class RotatingLog:
    """Writes NAME.mcap, NAME.1.mcap, NAME.2.mcap, ...; each is a whole log by itself, and none overwrites an existing file.

    A number whose file exists already, from an earlier run, is skipped.

    Args:
        path: path of the first file.
        robot: the robot of the log.
        size_mb: megabytes beyond which a file is finished; 0 for no bound.
        total_mb: megabytes of all files beyond which the oldest finished ones are removed; 0 for no bound.
        settings: settings of the daemon, as JSON; written to each file.

    Raises:
        FileExistsError: a file exists at `path`.

    Attributes:
        cycles_dropped: number of cycles that could not be recorded so far; the caller counts them.
        messages_dropped: number of the front's messages that could not be recorded so far; the caller counts them.
    """

    def __init__(self, path: Path, robot: RobotModel, size_mb: float, total_mb: float, settings: str = "") -> None:
        self._path, self._robot, self._settings = path, robot, settings
        self.cycles_dropped = self.messages_dropped = 0
        self._size_bytes, self._total_bytes = size_mb * _MB, total_mb * _MB
        self._number = 0
        self._full = False
        self._finished: list[Path] = []
        self._file, self._writer = self._begin()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            if error is None:
                self._finish()
        finally:
            self._file.close()

    def cycle(self, record: np.void) -> None:
        """Write one record of the bus process."""
        self._go_on()
        self._writer.cycle(record)

    def event(self, topic: str, payload: bytes) -> None:
        """Write one message of the front."""
        self._go_on()
        self._writer.event(topic, payload)

    def flush(self) -> None:
        """End the chunk; the next message goes to a new file when this one is full.

        Raises:
            OSError: the disk is full or gone.
        """
        self._writer.flush()
        self._file.flush()
        self._full = bool(self._size_bytes) and self._file.tell() > self._size_bytes

    def _go_on(self) -> None:
        """Begin the next file when this one is full; called only when there is something to write."""
        if not self._full:
            return
        self._finish()
        self._file.close()
        self._finished.append(self._current)
        self._number += 1
        self._full = False
        self._file, self._writer = self._begin()
        self._remove_oldest()

    @property
    def _current(self) -> Path:
        return self._path if not self._number else self._path.with_suffix(f".{self._number}{self._path.suffix}")

    def _finish(self) -> None:
        self._writer.finish(self.cycles_dropped, self.messages_dropped)

    def _begin(self) -> tuple[IO[bytes], LogWriter]:
        while True:
            is_device = self._current.exists() and not self._current.is_file()
            try:
                file = self._current.open("wb" if is_device else "xb")
            except FileExistsError:
                if not self._number:
                    raise
                self._number += 1
            else:
                return file, LogWriter(file, self._robot, self._settings)

    def _remove_oldest(self) -> None:
        if not self._total_bytes:
            return
        while self._finished and sum(p.stat().st_size for p in self._finished if p.exists()) > self._total_bytes:
            oldest = self._finished.pop(0)
            log.warning("removing %s: the logs of this run are more than %g MB", oldest, self._total_bytes / _MB)
            oldest.unlink(missing_ok=True)
