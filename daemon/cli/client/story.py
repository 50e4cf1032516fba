"""`mmmd story` and `mmmd inbetween`: several texts in one motion, poses at given times."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro
from tyro.conf import OmitArgPrefixes

from daemon.cli.connection import Connection
from daemon.cli.play_flags import PlayFlags, built, play
from daemon.errors import CommandError

if TYPE_CHECKING:
    from daemon.wire.requests import KeyPoseOf, SceneOf


def story(
    texts: Annotated[tuple[str, ...], tyro.conf.Positional] = (),
    scenes: Path | None = None,
    seed: int = 0,
    how: OmitArgPrefixes[PlayFlags] = PlayFlags(),  # noqa: B008
    wait: bool = True,
    json: bool = False,
    at: OmitArgPrefixes[Connection] = Connection(),  # noqa: B008
) -> int:
    """Play several texts one after another in one motion, with generated transitions.

    Example: mmmd story "wave with your right hand" "clap your hands" "bow"

    Example, without end: mmmd story "nod" "shake your head" --loop --no-wait

    Example, with lengths: mmmd story --scenes scenes.jsonl, of lines such as {"text": "bow", "seconds": 2.5}

    Args:
        texts: what to do, in order.
        scenes: file with one JSON object a line instead of texts: "text" and, if wanted, "seconds".
        seed: the same texts and seed give the same motion.
        how: how it is to be played; a story has no --hold.
        wait: return when the story has ended; --no-wait returns once it is accepted.
        json: print each event as one JSON object a line.
        at: where the daemon is.
    """
    from daemon.wire.requests import SceneOf, Story

    if bool(texts) == (scenes is not None):
        raise CommandError('story: give texts or --scenes; example: mmmd story "wave" "bow"')
    parts = [SceneOf(text=text) for text in texts] if scenes is None else _scenes(scenes)
    return play(built(Story, how, scenes=parts, seed=seed), at, wait=wait, json=json)


def inbetween(
    poses: Annotated[tuple[str, ...], tyro.conf.Positional, tyro.conf.arg(metavar="POSE@SECONDS")],
    text: str = "",
    seed: int = 0,
    how: OmitArgPrefixes[PlayFlags] = PlayFlags(),  # noqa: B008
    wait: bool = True,
    json: bool = False,
    at: OmitArgPrefixes[Connection] = Connection(),  # noqa: B008
) -> int:
    """Pass through poses at given times; the motion between them is generated.

    Example: mmmd inbetween raise_left@1 bow@2.5 standing@4

    Example: mmmd inbetween salute_right@1.5 standing@3 --text "turn your head to the left"

    Args:
        poses: a gesture, command:ID, or standing, each with the time at which it is shown, in order.
        text: what happens between them.
        seed: the same poses, text and seed give the same motion.
        how: how it is to be played.
        wait: return when the motion has ended; --no-wait returns once it is accepted.
        json: print each event as one JSON object a line.
        at: where the daemon is.
    """
    from daemon.wire.requests import Inbetween

    request = built(Inbetween, how, poses=[_pose(asked) for asked in poses], text=text, seed=seed)
    return play(request, at, wait=wait, json=json)


def _pose(asked: str) -> KeyPoseOf:
    """A pose with its time.

    Raises:
        CommandError: the text is no pose with a time.
    """
    from daemon.wire.requests import KeyPoseOf

    name, _, seconds = asked.rpartition("@")
    try:
        at_s = float(seconds)
    except ValueError:
        name = ""
        at_s = 0.0
    if not name:
        raise CommandError(f"inbetween: {asked!r}; allowed: POSE@SECONDS, for example bow@1.5 or standing@3")
    if name == "standing":
        return KeyPoseOf(at_s=at_s, standing=True)
    if name.startswith("command:"):
        return KeyPoseOf(at_s=at_s, command=name.removeprefix("command:"))
    return KeyPoseOf(at_s=at_s, gesture=name)


def _scenes(path: Path) -> list[SceneOf]:
    """The scenes of a file, one JSON object a line.

    Raises:
        CommandError: the file cannot be read; the error names the line.
    """
    import msgspec

    from daemon.wire.requests import SceneOf

    try:
        lines = path.read_text("utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise CommandError(f"--scenes {path}: cannot be read ({error}); give a text file of JSON lines") from None
    found: list[SceneOf] = []
    for number, line in enumerate(lines, 1):
        if line.strip():
            try:
                found.append(msgspec.json.decode(line, type=SceneOf))
            except msgspec.MsgspecError as error:
                allowed = '{"text": ..., "seconds": ...}, one a line'
                raise CommandError(f"--scenes {path}: line {number}: {error}; allowed: {allowed}") from None
    return found
