"""Installs a PyTorch that runs on the CPU, and GPU libraries of several gigabytes only on request.

The plain `torch` of the public package index requires CUDA on x86_64 and on arm64 Linux. This module tries, in this order, the
index that pip is configured for, then PyTorch's own CPU index, and takes the first build without GPU libraries. When neither has
one it stops and says what would be fetched. The standard library and pip are enough to run it: `make setup` does so before
anything else is installed (`python -m daemon.cli.cpu_torch --constraint constraints.txt`); `mmmd install-torch` is the same
for an installed mmmd.
"""

from __future__ import annotations

import argparse
import importlib
import importlib.metadata
import json
import os
import platform
import re
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from daemon.errors import NoCpuBuildError

CPU_INDEX = "https://download.pytorch.org/whl/cpu"
"""PyTorch's own index of builds without GPU libraries (pytorch.org, "Get Started Locally")."""
GPU_NAMES = re.compile(r"(nvidia|cuda|rocm|triton|pytorch-triton|intel-sycl)\b")
"""Beginnings of the names of packages that hold GPU libraries."""
GPU_SIZES = "about 3 GB to download and 6 GB on disk, where the CPU build takes 0.2 and 0.8 GB"
METADATA_WITHOUT_WHEEL = (23, 2)
"""Version of the first pip that reads a package's requirements without downloading its wheel (PEP 658 and PEP 714)."""
WHAT_TO_DO = (
    "install PyTorch's CPU build with `mmmd install-torch` (64-bit systems, a Raspberry Pi with 64-bit Raspberry Pi OS too),"
    " or name a generator on another machine: `mmmd run --generator tcp://HOST:5874`"
)
"""Advice for a machine without torch."""


@dataclass(frozen=True)
class Build:
    """A build of torch that an index offers.

    Attributes:
        version: version in pip's form, "2.13.0+cpu".
        gpu_libraries: names of the GPU packages that it requires on this machine.
    """

    version: str
    gpu_libraries: tuple[str, ...]


def install(requirement: str, *, constraint: Path | None, gpu: bool, cpu_index: str, pip_flags: Sequence[str]) -> str:
    """Install torch and its requirements.

    Args:
        requirement: "torch" with or without a range of versions.
        constraint: pip's constraints file; None for none.
        gpu: whether to accept the configured index's build with any requirements.
        cpu_index: the index to try after the configured one.
        pip_flags: further options of `pip install`.

    Returns:
        The installed version, in one sentence.

    Raises:
        NoCpuBuildError: no index has a build without GPU libraries, or none at all for this machine.
    """
    pip = _Pip(constraint, pip_flags)
    offered, problem = pip.offered(requirement) if gpu or pip.reads_metadata else (None, pip.too_old)
    if offered is not None and offered.version == "":
        return "torch is installed already and is kept"
    if offered is not None and (gpu or not offered.gpu_libraries):
        pip.install(f"torch=={offered.version}")
        return f"torch {offered.version} installed from the configured index"
    if gpu:
        raise NoCpuBuildError(f"torch: the configured index has no build for {_machine()}: {problem}; {WHAT_TO_DO}")
    with tempfile.TemporaryDirectory() as empty:
        only = {
            "PIP_INDEX_URL": cpu_index,
            "PIP_EXTRA_INDEX_URL": cpu_index,
            "PIP_FIND_LINKS": empty,
            "PIP_NO_INDEX": "0",
        }
        found, cpu_problem = pip.offered(requirement, only)
        if found is not None and found.version == "":
            return "torch is installed already and is kept"
        if found is not None and not found.gpu_libraries:
            pip.install(f"torch=={found.version}", "--no-deps", environment=only)
            pip.install(requirement)  # its requirements, from the configured index
            return f"torch {found.version} installed from {cpu_index}"
    raise NoCpuBuildError(_refusal(offered, problem, cpu_index, cpu_problem))


def _refusal(offered: Build | None, problem: str, cpu_index: str, cpu_problem: str) -> str:
    """The reason why nothing was installed, and what to do."""
    if offered is not None:
        names = ", ".join(offered.gpu_libraries[:4])
        more = f" and {len(offered.gpu_libraries) - 4} more" if len(offered.gpu_libraries) > 4 else ""
        first = (
            f"the configured index has torch {offered.version}, which brings GPU libraries ({names}{more}): {GPU_SIZES}"
        )
    else:
        first = f"the configured index has none for {_machine()} ({problem})"
        if problem.startswith("pip "):
            first = f"the configured index was not asked: {problem}"
    return (
        f"torch: no CPU build found: {first}; {cpu_index}: {cpu_problem or 'only builds with GPU libraries'};"
        " nothing was installed."
        " To go on: `make setup TORCH=gpu` or `mmmd install-torch --gpu` takes the build with GPU libraries;"
        " `--cpu-index URL` names another index of CPU builds; without torch, `mmmd run --generator tcp://HOST:5874` uses a"
        " generator on another machine"
    )


