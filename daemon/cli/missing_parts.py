"""Advice on a part of mmmd that is not installed: an extra, PyTorch, or files that stay in the repository."""

from __future__ import annotations

from pathlib import Path

from daemon.cli.cpu_torch import WHAT_TO_DO

_WITH_TORCH = ("torch", "safetensors", "tokenizers")
_EXTRAS = {
    "distributed": "dask",
    "dask": "dask",
    "tensorboard": "train",
    "mink": "bench",
    "rustypot": "bench",
    "tornado": "view",
}
_RUN = (
    "numpy",
    "serial",
    "dynamixel_sdk",
    "tyro",
    "mujoco",
    "scipy",
    "daqp",
    "mcap",
    "zstandard",
    "rich",
    "ruckig",
    "matplotlib",
)
"""Import names of the packages of the extra `run`."""
_OURS = ("mmm_core", "retarget", "daemon", "sim")
_ROOT = Path(__file__).parents[2]


def about_missing(error: Exception) -> str:
    """The missing part and its remedy, when an error says that a part of mmmd is not installed; else empty."""
    if isinstance(error, ModuleNotFoundError):
        package = (error.name or "").partition(".")[0]
        if package in _WITH_TORCH:
            return f"this needs {package}, which is not installed; {WHAT_TO_DO}"
        if package in _EXTRAS:
            return (
                f"this needs {package}, which is not installed; install it with: pip install 'mmmd[{_EXTRAS[package]}]'"
            )
        if package in _RUN:
            return (
                f"{package} is not installed: this is the client alone; install the rest with: pip install 'mmmd[run]'"
            )
        if package in _OURS:
            return _in_the_repository(str(error.name))
    elif isinstance(error, FileNotFoundError) and error.filename is not None:
        path = Path(str(error.filename))
        if any(path.is_relative_to(_ROOT / folder) for folder in ("mmm_core", "daemon", "retarget")):
            return _in_the_repository(str(path.relative_to(_ROOT)))
    return ""


def _in_the_repository(what: str) -> str:
    return (
        f"this needs {what}, which the installed package leaves out: training, evaluation and most figures of `mmmd bench` run"
        " from a clone of the repository; set it up with `make setup`"
    )
