"""`mmmd install-torch`: the CPU build of PyTorch, which the motion model needs."""

from __future__ import annotations

import importlib.metadata
import re
import subprocess
import sys
from pathlib import Path

from daemon.cli.cpu_torch import CPU_INDEX, install
from daemon.errors import NoCpuBuildError


def install_torch(gpu: bool = False, cpu_index: str = CPU_INDEX, constraint: Path | None = None) -> int:
    """Install PyTorch for the CPU, and what else the motion model needs, into the environment that mmmd runs in.

    A plain `pip install torch` brings about 6 GB of GPU libraries on Linux, on a Raspberry Pi too. This command takes a CPU build
    from the package index that pip is configured for, else from PyTorch's own CPU index, else it stops and says what
    would be fetched.

    Example: mmmd install-torch

    Args:
        gpu: take the build with GPU libraries, too.
        cpu_index: the index of CPU builds that is tried after the configured one.
        constraint: a constraints file for pip, such as the repository's constraints.txt.
    """
    requires = [r for r in importlib.metadata.requires("mmmd") or [] if re.search(r"extra == ['\"]generate['\"]", r)]
    names = [r.partition(";")[0].strip() for r in requires]
    torch = next(name for name in names if name.startswith("torch"))
    sys.stdout.write(install(torch, constraint=constraint, gpu=gpu, cpu_index=cpu_index, pip_flags=[]) + "\n")
    others = [name for name in names if name != torch]
    more = ["--constraint", str(constraint)] if constraint else []
    if subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", *more, *others], check=False).returncode:
        raise NoCpuBuildError(f"`pip install {' '.join(others)}` failed; its message is above")
    return 0
