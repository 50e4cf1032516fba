"""Changes tempo, size, hold and posture of a motion: features are resampled in time, rotations are scaled or added to.

Only root and rotation channels are read; the others are computed by forward kinematics. `sizing` scales the rotations.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from mmm_core.motion.features import HUMANML3D, features_from_rotations, recover, root_path
from mmm_core.motion.motion import FPS, Motion
from mmm_core.motion.repetitions import body_path, strokes_of
from mmm_core.motion.sizing import is_cyclic, sized
from mmm_core.motion.skeleton import Array, forward_kinematics, from_six_d, rotation_y, six_d
from mmm_core.motion.wide_way import reach_m, way_of, with_wide_way

_SPINE, _HEAD = (3, 6, 9), (15,)
_WIDE_WAY_TIMES, _WIDE_WAY_FRAMES = 3.0, 30
"""A wide way takes so many times as long as the way before, and is so lengthened to this many frames at most."""
_ENOUGH = 0.95
"""Share of the distance asked for that lets the hands keep their way."""
RAMP_FRAMES = 5
"""Frames over which size changes between two commands of a motion."""
STILL_M_S = 0.2
"""Metres a second below which a limb is held, with angles scaled to metres as in `body_path`."""
_FAR = 0.6
"""Share of the greatest distance from the first frame beyond which a pose counts as held."""
_LIMBS = (slice(0, 3), slice(3, 6), slice(6, 9), slice(9, 12))


@dataclass(frozen=True)
class _Swing:
    """A part of a performed motion whose arms swing out.

    Attributes:
        begin, end: first frame of the part, and the one after its last.
        first, last: frames from its beginning between which the arms swing out.
        wanted_m: distance from their first place to which the hands should come, metres.
    """

    begin: int
    end: int
    first: int
    last: int
    wanted_m: float


@dataclass(frozen=True)
class Stretch:
    """Frames of a motion that are performed in one manner.

    Attributes:
        start, end: first frame, and the one after the last.
        tempo: factor of speed.
        size: factor of size.
        hold_s: seconds that the pose is held; 0 leaves it as it is.
        trunk_pitch_rad, head_pitch_rad: posture that is added to trunk and head, forward and down positive.
        way: factor by which the hands go farther on the way to their gesture; above 1 they swing out wide.
    """

    start: int
    end: int
    tempo: float = 1.0
    size: float = 1.0
    hold_s: float = 0.0
    trunk_pitch_rad: float = 0.0
    head_pitch_rad: float = 0.0
    way: float = 1.0

    @property
    def plain(self) -> bool:
        """Whether the manner changes no frame."""
        return self == Stretch(self.start, self.end)


def performed(features: NDArray[np.float32], stretches: Sequence[Stretch]) -> tuple[NDArray[np.float32], list[int]]:
    """Features performed in the manners of their stretches, and the frame at which each stretch then ends.

    Features come back with as many frames as tempo and hold give them.

    Args:
        features: (T, 263), of our definition (`rest_pose` "mmmd").
        stretches: in order, without gaps, from 0 to T.
    """
    yaw, root = root_path(np.asarray(features, np.float64))
    local = np.empty((len(features), 22, 3, 3))
    local[:, 0] = rotation_y(yaw)
    local[:, 1:] = from_six_d(np.asarray(features[:, 67:193], np.float64).reshape(-1, 21, 6))
    places: list[Array] = []
    swings: list[_Swing] = []
    ends: list[int] = []
    for stretch in stretches:
        part = slice(stretch.start, stretch.end)
        motion = _motion(features[part])
        wanted_m = stretch.way * reach_m(local[part]) if stretch.way > 1.0 else 0.0
        if stretch.size != 1.0:
            local[part] = sized(local[part], local[0], motion, stretch.size, _ramp(stretch, len(features)))
        if stretch.trunk_pitch_rad or stretch.head_pitch_rad:
            _lean(local[part], stretch, len(features))
        way = _wide_way(local[part], motion, stretch, wanted_m)
        frames = _times(motion, stretch, way)
        begin = ends[-1] if ends else 0
        ends.append(begin + len(frames))
        places.append(stretch.start + frames)
        if way is not None:
            first, last = np.searchsorted(frames, way).tolist()
            swings.append(_Swing(begin, ends[-1], first, last, wanted_m))
    where = np.clip(np.concatenate(places), 0, len(features) - 1)
    return _features(yaw, root, local, where, swings), ends


def motion_of(features: NDArray[np.float32]) -> Motion:
    """The motion of features (T, 263), without text and ids."""
    return _motion(features)


def _motion(features: NDArray[np.float32]) -> Motion:
    seen = recover(features)
    return Motion(
        seen.joints_m.astype(np.float32), FPS, seen.head_quat_wxyz.astype(np.float32), seen.forearm_twist_rad.astype(np.float32),
        np.asarray(features, np.float32), np.zeros(0, np.int64), "", 0, "accepted", 1.0,
    )  # fmt: skip


def _features(yaw: Array, root: Array, local: Array, where: Array, swings: Sequence[_Swing]) -> NDArray[np.float32]:
    """Features of rotations and root at (n,) places between the frames, and with arms that swing out wide."""
    before = np.floor(where).astype(np.intp)
    after = np.minimum(before + 1, len(yaw) - 1)
    w = where - before
    mixed_yaw = yaw[before] + w * (yaw[after] - yaw[before])
    mixed_root = root[before] + w[:, None] * (root[after] - root[before])
    six = six_d(local[:, 1:])
    rotations = from_six_d(six[before] + w[:, None, None] * (six[after] - six[before]))
    whole = np.concatenate([rotation_y(mixed_yaw)[:, None], rotations], 1)
    for swing in swings:
        part = slice(swing.begin, swing.end)
        whole[part] = with_wide_way(whole[part], (swing.first, swing.last), swing.wanted_m)
    joints, _ = forward_kinematics(whole, mixed_root)
    return features_from_rotations(joints, mixed_yaw, whole[:, 1:], HUMANML3D)


def _wide_way(local: Array, motion: Motion, stretch: Stretch, wanted_m: float) -> tuple[int, int] | None:
    """First and last frame of a way that is to be wide; None where the hands go far enough, or repeat a stroke."""
    if stretch.way <= 1.0 or reach_m(local) >= _ENOUGH * wanted_m or is_cyclic(strokes_of(motion)):
        return None
    return way_of(local)


def _lean(local: Array, stretch: Stretch, n_frames: int) -> None:
    """Add the posture of a stretch to its rotations (T, 22, 3, 3), in place."""
    weights = _ramp(stretch, n_frames)
    for joints, pitch_rad in ((_SPINE, stretch.trunk_pitch_rad / len(_SPINE)), (_HEAD, stretch.head_pitch_rad)):
        pitch = Rotation.from_rotvec(np.outer(pitch_rad * weights, [1.0, 0.0, 0.0])).as_matrix()
        for joint in joints:
            local[:, joint] = local[:, joint] @ pitch


def _ramp(stretch: Stretch, n_frames: int) -> Array:
    """(T,) weights of a manner: 1, and less in the first and last frames next to another stretch."""
    n = stretch.end - stretch.start
    ramp = np.minimum(np.arange(1, n + 1) / RAMP_FRAMES, 1.0)
    weights = np.ones(n)
    if stretch.start > 0:
        weights = np.minimum(weights, ramp)
    if stretch.end < n_frames:
        weights = np.minimum(weights, ramp[::-1])
    return weights


def _tempo(motion: Motion, stretch: Stretch) -> float:
    """The factor of speed; larger strokes for which none is asked take longer, so that servos need not accelerate harder."""
    if stretch.tempo == 1.0 and stretch.size > 1.0 and is_cyclic(strokes_of(motion)):
        return stretch.size**-0.5
    return stretch.tempo


def _times(motion: Motion, stretch: Stretch, way: tuple[int, int] | None) -> Array:
    """(n,) fractional frame numbers, from the stretch's start, at which the performed motion samples it."""
    T = len(motion.joints_m)
    n = max(4, round(T / _tempo(motion, stretch)))
    places = (np.arange(n) + 0.5) * T / n - 0.5
    if way is not None:
        on_way = (places > way[0]) & (places < way[1])
        n_before = max(2, int(on_way.sum()))
        longer = np.linspace(*way, max(n_before, min(round(_WIDE_WAY_TIMES * n_before), _WIDE_WAY_FRAMES)) + 2)
        places = np.concatenate([places[places <= way[0]], longer[1:-1], places[places >= way[1]]])
    still = held_frames(motion) if stretch.hold_s else None
    if still is None:
        return places
    first, last = still
    held = np.linspace(first, last, max(2, round(stretch.hold_s * FPS)))
    return np.concatenate([places[places < first], held, places[places > last]])


def held_frames(motion: Motion) -> tuple[int, int] | None:
    """First and last frame of the longest pause of the limb that moves farthest, far from its start; None where nothing moves.

    A limb that never pauses there is taken as held for the frames beside its farthest point.
    """
    path = body_path(motion)
    limb = max(_LIMBS, key=lambda columns: float(np.linalg.norm(path[:, columns] - path[0, columns], axis=-1).max()))
    limb_path = path[:, limb]
    far = np.linalg.norm(limb_path - limb_path[0], axis=-1)
    if len(far) < 3 or far.max() < 0.05:
        return None
    speed = np.linalg.norm(np.gradient(limb_path, axis=0), axis=-1) * FPS
    best: tuple[int, int] | None = None
    start = -1
    for frame, ok in enumerate([*((speed < STILL_M_S) & (far > _FAR * far.max())).tolist(), False]):
        if ok and start < 0:
            start = frame
        elif not ok and start >= 0:
            if best is None or frame - 1 - start > best[1] - best[0]:
                best = (start, frame - 1)
            start = -1
    peak = int(far.argmax())
    return best or (max(0, peak - 1), min(len(far) - 1, peak + 1))
