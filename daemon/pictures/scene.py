"""A robot and a person in one three-dimensional picture, drawn by MuJoCo's renderer without a screen.

The renderer needs OpenGL: EGL by default (Debian's libegl1 and libgl1-mesa-dri draw on the CPU where there is no GPU), or
OSMesa where the environment variable MUJOCO_GL says so. Coordinates are those of the robot: x forward, y left, z up, metres.
"""

from __future__ import annotations

import contextlib
import importlib
import os
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daemon.pictures.errors import NoOpenGLError
from daemon.pictures.person import Bone, Stand, bones
from retarget.robot.description import description_spec, load_description, mujoco
from retarget.robot.kinematics import Kinematics
from retarget.robot.robot import RobotModel

Array = NDArray[np.float64]
Image = NDArray[np.uint8]

COLOURS = {"left": (0.80, 0.32, 0.25), "right": (0.20, 0.50, 0.75), "": (0.66, 0.69, 0.72), "nose": (0.25, 0.27, 0.30)}
"""Red, green and blue from 0 to 1 of the limbs of each side, of everything else, and of the person's nose."""
_GHOST_OPACITY = 0.35
_MAX_GEOMS = 4000
_STAGE_RADIUS = 6.0
"""Radius of the floor in lengths of the robot's arm."""
ASIDE = 3.4
"""Lengths of the robot's arm from the robot to the person at its left."""
_PERSON_ARM_M, _PERSON_SHOULDER_M = 0.514, 1.42
"""Metres from shoulder to wrist, and height of the shoulders, of the skeleton that motions use."""


@dataclass(frozen=True)
class View:
    """Direction of the camera: degrees to the left of the robot's front, degrees above the horizon."""

    azimuth_deg: float
    elevation_deg: float = 6.0


VIEWS = {"front": View(0.0), "half": View(-28.0, 10.0), "side": View(75.0)}


