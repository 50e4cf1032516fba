"""Retargeting: processor time of all stages, direction error, bounds and contacts checked again, and mink on the same arms."""

from __future__ import annotations

import dataclasses
import gc
import time
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.progress import track

from daemon.bench.contacts import ContactCheck
from daemon.bench.motions import bench_motions, cut, glued
from daemon.bench.report import context
from daemon.bench.retarget_peers import mink_figures
from daemon.bench.whole_clip import best_of_clip
from mmm_core.motion.motion import FPS, Motion
from retarget.human.human import read_human
from retarget.path.limits import limit_step
from retarget.path.paths import JointPath, JointState
from retarget.pipeline import Retargeter
from retarget.robot.loading import list_robots, load_robot
from retarget.robot.robot import RobotModel
from retarget.robot.ticks import JointServoMap

Array = NDArray[np.float64]
_CHUNK_FRAMES, _BATCH_FRAMES = 20, 4096
_SPEED_RAD_S, _ACCELERATION_RAD_S2 = 4.8, 40.0
_CHECKED_HZ = (20.0, 200.0)
_CONTACT_HZ = 100.0
_WRIST_SPEEDS_M_S = (2.0, 3.6, float("inf"))
"""Metres a second by which clips are grouped: the speed that the faster wrist keeps below in 99 of 100 frames; 3.6 is that of the
clips on which peers were measured."""
_METHOD = (
    "CPU time of the thread (other work on the machine lengthens wall time, not this); a chunk is 20 frames of a clip that"
    " join on to the path so far, timed from human joints to servo ticks at bus rate; the first frame is the first call of"
    " a new retargeter; direction error is the angle between human and robot bone, both bones of both arms, in every frame"
    " of every clip, after limits and self-contact; violations are samples at 20 and 200 Hz outside a position, velocity or"
    " acceleration bound; collisions are frames at 100 Hz in which MuJoCo finds bodies in contact; causal is the same poses under"
    " the same bounds one frame after another without a look ahead and without self-contact; whole_clip is the least squared"
    " direction error found by one program over all frames of a clip, with the same start, bounds and margins, of which"
    " share_of_optimum is the multiple of its mean that the path has; share_of_optimum_rms the same of the root mean square"
)


def bench_retarget(n: int | None = None, seed: int = 0, robots: tuple[str, ...] = ()) -> dict[str, Any]:
    """The figures, per robot under `robots`, on at most `n` clips, or all when None."""
    what, motions = bench_motions(n, seed)
    names = robots or tuple(list_robots())
    stderr = Console(stderr=True)
    figures = {name: _robot_figures(load_robot(name), motions, stderr) for name in names}
    total = {key: sum(f[key] for f in figures.values()) for key in ("violations", "collisions")}
    return {
        "robots": figures, **total, "motions": what, "clips": len(motions),
        "frames": sum(len(m.joints_m) for m in motions), "peers": mink_figures(motions), **context(seed, _METHOD),
    }  # fmt: skip


def _robot_figures(robot: RobotModel, motions: list[Motion], console: Console) -> dict[str, Any]:
    own = _fidelity(Retargeter(robot), track(motions, robot.name, console=console))
    common = _fidelity(
        Retargeter(with_common_limits(robot)), track(motions, "whole clips", console=console), whole=True
    )
    figures = {**common, "own_limits": own}
    for key in ("violations", "collisions"):
        figures[key] = common[key] + own[key]
    return {**figures, **_times(robot, motions)}


def with_common_limits(robot: RobotModel) -> RobotModel:
    """The robot with the speed and acceleration limits with which peers were measured."""
    joints = tuple(
        dataclasses.replace(j, velocity_limit_rad_s=_SPEED_RAD_S, acceleration_limit_rad_s2=_ACCELERATION_RAD_S2)
        for j in robot.joints
    )
    return dataclasses.replace(robot, joints=joints)


def _fidelity(retargeter: Retargeter, motions: Iterable[Motion], *, whole: bool = False) -> dict[str, Any]:
    """Direction error, the share of it that no limit in time and no contact can explain, violations, collisions.

    With `whole` also the least error that is possible over whole clips, which takes a second or more for each clip.
    """
    check = ContactCheck(retargeter.robot)
    errors: list[Array] = []
    reach: list[Array] = []
    causal: list[Array] = []
    best: list[Array] = []
    speeds_m_s: list[float] = []
    violations = collisions = interventions = 0
    for motion in motions:
        path = retargeter.retarget(motion)
        poses = retargeter.poses(read_human(motion))
        errors.append(retargeter.direction_errors_deg(poses, path.q_rad[: len(motion.joints_m)]))
        reach.append(retargeter.direction_errors_deg(poses, poses.q_rad))
        causal.append(retargeter.direction_errors_deg(poses, causal_path(poses.q_rad, retargeter)))
        if whole:
            best.append(best_of_clip(retargeter, poses, path).errors_deg)
        speeds_m_s.append(wrist_speed_m_s(motion))
        violations += sum(_violations(path, retargeter, rate_hz) for rate_hz in _CHECKED_HZ)
        collisions += check.frames(path.at_rate(_CONTACT_HZ))
        interventions += path.report.interventions
    every = np.concatenate([e.ravel() for e in errors])
    by_speed: list[dict[str, float]] = []
    for most in _WRIST_SPEEDS_M_S:
        some = [e for e, speed in zip(errors, speeds_m_s, strict=True) if speed <= most]
        if some:
            by_speed.append(
                {"wrist_m_s": most if np.isfinite(most) else round(max(speeds_m_s), 1), "clips": len(some)}
                | _angles(some)
            )
    return {
        **_angles(errors), **(_of_optimum(errors, best) if whole else {}), "by_wrist_speed": by_speed, "causal": _angles(causal),
        "direction_median_deg": round(float(np.median(every)), 3),
        "clip_mean_median_deg": round(float(np.median([e.mean() for e in errors])), 3),
        "reach_mean_deg": round(float(np.concatenate([e.ravel() for e in reach]).mean()), 3),
        "violations": violations, "collisions": collisions, "interventions": interventions,
    }  # fmt: skip


