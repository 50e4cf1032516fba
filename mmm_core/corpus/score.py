"""A gesture as a score, in which each channel of the upper body moves between key poses along minimum-jerk paths.

Channels: `left` and `right` arm (upper arm direction, forearm direction, forearm twist), `head` and `trunk` (yaw, pitch,
roll), `shrug`. Directions are given in the chest frame as (outward, up, forward), so that one pose serves both arms.
Directions of bones move on the sphere: along the great circle over short distances, past a via point in front of the body or
beside it over long ones, so that an arm raised from hanging swings through an arc. Minimum jerk: Flash and Hogan 1985.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from mmm_core.corpus.beat import Calm
from mmm_core.motion.skeleton import Array, normalise

Vector = tuple[float, float, float]
FRONT: Vector = (0.45, 0.0, 0.9)
SIDE: Vector = (1.0, 0.0, 0.15)
_FORE_VIA = np.array([0.12, 0.05, 1.0])
"""Via point of a forearm that turns far: folded forward, clear of the chest."""
_NEAR_RAD, _FAR_RAD = np.deg2rad(75.0), np.deg2rad(150.0)
"""Radians of a turn up to which it follows the great circle, and from which on it is bent fully towards the via point."""
TRACE_STEP_S = 0.05
"""Seconds between key poses on a traced path."""
TRACE_EASE_BEATS = 2
"""Beats that starting and ending a path take together."""
At = tuple[NDArray[np.intp], Array]
"""Index of the segment (T,), and progress in it from 0 to 1 (T,)."""


@dataclass(frozen=True)
class ArmPose:
    """Directions (outward, up, forward) of upper arm and forearm, and the forearm's twist in radians (palm up positive)."""

    upper: Vector
    fore: Vector
    twist_rad: float = 0.0

    def vector(self) -> Array:
        """(7,) channel value: unit directions and the twist."""
        out = np.empty(7)
        for at, v in ((0, self.upper), (3, self.fore)):
            length = max((v[0] ** 2 + v[1] ** 2 + v[2] ** 2) ** 0.5, 1e-9)
            out[at], out[at + 1], out[at + 2] = v[0] / length, v[1] / length, v[2] / length
        out[6] = self.twist_rad
        return out


REST_ARM = ArmPose((0.2, -0.97, 0.02), (0.1, -0.93, 0.3))


@dataclass(frozen=True)
class Segment:
    """A channel's movement from one value to the next: at an even pace if `is_steady`, else starting and stopping gently."""

    start_s: float
    end_s: float
    start: Array
    end: Array
    via: Vector = FRONT
    is_steady: bool = False


