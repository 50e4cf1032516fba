"""Settings of the daemon: frozen, checked on creation."""

from __future__ import annotations

import ipaddress
import os
from collections.abc import Set
from dataclasses import Field, dataclass, field, fields
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from daemon.errors import ConfigError
from daemon.wire.requests import IDLE_STYLES, LONGEST_SILENCE_S, SHORTEST_SILENCE_S

CMD_PORT, CTL_PORT, PUB_PORT, STREAM_PORT = 5871, 5872, 5873, 5875
HTTP_ADDRESS = "127.0.0.1:5880"


class EndpointInUseError(ConfigError):
    """Another process has the endpoint; the setting itself is right, so that a service may try again."""

    exit_status = 1


def config_error(key: str, found: str, allowed: str, do: str) -> ConfigError:
    """The error of a setting with a value that is not allowed."""
    return ConfigError(f"{key}: found {found}; allowed: {allowed}; {do}")


def check_endpoint(key: str, endpoint: str, *, keys: bool = False) -> None:
    """Refuse a malformed endpoint, and without `keys` an endpoint that other machines could reach.

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
    """Host and port of the metrics; anybody who reaches them may read them, because they are plain HTTP without a key.

    Raises:
        ConfigError: the address is no HOST:PORT, or other machines could reach it.
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
    """The default endpoint of `stream`: four ports after `cmd` (5875), or the first port after that not in `taken`.

    With ipc:// it is the path of `cmd` with `.stream` appended. Daemon and clients derive the same endpoint from `cmd` alone.
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
class Setting:
    """Help, bounds and options of a setting, beside its name, type and default, for config file, environment and command line.

    Attributes:
        help: help text for people; `{default:g}` stands for the default.
        low: smallest allowed value of a number.
        high: largest allowed value of a number.
        choices: allowed words; empty when any word is allowed.
        is_flag: whether `mmmd run` has an option for it.
        in_environment: whether `MMMD_NAME` sets it for `mmmd run`.
    """

    help: str
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] = ()
    is_flag: bool = True
    in_environment: bool = True


def _setting(default: Any, help: str, **more: Any) -> Any:
    """A field with its `Setting`."""
    return field(default=default, metadata={"setting": Setting(help, **more)})


def settings_of_class(kind: type[DaemonConfig] | type[Endpoints]) -> dict[str, tuple[Field[Any], Setting]]:
    """The fields of a class that are settings, in their order."""
    return {f.name: (f, f.metadata["setting"]) for f in fields(kind) if "setting" in f.metadata}


def named_in_environment() -> dict[str, Any]:
    """The endpoints that the environment names, by key: `MMMD_CMD` as "cmd"."""
    named = {key: os.environ.get(f"MMMD_{key.upper()}", "") for key in ("cmd", "ctl", "pub", "stream")}
    return {key: endpoint for key, endpoint in named.items() if endpoint}


@dataclass(frozen=True)
class Endpoints:
    """Addresses of the daemon's sockets."""

    cmd: str = _setting(f"tcp://127.0.0.1:{CMD_PORT}", "endpoint of requests and their events")
    ctl: str = _setting(f"tcp://127.0.0.1:{CTL_PORT}", "endpoint of stop, estop, reset, arm, park, torque, status")
    pub: str = _setting(f"tcp://127.0.0.1:{PUB_PORT}", "endpoint of state and events, for all")
    keys: Path | None = _setting(
        None,
        "folder of CURVE keys (`mmmd keys`): tcp sockets then take allowed clients only, and may be on any address;"
        " without keys only this machine reaches the daemon",
        in_environment=False,  # read by `daemon.network.keys`
    )
    stream: str = _setting(
        "",
        "endpoint of joint targets under a lease; beside `cmd` (four ports on, or PATH.stream) when it is not given",
    )

    @classmethod
    def of_environment(cls) -> Endpoints:
        """The endpoints that `MMMD_CMD`, `MMMD_CTL`, `MMMD_PUB` and `MMMD_STREAM` name, else the default ones.

        Raises:
            ConfigError: as below.
        """
        return cls(**named_in_environment())

    def __post_init__(self) -> None:
        """Refuse endpoints that other machines could reach, and two sockets at one address.

        Raises:
            ConfigError: an endpoint is refused by `check_endpoint`, or two are equal.
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
    """Settings of one daemon, in the order in which people read them."""

    robot: str = _setting(
        "reference", "name of a packaged robot, or path of a robot.toml; {default} when nothing says otherwise"
    )
    bus: str = _setting(
        "sim://",
        "where the servos are: sim:// (when nothing says otherwise) or dxl://DEVICE?baud=N (without: the robot file's); several"
        " ports with commas between them",
    )
    log: Path | None = _setting(
        None, "MCAP file to record into, or a folder: then each start has a file of its own, named by the time"
    )
    log_size_mb: float = _setting(
        500.0,
        "size in MB at which a log is ended and the next one begun (NAME.1.mcap, ...); 0 for never",
        low=0.0,
        high=1e6,
    )
    log_total_mb: float = _setting(
        0.0, "size in MB of all logs of a run beyond which the oldest are removed; 0 for never", low=0.0, high=1e7
    )
    generator: str | None = _setting(
        None, "endpoint of a generator that runs already (`mmmd generator`); one is started when it is not given"
    )
    model: Path | None = _setting(None, "checkpoint of the generator; the shipped one when it is not given")
    model_hash: str = _setting("", "beginning of the checkpoint's hash; a generator with another one is not used")
    auto_arm: bool = _setting(True, "the first text arms the robot; --no-auto-arm waits for `mmmd arm`")
    estop: str = _setting(
        "cut",
        "what an e-stop does: cut torque (when it is not given), or brake within the limits and hold; a second one cuts",
        choices=("cut", "hold"),
    )
    idle: str = _setting("off", "small movements while there is nothing to play", choices=("off", *IDLE_STYLES))
    alive: bool = _setting(
        True,
        "trunk and head go along with generated gestures, by a few degrees; --no-alive plays gestures as they were generated",
    )
    gestures: Path | None = _setting(
        None, "folder of your own gestures; your data folder when it is not given", in_environment=False
    )
    motions: Path | None = _setting(
        None, "folder in which `edit` looks for files; the folder the daemon was started in when it is not given"
    )
    endpoints: Endpoints = field(default_factory=Endpoints)
    metrics: str = _setting(
        "", "HOST:PORT of Prometheus metrics, for this machine only (127.0.0.1:9109); none when it is not given"
    )
    http: str = _setting(
        "",
        f"HOST:PORT of HTTP and WebSocket ({HTTP_ADDRESS}); beyond this machine clients need the token that is printed",
    )
    view: bool = _setting(False, f"serve the web page as well, at --http or http://{HTTP_ADDRESS}")
    queue_s: float = _setting(
        0.1, "seconds of setpoints kept ready in the bus process", low=0.02, high=0.3, is_flag=False
    )
    state_rate_hz: float = _setting(25.0, "messages of `v1/state` in a second", low=1.0, high=200.0, is_flag=False)
    generate_timeout_s: float = _setting(
        10.0, "seconds after which a generator that does not answer has failed", low=0.1, high=600.0, is_flag=False
    )
    park_timeout_s: float = _setting(
        20.0, "seconds that the robot has to park when the daemon ends", low=1.0, high=120.0, is_flag=False
    )
    lease_s: float = _setting(
        0.2,
        "seconds without a target of a streaming program after which the robot brakes and holds ({default:g})",
        low=SHORTEST_SILENCE_S,
        high=LONGEST_SILENCE_S,
    )
    lease_park_s: float = _setting(
        5.0,
        "seconds without a target after which the program's lease ends and the robot parks ({default:g})",
        low=0.1,
        high=600.0,
    )
    lease_limp_s: float = _setting(
        2.0, "seconds in the park pose after that before the robot goes limp ({default:g})", low=0.0, high=600.0
    )
    stream_queue_s: float = _setting(
        0.03,
        "seconds of a stream's setpoints kept ready in the bus process while the robot moves",
        low=0.01,
        high=0.3,
        is_flag=False,
    )

    def __post_init__(self) -> None:
        """Check ranges, the generator's endpoint and that of the metrics.

        Raises:
            ConfigError: a value is outside its range.
        """
        for key, (_, said) in settings_of_class(DaemonConfig).items():
            value = getattr(self, key)
            if said.low is not None and said.high is not None and not said.low <= value <= said.high:
                raise config_error(key, f"{value}", f"{said.low} to {said.high}", "choose a value in this range")
            if said.choices and value not in said.choices:
                raise config_error(key, repr(value), ", ".join(said.choices), "choose one of these")
        if self.lease_park_s <= self.lease_s:
            allowed = f"more than lease_s ({self.lease_s:g})"
            raise config_error("lease_park_s", f"{self.lease_park_s:g}", allowed, "holding comes before parking")
        if self.metrics:
            metrics_address(self.metrics)
        if self.generator is not None:
            check_endpoint("generator", self.generator, keys=self.endpoints.keys is not None)
