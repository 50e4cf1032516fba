"""Sentence tagger, gesture classifier and sentence parser on disk: their own layers, above the text encoder.

Tagger and classifier are in half precision. The parser, which has twice as many layers, has its matrices in integers of one byte,
each row with its scale.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import torch
from torch import Tensor

from mmm_core.errors import CheckpointError
from mmm_core.inference.checkpoint import TEXT_FILE, WEIGHTS_DIR, file_hash, fill_module, load_tensors, save_tensors
from mmm_core.model.gesture_classifier import ClassifierConfig, GestureClassifier
from mmm_core.model.sentence_parser import ParserConfig, SentenceParser
from mmm_core.model.sentence_tagger import SentenceTagger, TaggerConfig
from mmm_core.model.text import MiniLmConfig

TAGGER_FILE = WEIGHTS_DIR / "sentence_tagger.safetensors"
CLASSIFIER_FILE = WEIGHTS_DIR / "gesture_classifier.safetensors"
PARSER_FILE = WEIGHTS_DIR / "sentence_parser.safetensors"
_BYTES, _SCALE, _LEAST_SCALE = ".bytes", ".scale", 1e-12
_TAGGER, _CLASSIFIER, _PARSER = "mmmd-sentence-tagger", "mmmd-gesture-classifier", "mmmd-sentence-parser"


def save_tagger(path: Path, tagger: SentenceTagger) -> None:
    """Write a tagger in half precision; an older file stays whole if writing fails."""
    _save(path, _halves(tagger.state_dict()), _TAGGER, asdict(tagger.config))


def save_classifier(path: Path, classifier: GestureClassifier) -> None:
    """Write a classifier in half precision; an older file stays whole if writing fails."""
    _save(path, _halves(classifier.state_dict()), _CLASSIFIER, asdict(classifier.config))


def save_parser(path: Path, parser: SentenceParser) -> None:
    """Write a parser, its matrices in bytes; an older file stays whole if writing fails."""
    _save(path, _bytes(parser.state_dict()), _PARSER, asdict(parser.config))


def load_tagger(path: Path = TAGGER_FILE) -> SentenceTagger:
    """Read a tagger.

    Raises:
        CheckpointError: the file is missing, no tagger, or was trained on another text encoder.
    """
    tensors, config = _load(path, _TAGGER)
    tagger = SentenceTagger(TaggerConfig(**config), MiniLmConfig())
    fill_module(tagger, tensors, path)
    return tagger


def load_classifier(path: Path = CLASSIFIER_FILE) -> GestureClassifier:
    """Read a classifier.

    Raises:
        CheckpointError: the file is missing, no classifier, or was trained on another text encoder.
    """
    tensors, config = _load(path, _CLASSIFIER)
    sizes = ClassifierConfig(**{**config, "classes": tuple(config["classes"]), "manners": tuple(config["manners"])})
    classifier = GestureClassifier(sizes, MiniLmConfig())
    fill_module(classifier, tensors, path)
    return classifier


def load_parser(path: Path = PARSER_FILE) -> SentenceParser:
    """Read a parser.

    Raises:
        CheckpointError: the file is missing, no parser, one with layers of the encoder, or was trained on another text encoder.
    """
    tensors, config = _load(path, _PARSER)
    if "n_shared" in config:
        raise CheckpointError(
            path, "n_shared", str(config["n_shared"]), "none: make a new parser, with mmmd train parser"
        )
    parser = SentenceParser(ParserConfig(**{**config, "tokens": tuple(config["tokens"])}), MiniLmConfig())
    fill_module(parser, tensors, path)
    return parser


def _save(path: Path, tensors: Mapping[str, Tensor], kind: str, config: dict[str, Any]) -> None:
    save_tensors(path, tensors, kind, {"config": config, "text_encoder": file_hash(TEXT_FILE)})


def _halves(tensors: Mapping[str, Tensor]) -> dict[str, Tensor]:
    return {name: tensor.half() for name, tensor in tensors.items()}


def _bytes(tensors: Mapping[str, Tensor]) -> dict[str, Tensor]:
    """Matrices as integers from -127 to 127 times the scale of their row, other tensors in half precision."""
    matrices = {name: tensor for name, tensor in tensors.items() if tensor.ndim == 2}
    found = _halves({name: tensor for name, tensor in tensors.items() if name not in matrices})
    for name, tensor in matrices.items():
        scale = (tensor.abs().amax(1, keepdim=True) / 127).clamp_min(_LEAST_SCALE)
        found |= {name + _BYTES: (tensor / scale).round().to(torch.int8), name + _SCALE: scale}
    return found


def _load(path: Path, kind: str) -> tuple[dict[str, Tensor], dict[str, Any]]:
    tensors, metadata = load_tensors(path, kind)
    trained_on, packed = metadata["text_encoder"], file_hash(TEXT_FILE)
    if trained_on != packed:
        raise CheckpointError(path, "text_encoder", trained_on[:12], f"{packed[:12]}, the packed text encoder")
    scales = {name.removesuffix(_SCALE): tensors.pop(name) for name in list(tensors) if name.endswith(_SCALE)}
    found = {name.removesuffix(_BYTES): tensor.float() for name, tensor in tensors.items()}
    return {name: t * scales[name] if name in scales else t for name, t in found.items()}, metadata["config"]