class Scene:
    """A robot, a person, or both side by side, seen by a camera that shows all of them.

    Args:
        robot: the robot, drawn with meshes where their files exist; None for a person alone.
        size_px: width and height of a picture.
        person: whether space is left for a person at the robot's left, scaled to arms as long as the robot's.

    Raises:
        NoOpenGLError: OpenGL without a screen is missing.
        RobotFileError: the description cannot be read.
    """

    def __init__(self, robot: RobotModel | None, size_px: tuple[int, int], *, person: bool = True) -> None:
        self._size = size_px
        self._opengl = _opengl_context(*size_px)
        shoulder_m, self._arm_m = shoulder_and_arm(robot)
        stand, floor_m = person_stand(shoulder_m, self._arm_m)
        self._scale = stand.scale
        self._aside_m = ASIDE * self._arm_m if robot is not None and person else 0.0
        self._shoulder_m = shoulder_m
        self._model: Any = _stage(robot, size_px, floor_m, self._arm_m).compile()
        self._data: Any = mujoco.MjData(self._model)
        self._ghost: Any = mujoco.MjData(self._model)
        self._address = [self._model.joint(name).qposadr[0] for name in robot.joint_names] if robot else []
        if robot:
            _paint(self._model, robot)
        self._scene: Any = mujoco.MjvScene(self._model, maxgeom=_MAX_GEOMS)
        self._context: Any = mujoco.MjrContext(self._model, mujoco.mjtFontScale.mjFONTSCALE_100)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)
        self._option: Any = mujoco.MjvOption()
        self._option.sitegroup[:] = 0
        width, height = size_px
        half_width_m, half_height_m = 1.75 * self._arm_m + self._aside_m / 2, 1.75 * self._arm_m
        half_angle_rad = np.deg2rad(float(self._model.vis.global_.fovy)) / 2
        self._distance_m = (
            max(half_height_m, half_width_m * height / width) / np.tan(half_angle_rad) + 0.3 * self._arm_m
        )

    def draw(
        self,
        view: View,
        robot_rad: Array | None = None,
        ghost_rad: Array | None = None,
        person_m: Array | None = None,
        head_faces: Array | None = None,
    ) -> Image:
        """One picture (height, width, 3).

        Args:
            view: direction of the camera.
            robot_rad: (J,) the robot's joint angles.
            ghost_rad: (J,) a second pose of the robot, drawn transparent.
            person_m: (22, 3) joints of the person, in a person's axes (x left, y up, z forward).
            head_faces: (3,) unit vector to where the person's head faces; forward if not given.
        """
        camera: Any = mujoco.MjvCamera()
        azimuth_rad = np.deg2rad(view.azimuth_deg)
        aside = self._aside_m * np.array([-np.sin(azimuth_rad), np.cos(azimuth_rad), 0.0])
        camera.lookat[:] = self._shoulder_m + aside / 2 - [0.0, 0.0, 0.5 * self._arm_m]
        camera.distance = self._distance_m
        camera.azimuth, camera.elevation = 180.0 + view.azimuth_deg, -view.elevation_deg
        every = mujoco.mjtCatBit.mjCAT_ALL.value
        if robot_rad is not None:
            self._data.qpos[self._address] = robot_rad
        mujoco.mj_forward(self._model, self._data)
        mujoco.mjv_updateScene(self._model, self._data, self._option, None, camera, every, self._scene)
        if ghost_rad is not None:
            self._add_ghost(ghost_rad)
        if person_m is not None:
            for bone in bones(person_m, head_faces, Stand(self._shoulder_m + aside, self._scale)):
                self._add_bone(bone)
        width, height = self._size
        image = np.zeros((height, width, 3), np.uint8)
        area = mujoco.MjrRect(0, 0, width, height)
        mujoco.mjr_render(area, self._scene, self._context)
        mujoco.mjr_readPixels(image, None, area, self._context)
        return np.flipud(image)

    def close(self) -> None:
        """Release the renderer; a second call does nothing."""
        with contextlib.suppress(AttributeError):
            self._context.free()
            self._opengl.free()
            del self._context

    def __enter__(self) -> Scene:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _add_ghost(self, q_rad: Array) -> None:
        self._ghost.qpos[self._address] = q_rad
        mujoco.mj_forward(self._model, self._ghost)
        before = self._scene.ngeom
        moving = mujoco.mjtCatBit.mjCAT_DYNAMIC.value
        mujoco.mjv_addGeoms(self._model, self._ghost, self._option, mujoco.MjvPerturb(), moving, self._scene)
        for geom in self._scene.geoms[before : self._scene.ngeom]:
            geom.rgba[3], geom.transparent = _GHOST_OPACITY, 1

    def _add_bone(self, bone: Bone) -> None:
        geom = self._scene.geoms[self._scene.ngeom]
        self._scene.ngeom += 1
        rgba = np.array((*COLOURS[bone.colour], 1.0), np.float32)
        if np.array_equal(bone.start_m, bone.end_m):
            kind, size = mujoco.mjtGeom.mjGEOM_SPHERE, np.full(3, bone.radius_m)
            mujoco.mjv_initGeom(geom, kind, size, bone.start_m, np.eye(3).ravel(), rgba)
            return
        kind = mujoco.mjtGeom.mjGEOM_CAPSULE
        mujoco.mjv_initGeom(geom, kind, np.zeros(3), np.zeros(3), np.eye(3).ravel(), rgba)
        mujoco.mjv_connector(geom, kind, bone.radius_m, bone.start_m, bone.end_m)


def person_stand(shoulder_m: Array, arm_m: float) -> tuple[Stand, float]:
    """Position and size of a person at the left of a robot with shoulders at (3,) and arms of `arm_m`; the floor's height, m."""
    scale = arm_m / _PERSON_ARM_M
    stand = Stand(shoulder_m + np.array([0.0, ASIDE * arm_m, 0.0]), scale)
    return stand, float(shoulder_m[2]) - _PERSON_SHOULDER_M * scale


def shoulder_and_arm(robot: RobotModel | None) -> tuple[Array, float]:
    """(3,) middle between the shoulders, and metres from shoulder to wrist; those of a person when `robot` is None."""
    if robot is None:
        return np.array([0.0, 0.0, _PERSON_SHOULDER_M]), _PERSON_ARM_M
    kinematics = Kinematics(robot)
    names = [point.name for point in kinematics.key_points]
    points = dict(zip(names, kinematics.places(np.zeros((1, robot.n_joints)))[0], strict=True))
    arms = [
        [points[f"{side}_{part}"] for part in ("shoulder", "elbow", "wrist") if f"{side}_{part}" in points]
        for side in ("left", "right")
    ]
    arms = [arm for arm in arms if len(arm) > 1]
    if not arms:
        return np.zeros(3), _PERSON_ARM_M
    shoulder_m = np.mean([arm[0] for arm in arms], 0) * [1.0, 0.0, 1.0]
    return shoulder_m, float(np.linalg.norm(np.diff(arms[0], axis=0), axis=-1).sum())


