"""Ablations (MMM sec. 5.4) on our data: one choice is changed at a time, with equal training from new weights and equal measures.

Variants share the corpus, its captions, and the tokenizer and length predictor of the shipped model. Each variant keeps its
state and its figures in a folder of its own, so an interrupted run can be continued, and a new variant does not repeat the others.
"""

from __future__ import annotations

import json
import logging
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray

from mmm_core.corpus.cmu import read_clips
from mmm_core.errors import TrainingDataError
from mmm_core.evaluation import paper, report
from mmm_core.evaluation.probes import evaluate
from mmm_core.evaluation.reconstruction import tokenizer_figures
from mmm_core.generate.engine import Engine
from mmm_core.inference.checkpoint import Model, load_text_encoder, save_model
from mmm_core.model.tokenizer import Tokenizer
from mmm_core.model.tokens import FRAMES_PER_TOKEN
from mmm_core.motion.features import recover
from mmm_core.training.batches import Clip, encode_clips
from mmm_core.training.recipe import Recipe, TextRecipe
from mmm_core.training.run import Run, written_whole
from mmm_core.training.stages import Stages
from mmm_core.training.tokenizer_training import train_tokenizer
from mmm_core.training.transformer_training import train_transformer

log = logging.getLogger(__name__)

BASE = "as shipped"
"""Name of the variant without a change."""
PROBE_SEEDS = 2
"""Motions generated for each probe."""
REAL_REPEATS, REAL_EACH = 5, 10
"""Repeats of the measurement on real captions, and motions for each text of its MModality."""
COUNTED_CLIPS = 2000
"""Clips of the corpus whose codes are counted."""


@dataclass(frozen=True)
class Variant:
    """One choice that differs from the shipped recipe.

    Attributes:
        corruption: fields of `Corruption`.
        text: fields of `TextRecipe`.
        tokenizer: fields of `TokenizerRecipe`; such a variant trains a tokenizer and no transformer.
    """

    corruption: Mapping[str, float] = field(default_factory=dict)
    text: Mapping[str, float] = field(default_factory=dict)
    tokenizer: Mapping[str, int] = field(default_factory=dict)


TRANSFORMERS: Mapping[str, Variant] = {
    BASE: Variant(),
    "masked share U(0, 1)": Variant({"masked_share": 0.0}),
    "masked share U(0.7, 1)": Variant({"masked_share": 0.7}),
    "no motion masked whole beyond that": Variant({"full_share": 0.0}),
    "visible ids never replaced": Variant({"kept_share": 1.0}),
    "gestures alone": Variant({"real_share": 0.0}),
    "four motions in ten from people": Variant({"real_share": 0.4}),
    "last two layers of the text encoder trained": Variant(text={"tuned_layers": 2}),
}
TOKENIZERS: Mapping[str, Variant] = {
    "2048 x 16 (as shipped)": Variant(tokenizer={"n_codes": 2048, "code_dim": 16}),
    "128 x 16": Variant(tokenizer={"n_codes": 128, "code_dim": 16}),
    "512 x 16": Variant(tokenizer={"n_codes": 512, "code_dim": 16}),
    "2048 x 4": Variant(tokenizer={"n_codes": 2048, "code_dim": 4}),
    "2048 x 64": Variant(tokenizer={"n_codes": 2048, "code_dim": 64}),
}


def run_ablations(recipe: Recipe, run: Run, data: Path, only: Sequence[str] = ()) -> dict[str, dict[str, Any]]:
    """Train and measure every variant that has no figures yet; returns the figures of all, by variant.

    Args:
        recipe: recipe of every variant but for its one choice; its `start` is a checkpoint whose tokenizer and length predictor
            serve all variants.
        run: its folder gets a folder for each variant.
        data: folder with clips.jsonl; its clips are mixed into the training, and its held-out captions are measured.
        only: names of variants; all when empty.

    Raises:
        TrainingDataError: `only` names an unknown variant, or the recipe has no `start`.
    """
    known = {**TRANSFORMERS, **TOKENIZERS}
    if unknown := [name for name in only if name not in known]:
        raise TrainingDataError(run.folder, "variant", ", ".join(unknown), "; ".join(known))
    if not recipe.start:
        raise TrainingDataError(run.folder, "start", "none", "a checkpoint whose tokenizer serves all variants")
    shared = Stages(recipe, replace(run, folder=run.folder / "shared"), data)
    figures: dict[str, dict[str, Any]] = {}
    for name in only or known:
        folder = run.folder / "".join(c if c.isalnum() else "_" for c in name)
        path = folder / "figures.json"
        if not path.is_file():
            log.info("%s", name)
            folder.mkdir(parents=True, exist_ok=True)
            text = replace(recipe.text, **known[name].text)  # pyright: ignore[reportArgumentType]
            if text != shared.recipe.text:  # other caption states; both corpora at once would fill the memory
                shared = Stages(replace(recipe, text=text), shared.run, data)
            make = _transformer_figures if name in TRANSFORMERS else _tokenizer_figures
            found = make(shared, known[name], replace(run, folder=folder), data)
            with written_whole(path) as partial:
                partial.write_text(json.dumps(found))
        figures[name] = json.loads(path.read_text())
    return figures


