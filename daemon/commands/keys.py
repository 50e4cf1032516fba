"""`mmmd keys`: who may talk to whom over the network."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Literal

import tyro

from daemon.errors import CommandError


def keys(
    verb: Annotated[Literal["new", "allow", "trust", "list"], tyro.conf.Positional],
    name: Annotated[str, tyro.conf.Positional] = "",
    key: Annotated[str, tyro.conf.Positional] = "",
    keys: Path | None = None,
) -> int:
    """Make a key, allow a client's, trust a daemon's or a generator's, list all.

    To forbid a client again, remove DIR/allowed/NAME.pub: it cannot connect any more. A connection that stands goes on until the
    client or the daemon ends.

    Example, on the robot: mmmd keys new && mmmd run --keys ~/.config/mmmd/keys --cmd tcp://0.0.0.0:5871 ...

    Example, on the robot, with what `mmmd keys new` printed on the laptop: mmmd keys allow laptop PUBLIC

    Example, on the laptop, with what it printed on the robot: mmmd keys trust daemon PUBLIC

    Args:
        verb: new (make one's own key and print its public half), allow NAME KEY (let a client in), trust daemon|generator
            KEY (whom to talk to), list.
        name: of the client, or daemon or generator.
        key: its public key.
        keys: folder of the keys; your configuration folder when it is not given.
    """
    from daemon.keys import KeyFolder, default_folder

    folder = KeyFolder(keys or default_folder())
    if verb in ("allow", "trust") and not (name and key):
        raise CommandError(f"keys {verb}: a name and a public key belong to it; `mmmd keys --help` shows how")
    if verb == "new":
        pair = folder.new()
        sys.stdout.write(f"{pair.public.decode()}\n")
    elif verb == "allow":
        folder.allow(name, key)
    elif verb == "trust":
        folder.trust(name, key)
    else:
        lines = [f"own      {folder.own().public.decode()}"]
        lines += [f"allowed  {public.decode()}  {who}" for who, public in folder.allowed().items()]
        lines += [f"trusted  {public.decode()}  {who}" for who, public in folder.trusted().items()]
        sys.stdout.write("\n".join(lines) + "\n")
    return 0
