"""The sentence tagger on disk: its own layers in half precision; it is used with the text encoder that it was trained on."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

from mmm_core.errors import CheckpointError
from mmm_core.inference.checkpoint import TEXT_FILE, WEIGHTS_DIR, file_hash, fill_module, load_tensors, save_tensors
from mmm_core.model.sentence_tagger import SentenceTagger, TaggerConfig
from mmm_core.model.text import MiniLmConfig

TAGGER_FILE = WEIGHTS_DIR / "sentence_tagger.safetensors"
_KIND = "mmmd-sentence-tagger"


def save_tagger(path: Path, tagger: SentenceTagger) -> None:
    """Write a tagger in half precision; an older file stays whole if writing fails."""
    tensors = {name: tensor.half() for name, tensor in tagger.state_dict().items()}
    save_tensors(path, tensors, _KIND, {"config": asdict(tagger.config), "text_encoder": file_hash(TEXT_FILE)})


def load_tagger(path: Path | None = None) -> SentenceTagger:
    """Read a tagger, the packed one when None.

    Raises:
        CheckpointError: the file is missing, no tagger, or was trained on another text encoder.
    """
    path = path or TAGGER_FILE
    tensors, metadata = load_tensors(path, _KIND)
    trained_on, packed = metadata["text_encoder"], file_hash(TEXT_FILE)
    if trained_on != packed:
        raise CheckpointError(path, "text_encoder", trained_on[:12], f"{packed[:12]}, the packed text encoder")
    tagger = SentenceTagger(TaggerConfig(**metadata["config"]), MiniLmConfig())
    fill_module(tagger, {name: tensor.float() for name, tensor in tensors.items()}, path)
    return tagger
