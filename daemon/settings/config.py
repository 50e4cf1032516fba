"""Settings of the daemon: frozen, checked on creation."""

from __future__ import annotations

import ipaddress
from collections.abc import Set
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import urlsplit

from daemon.errors import ConfigError
from daemon.wire.requests import IDLE_STYLES, LONGEST_SILENCE_S, SHORTEST_SILENCE_S

ESTOP_WAYS = ("cut", "hold")
CMD_PORT, CTL_PORT, PUB_PORT, STREAM_PORT = 5871, 5872, 5873, 5875
HTTP_ADDRESS = "127.0.0.1:5880"


class EndpointInUseError(ConfigError):
    """An endpoint that somebody else has: nothing is wrong with what was asked, so a service tries it again."""

    exit_status = 1


def config_error(key: str, found: str, allowed: str, do: str) -> ConfigError:
    """The error of a setting with a value that is not allowed."""
    return ConfigError(f"{key}: found {found}; allowed: {allowed}; {do}")


def check_endpoint(key: str, endpoint: str, *, keys: bool = False) -> None:
    """Refuse what is no endpoint, and without `keys` one that other machines could reach.

    Raises:
        ConfigError: the endpoint is neither ipc:// nor tcp://, or not local and there are no keys.
    """
    allowed = "ipc://PATH, or tcp:// on a loopback address such as tcp://127.0.0.1:5871"
    if endpoint.startswith("ipc://") and len(endpoint) > len("ipc://"):
        return
    if not endpoint.startswith("tcp://"):
        raise config_error(key, repr(endpoint), allowed, "name a ZeroMQ endpoint")
    try:
        parts = urlsplit(endpoint)
        host, port = parts.hostname or "", parts.port
    except ValueError as error:
        raise config_error(key, f"{endpoint!r} ({error})", allowed, "name a host and a port") from None
    if port is None and not endpoint.endswith(":*"):
        raise config_error(key, f"{endpoint!r} without a port", allowed, "name a host and a port")
    if not keys and host != "localhost" and not _is_loopback(host):
        do = "give --keys for CURVE (`mmmd keys --help` shows how), or use an ssh tunnel"
        raise config_error(key, f"{endpoint!r}, which other machines can reach without a key", allowed, do)


def metrics_address(address: str) -> tuple[str, int]:
    """Host and port of the metrics, which anybody who reaches them may read: they are plain HTTP, without a key.

    Raises:
        ConfigError: it is no HOST:PORT, or other machines could reach it.
    """
    allowed = "HOST:PORT on a loopback address, for example 127.0.0.1:9109"
    host, _, port = address.rpartition(":")
    host = host.strip("[]")
    if not host or not port.isascii() or not port.isdigit() or int(port) > 65535:
        raise config_error("metrics", repr(address), allowed, "name a free port")
    if host != "localhost" and not _is_loopback(host):
        found = f"{address!r}, which other machines can reach without a key"
        do = "scrape them by way of an ssh tunnel, or of a proxy on this machine that asks who is there"
        raise config_error("metrics", found, allowed, do)
    return host, int(port)


def stream_beside(cmd: str, taken: Set[str] = frozenset()) -> str:
    """Where `stream` is when nobody says: four ports after `cmd` (5875), or the first free of `taken` after that.

    With ipc:// it is the path of `cmd` with `.stream` at its end. Daemon and clients come to the same from `cmd` alone.
    """
    host, _, port = cmd.rpartition(":")
    if not cmd.startswith("tcp://") or not port.isdigit():
        return cmd if cmd.startswith("tcp://") else f"{cmd}.stream"
    for step in range(STREAM_PORT - CMD_PORT, 16):
        beside = f"{host}:{int(port) + (step if int(port) + step < 65536 else -step)}"
        if beside not in taken:
            return beside
    raise AssertionError("three endpoints cannot take a dozen ports")


