"""mink, where installed, on the problem that our retargeting solves in closed form: elbows and wrists from bone directions.

Both get the same targets on the same robot with position limits only, one frame after another.
"""

from __future__ import annotations

import importlib
import importlib.util
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion.motion import Motion
from retarget.human.human import SIDES, HumanPose, read_human
from retarget.pipeline import Retargeter
from retarget.robot.loading import load_robot

Array = NDArray[np.float64]
_ROBOT = "reference"
_STEPS = (2, 5)
_SPEED_RAD_S = 4.8
_PERIOD_S = 0.05
_MOST_FRAMES = 400


def mink_figures(motions: list[Motion]) -> dict[str, Any]:
    """Milliseconds a frame and direction errors of mink and of our closed form, or a note that mink is missing."""
    if importlib.util.find_spec("mink") is None or importlib.util.find_spec("daqp") is None:
        return {"mink": "not installed: pip install '.[bench]'"}
    retargeter = Retargeter(load_robot(_ROBOT))
    human: list[HumanPose] = []
    n = 0
    for motion in motions:
        human.append(read_human(motion))
        n += len(motion.joints_m)
        if n >= _MOST_FRAMES:
            break
    figures: dict[str, Any] = {"robot": _ROBOT, "frames": n, "closed form": _ours(retargeter, human)}
    for steps in _STEPS:
        figures[f"mink, {steps} steps"] = _mink(retargeter, human, steps, None)
    figures[f"mink, 5 steps, v <= {_SPEED_RAD_S}"] = _mink(retargeter, human, 5, _SPEED_RAD_S)
    return figures


def _ours(retargeter: Retargeter, human: list[HumanPose]) -> dict[str, float]:
    began_s = time.thread_time()
    solved = [retargeter.solve(h) for h in human]
    return _figures(retargeter, human, solved, time.thread_time() - began_s)


def _mink(retargeter: Retargeter, human: list[HumanPose], steps: int, speed_rad_s: float | None) -> dict[str, float]:
    mink: Any = importlib.import_module("mink")
    kinematics, robot = retargeter.kinematics, retargeter.robot
    model = kinematics.model
    address = [int(model.joint(name).qposadr[0]) for name in robot.joint_names]
    limits: list[Any] = [mink.ConfigurationLimit(model)]
    if speed_rad_s is not None:
        limits.append(mink.VelocityLimit(model, dict.fromkeys(robot.joint_names, speed_rad_s)))
    # The targets are for a chest that stands still: all joints but the arms' stay where they are.
    still = [
        int(model.joint(j.name).dofadr[0])
        for j in robot.joints
        if not j.role.startswith(tuple(f"{side}_" for side in SIDES))
    ]
    frozen = [mink.DofFreezingTask(model, still)] if still else None
    points = {p.name: p for p in kinematics.key_points}
    tasks: dict[str, Any] = {}
    for chain in retargeter.arms:
        side = chain.side
        elbow_body = model.joint(robot.joint_names[chain.joints[-1]]).bodyid[0]
        tasks[f"{side}_elbow"] = mink.FrameTask(model.body(elbow_body).name, "body", 1.0, 0.0)
        tasks[f"{side}_wrist"] = mink.FrameTask(f"{side}_wrist", "site", 1.0, 0.0)
    length = {
        name: float(np.linalg.norm(points[name].zero_m - points[before].zero_m))
        for side in SIDES
        for name, before in ((f"{side}_elbow", f"{side}_shoulder"), (f"{side}_wrist", f"{side}_elbow"))
    }
    solved: list[Array] = []
    took_s = 0.0
    for h in human:
        configuration = mink.Configuration(model)
        rest = np.array(configuration.q)
        rest[address] = robot.rest_rad
        configuration.update(rest)
        q = np.empty((h.upper.shape[1], robot.n_joints))
        began_s = time.thread_time()
        for t in range(len(q)):
            for i, side in enumerate(SIDES):
                elbow = points[f"{side}_shoulder"].zero_m + length[f"{side}_elbow"] * h.upper[i, t]
                wrist = elbow + length[f"{side}_wrist"] * h.fore[i, t]
                for part, place in (("elbow", elbow), ("wrist", wrist)):
                    tasks[f"{side}_{part}"].set_target(mink.SE3.from_translation(place))
            for _ in range(steps):
                dt_s = _PERIOD_S / steps
                velocity = mink.solve_ik(
                    configuration, list(tasks.values()), dt_s, "daqp", 1e-4, limits=limits, constraints=frozen
                )
                configuration.integrate_inplace(velocity, dt_s)
            q[t] = configuration.q[address]
        took_s += time.thread_time() - began_s
        solved.append(q)
    return _figures(retargeter, human, solved, took_s)


def _figures(retargeter: Retargeter, human: list[HumanPose], solved: list[Array], took_s: float) -> dict[str, float]:
    every = np.concatenate([
        retargeter.direction_errors_deg(retargeter.poses(h), q).ravel() for h, q in zip(human, solved, strict=True)
    ])  # fmt: skip
    return {
        "ms_per_frame": round(1e3 * took_s / sum(map(len, solved)), 5),
        "direction_mean_deg": round(float(every.mean()), 3),
        "direction_p95_deg": round(float(np.percentile(every, 95)), 3),
    }
