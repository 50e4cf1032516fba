"""`mmmd generator`: the process that holds the model, alone."""

from __future__ import annotations

import logging
from pathlib import Path


def generator(bind: str = "tcp://127.0.0.1:5874", model: Path | None = None, threads: int = 1) -> int:
    """Serve motions to daemons that were started with --generator, until interrupted.

    Example: mmmd generator --bind tcp://127.0.0.1:5874

    Args:
        bind: endpoint to serve on, local only.
        model: checkpoint; the shipped one when it is not given.
        threads: CPU threads.
    """
    from daemon.generator import run

    logging.basicConfig(level=logging.INFO, format="generator: %(message)s")
    try:
        run(bind, model, threads)
    except KeyboardInterrupt:
        pass
    return 0
