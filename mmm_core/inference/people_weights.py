"""The weights for captions of people: low-rank changes of the model's transformer and tokenizer, in a file of their own.

The weights of the checkpoint MODEL.safetensors are in MODEL_people.safetensors beside it, which names that checkpoint's hash.
`mmmd train` makes it from a recipe with a rank (docs/training.md). The codebooks are the checkpoint's, but the ids of people's
motions are those of the changed tokenizer: only this one decodes what the changed transformer writes.
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
from mmm_core.model.tokenizer import Tokenizer
from mmm_core.model.transformer import MotionTransformer
from mmm_core.model.vqvae import VqVae

_KIND = "mmmd-people"
_CAPTIONS, _TOKENIZER = "captions.", "tokenizer."
SURE_LOGIT = 1.0
"""Log-odds from which a text is a caption of people; of 3,000 sentences of the corpus about a person 23 have so much."""


@dataclass(frozen=True)
class PeopleWeights:
    """Transformer and tokenizer for captions of people, and what tells these from descriptions of gestures.

    Attributes:
        transformer: the checkpoint's transformer with other weights.
        tokenizer: the checkpoint's tokenizer with other encoders and another decoder, and the same codebooks.
        captions: a sentence vector (D,) -> log-odds (1,) that the sentence is a caption of people.
        guidance: weight of the text in sampling, as in `SamplingSettings`.
    """

    transformer: MotionTransformer
    tokenizer: Tokenizer | VqVae
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
    path: Path,
    trained: nn.Module,
    tokenizer: nn.Module,
    captions: nn.Linear,
    start: Path,
    guidance: float,
    provenance: dict[str, Any],
) -> None:
    """Write the changes of a trained transformer and tokenizer, in half precision; an older file stays whole if writing fails.

    Args:
        path: where to.
        trained: a transformer with changes (`mmm_core.model.low_rank.add_changes`).
        tokenizer: a tokenizer with changes; without any, the checkpoint's own is used.
        captions: as `PeopleWeights.captions`.
        start: the checkpoint that was changed.
        guidance: as `PeopleWeights.guidance`.
        provenance: origin of the weights.
    """
    tensors = {name: factor.half() for name, factor in changes_of(trained).items()}
    tensors |= {_TOKENIZER + name: factor.half() for name, factor in changes_of(tokenizer).items()}
    tensors |= {_CAPTIONS + name: tensor for name, tensor in captions.state_dict().items()}
    save_tensors(path, tensors, _KIND, {"start": file_hash(start), "guidance": guidance, "provenance": provenance})


def load_people(
    transformer: MotionTransformer, tokenizer: Tokenizer | VqVae, checkpoint: Path, checkpoint_hash: str
) -> PeopleWeights | None:
    """The weights for captions of people that belong to a checkpoint; None where it has none.

    Args:
        transformer: the checkpoint's transformer, which is copied; its layers must not be packed yet.
        tokenizer: the checkpoint's tokenizer, which is copied.
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
    changed, decoding, captions = deepcopy(transformer), deepcopy(tokenizer), nn.Linear(transformer.config.text_dim, 1)
    fill_module(captions, _taken(tensors, _CAPTIONS), path)
    try:
        apply_changes(decoding, _taken(tensors, _TOKENIZER))
        apply_changes(changed, tensors)
    except (AttributeError, KeyError, RuntimeError) as error:
        first = str(error).split("\n", 1)[0]
        raise CheckpointError(path, "", f"a change that does not fit ({first})", "what `mmmd train` writes") from error
    return PeopleWeights(changed, decoding, captions, metadata["guidance"])


def _taken(tensors: dict[str, Tensor], prefix: str) -> dict[str, Tensor]:
    """The tensors whose names begin with `prefix`, by the rest of their names; they are taken out of `tensors`."""
    names = [name for name in tensors if name.startswith(prefix)]
    return {name.removeprefix(prefix): tensors.pop(name) for name in names}