def _is_loopback(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


@dataclass(frozen=True)
class Endpoints:
    """Where the daemon's sockets are.

    Attributes:
        cmd: requests and their events.
        ctl: stop, estop, reset, arm, park, torque, status.
        pub: state and events for all.
        keys: folder of CURVE keys, for which see `daemon.network.keys`; None leaves only local endpoints.
        stream: joint targets from another program; empty takes a place beside `cmd`, see `stream_beside`.
    """

    cmd: str = f"tcp://127.0.0.1:{CMD_PORT}"
    ctl: str = f"tcp://127.0.0.1:{CTL_PORT}"
    pub: str = f"tcp://127.0.0.1:{PUB_PORT}"
    keys: Path | None = None
    stream: str = ""

    def __post_init__(self) -> None:
        """Refuse what other machines could reach, and two sockets at one place.

        Raises:
            ConfigError: see `check_endpoint`.
        """
        for key in ("cmd", "ctl", "pub"):
            check_endpoint(key, getattr(self, key), keys=self.keys is not None)
        if not self.stream:
            object.__setattr__(self, "stream", stream_beside(self.cmd, {self.ctl, self.pub}))
        check_endpoint("stream", self.stream, keys=self.keys is not None)
        if len({self.cmd, self.ctl, self.pub, self.stream}) != 4 and not self.cmd.endswith(":*"):
            found = f"cmd {self.cmd}, ctl {self.ctl}, pub {self.pub}, stream {self.stream}"
            raise config_error("endpoints", found, "four different endpoints", "give each its own port")


@dataclass(frozen=True)
class DaemonConfig:
    """Settings of one daemon.

    Attributes:
        robot: name of a packaged robot, or path of a robot.toml.
        bus: URL of the servo bus.
        endpoints: sockets.
        log: MCAP file to record into, None for none; `mmmd run` takes a folder too, see `start_checks.log_file`.
        log_size_mb: a log of this size is ended and the next one begun; 0 for never.
        log_total_mb: oldest logs of the run are removed beyond so much together; 0 for never.
        generator: endpoint of a generator that runs already; None starts one.
        model: checkpoint of the generator; None takes the shipped one.
        auto_arm: whether the first text may arm the robot.
        estop: what an e-stop does: `cut` torque, or brake within the limits and `hold` (a second one then cuts).
        idle: style of the movements while there is nothing to play: off, calm or lively.
        alive: whether trunk and head go along with generated gestures (`mmm_core/motion/life.py`).
        gestures: folder of the user's own gestures; None takes the user's data folder.
        motions: folder in which `edit` looks for files; None takes the folder the daemon was started in.
        model_hash: beginning of the checkpoint's hash that the generator must have; empty takes any.
        metrics: HOST:PORT of Prometheus metrics, on a loopback address; empty for none.
        http: HOST:PORT of HTTP and WebSocket; empty for none, or for `HTTP_ADDRESS` with `view`.
        view: whether the web page is served there as well.
        queue_s: setpoints kept ready in the bus process.
        state_rate_hz: how often `v1/state` is published.
        generate_timeout_s: longest wait for the generator.
        park_timeout_s: longest wait for the robot to park at the end.
        lease_s: a lease without a target for so long brakes and holds, where it names no time itself.
        lease_park_s: after so long without a target the lease ends and the robot parks.
        lease_limp_s: the robot stays so long in the park pose before it goes limp, when a lease has led to it.
        stream_queue_s: setpoints of a stream kept ready in the bus process while it moves.
    """

    robot: str
    bus: str
    endpoints: Endpoints = field(default_factory=Endpoints)
    log: Path | None = None
    log_size_mb: float = 500.0
    log_total_mb: float = 0.0
    generator: str | None = None
    model: Path | None = None
    auto_arm: bool = True
    estop: str = "cut"
    idle: str = "off"
    alive: bool = True
    gestures: Path | None = None
    motions: Path | None = None
    model_hash: str = ""
    metrics: str = ""
    http: str = ""
    view: bool = False
    queue_s: float = 0.1
    state_rate_hz: float = 20.0
    generate_timeout_s: float = 10.0
    park_timeout_s: float = 20.0
    lease_s: float = 0.2
    lease_park_s: float = 5.0
    lease_limp_s: float = 2.0
    stream_queue_s: float = 0.03

    def __post_init__(self) -> None:
        """Check ranges, the generator's endpoint and that of the metrics.

        Raises:
            ConfigError: a value is outside its range.
        """
        for key, low, high in (
            ("queue_s", 0.02, 0.3), ("log_size_mb", 0.0, 1e6), ("log_total_mb", 0.0, 1e7), ("state_rate_hz", 1.0, 200.0),
            ("generate_timeout_s", 0.1, 600.0), ("park_timeout_s", 1.0, 120.0),
            ("lease_s", SHORTEST_SILENCE_S, LONGEST_SILENCE_S), ("lease_park_s", 0.1, 600.0), ("lease_limp_s", 0.0, 600.0),
            ("stream_queue_s", 0.01, 0.3),
        ):  # fmt: skip
            value = getattr(self, key)
            if not low <= value <= high:
                raise config_error(key, f"{value}", f"{low} to {high}", "choose a value in this range")
        if self.lease_park_s <= self.lease_s:
            allowed = f"more than lease_s ({self.lease_s:g})"
            raise config_error("lease_park_s", f"{self.lease_park_s:g}", allowed, "holding comes before parking")
        if self.idle not in ("off", *IDLE_STYLES):
            raise config_error("idle", repr(self.idle), ", ".join(("off", *IDLE_STYLES)), "choose one of these")
        if self.estop not in ESTOP_WAYS:
            raise config_error("estop", repr(self.estop), ", ".join(ESTOP_WAYS), "choose one of these")
        if self.metrics:
            metrics_address(self.metrics)
        if self.generator is not None:
            check_endpoint("generator", self.generator, keys=self.endpoints.keys is not None)
