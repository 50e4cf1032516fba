"""CURVE keys: the own pair, the allowed clients, the trusted daemons and generators.

A folder holds `own.key` (mode 600), `allowed/NAME.pub` and `trusted/daemon.pub`, `trusted/generator.pub`. Both sides have
such a folder: the daemon has in `allowed` the public key of a client's `own.key`, and the client has the daemon's in `trusted`.
"""

from __future__ import annotations

import logging
import os
import re
import struct
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import zmq
import zmq.utils.z85

from daemon.errors import ConfigError

log = logging.getLogger(__name__)

KEY_LENGTH = 40
"""Characters of a CURVE key in Z85, ZeroMQ's notation; many of them have a meaning in a shell."""
HEX_LENGTH = 64
"""Digits of a CURVE key in hexadecimal, the notation that people paste."""
ZAP = "inproc://zeromq.zap.01"
_POLL_MS = 100
_NAME = re.compile(r"[A-Za-z0-9_.-]{1,64}")
ROLES = ("daemon", "generator")


def default_folder() -> Path:
    """$MMMD_KEYS, else mmmd/keys in the user's configuration folder."""
    if chosen := os.environ.get("MMMD_KEYS"):
        return Path(chosen)
    config = os.environ.get("XDG_CONFIG_HOME") or str(Path.home() / ".config")
    return Path(config) / "mmmd" / "keys"


@dataclass(frozen=True)
class KeyPair:
    """A CURVE key pair, in Z85."""

    public: bytes
    secret: bytes


class KeyFolder:
    """Keys in a folder."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def new(self) -> KeyPair:
        """Create the own key pair.

        Raises:
            ConfigError: a pair exists already, or cannot be written.
        """
        file = self.path / "own.key"
        if file.exists():
            do = "remove it to make another: whoever allowed or trusted the old one must be given the new one"
            raise ConfigError(f"{file}: there is a key already; {do}")
        public, secret = zmq.curve_keypair()
        try:
            self.path.mkdir(parents=True, exist_ok=True, mode=0o700)
            fd = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
            with os.fdopen(fd, "wb") as f:
                f.write(b"public " + public + b"\nsecret " + secret + b"\n")
        except OSError as error:
            raise ConfigError(f"{file}: cannot be written ({error}); name another folder with --keys") from error
        return KeyPair(public, secret)

    def own(self) -> KeyPair:
        """The own key pair.

        Raises:
            ConfigError: the pair is missing, damaged, or readable by others.
        """
        file = self.path / "own.key"
        try:
            if file.stat().st_mode & 0o077:
                raise ConfigError(f"{file}: others may read this secret key; `chmod 600 {file}`")
            rows = dict(line.split() for line in file.read_text("ascii").splitlines() if line.strip())
            return KeyPair(checked_key(rows["public"]), checked_key(rows["secret"]))
        except FileNotFoundError:
            raise ConfigError(f"{file}: no key there; `mmmd keys new` makes one") from None
        except (OSError, KeyError, UnicodeDecodeError, ValueError) as error:
            if isinstance(error, ConfigError):
                raise
            raise ConfigError(f"{file}: no key pair to be read there ({error}); remove it, `mmmd keys new`") from error

    def allow(self, name: str, public: str) -> None:
        """Allow the owner of a public key to connect.

        Raises:
            ConfigError: the name or the key is malformed, or cannot be written.
        """
        if not _NAME.fullmatch(name):
            raise ConfigError(f"name {name!r}; allowed: 1 to 64 letters, digits, '_', '.' and '-'")
        self._write("allowed", name, checked_key(public))

    def trust(self, role: str, public: str) -> None:
        """Set the public key of the daemon or generator to connect to.

        Raises:
            ConfigError: the role is unknown, or the key is malformed or cannot be written.
        """
        if role not in ROLES:
            raise ConfigError(f"trust {role!r}; allowed: {', '.join(ROLES)}")
        self._write("trusted", role, checked_key(public))

    def allowed(self) -> dict[str, bytes]:
        """Public keys of the allowed clients, by name; malformed files are left out and logged."""
        return self._read("allowed")

    def trusted(self) -> dict[str, bytes]:
        """The known public keys of daemon and generator, by role."""
        return self._read("trusted")

    def server_of(self, role: str) -> bytes:
        """The public key of the daemon or the generator.

        Raises:
            ConfigError: the key is not known.
        """
        found = self.trusted().get(role)
        if found is None:
            do = f"`mmmd keys new` prints it there; here: `mmmd keys trust {role} KEY`"
            raise ConfigError(f"{self.path}/trusted/{role}.pub: the {role}'s public key is not known; {do}")
        return found

    def _write(self, kind: str, name: str, public: bytes) -> None:
        file = self.path / kind / f"{name}.pub"
        try:
            file.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
            file.write_bytes(public + b"\n")
        except OSError as error:
            raise ConfigError(f"{file}: cannot be written ({error}); name another folder with --keys") from error

    def _read(self, kind: str) -> dict[str, bytes]:
        found: dict[str, bytes] = {}
        for file in sorted((self.path / kind).glob("*.pub")):
            try:
                found[file.stem] = checked_key(file.read_text("ascii"))
            except (OSError, ConfigError, UnicodeDecodeError) as error:
                log.warning("%s is left out: %s", file, error)
        return found


def as_hex(key: bytes) -> str:
    """A key in hexadecimal: letters and digits only, which have no meaning in any shell."""
    return zmq.utils.z85.decode(key).hex()


def checked_key(text: str) -> bytes:
    """A key in Z85, from a text in hexadecimal or in Z85.

    Raises:
        ConfigError: the text is no key.
    """
    key = text.strip()
    allowed = f"allowed: {HEX_LENGTH} hexadecimal digits, as `mmmd keys list` prints them, or {KEY_LENGTH} of Z85"
    if len(key) == HEX_LENGTH and re.fullmatch(r"[0-9a-fA-F]+", key):
        return zmq.utils.z85.encode(bytes.fromhex(key))
    if len(key) != KEY_LENGTH or not key.isascii():
        raise ConfigError(f"key of {len(key)} characters; {allowed}")
    try:
        zmq.utils.z85.decode(key)
    except KeyError as error:
        raise ConfigError(f"key with {chr(error.args[0])!r}; {allowed}") from None
    except struct.error:  # five characters stand for four bytes, some for more than these hold
        raise ConfigError(f"key that stands for no 32 bytes; {allowed}") from None
    return key.encode()


def serve_curve(socket: zmq.Socket[Any], keys: KeyFolder) -> None:
    """Make a socket accept only clients with a CURVE key; the context's `Doorkeeper` decides which."""
    own = keys.own()
    socket.setsockopt(zmq.CURVE_SERVER, 1)
    socket.setsockopt(zmq.CURVE_PUBLICKEY, own.public)
    socket.setsockopt(zmq.CURVE_SECRETKEY, own.secret)
    socket.setsockopt(zmq.ZAP_DOMAIN, b"mmmd")


