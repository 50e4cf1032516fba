"""The tables of the paper's section 5, on whatever data and checkpoints are at hand.

1 (HumanML3D) and 2 (KIT-ML): real motion, the tokenizer's reconstruction, generation. 3: speed against quality. 4: editing in
time. 5: editing the upper body. 6: ablations, over steps with one checkpoint, and over whatever the given checkpoints differ
in (masking ratio, codebook).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import torch
from torch import Tensor

from mmm_core.editing import part_names
from mmm_core.engine import Engine
from mmm_core.evaluation.metrics import REPEATS, Interval
from mmm_core.evaluation.protocol import (
    GENERATE_BATCH,
    Motions,
    Pair,
    Progress,
    Reader,
    decode,
    generate,
    measure,
    measure_modality,
    reconstruct,
    seconds_per_sentence,
)
from mmm_core.sampling import fill
from mmm_core.text import TextStates

Table = dict[str, dict[str, Interval | float | int]]
"""Lines by name, each with its columns."""
STEPS = (2, 4, 6, 10, 16)
STRETCHES: dict[str, tuple[tuple[float, float], ...]] = {
    "in-betweening": ((0.25, 0.75),),
    "out-painting": ((0.0, 0.25), (0.75, 1.0)),
    "prefix (the rest is made)": ((0.5, 1.0),),
    "suffix (the rest is made)": ((0.0, 0.5),),
}
"""What is made again, as shares of the motion; half of it in every task."""


def comparison(reader: Reader, engine: Engine, pairs: Sequence[Pair], repeats: int, progress: Progress) -> Table:
    """Tables 1 and 2."""
    generated: dict[str, Any] = measure(reader, pairs, lambda s: generate(engine, pairs, s), repeats, progress)
    generated["MModality"] = measure_modality(reader, engine, pairs, min(repeats, REPEATS))
    return {
        "real motion": {**measure(reader, pairs, lambda _s: [p.features for p in pairs], repeats)},
        "tokenizer": {**measure(reader, pairs, lambda _s: reconstruct(engine, pairs), 1)},
        "generated": generated,
    }


def speed(reader: Reader, engine: Engine, pairs: Sequence[Pair], repeats: int, progress: Progress) -> Table:
    """Table 3: seconds for a sentence (AITS) beside FID, for several numbers of steps."""
    table: Table = {}
    for steps, faster in _with_steps(engine):
        row = measure(reader, pairs, lambda s, e=faster: generate(e, pairs, s), repeats, progress)
        table[f"{steps} steps"] = {"AITS s": seconds_per_sentence(faster, pairs), "FID": row["FID"]}
    return table


def editing_in_time(reader: Reader, engine: Engine, pairs: Sequence[Pair], repeats: int, progress: Progress) -> Table:
    """Table 4: half of each real motion is made again with the same text."""

    def task(stretches: Sequence[tuple[float, float]]) -> Callable[[int], Motions]:
        def hide(ids: Tensor) -> None:
            for start, end in stretches:
                ids[round(start * len(ids)) : round(end * len(ids))] = engine.model.transformer.ids.mask

        return lambda seed: _made_again(engine, pairs, hide, seed)

    return {name: {**measure(reader, pairs, task(s), repeats, progress)} for name, s in STRETCHES.items()}


def editing_the_upper_body(
    reader: Reader, engine: Engine, pairs: Sequence[Pair], repeats: int, progress: Progress
) -> Table:
    """Table 5: the lower body stays (or all but the arms, by our parts); empty for a model without parts."""
    names = part_names(engine)
    upper = [i for i, name in enumerate(names) if name == "upper" or name.endswith("_arm")]
    if not upper:
        return {}

    def hide(ids: Tensor) -> None:
        ids[:, upper] = engine.model.transformer.ids.mask

    row = measure(reader, pairs, lambda seed: _made_again(engine, pairs, hide, seed), repeats, progress)
    return {" and ".join(names[i] for i in upper): {**row}}


def ablations(
    reader: Reader, engines: dict[str, Engine], pairs: Sequence[Pair], repeats: int, progress: Progress
) -> Table:
    """Table 6: steps with the first checkpoint, then each checkpoint with what its recipe says of itself."""
    table: Table = {}
    for steps, other in _with_steps(next(iter(engines.values()))):
        table[f"{steps} steps"] = {
            **measure(reader, pairs, lambda s, e=other: generate(e, pairs, s), repeats, progress)
        }
    for name, engine in engines.items():
        row: dict[str, Any] = {**measure(reader, pairs, lambda s, e=engine: generate(e, pairs, s), repeats, progress)}
        config = engine.model.tokenizer.config
        row |= {"codes": config.n_codes, "code width": config.code_dim}
        recipe = engine.model.provenance.get("recipe", {})
        share = recipe.get("transformer", {}).get("corruption", {}).get("masked_share")
        table[name] = row if share is None else {**row, "masked from": share}
    return table


def _with_steps(engine: Engine) -> list[tuple[int, Engine]]:
    """The engine with other numbers of steps."""
    settings = [replace(engine.settings, fewest_steps=n, most_steps=n, official=False) for n in STEPS]
    return [
        (n, Engine(engine.model, engine.encoder, engine.checkpoint_hash, s))
        for n, s in zip(STEPS, settings, strict=True)
    ]


@torch.inference_mode()
def _made_again(engine: Engine, pairs: Sequence[Pair], hide: Callable[[Tensor], None], seed: int) -> Motions:
    """Real motions with the ids that `hide` masks made again for the same text."""
    made: Motions = []
    for i in range(0, len(pairs), GENERATE_BATCH):
        some = pairs[i : i + GENERATE_BATCH]
        rows = [engine.model.tokenizer.encode(torch.from_numpy(p.features)[None])[0].clone() for p in some]
        for row in rows:
            hide(row)
        states = TextStates.stacked([s for s, _ in engine.understand_all([p.text for p in some])])
        seeds = [(seed * 1_000_003 + i + k) % 2**31 for k in range(len(some))]
        made += decode(engine, fill(engine.model.transformer, states, rows, seeds, engine.settings))
    return made
