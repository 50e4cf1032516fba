"""Keeps the generator: starts it again when it ends or freezes, or watches one that another user or service runs."""

from __future__ import annotations

import asyncio
import importlib.util
import logging
import os
import time
from collections.abc import Coroutine, Mapping

from daemon.generator.client import GeneratorClient
from daemon.generator.generated import GeneratorError
from daemon.settings.config import DaemonConfig
from daemon.supervisor.children import FIRST_BACK_OFF_S, LONGEST_BACK_OFF_S, BackOff, Child

log = logging.getLogger(__name__)

PING_EVERY_S, PING_TIMEOUT_S = 2.0, 5.0
FIRST_PING_TIMEOUT_S = 0.25
"""Seconds that a ping waits before the generator has ever answered."""
FOLLOWING_PING_TIMEOUT_S = 1.0
"""Seconds that a ping waits for a generator that the daemon did not start, once it has answered."""
START_TIMEOUT_S = 120.0
"""Seconds that the generator has to load torch and the model, also from a slow card."""
NO_TORCH = "PyTorch is not installed: `mmmd install-torch`, or `--generator` names one elsewhere"


class GeneratorKeeper:
    """Keeps the generator of one client; the robot holds while there is none.

    Attributes:
        client: knows whether the generator answers.
        child: the generator process; not started when the generator runs elsewhere or PyTorch is missing.

    Args:
        config: the endpoint of a generator elsewhere, and the checkpoint.
        client: client of the generator, informed whether it answers.
        endpoint: endpoint that the process binds.
        environment: environment variables set for the process.
    """

    def __init__(
        self, config: DaemonConfig, client: GeneratorClient, endpoint: str, environment: Mapping[str, str]
    ) -> None:
        arguments = ["--bind", endpoint, "--parent-pid", str(os.getpid())]
        if config.model is not None:
            arguments += ["--model", str(config.model)]
        self.child = Child("generator", "daemon.generator.process", arguments, environment, follow=True)
        self._elsewhere, self.client = config.generator, client

    def work(self) -> Coroutine[None, None, None] | None:
        """The task to run until the end; None when no generator can run, which the client then reports."""
        if self._elsewhere is not None:
            return self._follow(self._elsewhere)
        if importlib.util.find_spec("torch") is None:
            self.client.mark_down(NO_TORCH)
            log.warning("generator %s; gestures, replay, look, idle and stream work without it", self.client.state)
            return None
        return self._keep()

    async def _keep(self) -> None:
        """Start the generator, and start it again whenever it ends or freezes."""
        child, client = self.child, self.client
        back_off = BackOff(FIRST_BACK_OFF_S, LONGEST_BACK_OFF_S, last_s=FIRST_BACK_OFF_S)
        while True:
            client.mark_starting()
            await child.start()
            answered = await self._attend()
            child.kill()
            status = await child.ended()
            why = child.said[-1] if child.said else "no message"
            wait_s = back_off.after(good=answered)
            client.mark_down(f"ended with status {status} ({why}); starts again in {wait_s:g} s")
            log.error("generator %s", client.state)
            await asyncio.sleep(wait_s)

    async def _attend(self) -> bool:
        """Wait until the generator has ended or does not answer; returns whether it ever answered."""
        client = self.client
        answered, timeouts = False, client.timeouts
        began_s = time.monotonic()
        ended = asyncio.create_task(self.child.ended())
        while not ended.done():
            if not client.busy:
                try:
                    checkpoint = await client.ping(PING_TIMEOUT_S if answered else FIRST_PING_TIMEOUT_S)
                except GeneratorError:
                    if answered or time.monotonic() - began_s > START_TIMEOUT_S:
                        log.error("the generator does not answer and is started again")
                        return answered
                    timeouts = client.timeouts
                    continue
                if not answered:
                    client.mark_ready(checkpoint)
                    log.info("generator %s after %.1f s", client.state, time.monotonic() - began_s)
                answered = True
            if client.timeouts != timeouts:
                log.error("the generator left a text unanswered and is started again")
                return answered
            await asyncio.wait({ended}, timeout=PING_EVERY_S if answered else 0.1)
        return answered

    async def _follow(self, endpoint: str) -> None:
        """Watch whether a generator that the daemon did not start answers, for ever."""
        client, ready = self.client, False
        while True:
            if not client.busy:
                try:
                    checkpoint = await client.ping(FOLLOWING_PING_TIMEOUT_S if ready else FIRST_PING_TIMEOUT_S)
                    if not ready:
                        client.mark_ready(checkpoint)
                        log.info("generator %s", client.state)
                    ready = True
                except GeneratorError as error:
                    timeout = error.code == "generator_timeout"
                    why = f"no answer from {endpoint}" if timeout else str(error)
                    if ready or client.state == "starting" or not client.state.endswith(why):
                        client.mark_down(why, ended=False)
                        log.error("generator %s", client.state)
                    ready = False
            await asyncio.sleep(PING_EVERY_S / 2 if ready else 0.1)
