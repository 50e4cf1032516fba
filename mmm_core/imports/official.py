"""Reads the files of the released model into our modules. No such file ships with mmmd; users name theirs.

Layout of exitudio/MMM's checkpoints: two pickled dicts, the tokenizer under `net` and the transformer under `trans`, the
second with a whole copy of the first. Every key is accounted for: renamed, joined, compared with our own computation, or on
the list of tensors that the released code never reads. Any other key is refused by name.
"""

from __future__ import annotations

import pickle
import re
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from mmm_core.errors import CheckpointError
from mmm_core.imports.foreign_tensors import State, check_tensors, load_exactly, n_blocks, shape_of
from mmm_core.imports.official_names import HALF_NAMES, TOKENIZER_COPY, rename_tokenizer, rename_transformer
from mmm_core.model.transformer import MotionTransformer, TransformerConfig, sinusoids
from mmm_core.model.vqvae import VqVae, VqVaeConfig

ROOT_STD = (5.147e-4, 6.769e-4, 6.769e-4, 6.121e-3)
"""Standard deviations of the root's four features in the statistics that the released model was trained with. Those in
HumanML3D's own `Std.npy` are 25 times larger, and the root would move 25 times too fast."""

RELEASED_DILATION_GROWTH = 3
"""Factor between the dilations of neighbouring residual blocks in the released tokenizers."""
TRAINING_LOG = "run.log"
"""File in the folder of checkpoints to which the released training writes its options as JSON."""
GREATEST_DILATION_GROWTH = 9
"""Greatest factor between dilations; with a greater one the third block would reach beyond the longest motion."""


