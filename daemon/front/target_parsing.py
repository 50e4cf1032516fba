"""Reads frames of the `stream` socket as checked targets; bad frames are counted, reported now and then, and move nothing."""

from __future__ import annotations

import hmac
from collections import Counter

import numpy as np
from numpy.typing import NDArray

from daemon.wire.codec import WireError, decode_target, only_frame
from daemon.wire.requests import Target
from retarget.robot.robot import RobotModel

Array = NDArray[np.float64]
NAMED_EVERY_S = 1.0
"""Seconds between two reports of the same kind of bad message; a report counts the messages since the last."""
FARTHEST_RAD = 1000.0
"""Radians that no joint of any robot reaches: a larger number is in another unit, or meaningless."""


class TargetParser:
    """Reads targets for one robot.

    Attributes:
        bad: number of bad messages so far, by code.
    """

    def __init__(self, robot: RobotModel) -> None:
        self._names = robot.joint_names
        self._index = {name: j for j, name in enumerate(robot.joint_names)}
        self.bad: Counter[str] = Counter()
        self._told: dict[str, tuple[float, int]] = {}

    def read(self, parts: list[bytes], lease_id: str, holder: str, secret: str) -> Array:
        """The target (J,) of a message, radians; NaN for joints that it does not name.

        Args:
            parts: frames of the message.
            lease_id: id of the lease that is held; empty for none.
            holder: its holder, in words.
            secret: secret that a target of its holder carries.

        Raises:
            WireError: the message is no target of this lease.
        """
        try:
            target = decode_target(only_frame(parts))
            self._check_lease(target, lease_id, holder, secret)
            return self._angles(target)
        except WireError as error:
            self.bad[error.code] += 1
            raise

    def due(self, code: str, now_s: float) -> int:
        """Number of messages of a kind to report now; 0 when the last report was less than `NAMED_EVERY_S` ago."""
        told_s, told = self._told.get(code, (float("-inf"), 0))
        if now_s - told_s < NAMED_EVERY_S:
            return 0
        self._told[code] = (now_s, self.bad[code])
        return self.bad[code] - told

    def _check_lease(self, target: Target, lease_id: str, holder: str, secret: str) -> None:
        if lease_id and target.id == lease_id:
            if hmac.compare_digest(target.secret.encode(), secret.encode()):
                return
            raise WireError(
                "wrong_secret", "target", f"another secret than that of the lease, which {holder} holds",
                "the `secret` of the `lease` request", "show the secret, or wait until the lease has ended",
            )  # fmt: skip
        found = f"id {target.id[:40]!r}; " + (
            f"{holder} holds lease {lease_id!r}" if lease_id else "nobody holds a lease"
        )
        raise WireError(
            "no_lease", "target", found, "the id of the lease that is held", "ask `cmd` for a `lease` first"
        )

    def _angles(self, target: Target) -> Array:
        n = len(self._names)
        if isinstance(target.q_rad, dict):
            unknown = [name for name in target.q_rad if name not in self._index]
            if unknown or not target.q_rad:
                found = f"joint {', '.join(name[:40] for name in unknown[:3])}" if unknown else "no joint"
                raise self._error("unknown_joint", target, found, f"some of {', '.join(self._names)}")
            q_rad = np.full(n, np.nan)
            values = np.array(list(target.q_rad.values()))
            q_rad[[self._index[name] for name in target.q_rad]] = values
        else:
            if len(target.q_rad) != n:
                raise self._error("wrong_number", target, f"{len(target.q_rad)} angles", f"{n}, or angles by name")
            q_rad = values = np.array(target.q_rad)
        if not np.isfinite(values).all() or (np.abs(values) > FARTHEST_RAD).any():
            bad = values[~(np.abs(values) <= FARTHEST_RAD)][0]
            raise self._error("not_finite", target, f"{bad}", f"finite radians within {FARTHEST_RAD:g}")
        return q_rad

    def _error(self, code: str, target: Target, found: str, allowed: str) -> WireError:
        return WireError(code, "target", found, allowed, "see `capabilities` for the robot's joints", target.id)
