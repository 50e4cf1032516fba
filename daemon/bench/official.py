"""Speed of a model of the released size: a whole motion by our decoder against one plain forward pass of the same weights."""

from __future__ import annotations

import copy
import statistics
import time
from dataclasses import replace
from typing import Any

import numpy as np

from daemon.bench.report import context

REPEATS = 3
N_TOKENS = 49
LENGTHS = range(1, N_TOKENS + 1)
"""Lengths in tokens at which the ids are compared."""


def bench_official(n: int | None = None, seed: int = 0) -> dict[str, Any]:
    """`fp32_s`, `bf16_s`, `int8_s` (where the processor can), `reference_forward_ms`, `tokens_identical`, and ratios to one.

    The weights are random, as speed does not depend on them. `tokens_identical` compares, at `n` lengths from 1 to 49 tokens (all
    when None), the packed fp32 model and the fast decoder with the plain model and the released sampler written plainly
    (`mmm_core.model.released_sampler`): a whole text, and an edit of its middle, alternately with arg-max and at temperature 1;
    `lengths_that_differ` lists the lengths at which ids differ. The steps are the released ten; the released code needs ten plain
    passes and more.
    """
    import torch

    from mmm_core.inference.int8_linear import convert_to_int8, int8_is_supported
    from mmm_core.inference.onednn_linear import pack
    from mmm_core.model.sampling import OFFICIAL_SAMPLING, empty_row, fill
    from mmm_core.model.text import TextStates
    from mmm_core.model.transformer import OFFICIAL, MotionTransformer
    from mmm_core.model.vqvae import VqVae, VqVaeConfig

    lengths = LENGTHS if n is None else sorted({round(float(x)) for x in np.linspace(N_TOKENS, 1, n)})
    torch.set_num_threads(1)
    torch.manual_seed(seed)  # pyright: ignore[reportUnknownMemberType]
    plain = MotionTransformer(OFFICIAL).eval()
    tokenizer = VqVae(VqVaeConfig()).eval()
    words = torch.randn(1, 77, OFFICIAL.text_dim)
    text = TextStates(words, torch.ones(1, 77, dtype=torch.bool), words.mean(1))
    closed = torch.full((1, N_TOKENS + 1, 1), plain.ids.mask)
    row = [empty_row(plain, N_TOKENS)]
    models = {"fp32": pack(copy.deepcopy(plain)), "bf16": pack(copy.deepcopy(plain), "bf16")}
    if int8_is_supported():
        eight = copy.deepcopy(plain)
        models["int8"] = convert_to_int8(eight, lambda: fill(eight, text, row, [seed], OFFICIAL_SAMPLING))

    def forward() -> None:
        with torch.inference_mode():
            plain(closed, plain.read_text(text))

    def motion(model: Any) -> None:
        with torch.inference_mode():
            tokenizer.decode(fill(model, text, row, [seed], OFFICIAL_SAMPLING)[0][None])

    times: dict[str, list[float]] = {"forward": [], **{name: [] for name in models}}
    for repeat in range(REPEATS + 1):
        for name, kept in times.items():
            start = time.perf_counter()
            if name == "forward":
                forward()
            else:
                motion(models[name])
            if repeat:
                kept.append(time.perf_counter() - start)
    differing = [n for n in lengths if not _same_ids(models["fp32"], plain, text, n, seed)]
    seconds = {name: statistics.median(kept) for name, kept in times.items()}
    forward_s = seconds.pop("forward")
    return {
        **{f"{name}_s": round(took_s, 3) for name, took_s in seconds.items()},
        **{f"{name}_in_forwards": round(took_s / forward_s, 2) for name, took_s in seconds.items()},
        "reference_forward_ms": round(1e3 * forward_s, 1),
        "tokens_identical": not differing,
        "lengths_compared": len(lengths),
        "lengths_that_differ": differing,
        "steps": 10,
        "n": REPEATS,
        **context(seed, f"median of {REPEATS} alternating runs, one thread, 196 frames, tokens and features, no text"),
    }


def _same_ids(fast: Any, plain: Any, text: Any, n_tokens: int, seed: int) -> bool:
    """Whether `fast` fills a row of `n_tokens`, and then its middle again, with the same ids as the plain sampler."""
    import torch

    from mmm_core.model.decode import seeded_noise
    from mmm_core.model.released_sampler import sample_plainly
    from mmm_core.model.sampling import OFFICIAL_SAMPLING, empty_row, fill

    temperature = float(n_tokens % 2)
    row = empty_row(plain, n_tokens)
    for settings in (replace(OFFICIAL_SAMPLING, temperature=t) for t in (temperature, 1.0 - temperature)):
        noise = seeded_noise([seed])
        expected = sample_plainly(plain, text, row, temperature=settings.temperature, noise=noise)
        with torch.inference_mode():
            if not torch.equal(fill(fast, text, [row], [seed], settings)[0], expected):
                return False
        row = expected.clone()
        row[n_tokens // 4 : n_tokens - n_tokens // 4] = plain.ids.mask
    return True
