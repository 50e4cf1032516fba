"""Clients of the daemon: `from daemon.client import Client`, or `AsyncClient` for asyncio.

Each is imported on first use: importing asyncio costs a command line a tenth of a second.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from daemon.client.async_client import AsyncClient
    from daemon.client.client import Client
    from daemon.client.errors import CancelledByError, NoAnswerError, RefusedError, Said

__all__ = ["AsyncClient", "CancelledByError", "Client", "NoAnswerError", "RefusedError", "Said"]


def __getattr__(name: str) -> object:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = {"AsyncClient": "async_client", "Client": "client"}.get(name, "errors")
    return getattr(import_module(f"{__name__}.{module}"), name)
