"""E-stops given while the daemon is disturbed: how many are lost, and the time from the request to torque off of all servos."""

from __future__ import annotations

import sys
import tempfile
import time
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from daemon.bench.daemon_rig import percentile
from daemon.bench.disturbances import DISTURBANCES, Disturbance
from daemon.bench.estop_rig import Button, EstopRig
from daemon.bench.tty_servos import pty_workers_first

STAYS_OFF_S = 0.1
"""Seconds without torque after which torque counts as off, once the e-stop is reported as carried out."""
_LOOK_S = 0.0005


@dataclass(frozen=True)
class Outcome:
    """The outcome of one e-stop.

    Attributes:
        lost: whether a servo still had torque at the bound.
        told: whether the daemon had reported by the bound that the e-stop was carried out.
        off_s: seconds from the request to torque off of all servos; 0 where none had torque, the bound where the e-stop was lost.
        back_s: seconds from the first bytes that servos received after the disturbance to torque off of all servos, if these came
            after the request; None where the bus process was not away, or no servo had torque.
    """

    lost: bool
    told: bool
    off_s: float
    back_s: float | None


def measure_disturbed(
    n: int, seed: int, robot: str, names: Sequence[str] = tuple(DISTURBANCES)
) -> tuple[dict[str, dict[str, Any]], int]:
    """Figures of each disturbance, and the number of violations that the servos' audit found in all of them.

    Args:
        n: e-stops for each disturbance.
        seed: seed of the instants.
        robot: name of the robot.
        names: names among `DISTURBANCES`.
    """
    figures: dict[str, dict[str, Any]] = {}
    with tempfile.TemporaryDirectory() as folder, EstopRig(robot, Path(folder)) as rig:
        for name in names:
            rng = np.random.default_rng((seed, zlib.crc32(name.encode())))
            outcomes: list[Outcome] = []
            for i in range(n):
                outcomes.append(give_one(rig, DISTURBANCES[name], rng))
                _tell(rig, f"{name} {i + 1}/{n}", outcomes[-1])
            figures[name] = summary(outcomes, DISTURBANCES[name])
        violations = rig.servos.bus.audit.report()["violations"]
    return figures, violations


def give_one(rig: EstopRig, disturbance: Disturbance, rng: np.random.Generator) -> Outcome:
    """Lead the robot to the state, disturb the daemon, give an e-stop and watch the servos."""
    rig.bring_to(disturbance.state)
    with Button(rig.endpoints.ctl, has_fifo=rig.has_fifo) as button:
        if not disturbance.newcomer:
            button.connect()
        with disturbance.act(rig, rng), pty_workers_first():
            asked_s = time.monotonic()
            if disturbance.newcomer:
                button.connect()
            button.press()
            return _watched(rig, button, asked_s, disturbance)


def summary(outcomes: Sequence[Outcome], disturbance: Disturbance) -> dict[str, Any]:
    """`lost` and `untold` of `n`, and the times of the other e-stops in milliseconds."""
    kept = [one for one in outcomes if not one.lost]
    figures: dict[str, Any] = {
        "lost": len(outcomes) - len(kept),
        "untold": sum(not one.told for one in outcomes),
        "n": len(outcomes),
        "bound_s": disturbance.bound_s,
        **_percentiles([one.off_s for one in kept]),
    }
    if disturbance.bus_away:
        figures["from_back"] = _percentiles([one.back_s for one in kept if one.back_s is not None])
    return figures


def _watched(rig: EstopRig, button: Button, asked_s: float, disturbance: Disturbance) -> Outcome:
    off_s, was_on, told = asked_s, False, False
    while (now_s := time.monotonic()) < asked_s + disturbance.bound_s:
        told = told or button.told()
        on = rig.servos.torque
        if on or was_on:
            off_s = time.monotonic()
        was_on = on
        if not on and told and now_s - off_s > STAYS_OFF_S:
            break
        time.sleep(_LOOK_S)
    lost, back_s = rig.servos.torque, rig.servos.bus.first_bytes_s
    if not disturbance.bus_away or back_s is None or lost or off_s == asked_s:
        return Outcome(lost, told, off_s - asked_s, None)
    return Outcome(lost, told, off_s - asked_s, max(0.0, off_s - max(back_s, asked_s)))


def _percentiles(seconds: Sequence[float]) -> dict[str, float | None]:
    times_ms = [1e3 * one for one in seconds]
    return {
        "p50_ms": percentile(times_ms, 50),
        "p99_ms": percentile(times_ms, 99),
        "worst_ms": percentile(times_ms, 100),
    }


def _tell(rig: EstopRig, trial: str, outcome: Outcome) -> None:
    """Print progress on stderr, and the daemon's log where an e-stop was lost or not reported as carried out."""
    back = "" if outcome.back_s is None else f", {1e3 * outcome.back_s:.1f} ms from the bus process's return"
    told = "" if outcome.told else ", not told as carried out"
    sys.stderr.write(f"{trial}: {'LOST' if outcome.lost else f'{1e3 * outcome.off_s:.1f} ms'}{back}{told}\n")
    if outcome.lost or not outcome.told:
        sys.stderr.write(f"the daemon's log ends with:\n{rig.said}\n")
    sys.stderr.flush()
