"""`mmmd render` and `mmmd plot`: pictures and films of a motion or a run."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import tyro

if TYPE_CHECKING:
    from rich.console import Console

_SIZES = {".png": "a contact sheet of eight instants", ".gif": "a film", ".mp4": "a film"}


def render(
    file: Annotated[Path, tyro.conf.Positional],
    out: Path,
    robot: str | None = None,
    show: Literal["both", "robot", "person"] = "both",
    view: Literal["front", "half", "side"] = "half",
    width: int = 640,
    height: int = 480,
    from_s: float = 0.0,
    to_s: float | None = None,
) -> int:
    """Draw a motion or a recorded run in three dimensions: a contact sheet (.png) or a film (.gif, .mp4).

    A motion (.npz of `mmmd generate`) shows the person and the robot that follows. A run (.mcap of `mmmd run --log`) shows the
    robot as it was measured, with the goals that were sent as a transparent second robot. An .mp4 needs `pip install mmmd[film]`.

    Example: mmmd render wave.npz --robot op3 --out wave.gif
    or: mmmd render run.mcap --from-s 3 --to-s 8 --out run.mp4

    Args:
        file: an .npz of `mmmd generate`, or an .mcap of `mmmd run --log`.
        out: the picture or film to write; its suffix says which: .png, .gif or .mp4.
        robot: name or robot.toml; reference for a motion and the run's own robot when not given.
        show: the robot, the person, or both side by side (a run has no person).
        view: from the front, from the front a little to the robot's left, or from its left side.
        width: pixels of a film; a contact sheet has its own size.
        height: pixels of a film.
        from_s: second to begin at.
        to_s: second to end at; the end when not given.
    """
    from rich.console import Console
    from rich.progress import track

    from daemon.errors import CommandError
    from daemon.pictures.drawing import contact_sheet, frames
    from daemon.pictures.film import write_film
    from daemon.pictures.performance import RUN_FPS, read_performance
    from daemon.pictures.picture_files import check_picture

    check_picture(out, "--out", tuple(_SIZES))
    if not (_even(width) and _even(height)):
        raise CommandError(f"--width {width} --height {height}: allowed are even numbers from 160 to 3840")
    for name, seconds in (("--from-s", from_s), ("--to-s", to_s)):
        if seconds is not None and not math.isfinite(seconds):
            raise CommandError(f"{name} {seconds}; allowed: a number of seconds")
    if to_s is not None and to_s <= from_s:
        raise CommandError(f"--from-s {from_s:g} --to-s {to_s:g}; allowed: an end after the beginning")
    performance = read_performance(file, robot, fps=RUN_FPS, from_s=from_s, to_s=to_s)
    if show == "person" and performance.person_m is None:
        raise CommandError(
            f"--show person: {file} is a recorded run, which holds the robot alone; allowed are robot and both"
        )
    console = Console(stderr=True)
    _warn(console, performance.problem)
    if out.suffix == ".png":
        contact_sheet([performance], show, view).save(out)
    else:
        pictures = frames(performance, show, view, (width, height))
        drawn = track(pictures, "drawing", total=len(performance), console=console, disable=not console.is_terminal)
        write_film(drawn, out, performance.fps)
    Console(soft_wrap=True).print(f"{out}: {_SIZES[out.suffix]}, {performance.duration_s:.1f} s", highlight=False)
    return 0


def _warn(console: Console, problem: str) -> None:
    if problem:
        console.print(f"warning: {problem}", style="yellow", highlight=False, soft_wrap=True)


def _even(pixels: int) -> bool:
    return 160 <= pixels <= 3840 and pixels % 2 == 0


def plot(file: Annotated[Path, tyro.conf.Positional], out: Path, robot: str | None = None) -> int:
    """Draw the joints of a recorded run over time: goal, measured angle, limits, headroom, commands and seams.

    Example: mmmd plot run.mcap --out joints.png

    Args:
        file: an .mcap of `mmmd run --log`.
        out: the picture to write, .png, .svg, .pdf or .jpg.
        robot: name or robot.toml; the run's own robot when not given.
    """
    from rich.console import Console

    from daemon.pictures.joints import joint_plot
    from daemon.pictures.picture_files import check_picture
    from daemon.recording.mcap_reading import read_log
    from retarget.robot.loading import load_robot

    check_picture(out, "--out")
    log = read_log(file)
    _warn(Console(stderr=True), log.problem)
    joint_plot(log, load_robot(robot or log.metadata["robot"]), out)
    Console(soft_wrap=True).print(f"{out}: drawn", highlight=False)
    return 0
