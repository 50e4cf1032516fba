"""The transformer's weights for captions of people: a low-rank change of the shipped model's weights, in a file of its own.

The weights of the checkpoint MODEL.safetensors are in MODEL_people.safetensors beside it, which names that checkpoint's hash.
`mmmd train` makes it from a recipe with a rank (docs/training.md).
"""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import torch
from torch import Tensor, nn

from mmm_core.errors import CheckpointError
from mmm_core.inference.checkpoint import file_hash, fill_module, load_tensors, save_tensors
from mmm_core.language.captions import may_be_of_people
from mmm_core.model.low_rank import apply_changes, changes_of
from mmm_core.model.transformer import MotionTransformer

_KIND = "mmmd-people"
_CAPTIONS = "captions."
SURE_LOGIT = 1.0
"""Log-odds from which a text is a caption of people; of 3,000 sentences of the corpus about a person 23 have so much."""


@dataclass(frozen=True)
class PeopleWeights:
    """A transformer for captions of people, and what tells these from descriptions of gestures.

    Attributes:
        transformer: the checkpoint's transformer with other weights.
        captions: a sentence vector (D,) -> log-odds (1,) that the sentence is a caption of people.
        guidance: weight of the text in sampling, as in `SamplingSettings`.
    """

    transformer: MotionTransformer
    captions: nn.Linear
    guidance: float

    @torch.inference_mode()
    def are_for(self, text: str, sentence: Tensor) -> bool:
        """Whether a text with its unit sentence vector (D,) is a caption of people."""
        return may_be_of_people(text) and float(self.captions(sentence)) > SURE_LOGIT


def people_file(checkpoint: Path) -> Path:
    """Path of the weights for captions of people that belong to a checkpoint."""
    return checkpoint.with_name(f"{checkpoint.stem}_people.safetensors")


def save_people(
    path: Path, trained: nn.Module, captions: nn.Linear, start: Path, guidance: float, provenance: dict[str, Any]
) -> None:
    """Write the changes of a trained transformer, in half precision; an older file stays whole if writing fails.

    Args:
        path: where to.
        trained: a transformer with changes (`mmm_core.model.low_rank.add_changes`).
        captions: as `PeopleWeights.captions`.
        start: the checkpoint whose transformer was changed.
        guidance: as `PeopleWeights.guidance`.
        provenance: origin of the weights.
    """
    tensors = {name: factor.half() for name, factor in changes_of(trained).items()}
    tensors |= {_CAPTIONS + name: tensor for name, tensor in captions.state_dict().items()}
    save_tensors(path, tensors, _KIND, {"start": file_hash(start), "guidance": guidance, "provenance": provenance})


def load_people(transformer: MotionTransformer, checkpoint: Path, checkpoint_hash: str) -> PeopleWeights | None:
    """The weights for captions of people that belong to a checkpoint; None where it has none.

    Args:
        transformer: the checkpoint's transformer, which is copied; its layers must not be packed yet.
        checkpoint: the checkpoint's file.
        checkpoint_hash: its hash.

    Raises:
        CheckpointError: the file is of another kind, belongs to another checkpoint, or has a change that does not fit.
    """
    path = people_file(checkpoint)
    if not path.is_file():
        return None
    tensors, metadata = load_tensors(path, _KIND)
    if metadata["start"] != checkpoint_hash:
        found = f"changes of the checkpoint {metadata['start'][:12]}"
        raise CheckpointError(
            path, "start", found, f"those of {checkpoint.name}, {checkpoint_hash[:12]}, or no such file"
        )
    changed, captions = deepcopy(transformer), nn.Linear(transformer.config.text_dim, 1)
    names = [name for name in tensors if name.startswith(_CAPTIONS)]
    fill_module(captions, {name.removeprefix(_CAPTIONS): tensors.pop(name) for name in names}, path)
    try:
        apply_changes(changed, tensors)
    except (AttributeError, KeyError, RuntimeError) as error:
        first = str(error).split("\n", 1)[0]
        raise CheckpointError(path, "", f"a change that does not fit ({first})", "what `mmmd train` writes") from error
    return PeopleWeights(changed, captions, metadata["guidance"])
