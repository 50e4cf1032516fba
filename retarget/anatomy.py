"""Finds arms, neck and waist in a description that says nothing of them, by forward kinematics in its zero pose.

What a joint is for follows from what it carries and where its axis looks, not from its name: limbs come in pairs that
mirror each other, the upper pair are the arms; the elbow is the joint across the arm that is far from both shoulder and
hand. Names decide two things only, where they speak of them: which side is left, and which joints are fingers.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from retarget.description import compiled, followers, loops, mujoco, read_spec, rotation_to_standard
from retarget.errors import RobotFileError
from retarget.robot import DIRECTIONS

Array = NDArray[np.float64]
_ALONG = 0.7
"""Cosine from which an axis counts as looking along a direction."""
_FINGERS = re.compile(r"grip|finger|thumb|claw|jaw|hand_?joint", re.IGNORECASE)
_LEFT, _RIGHT = (
    re.compile(r"(^|[_\W])l(eft)?([_\W]|$)", re.IGNORECASE),
    re.compile(r"(^|[_\W])r(ight)?([_\W]|$)", re.IGNORECASE),
)
_TO_THE_WRIST = 0.3
"""A joint nearer to the elbow than this share of forearm and hand is no wrist."""


@dataclass(frozen=True)
class FoundJoint:
    """A joint with a role.

    Attributes:
        axis: unit axis in the zero pose, x forward, y left, z up.
        range_deg: its range, None where the description has none.
        sign: 1 where its positive sense is the usual one (raises the arm forward or sideways, bends the elbow, turns to
            the left, nods down), -1 where it is the other, 0 where the zero pose does not tell.
        gear: (turns of the servo for one of the joint, direction) where another joint of the description drives it.
    """

    name: str
    role: str
    axis: tuple[float, float, float]
    range_deg: tuple[float, float] | None
    sign: int
    gear: tuple[float, int] | None = None


@dataclass(frozen=True)
class FoundPoint:
    """A place on a body, in the body's own axes."""

    body: str
    offset_m: tuple[float, float, float]


@dataclass(frozen=True)
class Anatomy:
    """What was found.

    Attributes:
        path: the description.
        forward: its axis that looks ahead.
        up: its axis that looks up.
        joints: joints with a role.
        points: the places that retargeting needs and the description does not name.
        reach_m: from the shoulder over the elbow to the wrist.
        notes: what was decided or left out, and why.
    """

    path: Path
    forward: str
    up: str
    joints: tuple[FoundJoint, ...]
    points: dict[str, FoundPoint]
    reach_m: float
    notes: tuple[str, ...]


def find_anatomy(path: Path) -> Anatomy:
    """Arms, neck and waist of a description.

    Raises:
        RobotFileError: MuJoCo cannot read it, or there is no pair of arms in it.
    """
    return _Finder(path).found()


