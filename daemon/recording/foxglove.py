"""Messages of a log in Foxglove's own schemas, beside ours: joint states, transforms and the daemon's log.

| topic | schema | what |
|---|---|---|
| `/joint_states` | foxglove.JointStates | measured angle and speed of each joint, by name, rad and rad/s; 50 a second |
| `/joint_goals` | foxglove.JointStates | the goals given to the servos, likewise |
| `/tf` | foxglove.FrameTransforms | each body of the description in its parent, at the measured angles, metres; 20 a second |
| `/log` | foxglove.Log | the lines of `v1/log` |

Schemas: https://docs.foxglove.dev/docs/sdk/schemas (JSON encoding). A joint whose servo did not answer has a name and no
values. Passive joints that a description has beside the robot's own stay in their zero pose.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from daemon.dynamixel.registers.models import MODELS
from daemon.wire.status import LogEvent
from retarget.robot.description import load_description, mujoco
from retarget.robot.robot import RobotModel
from retarget.robot.ticks import JointServoMap

Array = NDArray[np.float64]
MEASURED_TOPIC, GOAL_TOPIC, TRANSFORMS_TOPIC, LOG_TOPIC = "/joint_states", "/joint_goals", "/tf", "/log"
STATES_EVERY_S, TRANSFORMS_EVERY_S = 0.02, 0.05
"""Seconds between messages at least: `v1/cycle` has every bus cycle, and these messages cost the recorder 2.5 times as much."""
_VELOCITY_ITEMS = ("present_velocity", "present_speed")
_EARLY_NS = 2_000_000
"""Nanoseconds by which a cycle may be early for the next message."""
_STEP_S = 1e-3
"""Seconds over which a linkage counts as linear when speeds are computed."""
_LEVELS = {"debug": 1, "info": 2, "warning": 3, "error": 4, "critical": 5}


def _object(title: str, **properties: dict[str, Any]) -> dict[str, Any]:
    return {"title": title, "type": "object", "properties": properties, "required": list(properties)}


_NUMBER, _TEXT = {"type": "number"}, {"type": "string"}
_TIME = {"title": "time", "type": "object", "properties": {"sec": {"type": "integer"}, "nsec": {"type": "integer"}}}
_JOINT = _object("foxglove.JointState", name=_TEXT) | {
    "properties": {
        "name": _TEXT,
        "position": _NUMBER | {"description": "radians"},
        "velocity": _NUMBER | {"description": "radians per second"},
    }
}
_TRANSFORM = _object(
    "foxglove.FrameTransform", timestamp=_TIME, parent_frame_id=_TEXT, child_frame_id=_TEXT,
    translation=_object("foxglove.Vector3", x=_NUMBER, y=_NUMBER, z=_NUMBER) | {"description": "metres"},
    rotation=_object("foxglove.Quaternion", x=_NUMBER, y=_NUMBER, z=_NUMBER, w=_NUMBER),
)  # fmt: skip
_JOINT_STATES = _object("foxglove.JointStates", timestamp=_TIME, joints={"type": "array", "items": _JOINT})
SCHEMAS: dict[str, dict[str, Any]] = {
    MEASURED_TOPIC: _JOINT_STATES,
    GOAL_TOPIC: _JOINT_STATES,
    TRANSFORMS_TOPIC: _object("foxglove.FrameTransforms", transforms={"type": "array", "items": _TRANSFORM}),
    LOG_TOPIC: _object(
        "foxglove.Log", timestamp=_TIME, level={"type": "integer"}, message=_TEXT, name=_TEXT, file=_TEXT,
        line={"type": "integer"},
    ),
}  # fmt: skip
"""JSON schema of each topic; its title is Foxglove's name of the schema."""