def _machine() -> str:
    return f"Python {platform.python_version()} on {platform.system()} {platform.machine()}"


class _Pip:
    """The pip of this interpreter.

    Attributes:
        reads_metadata: whether it reads requirements without downloading the wheel, which for a GPU build has 0.5 to 0.9 GB.
        too_old: why the configured index is not asked where it does not, and what to do.
    """

    def __init__(self, constraint: Path | None, flags: Sequence[str]) -> None:
        self._options = [*flags, "--quiet", "--disable-pip-version-check"]
        if constraint is not None:
            self._options += ["--constraint", str(constraint)]
        version = importlib.metadata.version("pip")
        numbers = re.match(r"(\d+)\.(\d+)", version)
        self.reads_metadata = numbers is not None and (int(numbers[1]), int(numbers[2])) >= METADATA_WITHOUT_WHEEL
        self.too_old = (
            f"pip {version} tells what a package requires only after downloading it, which pip"
            f" {METADATA_WITHOUT_WHEEL[0]}.{METADATA_WITHOUT_WHEEL[1]} need not; `{sys.executable} -m pip install --upgrade pip`"
        )

    def offered(self, requirement: str, environment: Mapping[str, str] | None = None) -> tuple[Build | None, str]:
        """The build that pip would install, with an empty version when one is installed; or None and the reason."""
        arguments = ["install", "--dry-run", "--no-deps", "--report", "-", *self._options, requirement]
        done = self._run(arguments, environment or {})
        if done.returncode:
            lines = [line for line in done.stderr.splitlines() if line.startswith("ERROR: ")]
            return None, lines[-1].removeprefix("ERROR: ") if lines else done.stderr.strip()[-300:]
        report = json.loads(done.stdout)
        if not report["install"]:
            return Build("", ()), ""
        metadata = report["install"][0]["metadata"]
        return Build(metadata["version"], _gpu_libraries(metadata.get("requires_dist", []))), ""

    def install(self, *what: str, environment: Mapping[str, str] | None = None) -> None:
        """Install packages.

        Raises:
            NoCpuBuildError: pip failed; its own message is on stderr.
        """
        done = self._run(["install", *self._options, *what], environment or {}, told=True)
        if done.returncode:
            raise NoCpuBuildError(f"torch: `pip install {' '.join(what)}` failed (its message is above); {WHAT_TO_DO}")

    @staticmethod
    def _run(
        arguments: Sequence[str], environment: Mapping[str, str], told: bool = False
    ) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "pip", *arguments]
        return subprocess.run(
            command, env={**os.environ, **environment}, capture_output=not told, text=True, check=False
        )


def _gpu_libraries(requires: Sequence[str]) -> tuple[str, ...]:
    """Names of the GPU packages among the requirements that hold on this machine."""
    Requirement: Any = importlib.import_module("pip._vendor.packaging.requirements").Requirement
    needed = [r for r in map(Requirement, requires) if r.marker is None or r.marker.evaluate({"extra": ""})]
    return tuple(r.name for r in needed if GPU_NAMES.match(r.name))


def main() -> int:
    """Install torch by the command line; return 0, or 1 with a message."""
    parser = argparse.ArgumentParser(prog="python -m daemon.cli.cpu_torch", description=__doc__)
    parser.add_argument("--constraint", type=Path)
    parser.add_argument("--build", choices=("cpu", "gpu"), default="cpu")
    parser.add_argument("--cpu-index", default=CPU_INDEX)
    parser.add_argument("--pip-flags", default="", help="further options of pip install, in one string")
    asked = parser.parse_args()
    try:
        said = install(
            "torch", constraint=asked.constraint, gpu=asked.build == "gpu", cpu_index=asked.cpu_index,
            pip_flags=shlex.split(asked.pip_flags),
        )  # fmt: skip
    except NoCpuBuildError as error:
        sys.stderr.write(f"mmmd: {error}\n")
        return 1
    sys.stdout.write(f"{said}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
