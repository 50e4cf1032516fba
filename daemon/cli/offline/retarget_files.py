"""Retargets one file, or a folder of thousands: resumable, on all cores or a Dask cluster.

An output file appears under its name only when it is complete, so that existing ones need not be made again. `retarget.json` beside
the outputs contains the robot and the settings: another robot or setting needs another folder.
"""

from __future__ import annotations

import json
import multiprocessing
import os
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from daemon.errors import CommandError
from mmm_core.imports.recordings.files import read_motion
from mmm_core.motion.motion import Motion
from mmm_core.motion.skeleton import quat_wxyz
from retarget.errors import MotionError, RetargetError
from retarget.human.poser import ArmsFollow
from retarget.path.paths import JointPath
from retarget.pipeline import Retargeter
from retarget.robot.loading import load_robot
from retarget.robot.ticks import JointServoMap

MANIFEST = "retarget.json"
_DASK_BATCH = 16


@dataclass(frozen=True)
class Settings:
    """Settings of retargeting.

    Attributes:
        robot: name of a packaged robot, or the path of a robot.toml.
        arms_follow: see `Retargeter`.
        keep_contacts: whether hands that touch the body or each other touch on the robot too.
        most_error_deg: slow down until the mean direction error is at most this; None for as fast as the human.
        fps: frames per second of the files; None to take the files' own.
    """

    robot: str
    arms_follow: ArmsFollow = "chest"
    keep_contacts: bool = False
    most_error_deg: float | None = None
    fps: float | None = None


def retarget_file(settings: Settings, motion_path: Path, out: Path) -> JointPath:
    """Retarget one file; an older output stays intact if that fails.

    Raises:
        MmmError, RetargetError: the file or the robot cannot be used.
    """
    retargeter = _retargeter(settings)
    motion = read_motion(motion_path, settings.fps)
    try:
        path = retargeter.retarget(motion, most_error_deg=settings.most_error_deg)
    except MotionError as error:
        raise MotionError(error.key, error.found, error.allowed, str(motion_path)) from error
    write_path(retargeter, motion, path, out)
    return path


def write_path(retargeter: Retargeter, motion: Motion, path: JointPath, out: Path) -> None:
    """Write a path with ticks, key points and report as DESIGN section 12 lays down."""
    kinematics, q_rad = retargeter.kinematics, path.q_rad
    head = next((p.chain for p in kinematics.key_points if p.name == "head"), ())
    columns = [kinematics.turn(head, q_rad, axis) for axis in np.eye(3)]
    partial = out.with_name(f"{out.name}.{os.getpid()}.part")
    try:
        with partial.open("wb") as f:
            np.savez_compressed(
                f,
                q_rad=q_rad,
                joint_names=np.array(path.joint_names),
                rate_hz=np.float64(path.rate_hz),
                ticks=JointServoMap(retargeter.robot).rad_to_tick(q_rad),
                servo_ids=np.array(retargeter.robot.servo_ids, np.int32),
                keypoints=kinematics.places(q_rad).astype(np.float32),
                keypoint_names=np.array([p.name for p in kinematics.key_points]),
                up_axis=np.array("z"),
                head_quat_wxyz=quat_wxyz(np.stack(columns, -1)).astype(np.float32),
                text=np.array(motion.text),
                report=np.array(json.dumps(path.report.as_dict())),
            )
        os.replace(partial, out)
    finally:
        partial.unlink(missing_ok=True)


@dataclass(frozen=True)
class Done:
    """Result for one file of many: `error` is empty when its output was written."""

    path: str
    error: str


def start_folder(settings: Settings, motions: list[Path], folder: Path, out: Path) -> list[tuple[Path, Path]]:
    """Pairs of input files without output and their output files; writes the manifest.

    Raises:
        CommandError: the output folder holds results of other settings, or two inputs have one name.
    """
    out.mkdir(parents=True, exist_ok=True)
    manifest = {"format": 1, **asdict(settings)}
    file = out / MANIFEST
    if file.is_file():
        there = json.loads(file.read_text("utf-8"))
        if there != manifest:
            raise CommandError(f"{file}: results of {there}; asked for {manifest}: choose another folder for --out")
    file.write_text(json.dumps(manifest) + "\n", "utf-8")
    pairs = [(path, (out / path.relative_to(folder)).with_suffix(".npz")) for path in motions]
    if len({target for _, target in pairs}) < len(pairs):
        names = sorted({str(t) for _, t in pairs if sum(t == u for _, u in pairs) > 1})
        raise CommandError(f"{folder}: several inputs would be written to {names[0]}; keep one kind of file a folder")
    left = [(path, target) for path, target in pairs if not target.is_file()]
    for parent in {target.parent for _, target in left}:
        parent.mkdir(parents=True, exist_ok=True)
    return left


def on_cores(settings: Settings, pairs: list[tuple[Path, Path]], n_workers: int) -> Iterator[Done]:
    """Retarget pairs of input and output in `n_workers` processes; yield results in the order of completion."""
    jobs = ((settings, path, target) for path, target in pairs)
    if n_workers == 1:
        yield from map(_one, jobs)
        return
    # Spawned, not forked: a fork of a process that has threads may hang.
    with multiprocessing.get_context("spawn").Pool(n_workers, _alone) as pool:
        yield from pool.imap_unordered(_one, jobs, chunksize=4)


def on_dask(settings: Settings, pairs: list[tuple[Path, Path]], address: str) -> Iterator[Done]:
    """Retarget pairs on the workers of a Dask cluster, which must see the same files under the same paths.

    Raises:
        CommandError: Dask is not installed, or no scheduler answers at the address.
    """
    try:
        import distributed
    except ImportError as error:
        raise CommandError("--dask needs Dask: pip install '.[dask]'") from error
    library: Any = distributed
    jobs = [(settings, path.resolve(), target.resolve()) for path, target in pairs]
    batches = [jobs[i : i + _DASK_BATCH] for i in range(0, len(jobs), _DASK_BATCH)]
    try:
        client = library.Client(address, timeout="20s")
    except (OSError, ValueError) as error:
        raise CommandError(f"--dask {address}: no cluster answers there ({error})") from error
    with client:
        futures = client.map(_some, batches, pure=False)
        for _, done in library.as_completed(futures, with_results=True):
            yield from done


def _alone() -> None:
    """Limit a worker to one thread of arithmetic: there is a worker for each core."""
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ[name] = "1"


def _some(jobs: Iterable[tuple[Settings, Path, Path]]) -> list[Done]:
    return [_one(job) for job in jobs]


def _one(job: tuple[Settings, Path, Path]) -> Done:
    from mmm_core.errors import MmmError

    settings, path, target = job
    try:
        retarget_file(settings, path, target)
    except (MmmError, RetargetError, OSError) as error:
        return Done(str(path), str(error))
    return Done(str(path), "")


@lru_cache(maxsize=4)
def _retargeter(settings: Settings) -> Retargeter:
    return Retargeter(load_robot(settings.robot), settings.arms_follow, keep_contacts=settings.keep_contacts)
