"""How the shipped model is made, from corpus to checkpoint: the recipe behind `mmmd train`."""

from __future__ import annotations

import json
import logging
import subprocess
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np
import torch

from mmm_core.checkpoint import Model, load_text_encoder, save_model
from mmm_core.corpus.grammar import known_commands
from mmm_core.corpus.outside import OUTSIDE
from mmm_core.corpus.stream import make_corpus
from mmm_core.errors import TrainingDataError
from mmm_core.motion import FPS
from mmm_core.scope import ScopeIndex
from mmm_core.tokenizer import Tokenizer, TokenizerConfig
from mmm_core.training.batches import (
    CaptionStates,
    Clip,
    TokenCorpus,
    cut_to_tokens,
    encode_clips,
    load_clips,
    save_clips,
)
from mmm_core.training.run import Schedule
from mmm_core.training.tokenizer_training import train_tokenizer, tune_decoder
from mmm_core.training.transformer_training import train_length, train_transformer
from mmm_core.transformer import TransformerConfig

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Recipe:
    """Sizes of a training run; everything else has its default beside its code.

    Attributes:
        n_synthesised: clips the gesture corpus makes.
        tokenizer: its schedule; 0.22 s a step on one core.
        decoder: schedule of the tokenizer's decoder alone, afterwards; 0.15 s a step.
        transformer: its schedule; 0.5 s a step on one core.
        length: its schedule; 0.03 s a step.
        seed: of the corpus and of every stage.
    """

    n_synthesised: int = 14_000
    tokenizer: Schedule = field(default_factory=lambda: Schedule(steps=2600, learning_rate=1e-3))
    decoder: Schedule = field(default_factory=lambda: Schedule(steps=2500, learning_rate=1e-3))
    transformer: Schedule = field(default_factory=lambda: Schedule(steps=6200, learning_rate=1e-3))
    length: Schedule = field(default_factory=lambda: Schedule(steps=2500, learning_rate=1e-3, save_every=500))
    seed: int = 0


def corpus_clips(recipe: Recipe, data_dir: Path | None, run_dir: Path) -> list[Clip]:
    """The clips of this run: made once, then read from `run_dir`.

    Raises:
        TrainingDataError: the data folder holds no usable clip.
    """
    path = run_dir / "corpus.npz"
    if path.is_file():
        return load_clips(path)
    made = make_corpus(recipe.n_synthesised, data_dir, recipe.seed)
    rng = np.random.default_rng(recipe.seed)
    clips = [cut_to_tokens(Clip(c.features, list(c.captions), c.is_real), rng) for c in made]
    clips = [c for c in clips if len(c.features) and c.captions]
    if not clips:
        raise TrainingDataError(data_dir or Path(), "", "no clip", "the layout of clips.jsonl with motions_*.npz")
    run_dir.mkdir(parents=True, exist_ok=True)
    save_clips(path, clips)
    return clips


def tokenize(clips: Sequence[Clip], tokenizer: Tokenizer, run_dir: Path) -> TokenCorpus:
    """Ids and caption states of `clips`; caption states are kept in `run_dir`."""
    captions = sorted({c for clip in clips for c in clip.captions})
    row = {caption: i for i, caption in enumerate(captions)}
    path = run_dir / "captions.pt"
    if path.is_file():
        states: CaptionStates = CaptionStates.load(path)
    else:
        states = CaptionStates.encode(captions, load_text_encoder())
        states.save(path)
    rows = [[row[c] for c in clip.captions] for clip in clips]
    return TokenCorpus(encode_clips(clips, tokenizer), rows, states, np.array([c.is_real for c in clips]))


def scope_index() -> ScopeIndex:
    """What the model was taught to follow, in plain words, and what it cannot do."""
    commands = sorted(known_commands())
    texts = [*commands, *OUTSIDE]
    encoder = load_text_encoder()
    vectors = [encoder.encode(texts[i : i + 64]).sentence for i in range(0, len(texts), 64)]
    return ScopeIndex(texts, torch.cat(vectors), len(commands))


def make_model(recipe: Recipe, data_dir: Path | None, run_dir: Path, out: Path) -> None:
    """Run every stage that is not done yet and write the checkpoint to `out`."""
    clips = corpus_clips(recipe, data_dir, run_dir)
    hours = sum(len(c.features) for c in clips) / FPS / 3600
    log.info("%d clips, %.1f h, %d from people", len(clips), hours, sum(c.is_real for c in clips))
    tokenizer = train_tokenizer(clips, TokenizerConfig(), recipe.tokenizer, run_dir)
    corpus = tokenize(clips, tokenizer, run_dir)
    length = train_length(corpus, [len(c.features) / FPS for c in clips], recipe.length, run_dir)
    transformer = train_transformer(corpus, tokenizer, TransformerConfig(), recipe.transformer, run_dir)
    tune_decoder(tokenizer, clips, recipe.decoder, run_dir)
    provenance = {
        "recipe": json.loads(json.dumps(asdict(recipe))),
        "clips": len(clips),
        "clips_from_people": int(sum(c.is_real for c in clips)),
        "hours": round(hours, 2),
        "data": "synthesised gestures; CMU Graphics Lab Motion Capture Database (see docs/DATA.md)",
        "revision": _revision(),
    }
    save_model(out, Model(tokenizer, transformer, length, scope_index(), provenance))


def _revision() -> str:
    """Git revision of the code that trains, or "unknown" outside a checkout."""
    try:
        done = subprocess.run(["git", "rev-parse", "HEAD"], capture_output=True, text=True, check=True, timeout=10)
    except (OSError, subprocess.SubprocessError):
        return "unknown"
    return done.stdout.strip()
