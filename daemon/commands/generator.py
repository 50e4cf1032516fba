"""`mmmd generator`: the process that holds the model, alone."""

from __future__ import annotations

import logging
from pathlib import Path


def generator(
    bind: str = "tcp://127.0.0.1:5874", model: Path | None = None, threads: int = 1, keys: Path | None = None
) -> int:
    """Serve motions to daemons that were started with --generator, until interrupted.

    Example: mmmd generator --bind tcp://127.0.0.1:5874

    Example, for robots on the network: mmmd generator --bind tcp://0.0.0.0:5874 --keys ~/.config/mmmd/keys

    Args:
        bind: endpoint to serve on; one that other machines can reach needs --keys.
        model: checkpoint; the shipped one when it is not given.
        threads: CPU threads.
        keys: folder of CURVE keys (`mmmd keys`): only allowed daemons are served.
    """
    from daemon.generator.process import run

    logging.basicConfig(level=logging.INFO, format="generator: %(message)s")
    try:
        run(bind, model, threads, keys=keys)
    except KeyboardInterrupt:
        pass
    return 0
