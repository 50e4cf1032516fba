"""`mmmd gesture`: play, list, record, teach and add named clips."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Literal

import tyro
from tyro.conf import OmitArgPrefixes

from daemon.cli.client.teach import TeachFlags, teach
from daemon.cli.connection import Connection
from daemon.cli.play_flags import PlayFlags, built, play
from daemon.errors import CommandError

WIDE = 100
"""Columns of a terminal that is wide enough for the whole table."""


def gesture(
    verb: Annotated[Literal["play", "list", "record", "teach", "add"], tyro.conf.Positional],
    name: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="[NAME]")] = "",
    file: Annotated[Path | None, tyro.conf.Positional, tyro.conf.arg(metavar="[F.npz]")] = None,
    command: str = "",
    replace: Annotated[bool, tyro.conf.arg(aliases=["--force"])] = False,
    folder: Path | None = None,
    how: OmitArgPrefixes[PlayFlags] = PlayFlags(),  # noqa: B008
    taught: OmitArgPrefixes[TeachFlags] = TeachFlags(),  # noqa: B008
    wait: bool = True,
    json: bool = False,
    at: OmitArgPrefixes[Connection] = Connection(),  # noqa: B008
) -> int:
    """Play a named gesture, list them, keep the robot's last motion as one, teach one by hand, or add one from a file.

    `teach` parks the robot, cuts its torque, asks first, and records what its joints measure while you lead its arms
    (docs/teaching.md).

    Example: mmmd gesture play wave_right --repeat 2

    Example: mmmd say "bow slowly" && mmmd gesture record my_bow

    Example: mmmd generate "salute" --out s.npz && mmmd gesture add my_salute s.npz

    Example: mmmd gesture teach my_wave --text "waves at the door" --play

    Args:
        verb: play, list (all the library), record (the motion of a command), teach (by hand) or add (a motion file).
        name: of the gesture; for all but list.
        file: .npz of `mmmd generate`; for add.
        command: id of the command whose motion to record; the newest when it is not given.
        replace: for record, teach and add: take the place of a gesture of that name.
        folder: where your own gestures are; your data folder when it is not given. For list, teach and add.
        how: how it is to be played.
        taught: how it is taught.
        wait: return when the motion has ended; --no-wait returns once it is accepted.
        json: print events, or the list, as JSON.
        at: where the daemon is; for play, record and teach.
    """
    if verb == "list":
        return _list(folder, json)
    if not name:
        raise CommandError(f"gesture {verb}: no name; allowed: a name of `mmmd gesture list`, or a new one")
    if verb == "add":
        return _add(name, file, folder, replace=replace)
    if verb == "teach":
        return teach(name, taught, at, folder, replace=replace)
    if verb == "record":
        with at.client() as robot:
            ack = robot.record(name, command, replace=replace)
        sys.stdout.write(f"recorded {ack.note}\n")
        return 0
    from daemon.wire.requests import Gesture

    return play(built(Gesture, how, name=name), at, wait=wait, json=json)


def _list(folder: Path | None, json: bool) -> int:
    from daemon.gestures.library import GestureLibrary

    infos = GestureLibrary(folder).infos()
    if json:
        import msgspec

        sys.stdout.write(msgspec.json.encode(infos).decode() + "\n")
        return 0
    from rich.console import Console

    from daemon.cli.tables import table_of

    console = Console()
    columns = ("name", "shows", "s", "goes round", "held at", "other side", "own")
    shown = columns if console.width >= WIDE else columns[:3]  # a name that is cut off cannot be typed
    table = table_of(shown, ("name", "other side"), f"{len(infos)} gestures")
    for i in infos:
        loop, own = "in part" if i.loop else "as a whole", ", ".join(filter(None, ("yes" if i.own else "", i.side)))
        row = (i.name, i.text, f"{i.seconds:.1f}", loop, f"{i.hold_s:.1f} s", i.mirror, own)
        table.add_row(*row[: len(shown)])
    console.print(table)
    return 0


def _add(name: str, file: Path | None, folder: Path | None, *, replace: bool) -> int:
    from daemon.gestures.library import GestureLibrary
    from daemon.poses.pose_sequence import posture_of
    from mmm_core.motion.motion import load_npz

    if file is None:
        raise CommandError(f"gesture add {name}: no file; allowed: an .npz of `mmmd generate`")
    motion = load_npz(file)
    library = GestureLibrary(folder)
    clip = library.keep(name, motion.text or name, posture_of(motion), f"file {file.name}", replace=replace)
    sys.stdout.write(f"added {name} ({len(clip.posture) / clip.posture.fps:.1f} s) to {library.folder}\n")
    return 0
