"""`mmmd import-official`: converts the MMM authors' checkpoints into one file of ours."""

from __future__ import annotations

import json as json_module
import sys
from pathlib import Path
from typing import Annotated

import tyro


def import_official(
    tokenizer: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="VQ.pth")],
    transformer: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="TRANS.pth")],
    out: Path,
    mean: Path,
    std: Path,
    clip: Path | None = None,
    vocabulary: Path | None = None,
    heads: int | None = None,
    dilation_growth: int | None = None,
    any_statistics: bool = False,
    json: bool = False,
) -> int:
    """Turn the published pair of checkpoints into one safetensors file for `mmmd generate --model`.

    Nothing in the files is run: tensors alone are read, every one is accounted for, and shapes are checked. The result
    is about 1 GB (fp32, so that tokens are the released model's). The weights' own licence (CC BY-NC-ND 4.0) goes on to
    hold for it. Without --clip the file can be decoded and edited from tokens, but not asked by text.

    Example: mmmd import-official net_last_vq.pth net_last_trans.pth --mean t2m-mean.npy --std t2m-std.npy
    --clip ViT-B-32.pt --vocabulary bpe_simple_vocab_16e6.txt.gz --out official.safetensors

    Args:
        tokenizer: the tokenizer's checkpoint, key `net`.
        transformer: the transformer's checkpoint, key `trans`.
        out: the .safetensors file to write.
        mean: t2m-mean.npy, the mean of the features the model was trained with.
        std: t2m-std.npy, their spread; HumanML3D's own Std.npy is not it and is refused.
        clip: CLIP ViT-B/32: OpenAI's ViT-B-32.pt, or a state dict in .pt or .safetensors.
        vocabulary: CLIP's byte pairs: bpe_simple_vocab_16e6.txt.gz, or a tokenizer.json.
        heads: attention heads of the transformer; its width / 64 when not given, as released.
        dilation_growth: the tokenizer's `dilation_growth_rate`, which its file does not hold. When not given, it is read
            from the `run.log` that training left beside VQ.pth, or else is 3, as released.
        any_statistics: take mean and std as they are, for a model trained elsewhere.
        json: print one JSON object.
    """
    from daemon.errors import CommandError
    from mmm_core.imports.clip_weights import read_clip
    from mmm_core.imports.official import (
        dilation_growth_of,
        read_pickle,
        read_statistics,
        tokenizer_from_official,
        transformer_from_official,
    )
    from mmm_core.inference.checkpoint import Model, file_hash, save_model

    if (clip is None) != (vocabulary is None):
        raise CommandError("import-official: --clip and --vocabulary go together; give both, or neither")
    if not out.parent.is_dir():
        raise CommandError(f"import-official: {out}: no folder '{out.parent}'; make it, or choose another")
    growth, known_from = dilation_growth_of(tokenizer, dilation_growth)
    if known_from == "assumed":
        sys.stderr.write(
            f"import-official: no run.log beside {tokenizer.name}: a dilation growth of {growth} is assumed, as released; "
            "if it was trained with another one, say --dilation-growth N\n"
        )
    vq = tokenizer_from_official(read_pickle(tokenizer, "net"), tokenizer, growth)
    masked = transformer_from_official(read_pickle(transformer, "trans"), vq, transformer, heads)
    read_statistics(mean, std, vq, any_statistics=any_statistics)
    text = None if clip is None or vocabulary is None else read_clip(clip, vocabulary)
    sources = [p for p in (tokenizer, transformer, mean, std, clip, vocabulary) if p is not None]
    provenance = {
        "data": "imported; the licence of the weights holds (MMM: CC BY-NC-ND 4.0, CLIP: MIT)",
        "files": {p.name: file_hash(p) for p in sources},
    }
    model = Model(vq, masked, None, None, provenance, text, "humanml3d")
    save_model(out, model, half=False)
    summary = {
        "out": str(out),
        "sha256": file_hash(out),
        "layout": vq.config.layout,
        "codebook": [vq.config.n_codes, vq.config.code_dim],
        "dilation_growth": vq.config.dilation_growth,
        "parameters": sum(p.numel() for p in (*vq.parameters(), *masked.parameters())),
        "text": text is not None,
        "files": provenance["files"],
    }
    if json:
        sys.stdout.write(json_module.dumps(summary) + "\n")
    else:
        sys.stdout.write("".join(f"{key}: {value}\n" for key, value in summary.items()))
    return 0
