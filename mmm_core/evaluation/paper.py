"""Computes the tables of the paper's section 5 for given data and checkpoints.

1 (HumanML3D) and 2 (KIT-ML): real motion, the tokenizer's reconstruction, generation. 3: speed against quality. 4: editing in
time. 5: editing the upper body. 6: ablations, over steps with one checkpoint, and over the differences between the given
checkpoints (masking ratio, codebook).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import torch
from torch import Tensor

from mmm_core.evaluation.metrics import Interval
from mmm_core.evaluation.pairs import Pair
from mmm_core.evaluation.protocol import (
    GENERATE_BATCH,
    N_MODALITY,
    Make,
    Progress,
    decode,
    fid_between_halves,
    generate,
    measure,
    measure_modality,
    measure_same,
    reconstruct,
    seconds_per_sentence,
    seeds_of,
    text_states,
)
from mmm_core.evaluation.reader import Motions, Reader
from mmm_core.generate.editing import part_names
from mmm_core.generate.engine import Engine
from mmm_core.model.sampling import fill
from mmm_core.model.tokenizer import Tokenizer
from mmm_core.model.vqvae import VqVae

Table = dict[str, dict[str, Interval | float | int]]
"""Lines by name, each with its columns by name."""
STEPS = (2, 4, 6, 10, 16)
STRETCHES: dict[str, tuple[tuple[float, float], ...]] = {
    "in-betweening": ((0.25, 0.75),),
    "out-painting": ((0.0, 0.25), (0.75, 1.0)),
    "prefix (the rest is made)": ((0.5, 1.0),),
    "suffix (the rest is made)": ((0.0, 0.5),),
}
"""Segments that each task generates anew, as shares of the motion's length; together they are half of the motion."""


def for_evaluation(engine: Engine, temperature: float | None = None) -> Engine:
    """The engine with the temperature of a measurement: by default 1 for the released model, as in the paper, else its own."""
    if temperature is None:
        temperature = 1.0 if engine.settings.official else engine.settings.temperature
    return _with_settings(engine, temperature=temperature)


def comparison(
    reader: Reader, engine: Engine, pairs: Sequence[Pair], repeats: int, progress: Progress, each: int = N_MODALITY
) -> Table:
    """Tables 1 and 2; MModality is measured with `each` motions for a text.

    A line of its own gives the FID between two halves of the real motions. A model with weights for captions of people has
    two tokenizers, and a line for each.
    """
    tokenizers = {"tokenizer": engine.model.tokenizer}
    if engine.people is not None:
        tokenizers["tokenizer for people"] = engine.people.tokenizer
    again = {name: partial(_reconstruct, one) for name, one in tokenizers.items()}
    return {
        "real motion": {**measure_same(reader, pairs, _real, repeats)},
        "real motion, one half against the other": {"FID": fid_between_halves(reader, pairs, repeats)},
        **{name: {**measure_same(reader, pairs, make, repeats)} for name, make in again.items()},
        "generated": {
            **measure(reader, pairs, _generate(engine), repeats, progress),
            "MModality": measure_modality(reader, engine, pairs, repeats, each),
        },
    }


def speed(reader: Reader, engine: Engine, pairs: Sequence[Pair], repeats: int, progress: Progress) -> Table:
    """Table 3: seconds for a sentence (AITS) beside FID, for several numbers of steps."""
    table: Table = {}
    for steps, faster in _with_steps(engine):
        row = measure(reader, pairs, _generate(faster), repeats, progress)
        table[f"{steps} steps"] = {"AITS s": seconds_per_sentence(faster, pairs), "FID": row["FID"]}
    return table


def editing_in_time(reader: Reader, engine: Engine, pairs: Sequence[Pair], repeats: int, progress: Progress) -> Table:
    """Table 4: half of each real motion is generated anew for the same text."""

    def task(stretches: Sequence[tuple[float, float]]) -> Make:
        def hide(ids: Tensor) -> None:
            for start, end in stretches:
                ids[round(start * len(ids)) : round(end * len(ids))] = engine.model.transformer.ids.mask

        return lambda some, seed: _made_again(engine, some, hide, seed)

    return {name: {**measure(reader, pairs, task(s), repeats, progress)} for name, s in STRETCHES.items()}


def editing_the_upper_body(
    reader: Reader, engine: Engine, pairs: Sequence[Pair], repeats: int, progress: Progress
) -> Table:
    """Table 5: the lower body stays (with our body parts: all but the arms); empty for a model without body parts."""
    names = part_names(engine)
    upper = [i for i, name in enumerate(names) if name == "upper" or name.endswith("_arm")]
    if not upper:
        return {}

    def hide(ids: Tensor) -> None:
        ids[:, upper] = engine.model.transformer.ids.mask

    row = measure(reader, pairs, lambda some, seed: _made_again(engine, some, hide, seed), repeats, progress)
    return {" and ".join(names[i] for i in upper): {**row}}


def ablations(
    reader: Reader, engines: dict[str, Engine], pairs: Sequence[Pair], repeats: int, progress: Progress
) -> Table:
    """Table 6: several numbers of steps with the first checkpoint, then each checkpoint with facts of its recipe."""
    table: Table = {}
    for steps, other in _with_steps(next(iter(engines.values()))):
        table[f"{steps} steps"] = {**measure(reader, pairs, _generate(other), repeats, progress)}
    for name, engine in engines.items():
        row: dict[str, Any] = {**measure(reader, pairs, _generate(engine), repeats, progress)}
        config = engine.model.tokenizer.config
        row |= {"codes": config.n_codes, "code width": config.code_dim}
        recipe = engine.model.provenance.get("recipe", {})
        share = recipe.get("transformer", {}).get("corruption", {}).get("masked_share")
        table[name] = row if share is None else {**row, "masked from": share}
    return table


def _real(pairs: Sequence[Pair], _seed: int) -> Motions:
    return [p.features for p in pairs]


def _reconstruct(tokenizer: Tokenizer | VqVae, pairs: Sequence[Pair], _seed: int) -> Motions:
    return reconstruct(tokenizer, pairs)


def _generate(engine: Engine) -> Make:
    return lambda pairs, seed: generate(engine, pairs, seed)


def _with_steps(engine: Engine) -> list[tuple[int, Engine]]:
    """The engine with other numbers of steps."""
    return [(n, _with_settings(engine, steps=n, official=False)) for n in STEPS]


def _with_settings(engine: Engine, **changes: Any) -> Engine:
    settings = replace(engine.settings, **changes)
    return Engine(
        engine.model, engine.encoder, engine.checkpoint_hash, settings, reader=engine.reader, people=engine.people
    )


@torch.inference_mode()
def _made_again(engine: Engine, pairs: Sequence[Pair], hide: Callable[[Tensor], None], seed: int) -> Motions:
    """Real motions in which the ids that `hide` masks are generated anew for the same text."""
    made: Motions = []
    for i in range(0, len(pairs), GENERATE_BATCH):
        some = pairs[i : i + GENERATE_BATCH]
        rows = [engine.model.tokenizer.encode(torch.from_numpy(p.features)[None])[0].clone() for p in some]
        for row in rows:
            hide(row)
        states, seeds = text_states(engine, some), seeds_of(some, i, seed)
        made += decode(engine, fill(engine.model.transformer, states, rows, seeds, engine.settings))
    return made