def read_pickle(path: Path, key: str) -> State:
    """Tensors under `key` of a PyTorch file; nothing but tensors is ever unpickled.

    Raises:
        CheckpointError: the file is missing, no PyTorch file, contains code, lacks `key`, or holds a tensor that no layer can
            use (sparse, without data, complex, not finite).
    """
    if not path.is_file():
        raise CheckpointError(path, "", "no such file", f"a checkpoint with '{key}', as the MMM authors publish it")
    try:
        content = torch.load(path, map_location="cpu", weights_only=True)
    except pickle.UnpicklingError as error:
        first = str(error).split("\n", 1)[0]
        raise CheckpointError(
            path, "", f"holds more than tensors ({first})", "tensors alone; nothing was run"
        ) from None
    except (RuntimeError, EOFError, OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise CheckpointError(path, "", f"not a readable PyTorch file ({error})", f"a dict with '{key}'") from None
    if not isinstance(content, dict) or key not in content:
        found = sorted(content) if isinstance(content, dict) else type(content).__name__
        raise CheckpointError(path, key, f"missing; found {str(found)[:200]}", f"a dict with '{key}'")
    state = content[key]
    if not isinstance(state, dict):
        raise CheckpointError(path, key, f"a {type(state).__name__}", "a dict of tensors")
    return check_tensors(state, path)


def tokenizer_from_official(state: State, path: Path, dilation_growth: int = RELEASED_DILATION_GROWTH) -> VqVae:
    """The tokenizer of a `net` dict (whole body: keys begin with `vqvae.`; upper and lower: with their half's name).

    The file holds no statistics: `mean` and `std` stay 0 and 1 until `read_statistics` sets them. Nor does it hold
    `dilation_growth`, the factor from one residual block's dilation to the next, which `dilation_growth_of` finds.

    Raises:
        CheckpointError: a key is missing, unknown or of another shape; the first is named.
    """
    halves = any(k.startswith("quantizer_upper") for k in state)
    prefix = "" if halves else "vqvae."
    marks = HALF_NAMES if halves else ("",)
    n_codes, code_dim = shape_of(state, f"{prefix}quantizer{marks[0]}.codebook", 2, path)
    width, n_channels, _ = shape_of(state, f"{prefix}encoder{marks[0]}.model.0.weight", 3, path)
    blocks = [k for k in state if k.startswith(f"{prefix}encoder{marks[0]}.model.2.1.model.") and "conv1.weight" in k]
    config = VqVaeConfig(
        "halves" if halves else "whole", n_codes, code_dim, width, len(blocks), dilation_growth,
        n_features=263 if halves else n_channels,
    )  # fmt: skip
    ours = rename_tokenizer(state, path)
    tokenizer = VqVae(config)
    for q, book in enumerate(tokenizer.books):  # moving averages are not in the file: as after the first batch
        ours[f"quantizers.{q}.uses"] = torch.ones(config.n_codes)
        ours[f"quantizers.{q}.sums"] = ours[f"quantizers.{q}.codebook"].clone()
        ours[f"quantizers.{q}.n_updates"] = torch.ones_like(book.n_updates)
    kept = {k: v for k, v in tokenizer.state_dict().items() if k in ("mean", "std", "height_mean", "height_std")}
    load_exactly(tokenizer, {**kept, **ours}, path)
    return tokenizer


def transformer_from_official(
    state: State, tokenizer: VqVae, path: Path, n_heads: int | None = None
) -> MotionTransformer:
    """The transformer of a `trans` dict, with the code vectors of `tokenizer`.

    Raises:
        CheckpointError: a key is missing, unknown or of another shape, the copied tokenizer differs from `tokenizer`, or
            the position table is not the paper's.
    """
    copy = {k.removeprefix(TOKENIZER_COPY): v for k, v in state.items() if k.startswith(TOKENIZER_COPY)}
    if tokenizer.config.layout == "halves":
        copy = {k.removeprefix("vqvae."): v for k, v in copy.items()}
    if copy:
        copied = tokenizer_from_official(copy, path, tokenizer.config.dilation_growth)
        _same_tokenizer(tokenizer, copied, path)
    C, K, D = len(tokenizer.books), tokenizer.config.n_codes, tokenizer.config.code_dim
    width, text_dim = shape_of(state, "trans_base.cond_emb.weight", 2, path)
    if n_heads is None:
        n_heads = max(1, width // 64)
    if n_heads < 1 or width % n_heads:
        found = f"width {width} with {n_heads} heads"
        raise CheckpointError(path, "trans_base.cond_emb.weight", found, "--heads N with N a divisor of the width")
    n_cross, *n_self = (
        n_blocks(state, p, path) for p in ("trans_base.cross_att.", "trans_base.blocks.", "trans_head.blocks.")
    )
    config = TransformerConfig(
        K, C, D, width, n_heads, n_cross, sum(n_self), text_dim, n_predicted=1 if C > 1 else None,
    )  # fmt: skip
    table = state.get("trans_base.pos_embed.embed")
    if table is not None:
        _check_positions(table, width, path)
    ours = rename_transformer(state, path)
    shape_of(state, "trans_base.learn_tok_emb.weight", 2, path)
    ours["specials"] = ours["specials"].repeat(1, C)
    ours["codebooks"] = torch.stack([q.codebook for q in tokenizer.books])
    ours["no_words"] = torch.zeros(text_dim)  # the released model was never trained without text
    model = MotionTransformer(config)
    load_exactly(model, ours, path)
    return model


def dilation_growth_of(checkpoint: Path, given: int | None) -> tuple[int, str]:
    """The growth of the dilations of a tokenizer's file, and its source: "given", the name of the log, or "assumed".

    The shapes of the tensors do not show the growth. The caller gives it, or the training log beside the file names it;
    otherwise the released tokenizers' growth is assumed.

    Raises:
        CheckpointError: `given` and the log differ, or the growth is out of range.
    """
    log = checkpoint.parent / TRAINING_LOG
    found = re.search(r'"dilation_growth_rate": *(-?[0-9]{1,9})', _beginning_of(log))
    logged = int(found[1]) if found else None
    if given is not None and logged is not None and given != logged:
        raise CheckpointError(log, "dilation_growth_rate", f"{logged}, asked for {given}", "the same; leave one out")
    growth, source = (given, "given") if given is not None else (logged, TRAINING_LOG)
    if growth is None:
        return RELEASED_DILATION_GROWTH, "assumed"
    if not 1 <= growth <= GREATEST_DILATION_GROWTH:
        raise CheckpointError(checkpoint, "dilation growth", f"{growth}", f"1 to {GREATEST_DILATION_GROWTH}")
    return growth, source


def _beginning_of(log: Path) -> str:
    """The first 65,536 characters of the training log, which contain its options; empty when it cannot be read."""
    try:
        with log.open(encoding="utf-8", errors="replace") as lines:
            return lines.read(65536)
    except OSError:
        return ""


def read_statistics(mean_path: Path, std_path: Path, tokenizer: VqVae, *, any_statistics: bool = False) -> None:
    """Read mean and standard deviation of the features into `tokenizer`.

    Raises:
        CheckpointError: the files hold no arrays of the tokenizer's features, a deviation is not positive, or (unless
            `any_statistics`) the root's deviations are not those that the released model was trained with.
    """
    values: list[Tensor] = []
    for path in (mean_path, std_path):
        try:
            array = np.load(path, allow_pickle=False)
        except (OSError, ValueError, EOFError) as error:
            raise CheckpointError(path, "", f"not a readable .npy ({error})", "one number for each feature") from None
        if array.shape != (tokenizer.config.n_features,) or not np.isfinite(array).all():
            expected = f"({tokenizer.config.n_features},) finite numbers"
            raise CheckpointError(path, "", f"shape {array.shape}, finite: {bool(np.isfinite(array).all())}", expected)
        values.append(torch.from_numpy(array.astype(np.float64)))
    if not (values[1] > 0).all():
        raise CheckpointError(std_path, f"[{int((values[1] <= 0).nonzero()[0])}]", "not positive", "a spread above 0")
    root = values[1][: len(ROOT_STD)]
    if not any_statistics and not torch.allclose(root, torch.tensor(ROOT_STD, dtype=root.dtype), rtol=0.01):
        raise CheckpointError(
            std_path, "[0:4]", str([float(f"{v:.3e}") for v in root]), f"{list(ROOT_STD)}, the spread the released model "
            "was trained with (t2m-std.npy; HumanML3D's Std.npy is not it); --any-statistics takes yours",
        )  # fmt: skip
    tokenizer.mean.copy_(values[0])
    tokenizer.std.copy_(values[1])


def _same_tokenizer(given: VqVae, copied: VqVae, path: Path) -> None:
    for name, tensor in given.state_dict().items():
        other = copied.state_dict().get(name)
        if name not in ("mean", "std") and (other is None or not torch.equal(tensor, other)):
            raise CheckpointError(
                path,
                f"{TOKENIZER_COPY}... ({name})",
                "differs from the tokenizer file",
                "the pair that belongs together",
            )


def _check_positions(table: Tensor, width: int, path: Path) -> None:
    expected = sinusoids(len(table), width)
    if table.shape != (len(expected), 1, width) or not torch.allclose(table[:, 0].float(), expected, atol=1e-4):
        raise CheckpointError(path, "trans_base.pos_embed.embed", "not sinusoids", f"({len(expected)}, 1, {width})")
