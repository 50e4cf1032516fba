"""Translates the names of the released checkpoints' tensors into ours, for `official.py`.

Every key is accounted for: renamed, joined (keys and values), or on the list of tensors that the released code never
reads. Any other key is refused by name.
"""

from __future__ import annotations

import re
from pathlib import Path

import torch
from torch import Tensor

from mmm_core.errors import CheckpointError
from mmm_core.imports.foreign_tensors import State, n_blocks

_RESIDUALS = r"model\.([0-9])\.conv(1|2)\.(weight|bias)"
_CONV = {"1": "dilated", "2": "mix"}
TOKENIZER_COPY = "trans_base.vqvae."
_UNUSED = (
    r"trans_base\.pos_embedding\.weight",
    r"trans_base\.cross_att\.[0-9]+\.attn\.mask",
    r"trans_base\.pos_embed\.embed",
)
"""Names of tensors in the file that the released code never reads, and last of one that is computed and compared instead."""
HALF_NAMES = ("_upper", "_lower")


def rename_tokenizer(state: State, path: Path) -> State:
    """The tensors of a `net` dict under our names.

    Raises:
        CheckpointError: an unknown tensor.
    """
    halves = any(k.startswith("quantizer_upper") for k in state)
    prefix, marks = ("", HALF_NAMES) if halves else ("vqvae.", ("",))
    return {_tokenizer_key(name.removeprefix(prefix), marks, path, name): tensor for name, tensor in state.items()}


def rename_transformer(state: State, path: Path) -> State:
    """The tensors of a `trans` dict under our names, keys and values joined, the tokenizer's copy left out.

    Raises:
        CheckpointError: an unknown tensor, or a key without its value.
    """
    n_base = n_blocks(state, "trans_base.blocks.", path)
    ours: State = {}
    joined: dict[str, dict[str, Tensor]] = {}
    for name, tensor in state.items():
        if name.startswith(TOKENIZER_COPY) or any(re.fullmatch(pattern, name) for pattern in _UNUSED):
            continue
        key = _transformer_key(name, n_base, path)
        if match := re.fullmatch(r"(.*)\.(key|value)\.(weight|bias)", key):
            joined.setdefault(f"{match[1]}.key_value.{match[3]}", {})[match[2]] = tensor
        else:
            ours[key] = tensor
    for key, parts in joined.items():
        if len(parts) != 2:
            raise CheckpointError(path, key, f"only its {next(iter(parts))}", "key and value")
        ours[key] = torch.cat([parts["key"], parts["value"]])
    return ours


def _tokenizer_key(name: str, marks: tuple[str, ...], path: Path, full: str) -> str:
    """Our name of a tokenizer tensor."""
    if name in ("mean_upper", "std_upper"):
        return "height_" + name.removesuffix("_upper")
    for q, mark in enumerate(marks):
        if name == f"quantizer{mark}.codebook":
            return f"quantizers.{q}.codebook"
        for part in ("encoder", "decoder"):
            if match := re.fullmatch(rf"{part}{mark}\.model\.(.*)", name):
                key = _convolution(part, match[1])
                if key:
                    return f"{part}s.{q}.{key}"
    raise CheckpointError(path, full, "a tensor that the released tokenizer does not have", "its 67 (or 136) tensors")


def _convolution(part: str, rest: str) -> str | None:
    """Our name of the tensor `rest` below `encoder.model.` or `decoder.model.`."""
    encoder = part == "encoder"
    fixed = {"0": "stem", "4": "out"} if encoder else {"0": "stem", "4": "mix", "6": "out"}
    if (match := re.fullmatch(r"([0-9])\.(weight|bias)", rest)) and match[1] in fixed:
        return f"{fixed[match[1]]}.{match[2]}"
    resample, residual = ("0", "1") if encoder else ("2", "0")
    if (match := re.fullmatch(r"([23])\.([0-9])\.(weight|bias)", rest)) and match[2] == resample:
        return f"{'halvings' if encoder else 'doublings'}.{int(match[1]) - 2}.{match[3]}"
    if (match := re.fullmatch(rf"([23])\.([0-9])\.{_RESIDUALS}", rest)) and match[2] == residual:
        return f"residuals.{int(match[1]) - 2}.{match[3]}.{_CONV[match[4]]}.{match[5]}"
    return None


def _transformer_key(name: str, n_base: int, path: Path) -> str:
    """Our name of a transformer tensor; `key` and `value` are not joined yet."""
    fixed = {
        "trans_base.learn_tok_emb.weight": "specials",
        "trans_head.head.weight": "head.weight",
        "trans_head.ln_f.weight": "norm_out.weight",
        "trans_head.ln_f.bias": "norm_out.bias",
    }
    if name in fixed:
        return fixed[name]
    if match := re.fullmatch(r"trans_base\.(to|cond|word)_emb\.(weight|bias)", name):
        return f"{ {'to': 'embed', 'cond': 'sentence_in', 'word': 'word_in'}[match[1]] }.{match[2]}"
    if match := re.fullmatch(r"trans_(base|head)\.(cross_att|blocks)\.([0-9]+)\.(.*)\.(weight|bias)", name):
        cross = match[2] == "cross_att"
        number = int(match[3]) + (n_base if match[1] == "head" else 0)
        parts = {
            "ln1": "norm_x", "ln2": "norm_mlp", "attn.query": "attention.query", "attn.key": "attention.key",
            "attn.value": "attention.value", "attn.proj": "attention.out", "mlp.0": "mlp.0", "mlp.2": "mlp.2",
        } | ({"ln3": "norm_words"} if cross else {})  # fmt: skip
        if match[4] in parts:
            return f"{'cross' if cross else 'blocks'}.{number}.{parts[match[4]]}.{match[5]}"
    raise CheckpointError(path, name, "a tensor that the released transformer does not have", "its tensors alone")
