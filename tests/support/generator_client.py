"""A client of a generator, for one call."""

from __future__ import annotations

import asyncio

import zmq
import zmq.asyncio

from daemon.generator.client import GeneratorClient


def ask(endpoint: str, call):
    """Run `call(client)` with a client of the generator at `endpoint`."""

    async def run():
        context = zmq.asyncio.Context()
        client = GeneratorClient(context, endpoint)
        client.mark_ready("k")
        try:
            return await call(client)
        finally:
            await client.close()
            context.destroy(linger=0)

    return asyncio.run(run())
