"""Weights on disk: one safetensors file with its configuration, and the text encoder beside it.

A model file holds the tensors of its modules under `tokenizer.`, `transformer.`, `length.`, `scope.` and `text.`, and in its
metadata the sizes, the names of the reference commands and the origin of the weights. Nothing is ever unpickled.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from safetensors import SafetensorError, safe_open
from safetensors.torch import save_file
from tokenizers import Tokenizer as WordPieces
from torch import Tensor, nn
from torch.overrides import TorchFunctionMode

from mmm_core.errors import CheckpointError
from mmm_core.language.scope import ScopeClassifier, ScopeIndex
from mmm_core.model.clip import ClipConfig, ClipText
from mmm_core.model.length import LENGTH_PREDICTORS, LengthPredictor
from mmm_core.model.text import MiniLm, MiniLmConfig
from mmm_core.model.tokenizer import PartConfig, Tokenizer, TokenizerConfig
from mmm_core.model.transformer import MotionTransformer, TransformerConfig
from mmm_core.model.vqvae import VqVae, VqVaeConfig
from mmm_core.motion.features import RestPose

FORMAT = 1
WEIGHTS_DIR = Path(__file__).parents[1] / "weights"
MODEL_FILE = WEIGHTS_DIR / "mmm_compact.safetensors"
TEXT_FILE = WEIGHTS_DIR / "minilm.safetensors"
EVALUATOR_FILE = WEIGHTS_DIR / "evaluator.safetensors"
WORD_PIECES_FILE = WEIGHTS_DIR / "minilm_word_pieces.json"


@dataclass
class Model:
    """The modules and tables that a generation needs.

    Attributes:
        tokenizer: by body parts (ours) or the paper's.
        transformer: the masked model.
        length: seconds from text; None in imported models, which take the caller's seconds.
        scope: texts in and out of scope; None in imported models, which accept everything.
        provenance: record of the weights' origin.
        text: CLIP's text tower, in imported models; None means the packed MiniLM.
        rest_pose: definition of the model's features, above all the rest directions of the rotation channels.
            "mmmd": `features_from_joints`, joints come back from the rotations; "humanml3d":
            `humanml3d_features_from_joints`, joints come back from the position channels, as the reference recovers them.
    """

    tokenizer: Tokenizer | VqVae
    transformer: MotionTransformer
    length: LengthPredictor | None
    scope: ScopeIndex | None
    provenance: dict[str, Any]
    text: ClipText | None = None
    rest_pose: RestPose = "mmmd"

    @property
    def is_ours(self) -> bool:
        """Whether this repository trained the model; sampling, int8, mirroring, counting and previews are tuned for its models."""
        return self.rest_pose == "mmmd"

    @property
    def modules(self) -> dict[str, nn.Module]:
        """Modules with weights, by the prefix of their tensors."""
        named = {"tokenizer": self.tokenizer, "transformer": self.transformer, "length": self.length, "text": self.text}
        return {name: module for name, module in named.items() if module is not None}


def save_model(path: Path, model: Model, *, half: bool = True) -> None:
    """Write `model`, in half precision unless told otherwise; an older file stays whole if writing fails."""
    tensors = {f"{part}.{name}": t for part, module in model.modules.items() for name, t in module.state_dict().items()}
    config: dict[str, Any] = {
        "tokenizer": asdict(model.tokenizer.config),
        "transformer": asdict(model.transformer.config),
        "length": None if model.length is None else type(model.length).__name__,
        "rest_pose": model.rest_pose,
    }
    metadata = {"format": str(FORMAT), "kind": "mmmd-model", "provenance": json.dumps(model.provenance)}
    if model.scope is not None:
        tensors["scope.commands"] = model.scope.vectors
        metadata["scope"] = json.dumps({"commands": model.scope.commands, "n_known": model.scope.n_known})
        if model.scope.classifier is not None:
            tensors |= {f"scope.classifier.{name}": t for name, t in model.scope.classifier.state_dict().items()}
    if model.text is not None:
        config["text"] = asdict(model.text.config)
        if model.text.word_pieces is not None:
            metadata["word_pieces"] = model.text.word_pieces.to_str()
    metadata["config"] = json.dumps(config)
    compact = _compact if half else lambda _name, t: t.detach().clone().contiguous()
    _save(path, {name: compact(name, tensor) for name, tensor in tensors.items()}, metadata)


def load_model(path: Path | None = None) -> Model:
    """Read a model file, `MODEL_FILE` when None.

    Raises:
        CheckpointError: the file is missing, no safetensors file or of another kind or format, or a tensor does not fit.
    """
    path = path or MODEL_FILE
    tensors, metadata = _load(path, "mmmd-model")
    try:
        config = json.loads(metadata["config"])
        word_pieces = WordPieces.from_str(metadata["word_pieces"]) if "word_pieces" in metadata else None
        with _Uninitialised():
            model = Model(
                tokenizer=_tokenizer(config["tokenizer"]),
                transformer=MotionTransformer(TransformerConfig(**config["transformer"])),
                length=_length(config),
                scope=None,
                provenance=json.loads(metadata["provenance"]),
                text=ClipText(ClipConfig(**config["text"]), word_pieces) if "text" in config else None,
                rest_pose=config.get("rest_pose", "mmmd"),
            )
        if "scope" in metadata:
            names = json.loads(metadata["scope"])
            vectors, weights = tensors.pop("scope.commands").float(), _with_prefix(tensors, "scope.classifier.")
            classifier = ScopeClassifier(vectors.shape[1], len(weights["hidden.bias"])) if weights else None
            model.scope = ScopeIndex(names["commands"], vectors, names["n_known"], classifier)
    except (KeyError, TypeError, ValueError) as error:
        raise CheckpointError(path, "config", f"not readable ({error})", "what `save_model` writes") from error
    for name, module in model.modules.items():
        _fill(module, _with_prefix(tensors, name + "."), path, name + ".")
    if model.scope is not None and model.scope.classifier is not None:
        _fill(model.scope.classifier, _with_prefix(tensors, "scope.classifier."), path, "scope.classifier.")
    return model


class _Uninitialised(TorchFunctionMode):
    """Context in which new modules skip weight initialisation, which takes longer than reading the real weights.

    PyTorch's meta device does not help: initialising an embedding there imports its compiler (1.4 s).
    """

    def __torch_function__(
        self, func: Any, types: Any, args: tuple[Any, ...] = (), kwargs: dict[str, Any] | None = None
    ) -> Any:
        if getattr(func, "__module__", "") == nn.init.__name__:
            return kwargs["tensor"] if kwargs and "tensor" in kwargs else args[0]
        return func(*args, **(kwargs or {}))


def _length(config: dict[str, Any]) -> LengthPredictor | None:
    """The length predictor that a checkpoint names. Older checkpoints say only whether they have one; theirs is log-normal."""
    kind = config.get("length", True)
    if not kind:
        return None
    return LENGTH_PREDICTORS["LogNormalLength" if kind is True else kind](config["transformer"]["text_dim"])


def _tokenizer(config: dict[str, Any]) -> Tokenizer | VqVae:
    if "parts" not in config:
        return VqVae(VqVaeConfig(**config))
    parts = tuple(PartConfig(p["name"], tuple(p["channels"]), p["width"]) for p in config.pop("parts"))
    return Tokenizer(TokenizerConfig(**config, parts=parts))


def load_text_encoder(path: Path | None = None, word_pieces: Path | None = None, n_left_out: int = 0) -> MiniLm:
    """Read the text encoder, the packed one when None, without its last `n_left_out` layers, which the model brings itself.

    Raises:
        CheckpointError: as `load_model`.
    """
    path, word_pieces = path or TEXT_FILE, word_pieces or WORD_PIECES_FILE
    tensors, metadata = _load(path, "mmmd-text")
    if not word_pieces.is_file():
        raise CheckpointError(word_pieces, "", "no such file", "the word pieces that belong to the text encoder")
    pieces = WordPieces.from_file(str(word_pieces))
    with _Uninitialised():
        encoder = MiniLm(MiniLmConfig(**json.loads(metadata["config"])), pieces, n_left_out)
    weight = tensors.pop("word_embedding.bytes").float().mul_(tensors.pop("word_embedding.scale").float())
    tensors["word_embedding.weight"] = weight
    _fill(encoder, tensors, path, "")
    return encoder


def save_tensors(path: Path, tensors: Mapping[str, Tensor], kind: str, metadata: dict[str, Any]) -> None:
    """Write tensors of another kind (an evaluator, say); an older file stays whole if writing fails."""
    plain = {name: t.detach().clone().contiguous() for name, t in tensors.items()}
    _save(path, plain, {"format": str(FORMAT), "kind": kind, "metadata": json.dumps(metadata)})


def load_tensors(path: Path, kind: str) -> tuple[dict[str, Tensor], dict[str, Any]]:
    """Read what `save_tensors` wrote.

    Raises:
        CheckpointError: the file is missing, no safetensors file, or of another kind or format.
    """
    tensors, metadata = _load(path, kind)
    return tensors, json.loads(metadata["metadata"])


def fill_module(module: nn.Module, tensors: dict[str, Tensor], path: Path) -> None:
    """Load `tensors` into `module`, for inference.

    Raises:
        CheckpointError: a tensor is missing, unknown to the module or of another shape.
    """
    _fill(module, tensors, path, "")


def file_hash(path: Path) -> str:
    """SHA-256 of a file, hex."""
    with path.open("rb") as f:
        return hashlib.file_digest(f, "sha256").hexdigest()


def _compact(name: str, tensor: Tensor) -> Tensor:
    """Half precision for weights; statistics, code vectors and counters stay exact."""
    exact = not tensor.is_floating_point() or any(key in name for key in (".mean", ".std", "codebook", "uses", "sums"))
    return (tensor if exact else tensor.half()).detach().clone().contiguous()


def _with_prefix(tensors: Mapping[str, Tensor], prefix: str) -> dict[str, Tensor]:
    return {name.removeprefix(prefix): t for name, t in tensors.items() if name.startswith(prefix)}


def _save(path: Path, tensors: dict[str, Tensor], metadata: dict[str, str]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(path.name + ".part")
    try:
        save_file(tensors, str(partial), metadata=metadata)
        os.replace(partial, path)
    except (SafetensorError, OSError) as error:
        kept = "the older file is whole" if path.is_file() else "nothing was written"
        raise CheckpointError(path, "", f"could not be written ({error}); {kept}", "room on the disk") from error
    finally:
        partial.unlink(missing_ok=True)


def _load(path: Path, kind: str) -> tuple[dict[str, Tensor], dict[str, str]]:
    if not path.is_file():
        raise CheckpointError(path, "", "no such file", f"a {kind} file; the shipped one comes with the package")
    try:
        with safe_open(str(path), framework="pt") as f:  # type: ignore[no-untyped-call]
            metadata: dict[str, str] = f.metadata() or {}
            tensors = {name: f.get_tensor(name) for name in f.keys()}
    except (SafetensorError, OSError) as error:
        raise CheckpointError(path, "", f"not a readable safetensors file ({error})", f"a {kind} file") from error
    if metadata.get("kind") != kind:
        raise CheckpointError(path, "kind", repr(metadata.get("kind")), repr(kind))
    if metadata.get("format") != str(FORMAT):
        raise CheckpointError(path, "format", repr(metadata.get("format")), f"{FORMAT}; another mmmd version wrote it")
    return tensors, metadata


def _fill(module: nn.Module, tensors: dict[str, Tensor], path: Path, prefix: str) -> None:
    """Load `tensors` into `module` and make it ready for inference; every key and shape must agree."""
    wanted = module.state_dict()
    for name, tensor in wanted.items():
        if name not in tensors:
            raise CheckpointError(path, prefix + name, "missing", f"a tensor {tuple(tensor.shape)}")
        if tensors[name].shape != tensor.shape:
            raise CheckpointError(path, prefix + name, f"shape {tuple(tensors[name].shape)}", f"{tuple(tensor.shape)}")
    for name in tensors.keys() - wanted.keys():
        raise CheckpointError(
            path, prefix + name, "a tensor this model does not have", "only tensors of its configuration"
        )
    module.load_state_dict({name: t.to(wanted[name].dtype) for name, t in tensors.items()}, assign=True)  # no copies
    module.eval().requires_grad_(False)
