"""The robot's own body behind the servos: gravity, inertia, contact with itself, joint stops, pushes. MuJoCo.

The robot's description is taken as it is, but for what stands for the servos in it: damping, friction and armature of its
joints come from the servo's motor instead (the motor's own back-EMF damps, see `sim/drive.py`). Joints without a stop in
the description get one a little outside the limits of the robot file. Bodies that are neighbours, or touch in the rest pose,
do not touch: shapes are too coarse to tell.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from retarget.kinematics import description_spec, mujoco
from retarget.robot import RobotModel
from sim.errors import SimSettingError
from sim.motors import Motor

Array = NDArray[np.float64]

STOP_MARGIN_RAD = 0.1
"""Stops stand this far outside the position limits where the description says nothing."""
_NEAR_REST_M = 0.004


class MujocoBody:
    """A `Body` with one joint behind each servo.

    Args:
        robot: whose description is loaded; joint j is turned by servo j.
        motors: of the servos; more than the robot has joints is refused.
        position_rad: (S,) start angles of the shafts.
    """

    def __init__(self, robot: RobotModel, motors: Sequence[Motor], position_rad: Array) -> None:
        if len(motors) != robot.n_joints:
            raise SimSettingError("servos without a joint", str(len(motors) - robot.n_joints), "0 with the MuJoCo body")
        ratio = [s.direction * s.gear_ratio for s in robot.servos]
        self._ratio: Array = np.array(ratio)
        self._zero_rad: Array = np.array([s.zero_tick * 2 * np.pi / s.model.ticks_per_turn for s in robot.servos])
        self._model = _compile(robot, motors, self._ratio)
        self._data: Any = mujoco.MjData(self._model)
        joints = [self._model.joint(name) for name in robot.joint_names]
        self._q = np.array([j.qposadr[0] for j in joints])
        self._v = np.array([j.dofadr[0] for j in joints])
        self._free_friction: Array = self._model.dof_frictionloss[self._v].copy()
        self._blocked = np.zeros(len(motors), bool)
        self._push_nm: Array = np.zeros(len(motors))
        self.self_contacts = 0
        self._data.qpos[self._q] = (position_rad - self._zero_rad) / self._ratio
        mujoco.mj_forward(self._model, self._data)
        self.position_rad: Array = np.array(position_rad, np.float64)
        self.velocity_rad_s: Array = np.zeros(len(motors))

    @property
    def at_rest(self) -> bool:
        """Never for sure: an arm may start to sink."""
        return False

    @property
    def joint_rad(self) -> Array:
        """(J,) where the joints are."""
        return self._data.qpos[self._q].copy()

    def step(self, torque_nm: Array, blocked: NDArray[np.bool_], step_s: float) -> None:
        """One step of MuJoCo under the servos' torques."""
        if (blocked != self._blocked).any():
            self._blocked = blocked.copy()
            self._model.dof_frictionloss[self._v] = np.where(blocked, 1e3, self._free_friction)
        self._model.opt.timestep = step_s
        self._data.qfrc_applied[self._v] = (torque_nm + self._push_nm) * self._ratio
        mujoco.mj_step(self._model, self._data)
        self.position_rad = self._data.qpos[self._q] * self._ratio + self._zero_rad
        self.velocity_rad_s = self._data.qvel[self._v] * self._ratio
        if self._data.ncon:
            self.self_contacts += bool((self._data.contact.dist < 0).any())

    def place(self, shaft: int, position_rad: float) -> None:
        """Put one shaft somewhere, at rest."""
        self._data.qpos[self._q[shaft]] = (position_rad - self._zero_rad[shaft]) / self._ratio[shaft]
        self._data.qvel[self._v[shaft]] = 0.0
        mujoco.mj_forward(self._model, self._data)
        self.position_rad[shaft], self.velocity_rad_s[shaft] = position_rad, 0.0

    def push(self, joint: int | None, amount: float) -> None:
        """An external torque in N m, felt at the shaft."""
        self._push_nm[slice(None) if joint is None else joint] = amount


def _compile(robot: RobotModel, motors: Sequence[Motor], ratio: Array) -> Any:
    """The description with the servos' own dynamics at its joints."""
    spec = _with_stops(robot)
    for a, b in sorted(_never_touching(robot, _with_stops(robot).compile())):
        spec.add_exclude(bodyname1=a, bodyname2=b)
    model = spec.compile()
    dof = np.array([model.joint(name).dofadr[0] for name in robot.joint_names])
    model.dof_damping[dof] = [m.damping_nm_s_per_rad for m in motors] * ratio**2
    model.dof_armature[dof] = [m.inertia_kg_m2 for m in motors] * ratio**2
    model.dof_frictionloss[dof] = [m.friction_nm for m in motors] * np.abs(ratio)
    mujoco.mj_setConst(model, mujoco.MjData(model))
    return model


def _with_stops(robot: RobotModel) -> Any:
    """The description, every joint of the robot with a stop; a thousandth of friction so that MuJoCo keeps a row for it."""
    spec = description_spec(robot)
    for joint in robot.joints:
        described = spec.joint(joint.name)
        if not described.range[0] < described.range[1]:
            described.range = [joint.position_min_rad - STOP_MARGIN_RAD, joint.position_max_rad + STOP_MARGIN_RAD]
        described.limited = True
        described.frictionloss = 1e-3
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    return spec


def _never_touching(robot: RobotModel, model: Any) -> set[tuple[str, str]]:
    """Bodies within two steps of the tree, and those that meet in the rest pose."""
    parent = model.body_parentid
    pairs: set[tuple[int, int]] = set()
    for b in range(1, model.nbody):
        siblings = np.flatnonzero(parent == parent[b]).tolist()
        pairs |= {(int(o), b) for o in (parent[b], parent[parent[b]], *siblings) if int(o) != b}
    data = mujoco.MjData(model)
    for joint, q in zip(robot.joints, robot.rest_rad, strict=True):
        data.qpos[model.joint(joint.name).qposadr[0]] = q
    model.geom_margin[:] = _NEAR_REST_M
    mujoco.mj_forward(model, data)
    bodies = model.geom_bodyid[data.contact.geom]
    pairs |= {(int(a), int(b)) for a, b in bodies}
    names = {(str(model.body(a).name), str(model.body(b).name)) for a, b in pairs}
    return {(min(n), max(n)) for n in names if n[0] != n[1]}
