"""`mmmd say`: command the robot by a text."""

from __future__ import annotations

from typing import Annotated

import tyro
from tyro.conf import OmitArgPrefixes

from daemon.cli.connection import Connection
from daemon.cli.play_flags import PlayFlags, built, play


def say(
    text: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="TEXT")],
    seed: int = 0,
    seconds: float | None = None,
    prefix_s: float = 0.0,
    how: OmitArgPrefixes[PlayFlags] = PlayFlags(),  # noqa: B008
    wait: bool = True,
    json: bool = False,
    at: OmitArgPrefixes[Connection] = Connection(),  # noqa: B008
) -> int:
    """Tell the robot what to do, and how it went. Ctrl-C cancels it: the robot brakes and holds.

    Example: mmmd say "wave with your right hand" --seed 3

    Example, until something else comes: mmmd say "clap your hands" --loop --tempo 1.3 --no-wait

    Args:
        text: what to do, in English.
        seed: the same text, seed and seconds give the same motion.
        seconds: length of the motion; the model chooses when it is not given.
        prefix_s: seconds of the running motion, 0.2 to 1.6, that the new one continues from: the longer, the smoother the
            transition, and the less of the text shows. 0 for none.
        how: how it is to be played.
        wait: return when the motion has ended; --no-wait returns once it is accepted.
        json: print each event as one JSON object a line.
        at: where the daemon is.
    """
    from daemon.wire.requests import Say

    return play(built(Say, how, text=text, seed=seed, seconds=seconds, prefix_s=prefix_s), at, wait=wait, json=json)
