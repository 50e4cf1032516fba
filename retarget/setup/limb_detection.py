"""Finds arms, neck and waist in a description without roles, by forward kinematics in its zero pose.

The role of a joint follows from the bodies that it carries and the direction of its axis, not from its name. Limbs come in mirrored
pairs, and the upper pair are the arms; the elbow is the joint across the arm that is far from both shoulder and hand. Names decide
only two questions: which side is left, and which joints are fingers.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from retarget.errors import RobotFileError
from retarget.robot.description import followers, loops, mujoco
from retarget.setup.anatomy import Anatomy, FoundJoint
from retarget.setup.body_tree import BodyTree, FoundPoint

Array = NDArray[np.float64]
_ALONG = 0.7
"""Cosine from which an axis counts as parallel to a direction."""
_FINGERS = re.compile(r"grip|finger|thumb|claw|jaw|hand_?joint", re.IGNORECASE)
_ELBOW = 0.15
"""Least distance of an elbow from shoulder and hand, as a share of the distance between them."""
_TO_THE_WRIST = 0.3
"""Least distance of a wrist from the elbow, as a share of the length of forearm and hand."""


def find_anatomy(path: Path) -> Anatomy:
    """Arms, neck and waist of a description.

    Raises:
        RobotFileError: MuJoCo cannot read it, or there is no pair of arms in it.
    """
    return _Finder(path).found()


class _Finder:
    """One search; everything is in standard axes (x forward, y left, z up) once `_frame` has found them."""

    def __init__(self, path: Path) -> None:
        self._tree = BodyTree(path)
        self._path = path
        self._reach_m = 0.0

    def found(self) -> Anatomy:
        """The arms, neck and waist with their roles and points."""
        left, right = self._arms()
        roles: dict[int, str] = {}
        points: dict[str, FoundPoint] = {}
        for side, arm in (("left", left), ("right", right)):
            points[f"{side}_wrist"] = self._name_arm(side, arm, roles)
        self._name_centre(left[0], right[0], roles, points)
        self._note_what_is_left_out(roles)
        order = {"head": 0, "wais": 1, "left": 2, "righ": 3}
        listed = sorted(roles, key=lambda j: (order[roles[j][:4]], self._tree.depth(self._tree.body[j]), j))
        gears = self._gears()
        joints = tuple(self._joint(j, roles[j], gears) for j in listed)
        named = {str(self._tree.model.site(i).name) for i in range(self._tree.model.nsite)}
        needed = {name: point for name, point in points.items() if name not in named}
        return Anatomy(
            self._path, self._tree.forward, self._tree.up, joints, needed, self._reach_m, tuple(self._tree.notes)
        )

    def _arms(self) -> tuple[list[int], list[int]]:
        """Joints of the left and the right arm, from the shoulder on."""
        limbs = {"left": self._limbs(1.0), "right": self._limbs(-1.0)}
        pairs = [
            (a, b) for a in limbs["left"] for b in limbs["right"]
            if len(a) == len(b) >= 2 and abs(self._tree.anchor[a[0]][2] - self._tree.anchor[b[0]][2]) < 0.1 * self._tree.size()
        ]  # fmt: skip
        if not pairs:
            found = "; ".join([
                f"{len(limbs['left'])} limbs on the left, {len(limbs['right'])} on the right, none alike", *self._tree.notes
            ])  # fmt: skip
            raise RobotFileError(self._path, "description", found, "a pair of arms of at least two joints")
        return max(pairs, key=lambda p: self._tree.anchor[p[0][0]][2])

    def _limbs(self, side: float) -> list[list[int]]:
        """Chains of joints on one side, each from its first joint to the hand or foot."""
        tree = self._tree
        roots = [
            j for j in tree.joints
            if tree.side(j) == side and not any(tree.side(k) == side for k in tree.joints_above(tree.body[j], j))
        ]  # fmt: skip
        return [self._main_chain(j) for j in roots]

    def _main_chain(self, root: int) -> list[int]:
        """Joints from a limb's first one outwards, always on the branch with most joints; a tie (fingers) ends the chain."""
        chain, body = [root], self._tree.body[root]
        while True:
            following = sorted(
                (
                    (self._tree.longest(c), c)
                    for c in range(1, self._tree.model.nbody)
                    if self._tree.model.body_parentid[c] == body
                ),
                reverse=True,
            )
            if not following or following[0][0] == 0 or (len(following) > 1 and following[0][0] == following[1][0]):
                return chain
            body = following[0][1]
            chain += [
                j for j in self._tree.joints if self._tree.body[j] == body and not _FINGERS.search(self._tree.name[j])
            ]

    def _name_arm(self, side: str, arm: list[int], roles: dict[int, str]) -> FoundPoint:
        """Give an arm's joints their roles; returns the point of its wrist."""
        tree = self._tree
        shoulder = tree.anchor[arm[0]]
        far = {j: tree.farthest(tree.body[arm[-1]], tree.anchor[j]) for j in arm}
        across = {
            j: min(_length(tree.anchor[j] - shoulder), _length(far[j] - tree.anchor[j]))
            for j in arm[1:]
            if abs(tree.axis[j] @ _unit(tree.anchor[j] - shoulder)) < _ALONG
        }
        elbow = max(across, key=lambda j: across[j], default=arm[0])
        if across.get(elbow, 0.0) < _ELBOW * _length(far[arm[0]] - shoulder):
            return self._name_stiff_arm(side, arm, far[arm[-1]], roles)
        at = arm.index(elbow)
        self._name_shoulder(side, arm[:at], _unit(tree.anchor[elbow] - shoulder), roles)
        roles[elbow] = f"{side}_elbow"
        return self._name_forearm(side, elbow, arm[at + 1 :], (shoulder, far[elbow]), roles)

    def _name_stiff_arm(self, side: str, arm: list[int], tip: Array, roles: dict[int, str]) -> FoundPoint:
        """Give the joints of an arm without an elbow shoulder roles; returns the point of its wrist, the arm's end."""
        tree = self._tree
        self._tree.notes.append(f"{side} arm: no joint is an elbow, far from both shoulder and hand")
        self._name_shoulder(side, arm[:3], _unit(tip - tree.anchor[arm[0]]), roles)
        self._reach_m = _length(tip - tree.anchor[arm[0]])
        return tree.point(tree.body[arm[-1]], tip)

    def _name_shoulder(self, side: str, joints: list[int], upper: Array, roles: dict[int, str]) -> None:
        rest = list(joints)
        if len(rest) > 1 and abs(self._tree.axis[rest[-1]] @ upper) > _ALONG:
            roles[rest.pop()] = f"{side}_shoulder_yaw"
        if rest:
            pitch = max(rest, key=lambda j: abs(float(self._tree.axis[j][1])))
            if abs(self._tree.axis[pitch][1]) > _ALONG or len(rest) > 1:
                roles[pitch] = f"{side}_shoulder_pitch"
                rest.remove(pitch)
        if rest:
            roles[rest.pop(0)] = f"{side}_shoulder_roll"

    def _name_forearm(
        self, side: str, elbow: int, after: list[int], ends: tuple[Array, Array], roles: dict[int, str]
    ) -> FoundPoint:
        """Give forearm and wrist joints their roles; returns the first wrist joint's point, without one the farthest point."""
        (shoulder, tip), start = ends, self._tree.anchor[elbow]
        reach = _length(tip - start)
        wrist, place, carrier = list[int](), tip, elbow
        for j in after:
            twist = f"{side}_forearm_yaw" not in roles.values() and not wrist
            if twist and abs(self._tree.axis[j] @ _unit(tip - start)) > _ALONG:
                roles[j], carrier = f"{side}_forearm_yaw", j
                place = self._tree.anchor[j] + self._tree.axis[j] * float(
                    self._tree.axis[j] @ (tip - self._tree.anchor[j])
                )
            elif _length(self._tree.anchor[j] - start) > _TO_THE_WRIST * reach or wrist:
                wrist.append(j)
        if wrist:
            place = self._tree.nearest_on_axis(wrist[0], carrier if carrier != elbow else None)
        self._reach_m = _length(place - start) + _length(start - shoulder)
        names = ["wrist"] if len(wrist) == 1 else ["wrist_pitch", "wrist_roll"]
        for j, name in zip(wrist, names, strict=False):
            roles[j] = f"{side}_{name}"
        return self._tree.point(self._tree.body[carrier], place)

    def _name_centre(self, left: int, right: int, roles: dict[int, str], points: dict[str, FoundPoint]) -> None:
        """Waist joints carry both arms; neck joints carry neither and nothing of the legs, and stand above them."""
        arms = {self._tree.body[left], self._tree.body[right]}
        shoulder_m = (self._tree.anchor[left] + self._tree.anchor[right]) / 2
        chest = max(
            set(self._tree.bodies_above(self._tree.body[left])) & set(self._tree.bodies_above(self._tree.body[right])),
            key=self._tree.depth,
            default=0,
        )
        points["chest"] = self._tree.point(chest, shoulder_m)
        last_head = None
        for j in sorted(self._tree.joints, key=lambda k: self._tree.depth(self._tree.body[k])):
            if j in roles or self._tree.side(j) != 0:
                continue
            below = set(self._tree.bodies_below(self._tree.body[j]))
            if below >= arms:
                part = "waist"
            elif not below & arms and self._tree.carried(self._tree.body[j])[:, 2].mean() > shoulder_m[2]:
                part = "head"
            else:
                continue
            kind = ("roll", "pitch", "yaw")[int(np.abs(self._tree.axis[j]).argmax())]
            if f"{part}_{kind}" not in roles.values() and not _FINGERS.search(self._tree.name[j]):
                roles[j] = f"{part}_{kind}"
                last_head = j if part == "head" else last_head
        body = chest if last_head is None else self._tree.body[last_head]
        above = self._tree.carried(body).mean(0)
        if last_head is None:
            above = shoulder_m + np.array([0, 0, 0.2 * self._tree.size()])
        points["head"] = self._tree.point(body, above)

    def _note_what_is_left_out(self, roles: dict[int, str]) -> None:
        arms = [
            self._tree.name[j]
            for j in self._tree.joints
            if j not in roles and any(self._tree.body[k] in self._tree.bodies_above(self._tree.body[j]) for k in roles)
        ]
        others = [self._tree.name[j] for j in self._tree.joints if j not in roles and self._tree.name[j] not in arms]
        if arms:
            self._tree.notes.append(f"left still, beyond a listed joint: {', '.join(arms)}")
        if others:
            self._tree.notes.append(
                f"left still, no part of arms, neck or waist that carries the arms: {', '.join(others)}"
            )
        if self._tree.missing:
            self._tree.notes.append(
                f"meshes without a file, so without a shape for contacts: {', '.join(self._tree.missing)}"
            )
        if self._tree.model.ntendon:
            names = ", ".join(str(self._tree.model.tendon(i).name) for i in range(self._tree.model.ntendon))
            self._tree.notes.append(
                f"tendons couple joints ({names}): if servos share joints, write a [[differential]]"
            )
        tied = [f"{a} and {b}" for a, b in loops(self._tree.spec)]
        if tied:
            self._tree.notes.append(
                f"closed loops, not part of the tree: {', '.join(tied)}; a servo behind one needs a linkage table"
            )

    def _gears(self) -> dict[str, tuple[float, int]]:
        """For each joint that follows a leader in proportion: turns of the leader per turn of the joint, and their sense."""
        ratio = {e.name1: float(e.data[1]) for e in self._tree.spec.equalities if e.type == mujoco.mjtEq.mjEQ_JOINT}
        return {
            f.name: (round(1 / abs(ratio[f.name]), 6), 1 if ratio[f.name] > 0 else -1)
            for f in followers(self._tree.spec)
            if abs(ratio[f.name]) > 1e-6
        }

    def _joint(self, j: int, role: str, gears: dict[str, tuple[float, int]]) -> FoundJoint:
        limited = bool(self._tree.model.jnt_limited[j])
        low, high = np.rad2deg(self._tree.model.jnt_range[j]).tolist()
        x, y, z = self._tree.axis[j].tolist()
        range_deg = (low, high) if limited and low < high else None
        return FoundJoint(
            self._tree.name[j],
            role,
            (x, y, z),
            range_deg,
            _sign(role, self._tree.axis[j], range_deg),
            gears.get(self._tree.name[j]),
        )


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


def _length(v: Array) -> float:
    return float(np.linalg.norm(v))


def _unit(v: Array) -> Array:
    return v / max(float(np.linalg.norm(v)), 1e-9)
