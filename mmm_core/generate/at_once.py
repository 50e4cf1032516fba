"""Puts commands done at the same time into one motion: each gives the ids and the joints of its own body parts.

MMM (arXiv 2312.03596) sec. 3.4 edits the upper body with the lower one's ids as context. Here the model has three parts: left
arm, right arm, and trunk with head and legs. Head and trunk share one part, so the features of both are put together and
encoded. The decoder reads all parts, and ids of parts that were not generated together mislead it: of 96 pairs of commands
both were seen in 80, though each command by itself is seen in 99 of 100. Therefore every command's row is decoded by itself,
and the joints of its parts are taken from that motion.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from mmm_core.generate.interpretation import ReadCommand
from mmm_core.generate.motion_model import MotionModel
from mmm_core.model.tokenizer import Tokenizer
from mmm_core.model.tokens import FRAMES_PER_TOKEN
from mmm_core.model.vqvae import VqVae
from mmm_core.motion.body_parts import BodyPart, put_together
from mmm_core.motion.features import mirror
from mmm_core.motion.performing import motion_of
from mmm_core.motion.posture_features import posture_features

_HEAD_CHANNELS = slice(67 + 6 * 11, 67 + 6 * 12), slice(67 + 6 * 14, 67 + 6 * 15)
"""Feature channels of the 6-D rotations of neck and head."""
_ARMS: tuple[BodyPart, BodyPart] = ("left_arm", "right_arm")


@dataclass(frozen=True)
class StepIds:
    """The ids of commands done at the same time.

    Attributes:
        ids: (L, C) ids in which every command has its own parts.
        rows: (L, C) ids of each command by itself; empty for a single command.
        owners: index of the command that moves a body part.
    """

    ids: Tensor
    rows: tuple[Tensor, ...] = ()
    owners: dict[BodyPart, int] = field(default_factory=dict)


def mirrored_ids(engine: MotionModel, ids: Tensor) -> Tensor:
    """(L, C) ids of the mirrored motion: decoded, mirrored and encoded again."""
    features = torch.from_numpy(mirror(engine.model.tokenizer.decode(ids[None])[0].numpy()))
    return engine.model.tokenizer.encode(features[None])[0]


def composed(
    engine: MotionModel, commands: Sequence[ReadCommand], rows: Sequence[Tensor],
    arms: Sequence[tuple[BodyPart, ...]] | None = None,
) -> StepIds:  # fmt: skip
    """The ids of commands in which every command has its own body parts; arms that no command has go to the first.

    Args:
        engine: the model.
        commands: done at once; each with its limbs.
        rows: the commands' ids (L, C); a shorter row is lengthened by repeating its last id.
        arms: the arms of each command; None finds them (`arms_of`).
    """
    if len(rows) == 1:
        return StepIds(rows[0])
    longest = max(len(row) for row in rows)
    rows = tuple(torch.cat([row, row[-1:].repeat(longest - len(row), 1)]) for row in rows)
    owners: dict[BodyPart, int] = dict.fromkeys(_ARMS, 0)
    for k, mine in enumerate(arms_of(engine, commands, rows) if arms is None else arms):
        owners |= dict.fromkeys(mine, k)
    moved = {limb: k for k, c in reversed(list(enumerate(commands))) for limb in c.limbs}
    owners["trunk"] = moved.get("trunk", moved.get("head", 0))
    owners["head"] = moved.get("head", owners["trunk"])
    names = engine.model.tokenizer.part_names
    ids = rows[0].clone()
    for arm in _ARMS:
        ids[:, names.index(arm)] = rows[owners[arm]][:, names.index(arm)]
    ids[:, names.index("rest")] = _rest(engine, rows[owners["head"]], rows[owners["trunk"]])
    return StepIds(ids, rows, owners)


def arms_of(engine: MotionModel, commands: Sequence[ReadCommand], rows: Sequence[Tensor]) -> list[tuple[BodyPart, ...]]:
    """The arms of each command: the ones that its words name, else the ones that its motion moves and no other command has."""
    named: list[tuple[BodyPart, ...]] = [tuple(arm for arm in _ARMS if arm in c.limbs) for c in commands]
    free: list[BodyPart] = [arm for arm in _ARMS if not any(arm in arms for arms in named)]
    found: list[tuple[BodyPart, ...]] = []
    for command, arms, row in zip(commands, named, rows, strict=True):
        if "some_arm" in command.limbs and free:
            motion = motion_of(engine.model.tokenizer.decode(row[None])[0].numpy())
            moved = posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad).arms
            mine: tuple[BodyPart, ...] = tuple(arm for arm in free if arm.startswith(moved) or moved == "both") or (
                free[0],
            )
            free = [arm for arm in free if arm not in mine]
            found.append(mine)
        else:
            found.append(arms)
    return found


def features_of(tokenizer: Tokenizer | VqVae, ids: Tensor, steps: Sequence[tuple[int, StepIds]]) -> NDArray[np.float32]:
    """(T, 263) features of ids (L, C); body parts of commands done at once are decoded from each command's own ids.

    Args:
        tokenizer: decodes the ids.
        ids: of the whole motion, which contains every step.
        steps: the steps, each with the token at which it begins.
    """
    several = [(first, step) for first, step in steps if step.rows]
    if len(several) == len(steps) == 1 and len(ids) == len(several[0][1].ids):  # every joint has an owner
        step = several[0][1]
        own = tokenizer.decode(torch.stack(step.rows)).numpy()
        whole = own[step.owners["trunk"]]
        return put_together(whole, {part: own[k] for part, k in step.owners.items()}, 0, len(whole))
    rows = [ids]
    for k in range(max((len(step.rows) for _, step in several), default=0)):
        alone = ids.clone()
        for first, step in several:
            alone[first : first + len(step.ids)] = step.rows[min(k, len(step.rows) - 1)]
        rows.append(alone)
    whole, *own = tokenizer.decode(torch.stack(rows)).numpy()
    for first, step in several:
        start, end = first * FRAMES_PER_TOKEN, (first + len(step.ids)) * FRAMES_PER_TOKEN
        whole = put_together(whole, {part: own[k] for part, k in step.owners.items()}, start, end)
    return whole


def _rest(engine: MotionModel, head: Tensor, trunk: Tensor) -> Tensor:
    """(L,) ids of trunk, head and legs, given the rows (L, C) of the command for the head and of the one for the trunk."""
    place = engine.model.tokenizer.part_names.index("rest")
    if head is trunk:
        return trunk[:, place]
    looks, leans = engine.model.tokenizer.decode(torch.stack([head, trunk]))
    for channels in _HEAD_CHANNELS:
        leans[:, channels] = looks[:, channels]
    return engine.model.tokenizer.encode(leans[None])[0][:, place]
