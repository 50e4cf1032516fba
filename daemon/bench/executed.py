"""Motions as executed: their path through the daemon's control loop to simulated servos under load.

The control loop, gate, servo bus and codec are those of a run, in virtual time; behind them are servos with their own profiles,
loops and limits of torque, and the robot's body in MuJoCo with gravity, inertia, friction and contact. The measured positions that
the servos report are judged.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daemon.bench.audit_rig import AuditRig
from daemon.bench.motions import cut, glued
from mmm_core.corpus.heldout import PROBE_SETS
from mmm_core.evaluation.probes import judge
from mmm_core.motion.motion import Motion
from mmm_core.motion.posture_features import posture_features
from retarget.path.paths import JointPath
from retarget.pipeline import Retargeter
from retarget.robot.ticks import JointServoMap
from retarget.robot_to_human import as_motion
from sim.faults import Fault

Array = NDArray[np.float64]
_WAY_FRAMES = 30
"""Frames of standing in a motion's first pose before the motion, so that the robot reaches the pose at its own speed."""
_THERE_RAD = 0.02
"""Radians within which a robot counts as standing where a path begins or ends."""
_AFTER_S = 0.4
"""Seconds for which the end of a path is held, so that lagging servos come to rest."""
_LONGEST_LAG_S = 0.4
_MOVED_RAD = 0.05
"""Radians of travel below which no lag of a joint is computed."""
_ROUNDING_RAD = 1e-9
_SHORT = 0.98
"""Share of the commanded travel below which a joint is reported."""


@dataclass(frozen=True)
class Tracking:
    """Tracking of one path by the joints.

    Attributes:
        error_rad: (N, J) goal less measured position in each bus cycle.
        lag_s: (J,) delay that explains most of the error, NaN for joints that hardly moved.
        way: (J,) range measured as a share of the range commanded, NaN likewise.
        gated: bus cycles in which the daemon's gate changed a setpoint.
        longer_s: seconds that the robot took longer than its path, because something slowed it down.
    """

    error_rad: Array
    lag_s: Array
    way: Array
    gated: int
    longer_s: float


class Executed:
    """A simulated robot that plays one motion after another."""

    def __init__(self, retargeter: Retargeter, body: str = "mujoco", faults: tuple[Fault, ...] = ()) -> None:
        """Arm a simulated robot.

        Args:
            retargeter: the robot and its retargeting settings.
            body: body behind the servos, "plain" or "mujoco".
            faults: faults of servos and wire.
        """
        self._retargeter, self._map = retargeter, JointServoMap(retargeter.robot)
        self._rig = AuditRig(retargeter.robot, faults, body=body)
        self._rig.make_ready()
        self._rate_hz = retargeter.robot.bus.rate_hz
        self._faults: Counter[str] = Counter()
        self._tracking: list[Tracking] = []
        self._commanded: Counter[str] = Counter()
        self._kept: Counter[str] = Counter()
        self._probes = {p.text: p for probes in PROBE_SETS.values() for p in probes}

    def perform(self, motion: Motion) -> tuple[Motion, Motion]:
        """The commanded motion of the retargeted path and the measured motion, both as poses of a person."""
        first = cut(motion, 0, 1)
        begin = self._retargeter.retarget(first).q_rad[0]
        if np.abs(begin - self._rig.state().position_rad).max() > _THERE_RAD:
            self._play(self._retargeter.retarget(glued([first], _WAY_FRAMES), self._rig.state()))
        path = self._retargeter.retarget(motion, self._rig.state())
        cycles = self._play(path)
        measured = self._map.tick_to_rad(cycles["present_tick"])
        longer_s = (len(cycles) - len(path.at_rate(self._rate_hz))) / self._rate_hz - _AFTER_S
        self._tracking.append(tracking(cycles, measured, 1 / self._rate_hz, longer_s))
        kinematics, every = self._retargeter.kinematics, self._rate_hz / path.rate_hz
        at = np.arange(1, int(len(measured) / every) + 1) * every - 1
        low = np.minimum(at.astype(np.int64), len(measured) - 2)
        share = (at - low)[:, None]
        shown = measured[low] * (1 - share) + measured[low + 1] * share
        return (
            as_motion(kinematics, path.q_rad, path.rate_hz, motion),
            as_motion(kinematics, shown, path.rate_hz, motion),
        )

    def _play(self, path: JointPath) -> NDArray[np.void]:
        """The bus cycles of a path; a fault is recorded and repaired."""
        cycles = self._rig.recorded(path.at_rate(self._rate_hz), _AFTER_S)
        if self._rig.fault:
            self._faults[self._rig.fault] += 1
            self._rig.make_ready()
        return cycles

    def shown(self, motion: Motion) -> Motion:
        """The measured motion; whether it keeps the verdicts that its text's probe gives the path is counted."""
        if not len(motion.joints_m):
            return motion
        commanded, measured = self.perform(motion)
        probe = self._probes[motion.text]
        told, done = (
            judge(probe, posture_features(m.joints_m, m.head_quat_wxyz, m.forearm_twist_rad), with_pose=True)
            for m in (commanded, measured)
        )
        self._commanded.update(key for key, ok in told.items() if ok)
        self._kept.update(key for key, ok in told.items() if ok and done[key])
        return measured

    def figures(self) -> dict[str, Any]:
        """Share of the paths' expectations that the robot keeps (`kept`), faults, tracking, joints that fall short, the audit."""
        audit = self._rig.finish()
        total = sum(self._commanded.values())
        return {
            "kept": round(sum(self._kept.values()) / total, 4) if total else None,
            "kept_by_expectation": {k: round(self._kept[k] / n, 4) for k, n in sorted(self._commanded.items())},
            "faults": dict(self._faults.most_common()),
            **summary(self._tracking, self._retargeter.robot.joint_names),
            **{key: audit[key] for key in ("violations", "self_contacts", "measured_contacts", "repairs")},
        }


