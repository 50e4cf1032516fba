"""Robots made for tests: a torso with two arms of any family, written as MJCF with frames turned at random."""

from pathlib import Path

import numpy as np

from retarget.robot.loading import load_robot

UP, LEFT, FORWARD = np.array([0.0, 0, 1]), np.array([0.0, 1, 0]), np.array([1.0, 0, 0])
HANGING, SIDEWAYS, AHEAD = -UP, LEFT, FORWARD
FAMILIES = {
    # name: zero pose of the left arm, then (role, axis in the zero pose) from the chest outwards; "along" is the arm itself
    "2 pitch elbow": (HANGING, [("shoulder_pitch", LEFT), ("elbow", LEFT)]),
    "2 pitch roll": (HANGING, [("shoulder_pitch", -LEFT), ("shoulder_roll", FORWARD)]),
    "3 pitch roll elbow": (SIDEWAYS, [("shoulder_pitch", LEFT), ("shoulder_roll", -FORWARD), ("elbow", UP)]),
    "3 roll pitch elbow": (HANGING, [("shoulder_roll", FORWARD), ("shoulder_pitch", LEFT), ("elbow", LEFT)]),
    "4 hanging": (HANGING, [("shoulder_pitch", LEFT), ("shoulder_roll", FORWARD), ("shoulder_yaw", UP), ("elbow", -LEFT)]),
    "4 T pose": (
        SIDEWAYS, [("shoulder_pitch", -LEFT), ("shoulder_roll", FORWARD), ("shoulder_yaw", LEFT), ("elbow", -UP)]),
    "4 roll first": (AHEAD, [("shoulder_roll", UP), ("shoulder_pitch", LEFT), ("shoulder_yaw", -FORWARD), ("elbow", UP)]),
    "4 slanted axes": (
        HANGING, [("shoulder_pitch", LEFT + 0.3 * UP), ("shoulder_roll", FORWARD + 0.2 * LEFT), ("shoulder_yaw", UP),
                  ("elbow", -LEFT + 0.1 * FORWARD)]),
    "5": (HANGING, [("shoulder_pitch", -LEFT), ("shoulder_roll", FORWARD), ("shoulder_yaw", -UP), ("elbow", LEFT),
                    ("forearm_yaw", UP)]),
    "7": (SIDEWAYS, [("shoulder_pitch", LEFT), ("shoulder_roll", -FORWARD), ("shoulder_yaw", -LEFT), ("elbow", UP),
                     ("forearm_yaw", LEFT), ("wrist", UP)]),
}  # fmt: skip
UPPER_M, FORE_M = 0.22, 0.2


def mirrored_axis(v, role):
    """The axis on the right whose turns mirror those about `v` on the left."""
    return np.array([-v[0], v[1], -v[2]])


def arm_xml(side, zero, joints, rng, beside_m):
    """Nested bodies of one arm; each frame is turned at random, and axes and places are given in it."""
    sign = 1.0 if side == "left" else -1.0
    flip = np.array([1.0, sign, 1.0])
    along = zero * flip
    shoulder = np.array([0.0, 0.16 * sign, 0.4])
    places, lines, closing = {"shoulder": shoulder, "elbow": shoulder + UPPER_M * along}, [], 0
    wrist = places["elbow"] + FORE_M * along
    R_world, at = np.eye(3), np.zeros(3)
    for role, axis in joints:
        world_axis = (axis if side == "left" else mirrored_axis(axis, role)) / np.linalg.norm(axis)
        place = {"elbow": places["elbow"], "forearm_yaw": places["elbow"] + 0.5 * FORE_M * along, "wrist": wrist}.get(
            role, shoulder
        )
        if role == "shoulder_yaw":
            place = shoulder + 0.3 * UPPER_M * along + beside_m * np.cross(along, FORWARD + 0.3 * UP)
        R_new = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        R_new *= np.sign(np.linalg.det(R_new))
        pos = R_world.T @ (place - at)
        x, y = (R_world.T @ R_new)[:, 0], (R_world.T @ R_new)[:, 1]
        numbers = " ".join(f"{v:.17g}" for v in [*x, *y])
        local = R_new.T @ world_axis
        lines.append(
            f'<body pos="{pos[0]:.17g} {pos[1]:.17g} {pos[2]:.17g}" xyaxes="{numbers}">'
            f'<inertial pos="0 0 0" mass="0.1" diaginertia="1e-4 1e-4 1e-4"/>'
            f'<joint name="{side}_{role}" axis="{local[0]:.17g} {local[1]:.17g} {local[2]:.17g}"/>'
        )
        closing += 1
        R_world, at = R_new, place
    last = R_world.T @ (wrist - at)
    lines.append(
        f'<site name="{side}_wrist" pos="{last[0]:.17g} {last[1]:.17g} {last[2]:.17g}"/>' + "</body>" * closing
    )
    return "\n".join(lines)


def made_robot(folder: Path, family: str, seed=0, range_deg=(-170, 170), beside_m=0.0):
    """A robot of a family, without shapes, loaded from files written to `folder`."""
    zero, joints = FAMILIES[family]
    rng = np.random.default_rng(seed)
    arms = "".join(arm_xml(side, zero, joints, rng, beside_m) for side in ("left", "right"))
    (folder / "robot.xml").write_text(
        '<mujoco><compiler angle="radian"/><worldbody><body name="chest"><geom type="sphere" size="0.02"/>'
        f"{arms}</body></worldbody></mujoco>"
    )
    rows = [
        f'[[joint]]\nname = "{side}_{role}"\nrole = "{side}_{role}"\nposition_limit_deg = [{range_deg[0]}, {range_deg[1]}]\n'
        f'servo = {{ id = {i * 20 + k}, model = "XM430-W350" }}\n'
        for i, side in enumerate(("left", "right"))
        for k, (role, _) in enumerate(joints)
    ]
    (folder / "robot.toml").write_text(
        'format = 1\nname = "made"\ndescription = "robot.xml"\nlicence = "Apache-2.0"\n'
        "[bus]\nprotocol = 2.0\nbaud = 1000000\nrate_hz = 100\n"
        "[motion]\nvelocity_margin = 0.9\nacceleration_limit_deg_s2 = 2300\n" + "\n".join(rows)
    )
    return load_robot(str(folder))
