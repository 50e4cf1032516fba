"""`mmmd keys`: keys that decide which machines may connect over the network."""

from __future__ import annotations

import re
import socket
import sys
from pathlib import Path
from typing import Annotated, Literal

import tyro

from daemon.errors import CommandError


def keys(
    verb: Annotated[Literal["new", "allow", "trust", "list"], tyro.conf.Positional],
    name: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="[NAME]")] = "",
    key: Annotated[str, tyro.conf.Positional] = "",
    keys: Path | None = None,
) -> int:
    """Make a key, allow a client's, trust a daemon's or a generator's, list all.

    To forbid a client again, remove DIR/allowed/NAME.pub: it cannot connect any more. A connection that stands goes on until the
    client or the daemon ends.

    Example, on the robot: mmmd keys new && mmmd run --keys ~/.config/mmmd/keys --cmd tcp://0.0.0.0:5871 ...

    `mmmd keys new` prints the public key in hexadecimal, and the lines to paste on the other machine.

    Example, on the robot, with the key that `mmmd keys new` printed on the laptop: mmmd keys allow laptop PUBLIC

    Example, on the laptop, with the key that it printed on the robot: mmmd keys trust daemon PUBLIC

    Args:
        verb: new (make one's own key and print its public half), allow NAME KEY (let a client in), trust daemon|generator
            KEY (whom to talk to), list.
        name: name of the client; for trust: daemon or generator.
        key: public key of the other machine, in hexadecimal or in quoted Z85.
        keys: folder of the keys; your configuration folder when it is not given.
    """
    from daemon.network.keys import KeyFolder, as_hex, default_folder

    folder = KeyFolder(keys or default_folder())
    if verb in ("allow", "trust") and not (name and key):
        raise CommandError(f"keys {verb}: a name and a public key belong to it; `mmmd keys --help` shows how")
    if verb == "new":
        public = as_hex(folder.new().public)
        sys.stdout.write(f"{public}\n")
        sys.stdout.flush()
        sys.stderr.write(_to_paste(public))
    elif verb == "allow":
        folder.allow(name, key)
        sys.stdout.write(f"{name} may connect from now on\n")
    elif verb == "trust":
        folder.trust(name, key)
        sys.stdout.write(f"this is the {name} that is talked to from now on\n")
    else:
        lines = [f"own      {as_hex(folder.own().public)}"]
        lines += [f"allowed  {as_hex(public)}  {who}" for who, public in folder.allowed().items()]
        lines += [f"trusted  {as_hex(public)}  {who}" for who, public in folder.trusted().items()]
        sys.stdout.write("\n".join(lines) + "\n")
    return 0


def _to_paste(public: str) -> str:
    """The commands for the other machine, for each role that this machine may have."""
    here = re.sub(r"[^A-Za-z0-9_.-]", "-", socket.gethostname())[:64] or "here"
    return (
        "on the other machine paste one of these lines:\n"
        f"  when this one is a client:         mmmd keys allow {here} {public}\n"
        f"  when the daemon runs on this one:  mmmd keys trust daemon {public}\n"
        f"  when a generator runs on this one: mmmd keys trust generator {public}\n"
    )