def _angles(errors_deg: list[Array]) -> dict[str, float]:
    every = np.concatenate([e.ravel() for e in errors_deg])
    return {
        "direction_mean_deg": round(float(every.mean()), 3),
        "direction_p95_deg": round(float(np.percentile(every, 95)), 3),
    }


def _of_optimum(errors_deg: list[Array], best_deg: list[Array]) -> dict[str, Any]:
    """The least direction error that whole clips allow, and the ratio of the path's error to it."""
    ours, best = (np.concatenate([e.ravel() for e in errors]) for errors in (errors_deg, best_deg))
    rms = [float(np.sqrt((e**2).mean())) for e in (ours, best)]
    return {
        "whole_clip": {**_angles(best_deg), "direction_rms_deg": round(rms[1], 3)},
        "direction_rms_deg": round(rms[0], 3),
        "share_of_optimum": round(float(ours.mean() / best.mean()), 3),
        "share_of_optimum_rms": round(rms[0] / rms[1], 3),
    }


def causal_path(wanted_rad: Array, retargeter: Retargeter) -> Array:
    """(T, J) path that starts at rest in the first pose and in each step knows only the next pose."""
    position, velocity, period = wanted_rad[0], np.zeros(wanted_rad.shape[1]), 1 / FPS
    path = np.empty_like(wanted_rad)
    for t, wanted in enumerate(wanted_rad):
        path[t] = limit_step(wanted, position, velocity, retargeter.limits, period)
        position, velocity = path[t], (path[t] - position) / period
    return path


def wrist_speed_m_s(motion: Motion) -> float:
    """Speed in m/s that the faster wrist keeps below in 99 of 100 frames."""
    moved = np.diff(motion.joints_m[:, (20, 21)].astype(np.float64), axis=0)
    return float(np.percentile(np.linalg.norm(moved, axis=-1).max(-1), 99) * motion.fps)


def _violations(path: JointPath, retargeter: Retargeter, rate_hz: float) -> int:
    """Number of samples outside a bound; the path starts at rest."""
    limits, period = retargeter.limits, 1 / rate_hz
    start = path.at(np.zeros(1))
    q = np.concatenate([start, start, path.at_rate(rate_hz)])
    outside = (q < limits.position_min_rad - 1e-12) | (q > limits.position_max_rad + 1e-12)
    fast = np.abs(np.diff(q, axis=0)) > limits.velocity_rad_s * period * (1 + 1e-7)
    hard = np.abs(np.diff(q, n=2, axis=0)) > limits.acceleration_rad_s2 * period**2 * (1 + 1e-6) + 1e-12
    return int(outside.any(1).sum() + fast.any(1).sum() + hard.any(1).sum())


def _times(robot: RobotModel, motions: list[Motion]) -> dict[str, float]:
    chunks: list[float] = []
    first: list[float] = []
    rested: list[Motion] = [m for m in motions if len(m.joints_m) >= _CHUNK_FRAMES]
    retargeter, ticks = Retargeter(robot), JointServoMap(robot)
    at_rest = JointState(robot.rest_rad, np.zeros(robot.n_joints))
    gc.collect()
    gc.disable()
    try:
        for motion in rested[:5]:
            fresh = Retargeter(robot)
            first.append(_timed_s(fresh, ticks, cut(motion, 0, 1), at_rest)[0])
        for motion in rested:
            state: JointState | None = None
            for k in range(0, len(motion.joints_m) - _CHUNK_FRAMES + 1, _CHUNK_FRAMES):
                took_s, state = _timed_s(retargeter, ticks, cut(motion, k, k + _CHUNK_FRAMES), state)
                chunks.append(took_s / _CHUNK_FRAMES)
        batch_s = _timed_s(retargeter, ticks, glued(motions, _BATCH_FRAMES), None)[0] / _BATCH_FRAMES
    finally:
        gc.enable()
    return {
        "chunk20_ms_per_frame": round(1e3 * float(np.mean(chunks)), 4),
        "chunk20_median_ms_per_frame": round(1e3 * float(np.median(chunks)), 4),
        "chunk20_p95_ms_per_frame": round(1e3 * float(np.percentile(chunks, 95)), 4),
        "batch_ms_per_frame": round(1e3 * batch_s, 4),
        "first_frame_ms": round(1e3 * float(np.median(first)), 3),
    }


def _timed_s(
    retargeter: Retargeter, ticks: JointServoMap, motion: Motion, start: JointState | None
) -> tuple[float, JointState]:
    """Processor seconds from joint positions to ticks, and the state at the end of the path."""
    began_s = time.thread_time()
    path = retargeter.retarget(motion, start, settle=False)
    ticks.rad_to_tick(path.at_rate(retargeter.robot.bus.rate_hz))
    took_s = time.thread_time() - began_s
    end_s = np.array([path.duration_s])
    return took_s, JointState(path.at(end_s)[0], path.velocity_at(end_s)[0])
