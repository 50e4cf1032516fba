"""The robot's own body behind the servos: gravity, inertia, self-contact, joint stops, pushes. MuJoCo.

The robot's description is used unchanged except for its model of the servos: damping, friction and armature of the joints come from
the servo's motor instead (the motor's own back-EMF damps, see `sim/servos/drives.py`). Joints without a stop in the description get
one slightly outside the limits of the robot file. Bodies that are neighbours, or touch in the rest pose, cannot collide: their
shapes are too coarse to tell.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from retarget.robot.description import description_spec, mujoco
from retarget.robot.robot import RobotModel
from retarget.robot.ticks import JointServoMap
from sim.bodies.motors import Motor
from sim.errors import SimSettingError

Array = NDArray[np.float64]

STOP_MARGIN_RAD = 0.1
"""Radians by which stops lie outside the position limits where the description has none."""
_NEAR_REST_M = 0.004
_SMALL_RAD, _HELD_NM = 1e-4, 1e3


class MujocoBody:
    """A `Body` in which servos turn joints: one each, or several through gears, differentials and linkages.

    Args:
        robot: the robot; its description is loaded.
        motors: of the servos; more than the robot has is refused.
        position_rad: (S,) start angles of the shafts.
    """

    def __init__(self, robot: RobotModel, motors: Sequence[Motor], position_rad: Array) -> None:
        if len(motors) != len(robot.servos):
            raise SimSettingError(
                "servos without a joint", str(len(motors) - len(robot.servos)), "0 with the MuJoCo body"
            )
        self._map = JointServoMap(robot)
        self._rad_per_tick: Array = np.array([2 * np.pi / s.model.ticks_per_turn for s in robot.servos])
        self._bent = any(s.linkage is not None for s in robot.servos)
        q = self._map.tick_to_rad(np.rint(position_rad / self._rad_per_tick).astype(np.int64))
        self._gears = self._gears_at(q)
        self._model = _compile(robot, motors, self._gears)
        self._data: Any = mujoco.MjData(self._model)
        joints = [self._model.joint(name) for name in robot.joint_names]
        self._q = np.array([j.qposadr[0] for j in joints])
        self._v = np.array([j.dofadr[0] for j in joints])
        self._free_friction: Array = self._model.dof_frictionloss[self._v].copy()
        self._blocked = np.zeros(len(motors), bool)
        self._push_nm: Array = np.zeros(len(motors))
        self.self_contacts = 0
        self._data.qpos[self._q] = q
        mujoco.mj_forward(self._model, self._data)
        self.position_rad: Array = np.array(position_rad, np.float64)
        self.velocity_rad_s: Array = np.zeros(len(motors))

    def _gears_at(self, q: Array) -> Array:
        """(S, J) rate at which each shaft turns with each joint."""
        ends = q + np.concatenate([np.eye(len(q)), -np.eye(len(q))]) * _SMALL_RAD
        shafts = self._map.to_ticks(ends) * self._rad_per_tick
        return (shafts[: len(q)] - shafts[len(q) :]).T / (2 * _SMALL_RAD)

    @property
    def at_rest(self) -> bool:
        """Whether the body surely stays at rest: never, as an arm may start to sink."""
        return False

    @property
    def joint_rad(self) -> Array:
        """(J,) joint positions, rad."""
        return self._data.qpos[self._q].copy()

    def step(self, torque_nm: Array, blocked: NDArray[np.bool_], step_s: float) -> None:
        """One step of MuJoCo under the servos' torques."""
        if (blocked != self._blocked).any():
            self._blocked = blocked.copy()
            held = (self._gears[blocked] != 0).any(0)
            self._model.dof_frictionloss[self._v] = np.where(held, _HELD_NM, self._free_friction)
        if self._bent:
            self._gears = self._gears_at(self._data.qpos[self._q])
        self._model.opt.timestep = step_s
        self._data.qfrc_applied[self._v] = (torque_nm + self._push_nm) @ self._gears
        mujoco.mj_step(self._model, self._data)
        self.position_rad = self._map.to_ticks(self._data.qpos[self._q]) * self._rad_per_tick
        self.velocity_rad_s = self._gears @ self._data.qvel[self._v]
        if self._data.ncon:
            self.self_contacts += bool((self._data.contact.dist < 0).any())

    def place(self, shaft: int, position_rad: float) -> None:
        """Set one shaft to a position, at rest, and the joints that it moves with it."""
        turn = np.zeros(len(self.position_rad))
        turn[shaft] = position_rad - self.position_rad[shaft]
        self._data.qpos[self._q] += np.linalg.pinv(self._gears) @ turn
        self._data.qvel[self._v[self._gears[shaft] != 0]] = 0.0
        mujoco.mj_forward(self._model, self._data)
        self.position_rad = self._map.to_ticks(self._data.qpos[self._q]) * self._rad_per_tick
        self.velocity_rad_s[shaft] = 0.0

    def push(self, joint: int | None, amount: float) -> None:
        """Set an external torque in N m, as felt at the shaft."""
        self._push_nm[slice(None) if joint is None else joint] = amount


def _compile(robot: RobotModel, motors: Sequence[Motor], gears: Array) -> Any:
    """The compiled description with the servos' own dynamics at its joints; a differential's joints are not coupled by them."""
    spec = _with_stops(robot)
    for a, b in sorted(_never_touching(robot, _with_stops(robot).compile())):
        spec.add_exclude(bodyname1=a, bodyname2=b)
    model = spec.compile()
    dof = np.array([model.joint(name).dofadr[0] for name in robot.joint_names])
    model.dof_damping[dof] = np.array([m.damping_nm_s_per_rad for m in motors]) @ gears**2
    model.dof_armature[dof] = np.array([m.inertia_kg_m2 for m in motors]) @ gears**2
    model.dof_frictionloss[:] = _HELD_NM  # joints without a servo of the robot file stay as they are
    model.dof_frictionloss[dof] = np.array([m.friction_nm for m in motors]) @ np.abs(gears)
    mujoco.mj_setConst(model, mujoco.MjData(model))
    return model


def _with_stops(robot: RobotModel) -> Any:
    """The description with a stop and some friction at every joint; MuJoCo keeps friction only where some is given."""
    spec = description_spec(robot)
    for joint in robot.joints:
        described = spec.joint(joint.name)
        if not described.range[0] < described.range[1]:
            described.range = [joint.position_min_rad - STOP_MARGIN_RAD, joint.position_max_rad + STOP_MARGIN_RAD]
        described.limited = True
    for described in spec.joints:
        described.frictionloss = 1e-3
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    return spec


def _never_touching(robot: RobotModel, model: Any) -> set[tuple[str, str]]:
    """Pairs of bodies that cannot collide: within two steps of the tree, or in contact in the rest pose."""
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
