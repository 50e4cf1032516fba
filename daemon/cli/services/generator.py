"""`mmmd generator`: the process that holds the model, kept running."""

from __future__ import annotations

import logging
import os
import subprocess
import sys
import time
from pathlib import Path

log = logging.getLogger(__name__)

FIRST_BACK_OFF_S, LONGEST_BACK_OFF_S = 0.5, 30.0
GOOD_LIFE_S = 60.0
"""Seconds of life after which an end does not count as a failed start: the wait before the next start is short again."""
TOLD = (0, 1, 2)
"""Exit statuses of an end on request or with a message; any other status is a crash or a kill."""


def generator(
    bind: str = "tcp://127.0.0.1:5874", model: Path | None = None, threads: int = 1, keys: Path | None = None
) -> int:
    """Serve motions to daemons that were started with --generator, until interrupted; killed or crashed, it starts again.

    Example: mmmd generator --bind tcp://127.0.0.1:5874

    Example, for robots on the network: mmmd generator --bind tcp://0.0.0.0:5874 --keys ~/.config/mmmd/keys

    Args:
        bind: endpoint to serve on; one that other machines can reach needs --keys.
        model: checkpoint; the shipped one when it is not given.
        threads: CPU threads.
        keys: folder of CURVE keys (`mmmd keys`): only allowed daemons are served.
    """
    logging.basicConfig(level=logging.INFO, format="generator: %(message)s")
    command = [sys.executable, "-m", "daemon.generator.process", "--bind", bind, "--threads", str(threads)]
    command += ["--parent-pid", str(os.getpid())]
    command += ["--model", str(model)] if model is not None else []
    command += ["--keys", str(keys)] if keys is not None else []
    back_off_s = FIRST_BACK_OFF_S
    try:
        while True:
            began_s = time.monotonic()
            with subprocess.Popen(command) as process:
                try:
                    status = process.wait()
                finally:
                    process.terminate()  # on SIGTERM the `with` block waits for it
            if status in TOLD:
                return status
            back_off_s = FIRST_BACK_OFF_S if time.monotonic() - began_s > GOOD_LIFE_S else back_off_s
            log.error("ended with status %d; starts again in %g s", status, back_off_s)
            time.sleep(back_off_s)
            back_off_s = min(2 * back_off_s, LONGEST_BACK_OFF_S)
    except KeyboardInterrupt:
        return 0
