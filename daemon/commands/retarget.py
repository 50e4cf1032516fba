"""`mmmd retarget`: a human motion to a robot's joint angles and servo ticks."""

from __future__ import annotations

import json as json_module
import os
from pathlib import Path
from typing import Annotated

import tyro


def retarget(
    motion: Annotated[Path, tyro.conf.Positional], out: Path, robot: str = "reference", json: bool = False
) -> int:
    """Turn an .npz of `mmmd generate` (or any with `joints` (T,22,3) and `fps`) into a robot's path.

    The file written holds q_rad (T,J) and joint_names at rate_hz, ticks (T,S) and servo_ids, keypoints (T,K,3) in metres
    with keypoint_names and up_axis, head_quat_wxyz (T,4), and the report as JSON.

    Example: mmmd retarget wave.npz --robot op3 --out ticks.npz

    Args:
        motion: the .npz with the human motion.
        out: the .npz to write.
        robot: name of a packaged robot, or the path of a robot.toml.
        json: print the report as one JSON object.
    """
    import numpy as np
    from rich.console import Console

    from mmm_core.motion import load_npz
    from mmm_core.skeleton import quat_wxyz
    from retarget.pipeline import Retargeter
    from retarget.robot import load_robot
    from retarget.ticks import JointServoMap

    model = load_robot(robot)
    retargeter = Retargeter(model)
    path = retargeter.retarget(load_npz(motion))
    q_rad = path.q_rad
    kinematics = retargeter.kinematics
    head = next(p for p in kinematics.key_points if p.name == "head")
    columns = [kinematics.turn(head.chain, q_rad, axis) for axis in np.eye(3)]
    partial = out.with_name(out.name + ".part")
    try:
        with partial.open("wb") as f:
            np.savez_compressed(
                f,
                q_rad=q_rad,
                joint_names=np.array(path.joint_names),
                rate_hz=np.float64(path.rate_hz),
                ticks=JointServoMap(model).rad_to_tick(q_rad),
                servo_ids=np.array(model.servo_ids, np.int32),
                keypoints=kinematics.places(q_rad).astype(np.float32),
                keypoint_names=np.array([p.name for p in kinematics.key_points]),
                up_axis=np.array("z"),
                head_quat_wxyz=quat_wxyz(np.stack(columns, -1)).astype(np.float32),
                report=np.array(json_module.dumps(path.report.as_dict())),
            )
        os.replace(partial, out)
    finally:
        partial.unlink(missing_ok=True)
    report = path.report.as_dict()
    console = Console()
    if json:
        console.out(json_module.dumps(report))
    else:
        console.print(f"{out}: {len(q_rad)} frames at {path.rate_hz:g} Hz for '{model.name}'", highlight=False)
        for key, value in report.items():
            console.print(f"  {key}: {value}", highlight=False)
    return 0
