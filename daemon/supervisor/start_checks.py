"""Checks before any process starts: bus URL, web server, checkpoint and log file."""

from __future__ import annotations

import errno
import importlib.util
import socket
import time
from importlib.metadata import entry_points
from pathlib import Path

from daemon.network.web_access import address_of
from daemon.settings.config import HTTP_ADDRESS, DaemonConfig, EndpointInUseError, config_error

SAFETENSORS_HEAD_BYTES = 9
"""Bytes read of a checkpoint: eight with the header's length, and the brace with which the header begins."""
LOG_SUFFIX = ".mcap"
"""Ending of a log's name; without it the name is that of a folder, which each start puts a log of its own into."""


def check_config(config: DaemonConfig) -> None:
    """Refuse settings on which a process would fail again and again.

    Raises:
        ConfigError: the bus scheme, the HTTP address, its library or the checkpoint cannot be used.
    """
    check_scheme(config.bus)
    if config.http or config.view:
        check_web_server(config.http or HTTP_ADDRESS)
    if config.model is not None:
        check_model(config.model)


def check_scheme(bus: str) -> None:
    """Refuse a bus URL with an unknown scheme, before any process starts.

    Raises:
        ConfigError: the scheme is unknown.
    """
    known = sorted(point.name for point in entry_points(group="mmmd.ports"))
    if bus.partition(":")[0] not in known:
        allowed = ", ".join(f"{name}://" for name in known)
        raise config_error("bus", f"'{bus}', an unknown scheme", allowed, "for example dxl:///dev/ttyUSB0?baud=1000000")


def check_web_server(address: str) -> None:
    """Refuse a malformed address, and a server whose library is missing, before any process starts.

    Raises:
        ConfigError: the address is malformed or cannot be served at, or the library is missing.
        EndpointInUseError: another process serves at the address.
    """
    host, port = address_of(address)
    try:
        with socket.create_server((host, port), family=socket.AF_INET6 if ":" in host else socket.AF_INET):
            pass
    except OSError as error:
        if error.errno == errno.EADDRINUSE:
            do = "end that process, or choose another port"
            raise EndpointInUseError(
                f"http: found {address}, which another process has; allowed: a free port; {do}"
            ) from error
        raise config_error(
            "http",
            f"{address}: {error.strerror or error}",
            "an address of this machine, and a port that this user may open",
            "correct it",
        ) from error
    if importlib.util.find_spec("tornado") is None:
        raise config_error("http", "no tornado, the library that serves it", "mmmd[view]", "`pip install 'mmmd[view]'`")


def check_model(path: Path) -> None:
    """Refuse a file that cannot be a checkpoint, because a generator would be started again and again for it.

    Raises:
        ConfigError: the file is missing, cannot be read, or is no safetensors file.
    """
    do = "write one with `mmmd train`, or leave --model out for the shipped one"
    try:
        with path.open("rb") as file:
            head = file.read(SAFETENSORS_HEAD_BYTES)
    except OSError as error:
        raise config_error("model", f"{path}: {error.strerror}", "a checkpoint (.safetensors)", do) from error
    length = int.from_bytes(head[:8], "little")
    if head[8:] != b"{" or not 0 < length <= path.stat().st_size - 8:
        raise config_error("model", f"{path}, which is no safetensors file", "a checkpoint (.safetensors)", do)


def log_file(path: Path) -> Path:
    """The file to record into: `path`, or in a folder a file named by the time, so that each start of a service has its own."""
    return path / time.strftime("mmmd-%Y%m%dT%H%M%S.mcap", time.gmtime()) if path.is_dir() else path


def log_path_error(path: Path) -> str | None:
    """The reason why a log cannot be written to `path`; None when it can."""
    if path.exists():
        return f"--log {path}: the file exists; choose another name, or a folder; logs are not overwritten"
    if path.suffix != LOG_SUFFIX:
        return f"--log {path}: no folder {path}; make it (`mkdir -p {path}`), or name a file that ends in {LOG_SUFFIX}"
    if not path.parent.is_dir():
        return f"--log {path}: no folder {path.parent}; make it, or choose another"
    return None
