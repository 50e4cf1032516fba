"""What every figure carries: the machine, the versions, the seed and the method."""

from __future__ import annotations

import importlib.metadata
import os
import platform
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

_PACKAGES = ("mmmd", "torch", "numpy", "mujoco", "pyzmq")


def context(seed: int, method: str) -> dict[str, Any]:
    """`machine`, `versions`, `seed` and `method`, to stand beside the figures."""
    return {"machine": _machine(), "versions": _versions(), "seed": seed, "method": method}


def percentiles_ms(seconds: Sequence[float]) -> dict[str, float]:
    """`p50_ms` and `p95_ms` of times given in seconds."""
    p50, p95 = np.percentile(np.asarray(seconds) * 1e3, [50, 95])
    return {"p50_ms": round(float(p50), 2), "p95_ms": round(float(p95), 2)}


def _machine() -> str:
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
