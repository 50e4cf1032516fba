"""`mmmd edit`: generates a stretch, an end or a body part of a motion anew, into a file or on the robot."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any, Literal

import tyro
from tyro.conf import OmitArgPrefixes

from daemon.cli.connection import Connection
from daemon.cli.play_flags import PlayFlags, built, play
from daemon.errors import CommandError


def edit(
    motion: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="F.npz|gesture:NAME|command:ID|plan:N")],
    text: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="TEXT")],
    out: Path | None = None,
    start_s: float | None = None,
    end_s: float | None = None,
    part: tuple[str, ...] = (),
    before_s: float = 0.0,
    after_s: float = 0.0,
    then: Path | None = None,
    seed: int = 0,
    bvh: Path | None = None,
    bvh_names: Literal["mmmd", "cmu", "mixamo"] = "mmmd",
    model: Path | None = None,
    threads: int = 1,
    how: OmitArgPrefixes[PlayFlags] = PlayFlags(),  # noqa: B008
    wait: bool = True,
    json: bool = False,
    at: OmitArgPrefixes[Connection] = Connection(),  # noqa: B008
) -> int:
    """Make a part of a motion again for a text and keep the rest: into a file with --out, else on the robot.

    Of several candidates the first is taken that shows what the text asks. Where none does, the status is 1 and the message
    says what is missing ("not reached"): the robot does not move, and with --out the nearest motion is written.

    Example, on the robot: mmmd edit gesture:wave_right "raise your left arm" --part left_arm

    Example, the middle: mmmd edit wave.npz "clap your hands" --start-s 1 --end-s 2.5 --out edited.npz

    Example, one arm: mmmd edit wave.npz "raise your left arm" --part left_arm --out edited.npz

    Example, a new end: mmmd edit wave.npz "bow" --after-s 2 --out longer.npz

    Example, between two: mmmd edit wave.npz "turn to the left" --then clap.npz --after-s 1 --out joined.npz

    Args:
        motion: .npz written by `mmmd generate` (others need their `features`); on the robot one in the daemon's folder of
            motions, or a gesture, or what a command or plan played.
        text: what the new part is to be.
        out: .npz file to write; without it the daemon plays the result.
        start_s: where the new stretch begins, seconds; with neither --start-s nor --end-s all of it.
        end_s: where it ends.
        part: body parts to make again; the others keep what they do. The shipped model has left_arm, right_arm, rest.
        before_s: a new beginning of so many seconds.
        after_s: a new end of so many seconds; with --then the time between.
        then: a second motion that follows.
        seed: the same input and seed give the same motion.
        bvh: BVH file to write as well.
        bvh_names: its bones: mixamo or cmu as retargeting programs know them, or our joints.
        model: checkpoint; the shipped one when it is not given.
        threads: CPU threads.
        how: on the robot: how it is to be played.
        wait: on the robot: return when the motion has ended; --no-wait returns once it is accepted.
        json: on the robot: print each event as one JSON object a line.
        at: on the robot: where the daemon is.
    """
    if out is None:
        if before_s or after_s or then or bvh or model:
            raise CommandError(
                "edit: --before-s, --after-s, --then, --bvh and --model need --out, the .npz file to write"
            )
        return play(_request(motion, text, part, start_s, end_s, seed, how), at, wait=wait, json=json)
    from mmm_core.generate.editing import Edit, extend, in_between
    from mmm_core.generate.editing import edit as edit_motion
    from mmm_core.generate.engine import Engine
    from mmm_core.motion.bvh import save_bvh
    from mmm_core.motion.motion import load_npz

    stretch = start_s is not None or end_s is not None or bool(part)
    longer = bool(before_s or after_s or then)
    if stretch and longer:
        raise CommandError("edit: --start-s, --end-s and --part make a stretch again; --before-s, --after-s and --then "
                           "add to the motion: give one or the other")  # fmt: skip
    if then is not None and (before_s or not after_s):
        raise CommandError("edit: --then needs --after-s, the seconds between the two motions, and no --before-s")
    for path in filter(None, (out, bvh)):
        if not path.parent.is_dir():
            raise CommandError(f"edit: {path}: no folder '{path.parent}'; make it, or choose another")
    first = load_npz(Path(motion))
    second = None if then is None else load_npz(then)
    engine = Engine.load(model, threads=threads)
    if second is not None:
        made = in_between(engine, first, second, after_s, text, seed=seed)
    elif longer:
        made = extend(engine, first, text, before_s=before_s, after_s=after_s, seed=seed)
    else:
        made = edit_motion(engine, first, Edit(start_s or 0.0, end_s, part or None), text, seed=seed)
    made.motion.save_npz(out)
    if bvh is not None:
        save_bvh(made.motion, bvh, bvh_names)
    shows = f"; the new part {made.asked}" if made.asked and made.reached else ""
    sys.stdout.write(f"{out}: {len(made.motion.joints_m)} frames at {made.motion.fps:g} fps{shows}\n")
    if not made.reached:
        sys.stderr.write(
            f"mmmd: edit: not reached: asked was a motion that {made.asked}; found: {made.missing}; edit a longer stretch or more "
            "parts of the body, or take other words or another --seed\n"
        )
    return 0 if made.reached else 1


def _request(
    motion: str, text: str, part: tuple[str, ...], start_s: float | None, end_s: float | None, seed: int, how: PlayFlags
) -> Any:
    """The request for the daemon.

    Raises:
        CommandError: a value is not allowed.
    """
    from daemon.wire.requests import Edit

    kind, _, name = motion.partition(":")
    source: dict[str, Any] = {"file": motion}
    if kind in ("gesture", "command"):
        source = {kind: name}
    elif kind == "plan":
        if not name.isdigit():
            raise CommandError(f"edit: {motion!r}; allowed: plan:N with the plan's number, for example plan:3")
        source = {"plan": int(name)}
    return built(Edit, how, text=text, parts=list(part), start_s=start_s or 0.0, end_s=end_s, seed=seed, **source)