def connect_curve(socket: zmq.Socket[Any], keys: KeyFolder, role: str) -> None:
    """Make a socket connect only to the trusted daemon or generator."""
    own = keys.own()
    socket.setsockopt(zmq.CURVE_SERVERKEY, keys.server_of(role))
    socket.setsockopt(zmq.CURVE_PUBLICKEY, own.public)
    socket.setsockopt(zmq.CURVE_SECRETKEY, own.secret)


class Doorkeeper:
    """Answers ZeroMQ's requests (RFC 27) whether a key is allowed, for all CURVE sockets of one context.

    A key that is not allowed gets status 300, upon which the connection is closed silently: the stranger cannot
    distinguish it from a daemon that is not there. The folder is read for each request, so that a key can be allowed or
    removed while the daemon runs. ZeroMQ asks when a connection begins and never again: a connection that exists when
    its key is removed stays open until either side ends.
    """

    def __init__(self, context: zmq.Context[Any], keys: KeyFolder) -> None:
        self._keys = keys
        self.refused = 0
        self._stopping = threading.Event()
        self._socket: zmq.Socket[bytes] = zmq.Context(shadow=context).socket(zmq.REP)
        self._socket.setsockopt(zmq.LINGER, 0)
        self._socket.bind(ZAP)
        self._thread = threading.Thread(target=self._run, name="doorkeeper", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Stop answering: no new client is let in."""
        self._stopping.set()
        self._thread.join(2.0)
        self._socket.close(0)

    def _run(self) -> None:
        while not self._stopping.is_set():
            try:
                if self._socket.poll(_POLL_MS):
                    self._socket.send_multipart(self._reply(self._socket.recv_multipart()))
            except zmq.ZMQError as error:
                log.error("the doorkeeper's socket: %s", error)
                self._stopping.wait(_POLL_MS / 1e3)

    def _reply(self, question: list[bytes]) -> list[bytes]:
        """The answer to a request; a refusal after an error, because the thread must live on for other clients."""
        try:
            return self._answer(question)
        except Exception:
            log.exception("a client was not let in")
            return _refusal(question)

    def _answer(self, question: list[bytes]) -> list[bytes]:
        if len(question) != 7:  # version, sequence, domain, address, identity, mechanism, credentials
            return _refusal(question)
        version, sequence, _, _, _, mechanism, credentials = question
        name = next((n for n, key in self._names().items() if key == credentials), None)
        if version == b"1.0" and mechanism == b"CURVE" and name is not None:
            return [b"1.0", sequence, b"200", b"OK", name.encode(), b""]
        self.refused += 1
        log.warning("a client without an allowed key was not let in")
        return _refusal(question)

    def _names(self) -> dict[str, bytes]:
        return {name: zmq.utils.z85.decode(key) for name, key in self._keys.allowed().items()}


def _refusal(question: list[bytes]) -> list[bytes]:
    return [b"1.0", question[1] if len(question) > 1 else b"", b"300", b"", b"", b""]
