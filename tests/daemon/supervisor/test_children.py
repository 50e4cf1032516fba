"""A process of the daemon that is stopped by a signal is noticed; one that waits is not taken for such a one."""

from __future__ import annotations

import asyncio
import os
import signal

import pytest

from daemon.supervisor.children import Child


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
