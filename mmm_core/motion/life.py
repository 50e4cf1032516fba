"""Adds small movements of trunk and head, which a generated gesture lacks: the chest goes along with the arms, the head leads them.

The model moves arms while the trunk stands like a post (docs/evaluation.md, "Beside people"). `alive` adds rotations of a few
degrees to the decoded motion:

- The chest turns, tilts and leans with the arms, a little before them, as trunk muscles balance the weight of an arm
  (Bouisset and Zattara 1987, J. Biomech. 20).
- The head turns to where a hand goes before the hand gets there (Land, Mennie and Rusted 1999, Perception 28), and comes back
  where the hand stays. Against the chest's turns it holds half of its direction.
- When arms come down, chest and head sink and rise again: the gesture settles.
- Breath and a slow sway go on meanwhile; the seed gives their phases.

All joints above the first joint of the spine turn with the chest, so that arms keep their directions relative to the chest. The
additions fade where the motion itself moves head or trunk, and are small where no arm moves. The first and last frame do not
change, so that motions still meet. The first `OPENING_FRAMES` depend on no later frame, so that a preview and its motion, which
share these frames, begin alike.
All operations are elementwise, and odd in every quantity that a mirror negates: the mirrored motion becomes the mirror image to
the last bit.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import accumulate

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion.motion import FPS, Motion

Array = NDArray[np.float64]

_LEAD_FRAMES, _CHEST_LEAD_FRAMES = 4, 1
"""Frames (0.2 and 0.05 s) by which head and chest are ahead of the arms."""
_SMOOTH = (0.1, 0.2, 0.4, 0.2, 0.1)
"""Weights of five neighbouring frames in the smoothed path of the arms."""
OPENING_FRAMES = 8
"""Frames of the two tokens that a preview and its motion share (`mmm_core/generate/motion_generation.py`)."""
RISE_FRAMES, FALL_FRAMES = 8, 10
"""Frames over which the additions rise at the beginning and fall at the end."""
_ARM_M = 0.514
"""Length of the arm from shoulder to wrist in metres."""
_FORGOTTEN = 0.07
"""Share of a hand's new place that the head gets used to in each frame: half of it in half a second."""
_SETTLED = 0.15
"""Share of the sinking that is over after each frame."""
_ABOVE = [6, 9, *range(12, 22)]
"""Joints above the first joint of the spine."""
_OWN_DEG = 10.0
"""Degrees between the first and the present direction of head or trunk at which their own movement halves the additions."""
_STILL_SHARE, _MOVED = 0.2, 0.25
"""Share of the sway where no arm moves, and wrist displacement, in arm lengths, at which half of the remaining sway is added."""


@dataclass(frozen=True)
class Life:
    """Sizes of the additions in degrees.

    Attributes:
        turn: yaw of the chest, for one wrist an arm length ahead.
        tilt: roll of the chest, for one wrist an arm length up.
        lean: pitch of the chest, for both wrists an arm length up.
        gaze: rotation of the head, for a wrist an arm length away.
        settle: pitch of the chest, for two arms that come down from the shoulders' height.
        chest_sway, head_sway: yaw, roll and pitch of the slow movements.
        most: bound on the added rotation of chest and of head about each axis.
    """

    turn: float = 18.0
    tilt: float = 10.0
    lean: float = 7.5
    gaze: float = 18.0
    settle: float = 3.0
    chest_sway: tuple[float, float, float] = (5.0, 3.8, 5.0)
    head_sway: tuple[float, float, float] = (6.1, 5.0, 6.1)
    most: float = 8.0


_HZ = np.array([[[0.23, 0.41], [0.19, 0.37], [0.25, 0.43]], [[0.29, 0.53], [0.31, 0.47], [0.33, 0.61]]])
"""Hertz of two waves each for yaw, roll and pitch of chest and head, without a common period; the chest's pitch is breath."""


