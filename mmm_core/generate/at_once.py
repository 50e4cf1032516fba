"""Commands done at the same time: each fills the ids of its own body parts.

MMM (arXiv 2312.03596) sec. 3.4 edits the upper body with the lower one's ids as context; here the model has three parts: either
arm, and trunk with head and legs. Head and trunk share one part, so the features of both are put together and encoded.
"""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor

from mmm_core.generate.interpretation import ReadCommand
from mmm_core.generate.motion_model import MotionModel
from mmm_core.motion.features import mirror
from mmm_core.motion.performing import motion_of
from mmm_core.motion.posture_features import posture_features

_HEAD_CHANNELS = slice(67 + 6 * 11, 67 + 6 * 12), slice(67 + 6 * 14, 67 + 6 * 15)
"""6-D rotations of neck and head."""
_ARMS = ("left_arm", "right_arm")
OTHER = {"left_arm": "right_arm", "right_arm": "left_arm"}


def mirrored_ids(engine: MotionModel, ids: Tensor) -> Tensor:
    """(L, C) ids of the mirrored motion: decoded, mirrored and encoded again."""
    features = torch.from_numpy(mirror(engine.model.tokenizer.decode(ids[None])[0].numpy()))
    return engine.model.tokenizer.encode(features[None])[0]


def composed(
    engine: MotionModel, commands: Sequence[ReadCommand], rows: Sequence[Tensor],
    arms: Sequence[tuple[str, ...]] | None = None,
) -> Tensor:  # fmt: skip
    """(L, C) ids in which every command has its own parts; the first has what is left.

    Args:
        engine: the model.
        commands: done at once; each with its limbs.
        rows: their ids (L, C); a shorter one stays at its end.
        arms: the arms of each command; None finds them (`arms_of`).
    """
    names = engine.model.tokenizer.part_names
    longest = max(len(row) for row in rows)
    rows = [torch.cat([row, row[-1:].repeat(longest - len(row), 1)]) for row in rows]
    ids = rows[0].clone()
    taken = arms_of(engine, commands, rows) if arms is None else arms
    for row, mine in zip(rows, taken, strict=True):
        for arm in mine:
            ids[:, names.index(arm)] = row[:, names.index(arm)]
    rest = _rest(engine, commands, rows)
    if rest is not None:
        ids[:, names.index("rest")] = rest
    return ids


def arms_of(engine: MotionModel, commands: Sequence[ReadCommand], rows: Sequence[Tensor]) -> list[tuple[str, ...]]:
    """The arms that each command has: those its words name, else those that its motion moves and no other has."""
    named = [tuple(arm for arm in _ARMS if arm in c.limbs) for c in commands]
    free = [arm for arm in _ARMS if not any(arm in arms for arms in named)]
    found: list[tuple[str, ...]] = []
    for command, arms, row in zip(commands, named, rows, strict=True):
        if "some_arm" in command.limbs and free:
            motion = motion_of(engine.model.tokenizer.decode(row[None])[0].numpy())
            moved = posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad).arms
            mine = tuple(arm for arm in free if arm.startswith(moved) or moved == "both") or (free[0],)
            free = [arm for arm in free if arm not in mine]
            found.append(mine)
        else:
            found.append(arms)
    return found


def _rest(engine: MotionModel, commands: Sequence[ReadCommand], rows: Sequence[Tensor]) -> Tensor | None:
    """(L,) ids of trunk, head and legs; None where no command moves trunk or head."""
    place = engine.model.tokenizer.part_names.index("rest")
    head = next((row for c, row in zip(commands, rows, strict=True) if "head" in c.limbs), None)
    trunk = next((row for c, row in zip(commands, rows, strict=True) if "trunk" in c.limbs), None)
    if head is None or trunk is None:
        mine = head if trunk is None else trunk
        return None if mine is None else mine[:, place]
    looks, leans = (engine.model.tokenizer.decode(row[None])[0] for row in (head, trunk))
    for channels in _HEAD_CHANNELS:
        leans[:, channels] = looks[:, channels]
    return engine.model.tokenizer.encode(leans[None])[0][:, place]
