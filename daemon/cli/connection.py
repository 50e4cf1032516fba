"""Options and output shared by the commands that talk to a daemon."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from daemon.errors import CommandError
from daemon.settings.config import Endpoints, named_in_environment

if TYPE_CHECKING:
    from daemon.client import AsyncClient, Client

_DEFAULT = Endpoints()


def _endpoint(key: str) -> str:
    """The endpoint that the environment names, else the default one; it is checked when it is used."""
    default = "" if key == "stream" else getattr(_DEFAULT, key)
    return named_in_environment().get(key, default)


@dataclass(frozen=True)
class Connection:
    """Endpoints of the daemon; MMMD_CMD, MMMD_CTL, MMMD_PUB and MMMD_STREAM in the environment name others, for `mmmd run` too.

    Attributes:
        cmd: endpoint of requests.
        ctl: endpoint of stop, estop, reset, arm, park, status.
        pub: endpoint of state and events.
        keys: folder of CURVE keys, for a daemon on another machine (`mmmd keys`).
        stream: endpoint of joint targets; empty takes the place beside `cmd`.
        timeout_s: longest wait for a reply.
    """

    cmd: str = field(default_factory=partial(_endpoint, "cmd"))
    ctl: str = field(default_factory=partial(_endpoint, "ctl"))
    pub: str = field(default_factory=partial(_endpoint, "pub"))
    keys: Path | None = None
    stream: str = field(default_factory=partial(_endpoint, "stream"))
    timeout_s: float = 5.0

    def client(self) -> Client:
        """A client for the daemon.

        Raises:
            CommandError: the time-out is not above zero.
            ConfigError: an endpoint is not a local one and there are no keys.
        """
        if not self.timeout_s > 0:
            raise CommandError(f"--timeout-s {self.timeout_s:g}; allowed: more than 0")
        return self._client(self.timeout_s)

    def client_to_stop(self) -> Client:
        """A client for a stop, which no wrong time-out may keep from being sent.

        Raises:
            ConfigError: an endpoint is not a local one and there are no keys.
        """
        return self._client(self.timeout_s if self.timeout_s > 0 else Connection.timeout_s)

    def _client(self, timeout_s: float) -> Client:
        from daemon.client import Client

        return Client(self.endpoints, timeout_s)

    def async_client(self) -> AsyncClient:
        """An asyncio client for the daemon.

        Raises:
            ConfigError: an endpoint is not a local one and there are no keys.
        """
        from daemon.client import AsyncClient

        return AsyncClient(self.endpoints, self.timeout_s)

    @property
    def endpoints(self) -> Endpoints:
        """Checked endpoints.

        Raises:
            ConfigError: an endpoint is not local and there are no keys.
        """
        return Endpoints(self.cmd, self.ctl, self.pub, self.keys, self.stream)
