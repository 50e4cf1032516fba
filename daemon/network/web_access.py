"""Access to the web server: from this machine alone, or with a token; never from a page of another site. No I/O.

A browser sends requests for any page that a person has open. A request that names another site as its origin is therefore
refused, and on loopback a request whose Host is no name of this machine: another site may have made a name point here.
"""

from __future__ import annotations

import hmac
import ipaddress
from collections.abc import Mapping
from dataclasses import dataclass

from daemon.settings.config import config_error

TOKEN_VARIABLE = "MMMD_TOKEN"
"""Environment variable that holds the token."""
SHORTEST_TOKEN = 16
"""Characters of a token at least: enough that it cannot be guessed."""


@dataclass(frozen=True)
class Access:
    """Address of the server, and the token that it requires.

    Attributes:
        host: address to which the server is bound.
        port: its port.
        token: token that a request must carry; empty for none, on a loopback address only.
    """

    host: str
    port: int
    token: str = ""

    def __post_init__(self) -> None:
        """Refuse an address that other machines reach without a token.

        Raises:
            ConfigError: there is no token and the address is not loopback, or the token is short.
        """
        if not self.token and not is_loopback(self.host):
            found = f"{self.host}:{self.port}, which other machines can reach without a token"
            raise config_error("http", found, "a loopback address, or a token", "set $MMMD_TOKEN")
        if self.token and len(self.token) < SHORTEST_TOKEN:
            found, allowed = f"a token of {len(self.token)} characters", f"{SHORTEST_TOKEN} and more"
            raise config_error("token", found, allowed, "leave it out to have one made")

    @property
    def url(self) -> str:
        """The address for a person to open; the token stands behind the #, which browsers do not send."""
        host = "localhost" if self.host in ("0.0.0.0", "::") else f"[{self.host}]" if ":" in self.host else self.host
        return f"http://{host}:{self.port}/" + (f"#token={self.token}" if self.token else "")

    def refusal(self, headers: Mapping[str, str], token: str = "") -> tuple[int, str] | None:
        """The reason why a request is refused, as an HTTP status and a sentence; None for a request that is served.

        Args:
            headers: headers of the request.
            token: token in the request's address, for WebSockets, whose headers a page cannot set.
        """
        host = headers.get("Host", "")
        if not self.token and not is_loopback(_name(host)):
            return 403, f"Host {host!r} is no name of this machine; allowed: localhost, or a loopback address"
        origin = headers.get("Origin")
        if origin is not None and origin.partition("://")[2] != host:
            return 403, f"a page of {origin!r} may not use this server; allowed: http://{host}"
        if self.token:
            scheme, _, given = headers.get("Authorization", "").partition(" ")
            given = given.strip() if scheme.lower() == "bearer" else token
            if not hmac.compare_digest(given.encode(), self.token.encode()):
                return (
                    401,
                    "the token is missing or wrong; send `Authorization: Bearer TOKEN`, or open the address that mmmd printed",
                )
        return None


def address_of(text: str) -> tuple[str, int]:
    """Host and port of `HOST:PORT`, `[HOST]:PORT` or `PORT`.

    Raises:
        ConfigError: the text is none of these.
    """
    host, _, port = text.rpartition(":")
    host = host.strip("[]") or "127.0.0.1"
    if not (port.isascii() and port.isdigit() and int(port) < 65536):
        raise config_error("http", repr(text), "HOST:PORT or PORT, for example 127.0.0.1:5880", "name a free port")
    return host, int(port)


def is_loopback(host: str) -> bool:
    """Whether a name or an address is this machine's own."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def _name(host: str) -> str:
    """The Host header without its port."""
    if host.startswith("["):
        return host[1:].partition("]")[0]
    return host.partition(":")[0]