def alive(motion: Motion, *, is_mirrored: bool = False, life: Life | None = None) -> Motion:
    """The motion with small movements of trunk and head; features, ids and everything below the spine stay.

    Args:
        motion: at 20 frames per second; one of another rate, or shorter than half a second, comes back as it is.
        is_mirrored: whether the motion is the mirror image of its text's canonical one: the sway is mirrored as well.
        life: sizes; None for the usual ones.
    """
    if len(motion.joints_m) < FALL_FRAMES or motion.fps != FPS:
        return motion
    x, y, z = np.ascontiguousarray(motion.joints_m.T, np.float64)  # (22, T) each
    head_quat = np.ascontiguousarray(motion.head_quat_wxyz.T, np.float64)
    facing = _facing(x, z)
    chest_deg, head_deg = _turns((x, y, z), head_quat, facing, life or Life(), motion.seed, is_mirrored)
    chest, head = _quat(chest_deg, facing), _quat(head_deg, facing)
    joints_m = motion.joints_m.copy()
    face = _rotated(head, x[15] - x[12], y[15] - y[12], z[15] - z[12])
    for v, turned in zip((x, y, z), face, strict=True):
        v[15] = v[12] + turned
    above = _rotated(chest, *(v[_ABOVE] - v[3] for v in (x, y, z)))
    for axis, (v, turned) in enumerate(zip((x, y, z), above, strict=True)):
        joints_m[:, _ABOVE, axis] = (v[3] + turned).T
    head_quat = _product(chest, _product(head, head_quat))
    return replace(motion, joints_m=joints_m, head_quat_wxyz=head_quat.T.astype(np.float32))


def _turns(
    xyz: tuple[Array, Array, Array], head_quat: Array, facing: Array, life: Life, seed: int, is_mirrored: bool
) -> tuple[Array, Array]:
    """Added rotations of the chest, and of the head against the chest.

    Both are (3, T) degrees of yaw (left), roll (left shoulder up) and pitch (forward).
    """
    n = facing.shape[1]
    frames = np.arange(n)
    l_out, l_up, l_ahead, r_out, r_up, r_ahead = _smooth(
        np.concatenate([_arm(xyz, wrist, facing) for wrist in (20, 21)])
    )
    aside, apart, over, ups = where = np.stack([l_out + r_out, l_ahead - r_ahead, l_up - r_up, l_up + r_up])
    aside, apart, over, rise = where[:, _ahead(n, _CHEST_LEAD_FRAMES)]
    sunk = np.maximum(-np.diff(ups, prepend=ups[:1]), 0.0)
    sinking = life.settle * _faded(sunk, 1.0 - _SETTLED)
    chest = np.stack([life.turn * (0.6 * aside - apart), life.tilt * over, -0.5 * life.lean * rise + sinking])
    later = _ahead(n, _LEAD_FRAMES)
    aside, apart, over, rise = where[:, later] - _faded(_FORGOTTEN * where, 1.0 - _FORGOTTEN)
    head = life.gaze * np.stack([aside + 0.5 * apart, 0.3 * over, -0.5 * rise]) - 0.5 * chest
    head[2] += sinking

    away = np.maximum(l_out * l_out + l_up * l_up + l_ahead * l_ahead, r_out * r_out + r_up * r_up + r_ahead * r_ahead)
    moved = np.maximum.accumulate(away)[later] / _MOVED**2
    sway = _STILL_SHARE + (1 - _STILL_SHARE) * moved / (1 + moved)
    phase = np.random.default_rng(seed).uniform(0, 2 * np.pi, (2, 3, 2, 1))
    waves = np.sin(2 * np.pi / FPS * _HZ[..., None] * frames + phase).sum(2) / 2
    waves *= np.array([life.chest_sway, life.head_sway])[..., None] * sway
    if is_mirrored:
        waves[:, :2] *= -1.0

    x, y, z = xyz
    own_chest = _angle_deg(_seen(x[12] - x[3], y[12] - y[3], z[12] - z[3], facing))
    own_chest = own_chest + _angle_deg(_seen(x[13] - x[14], y[13] - y[14], z[13] - z[14], facing))
    own_head = _angle_deg(_seen(*_face(head_quat), facing))
    own = np.maximum.accumulate(np.stack([own_chest + 0.5 * own_head, own_chest + own_head]), axis=1)[:, later]
    shape = _envelope(n) / (1 + np.square(np.square(own / _OWN_DEG)))
    chest, head = (shape[i] * _bounded(turn + waves[i], life.most) for i, turn in enumerate((chest, head)))
    return chest, head


def _facing(x: Array, z: Array) -> Array:
    """(2, T) x and z of the unit vector from right to left hip, from x and z (22, T) of the joints."""
    across = np.stack([x[1] - x[2], z[1] - z[2]])
    return across / np.maximum(np.sqrt(across[0] * across[0] + across[1] * across[1]), 1e-9)


