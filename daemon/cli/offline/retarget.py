"""`mmmd retarget`: converts human motion to a robot's joint angles and servo ticks."""

from __future__ import annotations

import json as json_module
import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import tyro

if TYPE_CHECKING:
    from daemon.cli.offline.retarget_files import Settings


def retarget(
    motion: Annotated[Path, tyro.conf.Positional],
    out: Path,
    robot: str = "reference",
    arms_follow: Literal["chest", "world"] = "chest",
    keep_contacts: bool = False,
    most_error_deg: float | None = None,
    fps: float | None = None,
    jobs: int = 0,
    dask: str | None = None,
    json: bool = False,
) -> int:
    """Turn a motion file, or every motion file of a folder, into a robot's path.

    Read are .npz of `mmmd generate` (or any with `joints` (T,22,3) and `fps`), .npy of HumanML3D's new_joints and
    new_joint_vecs, .bvh, and .amc with its .asf beside it.

    A file written holds q_rad (T,J) and joint_names at rate_hz, ticks (T,S) and servo_ids, keypoints (T,K,3) in metres
    with keypoint_names and up_axis, head_quat_wxyz (T,4), and the report as JSON.

    A folder is gone through on all cores. Cut short, it goes on where it was when called again. Files that cannot be used
    are listed at the end and in failed.jsonl.

    Example: mmmd retarget wave.npz --robot op3 --out ticks.npz

    Example, a data set: mmmd retarget HumanML3D --robot toddlerbot --out paths --jobs 8

    Example, on a Dask cluster: mmmd retarget HumanML3D --robot toddlerbot --out paths --dask tcp://10.0.0.5:8786

    Args:
        motion: the file, or the folder.
        out: the .npz to write, or the folder.
        robot: name of a packaged robot, or the path of a robot.toml.
        arms_follow: arms keep their directions against the chest, or against the world (a robot without a waist then
            keeps hanging arms hanging in a bow).
        keep_contacts: hands that touch each other or the body touch on the robot too.
        most_error_deg: go slower than the human until the mean direction error is at most this, as far as slowing down helps.
        fps: frames per second of the files, where they say nothing or the wrong thing (AMC: 120).
        jobs: processes for a folder; 0 for one a core.
        dask: address of a Dask scheduler to use instead.
        json: print the report, or the counts of a folder, as one JSON object.
    """
    from daemon.cli.offline.retarget_files import Settings, retarget_file
    from daemon.errors import CommandError

    _refuse("--fps", fps, 1000.0, "frames per second")
    _refuse("--most-error-deg", most_error_deg, 180.0, "degrees")
    settings = Settings(robot, arms_follow, keep_contacts, most_error_deg, fps)
    if not motion.is_dir() and not out.parent.is_dir():
        raise CommandError(f"--out {out}: there is no folder {out.parent}; make it, or name a file in one there is")
    if motion.is_dir() and (out.is_file() or out.suffix == ".npz"):
        raise CommandError(
            f"--out {out}: {motion} is a folder, whose paths go to a folder; name one, such as {out.stem}"
        )
    if motion.is_dir():
        return _folder(settings, motion, out, jobs or os.cpu_count() or 1, dask, json=json)
    from rich.console import Console

    path = retarget_file(settings, motion, out)
    report = path.report.as_dict()
    console = Console()
    if json:
        console.out(json_module.dumps(report))
    else:
        console.print(f"{out}: {len(path.q_rad)} frames at {path.rate_hz:g} Hz for '{robot}'", highlight=False)
        for key, value in report.items():
            console.print(f"  {key}: {value}", highlight=False)
    return 0


def _refuse(option: str, value: float | None, most: float, unit: str) -> None:
    """Refuse a number outside its range, NaN and infinity included."""
    from daemon.errors import CommandError

    if value is not None and not 0 < value <= most:
        raise CommandError(f"{option} {value:g}: expected more than 0 and at most {most:g} {unit}")


def _folder(settings: Settings, folder: Path, out: Path, jobs: int, dask: str | None, *, json: bool) -> int:
    """Retarget all files of a folder that have no output yet; return 1 when no file could be used."""
    from rich.console import Console
    from rich.progress import track

    from daemon.cli.offline.retarget_files import on_cores, on_dask, start_folder
    from daemon.errors import CommandError
    from mmm_core.imports.recordings.files import KINDS, find_motions
    from retarget.robot.loading import load_robot

    load_robot(settings.robot)  # a wrong name is then one error, not one for each file
    motions = find_motions(folder)
    if not motions:
        raise CommandError(f"{folder}: no motion files; looked for {', '.join(KINDS)}")
    left = start_folder(settings, motions, folder, out)
    done = on_dask(settings, left, dask) if dask else on_cores(settings, left, min(jobs, max(1, len(left))))
    failed: list[dict[str, str]] = []
    for one in track(done, "retargeting", total=len(left), console=Console(stderr=True)):
        if one.error:
            failed.append({"path": one.path, "error": one.error})
    failed.sort(key=lambda row: row["path"])
    (out / "failed.jsonl").write_text("".join(json_module.dumps(row) + "\n" for row in failed), "utf-8")
    counts = {"files": len(motions), "were_there": len(motions) - len(left), "written": len(left) - len(failed)}
    console = Console()
    if json:
        console.out(json_module.dumps({**counts, "failed": failed}))
    else:
        console.print(", ".join(f"{key.replace('_', ' ')}: {n}" for key, n in counts.items()), highlight=False)
        for row in failed:
            console.print(f"not used: {row['error']}", highlight=False, markup=False)
    return 1 if len(failed) == len(motions) else 0