def tracking(cycles: NDArray[np.void], measured_rad: Array, period_s: float, longer_s: float = 0.0) -> Tracking:
    """Figures of how positions (N, J), measured in N bus cycles, follow the goals of those cycles."""
    goal_rad: Array = cycles["goal_rad"]
    error, setpoint = goal_rad - measured_rad, cycles["setpoint_rad"]
    J, most = goal_rad.shape[1], round(_LONGEST_LAG_S / period_s)
    lag, way = np.full(J, np.nan), np.full(J, np.nan)
    for j in np.flatnonzero(np.ptp(goal_rad, axis=0) > _MOVED_RAD):
        goal, found = goal_rad[:, j], measured_rad[:, j]
        off = [float(((found[k:] - goal[: len(goal) - k]) ** 2).mean()) for k in range(min(most, len(goal) // 2))]
        lag[j] = int(np.argmin(off)) * period_s
        way[j] = np.ptp(found) / np.ptp(goal)
    gated = (np.abs(goal_rad - setpoint) > _ROUNDING_RAD).any(1) & (cycles["plan_id"] > 0)
    return Tracking(error, lag, way, int(gated.sum()), longer_s)


def summary(of: list[Tracking], names: tuple[str, ...]) -> Mapping[str, Any]:
    """Tracking error, lag and travel of all paths: over all joints, and of the worst joints."""
    if not of:
        return {}
    error = np.rad2deg(np.concatenate([t.error_rad for t in of]))
    lag_ms, way = 1e3 * np.array([t.lag_s for t in of]), np.array([t.way for t in of])
    rms = np.sqrt((error**2).mean(0))
    moved = ~np.isnan(lag_ms).all(0)
    lags = {names[j]: round(float(np.nanmedian(lag_ms[:, j])), 1) for j in np.flatnonzero(moved)}
    ways = {names[j]: round(float(np.nanmedian(way[:, j])), 3) for j in np.flatnonzero(moved)}
    return {
        "tracking_rms_deg": round(float(np.sqrt((error**2).mean())), 3),
        "tracking_p95_deg": round(float(np.percentile(np.abs(error), 95)), 3),
        "tracking_max_deg": round(float(np.abs(error).max()), 2),
        "gated_cycles": sum(t.gated for t in of),
        "longer_s": round(sum(t.longer_s for t in of), 2),
        "lag_ms": round(float(np.nanmedian(lag_ms)), 1),
        "joint_rms_deg": {name: round(float(r), 3) for name, r in zip(names, rms, strict=True)},
        "joint_lag_ms": lags,
        "joints_that_fall_short": {name: share for name, share in ways.items() if share < _SHORT},
    }