def _seen(x: Array, y: Array, z: Array, facing: Array) -> Array:
    """(3, T) components of vectors to the left, upwards and ahead."""
    a, b = facing
    return np.stack([x * a + z * b, y, z * a - x * b])


def _arm(xyz: tuple[Array, Array, Array], wrist: int, facing: Array) -> Array:
    """(3, T) displacement of a wrist relative to its shoulder since the first frame, in arm lengths: left, up, ahead."""
    x, y, z = (v[wrist] - v[wrist - 4] for v in xyz)
    seen = _seen(x, y, z, facing) / _ARM_M
    return seen - seen[:, :1]


def _ahead(n: int, n_frames: int) -> NDArray[np.intp]:
    """(n,) for each frame the one `n_frames` later, but within the opening no later than its last one."""
    t, last = np.arange(n), OPENING_FRAMES - 1
    return np.minimum(np.minimum(t + n_frames, np.maximum(last + 2 * (t - last), last)), n - 1)


def _smooth(x: Array) -> Array:
    """(..., T) weighted means of five frames, with edge values repeated beyond the ends; the opening ends at its own last frame."""
    n, half = x.shape[-1], len(_SMOOTH) // 2
    t = np.arange(n)
    last = np.where(t < OPENING_FRAMES, OPENING_FRAMES - 1, n - 1)
    places = np.clip(t + np.arange(-half, half + 1)[:, None], 0, np.minimum(last, n - 1))
    return sum(w * x[..., place] for w, place in zip(_SMOOTH, places, strict=True))  # type: ignore[return-value]


def _faded(x: Array, kept: float) -> Array:
    """(..., T) leaky sums: each frame keeps the share `kept` of the sum before. scipy.signal takes half a second to import."""
    rows = [list(accumulate(row, lambda total, new: new + kept * total)) for row in x.reshape(-1, x.shape[-1]).tolist()]
    return np.array(rows).reshape(x.shape)


def _envelope(n: int) -> Array:
    """(n,) weights from 0 to 1 and back to 0."""
    rise = np.minimum(np.arange(n) / RISE_FRAMES, 1.0)
    fall = np.minimum(np.arange(n)[::-1] / FALL_FRAMES, 1.0)
    return rise * rise * (3 - 2 * rise) * (fall * fall * (3 - 2 * fall))


def _bounded(deg: Array, most: float) -> Array:
    """Angles pressed smoothly into -`most` to `most` degrees."""
    return deg / np.sqrt(1 + np.square(deg / most))


def _angle_deg(v: Array) -> Array:
    """(T,) degrees between the vector of each frame and that of the first, of vectors (3, T)."""
    a, b, c = v
    u, v, w = v[:, 0].tolist()
    cosine = (a * u + b * v + c * w) / np.maximum(np.sqrt((a * a + b * b + c * c) * (u * u + v * v + w * w)), 1e-9)
    return np.rad2deg(np.arccos(np.clip(cosine, -1.0, 1.0)))


def _face(quat: Array) -> tuple[Array, Array, Array]:
    """x, y and z of the direction that a head of orientation (4, T) faces."""
    w, x, y, z = quat
    return 2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)


def _quat(deg: Array, facing: Array) -> Array:
    """(4, T) rotations by small yaw, roll and pitch (3, T) in degrees."""
    yaw, roll, pitch = np.deg2rad(deg) / 2
    a, b = facing
    x, z = pitch * a - roll * b, pitch * b + roll * a
    return np.stack([np.ones_like(yaw), x, yaw, z]) / np.sqrt(1 + (x * x + z * z) + yaw * yaw)


def _rotated(quat: Array, a: Array, b: Array, c: Array) -> tuple[Array, Array, Array]:
    """Vectors (..., T) turned by (4, T) rotations."""
    w, x, y, z = quat
    tx, ty, tz = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
    return a + w * tx + (y * tz - z * ty), b + w * ty + (z * tx - x * tz), c + w * tz + (x * ty - y * tx)


def _product(p: Array, q: Array) -> Array:
    """(4, T) product of rotations."""
    a, b, c, d = p
    w, x, y, z = q
    return np.stack([
        a * w - b * x - (c * y + d * z), a * x + b * w + (c * z - d * y), a * y + c * w + (d * x - b * z),
        a * z + d * w + (b * y - c * x),
    ])  # fmt: skip
