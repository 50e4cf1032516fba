"""The context of every figure: machine, versions, seed and method."""

from __future__ import annotations

import importlib.metadata
import os
import platform
import statistics
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from sim.steal_time import stolen_s

_PACKAGES = ("mmmd", "torch", "numpy", "mujoco", "pyzmq")


def context(seed: int, method: str) -> dict[str, Any]:
    """`machine`, `versions`, `seed` and `method`, to be stored with the figures."""
    return {"machine": machine(), "versions": _versions(), "seed": seed, "method": method}


def percentiles_ms(seconds: Sequence[float]) -> dict[str, float]:
    """`p50_ms` and `p95_ms` of times given in seconds."""
    p50, p95 = np.percentile(np.asarray(seconds) * 1e3, [50, 95])
    return {"p50_ms": round(float(p50), 2), "p95_ms": round(float(p95), 2)}


class HostShare:
    """Measures the share of the processors' time that the host of a virtual machine takes, from the object's creation on."""

    def __init__(self) -> None:
        self._began_s, self._taken_s = time.monotonic(), stolen_s()

    def figures(self) -> dict[str, float]:
        """`host_took`, a share of the processors' time; empty where the system does not report it."""
        past_s = time.monotonic() - self._began_s
        shares = [(now_s - then_s) / past_s for now_s, then_s in zip(stolen_s(), self._taken_s, strict=True)]
        return {"host_took": round(statistics.fmean(shares), 3)} if shares else {}


def machine() -> str:
    """Processor, cores, system and Python."""
    model = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.is_file():
        names = [line.split(":", 1)[1].strip() for line in info.read_text().splitlines() if "model name" in line]
        model = names[0] if names else model
    return (
        f"{model}, {os.cpu_count()} cores, {platform.system()} {platform.release()}, Python {platform.python_version()}"
    )


def _versions() -> dict[str, str]:
    found: dict[str, str] = {}
    for name in _PACKAGES:
        try:
            found[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            found[name] = "not installed"
    return found
