"""Options and output shared by the commands that talk to a daemon."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from daemon.settings.config import Endpoints

if TYPE_CHECKING:
    from daemon.client import AsyncClient, Client

_DEFAULT = Endpoints()


@dataclass(frozen=True)
class Connection:
    """Endpoints of the daemon.

    Attributes:
        cmd: endpoint of requests.
        ctl: endpoint of stop, estop, reset, arm, park, status.
        pub: endpoint of state and events.
        keys: folder of CURVE keys, for a daemon on another machine (`mmmd keys`).
        stream: endpoint of joint targets; empty takes the place beside `cmd`.
        timeout_s: longest wait for a reply.
    """

    cmd: str = _DEFAULT.cmd
    ctl: str = _DEFAULT.ctl
    pub: str = _DEFAULT.pub
    keys: Path | None = None
    stream: str = ""
    timeout_s: float = 5.0

    def client(self) -> Client:
        """A client for the daemon.

        Raises:
            ConfigError: an endpoint is not a local one and there are no keys.
        """
        from daemon.client import Client

        return Client(self.endpoints, self.timeout_s)

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
