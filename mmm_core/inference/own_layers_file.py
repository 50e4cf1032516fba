"""Sentence tagger, gesture classifier and sentence parser on disk: their own layers in half precision, above the text encoder."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

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
_TAGGER, _CLASSIFIER, _PARSER = "mmmd-sentence-tagger", "mmmd-gesture-classifier", "mmmd-sentence-parser"


def save_tagger(path: Path, tagger: SentenceTagger) -> None:
    """Write a tagger in half precision; an older file stays whole if writing fails."""
    _save(path, tagger.state_dict(), _TAGGER, asdict(tagger.config))


def save_classifier(path: Path, classifier: GestureClassifier) -> None:
    """Write a classifier in half precision; an older file stays whole if writing fails."""
    _save(path, classifier.state_dict(), _CLASSIFIER, asdict(classifier.config))


def save_parser(path: Path, parser: SentenceParser) -> None:
    """Write a parser in half precision; an older file stays whole if writing fails."""
    _save(path, parser.state_dict(), _PARSER, asdict(parser.config))


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
        CheckpointError: the file is missing, no parser, or was trained on another text encoder.
    """
    tensors, config = _load(path, _PARSER)
    parser = SentenceParser(ParserConfig(**{**config, "tokens": tuple(config["tokens"])}), MiniLmConfig())
    fill_module(parser, tensors, path)
    return parser


def _save(path: Path, tensors: dict[str, Tensor], kind: str, config: dict[str, Any]) -> None:
    halves = {name: tensor.half() for name, tensor in tensors.items()}
    save_tensors(path, halves, kind, {"config": config, "text_encoder": file_hash(TEXT_FILE)})


def _load(path: Path, kind: str) -> tuple[dict[str, Tensor], dict[str, Any]]:
    tensors, metadata = load_tensors(path, kind)
    trained_on, packed = metadata["text_encoder"], file_hash(TEXT_FILE)
    if trained_on != packed:
        raise CheckpointError(path, "text_encoder", trained_on[:12], f"{packed[:12]}, the packed text encoder")
    return {name: tensor.float() for name, tensor in tensors.items()}, metadata["config"]
