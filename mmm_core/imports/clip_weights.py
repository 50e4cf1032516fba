"""Reads OpenAI's CLIP weights into the text tower (`mmm_core.model.clip`). The image tower is left out."""

from __future__ import annotations

import pickle
from pathlib import Path

import torch
from safetensors import SafetensorError
from safetensors.torch import load_file
from torch import Tensor

from mmm_core.errors import CheckpointError
from mmm_core.imports.foreign_tensors import check_tensors, load_exactly, n_blocks, shape_of
from mmm_core.model.clip import ClipConfig, ClipText
from mmm_core.model.clip_byte_pairs import read_vocabulary


def read_clip(path: Path, vocabulary: Path) -> ClipText:
    """The text tower from OpenAI's `ViT-B-32.pt` (a TorchScript archive), or from a state dict (.pt, .safetensors).

    Raises:
        CheckpointError: a file is missing or of another kind, or weights and vocabulary do not fit each other.
    """
    if not path.is_file():
        raise CheckpointError(path, "", "no such file", "CLIP ViT-B/32's weights")
    try:
        if path.suffix == ".safetensors":
            state = load_file(str(path))
        else:
            try:
                state = torch.load(path, map_location="cpu", weights_only=True)
            except RuntimeError:  # a TorchScript archive: its tensors are read, its code is not called
                state = torch.jit.load(str(path), map_location="cpu").state_dict()  # type: ignore[no-untyped-call]
    except (pickle.UnpicklingError, SafetensorError, RuntimeError, OSError, ValueError, EOFError) as error:
        first = str(error).split("\n", 1)[0]
        raise CheckpointError(path, "", f"not readable ({first})", "ViT-B-32.pt or a state dict of tensors") from None
    if not isinstance(state, dict):
        raise CheckpointError(path, "", f"a {type(state).__name__}", "a state dict of tensors")
    tower = clip_from_openai(dict(state), path)
    pieces = read_vocabulary(vocabulary)
    if pieces.get_vocab_size() != tower.config.vocabulary:
        found = f"{pieces.get_vocab_size()} pieces"
        raise CheckpointError(vocabulary, "", found, f"{tower.config.vocabulary}, as many as the weights have")
    tower.word_pieces = pieces
    return tower


def clip_from_openai(state: dict[str, Tensor], path: Path, n_heads: int | None = None) -> ClipText:
    """The text tower of a CLIP state dict in OpenAI's layout; the image tower is left out.

    Raises:
        CheckpointError: a weight of the text tower is missing, of another shape, or not dense, real and finite.
    """
    used = ("token_embedding.", "positional_embedding", "text_projection", "ln_final.", "transformer.")
    text = check_tensors({k: v for k, v in state.items() if k.startswith(used)}, path)
    vocabulary, width = shape_of(text, "token_embedding.weight", 2, path)
    n_layers = n_blocks(text, "transformer.resblocks.", path)
    n_positions = shape_of(text, "positional_embedding", 2, path)[0]
    sentence_dim = shape_of(text, "text_projection", 2, path)[1]
    n_heads = n_heads or max(1, width // 64)
    if width % n_heads:
        raise CheckpointError(path, "token_embedding.weight", f"width {width}", f"a multiple of {n_heads} heads")
    config = ClipConfig(vocabulary, n_positions, width, n_layers, n_heads, sentence_dim)
    try:
        out = {
            "token_embedding.weight": text["token_embedding.weight"],
            "position_embedding": text["positional_embedding"],
            "projection": text["text_projection"],
        }
        names = {"attn.in_proj_": "qkv.", "attn.out_proj.": "out.", "ln_1.": "norm_attention.", "ln_2.": "norm_mlp.",
                 "mlp.c_fc.": "mlp_in.", "mlp.c_proj.": "mlp_out."}  # fmt: skip
        for suffix in ("weight", "bias"):
            out[f"norm_out.{suffix}"] = text[f"ln_final.{suffix}"]
            for i in range(n_layers):
                for theirs, ours in names.items():
                    out[f"blocks.{i}.{ours}{suffix}"] = text[f"transformer.resblocks.{i}.{theirs}{suffix}"]
    except (KeyError, ValueError) as error:
        raise CheckpointError(path, str(error).strip("'"), "missing", "CLIP's text tower in OpenAI's layout") from None
    tower = ClipText(config)
    load_exactly(tower, out, path)
    return tower
