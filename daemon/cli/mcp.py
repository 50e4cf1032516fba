"""`mmmd mcp`: tools for a language model."""

from __future__ import annotations

import asyncio
import sys

from tyro.conf import OmitArgPrefixes

from daemon.cli.connection import Connection


def mcp(at: OmitArgPrefixes[Connection] = Connection()) -> int:  # noqa: B008
    """Serve the Model Context Protocol over stdin and stdout: a language model can say, stop and look, within the limits.

    The host of the model starts it; `mmmd run` runs beside it. A host that knows no virtual environment needs the whole path of
    `mmmd` (`command -v mmmd`).

    Example, in the settings of a model's host: {"mcpServers": {"robot": {"command": "mmmd", "args": ["mcp"]}}}

    Args:
        at: where the daemon is.
    """
    from daemon.client.mcp import McpServer

    async def serve() -> None:
        async with at.async_client() as robot:
            await McpServer(robot).serve(sys.stdin.buffer, sys.stdout)

    asyncio.run(serve())
    return 0
