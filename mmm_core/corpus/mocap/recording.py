"""A recording of any skeleton brought to the common one: 22 joints, common bone lengths, 20 fps."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mmm_core.errors import TrainingDataError
from mmm_core.motion import FPS
from mmm_core.skeleton import BONE_LENGTHS_M, JOINT_NAMES, PARENTS, Array

FLOOR_PERCENTILE = 2.0
"""Height of the feet that is taken as the floor."""
_SHORTEST_BONE_M = 1e-3
_MIDDLE = {
    "pelvis": ("pelvis", "hips", "hip", "root"),
    "spine1": ("spine1", "spine", "lowerback"),
    "spine2": ("spine2", "spine1", "upperback", "chest"),
    "spine3": ("spine3", "spine3_neck", "spine2", "thorax", "chest2", "neck"),
    "neck": ("neck", "neck1", "lowerneck"),
    "head": ("upperneck", "head", "neck_end"),
}
_SIDED = {
    "hip": ("{side}_hip", "{side}upleg", "{side}hip", "{s}hipjoint"),
    "knee": ("{side}_knee", "{side}leg", "{side}knee", "{s}femur"),
    "ankle": ("{side}_ankle", "{side}foot", "{side}ankle", "{s}tibia"),
    "foot": ("{side}_foot", "{side}toebase", "{side}toe", "{s}foot", "{side}_ankle_end"),
    "collar": ("{side}_collar", "{side}shoulder", "{side}collar"),
    "shoulder": ("{side}_shoulder", "{side}arm", "{side}uparm", "{s}clavicle"),
    "elbow": ("{side}_elbow", "{side}forearm", "{side}lowarm", "{s}humerus"),
    "wrist": ("{side}_wrist", "{side}hand", "{s}radius", "{side}_elbow_end"),
}
"""Names, lower case, that other skeletons have for our joints: ours, those of BVH files, the ends of CMU's ASF bones."""


@dataclass(frozen=True)
class Recording:
    """Joint positions of any skeleton.

    Attributes:
        path: file it was read from.
        names: of its J joints.
        positions_m: (T, J, 3) metres, y up.
        fps: frames a second.
    """

    path: Path
    names: tuple[str, ...]
    positions_m: Array
    fps: float

    def common(self) -> Array:
        """(T', 22, 3) joints on the common body at 20 fps: bone directions kept, lengths replaced, feet on the floor.

        Raises:
            TrainingDataError: a joint has no counterpart, a bone has no length, or there are fewer than two frames.
        """
        if len(self.positions_m) < 2 or not np.isfinite(self.positions_m).all():
            raise TrainingDataError(
                self.path, "frames", f"{len(self.positions_m)} frames or a value that is no number", "two finite frames"
            )
        source = self._resampled(np.stack([self._joint(name) for name in JOINT_NAMES], 1))
        joints = np.empty_like(source)
        legs_m = np.linalg.norm(source[:, (4, 7)] - source[:, (1, 4)], axis=-1).sum(-1).mean()
        joints[:, 0] = source[:, 0] * (BONE_LENGTHS_M[4] + BONE_LENGTHS_M[7]) / max(legs_m, _SHORTEST_BONE_M)
        for j, parent in enumerate(PARENTS[1:], 1):
            bone = source[:, j] - source[:, parent]
            length_m = np.linalg.norm(bone, axis=-1, keepdims=True)
            if length_m.min() < _SHORTEST_BONE_M:
                raise TrainingDataError(
                    self.path, JOINT_NAMES[j], f"it lies on {JOINT_NAMES[parent]}", "two joints apart"
                )
            joints[:, j] = joints[:, parent] + BONE_LENGTHS_M[j] * bone / length_m
        joints[..., 1] -= np.percentile(joints[:, (10, 11), 1], FLOOR_PERCENTILE)
        return joints

    def _joint(self, name: str) -> Array:
        """(T, 3) positions of one of our joints.

        A collar that is missing, or that lies on the end of the spine as in many BVH files, is put between neck and shoulder.
        """
        index = {n.lower().split(":")[-1]: i for i, n in enumerate(self.names)}
        side, _, part = name.partition("_")
        wanted = tuple(n.format(side=side, s=side[0]) for n in _SIDED[part]) if part else _MIDDLE[name]
        if name.startswith("spine") and not {"spine3", "spine3_neck", "thorax"} & set(index):
            wanted = {
                "spine1": ("spine", "lowerback"),
                "spine2": ("spine1", "chest"),
                "spine3": ("spine2", "neck", "chest2"),
            }[name]
        if name == "neck" and "neck1" in index:
            wanted = ("neck1",)
        found = next((self.positions_m[:, index[n]] for n in wanted if n in index), None)
        if part == "collar" and (found is None or _coincide(found, self._joint("spine3"))):
            neck, shoulder = self._joint("neck"), self._joint(f"{side}_shoulder")
            return neck + 0.45 * (shoulder - neck)
        if found is None:
            joints = f"joints {', '.join(self.names[:12])}, ..."
            raise TrainingDataError(self.path, name, joints, f"one called {' or '.join(wanted)}")
        return found

    def _resampled(self, positions_m: Array) -> Array:
        """Positions at 20 fps, linear between frames; faster recordings are averaged over a frame of ours first."""
        ratio = self.fps / FPS
        width = max(1, round(ratio / 2) * 2 - 1)
        flat = positions_m.reshape(len(positions_m), -1)
        if width > 1:
            padded = np.pad(flat, ((width // 2, width // 2), (0, 0)), mode="edge")
            sums = np.cumsum(np.vstack([np.zeros((1, flat.shape[1])), padded]), axis=0)
            flat = (sums[width:] - sums[:-width]) / width
        at = np.arange(0, len(flat) - 1 + 1e-9, ratio)
        low = np.minimum(at.astype(int), len(flat) - 2)
        share = (at - low)[:, None]
        return ((1 - share) * flat[low] + share * flat[low + 1]).reshape(-1, *positions_m.shape[1:])


def _coincide(a: Array, b: Array) -> bool:
    return bool(np.linalg.norm(a - b, axis=-1).min() < _SHORTEST_BONE_M)
