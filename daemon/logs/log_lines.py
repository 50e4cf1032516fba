"""Lines of the daemon's log: for people, or one JSON object each for programs."""

from __future__ import annotations

import json
import logging
import os
import time

JSON_VARIABLE = "MMMD_LOG_JSON"
"""Environment variable set for the daemon's children, so that all lines have the same form."""


class JsonLines(logging.Formatter):
    """Formats each line as a JSON object: time, level, process, module, message."""

    def __init__(self, process: str) -> None:
        super().__init__()
        self._process = process

    def format(self, record: logging.LogRecord) -> str:
        stamp = time.strftime("%Y-%m-%dT%H:%M:%S", time.gmtime(record.created))
        line = {
            "t": f"{stamp}.{int(record.msecs):03d}Z", "level": record.levelname.lower(), "process": self._process,
            "module": record.name, "message": record.getMessage(),
        }  # fmt: skip
        if record.exc_info:
            line["error"] = self.formatException(record.exc_info)
        return json.dumps(line)


def start_logging(process: str, *, level: int = logging.INFO, as_json: bool | None = None, stamp: bool = False) -> None:
    """Log to stderr; as JSON when requested, or when the process that started this one logs so."""
    as_json = os.environ.get(JSON_VARIABLE) == "1" if as_json is None else as_json
    if as_json:
        os.environ[JSON_VARIABLE] = "1"
        handler = logging.StreamHandler()
        handler.setFormatter(JsonLines(process))
        logging.basicConfig(level=level, handlers=[handler])
    elif stamp:
        logging.basicConfig(level=level, format="%(asctime)s %(message)s", datefmt="%H:%M:%S")
    else:
        form = f"%(asctime)s {process}: %(levelname)s %(message)s"
        logging.basicConfig(level=level, format=form, datefmt="%H:%M:%S")
