"""Speed of the released model's size: a whole motion by our decoder beside one plain forward pass of the same weights."""

from __future__ import annotations

import copy
import statistics
import time
from dataclasses import replace
from typing import Any

from daemon.bench.report import context

REPEATS = 3
N_TOKENS = 49


def bench_official(seed: int = 0) -> dict[str, Any]:
    """`fp32_s`, `bf16_s`, `reference_forward_ms`, `tokens_identical`, and the ratio of the first to the third.

    Random weights: speed does not depend on them. `tokens_identical` compares the packed fp32 model with the plain one,
    by arg-max and by sampling. The steps are the released ten; the released code needs ten plain passes and more.
    """
    import torch

    from mmm_core.packed import pack
    from mmm_core.sampling import OFFICIAL_SAMPLING, empty_row, fill
    from mmm_core.text import TextStates
    from mmm_core.transformer import OFFICIAL, MotionTransformer
    from mmm_core.vqvae import VqVae, VqVaeConfig

    torch.set_num_threads(1)
    torch.manual_seed(seed)  # pyright: ignore[reportUnknownMemberType]
    plain = MotionTransformer(OFFICIAL).eval()
    tokenizer = VqVae(VqVaeConfig()).eval()
    words = torch.randn(1, 77, OFFICIAL.text_dim)
    text = TextStates(words, torch.ones(1, 77, dtype=torch.bool), words.mean(1))
    closed = torch.full((1, N_TOKENS + 1, 1), plain.ids.mask)
    models = {"fp32": pack(copy.deepcopy(plain)), "bf16": pack(copy.deepcopy(plain), "bf16")}
    row = [empty_row(plain, N_TOKENS)]

    def forward() -> None:
        with torch.inference_mode():
            plain(closed, plain.read_text(text))

    def motion(model: Any) -> None:
        with torch.inference_mode():
            tokenizer.decode(fill(model, text, row, [seed], OFFICIAL_SAMPLING)[0][None])

    times: dict[str, list[float]] = {"forward": [], "fp32": [], "bf16": []}
    for repeat in range(REPEATS + 1):
        for name, kept in times.items():
            start = time.perf_counter()
            if name == "forward":
                forward()
            else:
                motion(models[name])
            if repeat:
                kept.append(time.perf_counter() - start)
    identical = all(
        torch.equal(*(fill(m, text, row, [seed], how)[0] for m in (plain, models["fp32"])))  # type: ignore[arg-type]
        for how in (OFFICIAL_SAMPLING, replace(OFFICIAL_SAMPLING, temperature=1.0))
    )
    forward_s, fp32_s, bf16_s = (statistics.median(times[name]) for name in ("forward", "fp32", "bf16"))
    return {
        "fp32_s": round(fp32_s, 3),
        "bf16_s": round(bf16_s, 3),
        "reference_forward_ms": round(1e3 * forward_s, 1),
        "tokens_identical": identical,
        "fp32_in_forwards": round(fp32_s / forward_s, 2),
        "bf16_in_forwards": round(bf16_s / forward_s, 2),
        "steps": 10,
        "n": REPEATS,
        **context(seed, f"median of {REPEATS} alternating runs, one thread, 196 frames, tokens and features, no text"),
    }
