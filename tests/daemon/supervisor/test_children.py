"""A process of the daemon that is stopped by a signal is noticed; one that waits is not taken for such a one."""

from __future__ import annotations

import asyncio
import errno
import os
import signal
from typing import Any

import pytest

from daemon.supervisor.children import NOT_STARTED, Child
from daemon.supervisor.side_processes import keep_web_server


@pytest.mark.skipif(not os.path.isdir("/proc/self"), reason="this system has no /proc")
def test_only_a_stopped_process_is_called_stopped() -> None:
    async def look() -> None:
        child = Child("sleeper", "timeit", ["-n1", "-r1", "import time; time.sleep(60)"], {})
        await child.start()
        try:
            for _ in range(3):
                await asyncio.sleep(0.05)
                assert not child.stopped_s(), "it starts, or waits"
            os.kill(child.pid, signal.SIGSTOP)
            while not child.stopped_s():
                await asyncio.sleep(0.01)
            os.kill(child.pid, signal.SIGCONT)
            while child.stopped_s():
                await asyncio.sleep(0.01)
        finally:
            child.kill()
            await child.ended()

    asyncio.run(asyncio.wait_for(look(), 60.0))


def test_a_process_that_the_system_has_no_room_for_is_started_later(monkeypatch: pytest.MonkeyPatch) -> None:
    """One `EAGAIN` ended the task that keeps a process, without a word."""
    spawn, refused = asyncio.create_subprocess_exec, [BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN))] * 2

    async def spawn_later(*arguments: str, **how: Any) -> asyncio.subprocess.Process:
        if refused:
            raise refused.pop()
        return await spawn(*arguments, **how)

    async def start() -> None:
        monkeypatch.setattr(asyncio, "create_subprocess_exec", spawn_later)
        child = Child("web server", "timeit", ["-n1", "-r1", "import time; time.sleep(60)"], {})
        await child.start()
        assert (child.running, await child.ended()) == (False, NOT_STARTED)
        assert list(child.said) == ["cannot be started: Resource temporarily unavailable"]
        keeping = asyncio.create_task(keep_web_server(child))
        while not child.running:
            assert not keeping.done()
            await asyncio.sleep(0.01)
        keeping.cancel()
        child.kill()
        await child.ended()

    asyncio.run(asyncio.wait_for(start(), 60.0))