class _Finder:
    """One search; everything is in standard axes (x forward, y left, z up) once `_frame` has found them."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.spec, self.missing = read_spec(path)
        self.model: Any = compiled(path, self.spec)
        self.data: Any = mujoco.MjData(self.model)
        mujoco.mj_kinematics(self.model, self.data)
        self.notes: list[str] = []
        self.reach_m = 0.0
        hinge = mujoco.mjtJoint.mjJNT_HINGE
        self.joints = [j for j in range(self.model.njnt) if self.model.jnt_type[j] == hinge]
        self.name = {j: str(self.model.joint(j).name) for j in self.joints}
        self.body = {j: int(self.model.jnt_bodyid[j]) for j in self.joints}
        self._leave_out_drives()
        self.R, self.forward, self.up = self._frame()
        self.axis = {j: self.R @ self.data.xaxis[j] for j in self.joints}
        self.anchor = {j: self.R @ self.data.xanchor[j] for j in self.joints}
        self.middle = self._lateral_middle()

    def found(self) -> Anatomy:
        """All of it."""
        left, right = self._arms()
        roles: dict[int, str] = {}
        points: dict[str, FoundPoint] = {}
        for side, arm in (("left", left), ("right", right)):
            points[f"{side}_wrist"] = self._name_arm(side, arm, roles)
        self._name_centre(left[0], right[0], roles, points)
        self._note_what_is_left_out(roles)
        order = {"head": 0, "wais": 1, "left": 2, "righ": 3}
        listed = sorted(roles, key=lambda j: (order[roles[j][:4]], self._depth(self.body[j]), j))
        gears = self._gears()
        joints = tuple(self._joint(j, roles[j], gears) for j in listed)
        named = {str(self.model.site(i).name) for i in range(self.model.nsite)}
        needed = {name: point for name, point in points.items() if name not in named}
        return Anatomy(self.path, self.forward, self.up, joints, needed, self.reach_m, tuple(self.notes))

    def _leave_out_drives(self) -> None:
        """A gear that turns another joint and carries nothing itself is a servo's business, not a joint's."""
        leaders = {f.leader for f in followers(self.spec)}
        parents = {int(p) for p in self.model.body_parentid}
        self.joints = [j for j in self.joints if self.name[j] not in leaders or self.body[j] in parents]

    def _frame(self) -> tuple[Array, str, str]:
        """Rotation to standard axes, and which of the description's axes look forward and up."""
        gravity = np.array(self.model.opt.gravity)
        up = np.array([0.0, 0, 1]) if np.abs(gravity).max() < 1e-6 else -gravity / np.linalg.norm(gravity)
        up_key = max(DIRECTIONS, key=lambda k: float(np.dot(DIRECTIONS[k], up)))
        sides = np.zeros(3)
        for j in self.joints:
            left, right = bool(_LEFT.search(self.name[j])), bool(_RIGHT.search(self.name[j]))
            if left != right:
                sides += (1 if left else -1) * np.array(self.data.xanchor[j])
        sides -= (sides @ np.array(DIRECTIONS[up_key])) * np.array(DIRECTIONS[up_key])
        if np.linalg.norm(sides) > 1e-3:
            left_key = max(DIRECTIONS, key=lambda k: float(np.dot(DIRECTIONS[k], sides)))
            forward = np.cross(DIRECTIONS[left_key], DIRECTIONS[up_key])
            forward_key = max(DIRECTIONS, key=lambda k: float(np.dot(DIRECTIONS[k], forward)))
            self.notes.append(f"forward is {forward_key}: joints named left stand on the {left_key} side")
        else:
            forward_key = "x" if up_key[-1] != "x" else "y"
            self.notes.append(f"forward is taken as {forward_key}: no names tell left from right; check")
        return rotation_to_standard(forward_key, up_key), forward_key, up_key

    def _lateral_middle(self) -> float:
        """Where the mirror plane stands: limbs come in pairs, so half way between the outermost joints."""
        lateral = [float(a[1]) for a in self.anchor.values()]
        if not lateral:
            raise RobotFileError(self.path, "description", "no hinge joint", "a robot with arms")
        return (min(lateral) + max(lateral)) / 2

    def _arms(self) -> tuple[list[int], list[int]]:
        """Joints of the left and the right arm, from the shoulder on."""
        limbs = {"left": self._limbs(1.0), "right": self._limbs(-1.0)}
        pairs = [
            (a, b) for a in limbs["left"] for b in limbs["right"]
            if len(a) == len(b) >= 2 and abs(self.anchor[a[0]][2] - self.anchor[b[0]][2]) < 0.1 * self._size()
        ]  # fmt: skip
        if not pairs:
            found = f"{len(limbs['left'])} limbs on the left, {len(limbs['right'])} on the right, none alike"
            raise RobotFileError(self.path, "description", found, "a pair of arms of at least two joints")
        return max(pairs, key=lambda p: self.anchor[p[0][0]][2])

    def _limbs(self, side: float) -> list[list[int]]:
        """Chains of joints on one side, each from its first joint to the hand or foot."""
        roots = [
            j for j in self.joints
            if self._side(j) == side and not any(self._side(k) == side for k in self._joints_above(self.body[j], j))
        ]  # fmt: skip
        return [self._main_chain(j) for j in roots]

    def _side(self, j: int) -> float:
        """1 for a joint that carries things on the left only, -1 on the right, 0 else."""
        lateral = self._carried(self.body[j])[:, 1] - self.middle
        edge = 0.02 * self._size()
        if lateral.min() > -edge and lateral.mean() > edge:
            return 1.0
        return -1.0 if lateral.max() < edge and lateral.mean() < -edge else 0.0

    def _main_chain(self, root: int) -> list[int]:
        """From a limb's first joint outwards, always where most joints follow; ends where that is a tie (fingers)."""
        chain, body = [root], self.body[root]
        while True:
            following = sorted(
                ((self._longest(c), c) for c in range(1, self.model.nbody) if self.model.body_parentid[c] == body),
                reverse=True,
            )
            if not following or following[0][0] == 0 or (len(following) > 1 and following[0][0] == following[1][0]):
                return chain
            body = following[0][1]
            chain += [j for j in self.joints if self.body[j] == body and not _FINGERS.search(self.name[j])]

    def _longest(self, body: int) -> int:
        """Most joints on a way outwards from a body, its own with them."""
        own = sum(self.body[j] == body for j in self.joints)
        return own + max(
            (self._longest(c) for c in range(1, self.model.nbody) if self.model.body_parentid[c] == body), default=0
        )

    def _name_arm(self, side: str, arm: list[int], roles: dict[int, str]) -> FoundPoint:
        """Give an arm's joints their roles; where its wrist is."""
        shoulder = self.anchor[arm[0]]
        far = {j: self._farthest(self.body[arm[-1]], self.anchor[j]) for j in arm}
        across = [
            j for j in arm[1:] if abs(self.axis[j] @ _unit(self.anchor[j] - shoulder)) < _ALONG
        ]  # fmt: skip
        elbow = max(
            across,
            key=lambda j: min(np.linalg.norm(self.anchor[j] - shoulder), np.linalg.norm(far[j] - self.anchor[j])),
            default=None,
        )
        if elbow is None:
            raise RobotFileError(self.path, f"{side} arm", "no joint that can be an elbow", "an arm with an elbow")
        at = arm.index(elbow)
        self._name_shoulder(side, arm[:at], _unit(self.anchor[elbow] - shoulder), roles)
        roles[elbow] = f"{side}_elbow"
        return self._name_forearm(side, elbow, arm[at + 1 :], (shoulder, far[elbow]), roles)

    def _name_shoulder(self, side: str, joints: list[int], upper: Array, roles: dict[int, str]) -> None:
        rest = list(joints)
        if len(rest) > 1 and abs(self.axis[rest[-1]] @ upper) > _ALONG:
            roles[rest.pop()] = f"{side}_shoulder_yaw"
        if rest:
            pitch = max(rest, key=lambda j: abs(float(self.axis[j][1])))
            if abs(self.axis[pitch][1]) > _ALONG or len(rest) > 1:
                roles[pitch] = f"{side}_shoulder_pitch"
                rest.remove(pitch)
        if rest:
            roles[rest.pop(0)] = f"{side}_shoulder_roll"

    def _name_forearm(
        self, side: str, elbow: int, after: list[int], ends: tuple[Array, Array], roles: dict[int, str]
    ) -> FoundPoint:
        """Forearm and wrist; the wrist's place is its first joint, or the farthest point where it has none."""
        (shoulder, tip), start = ends, self.anchor[elbow]
        reach = float(np.linalg.norm(tip - start))
        wrist, place, carrier = list[int](), tip, elbow
        for j in after:
            twist = f"{side}_forearm_yaw" not in roles.values() and not wrist
            if twist and abs(self.axis[j] @ _unit(tip - start)) > _ALONG:
                roles[j], carrier = f"{side}_forearm_yaw", j
                place = self.anchor[j] + self.axis[j] * float(self.axis[j] @ (tip - self.anchor[j]))
            elif np.linalg.norm(self.anchor[j] - start) > _TO_THE_WRIST * reach or wrist:
                wrist.append(j)
        if wrist:
            place = self._nearest_on_axis(wrist[0], carrier if carrier != elbow else None)
        self.reach_m = float(np.linalg.norm(place - start) + np.linalg.norm(start - shoulder))
        names = ["wrist"] if len(wrist) == 1 else ["wrist_pitch", "wrist_roll"]
        for j, name in zip(wrist, names, strict=False):
            roles[j] = f"{side}_{name}"
        return self._point(self.body[carrier], place)

    def _nearest_on_axis(self, j: int, twist: int | None) -> Array:
        """The point of a joint's axis nearest to the axis of the forearm's twist; its anchor without one."""
        if twist is None:
            return self.anchor[j]
        a, b = self.axis[j], self.axis[twist]
        gap = self.anchor[twist] - self.anchor[j]
        along = (a @ gap - (a @ b) * (b @ gap)) / max(1 - float(a @ b) ** 2, 1e-9)
        return self.anchor[j] + a * along

    def _name_centre(self, left: int, right: int, roles: dict[int, str], points: dict[str, FoundPoint]) -> None:
        """Waist joints carry both arms; neck joints carry neither and nothing of the legs, and stand above them."""
        arms = {self.body[left], self.body[right]}
        shoulder_m = (self.anchor[left] + self.anchor[right]) / 2
        chest = max(
            set(self._bodies_above(self.body[left])) & set(self._bodies_above(self.body[right])),
            key=self._depth,
            default=0,
        )
        points["chest"] = self._point(chest, shoulder_m)
        last_head = None
        for j in sorted(self.joints, key=lambda k: self._depth(self.body[k])):
            if j in roles or self._side(j) != 0:
                continue
            below = set(self._bodies_below(self.body[j]))
            if below >= arms:
                part = "waist"
            elif not below & arms and self._carried(self.body[j])[:, 2].mean() > shoulder_m[2]:
                part = "head"
            else:
                continue
            kind = ("roll", "pitch", "yaw")[int(np.abs(self.axis[j]).argmax())]
            if f"{part}_{kind}" not in roles.values() and not _FINGERS.search(self.name[j]):
                roles[j] = f"{part}_{kind}"
                last_head = j if part == "head" else last_head
        body = chest if last_head is None else self.body[last_head]
        above = self._carried(body).mean(0)
        if last_head is None:
            above = shoulder_m + np.array([0, 0, 0.2 * self._size()])
        points["head"] = self._point(body, above)

    def _note_what_is_left_out(self, roles: dict[int, str]) -> None:
        arms = [
            self.name[j]
            for j in self.joints
            if j not in roles and any(self.body[k] in self._bodies_above(self.body[j]) for k in roles)
        ]
        others = [self.name[j] for j in self.joints if j not in roles and self.name[j] not in arms]
        if arms:
            self.notes.append(f"left still, beyond a listed joint: {', '.join(arms)}")
        if others:
            self.notes.append(f"left still, no part of arms, neck or waist that carries the arms: {', '.join(others)}")
        if self.missing:
            self.notes.append(f"meshes without a file, so without a shape for contacts: {', '.join(self.missing)}")
        if self.model.ntendon:
            names = ", ".join(str(self.model.tendon(i).name) for i in range(self.model.ntendon))
            self.notes.append(f"tendons couple joints ({names}): if servos share joints, write a [[differential]]")
        tied = [f"{a} and {b}" for a, b in loops(self.spec)]
        if tied:
            self.notes.append(
                f"closed loops, not part of the tree: {', '.join(tied)}; a servo behind one needs a linkage table"
            )

    def _gears(self) -> dict[str, tuple[float, int]]:
        """For each joint that follows another in proportion: turns of the leader for one of it, and their sense."""
        ratio = {e.name1: float(e.data[1]) for e in self.spec.equalities if e.type == mujoco.mjtEq.mjEQ_JOINT}
        return {
            f.name: (round(1 / abs(ratio[f.name]), 6), 1 if ratio[f.name] > 0 else -1)
            for f in followers(self.spec)
            if abs(ratio[f.name]) > 1e-6
        }

    def _joint(self, j: int, role: str, gears: dict[str, tuple[float, int]]) -> FoundJoint:
        limited = bool(self.model.jnt_limited[j])
        low, high = np.rad2deg(self.model.jnt_range[j]).tolist()
        x, y, z = self.axis[j].tolist()
        range_deg = (low, high) if limited and low < high else None
        return FoundJoint(
            self.name[j], role, (x, y, z), range_deg, _sign(role, self.axis[j], range_deg), gears.get(self.name[j])
        )

    def _point(self, body: int, place: Array) -> FoundPoint:
        local = self.data.xmat[body].reshape(3, 3).T @ (self.R.T @ place - self.data.xpos[body])
        x, y, z = (round(float(v), 4) + 0.0 for v in local)
        return FoundPoint(str(self.model.body(body).name), (x, y, z))

    def _bodies_above(self, body: int) -> list[int]:
        above = [body]
        while body:
            body = int(self.model.body_parentid[body])
            above.append(body)
        return above

    def _bodies_below(self, body: int) -> list[int]:
        return [b for b in range(1, self.model.nbody) if body in self._bodies_above(b)]

    def _depth(self, body: int) -> int:
        return len(self._bodies_above(body))

    def _joints_above(self, body: int, but: int) -> list[int]:
        above = set(self._bodies_above(body))
        return [j for j in self.joints if self.body[j] in above and j != but]

    def _carried(self, body: int) -> Array:
        """(N, 3) places of what a body carries: its shapes and those of the bodies on it, or their origins."""
        below = self._bodies_below(body)
        shapes = [g for g in range(self.model.ngeom) if int(self.model.geom_bodyid[g]) in below]
        places = [self.data.geom_xpos[g] for g in shapes] or [self.data.xipos[b] for b in below]
        return np.array(places) @ self.R.T

    def _farthest(self, body: int, from_m: Array) -> Array:
        """The farthest point of what a body carries."""
        best = self.R @ self.data.xipos[body]
        below = self._bodies_below(body)
        for b in below:
            best = max(best, self.R @ self.data.xpos[b], key=lambda p: float(np.linalg.norm(p - from_m)))
        for g in range(self.model.ngeom):
            if int(self.model.geom_bodyid[g]) in below:
                turn = self.R @ self.data.geom_xmat[g].reshape(3, 3)
                box = self.model.geom_aabb[g]
                middle = self.R @ self.data.geom_xpos[g] + turn @ box[:3]
                side = np.sign((middle - from_m) @ turn)
                best = max(
                    best, middle + turn @ (side * _thin(box[3:])), key=lambda p: float(np.linalg.norm(p - from_m))
                )
        return best

    def _size(self) -> float:
        """How big the robot is."""
        places = np.array(list(self.anchor.values()))
        return float(np.linalg.norm(np.ptp(places, axis=0)))


def _thin(half: Array) -> Array:
    """The half sizes of a box without its two short ones: the middle of its far end, not a corner."""
    return np.where(np.arange(3) == int(half.argmax()), half, 0.0)


def _sign(role: str, axis: Array, range_deg: tuple[float, float] | None) -> int:
    """Whether the positive sense is the usual one; see `FoundJoint`."""
    part = role.removeprefix("left_").removeprefix("right_")
    usual = {"head_yaw": (0, 0, 1), "head_pitch": (0, 1, 0), "waist_yaw": (0, 0, 1), "waist_pitch": (0, 1, 0),
             "shoulder_pitch": (0, -1, 0), "shoulder_roll": (1 if role.startswith("left") else -1, 0, 0)}.get(part)  # fmt: skip
    if usual is not None:
        along = float(axis @ np.array(usual))
        return int(np.sign(along)) if abs(along) > _ALONG else 0
    if part == "elbow" and range_deg is not None and abs(sum(range_deg)) > 10:
        return 1 if sum(range_deg) > 0 else -1
    return 0


def _unit(v: Array) -> Array:
    return v / max(float(np.linalg.norm(v)), 1e-9)
