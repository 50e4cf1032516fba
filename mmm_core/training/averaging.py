"""Averages the weights of several models, each trained on other clips; the mean costs the time and size of one model.

The weights of models trained further from one start are so similar that their mean is a working model too, often a better one
than each by itself (Wortsman et al. 2022, "Model soups", the uniform soup).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import torch
from torch import Tensor, nn

from mmm_core.errors import CheckpointError
from mmm_core.inference.checkpoint import Model, file_hash, load_model, save_model

LEARNT = ("transformer", "length")
"""Modules whose weights are averaged; tokenizer, text tower and scope are the first model's."""


def average_models(paths: Sequence[Path], out: Path) -> None:
    """Write the mean of the checkpoints at `paths` to `out`.

    Raises:
        CheckpointError: a checkpoint cannot be read, or differs from the first one in sizes, modules or tokenizer (its ids
            would mean other motions).
    """
    mean, *others = (load_model(path) for path in paths)
    for path, other in zip(paths[1:], others, strict=True):
        _check_same_kind(paths[0], mean, path, other)
    models = [mean, *others]
    for part in LEARNT:
        if (module := mean.modules.get(part)) is not None:
            module.load_state_dict(_mean([m.modules[part].state_dict() for m in models]))
    mean.provenance = {
        "average_of": _told_once([(file_hash(path), m.provenance) for path, m in zip(paths, models, strict=True)]),
        "data": "; ".join(dict.fromkeys(str(m.provenance.get("data", "not stated")) for m in models)),
    }
    save_model(out, mean, half=mean.text is None)


def _told_once(models: Sequence[tuple[str, Mapping[str, object]]]) -> list[dict[str, object]]:
    """Each model's hash and provenance; a provenance that is already listed, for the same model or as a start, is left out."""
    told: set[object] = set()
    for _, provenance in models:
        start = provenance.get("start")
        while isinstance(start, Mapping):
            told.add(start.get("sha256"))
            start = start.get("start")
    found: list[dict[str, object]] = []
    for sha256, provenance in models:
        found.append({"sha256": sha256} if sha256 in told else {"sha256": sha256, **provenance})
        told.add(sha256)
    return found


def _mean(states: Sequence[Mapping[str, Tensor]]) -> dict[str, Tensor]:
    """The mean of each tensor over `states`; integer tensors (counters) are those of the first."""
    return {
        name: torch.stack([s[name].float() for s in states]).mean(0).to(t.dtype) if t.is_floating_point() else t
        for name, t in states[0].items()
    }


def _check_same_kind(first: Path, mean: Model, path: Path, other: Model) -> None:
    if other.transformer.config != mean.transformer.config:
        raise CheckpointError(
            path, "transformer", f"{other.transformer.config}", f"{mean.transformer.config}, as {first}"
        )
    if other.modules.keys() != mean.modules.keys() or other.rest_pose != mean.rest_pose:
        found, wanted = (f"{sorted(m.modules)}, rest pose {m.rest_pose}" for m in (other, mean))
        raise CheckpointError(path, "config", found, f"{wanted}, as {first}")
    if not _same(mean.tokenizer, other.tokenizer):
        raise CheckpointError(path, "tokenizer", "another one", f"that of {first}: models that went on from one start")


def _same(a: nn.Module, b: nn.Module) -> bool:
    tensors = b.state_dict()
    return a.state_dict().keys() == tensors.keys() and all(
        t.shape == tensors[name].shape and torch.equal(t, tensors[name]) for name, t in a.state_dict().items()
    )
