"""The process that holds torch: `python -m daemon.generator.process --bind ENDPOINT`.

The process has one thread and lower priority, and ends when the process that started it does, so that nothing stays behind.
"""

from __future__ import annotations

import argparse
import gc
import importlib.metadata
import logging
import os
import sys
from collections import deque
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Protocol

import zmq

from daemon.errors import ConfigError
from daemon.generator.generated import Generated, generated_message
from daemon.generator.messages import (
    GENERATION_VERSION,
    MOST_REQUEST_BYTES,
    BetweenMessage,
    EditMessage,
    FailureMessage,
    FromGenerator,
    GeneratedMessage,
    GenerateMessage,
    PingMessage,
    PongMessage,
    SceneMessage,
    ToGenerator,
    UnfitRequestError,
    decode_request,
    encode,
)
from daemon.host.descriptors import die_with_parent
from daemon.logs.log_feed import send_logs
from daemon.logs.log_lines import start_logging
from daemon.network.connections import ConnectionGuard, Share, connection_of
from daemon.network.keys import Doorkeeper, KeyFolder
from daemon.network.sockets import bind as bind_socket
from daemon.settings.config import check_endpoint
from daemon.wire.showing import shortened, shown

log = logging.getLogger(__name__)

NICENESS = 5
POLL_MS = 200
AFTER_DRAFT_MS = 10
"""Milliseconds of pause after a draft at most: the front then receives the draft and retargets its first frames, and needs the
cores."""
MOST_CONNECTIONS = 128
MOST_BEGUN = 8
"""Number of motions of which only the draft is made at most; beyond it the oldest is completed first."""


class MotionService(Protocol):
    """Generates motions: `daemon.generator.service` with the model, others in tests."""

    def generate(self, request: GenerateMessage) -> Iterator[Generated]:
        """Yield a motion, after a draft of it when one is requested and can be made."""
        ...

    def scene(self, request: SceneMessage) -> Generated:
        """The next scene of a story."""
        ...

    def edit(self, request: EditMessage) -> Generated:
        """A motion of which a part is generated anew."""
        ...

    def between(self, request: BetweenMessage) -> Generated:
        """A motion through poses."""
        ...


def answers(request: ToGenerator, maker: MotionService, checkpoint_hash: str) -> Iterator[FromGenerator]:
    """Yield the replies to one request; an error of the model becomes a `failure`, never the end of the process."""
    if request.v != GENERATION_VERSION:
        found, allowed = f"version {request.v} of the generator's protocol", f"version {GENERATION_VERSION}"
        yield FailureMessage(id=request.id, code="version", found=found, allowed=allowed)
    elif isinstance(request, PingMessage):
        yield PongMessage(id=request.id, checkpoint_hash=checkpoint_hash, version=importlib.metadata.version("mmmd"))
    else:
        try:
            for made in _made(request, maker):
                yield generated_message(request.id, made)
        except UnfitRequestError as error:
            yield FailureMessage(id=request.id, code=error.code, found=error.found, allowed=error.allowed)
        except Exception as error:  # whatever the model raises, the next text must still be answered
            log.exception("generating %s failed", shown(request.text))
            yield FailureMessage(id=request.id, code="generator_error", found=shortened(error), allowed="a motion")


def _made(
    request: GenerateMessage | SceneMessage | EditMessage | BetweenMessage, maker: MotionService
) -> Iterator[Generated]:
    if isinstance(request, SceneMessage):
        yield maker.scene(request)
    elif isinstance(request, EditMessage):
        yield maker.edit(request)
    elif isinstance(request, BetweenMessage):
        yield maker.between(request)
    else:
        yield from maker.generate(request)


def serve(
    socket: zmq.Socket[bytes],
    maker: MotionService,
    checkpoint_hash: str,
    alive: Callable[[], bool],
    received: Callable[[int], None] = lambda _fd: None,
) -> None:
    """Answer requests on a ROUTER socket while `alive()`; a new request comes before the motion that follows a draft.

    Args:
        socket: the bound socket.
        maker: generates the motions.
        checkpoint_hash: hash of the weights, for the answer to a ping.
        alive: returns whether to go on.
        received: called with the descriptor of the connection of each message, see `ConnectionGuard.received`.
    """
    begun: deque[tuple[list[bytes], Iterator[FromGenerator]]] = deque()
    pause_ms = 0
    while alive():
        asked = socket.poll(pause_ms if begun else POLL_MS)
        pause_ms = 0
        if asked and len(begun) < MOST_BEGUN:
            frames = socket.recv_multipart(copy=False)
            received(connection_of(frames[0]))
            *route, frame = (part.bytes for part in frames)
            try:
                request = decode_request(frame)
            except Exception as error:  # RecursionError among them: whatever a peer can make a decoder raise
                log.warning("dropped a frame that is no request: %s", shortened(error))
                continue
            replies = answers(request, maker, checkpoint_hash)
        elif begun:
            route, replies = begun.popleft()
        else:
            continue
        for reply in replies:
            socket.send_multipart([*route, encode(reply)])
            if isinstance(reply, GeneratedMessage) and reply.draft_of:
                begun.append((route, replies))
                pause_ms = AFTER_DRAFT_MS
                break


def run(
    bind: str, model: Path | None = None, threads: int = 1, parent_pid: int | None = None, keys: Path | None = None
) -> None:
    """Load the model, bind and answer until the parent process is gone.

    Raises:
        ConfigError: the endpoint could be reached from other machines, or cannot be bound.
    """
    check_endpoint("bind", bind, keys=keys is not None)
    os.nice(NICENESS)
    from daemon.generator.service import EngineService

    maker = EngineService.load(model, threads)
    checkpoint_hash = maker.checkpoint_hash
    context = zmq.Context()
    socket = context.socket(zmq.ROUTER)
    folder = KeyFolder(keys) if keys is not None else None
    doorkeeper = Doorkeeper(context, folder) if folder is not None else None
    guard: ConnectionGuard | None = None
    try:
        bind_socket(socket, "bind", bind, folder, most_bytes=MOST_REQUEST_BYTES)
        guard = ConnectionGuard({"generator": (socket, Share(MOST_CONNECTIONS))}, most_growth_bytes=float("inf"))
        guard.start()
        gc.collect()
        gc.freeze()  # the collector does not go through the model and the tables of words while a motion is made
        log.info("generator ready on %s with checkpoint %s", bind, checkpoint_hash[:12])
        serve(socket, maker, checkpoint_hash, lambda: parent_pid is None or os.getppid() == parent_pid, guard.received)
    finally:
        if guard is not None:
            guard.close()
        if doorkeeper is not None:
            doorkeeper.close()
        socket.close(0)
        context.term()


def main() -> int:
    """Entry point of the process."""
    parser = argparse.ArgumentParser(description="The process that turns text into motion.")
    parser.add_argument("--bind", required=True)
    parser.add_argument("--model", type=Path)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--parent-pid", type=int)
    parser.add_argument("--keys", type=Path)
    options = parser.parse_args()
    start_logging("generator")
    send_logs("generator")
    if options.parent_pid is not None:
        die_with_parent()
    from mmm_core.errors import MmmError

    try:
        run(options.bind, options.model, options.threads, options.parent_pid, options.keys)
    except (ConfigError, MmmError) as error:
        sys.stderr.write(f"generator: {error}\n")
        return 1
    except KeyboardInterrupt:
        pass
    return 0


if __name__ == "__main__":
    sys.exit(main())