@dataclass
class Score:
    """Movements of all channels over time; `move`, `trace` and `hold` append to them.

    Attributes:
        rng: randomness of poses, strokes and paces; a score with a beat has none (`beat.Calm`).
        rest: value of each channel at rest.
        time_s: seconds at which the next movement begins.
        follow_through: share of a movement by which a stopping limb runs past its end before it settles.
        beat_s: seconds of a beat; 0 for a score without one. With a beat each movement and pause lasts a whole number of half
            beats, and strokes begin on a beat.
        otherwise: with a beat, whether the second of two variants of a gesture is performed.
        ways: movements of each channel.
        chance: randomness of pauses, with a beat, too.
        strokes_s: with a beat, seconds at which strokes begin.
        is_traced: whether a path was traced.
    """

    rng: np.random.Generator
    rest: dict[str, Array]
    time_s: float = 0.0
    follow_through: float = 0.0
    beat_s: float = 0.0
    otherwise: bool = False
    ways: dict[str, list[Segment]] = field(default_factory=dict)
    chance: np.random.Generator = field(init=False)
    strokes_s: list[float] = field(default_factory=list)
    is_traced: bool = False

    def __post_init__(self) -> None:
        """Start every channel at rest."""
        self.chance = self.rng
        if self.beat_s:
            self.rng = Calm(self.rng, self.otherwise)
        for name, value in self.rest.items():
            self.start_at(name, value)

    def start_at(self, channel: str, value: Array) -> None:
        """Let `channel` begin the clip at `value`, without the movements that it had."""
        self.ways[channel] = [Segment(-1.0, -1.0, value, value)]

    def now(self, channel: str) -> Array:
        """The value that `channel` holds at the current time."""
        return self.ways[channel][-1].end

    def move(
        self, duration_s: float, via: Vector = FRONT, /, **targets: Array | ArmPose | Vector | float | list[float]
    ) -> None:
        """Move the named channels to their targets while others hold, and advance the time. Long movements of arms pass `via`."""
        if self.beat_s:
            duration_s = max(self.beat_s, self._in_half_beats(duration_s))
        for name, target in targets.items():
            value = target.vector() if isinstance(target, ArmPose) else np.atleast_1d(np.asarray(target, float))
            end_s = self.time_s + duration_s
            self.ways[name].append(Segment(self.time_s, end_s, self.now(name), value, via))
        self.time_s += duration_s

    def trace(self, duration_s: float, **paths: Callable[[float], ArmPose | Array]) -> None:
        """Move the named channels along paths of a phase from 0 to 1, with gentle start and end, and advance the time.

        A path should start at the present value of its channel. With a beat the movement takes `TRACE_EASE_BEATS` longer, so that
        the part between start and end has the pace of `duration_s`.
        """
        ease = min(0.3, 0.35 / duration_s)
        self.is_traced = True
        if self.beat_s:
            self.strokes_s.append(self.time_s)
            gently_s = TRACE_EASE_BEATS * self.beat_s
            duration_s = duration_s + gently_s
            ease = gently_s / duration_s
        n = max(4, int(np.ceil(duration_s / TRACE_STEP_S - 1e-6)))
        u = np.linspace(0, 1, n + 1)[1:]
        phase = _trapezoid(u, ease)
        for name, path in paths.items():
            for i in range(n):
                target = path(float(phase[i]))
                value = target.vector() if isinstance(target, ArmPose) else target
                start_s = self.time_s + duration_s * i / n
                self.ways[name].append(
                    Segment(start_s, start_s + duration_s / n, self.now(name), value, is_steady=True)
                )
        self.time_s += duration_s

    def hold(self, duration_s: float) -> None:
        """Let all channels hold, and advance the time."""
        self.time_s += self._in_half_beats(duration_s) if self.beat_s else duration_s

    def pause_s(self, least_s: float, most_s: float) -> float:
        """Random seconds of a pause; with a beat a whole number of beats."""
        if not self.beat_s:
            return float(self.rng.uniform(least_s, most_s))
        drawn = self.chance.uniform(least_s, most_s)
        return self.beat_s * max(1, round(drawn / self.beat_s))

    def to_beat(self) -> None:
        """With a beat, advance the time to the next one and note that a stroke begins there."""
        if self.beat_s:
            self.time_s = self.beat_s * float(np.ceil(self.time_s / self.beat_s - 1e-6))
            self.strokes_s.append(self.time_s)

    def _in_half_beats(self, duration_s: float) -> float:
        return self.beat_s / 2 * float(np.floor(2 * duration_s / self.beat_s + 0.5))

    def relax(self, duration_s: float) -> None:
        """Move every channel back to rest."""
        away = {name: self.rest[name] for name in self.ways if np.abs(self.now(name) - self.rest[name]).max() > 1e-3}
        self.move(duration_s, **away)

    def sample(self, channel: str, times_s: Array, fore_lag_s: float = 0.0) -> Array:
        """(T, D) values of `channel`; forearm and twist of an arm lag `fore_lag_s` behind the upper arm."""
        ways = self.ways[channel]
        if channel not in ("left", "right"):
            return self._between(ways, times_s)[0]
        values, upper = self._between(ways, times_s)
        later, fore = self._between(ways, times_s - fore_lag_s) if fore_lag_s else (values, upper)
        values[:, :3] = _on_sphere(ways, upper, slice(0, 3), np.array([w.via for w in ways]))
        values[:, 3:6] = _on_sphere(ways, fore, slice(3, 6), np.broadcast_to(_FORE_VIA, (len(ways), 3)))
        values[:, 6] = later[:, 6]
        return values

    def _between(self, ways: list[Segment], times_s: Array) -> tuple[Array, At]:
        """Values interpolated on straight lines, and the segment (T,) and progress in it (T,) of each time."""
        start_s = np.array([w.start_s for w in ways])
        end_s = np.array([w.end_s for w in ways])
        row = np.searchsorted(start_s, times_s, side="right") - 1
        u = np.clip((times_s - start_s[row]) / np.maximum(end_s - start_s, 1e-6)[row], 0, 1)
        share = np.where(np.array([w.is_steady for w in ways])[row], u, minimum_jerk(u))
        if self.follow_through:
            until_s = np.append(start_s[1:], np.inf)
            settle_s = np.minimum(0.4, until_s - end_s)
            bumps = (settle_s > 0.2) & ~np.array([w.is_steady for w in ways])
            x = np.clip((times_s - end_s[row]) / np.maximum(settle_s, 1e-6)[row], 0, 1)
            share = share + np.where(bumps[row], self.follow_through * 16 * np.square(x * (1 - x)), 0.0)
        starts, ends = np.array([w.start for w in ways]), np.array([w.end for w in ways])
        return starts[row] + (ends - starts)[row] * share[:, None], (row, share)


def minimum_jerk(u: Array) -> Array:
    """Share of the distance at share `u` of the time, on a path of minimum jerk."""
    return u**3 * (10 - 15 * u + 6 * u**2)


def _trapezoid(u: Array, ease: float) -> Array:
    """Share of the distance at share `u` of the time; speed rises over `ease` of the time, is constant, and falls likewise."""
    speed_up = np.minimum(u, ease) ** 2 / (2 * ease)
    even = np.clip(u - ease, 0, 1 - 2 * ease)
    slow = np.clip(u - (1 - ease), 0, ease)
    return (speed_up + even + slow - slow**2 / (2 * ease)) / (1 - ease)


def _on_sphere(ways: list[Segment], at: At, part: slice, via: Array) -> Array:
    """(T, 3) unit directions on a quadratic curve on the sphere, with one control point for each segment."""
    row, share = at
    a = np.array([w.start[part] for w in ways])
    b = np.array([w.end[part] for w in ways])
    angle = np.arccos(np.clip((a * b).sum(-1), -1, 1))
    bend = np.clip((angle - _NEAR_RAD) / (_FAR_RAD - _NEAR_RAD), 0, 1)[:, None]
    control = normalise((1 - bend) * normalise(a + b) + bend * via)
    s = share[:, None]
    a, b, control = a[row], b[row], control[row]
    return _slerp(_slerp(a, control, s), _slerp(control, b, s), s)


def _slerp(a: Array, b: Array, s: Array) -> Array:
    """(T, 3) directions at share `s` of the great circles between unit vectors (T, 3)."""
    angle = np.maximum(np.arccos(np.clip((a * b).sum(-1, keepdims=True), -1, 1)), 1e-4)
    return (np.sin((1 - s) * angle) * a + np.sin(s * angle) * b) / np.sin(angle)