def _stage(robot: RobotModel | None, size_px: tuple[int, int], floor_m: float, arm_m: float) -> Any:
    """The robot's description on a stand and a floor, with light and a bright background."""
    spec: Any = description_spec(robot) if robot else mujoco.MjSpec()
    for light in list(spec.lights):
        spec.delete(light)
    for texture in list(spec.textures):
        if texture.type == mujoco.mjtTexture.mjTEXTURE_SKYBOX:
            spec.delete(texture)
    spec.stat.extent, spec.stat.center = (_STAGE_RADIUS + 1) * arm_m, [0.0, 0.0, floor_m + 2 * arm_m]
    spec.visual.global_.offwidth, spec.visual.global_.offheight = size_px
    spec.visual.quality.offsamples, spec.visual.quality.shadowsize = 4, 1024
    spec.visual.headlight.ambient, spec.visual.headlight.diffuse = [0.5] * 3, [0.25] * 3
    spec.visual.headlight.specular = [0.05] * 3
    sky: Any = spec.add_texture(name="mmmd_sky", type=mujoco.mjtTexture.mjTEXTURE_SKYBOX, width=64, height=384)
    sky.builtin, sky.rgb1, sky.rgb2 = mujoco.mjtBuiltin.mjBUILTIN_GRADIENT, [0.97, 0.98, 0.99], [0.90, 0.92, 0.95]
    light: Any = spec.worldbody.add_light(pos=[2 * arm_m, -2 * arm_m, floor_m + 9 * arm_m], dir=[-0.25, 0.2, -0.95])
    light.type, light.diffuse, light.specular = mujoco.mjtLightType.mjLIGHT_DIRECTIONAL, [0.45] * 3, [0.05] * 3
    _add_column(spec, _STAGE_RADIUS * arm_m, floor_m - 0.02 * arm_m, floor_m, 0.88)
    foot_m = lowest_m(robot) if robot else floor_m
    if foot_m > floor_m:
        _add_column(spec, 0.18 * arm_m, floor_m, foot_m, 0.80)
    return spec


def _add_column(spec: Any, radius_m: float, bottom_m: float, top_m: float, grey: float) -> None:
    column: Any = spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_CYLINDER)
    column.size, column.pos = [radius_m, (top_m - bottom_m) / 2, 0.0], [0.0, 0.0, (top_m + bottom_m) / 2]
    column.rgba = [grey, grey + 0.02, grey + 0.05, 1.0]


def lowest_m(robot: RobotModel) -> float:
    """Height in metres of the lowest shape that does not move with the arms: the robot stands on it."""
    model = load_description(robot)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    moving = {int(model.jnt_bodyid[model.joint(j.name).id]) for j in robot.joints}
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    lowest: list[float] = []
    for geom in range(model.ngeom):
        body = int(model.geom_bodyid[geom])
        while body and body not in moving:
            body = int(model.body_parentid[body])
        if not body:
            local = model.geom_aabb[geom][:3] + corners * model.geom_aabb[geom][3:]
            lowest.append(float((data.geom_xpos[geom] + local @ data.geom_xmat[geom].reshape(3, 3).T)[:, 2].min()))
    return min(lowest, default=0.0)


def limb_of_bodies(model: Any, robot: RobotModel) -> list[str]:
    """The limb that each body moves with: left, right, head, waist, or "" for none; by the nearest joint above it."""
    role = {int(model.jnt_bodyid[model.joint(j.name).id]): j.role.split("_")[0] for j in robot.joints}
    sides = [""] * model.nbody
    for body in range(1, model.nbody):
        sides[body] = role.get(body, sides[int(model.body_parentid[body])])
    return sides


def _paint(model: Any, robot: RobotModel) -> None:
    """Colour each shape of the robot by the side of its limb."""
    sides = limb_of_bodies(model, robot)
    for geom in range(model.ngeom):
        if body := int(model.geom_bodyid[geom]):
            model.geom_rgba[geom] = (*COLOURS.get(sides[body], COLOURS[""]), 1.0)
            model.geom_matid[geom] = -1


def _opengl_context(width: int, height: int) -> Any:
    """Make an OpenGL context without a screen, and make it current."""
    backend = os.environ.get("MUJOCO_GL", "").lower() or "egl"
    try:
        context = importlib.import_module(f"mujoco.{backend}").GLContext(width, height)
        context.make_current()
    except Exception as error:  # the kind of exception depends on the driver's defect
        raise NoOpenGLError(
            f"no OpenGL that draws without a screen ({backend}: {type(error).__name__}: {str(error)[:200]}); install it, "
            "on Debian with `apt install libegl1 libgl1-mesa-dri`; or `apt install libosmesa6` and set MUJOCO_GL=osmesa"
        ) from error
    return context