class FoxgloveMessages:
    """Builds the messages of one robot."""

    def __init__(self, robot: RobotModel) -> None:
        self._names, self._map = robot.joint_names, JointServoMap(robot)
        self._servos_of = [[i for i, s in enumerate(robot.servos) if any(j == joint for j, _ in s.couplings)]
                           for joint in range(robot.n_joints)]  # fmt: skip
        self._tick_s_per_raw = np.array([_rad_s_per_raw(s.model.model_number) * s.model.ticks_per_turn / (2 * np.pi)
                                         for s in robot.servos])  # fmt: skip
        self._model = load_description(robot)
        self._data = mujoco.MjData(self._model)
        joints = [mujoco.mj_name2id(self._model, mujoco.mjtObj.mjOBJ_JOINT, name) for name in self._names]
        self._q_at = [int(self._model.jnt_qposadr[i]) for i in joints]
        self._next_states_ns = self._next_transforms_ns = 0

    def of_cycle(self, record: np.void, t_ns: int) -> Iterator[tuple[str, bytes]]:
        """Yield (topic, message) of one bus cycle; `t_ns` is its wall time in nanoseconds."""
        if t_ns < self._next_states_ns:
            return
        self._next_states_ns = t_ns + round(STATES_EVERY_S * 1e9) - _EARLY_NS
        tick = record["present_tick"].astype(np.float64)
        q_rad = self._map.tick_to_rad(tick)
        ahead_rad = self._map.tick_to_rad(tick + self._tick_s_per_raw * record["present_velocity_raw"] * _STEP_S)
        valid = [bool(record["valid"][servos].all()) for servos in self._servos_of]
        yield MEASURED_TOPIC, self._states(t_ns, q_rad, (ahead_rad - q_rad) / _STEP_S, valid)
        yield GOAL_TOPIC, self._states(t_ns, record["goal_rad"], record["velocity_rad_s"], [True] * len(self._names))
        if t_ns >= self._next_transforms_ns:
            self._next_transforms_ns = t_ns + round(TRANSFORMS_EVERY_S * 1e9) - _EARLY_NS
            yield TRANSFORMS_TOPIC, self._transforms(t_ns, q_rad)

    def _states(self, t_ns: int, q_rad: Array, velocity_rad_s: Array, valid: list[bool]) -> bytes:
        rows = zip(self._names, q_rad.tolist(), velocity_rad_s.tolist(), valid, strict=True)
        joints = [{"name": n, "position": q, "velocity": v} if ok else {"name": n} for n, q, v, ok in rows]
        return msgspec.json.encode({"timestamp": _time(t_ns), "joints": joints})

    def _transforms(self, t_ns: int, q_rad: Array) -> bytes:
        model, data, at = self._model, self._data, _time(t_ns)
        data.qpos[self._q_at] = model.qpos0[self._q_at] + q_rad
        mujoco.mj_kinematics(model, data)
        found: list[dict[str, Any]] = []
        for body in range(1, model.nbody):
            parent = int(model.body_parentid[body])
            R_parent = data.xmat[parent].reshape(3, 3)
            x, y, z = (R_parent.T @ (data.xpos[body] - data.xpos[parent])).tolist()
            inverse, turn = np.zeros(4), np.zeros(4)
            mujoco.mju_negQuat(inverse, data.xquat[parent])
            mujoco.mju_mulQuat(turn, inverse, data.xquat[body])
            w, i, j, k = turn.tolist()
            found.append({
                "timestamp": at, "parent_frame_id": model.body(parent).name, "child_frame_id": model.body(body).name,
                "translation": {"x": x, "y": y, "z": z}, "rotation": {"x": i, "y": j, "z": k, "w": w},
            })  # fmt: skip
        return msgspec.json.encode({"transforms": found})


def log_line(payload: bytes, t_ns: int) -> bytes:
    """The `/log` message of a `v1/log` payload."""
    line = msgspec.json.decode(payload, type=LogEvent)
    return msgspec.json.encode({
        "timestamp": _time(t_ns), "level": _LEVELS.get(line.level, 0), "message": line.text, "name": line.process,
        "file": line.module, "line": 0,
    })  # fmt: skip


def _rad_s_per_raw(model_number: int) -> float:
    """Speed of the servo's shaft, rad/s, for 1 in its register of measured speed."""
    table = MODELS[model_number].table
    return next(table[name].scale for name in _VELOCITY_ITEMS if name in table)


def _time(t_ns: int) -> dict[str, int]:
    return {"sec": t_ns // 1_000_000_000, "nsec": t_ns % 1_000_000_000}
