"""Probes whether anything listens at an endpoint: ZeroMQ itself would wait in silence, or take over its ipc path."""

from __future__ import annotations

import socket
from urllib.parse import urlsplit

PROBE_TIMEOUT_S = 1.0


def listening(endpoint: str) -> bool:
    """Whether a connection to a tcp:// or ipc:// endpoint is accepted."""
    try:
        if endpoint.startswith("ipc://"):
            with socket.socket(socket.AF_UNIX) as probe:
                probe.settimeout(PROBE_TIMEOUT_S)
                probe.connect(endpoint.removeprefix("ipc://"))
        else:
            parts = urlsplit(endpoint)
            socket.create_connection((parts.hostname, parts.port or 0), PROBE_TIMEOUT_S).close()
    except OSError:
        return False
    return True
