"""Keeps contacts of the hands (clapping, praying, resting on hip, chest or head) on a robot of other proportions.

Bone directions alone bring hands together only on a body of a person's proportions. Where a person's hand comes near the other
hand or a landmark, the smallest movement of the arm joints draws the robot's hand to its other hand or its body, until only
the margin of self-contact separates them; the nearer the person's hand is, the closer the robot's is drawn.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from retarget.human.human import SIDES, HumanMotion
from retarget.path.collision import SelfContact
from retarget.path.limits import JointLimits, within
from retarget.robot.kinematics import Kinematics

Array = NDArray[np.float64]
_PALM_M = 0.09
"""Metres from a person's wrist to the middle of the palm."""
_HUMAN = {"other hand": (0.10, 0.28), "head": (0.15, 0.25), "chest": (0.17, 0.26), "hip": (0.14, 0.22)}
"""Metres from a palm to the other palm, the head, the spine at the chest and a hip joint: at the first a palm touches, at the
second contact ends."""
_LANDMARKS = {"head": (15,), "chest": (9,), "hip": (1, 2)}
_BETWEEN_M = 0.004
"""Metres between touching hands, beyond the margin of self-contact."""
_STEPS = 10
_LARGEST_STEP_RAD = 0.15
_DAMPING = 2e-4
_WORTH_IT = 0.5
"""Share of a contact's frames in which the robot must reach it; a contact reached in fewer is not pursued."""
_KEPT_M = 0.02
"""Metres between two shapes, beyond the margin, up to which their contact counts as kept."""


@dataclass(frozen=True)
class HumanContacts:
    """Degree of contact (T,), 0 to 1, of a person's palms, by side and by the place that the palm touches."""

    share: dict[tuple[str, str], Array]

    @property
    def any(self) -> bool:
        """Whether a palm touches in any frame."""
        return any(s.any() for s in self.share.values())


def read_contacts(motion: HumanMotion) -> HumanContacts:
    """Contacts of the hands in a motion."""
    joints = motion.joints_m.astype(np.float64)
    palm = {s: _palm(joints, e, w) for s, (e, w) in zip(SIDES, ((18, 20), (19, 21)), strict=True)}
    share: dict[tuple[str, str], Array] = {}
    for side, other in zip(SIDES, reversed(SIDES), strict=True):
        share[side, "other hand"] = _near(np.linalg.norm(palm[side] - palm[other], axis=-1), "other hand")
        for what, marks in _LANDMARKS.items():
            away = np.min([np.linalg.norm(palm[side] - joints[:, j], axis=-1) for j in marks], axis=0)
            share[side, what] = _near(away, what)
    return HumanContacts(share)


class Hands:
    """The hands of one robot: the shapes beyond the last arm joint, or the forearms if no shape lies beyond."""

    def __init__(self, kinematics: Kinematics, contact: SelfContact, limits: JointLimits) -> None:
        self._contact = contact
        self._low, self._high = limits.position_min_rad, limits.position_max_rad
        robot = kinematics.robot
        self._mobility = np.array([j.role.startswith(SIDES) for j in robot.joints], np.float64)
        points = {p.name: p for p in kinematics.key_points}
        head = [i for i, j in enumerate(robot.joints) if j.role.startswith("head_")]
        arms = [i for i, j in enumerate(robot.joints) if j.role.startswith(SIDES)]
        hand = {side: self._last_shapes(points[f"{side}_wrist"].chain) for side in SIDES}
        head_shapes, body_shapes = contact.shapes_moved_by(head, []), contact.shapes_moved_by([], head + arms)
        self._pairs: dict[tuple[str, str], NDArray[np.int64]] = {}
        for side, other in zip(SIDES, reversed(SIDES), strict=True):
            touched = {"other hand": hand[other], "head": head_shapes if head else body_shapes}
            for what, shapes in (touched | {"chest": body_shapes, "hip": body_shapes}).items():
                pairs = contact.pairs_between(hand[side], shapes)
                if len(pairs):
                    self._pairs[side, what] = pairs

    def _last_shapes(self, chain: tuple[int, ...]) -> NDArray[np.int64]:
        """Shapes moved by the last joint of a chain that moves a shape."""
        for joint in reversed(chain):
            shapes = self._contact.shapes_moved_by([joint], [])
            if len(shapes):
                return shapes
        return np.zeros(0, np.int64)

    def keep(self, q_rad: Array, human: HumanContacts) -> Array:
        """Poses (T, J) with the hands drawn to the person's contacts; contacts out of reach do not change the poses."""
        wanted = [key for key, share in human.share.items() if share.any() and key in self._pairs]
        q = self._drawn(q_rad, human, wanted)
        counts = self.kept(q, human)
        lost = [name for name, n in counts.items() if n["robot"] < _WORTH_IT * n["human"]]
        if not lost:
            return q
        return self._drawn(q_rad, human, [key for key in wanted if _name(key) not in lost])

    def _drawn(self, q_rad: Array, human: HumanContacts, wanted: list[tuple[str, str]]) -> Array:
        q = q_rad.copy()
        aim: dict[tuple[str, str], Array] = {}
        for key in wanted:
            far = np.maximum(self._contact.nearest(q, self._pairs[key])[0] - _BETWEEN_M, 0.0)
            aim[key] = (1 - human.share[key]) * far + _BETWEEN_M
        for _ in range(_STEPS if wanted else 0):
            for key in wanted:
                gap, way = self._contact.nearest(q, self._pairs[key])
                too_far = np.where(human.share[key] > 0, np.maximum(gap - aim[key], 0.0), 0.0)[:, None]
                way = way * self._mobility
                step = -too_far * way / ((way * way).sum(1, keepdims=True) + _DAMPING)
                step = within(step, -_LARGEST_STEP_RAD, _LARGEST_STEP_RAD)
                q = within(q + step, self._low, self._high)
        return q

    def apart_m(self, q_rad: Array) -> float:
        """Least distance of the hands beyond their margin in poses (T, J); infinite for a robot whose hands cannot touch."""
        pairs = self._pairs.get(("left", "other hand"))
        return float("inf") if pairs is None else float(self._contact.nearest(q_rad, pairs)[0].min())

    def kept(self, q_rad: Array, human: HumanContacts) -> dict[str, dict[str, int]]:
        """For each contact, the number of frames in which the person touches fully, and of those in which the robot does."""
        counts: dict[str, dict[str, int]] = {}
        for (side, what), share in human.share.items():
            whole = np.flatnonzero(share[: len(q_rad)] >= 1)
            if len(whole) and (side, what) in self._pairs:
                gap, _ = self._contact.nearest(q_rad[whole], self._pairs[side, what])
                counts[_name((side, what))] = {"human": len(whole), "robot": int((gap < _KEPT_M).sum())}
        return counts


def _name(key: tuple[str, str]) -> str:
    return f"{key[0]} hand to {key[1]}"


def _palm(joints: Array, elbow: int, wrist: int) -> Array:
    along = joints[:, wrist] - joints[:, elbow]
    return joints[:, wrist] + _PALM_M * along / np.maximum(np.linalg.norm(along, axis=-1, keepdims=True), 1e-9)


def _near(distance_m: Array, what: str) -> Array:
    """Degree of contact at a distance: 1 where the palm touches, 0 where it is far, smooth between."""
    touch, far = _HUMAN[what]
    x = np.clip((far - distance_m) / (far - touch), 0.0, 1.0)
    return x * x * (3 - 2 * x)