def _transformer_figures(shared: Stages, variant: Variant, run: Run, data: Path) -> dict[str, Any]:
    how, tokenizer, start, text = shared.recipe.transformer, shared.tokenizer, shared.start, shared.recipe.text
    assert start is not None, "checked above"
    words = shared.corpus.captions.words.shape[1]
    config = how.config(tokenizer.config, tokenizer.n_codebooks, words, text.tuned_layers)
    corruption = replace(how.corruption, **variant.corruption)
    transformer = train_transformer(
        shared.corpus, tokenizer, config, how.schedule, run, corruption, how.tokens_per_batch,
        words=load_text_encoder().layers, words_rate=text.tuned_rate,
    )  # fmt: skip
    length = start.length if text == TextRecipe() else shared.length
    model = Model(tokenizer, transformer, length, start.scope, shared.provenance())
    checkpoint = run.folder / "model.safetensors"
    save_model(checkpoint, model)
    return _measured(checkpoint, data)


def _measured(checkpoint: Path, data: Path) -> dict[str, Any]:
    """Figures of a checkpoint on probes and on real captions, as `mmmd eval` measures them."""
    engine = Engine.load(checkpoint)
    probes = evaluate(lambda text, seed: engine.generate(text, seed=seed).motion, range(PROBE_SEEDS))
    reader, _ = report.load_reader()
    asked = paper.for_evaluation(engine)
    pairs = report.measured_pairs(reader, [asked], data, report.default_splits(data))
    real = report.real_figures(reader, asked, pairs, REAL_REPEATS, REAL_EACH, lambda _text: None)
    keys = ("limb", "side", "pose", "count", "direction", "hold", "order", "tempo")
    return {**{key: probes[key] for key in keys}, "r1_ratio": real["r1_ratio"], "fid_ratio": real["fid_ratio"]}


def _tokenizer_figures(shared: Stages, variant: Variant, run: Run, data: Path) -> dict[str, Any]:
    how = replace(shared.recipe.tokenizer, **variant.tokenizer)
    width = shared.clips[0].features.shape[1]
    tokenizer = train_tokenizer(
        shared.clips, how.config(width), how.schedule, run, batch=how.batch,
        window_frames=how.window_frames, real_share=how.real_share, plain_steps=how.plain_steps,
    )  # fmt: skip
    assert isinstance(tokenizer, Tokenizer), "the shipped layout is by parts"
    kept = tokenizer_figures(tokenizer)
    return {
        **kept["met"],
        **{key: angle["mean"] for key, angle in kept["kept"].items()},
        "error_mm": _error_mm(tokenizer, data),
        "codes_used": _codes_used(tokenizer, shared.clips),
    }


@torch.inference_mode()
def _error_mm(tokenizer: Tokenizer, data: Path) -> float:
    """Millimetres that joints of held-out motions of people are moved on average by encoding and decoding."""
    errors: list[float] = []
    for split in report.default_splits(data):
        for features, _ in read_clips(data, split):
            ids = tokenizer.encode(
                torch.from_numpy(features[None, : len(features) // FRAMES_PER_TOKEN * FRAMES_PER_TOKEN])
            )
            again = tokenizer.decode(ids)[0].numpy()
            apart = _in_place(again) - _in_place(features[: len(again)])
            errors.append(float(np.linalg.norm(apart, axis=-1).mean()))
    return round(1e3 * float(np.mean(errors)), 1)


def _in_place(features: NDArray[np.float32]) -> NDArray[np.float64]:
    """(T, 22, 3) joints without walking and turning: errors of steps add up, and do not concern the pose."""
    still = features.copy()
    still[:, :3] = 0.0
    return np.asarray(recover(still).joints_m, np.float64)


def _codes_used(tokenizer: Tokenizer, clips: Sequence[Clip]) -> float:
    """Share of the codes that the corpus uses at least once, as a mean over the body parts."""
    ids = torch.cat(encode_clips(clips[:COUNTED_CLIPS], tokenizer))
    used = [len(ids[:, part].unique()) / tokenizer.config.n_codes for part in range(ids.shape[1])]
    return round(float(np.mean(used)), 3)


def table(figures: Mapping[str, Mapping[str, Any]], names: Iterable[str]) -> str:
    """Markdown table with a line for each variant that has figures."""
    rows = {name: figures[name] for name in names if name in figures}
    if not rows:
        return ""
    keys = list(next(iter(rows.values())))
    lines = [["", *keys], ["---"] * (len(keys) + 1)]
    lines += [[name, *(f"{row[key]:.3g}" for key in keys)] for name, row in rows.items()]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)
